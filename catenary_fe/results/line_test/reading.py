"""Line tests from files: columns put together to passes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from catenary_fe.layout import InputError, counted
from catenary_fe.layout.arguments import whole
from catenary_fe.layout.parameters import shorten
from catenary_fe.results.line_test.columns import Map, Measured, like_it, measured_columns
from catenary_fe.results.line_test.files import Source, read_source
from catenary_fe.results.line_test.record import LineTest, MeasuredPass

_ALONG = ("position", "time", "speed")


def read_line_test(
    paths: str | Path | Sequence[str | Path],
    *,
    columns: Mapping[str, str | Sequence[str]] | None = None,
    support: int | None = None,
) -> LineTest:
    """What was measured in a line test, from one or several files.

    paths : of CSV tables, workbooks (.xlsx), MATLAB files (.mat, up to version 7.2) or TDMS files
    columns : headings by quantity, where they do not say it themselves: ``{"force [N]": "CH7"}``; "-" for a
        quantity that is not to be read
    support : number (from 1) of the support whose uplift it is, where the files do not say it

    Columns that are known: ``position`` (or ``chainage``), ``time``, ``speed``, ``force``, ``height`` of the
    contact wire at the head, ``uplift`` at a support, each with a unit, ``pass`` and ``support`` without.
    ``force 1 [N]`` and ``force 2 [N]`` are two passes, ``uplift_support_5_mm`` is that of support 5.

    Raises InputError, one line for each fault with row and column.
    """
    files = _paths(paths)
    given = _given(columns)
    if support is not None:
        whole("support", support, least=1)
    passes: list[MeasuredPass] = []
    notes: list[str] = []
    for path in files:
        source = read_source(path)
        found, more = measured_columns(source, given)
        notes += [*source.notes, *more]
        passes += _passes(source, found, path.stem if len(files) > 1 else "", support, notes)
    if support is not None and not any(support in p.uplift for p in passes):
        raise InputError(f"support = {support}: no file has an uplift without a support of its own")
    return LineTest(_named(passes), tuple(notes))


def _paths(paths: object) -> list[Path]:
    listed = [paths] if isinstance(paths, str | Path) else paths
    if not isinstance(listed, Sequence) or not listed or not all(isinstance(p, str | Path) for p in listed):
        raise InputError(f"paths = {shorten(paths)}: must be a path, or a list of paths")
    return [Path(p) for p in listed]


def _given(columns: object) -> Map:
    if columns is None:
        return {}
    if not isinstance(columns, Mapping):
        raise InputError(f"columns = {shorten(columns)}: must be headings by quantity")
    given = {k: [v] if isinstance(v, str) else v for k, v in columns.items()}
    for key, headings in given.items():
        fits = isinstance(headings, Sequence) and all(isinstance(h, str) for h in headings)
        if not isinstance(key, str) or not fits or not headings:
            raise InputError(f"columns: {shorten(key)} = {shorten(headings)}: must be a heading, or several")
    return given


def _named(passes: Sequence[MeasuredPass]) -> list[MeasuredPass]:
    """Passes of which no two have the same name."""
    names = [p.name for p in passes]
    if len(set(names)) == len(names):
        return list(passes)
    return [_with(p, name=f"{n}: {p.name}") for n, p in enumerate(passes, start=1)]


def _with(one: MeasuredPass, **changes: Any) -> MeasuredPass:
    fields = ("name", "position", "time", "speed", "force", "height", "uplift")
    return MeasuredPass(**({name: getattr(one, name) for name in fields} | changes))


def _passes(
    source: Source, columns: Sequence[Measured], stem: str, support: int | None, notes: list[str]
) -> list[MeasuredPass]:
    """The passes of one file. Raises InputError."""
    names = {c.quantity for c in columns}
    if not names & {"force", "height", "uplift"}:
        listed = ", ".join(raw.heading for raw in source.columns)
        raise InputError(
            f"{source.path}: row 1: there is no column of force, height or uplift, but {shorten(listed)};"
            " name it with its unit, such as force [N], or say --map 'force[N]=HEADING'"
        )
    if names & {"force", "height"} and not names & {"position", "time"}:
        raise InputError(
            f"{source.path}: row 1: column position [m] or time [s] is missing; add it, or say"
            " --map 'position[m]=HEADING'"
        )
    unused = names & {*_ALONG} if not names & {"force", "height"} else set()
    unused |= {"support"} & names if "uplift" not in names else set()
    if unused:
        notes.append(f"{source.path}: not used: {', '.join(sorted(unused))}")
    groups = _groups(source, columns)
    made = []
    for name, parts in groups.items():
        label = ": ".join(word for word in (stem, name) if word) or "measured"
        made.append(_one_pass(source, label, parts, support, notes))
    return made


def _groups(source: Source, columns: Sequence[Measured]) -> dict[str, list[Measured]]:
    """Columns of each pass, by its name."""
    numbers = sorted({c.number for c in columns if c.number is not None and c.quantity != "uplift"})
    labels = next((c for c in columns if c.quantity == "pass"), None)
    if labels is None:
        if not numbers:
            return {"": list(columns)}
        return {
            f"pass {n}": [
                c for c in columns if c.number in (n, None) or (c.quantity == "uplift" and n == numbers[0])
            ]
            for n in numbers
        }
    if numbers:
        raise InputError(f"{source.path}: row 1: a column pass and numbered columns: only one can say it")
    groups = {}
    for label in dict.fromkeys(labels.values):
        rows = [i for i, text in enumerate(labels.values) if text == label]
        name = label if not label.isdigit() else f"pass {label}"
        groups[name] = [_rows(c, rows) for c in columns if c is not labels]
    return groups


def _rows(column: Measured, rows: Sequence[int]) -> Measured:
    values = column.values
    kept = values[list(rows)] if isinstance(values, np.ndarray) else [values[i] for i in rows]
    raw = column.raw
    kept_raw = type(raw)(raw.heading, raw.unit, raw.values, [raw.rows[i] for i in rows])
    return Measured(column.quantity, column.number, kept, kept_raw)


def _one_pass(
    source: Source, name: str, columns: Sequence[Measured], support: int | None, notes: list[str]
) -> MeasuredPass:
    own = {c.quantity: c for c in columns if c.quantity not in ("uplift", "support")}
    histories = [c for c in own.values() if c.quantity in (*_ALONG, "force", "height")]
    if not {"force", "height"} & own.keys():
        histories = []  # an uplift needs no place and no time
    elif len({len(c.values) for c in histories}) > 1:
        sizes = ", ".join(f"{c.raw.heading}: {len(c.values)}" for c in histories)
        raise InputError(f"{source.path}: {name}: columns of different lengths ({shorten(sizes)})")
    end = _end(histories)
    total = max((len(c.values) for c in histories), default=0)
    if total > end:
        notes.append(f"{source.path}: {name}: {counted(total - end, 'row')} at the end without values")
    faults = []
    for column in histories:
        empty = np.flatnonzero(np.isnan(column.values[:end]))
        if empty.size:
            row = column.raw.rows[int(empty[0])]
            faults.append(
                f"{source.path}: row {row}, column {column.raw.heading}: is empty{like_it(empty.size - 1)};"
                " fill it, or leave the row out"
            )
    if faults:
        raise InputError(*faults)
    values: dict[str, Any] = {c.quantity: c.values[:end] for c in histories}
    try:
        return MeasuredPass(name=name, **values, uplift=_uplifts(source, columns, support))
    except InputError as error:
        raise InputError(*(f"{source.path}: {line.removeprefix('measured: ')}" if str(source.path) not in line
                           else line for line in error.problems)) from None  # fmt: skip


def _end(histories: Sequence[Measured]) -> int:
    """Number of rows up to the last one in which what was measured has a value."""
    filled = [np.flatnonzero(~np.isnan(c.values)) for c in histories if c.quantity not in _ALONG]
    return max((int(rows[-1]) + 1 for rows in filled if rows.size), default=0)


def _uplifts(source: Source, columns: Sequence[Measured], support: int | None) -> dict[int, Any]:
    """[m] uplifts by support, empty cells left out. Raises InputError."""
    labels = next((c for c in columns if c.quantity == "support"), None)
    found: dict[int, Any] = {}
    for column in (c for c in columns if c.quantity == "uplift"):
        where = f"{source.path}: row 1, column {column.raw.heading}"
        if column.number is not None:
            found[column.number] = column.values[~np.isnan(column.values)]
            continue
        if labels is None:
            if support is None:
                raise InputError(
                    f"{where}: of which support? name it uplift_support_5_mm, or say --support 5"
                )
            found[support] = column.values[~np.isnan(column.values)]
            continue
        for i, (label, value) in enumerate(zip(labels.values, column.values, strict=True)):
            if not label.isdigit() or int(label) < 1:
                raise InputError(
                    f"{source.path}: row {labels.raw.rows[i]}, column {labels.raw.heading}: {shorten(label)}"
                    " is no number of a support from 1"
                )
            if not np.isnan(value):
                found[int(label)] = np.append(found.get(int(label), []), value)
    if empty := [n for n, values in found.items() if not values.size]:
        raise InputError(f"{source.path}: the uplift of support {empty[0]} has no value")
    return found
