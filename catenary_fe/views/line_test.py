"""A run beside a line test: force along the line, statistics span by span, spectrum, uplifts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.layout.arguments import checked
from catenary_fe.results import ForceStatistics
from catenary_fe.results.line_test import LineTestComparison
from catenary_fe.results.quantities import FORCE, in_short
from catenary_fe.results.signal import CUT_OFF, low_pass
from catenary_fe.views import style

Floats = NDArray[np.float64]

_RUN = style.PANTOGRAPHS[0]
_UP_TO = 1.5 * CUT_OFF  # [Hz] of the spectrum
_MOST_TICKS = 40


@checked
@style.styled
def plot_line_test(comparison: LineTestComparison) -> Axes:
    """The run and what was measured: along the line, by span, over frequency, at the supports.

    Returns the first axes; what was not measured has none.
    """
    c = comparison
    rows: list[tuple[float, list[Any]]] = []
    if c.statistics:
        rows += [(3.2, ["force", "force"]), (2.4, ["mean", "std"]), (2.6, ["spectrum", "spectrum"])]
        if not c.by_span:
            del rows[1]
    if c.height_range is not None:
        rows.append((2.4, ["height", "height"]))
    if c.uplift:
        rows.append((2.4, ["uplift", "uplift"]))
    figure = style.Picture(figsize=(11.0, sum(height for height, _ in rows) + 0.4), layout="constrained")
    axes: dict[str, Axes] = figure.subplot_mosaic(
        [names for _, names in rows], height_ratios=[height for height, _ in rows]
    )
    draw: Mapping[str, Callable[[Axes, LineTestComparison], Any]] = {
        "force": _force, "mean": _mean, "std": _std, "spectrum": _spectrum, "height": _height,
        "uplift": _uplift,
    }  # fmt: skip
    for name, ax in axes.items():
        draw[name](ax, c)
    first = axes[rows[0][1][0]]
    title = style.run_title(c.run, f": {first.get_title(loc='left')}")
    first.set_title(title, fontsize=10, loc="left")
    return style.note_failed(first, c.run.failed_checks)


def _colours(c: LineTestComparison) -> list[str]:
    return style.distinct(len(c.passes) + 1)[1:]


def _along(ax: Axes, c: LineTestComparison, name: str, label: str, title: str) -> None:
    """Filtered histories of run and passes over what is compared, and a little more."""
    margin = 0.03 * (c.end - c.begin)
    variable = {"force": "contact_force", "height": "wire_height"}[name]
    x = c.run.data["position"].values[c.pantograph]
    own = low_pass(np.asarray(c.run.data[variable].values[c.pantograph]), c.run.step, kind=c.filter)
    supports = c.run.data["support_position"].values
    style.mark_supports(ax, supports[(supports >= c.begin - margin) & (supports <= c.end + margin)])
    ax.axvspan(c.begin, c.end, color=style.EVALUATED, linewidth=0, zorder=0, label="compared")
    shown = (x >= c.begin - margin) & (x <= c.end + margin)
    if name == "height":
        own = _about_mean(own, (x >= c.begin) & (x <= c.end))
    said = f": {in_short(c.statistics, ('mean', 'std'))}" if name == "force" and c.statistics else ""
    for one, colour in zip(c.passes, _colours(c), strict=True):
        values = getattr(one, name)
        if values is None:
            continue
        if name == "height":
            values = _about_mean(values, one.inside)
        seen = (one.x >= c.begin - margin) & (one.x <= c.end + margin)
        figures = f": {in_short(one.statistics, ('mean', 'std'))}" if said and one.statistics else ""
        ax.plot(one.x[seen], values[seen], color=colour, linewidth=1.0, label=f"{one.name}{figures}")
    if name == "force" and c.band:
        low, _, high = c.band.band.force
        said_of_band = f"5 to 95 % of {c.band.band.samples} samples"
        ax.fill_between(c.band.band.x, low, high, color=_RUN, alpha=0.2, linewidth=0, label=said_of_band)
    ax.plot(x[shown], own[shown], color=_RUN, linewidth=1.3, label=f"run{said}")
    ax.set_xlim(c.begin - margin, c.end + margin)
    rows = (len(c.passes) + 2 * bool(c.band)) // 2
    style.headroom(ax, 0.14 + 0.08 * rows)
    style.legend(ax, 2)
    style.finish(ax, style.ALONG, label, title)


def _about_mean(height: Floats, inside: NDArray[np.bool_]) -> Floats:
    """[mm]: heights may be measured above any level."""
    return 1e3 * (height - float(height[inside].mean()))


def _force(ax: Axes, c: LineTestComparison) -> None:
    _along(ax, c, "force", "contact force (N)", f"contact force, {c.filter} low-pass at {CUT_OFF:g} Hz")


def _height(ax: Axes, c: LineTestComparison) -> None:
    _along(ax, c, "height", "height (mm)", "height of the point of contact about its mean")


def _mean(ax: Axes, c: LineTestComparison) -> None:
    _by_span(ax, c, "mean")


def _std(ax: Axes, c: LineTestComparison) -> None:
    _by_span(ax, c, "std")


def _by_span(ax: Axes, c: LineTestComparison, name: str) -> None:
    """A figure of each span, and dashed over all that is compared."""
    spans = list(c.by_span)
    series: list[tuple[str, str, Mapping[int, ForceStatistics], ForceStatistics | None]] = [
        ("run", _RUN, c.by_span, c.statistics)
    ]
    for one, colour in zip(c.passes, _colours(c), strict=True):
        series.append((one.name, colour, one.by_span, one.statistics))
    for label, colour, by_span, whole in series:
        values = [getattr(by_span[n], name) if n in by_span else np.nan for n in spans]
        ax.plot(spans, values, "o-", color=colour, markersize=4, linewidth=0.9, label=label)
        if whole:
            ax.axhline(getattr(whole, name), color=colour, linewidth=0.9, linestyle="--")
    ax.plot([], [], "--", color="#777777", linewidth=0.9, label="over all")
    _number_axis(ax, spans)
    style.headroom(ax, 0.3)
    style.legend(ax, 3)
    quantity = FORCE[name]
    style.finish(ax, "span", f"{quantity.short} (N)", f"{quantity.name} {quantity.symbol} span by span")


def _number_axis(ax: Axes, numbers: list[int]) -> None:
    ax.set_xticks(numbers[:: -(-len(numbers) // _MOST_TICKS)])
    ax.set_xlim(min(numbers) - 0.6, max(numbers) + 0.6)


def _spectrum(ax: Axes, c: LineTestComparison) -> None:
    """Amplitudes of the unfiltered forces over what is compared."""
    for one, colour in zip(c.passes, _colours(c), strict=True):
        if one.spectrum:
            frequency, amplitude = one.spectrum
            shown = frequency <= _UP_TO
            ax.plot(frequency[shown], amplitude[shown], color=colour, linewidth=1.0, label=one.name)
    assert c.spectrum
    frequency, amplitude = c.spectrum
    shown = frequency <= _UP_TO
    ax.plot(frequency[shown], amplitude[shown], color=_RUN, linewidth=1.3, label="run")
    ax.axvspan(CUT_OFF, _UP_TO, color="#eeeeee", linewidth=0, label=f"above the filter's {CUT_OFF:g} Hz")
    ax.set_xlim(0, _UP_TO)
    ax.set_ylim(bottom=0)
    style.legend(ax, 2, "upper right")
    style.finish(ax, "frequency (Hz)", "amplitude (N)", "spectrum of the contact force before the filter")


def _uplift(ax: Axes, c: LineTestComparison) -> None:
    numbers = list(c.uplift)
    run, measured = (1e3 * np.array(values) for values in zip(*c.uplift.values(), strict=True))
    at = np.array(numbers, dtype=float)
    for values, offset, colour, label in (
        (run, -0.2, _RUN, "run"),
        (measured, 0.2, style.PANTOGRAPHS[1], "measured"),
    ):
        ax.bar(at + offset, values, width=0.36, color=colour, label=label)
        style.label_row(ax, at + offset, values, [f"{v:.0f}" for v in values], above=2)
    _number_axis(ax, numbers)
    style.headroom(ax, 0.3)
    style.legend(ax, 2)
    style.finish(ax, "support", "largest uplift (mm)", "largest uplift at the supports that were measured")
