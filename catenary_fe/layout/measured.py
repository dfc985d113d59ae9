"""Measured heights and staggers of a contact wire, and the line that they ask for."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout.arguments import checked
from catenary_fe.layout.catenary import Catenary
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.installed import changes_in_words
from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.layout.parts import Support
from catenary_fe.layout.tables import Column, Table, read_table

Floats = NDArray[np.float64]

LONGEST_GAP = 2.0  # [m] between rows, over which heights run straight: 0.1 mm beside a wire's curvature
NEAR = 0.25  # [m] from a row whose height is taken as it is: a millimetre at a gradient of 1 in 250
_COLUMNS = {
    "x": Column("length"),
    "height": Column("length", least=0.0),
    "stagger": Column("length"),
}


@changed_by_copy
@dataclass(frozen=True)
class MeasuredWire:
    """Where a contact wire was measured.

    x : [m], shape (rows,), ascending, from the line's first support
    height : [m], shape (rows,), above the rail
    stagger : [m], shape (rows,), to the left of the track's centre; None where it was not measured
    origin : of the values, for messages

    Raises InputError for places that do not ascend, and for heights that no contact wire has.
    """

    x: Floats
    height: Floats
    stagger: Floats | None = None
    origin: str = "measured heights"

    def __post_init__(self) -> None:
        for name in ("x", "height", "stagger"):
            values = getattr(self, name)
            if values is not None:
                values = np.asarray(values, dtype=float)
                object.__setattr__(self, name, values)
                if values.ndim != 1 or values.shape != self.x.shape or not np.isfinite(values).all():
                    raise InputError(f"{self.origin}: {name}: must be as many finite numbers as x has")
        if not self.x.size or (np.diff(self.x) <= 0).any():
            raise InputError(f"{self.origin}: x must ascend, with at least one row; sort the rows")
        if not ((self.height > 2) & (self.height < 10)).all():
            bad = int(np.argmax(~((self.height > 2) & (self.height < 10))))
            raise InputError(
                f"{self.origin}: height = {self.height[bad]:g} m at x = {self.x[bad]:g} m: contact wires lie 2 to"
                " 10 m above the rail; look at the unit"
            )

    def at(self, name: str, x: float, where: str) -> float:
        """A value [m], "height" or "stagger", at a place: straight between rows that are close.

        where : the place in words

        Raises InputError where there is no row near enough.
        """
        values = getattr(self, name)
        i = int(np.clip(np.searchsorted(self.x, x), 1, max(self.x.size - 1, 1)))
        nearest = int(np.abs(self.x - x).argmin())
        if abs(self.x[nearest] - x) < 1e-9:
            return float(values[nearest])
        pair = slice(i - 1, i + 1)
        if self.x.size > 1 and self.x[i - 1] <= x <= self.x[i] and np.ptp(self.x[pair]) <= LONGEST_GAP:
            return float(np.interp(x, self.x[pair], values[pair]))
        if abs(self.x[nearest] - x) <= NEAR:
            return float(values[nearest])
        raise InputError(
            f"{self.origin}: no height at {where}, x = {x:.2f} m: the nearest row is at {self.x[nearest]:.2f} m;"
            f" measure within {NEAR:g} m of it, or on both sides at most {LONGEST_GAP:g} m apart"
        )


@checked
def read_measured(path: str | Path) -> MeasuredWire:
    """Measured heights from a table (CSV) with columns ``x``, ``height`` and perhaps ``stagger``, with units.

    ``x_m``, ``height [mm]``: from the line's first support, above the rail, to the left of the track's centre.

    Raises InputError, one line for each fault with row and column.
    """
    table = read_table(path, _COLUMNS, ("x", "height"))
    faults = [
        f"{table.where(i, name)}: is empty; measure it, or leave the row out"
        for i, row in enumerate(table.rows)
        for name in table.headings
        if row[name] is None
    ]
    if not faults:
        faults = _descents(table)
    if faults:
        raise InputError(*faults)
    columns: dict[str, Any] = {n: np.array([row[n] for row in table.rows]) for n in table.headings}
    return MeasuredWire(**columns, origin=str(table.path))


def _descents(table: Table) -> list[str]:
    return [
        f"{table.where(i, 'x')}: x = {row['x']:g} m does not lie behind the row before, {before['x']:g} m; sort"
        " the rows, each place once"
        for i, (before, row) in enumerate(zip(table.rows, table.rows[1:], strict=False), start=1)
        if row["x"] <= before["x"]
    ]


def set_to_measured(catenary: Catenary, measured: MeasuredWire) -> Catenary:
    """The line whose design heights, and staggers if there are any, are the measured ones.

    Supports whose steady arm holds the height, and anchors, get the measured height; the messenger wire stays
    where its supports are. Droppers have no lengths: form finding gives those that bring the wire there.

    Raises InputError for lines of several sections, lines that have changed since their droppers were cut, and
    places that were not measured.
    """
    if getattr(catenary, "sections", ()):
        raise InputError(f"{measured.origin}: {catenary.name} has several sections; take one after the other")
    if catenary.departs_from_design:
        raise InputError(
            f"{measured.origin}: the layout says what has changed ({changes_in_words(catenary)}), and measured"
            " heights are of the line as it is: leave out missing droppers, put clamps where they are, give"
            " contact_wire the worn wire's values"
        )
    supports = []
    last = len(catenary.supports) - 1
    for i, support in enumerate(catenary.supports):
        x, where = float(catenary.support_positions[i]), f"support {i + 1}"
        changes: dict[str, Any] = {}
        arm = support.steady_arm
        if i in (0, last) or (arm and arm.holds_height):
            changes["contact_wire_height"] = measured.at("height", x, where)
            if catenary.messenger_wire:
                changes["system_height"] = _system_height(catenary, i, changes["contact_wire_height"], where)
        if measured.stagger is not None and (i in (0, last) or arm):
            changes["stagger"] = measured.at("stagger", x, where)
        supports.append(support.replace(**changes))
    heights = [
        measured.at("height", float(x), f"span {span}: dropper {number}")
        for x, span, number in zip(
            catenary.dropper_positions, catenary.dropper_spans, catenary.dropper_numbers, strict=True
        )
    ]
    return _with_heights(catenary, tuple(supports), np.array(heights)).without_dropper_lengths()


def _system_height(catenary: Catenary, support: int, height: float, where: str) -> float:
    """[m] that leaves the messenger wire where it is. Raises InputError."""
    left = float(catenary.messenger_support_heights[support]) - height
    if left <= 0:
        raise InputError(
            f"{where}: the measured height of {height:g} m lies above the messenger wire at"
            f" {left + height:g} m; look at the unit, or at the system height"
        )
    return left


def with_design_heights_of(goal: Catenary, catenary: Catenary) -> Catenary:
    """The line with the supports of one and the design heights at droppers of the other."""
    return _with_heights(catenary, goal.supports, catenary.design_heights)


def _with_heights(catenary: Catenary, supports: tuple[Support, ...], heights: Floats) -> Catenary:
    """The line with other supports, and design heights [m], shape (droppers,), at its droppers."""
    line = catenary.replace(supports=supports)
    offsets = iter((heights - line.design_line(line.dropper_positions)).tolist())
    spans = tuple(
        span.replace(droppers=tuple(d.replace(height_offset=next(offsets)) for d in span.droppers))
        for span in catenary.spans
    )
    return line.replace(spans=spans)
