"""CSV tables as spreadsheets of all countries write them: units in the header, faults with row and column."""

from __future__ import annotations

import csv
import difflib
import io
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from pathlib import Path
from typing import Any

from catenary_fe.layout.errors import InputError, counted
from catenary_fe.layout.parameters import shorten
from catenary_fe.layout.toml import LARGEST_FILE, read_text

FACTORS: dict[str, dict[str, float]] = {
    "length": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "km": 1e3},
    "force": {"N": 1.0, "kN": 1e3},
    "stiffness": {"N/m": 1.0, "kN/m": 1e3, "N/mm": 1e3},
    "mass": {"kg": 1.0},
    "time": {"s": 1.0, "ms": 1e-3},
    "speed": {"m/s": 1.0, "km/h": 1 / 3.6, "kmh": 1 / 3.6},
    "frequency": {"Hz": 1.0},
    "receptance": {"m/N": 1.0, "mm/N": 1e-3, "um/N": 1e-6},
    "angle": {"deg": 1.0, "rad": 180 / pi},
    "temperature": {"°C": 1.0, "C": 1.0},
    "load": {"N/m": 1.0, "kN/m": 1e3},
}
"""From units to SI, by kind of quantity; angles to degrees."""
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?")
_COMMA = re.compile(r"[+-]?\d+,\d+")
_YES = {"yes": True, "true": True, "1": True, "no": False, "false": False, "0": False}
MOST_ROWS = 200_000
ROUNDED = 2.5e-3  # [m] by which columns may differ that say the same, both rounded to the millimetre


@dataclass(frozen=True)
class Column:
    """What a column holds.

    kind : "length", "force", "load" and others of ``FACTORS``: a number with a unit; "whole", "text", "yes":
        without one; "result": what follows from a layout, which is not read
    least : smallest number that is allowed
    words : texts that are allowed; empty: any
    """

    kind: str
    least: float | None = None
    words: tuple[str, ...] = ()


_LENGTH, _SIZE, _RESULT = Column("length"), Column("length", least=0.0), Column("result")
_WHOLE = Column("whole")
MAST_COLUMNS = {
    "section": _WHOLE, "support": _WHOLE, "chainage": _LENGTH, "span_before": _SIZE, "span_after": _SIZE,
    "curve_radius_before": _LENGTH, "curve_radius_after": _LENGTH, "stagger": _LENGTH,
    "messenger_stagger": _LENGTH, "cant": _LENGTH, "contact_wire_height": _SIZE, "system_height": _SIZE,
    "pre_sag": _LENGTH,
    "midpoint": Column("yes"), "stitch_wire": Column("yes"), "stitch_wire_length": _SIZE,
    "uplift_room": _SIZE, "arm_kind": Column("text", words=("link", "spring", "none")),
    "arm_side": Column("text", words=("left", "right")), "arm_length": _SIZE,
    "arm_stiffness": Column("stiffness", least=0.0),
} | dict.fromkeys(
    ("arm_inclination", "arm_vertical", "arm_lateral", "arm_radial", "messenger_wire_height",
     "messenger_vertical", "messenger_lateral", "contact_wire_tension", "messenger_wire_tension",
     "stitch_wire_tension"), _RESULT
)  # fmt: skip
"""Columns of a mast table. ``curve_radius_after``, ``pre_sag``: of the span that begins at the mast."""
DROPPER_COLUMNS = {
    "section": _WHOLE, "span": _WHOLE, "from_support": _WHOLE, "to_support": _WHOLE, "dropper": _WHOLE,
    "chainage": _LENGTH, "position": _SIZE, "length": _SIZE, "cut_length": _SIZE, "height_offset": _LENGTH,
    "contact_wire": _WHOLE, "hangs_on": Column("text", words=("messenger wire", "stitch wire")),
} | dict.fromkeys(
    ("installed_length", "force", "contact_wire_height", "contact_wire_height_error"), _RESULT
)  # fmt: skip
"""Columns of a dropper table: a chainage or a position, which counts from the span's first support."""


@dataclass(frozen=True)
class Table:
    """A table as it was read.

    path : of its file
    rows : values by column, in SI units, None where a cell is empty; of columns without numbers of wires
    lines : number of each row, from 1, as spreadsheets count: the header is row 1
    headings : of the columns, as they are written
    not_read : headings of results
    """

    path: Path
    rows: list[dict[str, Any]]
    lines: list[int]
    headings: dict[str, str]
    not_read: tuple[str, ...]

    def has(self, name: str) -> bool:
        """Whether there is a column."""
        return name in self.headings

    def where(self, row: int, name: str | None = None) -> str:
        """A place in it, in words."""
        return f"{self.path}: row {self.lines[row]}" + (f", column {self.headings[name]}" if name else "")


def read_table(
    path: str | Path, columns: Mapping[str, Column], needed: Sequence[str], numbered: bool = False
) -> Table:
    """Read a table with these columns.

    Commas, semicolons or tabs may separate the cells; a byte order mark before them is read over.

    needed : columns that must be there
    numbered : whether columns may be there for each of two contact wires: ``stagger_1``, ``stagger_2``

    Raises InputError, one line for each fault with its row and column.
    """
    path = Path(path)
    lines, cells = read_cells(path)
    header, body = cells[0], cells[1:]
    names, units = _headings(path, header, columns, needed)
    if not numbered and (wrong := [h for h, n in zip(header, names, strict=True) if _common(n) != n]):
        raise InputError(
            *(f"{path}: row 1: {h}: this table has no columns of one contact wire" for h in wrong)
        )
    faults: list[str] = []
    rows = []
    for line, row in zip(lines[1:], body, strict=True):
        if len(row) != len(header):
            faults.append(
                f"{path}: row {line}: {counted(len(row), 'cell')} for {counted(len(header), 'column')}; look"
                " for a decimal comma or a separator too many"
            )
            continue
        found = {}
        for heading, name, unit, cell in zip(header, names, units, row, strict=True):
            column = columns[_common(name)]
            if column.kind == "result":
                continue
            try:
                found[name] = _value(cell.strip(), column, unit)
            except ValueError as fault:
                faults.append(f"{path}: row {line}, column {heading}: {fault}")
        rows.append(found)
    if not body:
        faults.append(f"{path}: there is no row below the header")
    if faults:
        raise InputError(*faults)
    kinds = [columns[_common(name)].kind for name in names]
    headings = {n: h for n, h, kind in zip(names, header, kinds, strict=True) if kind != "result"}
    not_read = tuple(h for h, kind in zip(header, kinds, strict=True) if kind == "result")
    return Table(path, rows, lines[1:], headings, not_read)


def one_wire(table: Table) -> Table:
    """A table in which columns of the right and the left contact wire are one: the mean of the staggers."""
    faults = []
    rows = [dict(row) for row in table.rows]
    headings = dict(table.headings)
    for name in table.headings:
        first, second = (name, name.replace("_1", "_2", 1))
        if "_1" not in name or second == name:
            continue
        whole = name.replace("_1", "", 1)
        if whole in headings or second not in headings:
            faults.append(
                f"{table.path}: row 1: {headings[name]}: give it for both contact wires, or {whole} alone"
            )
            continue
        for i, row in enumerate(rows):
            a, b = row.pop(first), row.pop(second)
            if whole == "stagger" and None not in (a, b):
                row[whole] = round((a + b) / 2, 9)
            elif a == b or (whole == "contact_wire_height" and None not in (a, b) and abs(a - b) < ROUNDED):
                row[whole] = a
            else:
                faults.append(f"{table.where(i, name)}: the two contact wires differ there; give one value")
        headings[whole] = headings[name]
    if alone := [h for n, h in headings.items() if "_2" in n and n.replace("_2", "_1", 1) not in headings]:
        faults += [
            f"{table.path}: row 1: {heading}: the right contact wire's is missing" for heading in alone
        ]
    if faults:
        raise InputError(*faults)
    return Table(table.path, rows, table.lines, headings, table.not_read)


def by_section(table: Table) -> dict[int, Table]:
    """The table's parts by the number of their tension section; 1 where it has no such column.

    Raises InputError where the numbers do not run from 1 in order.
    """
    numbers = [row.get("section") or 1 for row in table.rows]
    last = 0
    for i, number in enumerate(numbers):
        if number not in (last, last + 1) or number == 0:
            place = table.where(i, "section" if table.has("section") else None)
            raise InputError(f"{place}: section {number} after section {last}: number them from 1, in order")
        last = number
    parts = {}
    for number in range(1, last + 1):
        kept = [i for i, n in enumerate(numbers) if n == number]
        rows, lines = [table.rows[i] for i in kept], [table.lines[i] for i in kept]
        parts[number] = replace(table, rows=rows, lines=lines)
    return parts


def read_cells(
    path: Path, most_rows: int = MOST_ROWS, most_bytes: int = LARGEST_FILE, what: str = "the table of a line"
) -> tuple[list[int], list[list[str]]]:
    """Numbers of the rows that are not empty, and their cells: the header counts as the first.

    most_rows, most_bytes, what : how large it may be, and what it is then no more

    Raises InputError.
    """
    text = read_text(path, "table", most_bytes)
    header = next((line for line in text.splitlines() if line.strip()), "")
    separator = max(",;\t", key=header.count)
    found = csv.reader(io.StringIO(text, newline=""), delimiter=separator, strict=True)
    lines, cells = [], []
    try:
        for number, row in enumerate(found, start=1):
            if any(cell.strip() for cell in row):
                lines.append(number)
                cells.append([cell.strip() for cell in row])
            if len(lines) > most_rows:
                raise InputError(f"{path}: more than {most_rows:,} rows: that is not {what}")
    except csv.Error as error:
        raise InputError(f"{path}: row {len(lines) + 1}: not a CSV table: {error}") from None
    if not cells:
        raise InputError(f"{path}: is empty; its first row must name the columns")
    while cells[0] and not cells[0][-1] and all(not row[-1] for row in cells if len(row) == len(cells[0])):
        cells = [row[:-1] if len(row) == len(cells[0]) else row for row in cells]  # a separator at each end
    return lines, cells


def _common(name: str) -> str:
    """A column's name without the number of its contact wire."""
    return re.sub(r"_[12](?=_|$)", "", name)


def _headings(
    path: Path, header: Sequence[str], columns: Mapping[str, Column], needed: Sequence[str]
) -> tuple[list[str], list[str]]:
    """Names and units of the columns. Raises InputError."""
    faults, names, units = [], [], []
    for number, heading in enumerate(header, start=1):
        where = f"{path}: row 1, column {number} ({shorten(heading)})"
        name, unit = _split(heading, columns)
        fault = _heading_fault(name, unit, columns)
        if fault:
            faults.append(f"{where}: {fault}")
        elif name in names:
            faults.append(f"{where}: {name} is there twice; leave one of them")
        names.append(name)
        units.append(unit)
    given = {_common(name) for name in names}
    for name in needed:
        if name not in given:
            faults.append(f"{path}: row 1: column {_example(name, columns[name])} is missing; add it")
    if faults:
        raise InputError(*faults)
    return names, units


def _split(heading: str, columns: Mapping[str, Column]) -> tuple[str, str]:
    """Name and unit of a heading: ``stagger_mm``, ``Stagger [mm]`` and ``stagger (mm)`` are one."""
    text = re.sub(r"[\s_]+", "_", re.sub(r"[\[\]()]", " ", heading).strip())
    known = [n for n in columns if re.match(_pattern(n) + r"(_|$)", text, re.I)]
    if not known:
        return text.lower(), ""
    found = re.match(_pattern(max(known, key=len)), text, re.I)
    assert found
    unit = text[found.end() :].strip("_").replace("_per_", "/").replace("µ", "u")
    return found[0].lower(), unit


def _pattern(name: str) -> str:
    """Of a name that may have the number of a contact wire: behind it, or ``arm_1_length``."""
    head, _, rest = name.partition("_")
    return rf"{head}(_[12])?_{rest}(_[12])?" if rest else rf"{head}(_[12])?"


def _heading_fault(name: str, unit: str, columns: Mapping[str, Column]) -> str | None:
    column = columns.get(_common(name))
    if column is None:
        near = difflib.get_close_matches(name, columns, n=1)
        known = ", ".join(_example(n, c) for n, c in columns.items() if c.kind != "result")
        hint = f"did you mean {_example(near[0], columns[near[0]])}?" if near else f"known are {known}"
        return f"no column that is known; {hint}"
    units = FACTORS.get(column.kind)
    if units is None:
        wrong = unit and column.kind != "result"
        return f"{name} has no unit; write {name}" if wrong else None
    listed = ", ".join(units)
    if not unit:
        return f"the unit is missing: {listed}; write {_example(name, column)}"
    return None if unit in units else f"unit '{unit}' does not fit a {column.kind}: must be one of {listed}"


def _example(name: str, column: Column) -> str:
    units = [unit.replace("/", "_per_") for unit in FACTORS.get(column.kind, ())]
    return f"{name}_{units[0]}" if units else name


def _value(cell: str, column: Column, unit: str) -> Any:
    """A cell's value in SI units, None where it is empty. Raises ValueError with what is wrong."""
    if not cell:
        return None
    reader: dict[str, Callable[[str, Column], Any]] = {"text": _word, "yes": _yes, "whole": _whole}
    if column.kind in reader:
        return reader[column.kind](cell, column)
    value = number_in(cell)
    if column.least is not None and value < column.least:
        raise ValueError(f"{cell}: must be at least {column.least:g}")
    factor = FACTORS[column.kind][unit]
    return value if factor == 1 else float(f"{value * factor:.12g}")


def number_in(cell: str) -> float:
    """The number that a cell holds. Raises ValueError with what is wrong."""
    if _NUMBER.fullmatch(cell) and abs(float(cell)) < 1e15:
        return float(cell)
    if _COMMA.fullmatch(cell):
        raise ValueError(
            f"{cell} is a number with a comma: write a point before decimals ({cell.replace(',', '.')}), and"
            " nothing between thousands"
        )
    if re.fullmatch(r"[+-]?\d{1,3}([\s'’]\d{3})+(\.\d+)?", cell):
        raise ValueError(f"{cell} is a number with gaps: write nothing between thousands")
    if cell[0] in "‐‑‒–—−":
        raise ValueError(f"{cell} begins with a dash (U+{ord(cell[0]):04X}): write an ordinary hyphen")
    raise ValueError(f"{shorten(cell)} is not a number")


def _whole(cell: str, column: Column) -> int:
    if not re.fullmatch(r"\d{1,9}", cell):
        raise ValueError(f"{shorten(cell)} is not a whole number of at least 1")
    return int(cell)


def _yes(cell: str, column: Column) -> bool:
    if cell.casefold() not in _YES:
        raise ValueError(f"{shorten(cell)}: must be yes or no")
    return _YES[cell.casefold()]


def _word(cell: str, column: Column) -> str:
    word = cell.casefold()
    if column.words and word not in column.words:
        raise ValueError(f"{shorten(cell)}: must be one of {', '.join(map(repr, column.words))}")
    return word if column.words else cell
