"""Reference model of EN 50318:2002 through the public interface, and what is known of its results.

No text of the standard was open to us: ranges and the published result are from secondary sources, the static
values from an independent planar finite-element model.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from numpy.typing import NDArray

import catenary_fe as cf
from catenary_fe.studies.reference_models import NAMES, PUBLISHED, RANGES
from validation.check import Check
from validation.engines import engine
from validation.pictures import label

Floats = NDArray[np.float64]
LAYOUT = Path(__file__).parents[1] / "models" / "layouts" / "en50318_2002.toml"
SOURCE = (
    "EN 50318:2002 (secondary source); in brackets a published result inside the ranges (secondary source)"
)
REASON = (
    "the range that EN 50318:2002 accepts; the error is the distance outside it in units of its half width"
)
APART = ("standard deviation", "statistical maximum", "statistical minimum", "largest uplift at a support")


@dataclass(frozen=True)
class RunData:
    """A run's key figures in the order of NAMES, and its filtered contact force along the line."""

    values: tuple[float, ...]
    x: Floats
    force: Floats


@lru_cache(maxsize=1)
def shape() -> cf.Shape:
    """The model in static equilibrium."""
    return cf.find_form(cf.load_catenary(LAYOUT))


def run(speed_kmh: int) -> RunData:
    """One pantograph of the standard at a speed [km/h]; statistics with the default filter."""
    pantograph = cf.library.pantograph("EN 50318:2002")
    found = cf.simulate(shape(), [pantograph], speed=speed_kmh / 3.6, method=engine())
    s = found.contact_force_statistics()[0]
    values = (s.mean, s.std, s.statistical_max, s.statistical_min, s.max, s.min)
    rest = (1e3 * found.largest_support_uplift(), 100 * s.contact_loss)
    inside = found.window(0)
    x = np.asarray(found.data["position"].values[0])[inside]
    return RunData((*values, *rest), x, found.filtered_contact_force()[0][inside])


def range_checks(data: RunData, speed_kmh: int, *, ranges_of: int) -> list[Check]:
    """Compare with the accepted ranges of a speed."""
    published = [f" ({value:g})" for value in PUBLISHED[ranges_of]] + [""]
    rows = zip(NAMES, data.values, RANGES[ranges_of], published, strict=True)
    return [_range_check(name, unit, value, limits, known) for (name, unit), value, limits, known in rows]


def _range_check(name: str, unit: str, value: float, limits: tuple[float, float], known: str) -> Check:
    lower, upper = limits
    outside = max(lower - value, value - upper, 0.0) / (max(upper - lower, 1.0) / 2)
    return Check(
        quantity=f"{name} in {unit}",
        computed=round(value, 2),
        reference=f"{lower:g} to {upper:g}{known}",
        error=outside,
        tolerance=0.0,
        source=SOURCE,
        passed=outside == 0.0,
        reason=REASON,
        negative_control=name in APART,
    )


def draw_run(data: RunData, speed_kmh: int, figure: Figure) -> None:
    """The filtered force over the evaluated spans, and every figure in its range."""
    figure.set_size_inches(10, 4.5)
    left, right = figure.subplots(1, 2)
    left.plot(data.x, data.force, color="#c1440e", linewidth=1.2)
    label(left, "x in m", "contact force in N, 20 Hz low-pass", f"spans 5 and 6, {speed_kmh} km/h")
    _draw_ranges(right, data, speed_kmh)


def _draw_ranges(ax: Axes, data: RunData, speed_kmh: int) -> None:
    rows = list(zip(NAMES, data.values, RANGES[speed_kmh], PUBLISHED[speed_kmh], strict=False))
    for i, (_, value, (lower, upper), known) in enumerate(rows):
        middle, half = (lower + upper) / 2, (upper - lower) / 2
        ax.plot([-1, 1], [i, i], color="#bbbbbb", linewidth=9, solid_capstyle="butt", zorder=1)
        ax.plot((value - middle) / half, i, "o", color="#c1440e", label="computed" if i == 0 else None)
        ax.plot(
            (known - middle) / half,
            i,
            "k|",
            markersize=10,
            markeredgewidth=1.6,
            label="published" if i == 0 else None,
        )
    ax.set_yticks(
        range(len(rows)), [f"{name}\n{lo:g} to {hi:g} {unit}" for (name, unit), _, (lo, hi), _ in rows]
    )
    label(ax, "place in the accepted range: −1 lower, 1 upper end", "")
    ax.set_xlim(-1.6, 1.6)
    ax.set_ylim(len(rows) - 0.4, -1.3)
    ax.legend(fontsize=7, loc="upper right", ncols=2)
