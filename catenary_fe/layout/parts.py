"""The parts that a line is made of: wires, droppers, spans, and what stands at a mast."""

from __future__ import annotations

from math import pi
from typing import Annotated, Literal, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, ValidationInfo, field_validator, model_validator

from catenary_fe.layout.parameters import (
    Lateral,
    NonNegative,
    Number,
    Parameters,
    Positive,
    Share,
    Text,
    refuse,
)
from catenary_fe.layout.track import Cant, MessengerStagger
from catenary_fe.theory import Beam


class Wire(Parameters):
    """A wire under a constant tension: contact wire or messenger wire."""

    mass_per_length: Positive
    """[kg/m] of the wire as installed"""
    tension: Positive
    """[N] along the wire as installed, which the devices at its ends are set for"""
    axial_stiffness: Positive
    """[N] EA, cross-section times Young's modulus"""
    bending_stiffness: NonNegative = 0.0
    """[N m²] EI"""
    diameter: Positive | None = None
    """[m] outside, which wind and ice take; unset: estimated from the mass as of copper"""
    thermal_expansion: NonNegative = 1.7e-5
    """[1/K] lengthening by temperature: of copper and bronze"""
    name: Text = ""
    """what the wire is, e.g. 'AC-150'"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""

    @property
    def beam(self) -> Beam:
        """The wire as the closed forms of `catenary_fe.theory` take it."""
        return Beam(
            tension=self.tension,
            mass_per_length=self.mass_per_length,
            bending_stiffness=self.bending_stiffness,
        )

    @property
    def wave_speed(self) -> float:
        """[m/s] of transverse waves, √(T/ρ)."""
        return self.beam.wave_speed

    @property
    def impedance(self) -> float:
        """[N s/m] √(T ρ), force over velocity of a wave running one way."""
        return self.beam.impedance


Kind = Literal["fixed", "weights", "spring"]


class Termination(Parameters):
    """What holds a wire along the track at an end of its tension section.

    Weights keep its tension, whatever the wire does; a spring changes it with the wire's movement; between
    two fixed ends the tension is an outcome, which starts from the wire's nominal one.
    """

    kind: Kind
    """"fixed", "weights" or "spring\""""
    stiffness: Positive | None = None
    """[N/m] of a spring, along the track"""
    ratio: Positive | None = None
    """[m/m] of weights: how far they move for the wire, 3 or 5; unset: their inertia is left out"""
    efficiency: Share = 1.0
    """[1] of weights: share of the nominal tension that friction in the device leaves in the wire"""

    @model_validator(mode="after")
    def _of_its_kind(self) -> Self:
        if (self.kind == "spring") != (self.stiffness is not None):
            raise ValueError("stiffness: a spring needs one, and nothing else has one")
        for name, unset in (("ratio", None), ("efficiency", 1.0)):
            if self.kind != "weights" and getattr(self, name) != unset:
                raise ValueError(f"{name} has no effect on an end that is {self.kind}; leave it out")
        return self

    @property
    def in_words(self) -> str:
        """One line."""
        if self.kind == "weights":
            ratio = f" of ratio 1:{self.ratio:g}" if self.ratio else ""
            friction = f", efficiency {self.efficiency:g}" if self.efficiency < 1 else ""
            return f"weights{ratio}{friction}"
        return "fixed" if self.kind == "fixed" else f"spring of {self.stiffness:g} N/m"


class SectionEnd(Termination):
    """An end of a tension section: one termination for all its wires, or others for contact and messenger."""

    contact_wire: Termination | None = None
    """what holds contact wires here; unset: as all wires"""
    messenger_wire: Termination | None = None
    """what holds the messenger wire here; unset: as all wires"""

    @model_validator(mode="after")
    def _some_wire_ends_on_it(self) -> Self:
        if self.contact_wire and self.messenger_wire:
            for name in ("stiffness", "ratio", "efficiency"):
                if getattr(self, name) != type(self).model_fields[name].default:
                    raise ValueError(
                        f"{name} has no effect where contact_wire and messenger_wire have ends of their own"
                    )
        return self

    def of(self, wire: Literal["contact_wire", "messenger_wire"]) -> Termination:
        """What holds this kind of wire."""
        own: Termination | None = getattr(self, wire)
        return own or self

    @property
    def of_both(self) -> str:
        """What holds the wires, in one line."""
        contact, messenger = self.of("contact_wire").in_words, self.of("messenger_wire").in_words
        return contact if contact == messenger else f"contact wire {contact}, messenger wire {messenger}"


class Dropper(Parameters):
    """A dropper: a spring in tension that goes slack instead of pushing, with its mass and clamps."""

    position: Number
    """[m] from the span's first support"""
    length: Positive | None = None
    """[m] stress-free, from clamp to clamp, where it is given; unset: form finding decides"""
    stiffness: Positive = 1e5
    """[N/m] of the whole dropper in tension"""
    damping: NonNegative = 0.0
    """[N s/m] of the whole dropper while it is taut"""
    mass_per_length: NonNegative = 0.0
    """[kg/m], lumped half to each end"""
    messenger_clamp_mass: NonNegative = 0.0
    """[kg] of the clamp at its upper end, on the messenger wire or the stitch wire"""
    contact_wire_clamp_mass: NonNegative = 0.0
    """[kg] of the clamp at its lower end"""
    height_offset: Number | None = None
    """[m] design height of the contact wire here above the nominal one; unset: the span's pre-sag decides"""
    contact_wire: Literal[1, 2] | None = None
    """which of two contact wires hangs here, the right (1) or the left (2) one; unset: in turns"""
    state: Literal["missing", "broken"] | None = None
    """"missing": gone since, with both clamps; "broken": gone, its clamps stay on the wires. The other
    droppers keep the lengths that they were cut to with this one in place"""
    clamp_shift: Number = 0.0
    """[m] along the track by which its lower clamp has slid since, positive in x; its length stays"""


class StitchWire(Wire):
    """A wire clamped on the messenger wire to both sides of a support, from which the next droppers hang.

    `tension` is what it has when installed; no weights hold it.
    """

    length: Positive
    """[m] along the track, half of it to each side of the support"""
    clamp_mass: NonNegative = 0.0
    """[kg] of each of the two clamps on the messenger wire"""


SHARPEST_CURVE = 50.0  # [m] tramways; an assumption
CLOSEST = 0.01  # [m] between clamps: closer ones are a slip of the pen, and no mesh


class Span(Parameters):
    """From one support to the next, with its droppers in order."""

    length: Positive
    """[m] between the supports"""
    droppers: tuple[Dropper, ...]
    """in order of their positions"""
    pre_sag: Number = 0.0
    """[m] design sag of the contact wire at mid-span, a parabola between the outermost droppers"""
    curve_radius: Number | None = None
    """[m] of the track, positive in a curve to the left (centre at +y); unset or 0: straight"""
    curve_radius_end: Number | None = None
    """[m] at the span's end, of a transition curve: from `curve_radius` at its beginning the curvature
    changes linearly; 0: straight there; unset: as at the beginning"""

    @model_validator(mode="after")
    def _curve_is_a_track(self) -> Self:
        for name in ("curve_radius", "curve_radius_end"):
            radius = getattr(self, name)
            if radius and abs(radius) < SHARPEST_CURVE:
                raise ValueError(
                    f"{name} = {radius:g} m: no track with a catenary curves more sharply than"
                    f" {SHARPEST_CURVE:g} m; leave it out where the track is straight"
                )
        return self

    @property
    def curvatures(self) -> tuple[float, float]:
        """[1/m] of the track at the span's beginning and end, positive to the left; linear between."""
        begin = 1 / self.curve_radius if self.curve_radius else 0.0
        if self.curve_radius_end is None:
            return begin, begin
        return begin, 1 / self.curve_radius_end if self.curve_radius_end else 0.0

    def radius_at(self, end: bool) -> float | None:
        """[m] of the track at the span's beginning or end, positive to the left.

        None of a straight span, 0 where a transition curve is straight.
        """
        curvature = self.curvatures[end]
        if not any(self.curvatures):
            return None
        return (
            (self.curve_radius_end if end and self.curve_radius_end else self.curve_radius)
            if curvature
            else 0.0
        )

    @field_validator("droppers")
    @classmethod
    def _droppers_in_order(cls, droppers: tuple[Dropper, ...], info: ValidationInfo) -> tuple[Dropper, ...]:
        length = info.data.get("length", np.inf)  # a faulty one is reported by itself
        faults, previous = [], 0.0
        for number, dropper in enumerate(droppers, start=1):
            x = dropper.position
            if not 0 < x < length:
                faults.append(
                    f"dropper {number} at {x:g} m lies outside the {length:g} m span;"
                    f" positions count from the span's first support, between 0 and {length:g} m"
                )
            elif x <= previous:
                faults.append(
                    f"dropper {number} at {x:g} m does not come after the one before it at {previous:g} m;"
                    " list the droppers in order, each position once"
                )
            elif min(x - previous, length - x) < CLOSEST:
                faults.append(
                    f"dropper {number} at {x:.6g} m is less than {CLOSEST:g} m from the next clamp or support"
                    "; move it, or make one dropper of two"
                )
            else:
                previous = x
        refuse(faults)
        return droppers

    def height_offsets(self) -> NDArray[np.float64]:
        """[m], shape (droppers,): design height of the contact wire at each dropper above the nominal one."""
        x = np.array([d.position for d in self.droppers])
        if x.size == 0:
            return x
        first, last = x[0], x[-1]
        xi = (x - first) / (last - first) if last > first else np.full_like(x, 0.5)
        sag = -4 * self.pre_sag * xi * (1 - xi)
        own = [np.nan if d.height_offset is None else d.height_offset for d in self.droppers]
        return np.where(np.isnan(own), sag, own)


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
    mast_position: Number | None = None
    """[m] to the left of the track's centre (+y) of the hinge that the cantilever swings about when the wires
    move along the track; unset: it moves along with them and draws no wire to the side"""
    steady_arm: SteadyArm | None = None
    """registration of the contact wire; unset: the contact wire is free here"""
    contact_wire_height: Positive | None = None
    """[m] of the contact wire at this support, above the rail; unset: the catenary's. Between supports the
    design runs straight, sag and offsets of the droppers apart"""
    system_height: Positive | None = None
    """[m] between the wires at this support; unset: the catenary's"""
    stagger: Lateral = 0.0
    """[m] of the contact wire to the left of the track's centre (+y)"""
    messenger_stagger: MessengerStagger = 0.0
    """[m] of the messenger wire to the left of the track's centre (+y); "follows": plumb above the contact
    wire; "in curves": so where the track curves on either side, else above the track's centre"""
    cant: Cant = 0.0
    """[m] by which the right rail lies higher than the left one: the track leans to the left, as in a curve
    to the left; linear between supports"""
    stitch_wire: bool = True
    """whether a stitch wire, if the catenary has them, hangs here; none does at a line's ends"""
    stitch_wire_length: Positive | None = None
    """[m] along the track of the stitch wire here; unset: that of the stitch wire itself"""

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
