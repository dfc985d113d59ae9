"""Change single values of a layout or pantograph by their place, such as ``support.steady_arm.mass``."""

from __future__ import annotations

import copy
import difflib
import re
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from catenary_fe.system.catenary import Catenary
from catenary_fe.system.errors import InputError
from catenary_fe.system.files import LayoutFile, load_pantograph, read_layout
from catenary_fe.system.pantograph import Pantograph
from catenary_fe.system.parameters import problem_lines

PANTOGRAPH = "pantograph."  # keys of the pantograph start with this


class Variable:
    """A layout file and a pantograph whose values can be replaced by their place.

    A place is written with dots; members of a list by their number from 1, or ``*`` for all:
    ``contact_wire.tension``, ``span.*.pre_sag``, ``pantograph.stages.1.mass``.

    Raises InputError where a file is missing or faulty.
    """

    def __init__(self, layout: str | Path) -> None:
        self._path = Path(layout)
        self._record = read_layout(self._path)

    def catenary(self, values: dict[str, Any]) -> Catenary:
        """The catenary with these values; keys of the pantograph are left out.

        Raises InputError for a place that does not exist and for values that break a rule.
        """
        record = copy.deepcopy(self._record)
        changes = {place: v for place, v in values.items() if not place.startswith(PANTOGRAPH)}
        for place, value in changes.items():
            replace_at(record, place, value)
        said = ", ".join([str(self._path), *(f"{place} = {value!r}" for place, value in changes.items())])
        try:
            return LayoutFile.model_validate(record).catenary()
        except ValidationError as error:
            raise InputError(*problem_lines(error, LayoutFile, where=said)) from None
        except InputError as error:
            raise InputError(*(f"{said}: {line}" for line in error.problems)) from None


def varied_pantograph(name_or_path: str, values: dict[str, Any]) -> Pantograph:
    """A pantograph of the library or a file with these values; keys of the layout are left out.

    Raises InputError for a place that does not exist and for values that break a rule.
    """
    pantograph = load_pantograph(name_or_path)
    changes = {
        place.removeprefix(PANTOGRAPH): v for place, v in values.items() if place.startswith(PANTOGRAPH)
    }
    if not changes:
        return pantograph
    record = pantograph.model_dump(mode="json")
    for place, value in changes.items():
        replace_at(record, place, value)
    said = ", ".join([name_or_path, *(f"{place} = {value!r}" for place, value in changes.items())])
    try:
        return Pantograph.model_validate(record)
    except ValidationError as error:
        raise InputError(*problem_lines(error, Pantograph, where=said)) from None


def replace_at(record: dict[str, Any], place: str, value: Any) -> None:
    """Put a value at a place of nested tables and lists; a table's last key may be new.

    Raises InputError for a place that does not exist.
    """
    *steps, last = place.split(".")
    holders: list[Any] = [record]
    for step in steps:
        holders = [inner for holder in holders for inner in _inside(holder, step, place)]
    for holder in holders:
        if isinstance(holder, dict):
            holder[last] = value
            continue
        for i in _numbers(holder, last, place):
            holder[i] = value


def _inside(holder: Any, step: str, place: str) -> list[Any]:
    if isinstance(holder, dict):
        if step not in holder:
            near = difflib.get_close_matches(step, holder, n=1)
            hint = f"did you mean '{near[0]}'?" if near else f"there are: {', '.join(holder)}"
            raise InputError(f"{place}: no '{step}' to vary a value of; {hint}")
        return [holder[step]]
    return [holder[i] for i in _numbers(holder, step, place)]


def _numbers(holder: Any, step: str, place: str) -> list[int]:
    if not isinstance(holder, list):
        raise InputError(f"{place}: there is a single value where '{step}' is looked for")
    if step == "*":
        return list(range(len(holder)))
    if not (step.isdigit() and 1 <= int(step) <= len(holder)):
        raise InputError(
            f"{place}: '{step}' is not a number from 1 to {len(holder)}, nor * for all of a list's members"
        )
    return [int(step) - 1]


def unit_of(place: str) -> str:
    """Unit of the value at a place, such as "N/m"; empty where it has none."""
    model: type[BaseModel] | None = LayoutFile
    if place.startswith(PANTOGRAPH):
        model, place = Pantograph, place.removeprefix(PANTOGRAPH)
    said = ""
    for step in place.split("."):
        if step == "*" or step.isdigit():
            continue
        field = model.model_fields.get(step) if model else None
        if field is None:
            return ""
        said, model = field.description or "", _model_in(field.annotation)
    found = re.match(r"\[([^\]]+)\]", said)
    return found[1] if found else ""


def _model_in(kind: Any) -> type[BaseModel] | None:
    """The parameters inside a type such as ``tuple[Span, ...] | None``."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        return kind
    return next((model for each in get_args(kind) if (model := _model_in(each))), None)
