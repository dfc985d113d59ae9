"""Forces of a pantograph on a wire: histories F(t), and loads that move along it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._numerics import (
    FloatArray,
    Function,
    antiderivative,
    finite,
    non_negative,
    refuse,
)


@dataclass(frozen=True, kw_only=True)
class HarmonicForce:
    """F(t) = F_m + F_d sin(Ω t + φ), with φ = 0 the pantograph's force in the paper (text above eq. 6).

    mean : [N] F_m, positive upwards
    amplitude : [N] F_d
    angular_frequency : [rad/s] Ω, not negative
    phase : [rad] φ

    Raises ValueError for a value out of its range.
    """

    mean: float
    amplitude: float = 0.0
    angular_frequency: float = 0.0
    phase: float = 0.0

    def __post_init__(self) -> None:
        finite("mean", self.mean, "N")
        finite("amplitude", self.amplitude, "N")
        non_negative("angular_frequency", self.angular_frequency, "rad/s")
        finite("phase", self.phase, "rad")

    def __call__(self, t: ArrayLike) -> FloatArray:
        """[N] at the times t [s]."""
        time = np.asarray(t, dtype=np.float64)
        return np.asarray(self.mean + self.amplitude * np.sin(self.angular_frequency * time + self.phase))

    def impulse(self, t: ArrayLike) -> FloatArray:
        """[N s] ∫ F from 0 to t; regular as Ω → 0."""
        time = np.asarray(t, dtype=np.float64)
        half_angle = 0.5 * self.angular_frequency * time
        # [cos φ − cos(Ωt + φ)]/Ω written without the difference of near equals and without dividing by Ω
        wave = time * np.sin(half_angle + self.phase) * np.sinc(half_angle / np.pi)
        return np.asarray(self.mean * time + self.amplitude * wave)

    def later(self, delay: float) -> HarmonicForce:
        """The same force on a clock that starts `delay` [s] later."""
        return replace(self, phase=self.phase + self.angular_frequency * delay)


Force: TypeAlias = float | HarmonicForce | Function


def force_values(force: Force, t: ArrayLike) -> FloatArray:
    """[N] F(t) in the shape of t [s]."""
    time = np.asarray(t, dtype=np.float64)
    if callable(force):
        return np.broadcast_to(np.asarray(force(time), dtype=np.float64), time.shape)
    return np.full(time.shape, finite("force", force, "N"))


def as_harmonic(force: Force) -> HarmonicForce:
    """A constant or harmonic force as a harmonic one; any other is refused."""
    if isinstance(force, HarmonicForce):
        return force
    if callable(force):
        rule = "must be constant or harmonic for this closed form"
        raise refuse("force", force, rule, "pass a number or a HarmonicForce, or use images")
    return HarmonicForce(mean=finite("force", force, "N"))


def impulse_function(
    force: Force, until: float, *, impulse: Function | None = None, breakpoints: Sequence[float] = ()
) -> Callable[[FloatArray], FloatArray]:
    """t ↦ ∫ F from 0 to t [N s]: as given, in closed form, or by quadrature on 0 ≤ t ≤ ``until``."""
    if impulse is not None:
        given = impulse
        return lambda t: np.asarray(given(t), dtype=np.float64)
    if callable(force) and not isinstance(force, HarmonicForce):
        return antiderivative(force, 0.0, until, breakpoints=breakpoints)
    return as_harmonic(force).impulse


class MovingLoad(Protocol):
    """What pushes the wire at start + speed · t."""

    @property
    def start(self) -> float: ...

    @property
    def speed(self) -> float: ...

    def contact_force(self, t: float, deflection: float) -> float:
        """[N] upwards on the wire at time t [s], given the deflection there [m]."""
        ...


@dataclass(frozen=True, kw_only=True)
class MovingForce:
    """A force known in advance, moving along the wire (eq. 5).

    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times
    speed : [m/s] not negative
    start : [m] where it is at t = 0; it acts only while it is on the wire

    Raises ValueError for a negative speed.
    """

    force: Force
    speed: float
    start: float = 0.0

    def __post_init__(self) -> None:
        non_negative("speed", self.speed, "m/s")

    def contact_force(self, t: float, deflection: float) -> float:
        """[N] F(t), whatever the deflection."""
        return float(force_values(self.force, t))


@dataclass(frozen=True, kw_only=True)
class ElasticPantograph:
    """A pantograph whose contact force depends on the wire's deflection above it and never pulls.

    F = max(0, law(u)). Source: paper, section 3.1 (fig. 12), which leaves the law open.

    law : [N] force as a function of the deflection [m]; `linear_law` makes the usual one
    speed : [m/s] not negative
    start : [m] where it is at t = 0; it acts only while it is on the wire

    Raises ValueError for a negative speed.
    """

    law: Callable[[float], float]
    speed: float
    start: float = 0.0

    def __post_init__(self) -> None:
        non_negative("speed", self.speed, "m/s")

    def contact_force(self, t: float, deflection: float) -> float:
        """[N] max(0, law(deflection))."""
        return max(0.0, float(self.law(deflection)))


def linear_law(*, force: float, stiffness: float) -> Callable[[float], float]:
    """F₀ − k u [N] as a function of the deflection u [m]: a force that falls as the wire rises.

    force : [N] F₀ on the undeflected wire
    stiffness : [N/m] k, not negative
    """
    slackening = non_negative("stiffness", stiffness, "N/m")
    return lambda deflection: force - slackening * deflection
