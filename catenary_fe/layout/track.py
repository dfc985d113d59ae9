"""The track under a line: curvature in circular and transition curves, cant, and what they do to wires.

Places across the track are those seen from it: y to the left of the centre line of the canted track, z at
right angles to the plane of the rails. The pantograph, whose vehicle stands on that plane, has its centre at
y = 0.
"""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, ValidatorFunctionWrapHandler, WrapValidator
from pydantic_core import PydanticKnownError

from catenary_fe.layout.parameters import Lateral

if TYPE_CHECKING:
    from catenary_fe.layout.catenary import Catenary

Floats = NDArray[np.float64]
MOST_CANT = 0.3  # [m]; railways have up to 0.2 m: an assumption
FARTHEST = 10.0  # [m], of Lateral


def _one_fault(value: Any, handler: ValidatorFunctionWrapHandler) -> Any:
    """Of a number or words, the fault of the one that is meant: pydantic's own union tells of both."""
    if isinstance(value, str):
        if value not in ("follows", "in curves"):
            raise PydanticKnownError("literal_error", {"expected": "a number, 'follows' or 'in curves'"})
    elif isinstance(value, bool) or not isinstance(value, int | float):
        raise PydanticKnownError("float_type")
    elif not isfinite(value):
        raise PydanticKnownError("finite_number")
    elif abs(value) > FARTHEST:
        above = value > 0
        raise PydanticKnownError(
            "less_than_equal" if above else "greater_than_equal",
            {"le": FARTHEST} if above else {"ge": -FARTHEST},
        )
    return handler(value)


Cant = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-MOST_CANT, le=MOST_CANT)]
MessengerStagger = Annotated[Lateral | Literal["follows", "in curves"], WrapValidator(_one_fault)]


def curvatures(catenary: Catenary, x: ArrayLike) -> Floats:
    """[1/m] of the track at places x [m] along the line, positive to the left; linear in each span."""
    at, starts = np.asarray(x, dtype=float), catenary.support_positions
    span = np.clip(np.searchsorted(starts, at) - 1, 0, len(catenary.spans) - 1)
    begin, end = np.array([s.curvatures for s in catenary.spans]).T
    share = (at - starts[span]) / np.diff(starts)[span]
    found: Floats = begin[span] + (end - begin)[span] * share
    return found


def cant_angles(catenary: Catenary) -> Floats:
    """[rad], shape (spans + 1,): by which the track leans to the left at the supports, cant over its base."""
    return np.array([support.cant for support in catenary.supports]) / catenary.cant_base


def lean(catenary: Catenary, x: ArrayLike) -> Floats:
    """[rad] by which the track leans to the left at places x [m] along the line; linear between supports."""
    found: Floats = np.interp(np.asarray(x, dtype=float), catenary.support_positions, cant_angles(catenary))
    return found


def cant_bends(catenary: Catenary, heights: Floats) -> Floats:
    """Shape (spans + 1,): change of direction at the supports of a line at a height above the rail.

    The pantograph's centre at the height z swings to the left by z times the track's lean: where the cant
    begins or ends to rise, its way has a kink. 0 at the line's ends.

    heights : [m], shape (spans + 1,), above the rail
    """
    bends = np.zeros(len(catenary.supports))
    bends[1:-1] = np.diff(np.diff(heights * cant_angles(catenary)) / np.diff(catenary.support_positions))
    return bends


def support_bends(catenary: Catenary) -> Floats:
    """Shape (spans + 1,): change of direction of the contact wire at the supports: stagger, curves, cant.

    The wire is a polygon from support to support, bent to the outside by what the track bends to the inside:
    of the span's curve, linear from κ₁ to κ₂, L (κ₁ + 2 κ₂)/6 at its end and L (2 κ₁ + κ₂)/6 at its
    beginning. 0 at the line's ends.
    """
    lengths = np.array([span.length for span in catenary.spans])
    begin, end = np.array([span.curvatures for span in catenary.spans]).T
    before, after = lengths * (begin + 2 * end) / 6, lengths * (2 * begin + end) / 6
    bends = cant_bends(catenary, catenary.contact_wire_heights)
    bends[1:-1] += np.diff(np.diff(catenary.staggers) / lengths) + before[:-1] + after[1:]
    return bends


def messenger_staggers(catenary: Catenary) -> Floats:
    """[m], shape (spans + 1,): of the messenger wire at the supports.

    One that follows hangs plumb above the contact wire; in a canted track that is to the outside of the
    track's own axis by the system height times its lean.
    """
    heights = catenary.messenger_support_heights - catenary.contact_wire_heights
    drawn = np.array([support.stagger for support in catenary.supports])
    above = drawn - heights * cant_angles(catenary)
    curved = [any(span.curvatures) for span in catenary.spans]
    in_curve = np.array([False, *curved]) | np.array([*curved, False])
    return np.array(
        [
            (above[i] if support.messenger_stagger == "follows" or in_curve[i] else 0.0)
            if isinstance(support.messenger_stagger, str)
            else support.messenger_stagger
            for i, support in enumerate(catenary.supports)
        ]
    )
