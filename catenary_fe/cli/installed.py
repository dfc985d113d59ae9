"""The line as it is beside its design, for the command ``form``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from catenary_fe.cli.terminal import print_table, say, warned
from catenary_fe.layout import Catenary, CatenaryError, layout_warnings, read_measured
from catenary_fe.results.export import cell
from catenary_fe.results.quantities import decimals_of

if TYPE_CHECKING:
    from catenary_fe.statics import Shape

_COLUMNS = {
    "section": "section", "span": "span", "dropper": "dropper", "chainage_m": "at m", "state": "state",
    "height_difference_mm": "height mm", "design_force_N": "design N", "force_N": "force N",
    "force_difference_N": "more N",
}  # fmt: skip


def measured_line(catenary: Catenary, path: str) -> Catenary:
    """The line with the dropper lengths that explain measured heights. Raises InputError."""
    from catenary_fe.statics import fit_measured

    with warned(layout_warnings(catenary)):
        return fit_measured(catenary, read_measured(path)).catenary


def design_beside(shape: Shape, catenary: Catenary, quiet: bool) -> Shape | None:
    """The design of a line that hangs otherwise, and None of one that hangs as designed.

    Lengths that were given may belong to a design that nobody can hang; that is said, and there is none.
    """
    from catenary_fe.statics import design_of

    if not (shape.catenary.gives_dropper_lengths or shape.catenary.departs_from_design):
        return None
    try:
        return design_of(shape, catenary)
    except CatenaryError as error:
        if not quiet:
            say("note", f"the design itself cannot be hung, to compare with: {error}", "cyan")
        return None


def installed_rows(shape: Shape, design: Shape | None) -> list[dict[str, Any]]:
    """Rows of the comparison; none without a design."""
    from catenary_fe.statics import against_design

    return [row.as_dict() for row in against_design(shape, design)] if design else []


def print_installed(name: str, rows: list[dict[str, Any]]) -> None:
    """Print the comparison's main columns."""
    columns = [
        key for key in _COLUMNS if key in rows[0] and (key != "state" or any(row[key] for row in rows))
    ]
    table = [[cell(row[key], decimals_of(key)) for key in columns] for row in rows]
    print_table(f"{name}: the line as it is, above its design", [_COLUMNS[key] for key in columns], table)
