"""Pictures of several runs: over one another, and of a sweep, its figures against what was varied."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.layout import target_mean_force
from catenary_fe.layout.current_collection import DEVIATION_SHARE
from catenary_fe.layout.variation import unit_of
from catenary_fe.results import Run
from catenary_fe.results.quantities import UPLIFT, in_short
from catenary_fe.results.signal import FilterKind
from catenary_fe.views import style

Floats = NDArray[np.float64]
Rows = Sequence[Mapping[str, Any]]
_CRITERION: dict[str, Any] = {"color": "#222222", "linewidth": 1.1}


@style.styled
def plot_force_comparison(
    runs: Sequence[Run], labels: Sequence[str], *, filter: FilterKind = "causal"
) -> Axes:
    """Contact forces of each run's first pantograph along the line, and below their differences to the first.

    Returns the axes of the forces; the differences are in the axes below it. Supports are the first run's.
    """
    figure = style.Picture(figsize=(11.0, 6.4), layout="constrained")
    force, difference = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    curves = [_force(run, filter) for run in runs]
    first_x, first = curves[0]
    for axes in (force, difference):
        style.mark_supports(axes, runs[0].data["support_position"].values, label=axes is force)
    colours = style.distinct(len(runs))
    for i, ((x, values), label, colour) in enumerate(zip(curves, labels, colours, strict=True)):
        statistics = runs[i].contact_force_statistics(filter=filter)[0]
        name = f"{label}: {in_short(statistics, ('mean', 'std'))}"
        force.plot(x, values, color=colour, linewidth=1.1, label=name)
        if i:
            there = np.interp(first_x, x, values, left=np.nan, right=np.nan)
            difference.plot(
                first_x, there - first, color=colour, linewidth=1.1, label=f"{label} − {labels[0]}"
            )
    for axes in (force, difference):
        style.headroom(axes, 0.2)
        style.legend(axes, 3)
        axes.margins(x=0.01)
    style.finish(force, "", "contact force\n0 to 20 Hz (N)", "Contact force of the first pantographs")
    style.finish(difference, style.ALONG, "difference (N)", "")
    chosen: Axes = note_all_failed(force, runs, labels)
    return chosen


@style.styled
def plot_uplift_comparison(runs: Sequence[Run], labels: Sequence[str], *, ax: Axes | None = None) -> Axes:
    """Largest uplift at each support of each run."""
    ax = style.new_axes(ax)
    for run, label, colour in zip(runs, labels, style.distinct(len(runs)), strict=True):
        x = run.data["support_position"].values[1:-1]
        by_support = run.uplift_by_support(range(1, x.size + 2))
        uplift = [1e3 * lift for lift in list(by_support.values())[1:-1]]
        ax.plot(x, uplift, "o-", color=colour, linewidth=0.8, markersize=5, label=label)
    ax.set_ylim(bottom=0)
    style.headroom(ax, 0.2)
    style.legend(ax)
    style.finish(ax, style.ALONG, "largest uplift (mm)", "Largest uplift at the supports")
    return note_all_failed(ax, runs, labels)


def note_all_failed(ax: Axes, runs: Sequence[Run], labels: Sequence[str]) -> Axes:
    """Say under the title which run fails which checks."""
    for run, label in zip(runs, labels, strict=True):
        style.note_failed(ax, run.failed_checks, f" by {label}")
    return ax


def _force(run: Run, filter: FilterKind) -> tuple[Floats, Floats]:
    return np.asarray(run.data["position"].values[0]), run.filtered_contact_force(filter)[0]


@style.styled
def plot_sweep_forces(rows: Rows, x: str, by: Sequence[str] = (), *, ax: Axes | None = None) -> Axes:
    """Mean force, mean ± 3σ and actual extremes against ``x``, one colour for each combination of ``by``.

    rows : of a sweep's table, without failed cases
    x : column along the horizontal axis
    by : columns that tell the curves apart
    """
    ax = style.new_axes(ax, (10.0, 5.6))
    for colour, name, curve in _curves(rows, x, by):
        at = _column(curve, x)
        ax.plot(at, _column(curve, "mean_N"), "o-", color=colour, markersize=4, label=f"{name}mean")
        low, high = _column(curve, "statistical_min_N"), _column(curve, "statistical_max_N")
        ax.fill_between(at, low, high, color=colour, alpha=0.12, label=f"{name}mean ± 3σ")
        ax.plot(at, _column(curve, "min_N"), "v:", color=colour, markersize=4, linewidth=0.8)
        ax.plot(at, _column(curve, "max_N"), "^:", color=colour, markersize=4, linewidth=0.8)
    ax.plot([], [], "^:", color="#777777", markersize=4, label="actual maximum")
    ax.plot([], [], "v:", color="#777777", markersize=4, label="actual minimum")
    if x == "speed_kmh":
        speeds = np.linspace(*_ends(rows, x), 100)
        means = [target_mean_force("EN 50367 AC", v / 3.6) for v in speeds]
        ax.plot(speeds, means, "--", **_CRITERION, label="largest mean force, EN 50367 AC")
    ax.axhline(0.0, **_CRITERION, linestyle=":", label="mean − 3σ must stay above 0")
    return _finished(ax, rows, x, "contact force, 0 to 20 Hz (N)", "Contact force")


@style.styled
def plot_sweep_deviation(rows: Rows, x: str, by: Sequence[str] = (), *, ax: Axes | None = None) -> Axes:
    """Standard deviation against ``x`` with the largest one that is allowed, a share of the mean force."""
    ax = style.new_axes(ax, (10.0, 4.6))
    for colour, name, curve in _curves(rows, x, by):
        at = _column(curve, x)
        ax.plot(at, _column(curve, "std_N"), "o-", color=colour, markersize=4, label=f"{name}σ")
        most = DEVIATION_SHARE * _column(curve, "mean_N")
        allowed = f"{name}{DEVIATION_SHARE:g} of the mean, the most allowed"
        ax.plot(at, most, "--", color=colour, linewidth=1.1, label=allowed)
    ax.set_ylim(bottom=0.0)
    return _finished(ax, rows, x, "σ of the contact force, 0 to 20 Hz (N)", "Standard deviation")


@style.styled
def plot_sweep_uplift(rows: Rows, x: str, by: Sequence[str] = (), *, ax: Axes | None = None) -> Axes:
    """Largest uplift at a support of the evaluated spans against ``x``."""
    ax = style.new_axes(ax, (10.0, 4.2))
    for colour, name, curve in _curves(rows, x, by):
        values = _column(curve, UPLIFT.key)
        ax.plot(_column(curve, x), values, "o-", color=colour, markersize=4, label=f"{name}uplift")
    ax.set_ylim(bottom=0.0)
    return _finished(ax, rows, x, UPLIFT.label, "Uplift")


def _curves(rows: Rows, x: str, by: Sequence[str]) -> list[tuple[str, str, list[Mapping[str, Any]]]]:
    """Colour, name and rows of each curve, in the order of ``x``."""
    several = any(row.get("number", 1) > 1 for row in rows)
    curves: dict[str, list[Mapping[str, Any]]] = {}
    for row in rows:
        parts = [_named(key, row[key]) for key in by]
        if several:
            parts.append(f"pantograph {row['number']}")
        name = ", ".join(parts)
        curves.setdefault(f"{name}: " if name else "", []).append(row)
    colours = style.distinct(len(curves))
    return [
        (colour, name, sorted(curve, key=lambda row: row[x]))
        for colour, (name, curve) in zip(colours, curves.items(), strict=True)
    ]


def _named(key: str, value: Any) -> str:
    text = f"{value:g}" if isinstance(value, float) else str(value)
    if key == "pantograph":
        return text
    name, _, unit = _title(key).partition(" (")
    return f"{name} {text} {unit.removesuffix(')')}".rstrip()


def _title(key: str) -> str:
    unit = "km/h" if key == "speed_kmh" else unit_of(key)
    name = "speed" if key == "speed_kmh" else key.replace("_", " ").replace(".", ", ")
    return f"{name} ({unit})" if unit else name


def _column(curve: Rows, key: str) -> Any:
    return np.array([row[key] for row in curve], dtype=float)


def _ends(rows: Rows, x: str) -> tuple[float, float]:
    values = [row[x] for row in rows]
    return min(values), max(values)


def _finished(ax: Axes, rows: Rows, x: str, y: str, what: str) -> Axes:
    names = ax.get_legend_handles_labels()[1]
    if len(names) <= 12:
        columns = max(1, min(3, int(145 / (8 + max(map(len, names))))))  # of a figure 10 inches wide
        style.headroom(ax, 0.09 * (1 - (-len(names) // columns)))
        style.legend(ax, columns)
    else:
        ax.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), fontsize=7)
    failing = [row for row in rows if row.get("checks_failed")]
    checks = [name for row in failing for name in str(row["checks_failed"]).split("; ")]
    style.finish(ax, _title(x), y, f"{what} against {_title(x)}")
    return style.note_failed(ax, checks, f" in {len(failing)} of {len(rows)} rows")
