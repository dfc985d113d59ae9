"""The pantograph: a chain of lumped masses on a base that moves along the track, or an elastic force."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal, Self, get_args

from pydantic import field_validator, model_validator

from catenary_fe.layout.arguments import number
from catenary_fe.layout.current_collection import MeanForceRule, target_mean_force
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.parameters import (
    NonEmpty,
    NonNegative,
    Number,
    Parameters,
    Positive,
    Text,
    shorten,
)
from catenary_fe.layout.substructure import BASE, Body, ContactLaw, Joint, Strip, Substructure

Base = Literal["contact wire", "rail"]


class Stage(Parameters):
    """A mass with the spring and damper below it, which join it to the next stage or to the base."""

    mass: Positive
    """[kg] of the stage"""
    stiffness: NonNegative
    """[N/m] of the spring below the mass"""
    damping: NonNegative = 0.0
    """[N s/m] of the damper below the mass"""
    damping_up: NonNegative | None = None
    """[N s/m] of a damper that differs: while the mass rises against what is below it"""
    damping_down: NonNegative | None = None
    """[N s/m] likewise, while it comes down; both instead of `damping`"""
    friction: NonNegative = 0.0
    """[N] dry, between the mass and what is below it"""
    travel: tuple[Positive, Positive] | None = None
    """[m] down and up by which the mass can move from where the spring below it is force-free, before it
    meets its stops; unset: no stops"""
    stop_stiffness: Positive = 1e6
    """[N/m] of the stops (a value of an SNCF thesis)"""

    @model_validator(mode="after")
    def _one_damper(self) -> Self:
        up, down = self.damping_up, self.damping_down
        if (up is None) != (down is None):
            raise ValueError("damping_up and damping_down belong together: give both or neither")
        if up is not None and self.damping:
            raise ValueError("damping has no effect beside damping_up and damping_down; leave it out")
        if self.travel is None and self.stop_stiffness != type(self).model_fields["stop_stiffness"].default:
            raise ValueError("stop_stiffness has no effect without travel; give both or neither")
        return self

    def joint(self, upper: int, lower: int, share: float = 1.0, lever: float = 0.0) -> Joint:
        """The spring and damper below the mass, or a share of them, with what is not linear there."""
        up, down = (self.damping if each is None else each for each in (self.damping_up, self.damping_down))
        common = min(up, down)
        return Joint(
            upper,
            lower,
            share * self.stiffness,
            share * common,
            lever,
            rising=share * (up - common),
            falling=share * (down - common),
            friction=share * self.friction,
            travel=self.travel,
            stop_stiffness=share * self.stop_stiffness,
        )

    @property
    def in_words(self) -> str:
        """One line."""
        damper = f"{self.damping:g} N s/m"
        if self.damping_up is not None:
            damper = f"{self.damping_up:g} N s/m up and {self.damping_down:g} down"
        friction = f", {self.friction:g} N of friction" if self.friction else ""
        stops = f", stops at −{self.travel[0]:g} and {self.travel[1]:g} m" if self.travel else ""
        return f"{self.mass:g} kg on {self.stiffness:g} N/m, {damper}{friction}{stops}"


class AerodynamicForce(Parameters):
    """Upward force of the air on the lowest mass, a V² + b V."""

    quadratic: Number = 0.0
    """[N s²/m²] a, times the square of the speed in m/s"""
    linear: Number = 0.0
    """[N s/m] b, times the speed in m/s"""

    def at(self, speed: float) -> float:
        """[N] at a speed in m/s. Raises InputError for a negative or non-finite speed."""
        speed = number("speed", speed, "m/s", least=0.0)
        return self.quadratic * speed**2 + self.linear * speed


class Panhead(Parameters):
    """The head beyond its mass: its width, a roll of its own, a second collector strip."""

    width: Positive = 1.2
    """[m] of the part that may touch the wire, half to each side of the track's centre; the default is that
    of the 1600 mm head (recalled)"""
    spring_distance: Positive | None = None
    """[m] sideways between the two springs that share the stiffness below the head, which then rolls on
    them; unset: a head that stays level"""
    roll_inertia: Positive | None = None
    """[kg m²] about the track's direction; unset: that of a uniform bar of the head's width"""
    strips: Literal[1, 2] = 1
    """collector strips, one behind the other; two share the head's mass, spring and damper"""
    strip_distance: Positive | None = None
    """[m] along the track between two strips"""

    @model_validator(mode="after")
    def _options_belong_together(self) -> Self:
        if (self.strips == 2) != (self.strip_distance is not None):
            raise ValueError("strips = 2 and strip_distance belong together: give both or neither")
        if self.roll_inertia and self.spring_distance is None:
            raise ValueError("roll_inertia has no effect without spring_distance; give both or neither")
        return self

    def rolling_inertia(self, mass: float) -> float:
        """[kg m²] of a head of this mass [kg]."""
        return self.roll_inertia or mass * self.width**2 / 12


class Pantograph(Parameters):
    """Lumped masses, head first, pushed up by a constant force on the lowest one.

    The base moves along the track; its spring is force-free with the head at the contact wire's design
    height, or at the nominal one. Either ``uplift_force`` is given, or a ``mean_force`` that the uplift is
    set for.
    """

    name: Text = "pantograph"
    """what tables and pictures call it"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""
    stages: Annotated[tuple[Stage, ...], NonEmpty]
    """masses with the spring and damper below each, head first"""
    uplift_force: Positive | None = None
    """[N] constant force on the lowest mass, without the air's"""
    mean_force: Positive | MeanForceRule | None = None
    """[N] mean contact force to reach, or the name of an EN 50367 formula"""
    aerodynamic_force: AerodynamicForce = AerodynamicForce()
    """of the air, on the lowest mass, added to uplift_force"""
    contact_stiffness: Positive = 50e3
    """[N/m] between head and contact wire, no tension"""
    contact_damping: NonNegative = 0.0
    """[N s/m] beside the contact stiffness, never pulling"""
    base: Base = "contact wire"
    """what the base's height follows: the design height of the contact wire, as an articulated frame keeps
    its force over its working range, or the rail, as if its spring did"""
    head: Panhead | None = None
    """what the head is beyond the first mass; unset: a level head of the usual width with one strip"""

    @field_validator("mean_force", mode="before")
    @classmethod
    def _number_or_rule(cls, value: object) -> object:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if value is None or (is_number and value > 0) or value in get_args(MeanForceRule):  # type: ignore[operator]
            return value
        rules = ", ".join(f"'{rule}'" for rule in get_args(MeanForceRule))
        raise ValueError(f"{shorten(value)} is neither a force above 0 N nor one of {rules}")

    @model_validator(mode="after")
    def _one_force(self) -> Self:
        if (self.uplift_force is None) == (self.mean_force is None):
            raise ValueError(
                "uplift_force and mean_force: give exactly one, the force that pushes the lowest mass up"
                " or the mean contact force that it shall result in"
            )
        if self.mean_force is not None and self.aerodynamic_force != AerodynamicForce():
            raise ValueError(
                "aerodynamic_force has no effect beside mean_force, which is what air and uplift result in"
                " together; leave it out, or give an uplift_force instead"
            )
        return self

    @property
    def panhead(self) -> Panhead:
        """What the head is, be it given or the usual one."""
        return self.head or Panhead()

    def assemble(self, *, spatial: bool) -> Substructure:
        """Its bodies, joints, strips and contact law; two strips share the head's mass, spring and damper.

        spatial : whether the line has coordinates across the track, in which a head on two springs rolls
        """
        head, first, count = self.panhead, self.stages[0], self.panhead.strips
        lever = head.spring_distance / 2 if head.spring_distance and spatial else 0.0
        inertia = head.rolling_inertia(first.mass) / count if lever else None
        below = [*range(count, count + len(self.stages) - 1), BASE]
        joints = [first.joint(i, below[0], 1 / count, lever) for i in range(count)]
        joints += [
            stage.joint(i, lower) for i, lower, stage in zip(below, below[1:], self.stages[1:], strict=False)
        ]
        strips = [Body(first.mass / count, inertia)] * count
        single = len(self.stages) == 1
        apart = head.strip_distance or 0.0
        return Substructure(
            bodies=(*strips, *(Body(stage.mass) for stage in self.stages[1:])),
            joints=tuple(joints),
            lifted=(1 / count,) * count if single else (0.0,) * (len(below) + count - 2) + (1.0,),
            strips=tuple(Strip(apart * (0.5 - i) if count > 1 else 0.0, i) for i in range(count)),
            contact=ContactLaw(self.contact_stiffness, self.contact_damping),
            follows=self.base == "contact wire",
        )

    def in_words(self) -> list[tuple[str, str]]:
        """Names and values, for a table."""
        air, force = self.aerodynamic_force, self.uplift_force
        names = ["mass 1 (head)", *(f"mass {n}" for n in range(2, len(self.stages) + 1))]
        return [
            ("source", self.source or "not given"),
            *((name, stage.in_words) for name, stage in zip(names, self.stages, strict=True)),
            ("mean force to reach", str(self.mean_force))
            if force is None
            else ("uplift force", f"{force:g} N"),
            ("force of the air", f"{air.quadratic:g} V² + {air.linear:g} V (N, m/s)"),
            ("contact", f"{self.contact_stiffness:g} N/m, {self.contact_damping:g} N s/m, no tension"),
        ]

    def static_uplift(self, speed: float) -> float:
        """[N] upward force on the lowest mass at a speed in m/s; for a mean force, the first guess.

        Raises InputError where uplift and aerodynamic force push it down.
        """
        if self.uplift_force is None:
            target = self.target_mean_force(speed)
            assert target is not None
            return target
        uplift = self.uplift_force + self.aerodynamic_force.at(speed)
        if uplift <= 0:
            raise InputError(
                f"{self.name}: uplift and aerodynamic force add up to {uplift:.6g} N at {3.6 * speed:g} km/h:"
                " must be above 0, or the head stays down; change uplift_force or aerodynamic_force"
            )
        return uplift

    def with_uplift(self, uplift: float) -> Self:
        """The same pantograph with this uplift force [N] alone. Raises InputError."""
        return self.replace(uplift_force=uplift, mean_force=None, aerodynamic_force=AerodynamicForce())

    def target_mean_force(self, speed: float) -> float | None:
        """[N] mean contact force to reach at a speed in m/s; None with a given uplift."""
        if self.mean_force is None or isinstance(self.mean_force, float):
            return self.mean_force
        return target_mean_force(self.mean_force, speed)


class _WithoutStages(Parameters):
    """A pantograph whose bodies the program does not know: no stages, and no uplift to set."""

    @property
    def stages(self) -> tuple[Stage, ...]:
        """None."""
        return ()

    @property
    def head(self) -> None:
        """None."""
        return None

    @property
    def panhead(self) -> Panhead:
        """The usual one."""
        return Panhead()

    def with_uplift(self, uplift: float) -> Self:
        """Itself: it has no uplift force of its own."""
        return self

    def target_mean_force(self, speed: float) -> None:
        """None: its law or its loads decide the mean force."""


class ElasticPantograph(_WithoutStages):
    """A pantograph without masses whose force falls as the wire rises, and never pulls.

    Either linear, F = max(0, force − stiffness · elevation), or by a ``law`` of points. Source: the paper
    "Selected problems of wave phenomena in catenaries", section 3.1, which leaves the law open.
    """

    name: Text = "elastic pantograph"
    """what tables and pictures call it"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""
    force: Positive | None = None
    """[N] on a wire at the nominal contact wire height; unset with a `law`"""
    stiffness: NonNegative = 0.0
    """[N/m] by which the force falls as the wire rises; 0: a constant force"""
    base: Base = "contact wire"
    """what elevations count from where the height changes: the contact wire's design height, or the rail"""
    law: tuple[tuple[Number, NonNegative], ...] = ()
    """pairs of elevation [m] above the nominal height and force [N], straight between, constant outside"""

    @model_validator(mode="after")
    def _one_law(self) -> Self:
        if (self.force is None) == (not self.law):
            raise ValueError(
                "force and law: give exactly one, a force (with its stiffness) or a law of points"
            )
        if self.law and self.stiffness:
            raise ValueError(f"stiffness = {self.stiffness:g} N/m has no effect beside a law; leave it out")
        for (low, strong), (high, weak) in pairwise(self.law):
            if high <= low or weak > strong:
                raise ValueError(
                    f"law: after {strong:g} N at {low:g} m comes {weak:g} N at {high:g} m; elevations must"
                    " rise and forces must not"
                )
        return self

    def contact_force(self, elevation: float) -> float:
        """[N] on a wire at an elevation [m] above its nominal height. Raises InputError unless finite."""
        return self.assemble(spatial=False).contact.force(-number("elevation", elevation, "m"))

    def assemble(self, *, spatial: bool) -> Substructure:
        """One strip without mass at the nominal contact wire height, and the law."""
        law = ContactLaw(self.stiffness, preload=self.force or 0.0, points=self.law)
        return Substructure((), (), (), (Strip(),), law, self.base == "contact wire")

    def in_words(self) -> list[tuple[str, str]]:
        """Names and values, for a table."""
        law = f"points {list(self.law)}" if self.law else f"{self.force:g} N"
        return [
            ("source", self.source or "not given"),
            ("force", f"{law}, falling by {self.stiffness:g} N/m"),
        ]

    def static_uplift(self, speed: float) -> float:
        """[N] on a wire at its nominal height, at any speed."""
        return self.contact_force(0.0)


class AttachedPantograph(_WithoutStages):
    """What results record of a pantograph that a script made of bodies of its own in the multibody model."""

    attached: Literal[True] = True
    """tells it from others in a record"""
    name: Text
    """what tables and pictures call it"""
    source: Text = "bodies of a script's own in the multibody model"
    """where the numbers come from, and how sure they are"""
    contact_stiffness: Positive
    """[N/m] between each strip and contact wire, no tension"""
    contact_damping: NonNegative = 0.0
    """[N s/m] beside the contact stiffness, never pulling"""

    @property
    def base(self) -> Base:
        """Its script moves it, or not."""
        return "rail"

    def assemble(self, *, spatial: bool) -> Substructure:
        """Raises InputError: only the script that made the bodies knows them."""
        raise InputError(
            f"{self.name}: {self.source}, which no record knows; run the script again that made them"
        )

    def in_words(self) -> list[tuple[str, str]]:
        """Names and values, for a table."""
        return [
            ("source", self.source),
            ("contact", f"{self.contact_stiffness:g} N/m, {self.contact_damping:g} N s/m, no tension"),
        ]

    def static_uplift(self, speed: float) -> float:
        """[N] that a run adds: none, the bodies have loads of their own."""
        return 0.0


DescribedPantograph = Pantograph | ElasticPantograph
AnyPantograph = DescribedPantograph | AttachedPantograph


def recorded_pantograph(record: dict[str, Any]) -> AnyPantograph:
    """A pantograph from its record in a result. Raises pydantic's ValidationError for what is none."""
    kind = Pantograph if "stages" in record else ElasticPantograph
    return (AttachedPantograph if "attached" in record else kind).model_validate(record)


def check_pantographs(pantographs: object, *, least: int = 1) -> None:
    """Raises InputError for what is not a list of pantographs, or of too few."""
    remedy = "give a list of pantographs, such as [library.pantograph('DSA250')]"
    if isinstance(pantographs, str) or not isinstance(pantographs, Sequence):
        raise InputError(f"pantographs = {shorten(pantographs)}: {remedy}")
    if len(pantographs) < least:
        raise InputError("pantographs is empty; give at least one")
    for i, pantograph in enumerate(pantographs, start=1):
        if not isinstance(pantograph, AnyPantograph):
            raise InputError(f"pantograph {i} = {shorten(pantograph)}: {remedy}")
