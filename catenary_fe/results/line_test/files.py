"""Files of measurements: CSV tables, workbooks, MATLAB and TDMS files, all as named columns."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from catenary_fe.layout import InputError, counted
from catenary_fe.layout.parameters import shorten
from catenary_fe.layout.tables import FACTORS, read_cells
from catenary_fe.layout.toml import read_bytes
from catenary_fe.results.export import check_xlsx

LARGEST_FILE = 256 * 2**20  # [bytes] hours at a thousand rows a second
MOST_ROWS = 2_000_000
_WHAT = "a table of measurements"
_UNITS = {unit for units in FACTORS.values() for unit in units}
_GROUPED = re.compile(r"[+-]?[1-9]\d{0,2}(,\d{3})+")
_COMMA = re.compile(r"[+-]?\d+,\d+([eE][+-]?\d+)?")
_POINT = re.compile(r"[+-]?\d*\.\d*([eE][+-]?\d+)?")


@dataclass(frozen=True)
class RawColumn:
    """A column as a file has it.

    heading : as it is written
    unit : that the file states beside the heading; may be empty
    values : texts, numbers, or None where there is nothing
    rows : number of each value's row, as the file's own program counts
    """

    heading: str
    unit: str
    values: Sequence[Any]
    rows: Sequence[int]


@dataclass(frozen=True)
class Source:
    """A file of measurements.

    path : of the file
    columns : all that it has
    notes : on how it was read
    """

    path: Path
    columns: tuple[RawColumn, ...]
    notes: tuple[str, ...] = ()


def is_measurement(path: str | Path) -> bool:
    """Whether a name is that of a file which may hold measurements."""
    return Path(path).suffix.lower() in _READERS


def read_source(path: Path) -> Source:
    """All columns of a file. Raises InputError where it cannot be read, or no such file is known."""
    reader = _READERS.get(path.suffix.lower())
    if reader is None:
        raise InputError(f"{path}: no file of measurements; its name must end with {', '.join(_READERS)}")
    return reader(path)


def _csv(path: Path) -> Source:
    lines, cells = read_cells(path, MOST_ROWS, LARGEST_FILE, _WHAT)
    width = len(cells[0])
    wrong = [i for i, row in enumerate(cells) if len(row) != width]
    if wrong:
        more = f" (and {counted(len(wrong) - 1, 'more row')} like it)" if len(wrong) > 1 else ""
        raise InputError(
            f"{path}: row {lines[wrong[0]]}: {counted(len(cells[wrong[0]]), 'cell')} for"
            f" {counted(width, 'column')}{more}; look for decimal commas in a table that commas separate:"
            " write points, or separate by semicolons"
        )
    body = cells[1:]
    notes: tuple[str, ...] = ()
    if _decimal_commas(path, lines[1:], body):
        body = [[c.replace(",", ".") if _COMMA.fullmatch(c) else c for c in row] for row in body]
        notes = (f"{path}: commas are read as decimal commas",)
    return _table(path, cells[0], body, lines[1:], notes)


def _decimal_commas(path: Path, lines: Sequence[int], body: Sequence[Sequence[str]]) -> bool:
    """Whether the numbers are written with decimal commas. Raises InputError where that is not clear."""
    found = [(i, c) for i, row in enumerate(body) for c in row if "," in c and _COMMA.fullmatch(c)]
    if not found:
        return False
    row, first = lines[found[0][0]], found[0][1]
    points = next((c for cells in body for c in cells if "." in c and _POINT.fullmatch(c)), None)
    if points:
        raise InputError(
            f"{path}: row {row}: {first} has a comma, {points} a point: write points before decimals, and"
            " nothing between thousands"
        )
    if all(_GROUPED.fullmatch(c) for _, c in found):
        raise InputError(
            f"{path}: row {row}: {first} may be a decimal comma or a thousand: write points before decimals"
        )
    return True


def _table(
    path: Path,
    header: Sequence[Any],
    body: Sequence[Sequence[Any]],
    rows: Sequence[int],
    notes: tuple[str, ...],
) -> Source:
    """Columns of a table, whose first row below the header may hold the units."""
    headings = ["" if cell is None else str(cell).strip() for cell in header]
    units = [""] * len(headings)
    if body and _are_units(body[0]):
        units = [re.sub(r"[\[\]()]", "", str(cell or "")).strip() for cell in body[0]]
        body, rows = body[1:], rows[1:]
    if not body:
        raise InputError(f"{path}: there is no row below the header")
    columns = [
        RawColumn(heading, unit, values, rows)
        for heading, unit, values in zip(headings, units, zip(*body, strict=True), strict=True)
        if heading
    ]
    return Source(path, tuple(columns), notes)


def _are_units(cells: Sequence[Any]) -> bool:
    words = [str(cell).strip(" []()") for cell in cells if cell not in (None, "")]
    return any(word in _UNITS for word in words) and not any(re.search(r"\d", word) for word in words)


def _xlsx(path: Path) -> Source:
    check_xlsx()
    from openpyxl import load_workbook

    content = read_bytes(path, "table", LARGEST_FILE)
    try:
        with warnings.catch_warnings(action="ignore"):
            book = load_workbook(BytesIO(content), read_only=True, data_only=True)
        sheet = book.worksheets[0]
        found = [(n, row) for n, row in enumerate(sheet.iter_rows(values_only=True), start=1) if any(
            cell not in (None, "") for cell in row)]  # fmt: skip
    except Exception as error:  # of a damaged archive there are many
        raise InputError(_damaged(path, "workbook", error)) from None
    if not found:
        raise InputError(f"{path}: sheet {sheet.title}: is empty; its first row must name the columns")
    width = max(len(row) for _, row in found)
    cells = [[*row, *[None] * (width - len(row))] for _, row in found]
    others = [other.title for other in book.worksheets[1:]]
    notes = (f"{path}: sheet {sheet.title} is read, not {', '.join(others)}",) if others else ()
    return _table(path, cells[0], cells[1:], [n for n, _ in found[1:]], notes)


def _mat(path: Path) -> Source:
    from scipy.io import loadmat

    content = read_bytes(path, "table", LARGEST_FILE)
    try:
        found = loadmat(BytesIO(content))
    except NotImplementedError:
        raise InputError(
            f"{path}: a MATLAB file of version 7.3: save it with '-v7', or export a CSV table"
        ) from None
    except Exception as error:  # of a damaged file there are many
        raise InputError(_damaged(path, "MATLAB file", error)) from None
    columns: list[RawColumn] = []
    for name, value in found.items():
        if not name.startswith("__"):
            columns += _matlab_columns(name, value)
    if not columns:
        raise InputError(f"{path}: holds no list of numbers")
    return Source(path, tuple(columns))


def _matlab_columns(name: str, value: Any) -> list[RawColumn]:
    """Of a variable: a list is a column, a matrix several, a structure those of its fields."""
    array = np.asarray(value)
    if array.dtype.names and array.size == 1:
        fields = ((field, array.ravel()[0][field]) for field in array.dtype.names)
        return [column for field, inner in fields for column in _matlab_columns(f"{name}.{field}", inner)]
    if array.dtype.kind not in "iuf" or array.ndim != 2 or array.size < 2:
        return []
    if 1 in array.shape:
        return [RawColumn(name, "", array.ravel().tolist(), range(1, array.size + 1))]
    head = re.fullmatch(r"(.*?)(_[^_]+)?", name)  # force_N: force_1_N, force_2_N
    assert head
    return [
        RawColumn(f"{head[1]}_{n}{head[2] or ''}", "", values.tolist(), range(1, values.size + 1))
        for n, values in enumerate(array.T, start=1)
    ]


def _tdms(path: Path) -> Source:
    try:
        from nptdms import TdmsFile
    except ImportError:
        raise InputError(
            f'{path}: a TDMS file needs the package npTDMS: pip install "catenary_fe[measured]"'
        ) from None
    content = read_bytes(path, "table", LARGEST_FILE)
    columns: list[RawColumn] = []
    try:
        for group in TdmsFile.read(BytesIO(content)).groups():
            for channel in group.channels():
                columns += _tdms_columns(channel, any(c.heading == "time" for c in columns))
    except Exception as error:  # of a damaged file there are many
        raise InputError(_damaged(path, "TDMS file", error)) from None
    if not columns:
        raise InputError(f"{path}: holds no channel of numbers")
    return Source(path, tuple(columns))


def _tdms_columns(channel: Any, has_time: bool) -> list[RawColumn]:
    """A channel, and before it the time of its waveform, where it has one and no other said it before."""
    values = np.asarray(channel[:])
    if values.dtype.kind == "M":
        values = (values - values[:1]) / np.timedelta64(1, "s")
    if values.dtype.kind not in "iuf" or not values.size:
        return []
    rows = range(1, values.size + 1)
    unit = str(channel.properties.get("unit_string", ""))
    time = []
    if channel.properties.get("wf_increment") and not has_time:
        time = [RawColumn("time", "s", channel.time_track().tolist(), rows)]
    return [*time, RawColumn(channel.name, unit, values.tolist(), rows)]


def _damaged(path: Path, kind: str, error: Exception) -> str:
    said = shorten(str(error).splitlines()[0] if str(error) else type(error).__name__)
    return f"{path}: cannot be read as a {kind} ({said}); save it again, or export a CSV table"


_READERS: dict[str, Callable[[Path], Source]] = {
    ".csv": _csv, ".tsv": _csv, ".txt": _csv, ".xlsx": _xlsx, ".mat": _mat, ".tdms": _tdms,
}  # fmt: skip
