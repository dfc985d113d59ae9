"""Pictures of a run: contact force, its spectrum, uplift, dropper forces, energy, criteria."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.layout import InputError, Line
from catenary_fe.layout.arguments import checked, number, runs, whole
from catenary_fe.results import Criterion, ForceStatistics, Run, labels, spectrum
from catenary_fe.results.quantities import in_short
from catenary_fe.results.signal import CUT_OFF, FilterKind, low_pass
from catenary_fe.statics import Shape
from catenary_fe.views import style
from catenary_fe.views.heights import plot_heights
from catenary_fe.views.layout import head_width, plot_layout, plot_plan
from catenary_fe.views.static import SHADES, plot_static_shape

_NAMED = 12  # supports that a legend has room for
_COLOURS = {"passed": "#3a7d44", "missed": "#b3261e", "not judged": "#9a9a9a"}
_LONGEST = 2.0  # times the limit: a longer bar would leave no room to compare the others


def run_pictures(run: Run, shape: Shape, filter: FilterKind) -> Iterator[tuple[str, Axes]]:
    """Pictures of a run and of its line at rest, one after another, each with its name."""
    yield "layout", plot_layout(shape.catenary, shape)
    yield "static_shape", plot_static_shape(shape)
    if shape.catenary.is_spatial:
        yield "plan", plot_plan(shape, head_width=head_width(run.pantographs))
    if shape.catenary.changes_height:
        yield "heights", plot_heights(shape, speed=run.speed)
    yield "contact_force", plot_contact_force(run, filter=filter)
    if "section_force" in run.data:
        yield "handover", plot_handover(run, filter=filter)
    if "contact_lateral" in run.data:
        yield "contact_lateral", plot_contact_lateral(run)
    yield "support_uplift", plot_support_uplift(run)
    yield "dropper_forces", plot_dropper_forces(run)
    if run.has_energy:
        yield "energy", plot_energy(run)


@checked
@style.styled
def plot_contact_force(run: Run, *, filter: FilterKind = "causal", ax: Axes | None = None) -> Axes:
    """Contact force along the line, filtered and unfiltered, with mean and 3σ of the evaluated spans."""
    ax = style.new_axes(ax, (11.0, 4.4))
    supports = run.data["support_position"].values
    style.mark_supports(ax, supports)
    style.mark_spans(ax, supports, run.evaluated_spans)
    filtered = run.filtered_contact_force(filter)
    single = filtered.shape[0] == 1
    figures, names = run.figures(filter), run.data["pantograph"].values
    for i, (statistics, colour) in enumerate(zip(figures, style.distinct(len(figures)), strict=True)):
        x = run.data["position"].values[i]
        if single:
            raw = run.data["contact_force"].values[i]
            ax.plot(x, raw, color="#b9c7d3", linewidth=0.6, label="unfiltered")
        said = "" if single else f": {_in_words(statistics)}"
        ax.plot(x, filtered[i], color=colour, linewidth=1.1, label=f"{names[i]}, 0 to 20 Hz{said}")
        if statistics is not None:
            _draw_statistics(ax, run, statistics, colour, single)
    ax.set_ylim(bottom=min(0.0, ax.get_ylim()[0]))
    style.legend(ax, 3 if single else 1)
    ax.margins(x=0.01)
    style.headroom(ax, 0.18 if single else 0.1 + 0.06 * len(figures))
    said = f" ({_in_words(figures[0])})" if single else ""
    return style.finish_run(ax, run, style.ALONG, "contact force (N)", f": contact force{said}")


@checked
@style.styled
def plot_contact_lateral(run: Run, *, ax: Axes | None = None) -> Axes:
    """Where the wires lie on the heads along the line: to the left of a head's middle, with its half width.

    Raises InputError for a run in the plane, which knows no such place.
    """
    if "contact_lateral" not in run.data:
        raise InputError(
            "the run is in the vertical plane: it has no lateral places; model the line in space"
        )
    ax = style.new_axes(ax, (11.0, 3.4))
    supports, names = run.data["support_position"].values, run.data["pantograph"].values
    style.mark_supports(ax, supports)
    style.mark_spans(ax, supports, run.evaluated_spans)
    places = run.data["contact_lateral"].values
    for i, (each, colour) in enumerate(zip(places, style.distinct(len(places)), strict=True)):
        for n, y in enumerate(each):
            label = str(names[i]) if n == 0 else None
            ax.plot(run.data["position"].values[i], y, color=colour, linewidth=1.1, label=label)
    half = head_width(run.pantographs) / 2
    said = "half of the head" if any(p.head for p in run.pantographs) else "half of a usual head"
    for side in (-half, half):
        ax.axhline(side, color=style.SUPPORT, linewidth=0.9, linestyle="--", label=said if side > 0 else None)
    ax.set_ylim(-1.35 * half, 1.6 * half)
    ax.margins(x=0.01)
    style.legend(ax, 3)
    label = "to the left of the head's middle (m)"
    return style.finish_run(ax, run, style.ALONG, label, ": place of the contact on the head")


@checked
@style.styled
def plot_handover(
    run: Run, *, pantograph: int = 0, filter: FilterKind = "causal", ax: Axes | None = None
) -> Axes:
    """Force of a pantograph on the contact wires of each tension section in the overlaps, and in all.

    pantograph : its number, from 0

    Several overlaps are drawn below each other; the axes returned are those of the first.

    Raises InputError for a run on one section, and for a pantograph that did not run.
    """
    if not isinstance(run.catenary, Line) or "section_force" not in run.data:
        raise InputError("the run is on one tension section: no force is handed over")
    whole("pantograph", pantograph, least=0, most=run.data.sizes["pantograph"] - 1)
    zones, forces = run.catenary.common_zones, run.data["section_force"].values[pantograph]
    if ax is not None or len(zones) == 1:
        panels = [style.new_axes(ax, (11.0, 3.6))]
    else:
        panels = style.new_panels((11.0, 3.4 * len(zones)), [1] * len(zones))
    for overlap, (panel, zone) in enumerate(zip(panels, zones, strict=False), start=1):
        _draw_handover(panel, run, pantograph, forces, overlap, zone, filter)
    return panels[0]


def _draw_handover(
    ax: Axes,
    run: Run,
    pantograph: int,
    forces: np.ndarray,
    number: int,
    zone: tuple[float, float],
    filter: FilterKind,
) -> None:
    x = run.data["position"].values[pantograph]
    inside = (x >= zone[0]) & (x <= zone[1])
    supports = run.data["support_position"].values
    style.mark_supports(ax, supports[(supports >= zone[0] - 1e-6) & (supports <= zone[1] + 1e-6)])
    for section in (number - 1, number):
        ax.plot(
            x[inside], forces[section][inside], color=SHADES[section % 2], linewidth=1.0,
            label=f"on section {section + 1}, unfiltered",
        )  # fmt: skip
    total = low_pass(run.data["contact_force"].values[pantograph], run.step, kind=filter)
    ax.plot(x[inside], total[inside], color="black", linewidth=1.4, label="in all, 0 to 20 Hz")
    ax.set_ylim(bottom=0.0)
    style.headroom(ax, 0.18)
    style.legend(ax, 3)
    name = run.data["pantograph"].values[pantograph]
    style.finish_run(ax, run, style.ALONG, "contact force (N)", f": overlap {number}, {name}")


def _in_words(s: ForceStatistics | None) -> str:
    if s is None:
        return "evaluated spans not passed"
    return in_short(s, ("mean", "std", "min", "max"))


def _draw_statistics(ax: Axes, run: Run, statistics: ForceStatistics, colour: str, named: bool) -> None:
    """Mean and mean ± 3σ over each run of evaluated spans."""
    supports, groups = run.data["support_position"].values, np.array(runs(run.evaluated_spans))
    for value, line, name in (
        (statistics.mean, "-", "mean"),
        (statistics.statistical_max, "--", "mean ± 3σ"),
        (statistics.statistical_min, "--", ""),
    ):
        ends = supports[groups[:, 0] - 1], supports[groups[:, 1]]
        ax.hlines(
            [value] * len(groups), *ends, color=colour, linestyle=line, linewidth=1.2,
            label=name if named else "",
        )  # fmt: skip


@checked
@style.styled
def plot_support_uplift(run: Run, *, ax: Axes | None = None) -> Axes:
    """Uplift of the contact wire at the supports against time, those of the evaluated spans in colour.

    ax : for the curves alone; unset: those of a new figure, with a bar for each support's largest uplift

    Returns the axes of the curves.
    """
    uplift = 1e3 * run.data["support_uplift"].values
    inner = range(1, uplift.shape[0] - 1)
    evaluated = [n - 1 for n in run.uplift_by_support() if n - 1 in inner]
    colours = dict.fromkeys(inner, style.OTHERS) | dict(
        zip(evaluated, style.sequence(len(evaluated)), strict=True)
    )
    if ax is None:
        ax, bars = style.new_panels((11.0, 6.2), (3, 2))
        by_support = run.uplift_by_support(range(1, uplift.shape[0]))
        _uplift_bars(bars, {n: 1e3 * lift for n, lift in by_support.items() if n - 1 in inner}, colours)
    for i in sorted(inner, key=evaluated.__contains__):
        name = f"support {i + 1}: at most {uplift[i].max():.1f} mm" if i in evaluated else None
        if len(evaluated) > _NAMED and uplift[i].max() < uplift[evaluated].max():
            name = None
        ax.plot(run.time, uplift[i], color=colours[i], linewidth=1.3 if i in evaluated else 0.8, label=name)
    if len(evaluated) < len(inner):
        ax.plot([], [], color=style.OTHERS, linewidth=0.8, label="other supports")
    style.headroom(ax, 0.12 + 0.1 * (min(len(evaluated), _NAMED) // 4))
    ax.margins(x=0.01)
    style.legend(ax)
    return style.finish_run(ax, run, "time (s)", "uplift (mm)", ": uplift at the supports")


def _uplift_bars(ax: Axes, largest: dict[int, float], colours: dict[int, str]) -> None:
    """The largest uplift [mm] of each support by its number, in the colour of its curve."""
    numbers, heights = np.array(list(largest)), np.array(list(largest.values()))
    ax.bar(numbers, heights, color=[colours[n - 1] for n in largest], width=0.75)
    ax.set_xlim(numbers[0] - 0.6, numbers[-1] + 0.6)
    ax.set_ylim(0, 1.25 * max(heights.max(), 1e-6))
    ax.set_xticks(numbers[:: -(-numbers.size // 40)])
    style.label_row(ax, numbers, heights, [f"{height:.1f}" for height in heights], above=2)
    style.finish(
        ax, "support", "largest uplift (mm)", "Largest uplift of each support; evaluated ones in colour"
    )
    ax.grid(visible=False, axis="x")


@checked
@style.styled
def plot_dropper_forces(run: Run, *, ax: Axes | None = None) -> Axes:
    """Static, largest and smallest force of each dropper; those that went slack are marked."""
    ax = style.new_axes(ax)
    x = run.data["dropper_position"].values
    forces = run.data["dropper_force"].values
    style.mark_supports(ax, run.data["support_position"].values)
    style.mark_spans(ax, run.data["support_position"].values, run.evaluated_spans)
    low, high = forces.min(axis=1), forces.max(axis=1)
    ax.vlines(x, low, high, color=style.DROPPER, linewidth=min(2.0, 300 / max(1, x.size)),
              label="range during the run")  # fmt: skip
    size = 6 if x.size < 200 else 3
    ax.plot(x, forces[:, 0], ".", color=style.MESSENGER, markersize=size, label="at the start")
    slack = run.slackened_droppers
    if slack.size:
        share = np.mean(forces[slack] <= 0) * 100
        name = f"went slack: {slack.size} of {x.size}, {share:.1f} % of the time"
        ax.plot(x[slack], low[slack], "v", color=style.SLACK, markersize=0.8 * size, label=name)
    style.legend(ax, 2, "upper right")
    style.headroom(ax, 0.18)
    return style.finish_run(ax, run, style.ALONG, "dropper force (N)", ": dropper forces")


@checked
@style.styled
def plot_energy(run: Run, *, ax: Axes | None = None) -> Axes:
    """Work on the whole system, what its dampers took, what it has stored, and what is missing of that.

    Raises InputError where the run recorded no energy.
    """
    ax = style.new_axes(ax)
    missing, time = run.missing_energy, run.data["energy_time"].values
    for name, label, colour in (
        ("driven_work", "done by the contacts", style.PANTOGRAPHS[0]),
        ("lost_work", "lost in dampers", style.PANTOGRAPHS[1]),
        ("energy", "kinetic and stored, since the start", style.PANTOGRAPHS[2]),
    ):
        ax.plot(time, run.data[name].values, color=colour, linewidth=1.2, label=label)
    ax.plot(time, missing, color=style.SLACK, linewidth=1.2, linestyle="--", label="missing")
    style.legend(ax)
    ax.margins(x=0.01)
    style.headroom(ax, 0.18)
    most = np.abs(missing).max()
    return style.finish_run(ax, run, "time (s)", "energy (J)", f": energy ({most:.2g} J missing)")


@checked
@style.styled
def plot_force_spectrum(run: Run, *, up_to: float = 1.5 * CUT_OFF, ax: Axes | None = None) -> Axes:
    """Amplitudes of the unfiltered contact force while the pantographs are in the evaluated spans.

    up_to : [Hz] end of the axis

    Marked are the frequencies at which the train passes spans and droppers, by their mean distances.
    """
    number("up_to", up_to, "Hz", above=0.0)
    ax = style.new_axes(ax)
    for i, name in enumerate(run.data["pantograph"].values):
        force = run.data["contact_force"].values[i][run.window(i)]
        frequency, amplitude = spectrum(force, run.step)
        shown = frequency <= up_to
        colour = style.pantograph_colour(i)
        ax.plot(frequency[shown], amplitude[shown], color=colour, marker=".", markersize=3, label=str(name))
    style.headroom(ax, 0.2)
    ax.set_ylim(bottom=0)
    ax.axvspan(CUT_OFF, up_to, color="#eeeeee", label=f"above the filter's {CUT_OFF:g} Hz")
    for name, distance in _distances(run).items():
        rate = run.speed / distance
        if rate < up_to:
            ax.axvline(rate, color=style.SUPPORT, linestyle=":", linewidth=0.9)
            text, axes = f" {name}, {rate:.2g} Hz", ax.get_xaxis_transform()
            ax.text(rate, 0.97, text, transform=axes, fontsize=8, va="top")
    style.legend(ax, 1, "upper right")
    ax.set_xlim(0, up_to)
    return style.finish_run(ax, run, "frequency (Hz)", "amplitude (N)", ": spectrum of the contact force")


def _distances(run: Run) -> dict[str, float]:
    """[m] mean distance of what passes, in the evaluated spans."""
    supports, at = run.data["support_position"].values, run.data["dropper_position"].values
    spans = run.evaluated_spans
    start, end = supports[min(spans) - 1], supports[max(spans)]
    distances = {"spans": float(np.diff(supports)[min(spans) - 1 : max(spans)].mean())}
    inside = at[(at >= start) & (at <= end)]
    if inside.size > 1:
        distances["droppers"] = float(np.diff(inside).mean())
    return distances


@style.styled
def plot_criteria(rows: Sequence[Criterion], *, title: str = "", ax: Axes | None = None) -> Axes:
    """One bar for each criterion: 100 % is the limit, a longer bar misses it.

    A lower limit of a figure that is a mean less its scatter is used by the scatter. Where the share has no
    end, or goes beyond twice the limit, the bar is hatched and ends there. A criterion without a known
    limit has an empty bar.
    """
    ax = style.new_axes(ax, (11.0, 1.2 + 0.32 * len(rows)))
    shares = [row.used for row in rows]
    end = 100 * max([1.0, *(min(share, _LONGEST) for share in shares if share is not None)])
    for i, (row, share) in enumerate(zip(rows, shares, strict=True)):
        colour = _COLOURS[row.verdict]
        if share is None:
            ax.barh(i, 100, height=0.62, facecolor="none", edgecolor=colour, linestyle=":", linewidth=1.0)
        else:
            hatch = "//" if share > _LONGEST else None
            width = 100 * min(share, _LONGEST)
            ax.barh(i, width, height=0.62, color=colour, hatch=hatch, edgecolor="white" if hatch else colour)
        text = f"{row.value_text}, {row.limit_text}" if row.limit is not None else row.value_text
        marks = [row.verdict] + ["limit recalled"] * row.recalled
        colour = _COLOURS["missed"] if row.passed is False else "#222222"
        ax.text(end + 3, i, f"{text}: {', '.join(marks)}", va="center", fontsize=8, color=colour)
    ax.axvline(100, color="#333333", linewidth=1.0, linestyle="--")
    ax.set_yticks(range(len(rows)), labels(rows), fontsize=8)
    ax.invert_yaxis()
    ax.set_xlim(0, 1.6 * end)
    ax.set_xticks([x for x in ax.get_xticks() if x <= end])
    heading = f"{title}: criteria" if title else "criteria"
    style.finish(ax, "share of the limit that is used (%)", "", heading)
    ax.grid(visible=False, axis="y")
    return ax
