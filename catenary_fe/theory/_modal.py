"""Modal amplitudes of a pinned wire, string or beam, under a moving force; regular in every resonance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from catenary_fe.theory._checks import FloatArray
from catenary_fe.theory.forces import HarmonicForce


def _sinc(angle: FloatArray) -> FloatArray:
    return np.asarray(np.sinc(angle / np.pi))


def _driven_by_cosine(t: FloatArray, omega: float, drive: float) -> tuple[FloatArray, FloatArray]:
    """Displacement and rate of q̈ + ω² q = cos(a t), a ≥ 0, from rest; the limit at a = ω included."""
    far, near = 0.5 * (omega + drive) * t, 0.5 * (omega - drive) * t
    displacement = 0.5 * t**2 * _sinc(far) * _sinc(near)
    rate = (omega * t * np.cos(far) * _sinc(near) + np.sin(drive * t)) / (omega + drive)
    return displacement, rate


def _driven_by_sine(t: FloatArray, omega: float, drive: float) -> tuple[FloatArray, FloatArray]:
    """Displacement and rate of q̈ + ω² q = sin(a t), a ≥ 0, from rest; the limit at a = ω included."""
    far, near = 0.5 * (omega + drive) * t, 0.5 * (omega - drive) * t
    displacement = (np.sin(omega * t) / omega - t * np.cos(far) * _sinc(near)) / (omega + drive)
    rate = 0.5 * drive * t**2 * _sinc(far) * _sinc(near)
    return displacement, rate


@dataclass(frozen=True)
class MovingLoad:
    """A constant or harmonic force that moves from `start` at t = 0 and acts until it leaves the wire."""

    force: HarmonicForce
    speed: float
    start: float
    leave: float

    def amplitude(self, t: FloatArray, omega: float, wavenumber: float) -> FloatArray:
        """Return q of q̈ + ω² q = F(t) sin(k (start + V t)), from rest, right side 0 after the force left."""
        acting = np.minimum(t, self.leave)
        displacement, rate = np.zeros(t.shape), np.zeros(t.shape)
        for weight, drive, phase in self._terms(wavenumber):
            if weight == 0.0:
                continue
            by_cosine = _driven_by_cosine(acting, omega, abs(drive))
            by_sine = _driven_by_sine(acting, omega, abs(drive))
            along, across = weight * np.cos(phase), -weight * np.sin(phase) * np.sign(drive)
            displacement += along * by_cosine[0] + across * by_sine[0]
            rate += along * by_cosine[1] + across * by_sine[1]
        since = t - acting
        return displacement * np.cos(omega * since) + rate * since * _sinc(omega * since)

    def _terms(self, wavenumber: float) -> list[tuple[float, float, float]]:
        """Write F(t) sin(k (start + V t)) as a sum of weight · cos(drive · t + phase)."""
        sweep, phase = wavenumber * self.speed, wavenumber * self.start
        half, pulse, lead = 0.5 * self.force.amplitude, self.force.angular_frequency, self.force.phase
        return [
            (self.force.mean, sweep, phase - 0.5 * np.pi),
            (half, sweep - pulse, phase - lead),
            (-half, sweep + pulse, phase + lead),
        ]


def sine_sum(
    x: FloatArray,
    t: FloatArray,
    *,
    length: float,
    modes: int,
    amplitude: Callable[[FloatArray, float], FloatArray],
) -> FloatArray:
    """Return Σ amplitude(t, k) sin(k x), k = nπ/length, n = 1 … modes, in the shape of x and t broadcast.

    One mode at a time: sines and amplitudes are only computed on x and t as given, which are often a row
    and a column.
    """
    total = np.zeros(np.broadcast_shapes(x.shape, t.shape))
    for mode in range(1, modes + 1):
        wavenumber = mode * np.pi / length
        total += amplitude(t, wavenumber) * np.sin(wavenumber * x)
    return total
