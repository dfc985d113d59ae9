"""The tables of a static shape for those who build it: droppers and supports."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from catenary_fe.cli.terminal import print_table
from catenary_fe.results.export import cell, common_name
from catenary_fe.results.quantities import decimals_of

if TYPE_CHECKING:
    from catenary_fe.cli.folder import Folder
    from catenary_fe.statics import Shape

_DROPPERS = (
    "span", "dropper", "chainage_m", "hangs_on", "contact_wire", "cut_length_mm", "installed_length_m",
    "force_N", "contact_wire_height_error_mm",
)  # fmt: skip
_SUPPORTS = (
    "support", "chainage_m", "stagger_m", "contact_wire_height_m", "system_height_m", "arm_vertical_N",
    "arm_lateral_N", "messenger_vertical_N", "messenger_lateral_N",
)  # fmt: skip
_SHORT = {
    "chainage_m": "at m",
    "contact_wire_height_error_mm": "height error mm",
    "cut_length_mm": "cut mm",
    "installed_length_m": "installed m",
    "contact_wire_height_m": "wire height m",
    "messenger_vertical_N": "messenger up N",
    "messenger_lateral_N": "messenger left N",
    "arm_vertical_N": "arm up N",
    "arm_lateral_N": "arm left N",
}


def write_schedules(folder: Folder, shape: Shape) -> None:
    """Write the tables of droppers and supports as CSV, all columns on every line."""
    from catenary_fe.statics import DropperRow

    droppers = [row.as_record() for row in shape.dropper_schedule()]
    folder.table("dropper_schedule.csv", droppers, columns=DropperRow.columns())
    folder.table("support_schedule.csv", [row.as_dict() for row in shape.support_schedule()])


def print_schedules(shape: Shape) -> None:
    """Print what matters most of both tables."""
    name, several = shape.catenary.name, len(shape.contact_wires) > 1
    supports = [key for key in _SUPPORTS if not (several and key == "contact_wire_height_m")]  # no room
    _print(f"{name}: dropper schedule", [row.as_dict() for row in shape.dropper_schedule()], _DROPPERS)
    _print(f"{name}: supports", [row.as_dict() for row in shape.support_schedule()], supports)


def _print(title: str, rows: Sequence[Mapping[str, Any]], wanted: Sequence[str]) -> None:
    """The wanted columns, those of each contact wire among them, as far as the line has them."""
    columns = [
        key
        for key in (rows[0] if rows else ())
        if common_name(key) in wanted and any(row[key] is not None for row in rows)
    ]
    columns.sort(key=lambda key: wanted.index(common_name(key)))
    table = [
        ["" if row[key] is None else cell(row[key], decimals_of(key)) for key in columns] for row in rows
    ]
    print_table(title, [_heading(key) for key in columns], table)


def _heading(key: str) -> str:
    common = common_name(key)
    number = key[len(common) :] and ("right " if "_1_" in key else "left ")
    return number + _SHORT.get(common, common.replace("_", " "))
