"""What a place of a layout, a pantograph or conditions stands for: its members and their nominal values."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel

from catenary_fe.layout.catenary import Catenary
from catenary_fe.layout.conditions import Conditions, over_x
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.files import LayoutFile, load_pantograph
from catenary_fe.layout.variation import CONDITIONS, Variable, kind_of, places_of

Floats = NDArray[np.float64]
AS_BUILT = "as_built."
_ALONG: Mapping[str, Callable[[Catenary], Floats]] = {
    "dropper_length": lambda line: line.dropper_positions,
    "stagger": lambda line: line.support_positions,
    "contact_wire_height": lambda line: line.support_positions,
    "messenger_wire_height": lambda line: line.support_positions,
    "pre_sag": lambda line: (line.support_positions[:-1] + line.support_positions[1:]) / 2,
}
"""Places [m] along the line of each member of a deviation of the line as built."""


@dataclass(frozen=True)
class Members:
    """What a place stands for: one value or several.

    place : as it is written
    places : of each member; all the same where they make up one table over x
    nominal : their values, None where unset
    x : [m] of each member, where they make up a table
    """

    place: str
    places: tuple[str, ...]
    nominal: tuple[Any, ...]
    x: tuple[float, ...] | None = None

    def changes(self, drawn: Sequence[Any]) -> dict[str, Any]:
        """Values by the places that they go to, of one value a member."""
        if self.x is not None:
            return {self.place: [list(pair) for pair in zip(self.x, drawn, strict=True)]}
        return dict(zip(self.places, drawn, strict=True))


def members_of_line(variable: Variable, place: str, *, together: bool = False) -> Members:
    """Members of a place of the layout or the conditions.

    together : of deviations as built, one for the whole line

    Raises InputError for a place that does not exist.
    """
    if kind_of(place) == CONDITIONS:
        return _members(variable.conditions_record, variable.conditions({}) or Conditions(), place)
    if place.startswith(AS_BUILT):
        return _as_built(variable, place, together)
    record = variable.record
    return _members(record, LayoutFile.model_validate(record), place)


def members_of_pantograph(name_or_path: str, place: str) -> Members:
    """Members of a place of a pantograph. Raises InputError for a place that does not exist."""
    pantograph = load_pantograph(name_or_path)
    return _members(pantograph.model_dump(mode="json"), pantograph, place)


def _members(record: dict[str, Any], whole: BaseModel, place: str) -> Members:
    kind = kind_of(place)
    own = places_of(record, place.removeprefix(kind), type(whole))
    return Members(place, tuple(f"{kind}{p}" for p in own), tuple(_nominal(record, whole, p) for p in own))


def _nominal(record: Any, whole: Any, place: str) -> Any:
    """The value that the file has, else the one that it stands for: a default, or the library's."""
    for step in place.split("."):
        if isinstance(whole, BaseModel) and step not in type(whole).model_fields:
            near = difflib.get_close_matches(step, type(whole).model_fields, n=1)
            hint = (
                f"did you mean '{near[0]}'?" if near else f"there are: {', '.join(type(whole).model_fields)}"
            )
            raise InputError(f"{place}: there is no key '{step}'; {hint}")
        record, whole = _inside(record, step), _inside(whole, step)
    return whole if record is None else record


def _inside(holder: Any, step: str) -> Any:
    if isinstance(holder, list | tuple):
        return holder[int(step) - 1]
    return holder.get(step) if isinstance(holder, dict) else getattr(holder, step, None)


def _as_built(variable: Variable, place: str, together: bool) -> Members:
    given = variable.record.get("as_built", {}).get(place.removeprefix(AS_BUILT), 0.0)
    if isinstance(given, dict):
        raise InputError(
            f"scatter: {place}: the layout draws it by chance already; leave it out there, or here"
        )
    along = _ALONG.get(place.removeprefix(AS_BUILT))
    if along is None or (together and not isinstance(given, list)):
        return Members(place, (place,), (given,))
    x = np.unique(along(variable.catenary({})))  # where sections overlap, a place may be there twice
    table = tuple(map(tuple, given)) if isinstance(given, list) else float(given)
    return Members(place, (place,) * x.size, tuple(over_x(table, x).tolist()), tuple(x.tolist()))
