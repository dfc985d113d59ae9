"""The string between two rigid ends: standing waves, sine series, images (eq. 7), and its statics."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray, counted, numbers, positive, times, within
from catenary_fe.theory._modal import sine_sum
from catenary_fe.theory._quadrature import Function, antiderivative
from catenary_fe.theory.infinite_string import running_waves


def standing_wave(
    x: ArrayLike, t: ArrayLike, *, wave_speed: float, length: float, mode: int, amplitude: float
) -> FloatArray:
    """One mode of the string swinging freely.

    ü = c² u'', u(0, t) = u(L, t) = 0, u(x, 0) = A sin(kx), u̇(x, 0) = 0, k = nπ/L: u = A sin(kx) cos(kct),
    two running waves of amplitude A/2.
    Source: paper, eq. 7; the shapes on 0 ≤ x ≤ L are sin(nπx/L), the print has cos(lπ/L).

    Parameters
    ----------
    x : [m] positions, 0 ≤ x ≤ L, any shape
    t : [s] times, not negative, broadcasting with x
    wave_speed : [m/s] c
    length : [m] L between the rigid ends
    mode : [-] n, 1 or more
    amplitude : [m] A

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        c or L is not positive, n below 1, x off the string, or a time is negative.
    """
    x, t = within("x", x, 0.0, positive("length", length, "m")), times(t)
    k = counted("mode", mode) * np.pi / length
    return np.asarray(amplitude * np.sin(k * x) * np.cos(k * positive("wave_speed", wave_speed, "m/s") * t))


def _odd_extension(function: Function, length: float) -> Callable[[FloatArray], FloatArray]:
    """Continue a function beyond 0 ≤ x ≤ length by turning it over at the ends."""

    def extended(x: FloatArray) -> FloatArray:
        lap = np.mod(x, 2.0 * length)
        turned = lap > length
        values = np.asarray(function(np.where(turned, 2.0 * length - lap, lap)), dtype=np.float64)
        return np.where(turned, -values, values)

    return extended


def reflected_waves(
    x: ArrayLike,
    t: ArrayLike,
    *,
    wave_speed: float,
    length: float,
    initial_deflection: Function | None = None,
    initial_velocity: Function | None = None,
    breakpoints: Sequence[float] = (),
) -> FloatArray:
    """Free waves on a string between rigid ends, by images: exact.

    d'Alembert's solution on the odd, 2L-periodic continuation of the initial state. ü = c² u'', u(0, t) =
    u(L, t) = 0, u = u₀ and u̇ = v₀ at t = 0. An echo returns inverted.
    Source: method of images (any textbook on waves) on eq. 4 of the paper.

    Parameters
    ----------
    x : [m] positions, 0 ≤ x ≤ L, any shape
    t : [s] times, not negative, broadcasting with x
    wave_speed : [m/s] c
    length : [m] L between the rigid ends
    initial_deflection : [m] u₀ on 0 ≤ x ≤ L, function of positions; none means straight
    initial_velocity : [m/s] v₀ on 0 ≤ x ≤ L, function of positions; none means at rest
    breakpoints : [m] places where v₀ jumps or bends, so that its quadrature stays exact there

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        c or L is not positive, x off the string, a time is negative, or an entry is not finite.
    """
    x = within("x", x, 0.0, positive("length", length, "m"))
    deflection = None if initial_deflection is None else _odd_extension(initial_deflection, length)
    even_integral = None
    if initial_velocity is not None:
        integral = antiderivative(initial_velocity, 0.0, length, breakpoints=breakpoints)

        def even_integral(s: FloatArray) -> FloatArray:
            return integral(np.abs(np.mod(s + length, 2.0 * length) - length))

    return running_waves(
        x, t, wave_speed=wave_speed, initial_deflection=deflection, velocity_antiderivative=even_integral
    )


def initial_value_series(
    x: ArrayLike,
    t: ArrayLike,
    *,
    wave_speed: float,
    length: float,
    initial_deflection: Function | None = None,
    initial_velocity: Function | None = None,
    modes: int = 200,
) -> FloatArray:
    """Free waves on a string between rigid ends, by sine series.

    ü = c² u'', u(0, t) = u(L, t) = 0, u = u₀ and u̇ = v₀ at t = 0: u = Σ [a_n cos ω_n t + (b_n/ω_n) sin ω_n
    t] sin(nπx/L), ω_n = nπc/L, a_n = (2/L) ∫ u₀ sin(nπx/L) dx, b_n likewise of v₀.
    Source: paper, eq. 7; the shapes on 0 ≤ x ≤ L are sin(nπx/L), the print has cos(lπ/L).

    Parameters
    ----------
    x : [m] positions, 0 ≤ x ≤ L, any shape
    t : [s] times, not negative, broadcasting with x
    wave_speed : [m/s] c
    length : [m] L between the rigid ends
    initial_deflection : [m] u₀ on 0 ≤ x ≤ L, function of positions; none means straight
    initial_velocity : [m/s] v₀ on 0 ≤ x ≤ L, function of positions; none means at rest
    modes : [-] number of terms

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        c or L is not positive, x off the string, a time is negative, or an entry is not finite.
    """
    x, t = within("x", x, 0.0, positive("length", length, "m")), times(t)
    c, modes = positive("wave_speed", wave_speed, "m/s"), counted("modes", modes)
    a, b = (
        _sine_coefficients(function, length, modes) for function in (initial_deflection, initial_velocity)
    )

    def amplitude(time: FloatArray, k: float) -> FloatArray:
        index, omega = round(k * length / np.pi) - 1, k * c
        return np.asarray(a[index] * np.cos(omega * time) + b[index] / omega * np.sin(omega * time))

    return sine_sum(x, t, length=length, modes=modes, amplitude=amplitude)


def _sine_coefficients(function: Function | None, length: float, modes: int) -> FloatArray:
    """Return (2/L) ∫ function · sin(nπx/L) dx for n = 1 … modes."""
    if function is None:
        return np.zeros(modes)
    nodes, weights = np.polynomial.legendre.leggauss(8)
    panel = length / max(modes, 64)  # at most half a wave of the shortest mode in a panel of 8 points
    points = (panel * (np.arange(max(modes, 64))[:, None] + 0.5 * (1.0 + nodes))).ravel()
    values = np.broadcast_to(np.asarray(function(points), dtype=np.float64), points.shape)
    weighted = values * np.tile(weights, max(modes, 64)) * panel / length
    return np.asarray([weighted @ np.sin(n * np.pi * points / length) for n in range(1, modes + 1)])


def influence_line(x: FloatArray, place: FloatArray, length: float) -> FloatArray:
    """Static deflection × T under a unit force at `place`, continued odd and 2L-periodic in `place`."""
    lap = np.mod(place, 2.0 * length)
    inside = np.where(lap > length, 2.0 * length - lap, lap)
    line = np.minimum(x, inside) * (length - np.maximum(x, inside)) / length
    return np.where(lap > length, -line, line)


def static_deflection(
    x: ArrayLike, *, tension: float, length: float, position: float, force: float
) -> FloatArray:
    """Deflection of a string between rigid ends under a point force at rest.

    −T u'' = F δ(x − a), u(0) = u(L) = 0: u = F min(x, a) (L − max(x, a))/(T L).
    Source: any textbook on statics.

    Parameters
    ----------
    x : [m] positions, 0 ≤ x ≤ L, any shape
    tension : [N] along the wire, constant
    length : [m] L between the rigid ends
    position : [m] a of the force, 0 ≤ a ≤ L
    force : [N] F, positive upwards

    Returns
    -------
    FloatArray
        [m] deflection, shape of x

    Raises
    ------
    ValueError
        Tension or length is not positive, x or a off the string.
    """
    x = within("x", x, 0.0, positive("length", length, "m"))
    place = within("position", position, 0.0, length)
    return np.asarray(
        force / positive("tension", tension, "N") * influence_line(numbers("x", x), place, length)
    )
