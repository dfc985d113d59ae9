"""Overlaps of two tension sections: their rule, and a section whose wires run off at its end by it."""

from __future__ import annotations

from math import sqrt
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from catenary_fe.layout.catenary import Catenary
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.parameters import GRAVITY, NonNegative, Parameters, Positive
from catenary_fe.layout.parts import Span

_DISTANCE = {"mechanical": 0.25, "insulated": 0.40}  # [m] 0.25, and 0.30 to 0.45 m (secondary source)
_LIFT = 0.25  # [m] at least, up to 0.5 m (secondary source)
_AWAY = 1.0  # [m] from the track's centre, where a wire is anchored: an assumption
FEWEST = 3  # spans of an overlap by the rule: both wires come, hand over, and go


class Overlap(Parameters):
    """The spans that two tension sections share.

    By the rule the wires that run off are lifted at the last mast before their anchor and run on straight to
    it; droppers are left out where the wire rises by itself. The two lines run side by side on the masts
    between the anchors, in space at `distance`.
    """

    spans: Annotated[int, Field(strict=True, ge=1, le=12)] = 3
    """shared by both sections, those of their anchors included"""
    kind: Literal["mechanical", "insulated"] = "mechanical"
    """an insulated one keeps a greater distance"""
    lift: Positive | None = None
    """[m] of the wires that run off, at the mast before their anchor; unset: 0.25 m"""
    distance: NonNegative | None = None
    """[m] between the two lines; unset: 0.25 m, insulated 0.40 m"""
    anchor_stagger: Positive | None = None
    """[m] from the track's centre of the wires at their anchors; unset: 1 m, an assumption"""
    as_written: bool = False
    """true: heights, staggers and droppers of both sections are as their spans and supports say"""

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        given = [name for name in ("lift", "distance", "anchor_stagger") if getattr(self, name) is not None]
        if self.as_written and given:
            raise ValueError(
                f"{given[0]} has no effect on an overlap that is as_written; leave one of them out"
            )
        if not self.as_written and self.spans < FEWEST:
            raise ValueError(
                f"spans = {self.spans}: an overlap by the rule takes at least {FEWEST}, one in which each"
                " wire is anchored and one for both; take more, or write heights and staggers span by span"
                " (as_written)"
            )
        return self

    @property
    def gap(self) -> float:
        """[m] between the two lines."""
        return _DISTANCE[self.kind] if self.distance is None else self.distance


def run_off(section: Catenary, overlap: Overlap, side: float, turn: float) -> Catenary:
    """A section whose wires run off at its end.

    side : 1 where its line lies to the left of the other one in the overlap, else -1
    turn : likewise of both lines at the first mast between the anchors; they change sides from mast to mast
    """
    lift = _LIFT if overlap.lift is None else overlap.lift
    supports, spans, n = list(section.supports), list(section.spans), overlap.spans
    wire, last = section.contact_wire, spans[-1].length
    curvature = GRAVITY * wire.mass_per_length / wire.tension
    slope = sqrt(2 * lift * curvature)
    heights = section.contact_wire_heights
    spans[-2] = _rising(spans[-2], lift, slope / curvature, len(section.spans) - 1)
    spans[-1] = spans[-1].replace(pre_sag=0.0)
    lifted = {-2: lift, -1: lift + slope * last}
    for i, up in lifted.items():
        supports[i] = supports[i].replace(contact_wire_height=float(heights[i]) + up, stitch_wire=False)
    if section.is_spatial:
        for i in range(1, n):
            zigzag = turn * (-1) ** (i - 1)
            supports[-1 - n + i] = supports[-1 - n + i].replace(
                stagger=overlap.gap / 2 * (side + zigzag), messenger_stagger=overlap.gap / 2 * side
            )
        away = side * (_AWAY if overlap.anchor_stagger is None else overlap.anchor_stagger)
        supports[-1] = supports[-1].replace(stagger=away, messenger_stagger=away)
    return section.replace(spans=tuple(spans), supports=tuple(supports))


def _rising(span: Span, lift: float, rise: float, number: int) -> Span:
    """A span at whose end the contact wire rises by itself, over a length [m]; it has no droppers there."""
    level = span.length - rise
    kept = [d for d in span.droppers if d.position <= level]
    if not kept:
        raise InputError(
            f"span {number}: a contact wire that rises by itself to a lift of {lift:g} m takes {rise:.1f} m"
            f" for that, which leaves no dropper in a span of {span.length:g} m; take a smaller lift or a"
            " longer span"
        )
    offsets = span.height_offsets()
    droppers = tuple(
        d.replace(height_offset=float(offset) - lift * d.position / span.length)
        for d, offset in zip(span.droppers, offsets, strict=True)
        if d.position <= level
    )
    return span.replace(droppers=droppers, pre_sag=0.0)
