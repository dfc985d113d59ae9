"""Equipment within the spans: section insulators, neutral sections, feeder and jumper clamps."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Literal, Self

from pydantic import Field, model_validator

from catenary_fe.layout.parameters import NonNegative, Number, Parameters, Positive, Text

if TYPE_CHECKING:
    from catenary_fe.layout.catenary import Catenary

CLOSEST = 0.01  # [m] between an end of equipment and the next clamp or support, where they do not meet


class Equipment(Parameters):
    """What sits on a wire at a place within the spans: its mass, and its stiffness over its length.

    Its weight hangs on the wire from the start: droppers are cut with it in place. Without a length it is one
    mass at a point (a feeder or jumper clamp); with one, its mass is spread evenly over it (a section
    insulator, the insulating rods of a neutral section). The contact wire runs on under it: a skid that
    changes the running surface is no part of it.
    """

    x: Number | None = None
    """[m] of its middle from the line's first support; or give `span` and `position`"""
    span: Annotated[int, Field(strict=True)] | None = None
    """number of the span that it is in, from 1, beside `position`"""
    position: Number | None = None
    """[m] of its middle from that span's first support"""
    wire: Literal["contact wire", "messenger wire"] = "contact wire"
    """the wire that carries it; of two contact wires each carries half of the mass"""
    mass: NonNegative
    """[kg] beside the wire's own"""
    length: NonNegative = 0.0
    """[m] along the wire, half of it to each side of its middle; 0: a mass at a point"""
    bending_stiffness: Positive | None = None
    """[N m²] EI of wire and equipment together over its length; unset: the wire's own"""
    name: Text = ""
    """what it is, e.g. 'section insulator'"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        by_span = [self.span is not None, self.position is not None]
        if (self.x is not None) == any(by_span) or any(by_span) != all(by_span):
            raise ValueError("x, or span and position: give exactly one of the two, the place of its middle")
        return self

    @model_validator(mode="after")
    def _stiff_over_a_length(self) -> Self:
        if self.bending_stiffness is not None and not self.length:
            raise ValueError(
                f"bending_stiffness = {self.bending_stiffness:g} N m² has no effect without a length;"
                " give the length over which the wire is as stiff, or leave it out"
            )
        if not self.mass and self.bending_stiffness is None:
            raise ValueError("mass = 0 without a bending_stiffness has no effect; give one of them")
        return self

    @property
    def place(self) -> str:
        """Its name, wire and place as they were written, for messages and tables."""
        at = f"x = {self.x:g} m" if self.x is not None else f"{self.position:g} m in span {self.span}"
        return f"{self.name or 'equipment'} on the {self.wire} at {at}"

    def middle(self, catenary: Catenary) -> float:
        """[m] from the line's first support."""
        if self.span is None or self.position is None:
            assert self.x is not None
            return self.x
        return float(catenary.support_positions[self.span - 1]) + self.position

    def ends(self, catenary: Catenary) -> tuple[float, float]:
        """[m] where it begins and ends; the same place of a mass at a point."""
        middle = self.middle(catenary)
        return middle - self.length / 2, middle + self.length / 2

    def stations(self, catenary: Catenary) -> list[float]:
        """[m] where the mesh of its wire needs a node: at its ends and in its middle."""
        begin, end = self.ends(catenary)
        return [begin, (begin + end) / 2, end] if self.length else [begin]

    def mirrored(self, catenary: Catenary) -> Self:
        """The same on the mirror image of a line."""
        if self.span is None or self.position is None:
            return self.replace(x=catenary.length - self.middle(catenary))
        length = catenary.spans[self.span - 1].length
        return self.replace(span=len(catenary.spans) + 1 - self.span, position=length - self.position)


def stations(catenary: Catenary, wire: str) -> list[float]:
    """[m] where equipment, and a midpoint anchor, need nodes in the mesh of a wire, by its name."""
    found = [x for item in catenary.equipment if item.wire == wire for x in item.stations(catenary)]
    held = catenary.midpoint_position
    return found if held is None or wire == "stitch wire" else [*found, held]


def equipment_faults(catenary: Catenary) -> Iterator[str]:
    """One line for each piece that is not on the line, too close to a clamp, or on another piece."""
    found: dict[str, list[tuple[float, float, str]]] = {}
    for n, item in enumerate(catenary.equipment, start=1):
        where, count = f"equipment {n}", len(catenary.spans)
        if item.span is not None and not 1 <= item.span <= count:
            yield f"{where}: span = {item.span}: the line has spans 1 to {count}"
            continue
        if item.span is not None and not 0 <= (item.position or 0.0) <= catenary.spans[item.span - 1].length:
            yield (
                f"{where}: position = {item.position:g} m lies outside span {item.span} of"
                f" {catenary.spans[item.span - 1].length:g} m; positions count from the span's first support"
            )
            continue
        begin, end = item.ends(catenary)
        if begin <= 0 or end >= catenary.length:
            yield (
                f"{where}: reaches from {begin:g} to {end:g} m: must lie between the line's ends, 0 and"
                f" {catenary.length:g} m"
            )
            continue
        yield from (f"{where}: {line}" for line in _too_close(catenary, item))
        found.setdefault(item.wire, []).append((begin, end, where))
    for pieces in found.values():
        for (_, end, first), (begin, _, second) in pairwise(sorted(pieces)):
            if begin < end:
                yield (
                    f"{second} begins at {begin:g} m, before {first} ends at {end:g} m on the same wire;"
                    " part them"
                )


def _too_close(catenary: Catenary, item: Equipment) -> Iterator[str]:
    import numpy as np

    fixed = np.concatenate([catenary.support_positions, catenary.dropper_positions])
    if catenary.midpoint_position is not None:
        fixed = np.append(fixed, catenary.midpoint_position)
    for x in item.stations(catenary):
        near = float(fixed[np.abs(fixed - x).argmin()])
        if 1e-6 < abs(near - x) < CLOSEST:
            yield (
                f"its end or middle at {x:.6g} m lies less than {CLOSEST:g} m from the clamp, anchor or"
                f" support at {near:.6g} m; move it there, or further away"
            )
