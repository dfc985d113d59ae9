"""Point forces at rest or moving on the infinite string (eq. 4 to 6)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray, non_negative, numbers, positive, times
from catenary_fe.theory._quadrature import Function
from catenary_fe.theory.forces import Force, HarmonicForce, force_values, impulse_function
from catenary_fe.theory.infinite_string import wave_speed

# Two speeds or places closer than this (relatively) are the same: rounding must not decide on which side of a
# front.
_SAME = 1e-12


class Influence(NamedTuple):
    """Times between which a moving force has acted on what is seen at (x, t); both 0 if never."""

    first: FloatArray
    last: FloatArray


class Derivatives(NamedTuple):
    """Slope ∂u/∂x [-] and velocity ∂u/∂t [m/s] of the wire."""

    slope: FloatArray
    velocity: FloatArray


def influence_interval(x: ArrayLike, t: ArrayLike, *, wave_speed: float, speed: float) -> Influence:
    """Times whose force is felt at (x, t): {τ : 0 ≤ τ ≤ t, |x − Vτ| ≤ c (t − τ)}, always one interval.

    Source: derived from eq. 4 and 5 (the print has δ(Vt) for δ(x − Vt)).

    Parameters
    ----------
    x : [m] positions, counted from where the force is at t = 0, any shape
    t : [s] times, any shape that broadcasts with x; nothing is felt before t = 0
    wave_speed : [m/s] c
    speed : [m/s] V of the force, not negative; below, at or above c

    Returns
    -------
    Influence
        [s] first and last such time, each in the shape of x and t broadcast; both 0 where nothing is felt

    Raises
    ------
    ValueError
        c is not positive, V is negative, or an entry is not finite.
    """
    x, t = numbers("x", x), numbers("t", t)
    c, v = positive("wave_speed", wave_speed, "m/s"), non_negative("speed", speed, "m/s")
    reach = c * t
    last = np.asarray((reach + x) / (c + v))
    first = np.zeros(last.shape)
    if abs(v - c) <= _SAME * c:
        last = np.where(x <= reach + _SAME * np.abs(reach), last, 0.0)
    elif v < c:
        last = np.minimum(last, (reach - x) / (c - v))
    else:
        first = np.maximum(0.0, (x - reach) / (v - c))
    felt = last > first
    return Influence(np.where(felt, first, 0.0), np.where(felt, last, 0.0))


def moving_force(
    x: ArrayLike,
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    speed: float,
    force: Force,
    impulse: Function | None = None,
    breakpoints: Sequence[float] = (),
) -> FloatArray:
    """Deflection under a point force that starts at x = 0, t = 0 and moves at any speed V ≥ 0.

    ρ ü − T u'' = F(t) δ(x − Vt) on −∞ < x < ∞, u = u̇ = 0 at t = 0:
    u = (1/2ρc) ∫ F(τ) dτ over {0 ≤ τ ≤ t : |x − Vτ| ≤ c (t − τ)}.
    Closed for a constant or harmonic force or with a given `impulse`, by quadrature otherwise. At V = c the
    deflection jumps at x = ct from its largest value, returned there, to zero ahead.
    Source: paper, eq. 4 with eq. 5; factor 1/(2ρc) where the print has ½, δ(x − Vt) where it has δ(Vt).

    Parameters
    ----------
    x : [m] positions, any shape
    t : [s] times, not negative, any shape that broadcasts with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    speed : [m/s] V, not negative; below, at or above the wave speed
    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times
    impulse : [N s] any antiderivative of F as a function of time; used in place of the quadrature
    breakpoints : [s] times where F jumps or bends, so that the quadrature stays exact there

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension or mass is not positive, speed or a time is negative, or an entry is not finite.
    """
    t = times(t)
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    first, last = influence_interval(x, t, wave_speed=c, speed=speed)
    gathered = impulse_function(
        force, float(np.max(t, initial=0.0)), impulse=impulse, breakpoints=breakpoints
    )
    return np.asarray((gathered(last) - gathered(first)) / (2.0 * mass_per_length * c))


def moving_force_derivatives(
    x: ArrayLike, t: ArrayLike, *, tension: float, mass_per_length: float, speed: float, force: Force
) -> Derivatives:
    """Slope and velocity of the string under `moving_force`, by differentiating its limits of integration.

    The slope jumps by F/(T (1 − V²/c²)) at the force; at x = Vt the value ahead of the force is returned. At
    V = c the slope is infinite there, and the value behind the force is returned.
    Source: derived from eq. 4 and 5.

    Parameters
    ----------
    x : [m] positions, any shape
    t : [s] times, not negative, broadcasting with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    speed : [m/s] V, not negative
    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times

    Returns
    -------
    Derivatives
        slope [-] and velocity [m/s], each in the shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension or mass is not positive, speed or a time is negative, or an entry is not finite.
    """
    x, t = np.broadcast_arrays(numbers("x", x), times(t))
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    first, last = influence_interval(x, t, wave_speed=c, speed=speed)
    felt = last > first
    latest = np.where(felt, force_values(force, last), 0.0)
    # Each limit of integration is linear in x and t: (ct ± x)/(c ± V).
    slope, velocity = latest / (c + speed), latest * c / (c + speed)
    gap = c - speed
    if gap > _SAME * c:
        ahead = x >= speed * t
        slope = np.where(ahead, -latest / gap, slope)
        velocity = np.where(ahead, latest * c / gap, velocity)
    elif gap < -_SAME * c:
        earliest = np.where(felt & (first > 0.0), force_values(force, first), 0.0)
        slope, velocity = slope + earliest / gap, velocity - earliest * c / gap
    scale = 2.0 * mass_per_length * c
    return Derivatives(slope / scale, velocity / scale)


def deflection_under_moving_force(
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    speed: float,
    mean: float,
    amplitude: float = 0.0,
    angular_frequency: float = 0.0,
) -> FloatArray:
    """Deflection at the force itself, x = Vt, for F(t) = F_m + F_d sin Ωt.

    Problem as in `moving_force`. For V ≤ c, whatever V: u = (1/2ρc) [F_m t − (F_d/Ω) (cos Ωt − 1)]; for V >
    c the force outruns the wave and u = 0.
    Source: paper, eq. 6; the print has ρc = 1 and + (F_d/2Ω) (cos Ωt − 1), the wrong sign.

    Parameters
    ----------
    t : [s] times, not negative, any shape
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    speed : [m/s] V, not negative
    mean : [N] F_m, positive upwards
    amplitude : [N] F_d
    angular_frequency : [rad/s] Ω, not negative

    Returns
    -------
    FloatArray
        [m] deflection, shape of t

    Raises
    ------
    ValueError
        Tension or mass is not positive, speed, frequency or a time is negative, or an entry is not finite.
    """
    t = times(t)
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    force = HarmonicForce(mean=mean, amplitude=amplitude, angular_frequency=angular_frequency)
    outruns = non_negative("speed", speed, "m/s") > c * (1.0 + _SAME)
    return np.zeros(t.shape) if outruns else force.impulse(t) / (2.0 * mass_per_length * c)


def force_at_rest(
    x: ArrayLike,
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    force: Force,
    position: float = 0.0,
    impulse: Function | None = None,
    breakpoints: Sequence[float] = (),
) -> FloatArray:
    """Deflection under a force F(t) at a fixed place (Duhamel).

    ρ ü − T u'' = F(t) δ(x − a) on −∞ < x < ∞, u = u̇ = 0 at t = 0:
    u = 1/(2 √(Tρ)) ∫ F dτ from 0 to t − |x − a|/c, zero before the wave arrives.
    Source: Duhamel's integral (any textbook on waves); eq. 4 and 5 with V = 0.

    Parameters
    ----------
    x : [m] positions, any shape
    t : [s] times, not negative, broadcasting with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times
    position : [m] a, where the force acts
    impulse : [N s] any antiderivative of F as a function of time; used in place of the quadrature
    breakpoints : [s] times where F jumps or bends, so that the quadrature stays exact there

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension or mass is not positive, a time is negative, or an entry is not finite.
    """
    x, t = numbers("x", x), times(t)
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    felt = np.maximum(0.0, t - np.abs(x - position) / c)
    gathered = impulse_function(
        force, float(np.max(t, initial=0.0)), impulse=impulse, breakpoints=breakpoints
    )
    start = gathered(np.zeros(felt.shape))
    return np.asarray((gathered(felt) - start) / (2.0 * np.sqrt(tension * mass_per_length)))
