"""Where a solve failed, in words of the line: which pantograph, dropper and support."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import Catenary

Floats = NDArray[np.float64]


def place_of_heads(supports: Floats, positions: Sequence[float] | Floats) -> str:
    """Where the pantographs are: position, span, and the support next to it.

    supports, positions : [m] along the track
    """
    texts = []
    for i, x in enumerate(positions, start=1):
        span = min(max(int(np.searchsorted(supports, x)), 1), supports.size - 1)
        nearest = int(np.abs(supports - x).argmin())
        gap = x - supports[nearest]
        side = "behind" if gap >= 0 else "before"
        texts.append(
            f"pantograph {i} at {x:.1f} m, in span {span}, {abs(gap):.1f} m {side} support {nearest + 1}"
        )
    return "; ".join(texts)


def smaller_steps(
    supports: Floats, positions: Sequence[float] | Floats, time: float, parts: int, lasted: float
) -> str:
    """A warning that steps were divided: when [s], into how many parts, for how long [ms], and where."""
    return (
        f"no convergence with the time step at {time:.4f} s, {place_of_heads(supports, positions)}: the"
        f" {lasted:g} ms from there are computed in steps of 1/{parts} of it; if the force is rough there,"
        " take a smaller time step for all of the run"
    )


def most_strained(
    catenary: Catenary, positions: Sequence[float] | Floats, forces: Floats, before: Floats
) -> str:
    """The dropper near a pantograph whose force changed most, with what it is; empty without droppers.

    forces, before : [N], shape (droppers,), at the last step and at the start
    """
    at = catenary.dropper_positions
    if not at.size:
        return ""
    reach = max(span.length for span in catenary.spans)
    near = np.abs(at[:, None] - np.asarray(positions)).min(axis=1) <= reach
    change = np.where(near, np.abs(forces - before), -1.0)
    i = int(change.argmax())
    dropper, span = catenary.droppers[i], catenary.dropper_spans[i]
    place = at[i] - catenary.support_positions[span - 1]
    return (
        f"most strained there: the dropper of span {span} at {place:g} m ({dropper.stiffness:g} N/m), from"
        f" {before[i]:.0f} N at the start to {forces[i]:.0f} N"
    )
