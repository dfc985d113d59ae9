"""Which column of a file holds what: by its heading, or by what the user says."""

from __future__ import annotations

import difflib
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError, counted
from catenary_fe.layout.parameters import shorten
from catenary_fe.layout.tables import FACTORS, number_in
from catenary_fe.results.line_test.files import RawColumn, Source

Floats = NDArray[np.float64]
Map = Mapping[str, Sequence[str]]

KINDS = {
    "position": "length", "time": "time", "speed": "speed", "force": "force", "height": "length",
    "uplift": "length", "pass": "label", "support": "label",
}  # fmt: skip
"""What is measured, and the kind of its unit; labels have none."""
_ALIASES = {
    "x": "position", "chainage": "position", "contact_force": "force", "wire_height": "height",
    "contact_wire_height": "height", "displacement": "height", "support_uplift": "uplift",
}  # fmt: skip
NOTHING = "-"
"""In place of a heading: no column holds that quantity, whatever headings say."""
_NAMES = "|".join(sorted([*KINDS, *_ALIASES], key=len, reverse=True))
_HEADING = re.compile(
    rf"(?:support_(?P<support>\d+)_(?:at_[\d.]+_m_)?)?(?P<name>{_NAMES})"
    r"(?:_?(?:pass_|support_)?(?P<number>\d+))?(?:_(?P<unit>[^\d_]\S*))?",
    re.I,
)
_KEY = re.compile(r"\s*(?P<name>[a-z_]+?)[ _]?(?P<number>\d+)?\s*(?:\[(?P<unit>[^\]]*)\])?\s*", re.I)
_UNIT_IN_BRACKETS = re.compile(r"(.*?)\s*[\[(]\s*([^\])]*?)\s*[\])]\s*")


@dataclass(frozen=True)
class Measured:
    """A column that is read.

    quantity : a key of ``KINDS``
    number : of the pass, of an uplift of the support; None without one
    values : in SI units with NaN where a cell is empty; of labels, as texts
    raw : where it comes from
    """

    quantity: str
    number: int | None
    values: Any
    raw: RawColumn


def measured_columns(source: Source, given: Map) -> tuple[list[Measured], list[str]]:
    """The columns of a file that hold something measured, and notes on those that are not read.

    given : headings by quantity, as ``--map`` has them; these quantities are then looked for nowhere else

    Raises InputError, one line for each column with a fault.
    """
    chosen, faults = _mapped(source, given)
    said = {_key(key)[0] for key in given}
    for raw in source.columns:
        if any(raw is other for _, _, _, other in chosen):
            continue
        found = _by_heading(raw)
        if found and found[0] not in said:
            chosen.append((*found, raw))
    columns: list[Measured] = []
    kept: list[tuple[str, int | None]] = []
    for name, number, unit, raw in chosen:
        where = _where(source, raw)
        if any((name, number) == other for other in kept):
            which = f"{name} {number}" if number else name
            faults.append(f"{where}: {which} is there twice; say which one by --map '{which}=HEADING'")
            continue
        kept.append((name, number))
        try:
            columns.append(Measured(name, number, _values(raw, name, unit), raw))
        except ValueError as fault:
            faults.append(
                f"{where}: {fault}" if not str(fault).startswith("row") else f"{source.path}: {fault}"
            )
    if faults:
        raise InputError(*faults)
    order = {id(raw): i for i, raw in enumerate(source.columns)}
    columns.sort(key=lambda c: order[id(c.raw)])
    unread = [raw.heading for raw in source.columns if all(raw is not c.raw for c in columns)]
    return columns, [f"{source.path}: not read: {', '.join(unread)}"] if unread else []


def _where(source: Source, raw: RawColumn) -> str:
    number = next(i for i, other in enumerate(source.columns, start=1) if other is raw)
    return f"{source.path}: row 1, column {number} ({shorten(raw.heading)})"


def _key(text: str) -> tuple[str, int | None, str]:
    """Quantity, number and unit of what ``--map`` has before the equals sign. Raises InputError."""
    found = _KEY.fullmatch(text)
    name = found["name"].lower() if found else text
    name = _ALIASES.get(name, name)
    if not found or name not in KINDS:
        near = difflib.get_close_matches(name, KINDS, n=1)
        hint = f"did you mean {near[0]}?" if near else f"known are {', '.join(KINDS)}"
        raise InputError(f"--map {text}=...: no quantity that is known; {hint}")
    return name, int(found["number"]) if found["number"] else None, (found["unit"] or "").strip()


def _mapped(source: Source, given: Map) -> tuple[list[tuple[str, int | None, str, RawColumn]], list[str]]:
    chosen, faults = [], []
    for key, headings in given.items():
        name, number, unit = _key(key)
        for i, heading in enumerate(headings if list(headings) != [NOTHING] else [], start=1):
            raw = next(
                (c for c in source.columns if c.heading.casefold() == heading.strip().casefold()), None
            )
            if raw is None:
                near = difflib.get_close_matches(heading, [c.heading for c in source.columns], n=1)
                listed = ", ".join(c.heading for c in source.columns)
                hint = f"did you mean {near[0]}?" if near else f"it has {listed}"
                faults.append(f"{source.path}: --map {key}={heading}: no such column; {shorten_hint(hint)}")
                continue
            own = _unit_of(raw, name)
            if unit and own and unit != own and own in FACTORS.get(KINDS[name], {}):
                faults.append(f"{_where(source, raw)}: its unit is {own}, --map says {unit}; leave one out")
                continue
            several = i if number is None and len(headings) > 1 else number
            chosen.append((name, several, unit or own, raw))
    return chosen, faults


def shorten_hint(text: str) -> str:
    """A list of headings that is not too long for a line."""
    return text if len(text) <= 200 else text[:197] + "..."


def _unit_of(raw: RawColumn, name: str) -> str:
    """The unit of a column whose heading may be anything: in brackets, at its end, or beside it."""
    if found := _UNIT_IN_BRACKETS.fullmatch(raw.heading):
        return found[2]
    tail = re.split(r"[\s_]", raw.heading)[-1].replace("per", "/")
    return tail if tail in FACTORS.get(KINDS[name], {}) else raw.unit


def _by_heading(raw: RawColumn) -> tuple[str, int | None, str] | None:
    """Quantity, number and unit of a heading such as ``force 2 [N]``; None for one that is not known."""
    is_field = re.fullmatch(r"[A-Za-z]\w*\.[A-Za-z]\w*", raw.heading)  # of a MATLAB structure
    heading = raw.heading.split(".")[-1] if is_field else raw.heading
    bracketed = _UNIT_IN_BRACKETS.fullmatch(heading)
    name = bracketed[1] if bracketed else heading
    text = re.sub(r"[\s_]+", "_", name.strip())
    found = _HEADING.fullmatch(text)
    if not found or (found["unit"] and (bracketed or "_" in found["unit"].replace("_per_", "/"))):
        return None
    quantity = _ALIASES.get(found["name"].lower(), found["name"].lower())
    if found["support"] and quantity != "uplift":
        return None
    unit = (bracketed[2] if bracketed else (found["unit"] or "").replace("_per_", "/")) or raw.unit
    number = found["support"] or found["number"]
    return quantity, int(number) if number else None, unit


def _values(raw: RawColumn, name: str, unit: str) -> Any:
    """A column's values in SI units, or labels. Raises ValueError with what is wrong."""
    kind = KINDS[name]
    if kind == "label":
        return _labels(raw)
    units = FACTORS[kind]
    listed = ", ".join(units)
    if not unit:
        raise ValueError(f"the unit is missing: write {name} [{next(iter(units))}], one of {listed}")
    if unit not in units:
        article = f"a {kind}" if name == kind else f"{name}, a {kind}"
        raise ValueError(
            f"unit '{unit}' does not fit {article}: must be one of {listed}; --map {name}=- leaves it out"
        )
    values = np.empty(len(raw.values))
    faults = []
    for i, cell in enumerate(raw.values):
        try:
            values[i] = _number(cell)
        except ValueError as fault:
            faults.append(f"row {raw.rows[i]}, column {raw.heading}: {fault}")
    if faults:
        raise ValueError(faults[0] + like_it(len(faults) - 1))
    return values * units[unit]


def like_it(more: int) -> str:
    """How many more rows have the same fault, in words."""
    return f" (and {counted(more, 'more row')} like it)" if more else ""


def _number(cell: Any) -> float:
    """NaN for an empty cell, and for what programs write for a value that is not there."""
    if cell is None or (isinstance(cell, str) and cell.strip().casefold() in ("", "nan")):
        return float("nan")
    if isinstance(cell, bool) or not isinstance(cell, str | int | float):
        raise ValueError(f"{shorten(str(cell))} is not a number")
    value = number_in(cell.strip()) if isinstance(cell, str) else float(cell)
    if abs(value) >= 1e15:
        raise ValueError(f"{value:g} is no value that can be measured")
    return value


def _labels(raw: RawColumn) -> list[str]:
    texts = []
    for i, cell in enumerate(raw.values):
        text = "" if cell is None else f"{cell:g}" if isinstance(cell, float) else str(cell).strip()
        if not text:
            raise ValueError(
                f"row {raw.rows[i]}, column {raw.heading}: is empty; fill it, or leave the row out"
            )
        texts.append(text)
    return texts
