"""Change single values of a layout or pantograph by their place, such as ``support.steady_arm.mass``."""

from __future__ import annotations

import copy
import difflib
import re
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from catenary_fe.layout.catenary import Catenary
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.files import LayoutFile, fault_lines, load_pantograph
from catenary_fe.layout.pantograph import DescribedPantograph
from catenary_fe.layout.parameters import problem_lines
from catenary_fe.layout.toml import read_toml

PANTOGRAPH = "pantograph."  # keys of the pantograph start with this


class Variable:
    """A layout file and a pantograph whose values can be replaced by their place.

    A place is written with dots; members of a list by their number from 1, or ``*`` for all:
    ``contact_wire.tension``, ``span.*.pre_sag``, ``pantograph.stages.1.mass``.

    Raises InputError where a file is missing or faulty.
    """

    def __init__(self, layout: str | Path) -> None:
        self._path = Path(layout)
        self._record = read_toml(self._path, "layout")

    def catenary(self, values: dict[str, Any]) -> Catenary:
        """The catenary with these values; keys of the pantograph are left out.

        Raises InputError for a place that does not exist and for values that break a rule.
        """
        record = copy.deepcopy(self._record)
        changes = {place: v for place, v in values.items() if not place.startswith(PANTOGRAPH)}
        said = _changed(record, str(self._path), changes)
        try:
            return LayoutFile.model_validate(record).catenary()
        except ValidationError as error:
            raise InputError(*(f"{said}: {line}" for line in fault_lines(error, record))) from None
        except InputError as error:
            raise InputError(*(f"{said}: {line}" for line in error.problems)) from None


def varied_pantograph(name_or_path: str, values: dict[str, Any]) -> DescribedPantograph:
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
    said = _changed(record, name_or_path, changes)
    try:
        return type(pantograph).model_validate(record)
    except ValidationError as error:
        raise InputError(*problem_lines(error, type(pantograph), where=said)) from None


def _changed(record: dict[str, Any], name: str, changes: dict[str, Any]) -> str:
    """Put values in their places; returns name and changes in words."""
    for place, value in changes.items():
        replace_at(record, place, value)
    return ", ".join([name, *(f"{place} = {value!r}" for place, value in changes.items())])


def replace_at(record: dict[str, Any], place: str, value: Any) -> None:
    """Put a value at a place of nested tables and lists; a table's last key may be new.

    Raises InputError for a place that does not exist, and for one that holds a table of several values.
    """
    steps = place.split(".")
    holders: list[Any] = [record]
    for n, step in enumerate(steps[:-1]):
        holders = [holder[key] for holder in holders for key in _keys(holder, step, place, steps[:n])]
    for holder in holders:
        for key in _keys(holder, steps[-1], place, steps[:-1], new=True):
            before = holder[key] if isinstance(holder, list) else holder.get(key)
            if isinstance(before, dict):
                raise InputError(
                    f"{place}: there is a table of {', '.join(before)}; vary one of them, such as"
                    f" {place}.{next(iter(before))}"
                )
            holder[key] = value


def _keys(holder: Any, step: str, place: str, path: list[str], new: bool = False) -> list[Any]:
    """What a step of a place means inside a table or a list.

    path : the steps before
    new : whether a key that is not there may be made
    """
    if isinstance(holder, dict):
        if step not in holder and not new:
            near = difflib.get_close_matches(step, holder, n=1)
            hint = f"did you mean '{near[0]}'?" if near else f"there are: {', '.join(holder)}"
            raise InputError(f"{place}: no '{step}' to vary a value of; {hint}")
        return [step]
    before = ".".join(path)
    if not isinstance(holder, list):
        raise InputError(f"{place}: {before} is a single value, {holder!r}; vary {before} itself")
    if step == "*":
        return list(range(len(holder)))
    if not (step.isdigit() and 1 <= int(step) <= len(holder)):
        missing = any(isinstance(member, dict) and step in member for member in holder)
        hint = f"{before}.*{place.removeprefix(before)}" if missing else f"{before}.1"
        raise InputError(
            f"{place}: '{step}' is not a number from 1 to {len(holder)}, nor * for all of a list's members;"
            f" such as {hint}"
        )
    return [int(step) - 1]


def unit_of(place: str) -> str:
    """Unit of the value at a place, such as "N/m"; empty where it has none."""
    models: list[type[BaseModel]] = [LayoutFile]
    if place.startswith(PANTOGRAPH):
        models, place = list(get_args(DescribedPantograph)), place.removeprefix(PANTOGRAPH)
    return next((unit for model in models if (unit := _unit_in(model, place))), "")


def _unit_in(model: type[BaseModel] | None, place: str) -> str:
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
