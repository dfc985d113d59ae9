"""Conditions of which a file names CSV tables: they are read once, and conditions hold what they say."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from catenary_fe.layout.errors import InputError
from catenary_fe.layout.tables import Column, Table, read_table

Record = dict[str, Any]
_X, _TIME, _HEIGHT = Column("length"), Column("time"), Column("length")


class _Form(NamedTuple):
    """Columns that a table may have, in the order of the numbers in a row, and those that it must have."""

    columns: dict[str, Column]
    needed: tuple[str, ...]


_FORMS = {
    "temperature": _Form({"x": _X, "temperature": Column("temperature")}, ("x", "temperature")),
    "wind.speed": _Form({"time": _TIME, "x": _X, "speed": Column("speed")}, ("speed",)),
    "ice.load": _Form({"x": _X, "load": Column("load")}, ("x", "load")),
    "irregularity.height": _Form({"x": _X, "height": _HEIGHT}, ("x", "height")),
    "base.height": _Form({"x": _X, "height": _HEIGHT}, ("x", "height")),
    "base.height_over_time": _Form({"time": _TIME, "height": _HEIGHT}, ("time", "height")),
}
"""Keys whose values may be the name of a file."""


_AS_BUILT = {
    f"as_built.{name}": _Form({"x": _X, name: Column("length")}, ("x", name))
    for name in ("stagger", "messenger_wire_height", "dropper_length", "contact_wire_height", "pre_sag")
}
"""The same of a layout file."""


def names_files(record: Mapping[str, Any]) -> bool:
    """Whether a conditions file's record names any."""
    return with_tables(record, None) != record


def with_tables(record: Mapping[str, Any], folder: Path | None) -> Record:
    """A conditions file's record with tables in the place of names of CSV files, also in its cases.

    folder : that names count from; unset: no file is read, names become empty tables

    Raises InputError, one line for each fault of the tables with its row and column.
    """
    return _with(record, _FORMS, folder, "case")


def with_tables_as_built(record: Mapping[str, Any], folder: Path | None) -> Record:
    """A layout file's record likewise, also in its further sections. Raises InputError."""
    return _with(record, _AS_BUILT, folder, "further_sections")


def _with(record: Mapping[str, Any], forms: Mapping[str, _Form], folder: Path | None, inner: str) -> Record:
    """A record with tables in the place of names of files, also in the list of records with this key."""
    found, faults = dict(record), []
    for key, form in forms.items():
        *outer, name = key.split(".")
        holder = found.get(outer[0]) if outer else found
        if not isinstance(holder, dict) or not _is_file(holder.get(name)):
            continue
        try:
            rows = _rows(folder / holder[name], form) if folder else []
        except InputError as error:
            faults += [f"{key}: {line}" for line in error.problems]
            continue
        found |= {outer[0]: holder | {name: rows}} if outer else {name: rows}
    entries = found.get(inner)
    if isinstance(entries, list):
        found[inner] = []
        for number, entry in enumerate(entries, start=1):
            try:
                one = _with(entry, forms, folder, inner) if isinstance(entry, dict) else entry
                found[inner].append(one)
            except InputError as error:
                faults += [f"{inner} {number}: {line}" for line in error.problems]
    if faults:
        raise InputError(*faults)
    return found


def _is_file(value: Any) -> bool:
    return isinstance(value, str) and value.lower().endswith(".csv")


def _rows(path: Path, form: _Form) -> list[list[float]]:
    """Rows of numbers; a record in time without places is of one place."""
    table = read_table(path, form.columns, form.needed)
    names = [name for name in form.columns if table.has(name)]
    if "time" in names and "x" not in names and "x" in form.columns:
        names.insert(1, "x")
        for row in table.rows:
            row["x"] = 0.0
    if names[0] == "speed":
        raise InputError(f"{path}: row 1: column x_m or time_s is missing; add it, or write the one speed")
    _check(table, names)
    return [[row[name] for name in names] for row in table.rows]


def _check(table: Table, names: list[str]) -> None:
    """Raises InputError for empty cells, and for rows that are not in order."""
    faults = [
        f"{table.where(i, name)}: is empty; give a number, or leave out the row"
        for i, row in enumerate(table.rows)
        for name in names
        if row[name] is None
    ]
    last: dict[float, float] = {}  # of each place where there are times
    for i, row in enumerate(table.rows):
        if faults:
            break
        place = row["x"] if "time" in names and "x" in names else 0.0
        now = row[names[0]]
        if now <= last.get(place, now - 1):
            unit = "s" if names[0] == "time" else "m"
            faults.append(
                f"{table.where(i, names[0])}: {now:g} {unit} does not come after {last[place]:g} {unit};"
                " list the rows in order"
            )
        last[place] = now
    if faults:
        raise InputError(*faults)
