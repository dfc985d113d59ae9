"""Pictures of a sweep: figures and verdicts against what was varied, and envelopes along the line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import ArrayLike

from catenary_fe.layout import target_mean_force
from catenary_fe.layout.current_collection import DEVIATION_SHARE
from catenary_fe.layout.variation import unit_of
from catenary_fe.results.quantities import UPLIFT
from catenary_fe.views import style

Rows = Sequence[Mapping[str, Any]]
_CRITERION: dict[str, Any] = {"color": "#222222", "linewidth": 1.1}
_OWN_UNITS = {"speed_kmh": "km/h", "distance_m": "m"}
_MOST_PANELS = 6
_VERDICTS = ((0.0, "#2d6a35"), (0.8, "#a9c79a"), (1.0, "#f3d9a0"), (1.0, "#d98880"), (1.5, "#8b1a1a"))


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


@style.styled
def plot_verdicts(cases: Rows, x: str, *, ax: Axes | None = None) -> Axes:
    """The largest share of each criterion's limit at each value of ``x``, over all else that was varied.

    cases : of a sweep's record, with ``values`` and ``criteria``
    x : along the horizontal axis
    """
    places = sorted({case["values"][x] for case in cases})
    shares: dict[str, dict[float, float]] = {}
    for case in cases:
        for row in case["criteria"]:
            if row["used"] is not None:
                worst = shares.setdefault(row["name"], {})
                at = case["values"][x]
                worst[at] = max(worst.get(at, 0.0), share_of_limit(row))
    table = np.array([[own.get(at, np.nan) for at in places] for own in shares.values()])
    ax = style.new_axes(ax, (min(14.0, 4.5 + 0.62 * len(places)), 1.5 + 0.42 * len(shares)))
    ax.imshow(table, aspect="auto", cmap=_shares(), vmin=0.0, vmax=_VERDICTS[-1][0])
    for (i, j), share in np.ndenumerate(table):
        if np.isfinite(share) and len(places) <= 24:
            text = f"{100 * share:.0f}" if share < 10 else ">999"
            ax.text(j, i, text, ha="center", va="center", fontsize=7, color=_ink(share))
    every = -(-len(places) // 24)
    ax.set_xticks(np.arange(len(places))[::every], [f"{at:g}" for at in places[::every]])
    ax.set_yticks(np.arange(len(shares)), list(shares), fontsize=8)
    for i, own in enumerate(shares.values()):
        if max(own.values()) > 1:
            ax.get_yticklabels()[i].set_color("#8b1a1a")
    style.finish(ax, place_title(x), "", "Largest share of each limit in % (red: missed)")
    ax.grid(visible=False)
    return ax


def share_of_limit(row: Mapping[str, Any]) -> float:
    """Of a judged criterion, above 1 only where it is missed: some have a tolerance."""
    used: float = row["used"]
    return used if row["passed"] is False else min(used, 1.0)


def _shares() -> Any:
    """Green to sand up to the limit, red beyond it."""
    from matplotlib.colors import LinearSegmentedColormap

    most = _VERDICTS[-1][0]
    return LinearSegmentedColormap.from_list("shares", [(at / most, colour) for at, colour in _VERDICTS])


def _ink(share: float) -> str:
    return "white" if share < 0.4 or share > 1.25 else "black"


@style.styled
def plot_force_envelopes(cases: Rows, x: str | None, supports: ArrayLike | None = None) -> Axes:
    """The contact force along the line, all cases of one value of ``x`` in a panel, with their envelope.

    cases : of a sweep's record, with ``values`` and ``force``: ``x`` [m], ``values`` [N] of each pantograph
    x : what tells the panels apart; unset: one panel. Of more than six values, six of them are drawn
    supports : [m] places of supports to mark; unset: none

    Returns the axes of the first panel.
    """
    groups: dict[Any, list[Mapping[str, Any]]] = {}
    for case in cases:
        groups.setdefault(case["values"][x] if x else None, []).append(case["force"])
    keys = sorted(groups) if x else [None]
    chosen = dict.fromkeys(np.linspace(0, len(keys) - 1, min(len(keys), _MOST_PANELS)).round().astype(int))
    shown = [keys[i] for i in chosen]
    panels = style.new_panels((11.0, 1.2 + 2.4 * len(shown)), [1] * len(shown))
    for ax, key in zip(panels, shown, strict=True):
        _draw_envelope(ax, groups[key], supports)
        title = f"{_named(x, key)}" if x else "Contact force of all cases"
        along = style.ALONG if ax is panels[-1] else ""
        style.finish(ax, along, "contact force\n0 to 20 Hz (N)", title)
    style.headroom(panels[0], 0.2)
    style.legend(panels[0], 4)
    return panels[0]


def _draw_envelope(ax: Axes, forces: Rows, supports: ArrayLike | None) -> None:
    """Lowest, highest and mean values where there are several curves; themselves where there are few."""
    curves = [(np.array(f["x"]), np.array(own)) for f in forces for own in f["values"]]
    grid = np.unique(np.concatenate([at for at, _ in curves]))
    there = np.array([np.interp(grid, at, own, left=np.nan, right=np.nan) for at, own in curves])
    inside = [p for p in np.asarray(supports if supports is not None else ()) if grid[0] <= p <= grid[-1]]
    style.mark_supports(ax, inside)
    if len(curves) > 1:
        low, high = np.nanmin(there, axis=0), np.nanmax(there, axis=0)
        ax.fill_between(grid, low, high, color=style.PANTOGRAPHS[0], alpha=0.2, linewidth=0, label="envelope")
        ax.plot(grid, np.nanmean(there, axis=0), color=style.PANTOGRAPHS[0], linewidth=1.2, label="mean")
    if len(curves) <= len(style.PANTOGRAPHS):
        for n, (at, own) in enumerate(curves):
            name = f"force {n + 1}" if len(curves) > 1 else "force"
            ax.plot(at, own, color=style.pantograph_colour(n), linewidth=0.8, label=name)
    ax.margins(x=0.01)


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
    name, _, unit = place_title(key).partition(" (")
    return f"{name} {text} {unit.removesuffix(')')}".rstrip()


def place_title(key: str) -> str:
    """What is varied, as axes name it, with its unit."""
    unit = _OWN_UNITS.get(key) or unit_of(key)
    name = {"speed_kmh": "speed", "distance_m": "distance"}.get(key) or key.replace("_", " ").replace(
        ".", ", "
    )
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
    style.finish(ax, place_title(x), y, f"{what} against {place_title(x)}")
    return style.note_failed(ax, checks, f" in {len(failing)} of {len(rows)} rows")
