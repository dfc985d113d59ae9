"""Pictures of a run: contact force, uplift at supports, dropper forces, energy."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.layout.arguments import checked
from catenary_fe.results import ForceStatistics, Run
from catenary_fe.results.quantities import in_short
from catenary_fe.results.signal import FilterKind
from catenary_fe.views.style import (
    DROPPER,
    OTHERS,
    PANTOGRAPHS,
    SLACK,
    distinct,
    finish,
    headroom,
    label_row,
    mark_spans,
    mark_supports,
    new_axes,
    new_panels,
    note_failed,
    runs,
    sequence,
    styled,
)

Floats = NDArray[np.float64]
_NAMED = 12  # supports that a legend has room for


@checked
@styled
def plot_contact_force(run: Run, *, filter: FilterKind = "causal", ax: Axes | None = None) -> Axes:
    """Contact force along the line, filtered and unfiltered, with mean and 3σ of the evaluated spans."""
    ax = new_axes(ax, (11.0, 4.4))
    supports = run.data["support_position"].values
    mark_supports(ax, supports)
    mark_spans(ax, supports, run.evaluated_spans)
    filtered = run.filtered_contact_force(filter)
    single = filtered.shape[0] == 1
    figures, names = run.figures(filter), run.data["pantograph"].values
    for i, (statistics, colour) in enumerate(zip(figures, distinct(len(figures)), strict=True)):
        x = run.data["position"].values[i]
        if single:
            raw = run.data["contact_force"].values[i]
            ax.plot(x, raw, color="#b9c7d3", linewidth=0.6, label="unfiltered")
        said = "" if single else f": {_in_words(statistics)}"
        ax.plot(x, filtered[i], color=colour, linewidth=1.1, label=f"{names[i]}, 0 to 20 Hz{said}")
        if statistics is not None:
            _draw_statistics(ax, run, statistics, colour, single)
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
    ax.legend(loc="upper left", fontsize=8, ncols=3 if single else 1, framealpha=0.9)
    ax.margins(x=0.01)
    headroom(ax, 0.18 if single else 0.1 + 0.06 * len(figures))
    said = f" ({_in_words(figures[0])})" if single else ""
    title = f"{run.data.attrs['title']}, {3.6 * run.speed:.0f} km/h: contact force{said}"
    return note_failed(
        finish(ax, "position along the line (m)", "contact force (N)", title), run.failed_checks
    )


def _in_words(s: ForceStatistics | None) -> str:
    if s is None:
        return "evaluated spans not passed"
    return in_short(s, ("mean", "std", "min", "max"))


def _draw_statistics(ax: Axes, run: Run, statistics: ForceStatistics, colour: str, named: bool) -> None:
    """Mean and mean ± 3σ over each run of evaluated spans."""
    supports, groups = run.data["support_position"].values, np.array(runs(run.evaluated_spans))
    for value, style, name in (
        (statistics.mean, "-", "mean"),
        (statistics.statistical_max, "--", "mean ± 3σ"),
        (statistics.statistical_min, "--", ""),
    ):
        ends = supports[groups[:, 0] - 1], supports[groups[:, 1]]
        ax.hlines(
            [value] * len(groups), *ends, color=colour, linestyle=style, linewidth=1.2,
            label=name if named else "",
        )  # fmt: skip


@checked
@styled
def plot_support_uplift(run: Run, *, ax: Axes | None = None) -> Axes:
    """Uplift of the contact wire at the supports against time, those of the evaluated spans in colour.

    ax : for the curves alone; unset: those of a new figure, with a bar for each support's largest uplift

    Returns the axes of the curves.
    """
    uplift = 1e3 * run.data["support_uplift"].values
    inner = range(1, uplift.shape[0] - 1)
    evaluated = [n - 1 for n in run.uplift_by_support() if n - 1 in inner]
    colours = dict.fromkeys(inner, OTHERS) | dict(zip(evaluated, sequence(len(evaluated)), strict=True))
    if ax is None:
        ax, bars = new_panels((11.0, 6.2), (3, 2))
        by_support = run.uplift_by_support(range(1, uplift.shape[0]))
        _uplift_bars(bars, {n: 1e3 * lift for n, lift in by_support.items() if n - 1 in inner}, colours)
    for i in sorted(inner, key=evaluated.__contains__):
        name = f"support {i + 1}: at most {uplift[i].max():.1f} mm" if i in evaluated else None
        if len(evaluated) > _NAMED and uplift[i].max() < uplift[evaluated].max():
            name = None
        ax.plot(run.time, uplift[i], color=colours[i], linewidth=1.3 if i in evaluated else 0.8, label=name)
    if len(evaluated) < len(inner):
        ax.plot([], [], color=OTHERS, linewidth=0.8, label="other supports")
    headroom(ax, 0.12 + 0.1 * (min(len(evaluated), _NAMED) // 4))
    ax.margins(x=0.01)
    ax.legend(loc="upper left", fontsize=8, ncols=4, framealpha=0.9)
    title = f"{run.data.attrs['title']}, {3.6 * run.speed:.0f} km/h: uplift at the supports"
    return note_failed(finish(ax, "time (s)", "uplift (mm)", title), run.failed_checks)


def _uplift_bars(ax: Axes, largest: dict[int, float], colours: dict[int, str]) -> None:
    """The largest uplift [mm] of each support by its number, in the colour of its curve."""
    numbers, heights = np.array(list(largest)), np.array(list(largest.values()))
    ax.bar(numbers, heights, color=[colours[n - 1] for n in largest], width=0.75)
    ax.set_xlim(numbers[0] - 0.6, numbers[-1] + 0.6)
    ax.set_ylim(0, 1.25 * max(heights.max(), 1e-6))
    ax.set_xticks(numbers[:: -(-numbers.size // 40)])
    label_row(ax, numbers, heights, [f"{height:.1f}" for height in heights], above=2)
    finish(ax, "support", "largest uplift (mm)", "Largest uplift of each support; evaluated ones in colour")
    ax.grid(visible=False, axis="x")


@checked
@styled
def plot_dropper_forces(run: Run, *, ax: Axes | None = None) -> Axes:
    """Static, largest and smallest force of each dropper; those that went slack are marked."""
    ax = new_axes(ax)
    x = run.data["dropper_position"].values
    forces = run.data["dropper_force"].values
    mark_supports(ax, run.data["support_position"].values)
    mark_spans(ax, run.data["support_position"].values, run.evaluated_spans)
    low, high = forces.min(axis=1), forces.max(axis=1)
    ax.vlines(x, low, high, color=DROPPER, linewidth=2.0, label="range during the run")
    ax.plot(x, forces[:, 0], ".", color=PANTOGRAPHS[0], markersize=6, label="at the start")
    slack = run.slackened_droppers
    if slack.size:
        share = np.mean(forces[slack] <= 0) * 100
        name = f"went slack: {slack.size} of {x.size}, {share:.1f} % of the time"
        ax.plot(x[slack], low[slack], "v", color=PANTOGRAPHS[1], markersize=5, label=name)
    ax.legend(loc="upper right", fontsize=8, ncols=2, framealpha=0.9)
    headroom(ax, 0.18)
    title = f"{run.data.attrs['title']}, {3.6 * run.speed:.0f} km/h: dropper forces"
    return note_failed(
        finish(ax, "position along the line (m)", "dropper force (N)", title), run.failed_checks
    )


@checked
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
