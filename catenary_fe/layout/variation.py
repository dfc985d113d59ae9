"""Change single values of layout, pantograph, conditions by their place: ``support.steady_arm.mass``."""

from __future__ import annotations

import copy
import difflib
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from catenary_fe.layout.catenary import Catenary
from catenary_fe.layout.conditions import Conditions, conditions_record, load_conditions, one_of_a_run
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.files import LayoutFile, fault_lines, layout_record, load_pantograph
from catenary_fe.layout.pantograph import DescribedPantograph
from catenary_fe.layout.parameters import problem_lines, shorten

PANTOGRAPH = "pantograph."  # keys of the pantograph start with this
CONDITIONS = "conditions."  # and those of the conditions with this


def kind_of(place: str) -> str:
    """What a place is of: ``PANTOGRAPH``, ``CONDITIONS``, or "", the layout."""
    return next((kind for kind in (PANTOGRAPH, CONDITIONS) if place.startswith(kind)), "")


class Variable:
    """A layout file and perhaps one of conditions, whose values can be replaced by their place.

    A place is written with dots; members of a list by their number from 1, or ``*`` for all:
    ``contact_wire.tension``, ``span.*.pre_sag``, ``pantograph.stages.1.mass``, ``conditions.wind.speed``.

    conditions : their file; unset: none, and places say all that there is of them

    Raises InputError where a file is missing or faulty, and for conditions with cases.
    """

    def __init__(self, layout: str | Path, conditions: str | Path | None = None) -> None:
        self.path = Path(layout)
        self.record = layout_record(self.path)
        self._has_conditions, self._conditions_path = conditions is not None, str(conditions or "conditions")
        self.conditions_record: dict[str, Any] = {}
        if conditions is not None:
            self.conditions_record = conditions_record(conditions)
            one_of_a_run(load_conditions(conditions), conditions)

    def changed(self, values: dict[str, Any]) -> Variable:
        """The same files with values of the layout and the conditions replaced. Raises InputError."""
        found = copy.copy(self)
        found.record, found.conditions_record = map(copy.deepcopy, (self.record, self.conditions_record))
        line = {place: v for place, v in values.items() if not kind_of(place)}
        _changed(found.record, str(self.path), line, LayoutFile)
        day = _of(CONDITIONS, values)
        _changed(found.conditions_record, self._conditions_path, day, Conditions)
        found._has_conditions = self._has_conditions or bool(day)
        return found

    def catenary(self, values: dict[str, Any]) -> Catenary:
        """The catenary with these values; keys of pantograph and conditions are left out.

        Raises InputError for a place that does not exist and for values that break a rule.
        """
        record = copy.deepcopy(self.record)
        changes = {place: v for place, v in values.items() if not kind_of(place)}
        said = _changed(record, str(self.path), changes, LayoutFile)
        try:
            return LayoutFile.model_validate(record).catenary()
        except ValidationError as error:
            raise InputError(*(f"{said}: {line}" for line in fault_lines(error, record))) from None
        except InputError as error:
            raise InputError(*(f"{said}: {line}" for line in error.problems)) from None

    def conditions(self, values: dict[str, Any]) -> Conditions | None:
        """The conditions with these values, None without any; keys of layout and pantograph are left out.

        Raises InputError for a place that does not exist and for values that break a rule.
        """
        changes = _of(CONDITIONS, values)
        if not (self._has_conditions or changes):
            return None
        record = copy.deepcopy(self.conditions_record)
        said = _changed(record, self._conditions_path, changes, Conditions)
        try:
            return Conditions.model_validate(record)
        except ValidationError as error:
            raise InputError(*problem_lines(error, Conditions, where=said)) from None


def varied_pantograph(name_or_path: str, values: dict[str, Any]) -> DescribedPantograph:
    """A pantograph of the library or a file with these values; keys of the layout are left out.

    Raises InputError for a place that does not exist and for values that break a rule.
    """
    pantograph = load_pantograph(name_or_path)
    changes = _of(PANTOGRAPH, values)
    if not changes:
        return pantograph
    record = pantograph.model_dump(mode="json")
    said = _changed(record, name_or_path, changes, type(pantograph))
    try:
        return type(pantograph).model_validate(record)
    except ValidationError as error:
        raise InputError(*problem_lines(error, type(pantograph), where=said)) from None


def _of(prefix: str, values: dict[str, Any]) -> dict[str, Any]:
    """Those values whose place starts so, by the rest of it."""
    return {place.removeprefix(prefix): v for place, v in values.items() if place.startswith(prefix)}


def _changed(record: dict[str, Any], name: str, changes: dict[str, Any], model: type[BaseModel]) -> str:
    """Put values in their places; returns name and changes in words."""
    for place, value in changes.items():
        _make_tables(record, place, model)
        replace_at(record, place, value)
    return ", ".join([name, *(f"{place} = {shorten(value)}" for place, value in changes.items())])


def _make_tables(record: dict[str, Any], place: str, model: type[BaseModel]) -> None:
    """The tables on the way to a key, where a file may leave them out. Raises InputError for unknown ones."""
    for step in place.split(".")[:-1]:
        field = model.model_fields.get(step)
        if field is None:
            raise InputError(f"{place}: no '{step}' to vary a value of; {_near(step, model.model_fields)}")
        kinds = (field.annotation, *get_args(field.annotation)) if field else ()
        inner = next((k for k in kinds if isinstance(k, type) and issubclass(k, BaseModel)), None)
        if inner is None or not isinstance(record.setdefault(step, {}), dict):
            return
        record, model = record[step], inner


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


def places_of(record: dict[str, Any], place: str, model: type[BaseModel]) -> list[str]:
    """Places of single members that a place stands for, ``*`` written out.

    Raises InputError for a place that does not exist.
    """
    trial = copy.deepcopy(record)
    _make_tables(trial, place, model)
    replace_at(trial, place, None)
    steps = place.split(".")
    found: list[tuple[list[str], Any]] = [([], record)]
    for n, step in enumerate(steps):
        inside: list[tuple[list[str], Any]] = []
        for path, holder in found:
            if isinstance(holder, dict) or (holder is None and step != "*"):
                inside.append(([*path, step], (holder or {}).get(step)))
            else:
                keys = _keys(holder, step, place, steps[:n])
                inside += [([*path, str(key + 1)], holder[key]) for key in keys]
        found = inside
    return [".".join(path) for path, _ in found]


def _near(step: str, known: Iterable[str]) -> str:
    """The nearest of the known keys, or all of them."""
    near = difflib.get_close_matches(step, list(known), n=1)
    return f"did you mean '{near[0]}'?" if near else f"there are: {', '.join(known)}"


def _keys(holder: Any, step: str, place: str, path: list[str], new: bool = False) -> list[Any]:
    """What a step of a place means inside a table or a list.

    path : the steps before
    new : whether a key that is not there may be made
    """
    if isinstance(holder, dict):
        if step not in holder and not new:
            raise InputError(f"{place}: no '{step}' to vary a value of; {_near(step, holder)}")
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
    elif place.startswith(CONDITIONS):
        models, place = [Conditions], place.removeprefix(CONDITIONS)
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
