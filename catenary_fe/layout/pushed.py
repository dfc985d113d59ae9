"""What pantographs of masses have in common: the force that pushes them up, the air, contact, base."""

from __future__ import annotations

from typing import ClassVar, Literal, Self, get_args

import numpy as np
from numpy.typing import NDArray
from pydantic import field_validator, model_validator

from catenary_fe.layout.current_collection import MeanForceRule, target_mean_force
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.panhead import AerodynamicForce, Knuckle
from catenary_fe.layout.parameters import NonNegative, Parameters, Positive, Text, shorten

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
Base = Literal["contact wire", "rail"]


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
    knuckle: Knuckle = "leading"
    """which end runs ahead, of a frame with one arm: forces of the air may know both"""
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
        return self

    @model_validator(mode="after")
    def _air_acts(self) -> Self:
        if self.mean_force is not None and any(air != AerodynamicForce() for air in self.airs):
            raise ValueError(
                "aerodynamic_force has no effect beside mean_force, which is what air and uplift result in"
                " together; leave it out, or give an uplift_force instead"
            )
        if self.knuckle == "trailing" and not any(air.trailing for air in self.airs):
            raise ValueError("knuckle = 'trailing' has no effect: no aerodynamic_force has `trailing`")
        return self

    @property
    def airs(self) -> list[AerodynamicForce]:
        """Forces of the air, mass by mass, head first; that on the lowest mass is the last one."""
        return [self.aerodynamic_force]

    def air(self, speed: float) -> list[float]:
        """[N] of :attr:`airs` at a speed in m/s. Raises InputError for a negative or non-finite speed."""
        return [air.at(speed, self.knuckle) for air in self.airs]

    def shares(self, speed: float | None) -> list[float]:
        """Of :attr:`airs` in the whole uplift force, the lowest mass's own beside the last of them.

        speed : [m/s]; None: at a standstill
        """
        air = self.air(speed or 0.0)
        above, total = air[:-1], self.static_uplift(speed or 0.0) if any(air[:-1]) else 1.0
        return [*(force / total for force in above), 1.0 - sum(above) / total]

    def forces_in_words(self) -> list[tuple[str, str]]:
        """Names and values, for a table."""
        air, force = self.aerodynamic_force, self.uplift_force
        return [
            ("mean force to reach", str(self.mean_force))
            if force is None
            else ("uplift force", f"{force:g} N"),
            ("force of the air", air.in_words(self.knuckle)),
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
        uplift = self.uplift_force + sum(self.air(speed))
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
