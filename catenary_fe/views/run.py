"""Pictures of a run: contact force, uplift at supports, dropper forces, energy."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.results import Run
from catenary_fe.views.style import (
    DROPPER,
    PANTOGRAPHS,
    SLACK,
    finish,
    headroom,
    mark_supports,
    new_axes,
    note_failed,
    styled,
)


@styled
def plot_contact_force(run: Run, *, ax: Axes | None = None) -> Axes:
    """Contact force along the line, filtered and unfiltered, with mean and 3σ of the evaluated spans."""
    ax = new_axes(ax, (11.0, 4.4))
    supports = run.data["support_position"].values
    mark_supports(ax, supports)
    spans = run.evaluated_spans
    ax.axvspan(supports[min(spans) - 1], supports[max(spans)], color="#f3efe2", label="evaluated spans")
    filtered = run.filtered_contact_force()
    single = filtered.shape[0] == 1
    figures, names = run.figures(), run.data["pantograph"].values
    for i, statistics in enumerate(figures):
        colour = PANTOGRAPHS[i % len(PANTOGRAPHS)]
        x = run.data["position"].values[i]
        if single:
            raw = run.data["contact_force"].values[i]
            ax.plot(x, raw, color="#b9c7d3", linewidth=0.6, label="unfiltered")
        ax.plot(x, filtered[i], color=colour, linewidth=1.1, label=f"{names[i]}, 0 to 20 Hz")
        if statistics is None:
            continue
        inside = x[run.window(i)]
        for value, style in (
            (statistics.mean, "-"),
            (statistics.statistical_max, "--"),
            (statistics.statistical_min, "--"),
        ):
            label = ""
            if single:
                label = {statistics.mean: "mean", statistics.statistical_max: "mean ± 3σ"}.get(value, "")
            ax.hlines(value, inside[0], inside[-1], color=colour, linestyle=style, linewidth=1.2, label=label)
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
    ax.legend(loc="upper left", fontsize=8, ncols=3, framealpha=0.9)
    ax.margins(x=0.01)
    headroom(ax, 0.18)
    means = ", ".join(
        f"mean {s.mean:.1f} N, σ {s.std:.1f} N, min {s.min:.0f} N, max {s.max:.0f} N" for s in figures if s
    )
    said = means or "evaluated spans not passed"
    title = f"{run.data.attrs['title']}, {3.6 * run.speed:.0f} km/h: contact force ({said})"
    return note_failed(
        finish(ax, "position along the line (m)", "contact force (N)", title), run.failed_checks
    )


@styled
def plot_support_uplift(run: Run, *, ax: Axes | None = None) -> Axes:
    """Uplift of the contact wire at the supports against time, those of the evaluated spans in colour."""
    ax = new_axes(ax)
    uplift = 1e3 * run.data["support_uplift"].values
    evaluated = sorted({s for n in run.evaluated_spans for s in (n - 1, n)})
    for i, values in enumerate(uplift[1:-1], start=1):
        if i not in evaluated:
            ax.plot(run.time, values, color="#c9c9c9", linewidth=0.8)
    for n, i in enumerate(evaluated):
        colour = PANTOGRAPHS[n % len(PANTOGRAPHS)]
        name = f"support {i + 1}: at most {uplift[i].max():.1f} mm"
        ax.plot(run.time, uplift[i], color=colour, linewidth=1.3, label=name)
    ax.plot([], [], color="#c9c9c9", linewidth=0.8, label="other supports")
    rows = 1 + len(evaluated) // 4
    headroom(ax, 0.08 + 0.1 * rows)
    ax.legend(loc="upper left", fontsize=8, ncols=4, framealpha=0.9)
    title = f"{run.data.attrs['title']}, {3.6 * run.speed:.0f} km/h: uplift at the supports"
    return note_failed(finish(ax, "time (s)", "uplift (mm)", title), run.failed_checks)


@styled
def plot_dropper_forces(run: Run, *, ax: Axes | None = None) -> Axes:
    """Static, largest and smallest force of each dropper; those that went slack are marked."""
    ax = new_axes(ax)
    x = run.data["dropper_position"].values
    forces = run.data["dropper_force"].values
    mark_supports(ax, run.data["support_position"].values)
    low, high = forces.min(axis=1), forces.max(axis=1)
    ax.vlines(x, low, high, color=DROPPER, linewidth=2.0, label="range during the run")
    ax.plot(x, forces[:, 0], ".", color=PANTOGRAPHS[0], markersize=6, label="at the start")
    slack = low <= 0
    if slack.any():
        share = np.mean(forces[slack] <= 0) * 100
        name = f"went slack: {slack.sum()} of {x.size}, {share:.1f} % of the time"
        ax.plot(x[slack], low[slack], "v", color=PANTOGRAPHS[1], markersize=5, label=name)
    ax.legend(loc="upper right", fontsize=8, ncols=2, framealpha=0.9)
    headroom(ax, 0.18)
    title = f"{run.data.attrs['title']}, {3.6 * run.speed:.0f} km/h: dropper forces"
    return note_failed(
        finish(ax, "position along the line (m)", "dropper force (N)", title), run.failed_checks
    )


@styled
def plot_energy(run: Run, *, ax: Axes | None = None) -> Axes:
    """Work on the whole system, what its dampers took, what it has stored, and what is missing of that.

    Raises InputError where the run recorded no energy.
    """
    ax = new_axes(ax)
    missing, time = run.missing_energy, run.data["energy_time"].values
    for name, label, colour in (
        ("driven_work", "done by the contacts", PANTOGRAPHS[0]),
        ("lost_work", "lost in dampers", PANTOGRAPHS[1]),
        ("energy", "kinetic and stored, since the start", PANTOGRAPHS[2]),
    ):
        ax.plot(time, run.data[name].values, color=colour, linewidth=1.2, label=label)
    ax.plot(time, missing, color=SLACK, linewidth=1.2, linestyle="--", label="missing")
    ax.legend(loc="upper left", fontsize=8, ncols=4, framealpha=0.9)
    ax.margins(x=0.01)
    headroom(ax, 0.18)
    most = np.abs(missing).max()
    title = f"{run.data.attrs['title']}, {3.6 * run.speed:.0f} km/h: energy ({most:.2g} J missing)"
    return note_failed(finish(ax, "time (s)", "energy (J)", title), run.failed_checks)
