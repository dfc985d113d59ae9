"""Pictures of a study's samples: bands over speed, histograms, bands of the force, what matters most."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.layout.variation import unit_of
from catenary_fe.results.quantities import FORCE, UPLIFT, Quantity
from catenary_fe.views import style

Rows = Sequence[Mapping[str, Any]]
_SHOWN = FORCE["mean"], FORCE["std"], FORCE["max"], UPLIFT
_NOMINAL = "#222222"
_BINS = 20


@style.styled
def plot_scatter(rows: Rows, bands: Rows) -> Axes:
    """Mean, standard deviation, maximum and uplift: bands over speed, or histograms of one speed.

    rows, bands : of what :func:`catenary_fe.run_scatter` returned

    Returns the axes of the mean.
    """
    panels = _grid(2, 2, (11.0, 7.0))
    groups = _groups(bands)
    several = len({band["speed_kmh"] for band in bands}) > 1
    for ax, q in zip(panels, _SHOWN, strict=True):
        (_bands_over_speed if several else _histograms)(ax, rows, bands, groups, q)
        title = f"{q.name}, {max(band['samples'] for band in bands)} samples"
        style.finish(ax, "speed (km/h)" if several else q.label, q.label if several else "samples", title)
    panels[0].legend(fontsize=7, frameon=False)
    return panels[0]


def _grid(rows: int, columns: int, size: tuple[float, float]) -> list[Axes]:
    figure = style.Picture(figsize=size, layout="constrained")
    return list(np.ravel(figure.subplots(rows, columns, squeeze=False)))


def _groups(rows: Rows) -> list[tuple[str, int]]:
    """Pantographs and their numbers."""
    return list(dict.fromkeys((row["pantograph"], row["number"]) for row in rows))


def _named(group: tuple[str, int], groups: Sequence[tuple[str, int]]) -> str:
    """What tells a pantograph from the others; empty where there is one."""
    several = len({number for _, number in groups}) > 1
    return (f"{group[0]}{f', no. {group[1]}' if several else ''}: ") if len(groups) > 1 else ""


def _bands_over_speed(
    ax: Axes, rows: Rows, bands: Rows, groups: Sequence[tuple[str, int]], q: Quantity
) -> None:
    for group, colour in zip(groups, style.distinct(len(groups)), strict=True):
        own = [b for b in bands if b["figure"] == q.key and (b["pantograph"], b["number"]) == group]
        own.sort(key=lambda band: band["speed_kmh"])
        speed = [band["speed_kmh"] for band in own]
        low, middle, high, nominal = (
            np.array([np.nan if band[key] is None else band[key] for band in own])
            for key in ("low_5", "median", "high_95", "nominal")
        )
        name = _named(group, groups)
        ax.fill_between(speed, low, high, color=colour, alpha=0.18, linewidth=0, label=f"{name}5 to 95 %")
        ax.plot(speed, middle, "-", color=colour, label=f"{name}median")
        ax.plot(speed, nominal, "o", color=colour, markerfacecolor="white", label=f"{name}nominal")


def _histograms(ax: Axes, rows: Rows, bands: Rows, groups: Sequence[tuple[str, int]], q: Quantity) -> None:
    good = [row for row in rows if not row["error"] and row["sample"]]
    everything = np.array([row[q.key] for row in good], dtype=float)
    bins = np.histogram_bin_edges(everything, bins=min(_BINS, max(5, everything.size // 5)))
    for group, colour in zip(groups, style.distinct(len(groups)), strict=True):
        name = _named(group, groups)
        own = [row[q.key] for row in good if (row["pantograph"], row["number"]) == group]
        ax.hist(own, bins=bins.tolist(), color=colour, alpha=0.45, label=f"{name}samples")
        band = next(b for b in bands if b["figure"] == q.key and (b["pantograph"], b["number"]) == group)
        if band["nominal"] is not None:
            ax.axvline(band["nominal"], color=colour, linewidth=1.4, label=f"{name}nominal")
        for i, key in enumerate(("low_5", "high_95")):
            label = f"{name}5 and 95 %" if i == 0 else None
            ax.axvline(band[key], color=colour, linewidth=1.0, linestyle="--", label=label)


_MOST_PANELS = 6


@style.styled
def plot_force_bands(bands: Rows, supports: NDArray[np.float64] | None = None) -> Axes:
    """The contact force along the line: nominal, median and 5 to 95 % at each place, a panel a speed.

    bands : ``force`` of what :func:`catenary_fe.run_scatter` returned; the first six are drawn
    supports : [m] places of supports to mark; unset: none

    Returns the axes of the first one.
    """
    shown = bands[:_MOST_PANELS]
    panels = style.new_panels((11.0, 1.2 + 2.5 * len(shown)), [1] * len(shown))
    groups = _groups(bands)
    for n, (ax, band) in enumerate(zip(panels, shown, strict=True)):
        x = band["x"]
        colour = style.pantograph_colour(groups.index((band["pantograph"], band["number"])))
        inside = [p for p in (supports if supports is not None else ()) if x[0] - 1e-6 <= p <= x[-1] + 1e-6]
        style.mark_supports(ax, inside)
        ax.fill_between(x, band["low_5"], band["high_95"], color=colour, alpha=0.2, linewidth=0,
                        label="5 to 95 %")  # fmt: skip
        ax.plot(x, band["median"], color=colour, linewidth=1.1, label="median")
        if band["nominal"] is not None:
            ax.plot(x, band["nominal"], color=_NOMINAL, linewidth=0.9, linestyle="--", label="nominal")
        ax.margins(x=0.01)
        name = _named((band["pantograph"], band["number"]), groups)
        if n == 0:
            style.headroom(ax, 0.2)
            style.legend(ax, 5)
        style.finish(
            ax,
            style.ALONG if n == len(shown) - 1 else "",
            "contact force\n0 to 20 Hz (N)",
            f"{name}{band['speed_kmh']:g} km/h",
        )
    return panels[0]


@style.styled
def plot_scatter_inputs(rows: Rows, places: Sequence[str]) -> Axes:
    """The standard deviation of each sample over each value that scatters, one colour a speed.

    rows : of what :func:`catenary_fe.run_scatter` returned
    places : that have one value a sample

    Returns the axes of the first place.
    """
    columns = min(3, len(places))
    lines = -(-len(places) // columns)
    panels = _grid(lines, columns, (3.8 * columns + 0.4, 3.2 * lines + 0.4))
    good = [row for row in rows if not row["error"] and row["sample"]]
    speeds = sorted({row["speed_kmh"] for row in good})
    for ax, place in zip(panels, places, strict=False):
        unit = unit_of(place)
        for speed, colour in zip(speeds, style.distinct(len(speeds)), strict=True):
            own = [(row[place], row["std_N"]) for row in good if row["speed_kmh"] == speed]
            ax.plot(*zip(*own, strict=True), "o", color=colour, markersize=3, alpha=0.6, markeredgewidth=0,
                    label=f"{speed:g} km/h")  # fmt: skip
        style.finish(ax, f"{place} ({unit})" if unit else place, "σ (N)", "")
    for ax in panels[len(places) :]:
        ax.set_axis_off()
    panels[0].legend(fontsize=7)
    return panels[0]


@style.styled
def plot_sensitivity(rows: Rows, pantograph: str, number: int = 1) -> Axes:
    """Share of the variance that each place brings: total as bars, alone as points, 95 % confidence.

    rows : ``sensitivity`` of what :func:`catenary_fe.run_scatter` returned
    pantograph, number : whose runs

    Returns the axes of the standard deviation.
    """
    own = [row for row in rows if (row["pantograph"], row["number"]) == (pantograph, number)]
    figures = list(dict.fromkeys(row["figure"] for row in own))
    places = list(dict.fromkeys(row["input"] for row in own))
    speeds = sorted({row["speed_kmh"] for row in own})
    names = {q.key: q.name for q in _SHOWN}
    panels = _grid(2, 2, (11.5, 2.4 + 0.55 * len(places) * 2 + 0.25 * len(speeds)))
    thick = 0.8 / len(speeds)
    for ax, figure in zip(panels, figures, strict=True):
        for n, (speed, colour) in enumerate(zip(speeds, style.distinct(len(speeds)), strict=True)):
            bars = {r["input"]: r for r in own if (r["figure"], r["speed_kmh"]) == (figure, speed)}
            at = np.arange(len(places)) + (n - (len(speeds) - 1) / 2) * thick
            for kind, shift in (("total", 0.15), ("first_order", -0.15)):
                value, low, high = (
                    np.array([bars[place][f"{kind}{end}"] for place in places])
                    for end in ("", "_at_least", "_at_most")
                )
                errors = np.maximum([value - low, high - value], 0.0)
                if kind == "total":
                    ax.barh(at, value, 0.9 * thick, color=colour, alpha=0.45, label=f"{speed:g} km/h, total")
                else:
                    ax.plot(value, at + shift * thick, "o", color=colour, markersize=4,
                            label=f"{speed:g} km/h, alone")  # fmt: skip
                ax.errorbar(
                    value, at + shift * thick, xerr=errors, ecolor=_NOMINAL, elinewidth=0.8, fmt="none"
                )
        ax.set_yticks(np.arange(len(places)), places, fontsize=7)
        ax.invert_yaxis()
        ax.axvline(0.0, color=_NOMINAL, linewidth=0.8)
        style.finish(ax, "share of the variance, with 95 % confidence", "", names[figure])
    panels[-1].legend(fontsize=7)
    return panels[0]
