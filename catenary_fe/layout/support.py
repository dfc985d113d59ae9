"""What stands at a mast: the messenger wire's support, and the contact wire's registration."""

from __future__ import annotations

from math import pi
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from catenary_fe.layout.parameters import NonNegative, Number, Parameters, Positive, Sideways

Angle = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, lt=pi / 3)]
Side = Literal["left", "right"]


class SteadyArm(Parameters):
    """Registration of the contact wire at a support: a link that the stagger pulls, or a vertical spring.

    With a `length` the arm is a straight bar on a pivot, seen in space. Its wire end swings up and down
    against the wire's sideways pull. With a `stiffness` it is what planar models make of that: a vertical
    spring and a mass; sideways it holds the wire where it is.
    """

    stiffness: NonNegative | None = None
    """[N/m] vertical, at the contact wire, of an arm that is modelled as a spring"""
    mass: NonNegative = 0.0
    """[kg] of arm and clamp that moves with the wire, of an arm that is modelled as a spring"""
    damping: NonNegative = 0.0
    """[N s/m] vertical, of an arm that is modelled as a spring"""
    length: Positive | None = None
    """[m] from pivot to wire, of an arm that is modelled as a link"""
    mass_per_length: NonNegative = 0.0
    """[kg/m] of a link"""
    clamp_mass: NonNegative = 0.0
    """[kg] where a link holds the wire"""
    inclination: Angle | None = None
    """[rad] by which a link rises from the wire to its pivot; unset: what the wire's design height takes"""
    side: Side | None = None
    """side of the wire (left looking along x, +y) that a link's pivot is on; unset: where the link pulls"""
    holds_design_height: bool = True
    """true: set so that the wire has its design height here; false: a spring carries `preload`"""
    preload: Number = 0.0
    """[N] upward force of a spring on the wire at its design height, where it does not hold that height"""
    uplift_room: Positive | None = None
    """[m] that the wire can rise here before something is in its way, for the criteria; unset: not judged"""

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        if (self.stiffness is None) == (self.length is None):
            raise ValueError(
                "stiffness and length: give exactly one, the vertical stiffness [N/m] of an arm that is"
                " modelled as a spring or the length [m] of one that is modelled as a link"
            )
        of_other_kind = (
            ("mass_per_length", "clamp_mass", "inclination", "side")
            if self.length is None
            else ("mass", "damping", "preload")
        )
        for name in of_other_kind:
            if getattr(self, name):
                kind = "spring, as it has a stiffness" if self.length is None else "link, as it has a length"
                raise ValueError(f"{name} has no effect on an arm that is a {kind}; leave it out")
        if self.preload and self.holds_design_height:
            raise ValueError(
                f"preload = {self.preload:g} N has no effect on an arm that is set for the wire's design"
                " height; give holds_design_height = false too, or leave it out"
            )
        return self

    @model_validator(mode="after")
    def _link_has_a_height(self) -> Self:
        if self.length is not None and not self.holds_design_height and self.inclination is None:
            raise ValueError("a link that does not hold the design height needs an inclination")
        return self

    @property
    def holds_height(self) -> bool:
        """Whether the wire has its design height at the arm."""
        return self.holds_design_height and self.inclination is None

    @property
    def tip_mass(self) -> float:
        """[kg] that moves with the wire.

        A uniform bar on a pivot moves like a third of its mass at its end, so it needs no body of its own.
        """
        return self.mass if self.length is None else self.mass_per_length * self.length / 3 + self.clamp_mass

    @property
    def hanging_mass(self) -> float:
        """[kg] whose weight the wire end carries: half of a bar's, as the pivot carries the other half."""
        return self.mass if self.length is None else self.mass_per_length * self.length / 2 + self.clamp_mass


class Support(Parameters):
    """What holds the wires at a mast. The first and the last support of a line anchor both wires."""

    messenger_stiffness: Positive | None = None
    """[N/m] vertical, under the messenger wire; unset: rigid"""
    messenger_damping: NonNegative = 0.0
    """[N s/m] vertical, beside the stiffness"""
    messenger_lateral_stiffness: Positive | None = None
    """[N/m] of the cantilever sideways; unset: rigid"""
    messenger_lateral_damping: NonNegative = 0.0
    """[N s/m] sideways, beside the stiffness"""
    steady_arm: SteadyArm | None = None
    """registration of the contact wire; unset: the contact wire is free here"""
    contact_wire_height: Positive | None = None
    """[m] of the contact wire at this support, above the rail; unset: the catenary's. Between supports the
    design runs straight, sag and offsets of the droppers apart"""
    system_height: Positive | None = None
    """[m] between the wires at this support; unset: the catenary's"""
    stagger: Sideways = 0.0
    """[m] of the contact wire to the left of the track's centre (+y)"""
    messenger_stagger: Sideways = 0.0
    """[m] of the messenger wire to the left of the track's centre (+y)"""
    stitch_wire: bool = True
    """whether a stitch wire, if the catenary has them, hangs here; none does at a line's ends"""

    @model_validator(mode="after")
    def _damping_needs_a_spring(self) -> Self:
        for kind in ("messenger", "messenger_lateral"):
            damping = getattr(self, f"{kind}_damping")
            if damping and getattr(self, f"{kind}_stiffness") is None:
                raise ValueError(
                    f"{kind}_damping = {damping:g} N s/m has no effect on a rigid support;"
                    f" give {kind}_stiffness too"
                )
        return self
