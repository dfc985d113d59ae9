"""Force histories F(t) of a pantograph: constant, harmonic, or any function of time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray, finite, non_negative
from catenary_fe.theory._quadrature import Function, antiderivative


@dataclass(frozen=True, kw_only=True)
class HarmonicForce:
    """F(t) = F_m + F_d sin(Ω t + φ), with φ = 0 the pantograph's force in the paper (text above eq. 6).

    Parameters
    ----------
    mean : [N] F_m, positive upwards
    amplitude : [N] F_d
    angular_frequency : [rad/s] Ω, not negative
    phase : [rad] φ

    Raises
    ------
    ValueError
        A value is not finite, or the frequency is negative.
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
        """Return the force [N] at the times t [s]."""
        time = np.asarray(t, dtype=np.float64)
        return np.asarray(self.mean + self.amplitude * np.sin(self.angular_frequency * time + self.phase))

    def impulse(self, t: ArrayLike) -> FloatArray:
        """Return ∫ F from 0 to t [N s]; regular as Ω → 0."""
        time = np.asarray(t, dtype=np.float64)
        half_angle = 0.5 * self.angular_frequency * time
        # [cos φ − cos(Ωt + φ)]/Ω written without the difference of near equals and without dividing by Ω
        wave = time * np.sin(half_angle + self.phase) * np.sinc(half_angle / np.pi)
        return np.asarray(self.mean * time + self.amplitude * wave)

    def later(self, delay: float) -> HarmonicForce:
        """Return the same force on a clock that starts `delay` [s] later."""
        return replace(self, phase=self.phase + self.angular_frequency * delay)


Force: TypeAlias = float | HarmonicForce | Function
Impulse: TypeAlias = Callable[[FloatArray], FloatArray]


def force_values(force: Force, t: ArrayLike) -> FloatArray:
    """Return F(t) [N] in the shape of t [s]."""
    time = np.asarray(t, dtype=np.float64)
    if callable(force):
        return np.broadcast_to(np.asarray(force(time), dtype=np.float64), time.shape)
    return np.full(time.shape, finite("force", force, "N"))


def as_harmonic(force: Force) -> HarmonicForce | None:
    """Return the force as a harmonic one if it is constant or harmonic, else None."""
    if isinstance(force, HarmonicForce):
        return force
    return None if callable(force) else HarmonicForce(mean=finite("force", force, "N"))


def impulse_function(
    force: Force, until: float, *, impulse: Function | None = None, breakpoints: Sequence[float] = ()
) -> Impulse:
    """Return t ↦ ∫ F from 0 to t: the given one, the closed one, or one by quadrature on 0 ≤ t ≤ `until`."""
    if impulse is not None:
        given = impulse
        return lambda t: np.asarray(given(t), dtype=np.float64)
    harmonic = as_harmonic(force)
    if harmonic is not None:
        return harmonic.impulse
    assert callable(force)
    return antiderivative(force, 0.0, until, breakpoints=breakpoints)
