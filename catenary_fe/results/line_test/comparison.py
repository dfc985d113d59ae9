"""A run beside a line test: statistics, span by span, uplifts, and the verdict on the deviations."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.results.criteria import Criterion
from catenary_fe.results.line_test.band import InBand
from catenary_fe.results.line_test.signals import Place
from catenary_fe.results.line_test.verdict import deviations, pooled
from catenary_fe.results.quantities import FORCE, UPLIFT
from catenary_fe.results.run import Run
from catenary_fe.results.signal import FilterKind
from catenary_fe.results.statistics import ForceStatistics

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class PlacedPass:
    """A pass where it belongs on the run's line.

    name : of the pass
    place : shift and correlation
    x : [m], shape (times,), along the run's line
    force : [N], shape (times,), filtered; None where it was not measured
    height : [m], likewise
    inside : shape (times,), where it is compared
    statistics : over what is compared; None without a force
    by_span : likewise, of each span that is compared as a whole
    height_range : [m] of the filtered height over what is compared; None where it was not measured
    spectrum : [Hz] frequencies and [N] amplitudes of the unfiltered force; None without a force
    rate : [Hz] samples
    speed : [m/s] mean over what is compared
    """

    name: str
    place: Place
    x: Floats
    force: Floats | None
    height: Floats | None
    inside: Bools
    statistics: ForceStatistics | None
    by_span: Mapping[int, ForceStatistics]
    height_range: float | None
    spectrum: tuple[Floats, Floats] | None
    rate: float
    speed: float


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class LineTestComparison:
    """A run beside a line test, both filtered in the same way, over what both have.

    run, pantograph : the run, and the number (from 0) of its pantograph
    filter : which low-pass
    passes : where the train measured along the line; empty where only uplifts were measured
    begin, end : [m] of the line, of what is compared; both 0 without such passes
    statistics : of the run's pantograph over that; None without a measured force
    by_span : likewise, of each evaluated span that lies inside as a whole
    height_range : [m] of the run's point of contact over that, filtered; None without a measured height
    spectrum : [Hz] frequencies and [N] amplitudes of the run's unfiltered force over that; None without one
    uplift : [m] largest of run and measurement at each support that was measured, by its number
    band : what was measured in the bands of a scatter study; None without one
    notes : on what was read, assumed, found and left out
    warnings : on what makes the comparison doubtful
    """

    run: Run
    pantograph: int
    filter: FilterKind
    passes: Sequence[PlacedPass]
    begin: float
    end: float
    statistics: ForceStatistics | None
    by_span: Mapping[int, ForceStatistics]
    height_range: float | None
    spectrum: tuple[Floats, Floats] | None
    uplift: Mapping[int, tuple[float, float]]
    band: InBand | None
    notes: Sequence[str]
    warnings: Sequence[str]

    @property
    def measured(self) -> ForceStatistics | None:
        """Of all passes: mean force, σ in the root mean square, the largest and the smallest of them."""
        return pooled([p.statistics for p in self.passes if p.statistics])

    @property
    def measured_by_span(self) -> dict[int, ForceStatistics]:
        """As :attr:`measured`, of each span."""
        found = {n: pooled([p.by_span[n] for p in self.passes if n in p.by_span]) for n in self.by_span}
        return {n: s for n, s in found.items() if s}

    @property
    def measured_height_range(self) -> float | None:
        """[m] largest of the passes."""
        return max((p.height_range for p in self.passes if p.height_range is not None), default=None)

    @property
    def largest_uplift(self) -> tuple[float, float] | None:
        """[m] of the run and of the measurement, at the supports that were measured."""
        if not self.uplift:
            return None
        run, measured = zip(*self.uplift.values(), strict=True)
        return max(run), max(measured)

    @cached_property
    def criteria(self) -> list[Criterion]:
        """The deviations against the limits of EN 50318's comparison with line tests (recalled)."""
        return deviations(
            self.statistics, self.measured, self.largest_uplift, self.height_range, self.measured_height_range
        )

    def as_dict(self) -> dict[str, Any]:
        """All figures in display units, ready for JSON."""
        run, all_passes = self.statistics, self.measured
        own = {"name": "run", "contact_point_range_mm": _mm(self.height_range), **_figures(run)}
        measured = [
            {
                "name": p.name,
                "shift_m": p.place.shift,
                "correlation": p.place.correlation,
                "samples_per_s": p.rate,
                "speed_kmh": 3.6 * p.speed,
                "contact_point_range_mm": _mm(p.height_range),
                **_figures(p.statistics),
            }
            for p in self.passes
        ]
        return {
            "speed_kmh": round(3.6 * self.run.speed, 9),
            "pantograph": str(self.run.data["pantograph"].values[self.pantograph]),
            "filter": self.filter,
            "compared_from_m": self.begin,
            "compared_to_m": self.end,
            "run": own,
            "passes": measured,
            "all_passes": _figures(all_passes),
            "spans": [
                {"span": n, "run": _figures(s), "measured": _figures(self.measured_by_span[n])}
                for n, s in self.by_span.items()
            ],
            "supports": [
                {"support": n, "run_uplift_mm": UPLIFT.shown(a), "measured_uplift_mm": UPLIFT.shown(b)}
                for n, (a, b) in self.uplift.items()
            ],
            "criteria": [row.as_dict() for row in self.criteria],
            **({"scatter": self.band.as_dict()} if self.band else {}),
            "notes": list(self.notes),
            "warnings": list(self.warnings),
        }


SHOWN = ("mean", "std", "std_0_5", "std_5_20", "statistical_max", "statistical_min", "max", "min")
"""Figures of the contact force that run and measurement are compared by."""


def _figures(s: ForceStatistics | None) -> dict[str, float]:
    return {FORCE[name].key: getattr(s, name) for name in SHOWN} if s else {}


def _mm(value: float | None) -> float | None:
    return None if value is None else 1e3 * value
