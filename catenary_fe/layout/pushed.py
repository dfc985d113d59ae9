"""What pantographs of masses have in common: the head, the force that pushes them up, contact, base."""

from __future__ import annotations

from typing import ClassVar, Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator, model_validator

from catenary_fe.layout.arguments import number
from catenary_fe.layout.current_collection import MeanForceRule, target_mean_force
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.parameters import NonNegative, Number, Parameters, Positive, Text, shorten
from catenary_fe.layout.substructure import Joint

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Base = Literal["contact wire", "rail"]


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


class KnownPantograph(Parameters):
    """What is asked of any pantograph; most are not described by a measurement."""

    kind: ClassVar[str]
    """what describes it"""

    @property
    def measured(self) -> tuple[Floats, Complex] | None:
        """Frequencies [Hz] and receptances [m/N] that it was given as; None otherwise."""
        return None

    @property
    def errors(self) -> Floats:
        """Shape (measured frequencies,): by how much its receptance is off, as a share."""
        return np.zeros(0)

    def fit_warnings(self) -> list[str]:
        """Where it does not meet what was measured, or that does not say what a run needs."""
        return []


class PushedPantograph(KnownPantograph):
    """Masses that a constant force on the lowest one pushes up."""

    kind = "masses"
    name: Text = "pantograph"
    """what tables and pictures call it"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""
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

    def forces_in_words(self) -> list[tuple[str, str]]:
        """Names and values, for a table."""
        air, force = self.aerodynamic_force, self.uplift_force
        return [
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
