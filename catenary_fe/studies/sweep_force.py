"""The contact force along the line, as a sweep's records keep it: at places that are the same in all runs."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import Catenary
from catenary_fe.results import Run
from catenary_fe.results.signal import FilterKind

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
