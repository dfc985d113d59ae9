"""The tensioned beam: statics with its boundary layer, moving force on pinned ends, free waves (eq. 1)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import (
    FloatArray,
    counted,
    finite,
    non_negative,
    numbers,
    positive,
    refuse,
    times,
    within,
)
from catenary_fe.theory._modal import sine_sum
from catenary_fe.theory._quadrature import Function
from catenary_fe.theory.bounded_moving_force import moving_load
from catenary_fe.theory.bounded_string import static_deflection
from catenary_fe.theory.dispersion import angular_frequency, group_velocity
from catenary_fe.theory.forces import HarmonicForce


def boundary_layer_length(*, tension: float, bending_stiffness: float) -> float:
    """Length √(EI/T) over which bending rounds off the kinks of the string.

    Source: derived from EI w'''' − T w'' = 0 (eq. 1 at rest), whose solutions decay as exp(−x/√(EI/T)).

    Parameters
    ----------
    tension : [N] along the wire, constant
    bending_stiffness : [N m²] EI

    Returns
    -------
    float
        [m]

    Raises
    ------
    ValueError
        Tension is not positive or EI negative.
    """
    stiffness = non_negative("bending_stiffness", bending_stiffness, "N m²")
    return float(np.sqrt(stiffness / positive("tension", tension, "N")))


def beam_point_force(
    x: ArrayLike, *, tension: float, bending_stiffness: float, length: float, position: float, force: float
) -> FloatArray:
    """Static deflection of a pinned tensioned beam under a point force anywhere.

    EI w'''' − T w'' = F δ(x − a), w = w'' = 0 at x = 0 and L: the string's triangle less the rounding
    (F/T) sinh(λx_<) sinh(λ(L − x_>))/(λ sinh λL), λ = √(T/EI), x_< and x_> the smaller and larger of x and
    a. Under a load at mid-span: w = (F L/4T) (1 − tanh u/u), u = λL/2.
    Source: textbook statics of ties; derived here for any position.

    Parameters
    ----------
    x : [m] positions, 0 ≤ x ≤ L, any shape
    tension : [N] along the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string
    length : [m] L between the supports
    position : [m] a of the force, 0 ≤ a ≤ L
    force : [N] F, positive upwards

    Returns
    -------
    FloatArray
        [m] deflection, shape of x

    Raises
    ------
    ValueError
        Tension or length is not positive, EI negative, x or a off the beam.
    """
    triangle = static_deflection(x, tension=tension, length=length, position=position, force=force)
    layer = boundary_layer_length(tension=tension, bending_stiffness=bending_stiffness)
    if layer == 0.0:
        return triangle
    x, a = within("x", x, 0.0, length), float(within("position", position, 0.0, length))
    before, after, whole = np.minimum(x, a) / layer, (length - np.maximum(x, a)) / layer, length / layer
    # sinh p · sinh q/sinh r with the growing exponentials taken out: a thin layer must not overflow
    decay = -np.expm1(-2.0 * before) * np.expm1(-2.0 * after) / np.expm1(-2.0 * whole)
    rounding = force * layer / (2.0 * tension) * np.exp(before + after - whole) * decay
    return np.asarray(triangle - rounding)


def beam_uniform_load(
    x: ArrayLike, *, tension: float, bending_stiffness: float, length: float, load: float
) -> FloatArray:
    """Static deflection of a pinned tensioned beam under a uniform load.

    EI w'''' − T w'' = q, w = w'' = 0 at x = 0 and L:
    w = q x (L − x)/(2T) − (q EI/T²) [1 − cosh(λ(x − L/2))/cosh(λL/2)], λ = √(T/EI).
    Source: textbook statics of ties; derived here. With EI = 0 the sag is q L²/(8T).

    Parameters
    ----------
    x : [m] positions, 0 ≤ x ≤ L, any shape
    tension : [N] along the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string
    length : [m] L between the supports
    load : [N/m] q, positive upwards (a weight is negative)

    Returns
    -------
    FloatArray
        [m] deflection, shape of x

    Raises
    ------
    ValueError
        Tension or length is not positive, EI negative, or x off the beam.
    """
    x = within("x", x, 0.0, positive("length", length, "m"))
    layer = boundary_layer_length(tension=tension, bending_stiffness=bending_stiffness)
    parabola = np.asarray(finite("load", load, "N/m") * x * (length - x) / (2.0 * tension))
    if layer == 0.0:
        return parabola
    near, far = np.minimum(x, length - x) / layer, np.maximum(x, length - x) / layer
    ratio = (np.exp(-near) + np.exp(-far)) / (1.0 + np.exp(-length / layer))
    return np.asarray(parabola - load * layer**2 / tension * (1.0 - ratio))


def beam_point_force_unbounded(
    x: ArrayLike, *, tension: float, bending_stiffness: float, force: float, position: float = 0.0
) -> FloatArray:
    """Static deflection of an infinite tensioned beam relative to the point under the force.

    EI w'''' − T w'' = F δ(x − a), slopes ∓ F/2T far away, w(a) = 0:
    w = −(F/2T) [d − ℓ (1 − exp(−d/ℓ))], d = |x − a|, ℓ = √(EI/T).
    Source: derived from eq. 1 at rest.

    Parameters
    ----------
    x : [m] positions, any shape
    tension : [N] along the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string
    force : [N] F, positive upwards
    position : [m] a of the force

    Returns
    -------
    FloatArray
        [m] deflection below the one at the force, so negative for an upward force; shape of x

    Raises
    ------
    ValueError
        Tension is not positive or EI negative.
    """
    distance = np.abs(numbers("x", x) - position)
    layer = boundary_layer_length(tension=tension, bending_stiffness=bending_stiffness)
    rounding = 0.0 if layer == 0.0 else -layer * np.expm1(-distance / layer)
    return np.asarray(-force / (2.0 * tension) * (distance - rounding))


def beam_moving_force(
    x: ArrayLike,
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    bending_stiffness: float,
    length: float,
    speed: float,
    force: float | HarmonicForce,
    start: float = 0.0,
    modes: int = 400,
) -> FloatArray:
    """Deflection of a pinned tensioned beam under a moving force, by sine series.

    ρ ü + EI u'''' − T u'' = F(t) δ(x − a − Vt) while a + Vt < L, then free; u = u'' = 0 at x = 0 and L, u =
    u̇ = 0 at t = 0. Each mode's amplitude is exact, resonances included; terms fall as 1/n⁴ once n > (L/π)
    √(T/EI).
    Source: paper, eq. 7 with eq. 1 (P = −T; shapes corrected to sines).

    Parameters
    ----------
    x : [m] positions, 0 ≤ x ≤ L, any shape
    t : [s] times, not negative, broadcasting with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string
    length : [m] L between the supports
    speed : [m/s] V, not negative
    force : [N] positive upwards: a number or a `HarmonicForce`
    start : [m] a, where the force is at t = 0, 0 ≤ a ≤ L
    modes : [-] number of terms

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension, mass or length is not positive, EI, speed or a time is negative, x or start off the beam,
        or the force is neither constant nor harmonic.
    """
    x, t = within("x", x, 0.0, positive("length", length, "m")), times(t)
    load = moving_load(force, speed=speed, start=start, length=length)
    wire = {"tension": tension, "mass_per_length": mass_per_length, "bending_stiffness": bending_stiffness}

    def amplitude(time: FloatArray, k: float) -> FloatArray:
        omega = float(angular_frequency(k, **wire))
        return load.amplitude(time, omega, k) * 2.0 / (mass_per_length * length)

    return sine_sum(x, t, length=length, modes=counted("modes", modes), amplitude=amplitude)


@dataclass(frozen=True)
class _Spectrum:
    """Σ [even cos k(x − centre) + odd sin k(x − centre)], the part of a shape that is not rounding."""

    wavenumbers: FloatArray
    even: FloatArray
    odd: FloatArray


def beam_free_waves(
    x: ArrayLike,
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    bending_stiffness: float,
    initial_deflection: Function,
    centre: float = 0.0,
    half_width: float,
    points: int = 512,
) -> FloatArray:
    """Free waves on an infinite tensioned beam from an initial shape at rest, by Fourier's integral.

    ρ ü + EI u'''' − T u'' = 0 on −∞ < x < ∞, u = u₀, u̇ = 0 at t = 0: every component exp(ikx) swings as
    cos ω(k)t. The integral becomes a sum on a period so long that nothing returns before max t.
    Source: paper, remark below fig. 4 (superposed sinusoidal waves); dispersion of eq. 1.

    Parameters
    ----------
    x : [m] positions, any shape
    t : [s] times, not negative, broadcasting with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string
    initial_deflection : [m] smooth u₀, function of positions
    centre : [m] middle of the shape
    half_width : [m] u₀ is negligible farther than this from the centre
    points : [-] samples of the shape over its width, enough to resolve it

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension, mass or half_width is not positive, EI or a time is negative, or the period needs more than
        2²⁰ samples.
    """
    x, t = numbers("x", x), times(t)
    wire = {"tension": tension, "mass_per_length": mass_per_length, "bending_stiffness": bending_stiffness}
    step = 2.0 * positive("half_width", half_width, "m") / counted("points", points, at_least=16)
    offset = np.asarray(x - finite("centre", centre, "m"))

    def spectrum(half_period: float) -> _Spectrum:
        return _significant_waves(initial_deflection, centre, half_period, step, half_width)

    longest = float(spectrum(2.0 * half_width).wavenumbers[-1])
    travelled = float(group_velocity(longest, **wire)) * float(np.max(t, initial=0.0))
    farthest = max(half_width, float(np.max(np.abs(offset), initial=0.0)))
    waves = spectrum(half_width + travelled + farthest)
    total = np.zeros(np.broadcast_shapes(offset.shape, t.shape))
    frequencies = angular_frequency(waves.wavenumbers, **wire)
    for k, omega, even, odd in zip(waves.wavenumbers, frequencies, waves.even, waves.odd, strict=True):
        total += (even * np.cos(k * offset) + odd * np.sin(k * offset)) * np.cos(omega * t)
    return total


def _significant_waves(
    shape: Callable[[FloatArray], ArrayLike],
    centre: float,
    half_period: float,
    step: float,
    half_width: float,
) -> _Spectrum:
    """Return the Fourier components of a shape up to the last that stands out of rounding."""
    half = int(np.ceil(half_period / step))
    if half > 2**19:
        rule = f"needs {2 * half} samples for a period in which nothing returns, more than 2^20"
        raise refuse("t", "too late", rule, "ask for earlier times, a smoother shape or fewer points")
    offset = step * np.arange(-half, half, dtype=np.float64)
    values = np.where(np.abs(offset) <= half_width, np.asarray(shape(centre + offset), dtype=np.float64), 0.0)
    coefficients = np.fft.rfft(np.fft.ifftshift(values)) / offset.size
    coefficients[1:-1] *= 2.0
    size = np.abs(coefficients)
    last = int(np.flatnonzero(size >= 1e-13 * max(float(size.max()), np.finfo(float).tiny)).max(initial=1))
    wavenumbers = np.arange(last + 1, dtype=np.float64) * (np.pi / (half * step))
    return _Spectrum(wavenumbers, coefficients.real[: last + 1], -coefficients.imag[: last + 1])
