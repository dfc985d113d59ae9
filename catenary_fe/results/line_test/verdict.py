"""Deviations of a run from a line test against their limits, and what makes a comparison doubtful."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from catenary_fe.results.criteria import Criterion
from catenary_fe.results.quantities import FORCE, UPLIFT
from catenary_fe.results.statistics import ForceStatistics

if TYPE_CHECKING:
    from catenary_fe.results.line_test.comparison import PlacedPass

MEAN_LIMIT = 2.5  # [N]
DEVIATION_LIMIT = 0.20  # of the measured σ
UPLIFT_LIMIT = 0.20  # of the measured largest uplift
LEAST_SPANS, LEAST_LENGTH = 22, 1000.0  # [m] either of them, of a line test
SPEEDS_APART = 0.02  # of the run's, by which a pass may be faster or slower without a word
_SOURCE = "EN 50318:2018, line tests (recalled)"


def pooled(passes: Sequence[ForceStatistics]) -> ForceStatistics | None:
    """Of several passes: mean force, standard deviations in the root mean square, largest and smallest."""
    if not passes:
        return None
    mean = float(np.mean([s.mean for s in passes]))
    std, slow, fast = (
        float(np.sqrt(np.mean([getattr(s, name) ** 2 for s in passes])))
        for name in ("std", "std_0_5", "std_5_20")
    )
    return replace(
        passes[0],
        pantograph="all passes" if len(passes) > 1 else passes[0].pantograph,
        mean=mean,
        std=std,
        std_0_5=slow,
        std_5_20=fast,
        statistical_max=mean + 3 * std,
        statistical_min=mean - 3 * std,
        max=max(s.max for s in passes),
        min=min(s.min for s in passes),
    )


def deviations(
    run: ForceStatistics | None,
    measured: ForceStatistics | None,
    uplift: tuple[float, float] | None,
    height_range: float | None,
    measured_range: float | None,
) -> list[Criterion]:
    """A row for each deviation, without its sign.

    uplift, height_range, measured_range : [m]
    """
    rows = []
    if run and measured:
        rows.append(_row(FORCE["mean"].name, abs(run.mean - measured.mean), MEAN_LIMIT, "N"))
        rows.append(_share(FORCE["std"].name, run.std, measured.std, DEVIATION_LIMIT))
    if uplift:
        rows.append(_share(UPLIFT.name, *uplift, UPLIFT_LIMIT))
    if height_range is not None and measured_range is not None:
        name = FORCE["contact_point_range"].name
        rows.append(_row(name, 1e3 * abs(height_range - measured_range), None, "mm"))
    return rows


def _share(name: str, run: float, measured: float, limit: float) -> Criterion:
    """Of the measured value; where that is nothing, there is no share, and the limit is missed."""
    share = abs(run - measured) / measured if measured > 0 else 1.0
    return _row(name, 100 * share, 100 * limit, "%")


def _row(name: str, value: float, limit: float | None, unit: str) -> Criterion:
    return Criterion(
        name=f"deviation of the {name}",
        value=value,
        limit=limit,
        unit=unit,
        source="no limit known here" if limit is None else _SOURCE,
        recalled=limit is not None,
    )


def warnings_of(
    passes: Sequence[PlacedPass], speed: float, spans: Sequence[int], length: float, found: bool
) -> list[str]:
    """What makes a comparison of passes doubtful.

    speed : [m/s] of the run
    spans : that are compared as a whole
    length : [m] that is compared
    found : whether the shifts were found, not given
    """
    said = []
    if passes and len(spans) < LEAST_SPANS and length <= LEAST_LENGTH:
        said.append(
            f"{length:.0f} m and {len(spans)} whole spans are compared: EN 50318 asks for {LEAST_SPANS} spans"
            f" or more than {LEAST_LENGTH:g} m (recalled)"
        )
    for p in passes:
        if abs(p.speed / speed - 1) > SPEEDS_APART:
            said.append(
                f"{p.name}: measured at {3.6 * p.speed:.1f} km/h, the run is at {3.6 * speed:.1f} km/h:"
                " compare with a run at the speed that was measured"
            )
        if found and p.place.other:
            at, r = p.place.other
            said.append(
                f"{p.name}: the shift of {p.place.shift:.2f} m is not the only one: at {at:.2f} m the"
                f" correlation is {r:.3f}, here {p.place.correlation:.3f}; give the shift if you know it"
            )
    return said
