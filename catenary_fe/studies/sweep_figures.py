"""What a sweep's records keep of a run: its figures to be judged, and perhaps its force along the line."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import Catenary
from catenary_fe.results import ForceStatistics, KeyFigures, Run
from catenary_fe.results.quantities import LATERAL, UPLIFT
from catenary_fe.results.signal import FilterKind

if TYPE_CHECKING:
    from catenary_fe.studies.sweep import SweepCase
    from catenary_fe.studies.sweep_store import Record

Floats = NDArray[np.float64]
STEP = 0.5  # [m] at 300 km/h a wave of 20 Hz has 8 of them
_DIGITS = 2  # after the point of a newton


def places(catenary: Catenary) -> Floats:
    """[m] along the evaluated spans, every half a metre from the first one's begin."""
    supports, spans = catenary.support_positions, catenary.spans_to_evaluate
    begin, end = supports[min(spans) - 1], supports[max(spans)]
    x = begin + STEP * np.arange(int((end - begin) / STEP + 1e-9) + 1)
    numbers = np.clip(np.searchsorted(supports, x, side="right"), 1, supports.size - 1)
    found: Floats = x[np.isin(numbers, list(spans)) | np.isin(x, supports[list(spans)])]
    return found


def force_along(run: Run, filter: FilterKind) -> dict[str, Any]:
    """``x`` [m], shape (places,), and ``values`` [N], shape (pantographs, places), low-passed at 20 Hz."""
    x = places(run.catenary)
    rows = zip(run.data["position"].values, run.filtered_contact_force(filter), strict=True)
    values = [np.round(np.interp(x, position, force), _DIGITS).tolist() for position, force in rows]
    return {"x": x.tolist(), "values": values}


def key_figures_of(record: Record, case: SweepCase) -> KeyFigures:
    """What is judged of a run, by what is kept of it."""
    summary = record["summary"]
    return KeyFigures(
        speed=case.speed,
        catenary=case.catenary,
        pantographs=case.pantographs,
        statistics=[ForceStatistics.from_dict(each, summary["filter"]) for each in summary["pantographs"]],
        lateral=[None if y is None else LATERAL.si(y) for y in summary.get("contact_lateral_mm", [])],
        uplift={int(n): UPLIFT.si(lift) for n, lift in summary["support_uplift_mm"].items()},
    )
