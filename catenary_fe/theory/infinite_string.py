"""The infinite string without point forces: wave speed, running waves, distributed loads (eq. 2 to 4)."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray, counted, numbers, positive, times
from catenary_fe.theory._quadrature import Function, antiderivative


def wave_speed(*, tension: float, mass_per_length: float) -> float:
    """Speed of transverse waves on a string, c = √(T/ρ).

    Source: paper, below eq. 2.

    Parameters
    ----------
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant

    Returns
    -------
    float
        [m/s]

    Raises
    ------
    ValueError
        Tension or mass per length is not positive.
    """
    ratio = positive("tension", tension, "N") / positive("mass_per_length", mass_per_length, "kg/m")
    return float(np.sqrt(ratio))


def running_waves(
    x: ArrayLike,
    t: ArrayLike,
    *,
    wave_speed: float,
    initial_deflection: Function | None = None,
    initial_velocity: Function | None = None,
    velocity_antiderivative: Function | None = None,
    breakpoints: Sequence[float] = (),
) -> FloatArray:
    """Free waves from any initial shape and velocity (d'Alembert).

    ü = c² u'' on −∞ < x < ∞, u(x, 0) = u₀, u̇(x, 0) = v₀:
    u = ½[u₀(x − ct) + u₀(x + ct)] + (1/2c) ∫ v₀ dξ from x − ct to x + ct.
    Source: paper, eq. 3 and the first two terms of eq. 4.

    Parameters
    ----------
    x : [m] positions, any shape
    t : [s] times, not negative, any shape that broadcasts with x
    wave_speed : [m/s] c
    initial_deflection : [m] u₀ as a function of an array of positions; none means straight
    initial_velocity : [m/s] v₀ likewise, integrated by quadrature; none means at rest
    velocity_antiderivative : [m²/s] any antiderivative of v₀; used in place of the quadrature
    breakpoints : [m] places where v₀ jumps or bends, so that the quadrature stays exact there

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        c is not positive, a time is negative, or an entry is not finite.
    """
    x, t = numbers("x", x), times(t)
    reach = positive("wave_speed", wave_speed, "m/s") * t
    left, right = np.asarray(x - reach), np.asarray(x + reach)
    deflection = np.zeros(left.shape)
    if initial_deflection is not None:
        deflection += 0.5 * (np.asarray(initial_deflection(left)) + np.asarray(initial_deflection(right)))
    integral = velocity_antiderivative
    if integral is None and initial_velocity is not None and left.size:
        integral = antiderivative(initial_velocity, left.min(), right.max(), breakpoints=breakpoints)
    if integral is not None:
        deflection += (np.asarray(integral(right)) - np.asarray(integral(left))) / (2.0 * wave_speed)
    return deflection


def distributed_load(
    x: ArrayLike,
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    load: Callable[[FloatArray, FloatArray], ArrayLike],
    points: int = 24,
) -> FloatArray:
    """Deflection of the string, straight and at rest at t = 0, under a distributed load f(x, t).

    ρ ü − T u'' = f on −∞ < x < ∞, u = u̇ = 0 at t = 0:
    u = (1/2ρc) ∫∫ f(ξ, τ) dξ dτ over the triangle 0 ≤ τ ≤ t, |x − ξ| ≤ c (t − τ).
    Source: paper, last term of eq. 4; the print has ½ ∬ f in place of (1/2c) ∬ f/ρ.

    Parameters
    ----------
    x : [m] positions, any shape
    t : [s] times, not negative, broadcasting with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    load : [N/m] smooth f(ξ, τ), positive upwards, of two arrays that broadcast
    points : [-] Gauss points each way; more for loads that vary strongly within the triangle

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension or mass is not positive, a time is negative, or an entry is not finite.
    """
    x, t = np.broadcast_arrays(numbers("x", x), times(t))
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    nodes, weights = np.polynomial.legendre.leggauss(counted("points", points))
    total = np.zeros(x.shape)
    for node, weight in zip(nodes, weights, strict=True):
        instant = 0.5 * t * (1.0 + node)
        reach = c * (t - instant)
        where = x[..., None] + reach[..., None] * nodes
        values = np.broadcast_to(np.asarray(load(where, instant[..., None])), where.shape)
        total += 0.5 * t * weight * reach * (values @ weights)
    return total / (2.0 * mass_per_length * c)


def general_solution(
    x: ArrayLike,
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    initial_deflection: Function | None = None,
    initial_velocity: Function | None = None,
    load: Callable[[FloatArray, FloatArray], ArrayLike] | None = None,
) -> FloatArray:
    """Deflection from initial shape, initial velocity and a distributed load together.

    ρ ü − T u'' = f on −∞ < x < ∞, u = u₀ and u̇ = v₀ at t = 0: the sum of `running_waves` and
    `distributed_load`.
    Source: paper, eq. 4, source term (1/2c) ∬ f/ρ (print: ½ ∬ f).

    Parameters
    ----------
    x : [m] positions, any shape
    t : [s] times, not negative, broadcasting with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    initial_deflection : [m] u₀, function of positions; none means straight
    initial_velocity : [m/s] v₀, function of positions; none means at rest
    load : [N/m] f(ξ, τ), positive upwards; none means free

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension or mass is not positive, a time is negative, or an entry is not finite.
    """
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    waves = running_waves(
        x, t, wave_speed=c, initial_deflection=initial_deflection, initial_velocity=initial_velocity
    )
    if load is None:
        return waves
    return waves + distributed_load(x, t, tension=tension, mass_per_length=mass_per_length, load=load)
