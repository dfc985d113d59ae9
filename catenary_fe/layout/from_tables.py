"""Lines from tables: one row a mast, one row a dropper, as crews and design offices keep them."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

from catenary_fe.layout.arguments import checked
from catenary_fe.layout.builders import LinePattern, stitch_wire_length
from catenary_fe.layout.catenary import Catenary
from catenary_fe.layout.errors import InputError, counted
from catenary_fe.layout.line import join_sections
from catenary_fe.layout.overlap import Overlap
from catenary_fe.layout.parts import Dropper, Span, SteadyArm, Support
from catenary_fe.layout.tables import (
    DROPPER_COLUMNS,
    MAST_COLUMNS,
    ROUNDED,
    Table,
    by_section,
    one_wire,
    read_table,
)


@dataclass(frozen=True)
class LineFromTables:
    """A line, and what the tables hold beside.

    not_read : by file, headings of columns that hold results, such as forces: they follow from the line
    """

    catenary: Catenary
    not_read: dict[str, tuple[str, ...]]


@checked
def catenary_from_tables(
    masts: str | Path, droppers: str | Path | None = None, *, base: Any, name: str | None = None
) -> Catenary:
    """A line from tables of its masts and droppers (CSV), such as ``catenary-fe form -o`` writes.

    Columns carry their unit: ``stagger_mm``, ``chainage [m]``. Mast tables need ``chainage`` and ``stagger``,
    dropper tables ``span`` and ``position`` or ``chainage``. Droppers with a ``length`` are hung with it. Of
    several tension sections, a column ``section`` numbers them; the masts of an overlap are there for both.

    masts : file, one row a mast
    droppers : file, one row a dropper; unset: by the rule of the line type, or as spans of the same length
        have them in the base
    base : what the tables do not hold: a Catenary, whose wires, damping, arms and droppers are taken, or the
        name of a line in the library
    name : of the line; unset: the mast table's

    Raises InputError, one line for each fault with file, row and column.
    """
    return read_line(masts, droppers, base=base, name=name).catenary


def read_line(
    masts: str | Path, droppers: str | Path | None = None, *, base: Any, name: str | None = None
) -> LineFromTables:
    """As :func:`catenary_from_tables`, with what was not read."""
    pattern, name = LinePattern.of(base), name or Path(masts).stem
    mast_table = one_wire(read_table(masts, MAST_COLUMNS, ("chainage", "stagger"), numbered=True))
    dropper_table = None if droppers is None else read_table(droppers, DROPPER_COLUMNS, ("span",))
    parts, hung = by_section(mast_table), by_section(dropper_table) if dropper_table else {}
    if dropper_table and hung.keys() != parts.keys():
        raise InputError(
            f"{dropper_table.path}: droppers of sections {_listed(hung)}, masts of {_listed(parts)}: give"
            " both for each section"
        )
    made = [_section(part, hung.get(n), pattern, name) for n, part in parts.items()]
    tables = [mast_table, *([dropper_table] if dropper_table else [])]
    found = made[0] if len(made) == 1 else _joined(list(parts.values()), made)
    return LineFromTables(found, {str(t.path): t.not_read for t in tables if t.not_read})


def _listed(parts: Iterable[int]) -> str:
    return ", ".join(map(str, parts))


def _joined(tables: Sequence[Table], sections: Sequence[Catenary]) -> Catenary:
    """Sections with the overlaps that their masts share, as the tables have them."""
    overlaps = []
    for before, behind in pairwise(tables):
        first = behind.rows[0]["chainage"]
        shared = sum(row["chainage"] > first - ROUNDED for row in before.rows) - 1
        if shared < 1:
            raise InputError(
                f"{behind.where(0, 'chainage')}: {first:g} m: the sections share no span; they must overlap"
            )
        overlaps.append(Overlap(spans=min(shared, 12), as_written=True))
    try:
        return join_sections(sections, overlaps)
    except InputError as error:
        raise InputError(*(f"{tables[0].path}: {text}" for text in error.problems)) from None


def _section(mast_table: Table, dropper_table: Table | None, pattern: LinePattern, name: str) -> Catenary:
    """The line of one section. Raises InputError."""
    at = _chainages(mast_table)
    lengths = [round(b - a, 6) for a, b in pairwise(at)]
    _check_spans(mast_table, lengths)
    supports = _supports(mast_table, pattern, lengths)
    if dropper_table is None:
        spans = [pattern.span(length) for length in lengths]
    else:
        spans = _spans(dropper_table, pattern, at, lengths)
    line = pattern.line
    try:
        found = line.replace(
            name=name,
            source=f"{line.source}; masts and droppers of tables".removeprefix("; "),
            spans=_with_own(mast_table, spans),
            supports=supports,
            midpoint=_midpoint(mast_table, line),
            evaluated_spans=None,
        )
    except InputError as error:
        raise InputError(*(_placed(text, mast_table, dropper_table) for text in error.problems)) from None
    if dropper_table is not None:
        _check_hangers(dropper_table, found)
    return found


def _chainages(table: Table) -> list[float]:
    faults: list[str] = []
    found: list[float] = []
    for i, row in enumerate(table.rows):
        if row.get("support") not in (None, i + 1):
            faults.append(
                f"{table.where(i, 'support')}: {row['support']}: must be {i + 1}, one row a mast in order"
            )
        for name in ("chainage", "stagger"):
            if row[name] is None:
                faults.append(f"{table.where(i, name)}: is empty; give a number")
        x = row["chainage"]
        if x is not None and found and x <= found[-1]:
            faults.append(
                f"{table.where(i, 'chainage')}: {x:g} m does not come after the mast before it,"
                f" at {found[-1]:g} m"
            )
        elif x is not None:
            found.append(x)
    if not faults and len(found) < 2:
        faults.append(f"{table.path}: {counted(len(found), 'mast')}: a line has at least two")
    if faults:
        raise InputError(*faults)
    return found


def _check_spans(table: Table, lengths: Sequence[float]) -> None:
    """Raises InputError where columns of the spans beside a mast do not say what the chainages say."""
    faults = []
    ends: list[float | None] = [None, *lengths, None]
    for name, shift in (("span_before", 0), ("span_after", 1)):
        for i, row in enumerate(table.rows):
            given, found = row.get(name), ends[i + shift]
            if given is not None and (found is None or abs(given - found) > ROUNDED):
                real = "there is none" if found is None else f"it is {found:g} m by the chainages"
                faults.append(f"{table.where(i, name)}: {given:g} m: {real}")
    if table.rows[0].get("curve_radius_before"):
        faults.append(
            f"{table.where(0, 'curve_radius_before')}: no span ends at the first mast; leave it empty"
        )
    for name in ("curve_radius_after", "pre_sag"):
        if table.rows[-1].get(name):
            faults.append(
                f"{table.where(len(table.rows) - 1, name)}: no span begins at the last mast; leave it empty"
            )
    if faults:
        raise InputError(*faults)


def _with_own(table: Table, spans: Sequence[Span]) -> tuple[Span, ...]:
    """The spans with what the mast table holds of them. Raises InputError with the row."""
    found, faults = [], []
    for i, span in enumerate(spans):
        row = table.rows[i]
        own = {"curve_radius": row.get("curve_radius_after") or None, "curve_radius_end": None}
        if "curve_radius_before" in row:  # of a transition curve, at its end
            end = table.rows[i + 1]["curve_radius_before"] or 0.0
            own["curve_radius_end"] = None if end == (own["curve_radius"] or 0.0) else end
        own |= {"pre_sag": row["pre_sag"]} if row.get("pre_sag") is not None else {}
        try:
            found.append(span.replace(**own))
        except InputError as error:
            faults += [text if text.startswith(str(table.path)) else f"{table.where(i)}: {text}"
                       for text in error.problems]  # fmt: skip
    if faults:
        raise InputError(*faults)
    return tuple(found)


def _placed(text: str, masts: Table, droppers: Table | None) -> str:
    """A fault of the whole line with the file, and the row of the dropper or the mast that it is about."""
    if droppers and (found := re.match(r"span (\d+): dropper (\d+)", text)):
        rows = [i for i, row in enumerate(droppers.rows) if row.get("span") == int(found[1])]
        return f"{droppers.where(rows[int(found[2]) - 1])}: {text}"
    if found := re.match(r"(?:support|span) (\d+)\b", text):
        return f"{masts.where(int(found[1]) - 1)}: {text}"
    return text if text.startswith(str(masts.path)) else f"{masts.path}: {text}"


def _midpoint(table: Table, line: Catenary) -> int | None:
    """Number of the support that is said to be the midpoint. Raises InputError where that is not clear."""
    marked = [i for i, row in enumerate(table.rows) if row.get("midpoint")]
    if len(marked) > 1:
        raise InputError(f"{table.where(marked[1], 'midpoint')}: yes: a section has one midpoint")
    if line.midpoint and not table.has("midpoint"):
        raise InputError(
            f"{table.path}: row 1: the base has a midpoint; add a column midpoint, with yes at its support"
        )
    return marked[0] + 1 if marked else None


def _supports(table: Table, pattern: LinePattern, lengths: Sequence[float]) -> tuple[Support, ...]:
    faults: list[str] = []
    found = []
    for i, row in enumerate(table.rows):
        inside = 0 < i < len(table.rows) - 1
        own = {
            name: row[name] for name in ("stagger", "messenger_stagger", "cant") if row.get(name) is not None
        }
        for name in ("contact_wire_height", "system_height"):
            if row.get(name) is not None and row[name] != getattr(pattern.line, name):
                own[name] = row[name]
        try:
            own |= _stitch(row, pattern, lengths[i - 1 : i + 1]) if inside else {}
            arm = _arm(row, pattern.support.steady_arm) if inside else pattern.support.steady_arm
            found.append(pattern.support.replace(steady_arm=arm, **own))
        except InputError as error:
            faults += [f"{table.where(i)}: {line}" for line in error.problems]
    if faults:
        raise InputError(*faults)
    for end, inner in ((0, 1), (-1, -2)):  # anchored, whatever is written there: as the next one
        same = {n: getattr(found[inner], n) for n in ("steady_arm", "stitch_wire", "stitch_wire_length")}
        found[end] = found[end].replace(**same)
    return tuple(found)


def _stitch(row: dict[str, Any], pattern: LinePattern, beside: Sequence[float]) -> dict[str, Any]:
    """Whether, and how long, a stitch wire hangs at a support; the rule's where the table does not say."""
    hangs, length = row.get("stitch_wire"), row.get("stitch_wire_length")
    wire = pattern.line.stitch_wire
    if wire is None:
        if hangs or length:
            raise InputError("a stitch wire, but the base has none")
        return {}
    if hangs is None and "stitch_wire_length" in row:
        hangs = bool(length)
    if hangs is None and pattern.kind and pattern.kind.dropper_rule == "Re":
        length = stitch_wire_length(beside[0], beside[1], wire.length)
        hangs = length > 0
    if hangs is False and length:
        raise InputError(f"stitch_wire = no, and a stitch_wire_length of {length:g} m; give one of them")
    own = length if length and length != wire.length else None
    return {"stitch_wire": hangs is not False, "stitch_wire_length": own}


def _arm(row: dict[str, Any], usual: SteadyArm | None) -> SteadyArm | None:
    """The arm of a support. Raises InputError where the base has none that it could be like."""
    kind = row.get("arm_kind")
    own = {key: row[f"arm_{key}"] for key in ("side", "length", "stiffness") if row.get(f"arm_{key}")}
    own |= {"uplift_room": row["uplift_room"]} if row.get("uplift_room") else {}
    if kind == "none":
        if own:
            raise InputError(f"arm_kind = none, and a value for its {', '.join(own)}; give one of them")
        return None
    if usual is None:
        if kind or own:
            raise InputError("a steady arm, but the base has none to take its masses from")
        return None
    usual_kind = "spring" if usual.length is None else "link"
    if kind and kind != usual_kind:
        raise InputError(f"arm_kind = {kind}, but the base's steady arms are of the kind {usual_kind}")
    return usual.replace(**own)


def _spans(table: Table, pattern: LinePattern, at: Sequence[float], lengths: Sequence[float]) -> list[Span]:
    """The spans with their droppers, as the dropper table has them."""
    if not (table.has("position") or table.has("chainage")):
        raise InputError(f"{table.path}: row 1: column position_m or chainage_m is missing; add one")
    faults: list[str] = []
    found: list[list[Dropper]] = [[] for _ in lengths]
    last = 0
    for i, row in enumerate(table.rows):
        span = row["span"]
        if span is None or not 1 <= span <= len(lengths):
            said = "is empty" if span is None else f"{span}"
            faults.append(f"{table.where(i, 'span')}: {said}: the line has spans 1 to {len(lengths)}")
            continue
        if span < last:
            faults.append(
                f"{table.where(i, 'span')}: {span} does not come after span {last}; list them in order"
            )
            continue
        last = span
        try:
            found[span - 1].append(_dropper(table, i, pattern, at, len(found[span - 1]) + 1))
        except InputError as error:
            faults += error.problems
    faults += [
        f"{table.path}: span {n} has no droppers; give its rows"
        for n, each in enumerate(found, 1)
        if not each
    ] * (not faults)
    spans = []
    for n, (length, droppers) in enumerate(zip(lengths, found, strict=True), start=1):
        try:
            spans.append(Span(length=length, droppers=tuple(droppers), pre_sag=pattern.sag * length))
        except InputError as error:
            faults += [
                f"{table.path}: span {n}: {line.removeprefix('droppers: ')}" for line in error.problems
            ]
    if faults:
        raise InputError(*faults)
    return spans


def _dropper(table: Table, i: int, pattern: LinePattern, at: Sequence[float], number: int) -> Dropper:
    """The dropper of a row. Raises InputError with the place."""
    row, faults = table.rows[i], []
    span = row["span"]

    def refuse(name: str, text: str) -> None:
        faults.append(f"{table.where(i, name)}: {text}")

    for name, right in (("dropper", number), ("from_support", span), ("to_support", span + 1)):
        if row.get(name) not in (None, right):
            refuse(name, f"{row[name]}: must be {right}, as the rows of span {span} stand")
    x, chainage = row.get("position"), row.get("chainage")
    from_chainage = None if chainage is None else round(chainage - at[span - 1], 9)
    if x is None and from_chainage is None:
        refuse("position" if table.has("position") else "chainage", "is empty; give a number")
    elif x is not None and from_chainage is not None and abs(x - from_chainage) > ROUNDED:
        refuse(
            "chainage", f"{chainage:g} m: the position of {x:g} m in span {span} is at {at[span - 1] + x:g} m"
        )
    length = _length(row, refuse)
    wire = row.get("contact_wire")
    twin = pattern.line.contact_wire_spacing is not None
    if wire is not None and wire not in ((1, 2) if twin else (1,)):
        refuse(
            "contact_wire", f"{wire}: must be " + ("1 or 2" if twin else "1: the base has one contact wire")
        )
    if faults:
        raise InputError(*faults)
    place = from_chainage if x is None else x
    assert place is not None
    return pattern.dropper.replace(
        position=float(place),
        length=length,
        height_offset=row.get("height_offset"),
        contact_wire=wire if twin else None,
    )


def _length(row: dict[str, Any], refuse: Callable[[str, str], None]) -> float | None:
    """[m] of a dropper: the finer of its two columns, where they agree."""
    length, cut = row.get("length"), row.get("cut_length")
    if length is not None and cut is not None and abs(length - cut) > 0.6e-3:
        refuse("cut_length", f"{1e3 * cut:g} mm: the length is {1e3 * length:g} mm; give one of them")
    found: float | None = cut if length is None else length
    if found == 0:
        refuse(
            "cut_length" if length is None else "length", "0: a dropper has a length; leave it empty for none"
        )
    return found


def _check_hangers(table: Table, catenary: Catenary) -> None:
    """Raises InputError where a dropper is said to hang on a wire that it does not reach."""
    faults = []
    ends = [
        (x - length / 2, x + length / 2)
        for x, length in zip(catenary.support_positions, catenary.stitch_wire_lengths, strict=True)
        if length
    ]
    for i, (row, x) in enumerate(zip(table.rows, catenary.dropper_positions, strict=True)):
        wire = "stitch wire" if any(a < x < b for a, b in ends) else "messenger wire"
        if row.get("hangs_on") not in (None, wire):
            faults.append(f"{table.where(i, 'hangs_on')}: {row['hangs_on']}: at this place it is the {wire}")
    if faults:
        raise InputError(*faults)
