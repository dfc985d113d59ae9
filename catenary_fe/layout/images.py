"""A line seen otherwise: in the vertical plane, and in a mirror."""

from __future__ import annotations

from math import tan
from typing import TYPE_CHECKING, TypeVar

from catenary_fe.layout.as_built import mirrored
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.parameters import GRAVITY
from catenary_fe.layout.parts import Span, SteadyArm

if TYPE_CHECKING:
    from catenary_fe.layout.catenary import Catenary

_Line = TypeVar("_Line", bound="Catenary")


def in_the_plane(catenary: _Line) -> _Line:
    """See :meth:`Catenary.planar`."""
    supports = [
        s.replace(
            stagger=0.0,
            messenger_stagger=0.0,
            cant=0.0,
            messenger_lateral_stiffness=None,
            messenger_lateral_damping=0.0,
            steady_arm=s.steady_arm and _arm_in_the_plane(s.steady_arm, abs(float(pull)), i),
        )
        for i, (s, pull) in enumerate(zip(catenary.supports, catenary.lateral_pulls, strict=True), start=1)
    ]
    for end, beside in ((0, 1), (-1, -2)):  # anchors: an arm has no effect there, and is as the others
        if supports[end].steady_arm and supports[beside].steady_arm:
            supports[end] = supports[end].replace(steady_arm=supports[beside].steady_arm)
    spans = tuple(span.replace(curve_radius=None, curve_radius_end=None) for span in catenary.spans)
    built = catenary.as_built and catenary.as_built.replace(stagger=None)
    return catenary.replace(spans=spans, supports=tuple(supports), as_built=built, spatial=False)


def mirror_image(catenary: _Line) -> _Line:
    """See :meth:`Catenary.mirrored`."""
    wires = iter(catenary.wires_held())
    spans = []
    for span in catenary.spans:
        images = [
            d.replace(
                position=span.length - d.position,
                clamp_shift=-d.clamp_shift,
                contact_wire=next(wires) + 1 if catenary.contact_wire_spacing else None,
            )
            for d in span.droppers
        ]
        spans.append(_turned(span).replace(droppers=tuple(reversed(images))))
    n = len(catenary.spans)
    evaluated = tuple(n + 1 - i for i in catenary.evaluated_spans) if catenary.evaluated_spans else None
    return catenary.replace(
        spans=tuple(reversed(spans)),
        supports=catenary.supports[::-1],
        begin=catenary.end,
        end=catenary.begin,
        midpoint=catenary.midpoint and n + 2 - catenary.midpoint,
        midpoint_position=None
        if catenary.midpoint_position is None
        else catenary.length - catenary.midpoint_position,
        equipment=tuple(item.mirrored(catenary) for item in catenary.equipment),
        wear=tuple(wear.mirrored(catenary) for wear in catenary.wear),
        as_built=mirrored(catenary),
        evaluated_spans=evaluated,
    )


def _turned(span: Span) -> Span:
    """The span with its track seen from its other end."""
    if span.curve_radius_end is None:
        return span
    return span.replace(curve_radius=span.curve_radius_end, curve_radius_end=span.curve_radius or 0.0)


def _arm_in_the_plane(arm: SteadyArm, pull: float, support: int) -> SteadyArm:
    if arm.length is None:
        return arm
    force = pull * tan(arm.inclination or 0.0) - GRAVITY * (arm.hanging_mass - arm.tip_mass)
    try:
        return SteadyArm(
            stiffness=pull / arm.length,
            mass=arm.tip_mass,
            holds_design_height=arm.holds_height,
            preload=0.0 if arm.holds_height else force,
        )
    except InputError as error:
        where = f"support {support}: the steady arm as a vertical spring of pull over length"
        raise InputError(*(f"{where}: {line}" for line in error.problems)) from None
