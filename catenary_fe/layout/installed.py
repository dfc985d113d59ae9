"""What has changed on a line since its droppers were cut: droppers gone, clamps slid, contact wire worn."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from catenary_fe.layout.errors import counted
from catenary_fe.layout.parameters import Number, Parameters, Positive
from catenary_fe.layout.parts import CLOSEST

if TYPE_CHECKING:
    from catenary_fe.layout.catenary import Catenary
    from catenary_fe.layout.parts import Span

Floats = NDArray[np.float64]

MOST_WORN = 0.5  # share that must be left: wires are taken down at 0.7 or 0.8
_Share = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=MOST_WORN, le=1.0)]


class Wear(Parameters):
    """How much of the contact wire's cross-section is left in a span, or from one place to another.

    Mass per length and EA go with the area, EI with its square (an assumption, exact for sections that shrink
    alike; a flat worn from below leaves a little less). The tension stays: weights hold it. An element that
    lies in two ranges has their mean.
    """

    begin: Number | None = None
    """[m] from the line's first support, beside `end`; or give `span`"""
    end: Number | None = None
    """[m] from the line's first support"""
    span: Annotated[int, Field(strict=True)] | None = None
    """number of the span, from 1, that is worn from support to support"""
    area_left: _Share
    """[1] residual area over that of the new wire"""
    contact_wire: Literal[1, 2] | None = None
    """which of two contact wires is worn, the right (1) or the left (2) one; unset: both"""
    transition: Positive | None = None
    """[m] over which the wear comes and goes at the ends of its range: pantographs then run on the surface
    that it has left; unset: the surface is taken as even"""

    @model_validator(mode="after")
    def _one_place(self) -> Self:
        by_ends = [self.begin is not None, self.end is not None]
        if (self.span is not None) == any(by_ends) or any(by_ends) != all(by_ends):
            raise ValueError("span, or begin and end: give exactly one of the two, the range that is worn")
        if self.begin is not None and self.end is not None and self.end <= self.begin:
            raise ValueError(
                f"end = {self.end:g} m does not lie behind begin = {self.begin:g} m; exchange them"
            )
        return self

    def ends(self, catenary: Catenary) -> tuple[float, float]:
        """[m] where the range begins and ends, from the line's first support."""
        if self.span is not None:
            begin, end = catenary.support_positions[self.span - 1 : self.span + 1].tolist()
            return begin, end
        assert self.begin is not None
        assert self.end is not None
        return self.begin, self.end

    def mirrored(self, catenary: Catenary) -> Self:
        """The same on the mirror image of a line."""
        if self.span is not None:
            return self.replace(span=len(catenary.spans) + 1 - self.span)
        begin, end = self.ends(catenary)
        return self.replace(begin=catenary.length - end, end=catenary.length - begin)


def changes_of(catenary: Catenary) -> dict[str, int]:
    """How many of each change there are since the droppers were cut, by their names in words."""
    parts = getattr(catenary, "sections", ()) or (catenary,)
    all_of = [dropper for part in parts for span in part.spans for dropper in span.droppers]
    found = {
        "dropper missing": sum(d.state == "missing" for d in all_of),
        "dropper broken": sum(d.state == "broken" for d in all_of),
        "clamp slid": sum(bool(d.clamp_shift) and d.state is None for d in all_of),
        "range of worn contact wire": sum(len(part.wear) for part in parts),
        "deviation as built": sum(len(part.as_built.given) for part in parts if part.as_built),
    }
    return {name: count for name, count in found.items() if count}


def changes_in_words(catenary: Catenary) -> str:
    """The changes since the droppers were cut, such as "2 droppers missing"; empty without any."""
    return ", ".join(
        counted(count, name.split()[0]) + name.removeprefix(name.split()[0])
        for name, count in changes_of(catenary).items()
    )


def worn_mass(catenary: Catenary) -> float:
    """[kg] that has worn off the contact wires."""
    lost = 0.0
    for part in getattr(catenary, "sections", ()) or (catenary,):
        for wear in part.wear:
            begin, end = wear.ends(part)
            wires = len(part.contact_wire_offsets) if wear.contact_wire is None else 1
            lost += wires * (1 - wear.area_left) * (end - begin) * part.contact_wire.mass_per_length
    return lost


def designed_spans(catenary: Catenary) -> tuple[Any, ...]:
    """The spans with all droppers in place, and each clamp where it was put."""
    as_put: dict[str, Any] = {"state": None, "clamp_shift": 0.0}
    return tuple(
        span.replace(droppers=tuple(d.replace(**as_put) for d in span.droppers))
        if any(d.state or d.clamp_shift for d in span.droppers)
        else span
        for span in catenary.spans
    )


def worn_depth(wear: Wear, diameter: float) -> float:
    """[m] by which the running surface has come nearer to the wire's axis: worn off flat, from below.

    The wire's grooves are left out: the section is a circle, of which a segment is gone.

    diameter : [m] of the new wire
    """
    from scipy.optimize import brentq

    worn = np.pi * (1 - wear.area_left)
    half_angle = brentq(lambda a: a - np.sin(a) * np.cos(a) - worn, 0.0, np.pi)
    return float(diameter / 2 * (1 - np.cos(half_angle)))


def worn_surface(catenary: Catenary, wire: int, diameter: float, x: Floats) -> Floats:
    """[m], shape of x [m]: by how much a contact wire's running surface lies above that of a new one.

    wire : its number, from 0
    """
    surface: Floats = np.zeros(x.shape)
    for wear in catenary.wear:
        if wear.transition is None or wear.contact_wire not in (None, wire + 1):
            continue
        depth, (begin, end) = worn_depth(wear, diameter), wear.ends(catenary)
        for place, sign in ((begin, 1.0), (end, -1.0)):
            if 0 < place < catenary.length:  # to the line's ends the wear goes on
                share = np.clip((x - place) / wear.transition + 0.5, 0, 1)
                surface += sign * depth * (1 - np.cos(np.pi * share)) / 2
            elif sign > 0:
                surface += depth
    return surface


class BrokenDroppers(NamedTuple):
    """Droppers that left their clamps on the wires.

    x : [m], shape (broken,), along the line
    contact_wires : shape (broken,), number of the contact wire, from 0, that each has held
    lower, upper : [kg], shape (broken,), of the clamps
    """

    x: NDArray[np.float64]
    contact_wires: NDArray[np.int64]
    lower: NDArray[np.float64]
    upper: NDArray[np.float64]


def broken_droppers(catenary: Catenary) -> BrokenDroppers:
    """Those of a line, in order."""
    designed = catenary.as_designed()
    broken = np.array([d.state == "broken" for span in catenary.spans for d in span.droppers], dtype=bool)
    clamps = np.array([(d.contact_wire_clamp_mass, d.messenger_clamp_mass) for d in designed.droppers])
    lower, upper = clamps.reshape(-1, 2)[broken].T
    return BrokenDroppers(
        designed.dropper_positions[broken], designed.dropper_contact_wires[broken], lower, upper
    )


def change_faults(catenary: Catenary) -> Iterator[str]:
    """One line for each clamp that cannot have slid so far, and each worn range that does not fit."""
    yield from _shift_faults(catenary)
    yield from _wear_faults(catenary)


def _shift_faults(catenary: Catenary) -> Iterator[str]:
    for i, span in enumerate(catenary.spans, start=1):
        for number, dropper in enumerate(span.droppers, start=1):
            where, shift = f"span {i}: dropper {number}", dropper.clamp_shift
            if shift and dropper.state:
                yield (
                    f"{where}: clamp_shift = {shift:g} m of a dropper that is {dropper.state}; leave one of"
                    " them out"
                )
        yield from (f"span {i}: {line}" for line in _clamps_that_meet(span))


def _clamps_that_meet(span: Span) -> Iterator[str]:
    hanging = [(n, d) for n, d in enumerate(span.droppers, start=1) if d.state is None]
    inner = [(d.position + d.clamp_shift, f"dropper {n}", bool(d.clamp_shift)) for n, d in hanging]
    clamps = [(0.0, "the support", False), *inner, (span.length, "the support", False)]
    for pair in pairwise(clamps):
        (x, name, slid), (other_x, other, _) = pair if pair[0][2] else pair[::-1]
        if slid and pair[1][0] - pair[0][0] < CLOSEST:
            yield (
                f"{name}: clamp_shift puts its clamp at {x:g} m, on or past {other} at {other_x:g} m; a clamp"
                " stops at the next one"
            )


def _wear_faults(catenary: Catenary) -> Iterator[str]:
    ranges: list[tuple[float, float, int]] = []
    for n, wear in enumerate(catenary.wear, start=1):
        if wear.span is not None and not 1 <= wear.span <= len(catenary.spans):
            yield f"wear {n}: span = {wear.span}: the line has spans 1 to {len(catenary.spans)}"
            continue
        if wear.contact_wire is not None and catenary.contact_wire_spacing is None:
            yield (
                f"wear {n}: contact_wire = {wear.contact_wire}, but there is one contact wire; give"
                " contact_wire_spacing for two, or leave it out"
            )
        begin, end = wear.ends(catenary)
        if begin < -1e-6 or end > catenary.length + 1e-6:
            yield (
                f"wear {n}: from {begin:g} to {end:g} m: must lie between the line's ends, 0 and"
                f" {catenary.length:g} m"
            )
        for a, b, other in ranges:
            mine, theirs = wear.contact_wire, catenary.wear[other - 1].contact_wire
            if min(b, end) - max(a, begin) > 1e-6 and (mine is None or theirs is None or mine == theirs):
                yield (
                    f"wear {n}: from {begin:g} to {end:g} m overlaps with wear {other}, from {a:g} to {b:g} m"
                    " on the same wire; part them"
                )
        ranges.append((begin, end, n))
