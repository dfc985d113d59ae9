"""The pantograph: a chain of lumped masses on a base that moves along the track, or an elastic force."""

from __future__ import annotations

import json
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

from pydantic import model_validator

from catenary_fe.layout.arguments import number
from catenary_fe.layout.bodies import ContactLaw, Strip
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.linkage import LinkagePantograph
from catenary_fe.layout.panhead import AerodynamicForce, Panhead, Stage, lifted
from catenary_fe.layout.parameters import (
    NonEmpty,
    NonNegative,
    Number,
    Positive,
    Text,
    shorten,
)
from catenary_fe.layout.pushed import Base, KnownPantograph, PushedPantograph
from catenary_fe.layout.receptance import ReceptancePantograph
from catenary_fe.layout.substructure import Substructure


class Pantograph(PushedPantograph):
    """Lumped masses, head first, pushed up by a constant force on the lowest one.

    The base moves along the track; its spring is force-free with the head at the contact wire's design
    height, or at the nominal one. Either ``uplift_force`` is given, or a ``mean_force`` that the uplift is
    set for.
    """

    stages: Annotated[tuple[Stage, ...], NonEmpty]
    """masses with the spring and damper below each, head first"""
    head: Panhead | None = None
    """what the head is beyond the first mass; unset: a level head of the usual width with one strip"""

    @property
    def panhead(self) -> Panhead:
        """What the head is, be it given or the usual one."""
        return self.head or Panhead()

    @property
    def airs(self) -> list[AerodynamicForce]:
        """Forces of the air, mass by mass, head first; the pantograph's own is the last one."""
        return [*(stage.aerodynamic_force for stage in self.stages), self.aerodynamic_force]

    def assemble(
        self, *, spatial: bool, height: float | None = None, speed: float | None = None
    ) -> Substructure:
        """Its bodies, joints, strips and contact law.

        spatial : whether the line has coordinates across the track, in which a head on two springs rolls
        height : [m] of the contact wire above the rail; of no use here
        speed : [m/s], by which the air shares the uplift force out; None: at a standstill
        """
        bodies, joints, strips = self.panhead.on_springs(self.stages, on_base=True, spatial=spatial)
        return Substructure(
            bodies=tuple(bodies),
            joints=tuple(joints),
            lifted=lifted(self.shares(speed), len(bodies), len(self.stages)),
            strips=tuple(strips),
            contact=ContactLaw(self.contact_stiffness, self.contact_damping),
            follows=self.base == "contact wire",
        )

    @property
    def masses(self) -> tuple[float, ...]:
        """[kg] of the stages."""
        return tuple(stage.mass for stage in self.stages)

    def in_words(self) -> list[tuple[str, str]]:
        """Names and values, for a table."""
        names = ["mass 1 (head)", *(f"mass {n}" for n in range(2, len(self.stages) + 1))]
        return [
            ("source", self.source or "not given"),
            *((name, stage.in_words) for name, stage in zip(names, self.stages, strict=True)),
            *self.forces_in_words(),
        ]


class _WithoutMasses(KnownPantograph):
    """A pantograph whose bodies the program does not know: no masses, and no uplift to set."""

    @property
    def masses(self) -> tuple[float, ...]:
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


class ElasticPantograph(_WithoutMasses):
    """A pantograph without masses whose force falls as the wire rises, and never pulls.

    Either linear, F = max(0, force − stiffness · elevation), or by a ``law`` of points. Source: the paper
    "Selected problems of wave phenomena in catenaries", section 3.1, which leaves the law open.
    """

    kind = "elastic"
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

    def assemble(
        self, *, spatial: bool, height: float | None = None, speed: float | None = None
    ) -> Substructure:
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


class AttachedPantograph(_WithoutMasses):
    """What results record of a pantograph that a script made of bodies of its own in the multibody model."""

    kind = "attached"
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

    def assemble(
        self, *, spatial: bool, height: float | None = None, speed: float | None = None
    ) -> Substructure:
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


DescribedPantograph = Pantograph | ElasticPantograph | ReceptancePantograph | LinkagePantograph
AnyPantograph = DescribedPantograph | AttachedPantograph


def kind_of(record: dict[str, Any]) -> type[DescribedPantograph]:
    """The class of the pantograph that a file or a record describes."""
    if "lower_arm" in record:
        return LinkagePantograph
    if "stages" in record:
        return Pantograph
    if "receptance" in record:
        return ReceptancePantograph
    return ElasticPantograph if not record.keys().isdisjoint({"force", "stiffness", "law"}) else Pantograph


def recorded_pantograph(record: dict[str, Any]) -> AnyPantograph:
    """A pantograph from its record in a result. Raises pydantic's ValidationError for what is none."""
    return (AttachedPantograph if "attached" in record else kind_of(record)).model_validate(record)


@lru_cache(maxsize=4)
def recorded_pantographs(text: str) -> tuple[AnyPantograph, ...]:
    """Pantographs from JSON; runs are asked for them again and again."""
    return tuple(map(recorded_pantograph, json.loads(text)))


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
