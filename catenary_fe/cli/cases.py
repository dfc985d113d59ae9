"""The line at rest under wind, ice and temperature, case by case."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from catenary_fe.cli import options
from catenary_fe.cli.terminal import Answer, print_table, static_shape, working
from catenary_fe.layout import layout_warnings, load_conditions
from catenary_fe.layout.conditions import Conditions
from catenary_fe.results.export import cell, check_xlsx
from catenary_fe.results.quantities import decimals_of

if TYPE_CHECKING:
    from catenary_fe.cli.folder import Folder
    from catenary_fe.statics import CaseRows

EPILOG = """\b
Example:
  catenary-fe cases models/layouts/re330.toml --conditions models/conditions/storm.toml -o cases"""


@click.command(epilog=EPILOG)
@options.layout
@options.conditions("The circumstances, and cases that change them.", required=True)
@options.flag("--xlsx", "Write the tables as a workbook, too (with -o).")
@options.drawn_spans
@options.planar
@options.answer()
def cases(
    layout: str, conditions: str, xlsx: bool, spans: list[int] | None, planar: bool, answer: Answer
) -> int:
    """A LAYOUT at rest under each case of a conditions file: tensions, sags, offsets, supports, devices.

    Exit code 1 where the contact wire leaves the allowed offset of a case, or a steady arm has to push.
    """
    from catenary_fe.statics import case_rows, settle

    if xlsx:
        if answer.folder is None:
            raise click.UsageError("--xlsx writes a workbook: give -o DIR, too")
        check_xlsx()
    given, catenary = load_conditions(conditions), options.read_layout(layout, planar)
    with static_shape(catenary, answer) as (shape, folder):
        settled = []
        for case in given.cases:
            with working(f"case {case.name}", not answer.quiet):
                settled.append(settle(shape, case))
        rows = [case_rows(each) for each in settled]
        warnings = [*layout_warnings(catenary), *estimated(catenary, given)]
        result: dict[str, Any] = {"cases": [row.as_dict() for row in rows], "warnings": warnings}
        if folder:
            from catenary_fe.views import plot_cases

            folder.json("cases.json", result)
            write_tables(folder, rows, xlsx)
            folder.picture("cases.png", plot_cases(settled, spans=spans))
    answer.show(result, lambda: _print(catenary.name, rows))
    return 0 if all(row.holds for row in rows) else 1


def estimated(catenary: Any, given: Conditions) -> list[str]:
    """What of the wires is estimated that the cases use."""
    if not any(case.wind or case.ice for case in given.cases):
        return []
    named = ("contact_wire", "messenger_wire", "stitch_wire")
    missing = [name for name in named if (wire := getattr(catenary, name)) and wire.diameter is None]
    if not missing:
        return []
    return [f"diameter of {', '.join(missing)}: not given; estimated from the mass, as of copper"]


def case_table(row: CaseRows) -> dict[str, Any]:
    """A case in one row."""
    tensions = {f"{wire.name.replace(' ', '_')}_tension_N": wire.tension_N for wire in row.wires}
    travels = [abs(z) for support in row.supports for z in (support.device_travel_mm or {}).values()]
    shifts = [abs(s.cantilever_shift_mm) for s in row.supports if s.cantilever_shift_mm is not None]
    return {
        "case": row.name,
        **tensions,
        "largest_offset_m": row.largest_lateral_offset_m,
        "allowed_offset_m": row.allowed_offset_m,
        "holds": "yes" if row.holds else "NO",
        "lowest_contact_wire_m": row.lowest_contact_wire_m,
        "highest_contact_wire_m": row.highest_contact_wire_m,
        "largest_dropper_force_N": row.largest_dropper_force_N,
        "slack_droppers": row.slack_droppers,
        "pushed_arms": len(row.pushed_arms),
        "largest_cantilever_shift_mm": max(shifts, default=0.0),
        "largest_device_travel_mm": max(travels, default=0.0),
    }


def support_table(row: CaseRows) -> list[dict[str, Any]]:
    """A case's supports, a row each, with the case's name."""
    found = []
    for support in row.supports:
        travel = support.device_travel_mm or {}
        found.append(
            {
                "case": row.name,
                "section": support.section,
                "support": support.support,
                "cantilever_shift_mm": support.cantilever_shift_mm,
                "cantilever_rotation_deg": support.cantilever_rotation_deg,
                "contact_wire_height_m": support.contact_wire_height_m,
                "stagger_m": support.stagger_m,
                "contact_wire_device_mm": travel.get("contact_wire"),
                "messenger_wire_device_mm": travel.get("messenger_wire"),
                **{f"{name}_N": force for name, force in support.forces_N.items()},
            }
        )
    return found


def write_tables(folder: Folder, rows: list[CaseRows], xlsx: bool) -> None:
    """Cases and supports as CSV, perhaps as a workbook, too."""
    from catenary_fe.results.export import write_xlsx

    whole = [case_table(row) for row in rows]
    supports = [each for row in rows for each in support_table(row)]
    folder.table("cases.csv", whole)
    folder.table("supports.csv", supports)
    if xlsx:
        sheets = {"cases": (list(whole[0]), whole), "supports": (list(supports[0]), supports)}
        write_xlsx(folder.path / "cases.xlsx", sheets)


def _print(name: str, rows: list[CaseRows]) -> None:
    tables = [case_table(row) for row in rows]
    columns = [key for key in tables[0] if any(table[key] is not None for table in tables)]
    lines = [
        [key.replace("_", " "), *(_text(key, table[key]) for table in tables)]
        for key in columns
        if key != "case"
    ]
    print_table(f"{name}: cases", ["quantity", *(row.name for row in rows)], lines)


def _text(key: str, value: Any) -> str:
    return "" if value is None else str(cell(value, decimals_of(key)))
