"""The pantograph: a chain of lumped masses on a base that moves along the track, or an elastic force."""

from __future__ import annotations

from itertools import pairwise
from typing import Annotated, Literal, Self, get_args

from pydantic import field_validator, model_validator

from catenary_fe.system.parameters import NonEmpty, NonNegative, Number, Parameters, Positive, Text

MeanForceRule = Literal["EN 50367 AC", "EN 50367 DC 3 kV", "EN 50367 DC 1.5 kV"]


def target_mean_force(rule: MeanForceRule, speed: float) -> float:
    """[N] largest mean contact force that EN 50367 allows.

    rule : which system's formula
    speed : [m/s] of the train

    Source: the AC formula above 200 km/h from a secondary source; the others were recalled, not read. Of the
    DC 1.5 kV formula only the branch above 200 km/h is known here: below it, the same formula is used.
    """
    v = speed * 3.6
    if rule == "EN 50367 AC":
        return 0.00097 * v**2 + 70 if v > 200 else 0.00047 * v**2 + 90
    if rule == "EN 50367 DC 3 kV":
        return 0.00097 * v**2 + 110
    return 0.00228 * v**2 + 90


class Stage(Parameters):
    """A mass with the spring and damper below it, which join it to the next stage or to the base."""

    mass: Positive
    """[kg]"""
    stiffness: NonNegative
    """[N/m] of the spring below the mass"""
    damping: NonNegative = 0.0
    """[N s/m] of the damper below the mass"""


class AerodynamicForce(Parameters):
    """Upward force of the air on the lowest mass, a V² + b V."""

    quadratic: Number = 0.0
    """[N s²/m²] a, times the square of the speed in m/s"""
    linear: Number = 0.0
    """[N s/m] b, times the speed in m/s"""

    def at(self, speed: float) -> float:
        """[N] at a speed in m/s."""
        return self.quadratic * speed**2 + self.linear * speed


class Pantograph(Parameters):
    """Lumped masses, head first, pushed up by a constant force on the lowest one.

    The base moves along the track at constant height; its spring is force-free with the head at the nominal
    contact wire height. Either ``uplift_force`` is given, or a ``mean_force`` that the uplift is set for.
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

    @field_validator("mean_force", mode="before")
    @classmethod
    def _number_or_rule(cls, value: object) -> object:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if value is None or (is_number and value > 0) or value in get_args(MeanForceRule):  # type: ignore[operator]
            return value
        rules = ", ".join(f"'{rule}'" for rule in get_args(MeanForceRule))
        raise ValueError(f"{value!r} is neither a force above 0 N nor one of {rules}")

    @model_validator(mode="after")
    def _one_force(self) -> Self:
        if (self.uplift_force is None) == (self.mean_force is None):
            raise ValueError(
                "uplift_force and mean_force: give exactly one, the force that pushes the lowest mass up"
                " or the mean contact force that it shall result in"
            )
        return self

    def static_uplift(self, speed: float) -> float:
        """[N] upward force on the lowest mass at a speed in m/s; for a mean force, the first guess."""
        if self.uplift_force is not None:
            return self.uplift_force + self.aerodynamic_force.at(speed)
        target = self.target_mean_force(speed)
        assert target is not None
        return target

    def target_mean_force(self, speed: float) -> float | None:
        """[N] mean contact force to reach at a speed in m/s; None with a given uplift."""
        if self.mean_force is None or isinstance(self.mean_force, float):
            return self.mean_force
        return target_mean_force(self.mean_force, speed)


class ElasticPantograph(Parameters):
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
        """[N] on a wire at an elevation [m] above its nominal height."""
        force, stiffness = self.tangent(elevation)
        return max(0.0, force - stiffness * elevation)

    def tangent(self, elevation: float) -> tuple[float, float]:
        """F₀ [N] and k [N/m] of the straight law F₀ − k · elevation that holds around an elevation [m]."""
        if self.force is not None:
            return self.force, self.stiffness
        for (low, strong), (high, weak) in pairwise(self.law):
            if low <= elevation < high:
                slope = (strong - weak) / (high - low)
                return strong + slope * low, slope
        return self.law[0 if elevation < self.law[0][0] else -1][1], 0.0

    def static_uplift(self, speed: float) -> float:
        """[N] on a wire at its nominal height, at any speed."""
        return self.contact_force(0.0)

    def target_mean_force(self, speed: float) -> None:
        """None: the law decides the mean force."""


AnyPantograph = Pantograph | ElasticPantograph
