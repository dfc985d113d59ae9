"""The infinite string: waves, distributed loads, forces at rest and moving, pantographs (eq. 2 to 6)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._numerics import (
    FloatArray,
    Function,
    antiderivative,
    counted,
    finite,
    non_negative,
    numbers,
    positive,
    refuse,
    times,
)
from catenary_fe.theory.forces import Force, as_harmonic, force_values, impulse_function
from catenary_fe.theory.wires import String, string_speed

# Two speeds or places closer than this (relatively) are the same: rounding must not decide on which side of a
# front.
_SAME = 1e-12


class Influence(NamedTuple):
    """[s] between which a moving force has acted on what is seen at (x, t); both 0 if never."""

    first: FloatArray
    last: FloatArray


class Derivatives(NamedTuple):
    """Slope ∂u/∂x [-] and velocity ∂u/∂t [m/s] of the wire."""

    slope: FloatArray
    velocity: FloatArray


class SlidingOscillator(NamedTuple):
    """Contact force [N], height of the mass [m] and deflection of the wire at the pantograph [m]."""

    force: FloatArray
    mass_height: FloatArray
    deflection: FloatArray


def running_waves(
    string: String,
    x: ArrayLike,
    t: ArrayLike,
    *,
    initial_deflection: Function | None = None,
    initial_velocity: Function | None = None,
    velocity_antiderivative: Function | None = None,
    breakpoints: Sequence[float] = (),
) -> FloatArray:
    """[m] free waves from any initial shape and velocity (d'Alembert).

    ü = c² u'' on −∞ < x < ∞, u(x, 0) = u₀, u̇(x, 0) = v₀:
    u = ½[u₀(x − ct) + u₀(x + ct)] + (1/2c) ∫ v₀ dξ from x − ct to x + ct.
    Source: paper, eq. 3 and the first two terms of eq. 4; the third is `distributed_load`.

    x : [m] positions, any shape
    t : [s] times, not negative, broadcasting with x
    initial_deflection : [m] u₀ as a function of an array of positions; none: straight
    initial_velocity : [m/s] v₀ likewise, integrated by quadrature; none: at rest
    velocity_antiderivative : [m²/s] any antiderivative of v₀; used in place of the quadrature
    breakpoints : [m] places where v₀ jumps or bends, so that the quadrature stays exact there
    """
    x, t, c = numbers("x", x), times(t), string_speed(string)
    left, right = np.asarray(x - c * t), np.asarray(x + c * t)
    deflection = np.zeros(left.shape)
    if initial_deflection is not None:
        deflection += 0.5 * (np.asarray(initial_deflection(left)) + np.asarray(initial_deflection(right)))
    integral = velocity_antiderivative
    if integral is None and initial_velocity is not None and left.size:
        integral = antiderivative(initial_velocity, left.min(), right.max(), breakpoints=breakpoints)
    if integral is not None:
        deflection += (np.asarray(integral(right)) - np.asarray(integral(left))) / (2.0 * c)
    return deflection


def distributed_load(
    string: String,
    x: ArrayLike,
    t: ArrayLike,
    *,
    load: Callable[[FloatArray, FloatArray], ArrayLike],
    points: int = 24,
) -> FloatArray:
    """[m] deflection of the string, straight and at rest at t = 0, under a distributed load f(x, t).

    ρ ü − T u'' = f on −∞ < x < ∞, u = u̇ = 0 at t = 0:
    u = (1/2ρc) ∫∫ f(ξ, τ) dξ dτ over the triangle 0 ≤ τ ≤ t, |x − ξ| ≤ c (t − τ).
    Source: paper, last term of eq. 4; the print has ½ ∬ f in place of (1/2c) ∬ f/ρ.

    x : [m] positions, any shape
    t : [s] times, not negative, broadcasting with x
    load : [N/m] smooth f(ξ, τ), positive upwards, of two arrays that broadcast
    points : [-] Gauss points each way; more for loads that vary strongly within the triangle
    """
    x, t = np.broadcast_arrays(numbers("x", x), times(t))
    c = string_speed(string)
    nodes, weights = np.polynomial.legendre.leggauss(counted("points", points))
    total = np.zeros(x.shape)
    for node, weight in zip(nodes, weights, strict=True):
        instant = 0.5 * t * (1.0 + node)
        reach = c * (t - instant)
        where = x[..., None] + reach[..., None] * nodes
        values = np.broadcast_to(np.asarray(load(where, instant[..., None])), where.shape)
        total += 0.5 * t * weight * reach * (values @ weights)
    return total / (2.0 * string.impedance)


def influence_interval(string: String, x: ArrayLike, t: ArrayLike, *, speed: float) -> Influence:
    """[s] times whose force is felt at (x, t): {τ : 0 ≤ τ ≤ t, |x − Vτ| ≤ c (t − τ)}, always one interval.

    First and last such time, each in the shape of x and t broadcast; both 0 where nothing is felt.
    Source: derived from eq. 4 and 5 (the print has δ(Vt) for δ(x − Vt)).

    x : [m] positions, counted from where the force is at t = 0, any shape
    t : [s] times, broadcasting with x; nothing is felt before t = 0
    speed : [m/s] V of the force, not negative; below, at or above c
    """
    x, t = numbers("x", x), numbers("t", t)
    c, v = string_speed(string), non_negative("speed", speed, "m/s")
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
    string: String,
    x: ArrayLike,
    t: ArrayLike,
    *,
    speed: float,
    force: Force,
    impulse: Function | None = None,
    breakpoints: Sequence[float] = (),
) -> FloatArray:
    """[m] deflection under a point force that starts at x = 0, t = 0 and moves at any speed V ≥ 0.

    ρ ü − T u'' = F(t) δ(x − Vt) on −∞ < x < ∞, u = u̇ = 0 at t = 0:
    u = (1/2ρc) ∫ F(τ) dτ over {0 ≤ τ ≤ t : |x − Vτ| ≤ c (t − τ)}.
    Closed for a constant or harmonic force or with a given `impulse`, by quadrature otherwise. At V = c the
    deflection jumps at x = ct from its largest value, returned there, to zero ahead.
    Source: paper, eq. 4 with eq. 5; factor 1/(2ρc) where the print has ½, δ(x − Vt) where it has δ(Vt).

    x : [m] positions, any shape
    t : [s] times, not negative, broadcasting with x
    speed : [m/s] V, not negative; below, at or above the wave speed
    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times
    impulse : [N s] any antiderivative of F as a function of time; used in place of the quadrature
    breakpoints : [s] times where F jumps or bends, so that the quadrature stays exact there
    """
    t = times(t)
    first, last = influence_interval(string, x, t, speed=speed)
    until = float(np.max(t, initial=0.0))
    gathered = impulse_function(force, until, impulse=impulse, breakpoints=breakpoints)
    return np.asarray((gathered(last) - gathered(first)) / (2.0 * string.impedance))


def moving_force_derivatives(
    string: String, x: ArrayLike, t: ArrayLike, *, speed: float, force: Force
) -> Derivatives:
    """Slope [-] and velocity [m/s] of the string under `moving_force`, in the shape of x and t broadcast.

    The slope jumps by F/(T (1 − V²/c²)) at the force; at x = Vt the value ahead of the force is returned. At
    V = c the slope is infinite there, and the value behind the force is returned.
    Source: derived from eq. 4 and 5, by differentiating the limits of integration.

    x : [m] positions, any shape
    t : [s] times, not negative, broadcasting with x
    speed : [m/s] V, not negative
    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times
    """
    x, t = np.broadcast_arrays(numbers("x", x), times(t))
    c = string_speed(string)
    first, last = influence_interval(string, x, t, speed=speed)
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
    scale = 2.0 * string.impedance
    return Derivatives(slope / scale, velocity / scale)


def deflection_under_moving_force(string: String, t: ArrayLike, *, speed: float, force: Force) -> FloatArray:
    """[m] deflection at the force itself, x = Vt, for F(t) = F_m + F_d sin Ωt, in the shape of t.

    Problem as in `moving_force`. For V ≤ c, whatever V: u = (1/2ρc) [F_m t − (F_d/Ω) (cos Ωt − 1)]; for V >
    c the force outruns the wave and u = 0.
    Source: paper, eq. 6; the print has ρc = 1 and + (F_d/2Ω) (cos Ωt − 1), the wrong sign.

    t : [s] times, not negative, any shape
    speed : [m/s] V, not negative
    force : [N] positive upwards: a number or a `HarmonicForce`
    """
    t, c = times(t), string_speed(string)
    outruns = non_negative("speed", speed, "m/s") > c * (1.0 + _SAME)
    impulse = as_harmonic(force).impulse(t)
    return np.zeros(t.shape) if outruns else impulse / (2.0 * string.impedance)


def force_at_rest(
    string: String,
    x: ArrayLike,
    t: ArrayLike,
    *,
    force: Force,
    position: float = 0.0,
    impulse: Function | None = None,
    breakpoints: Sequence[float] = (),
) -> FloatArray:
    """[m] deflection under a force F(t) at a fixed place.

    ρ ü − T u'' = F(t) δ(x − a) on −∞ < x < ∞, u = u̇ = 0 at t = 0:
    u = 1/(2 √(Tρ)) ∫ F dτ from 0 to t − |x − a|/c, zero before the wave arrives.
    Source: Duhamel's integral (any textbook on waves); eq. 4 and 5 with V = 0.

    x : [m] positions, any shape
    t : [s] times, not negative, broadcasting with x
    force, impulse, breakpoints : as in `moving_force`
    position : [m] a, where the force acts
    """
    x, t = numbers("x", x), times(t)
    felt = np.maximum(0.0, t - np.abs(x - position) / string_speed(string))
    until = float(np.max(t, initial=0.0))
    gathered = impulse_function(force, until, impulse=impulse, breakpoints=breakpoints)
    start = gathered(np.zeros(felt.shape))
    return np.asarray((gathered(felt) - start) / (2.0 * string.impedance))


def _damping(string: String, speed: float) -> float:
    """[N s/m] 2 √(Tρ), as which a point moving at V < c on an undisturbed string feels it, whatever V.

    u̇ = F/(2√(Tρ)): eq. 4 with 5, read at x = Vt. That closes a pantograph's problem without the wire.
    """
    c = string_speed(string)
    if non_negative("speed", speed, "m/s") >= c:
        rule = f"must be below the wave speed {c:g} m/s"
        raise refuse("speed", f"{speed:g} m/s", rule, "slow down, or use the method of lines")
    return 2.0 * string.impedance


def elastic_pantograph_force(
    string: String, t: ArrayLike, *, speed: float, force: float, stiffness: float
) -> FloatArray:
    """[N] contact force of a pantograph whose force falls as it rises, in the shape of t.

    F = F₀ − k u(Vt, t), ρ ü − T u'' = F(t) δ(x − Vt), u = u̇ = 0 at t = 0, V < c: F = F₀ exp(−k
    t/(2√(Tρ))), which never gets negative. The deflection under it is (F₀ − F)/k; anywhere else
    `moving_force` with this F.
    Source: paper, section 3.1 (fig. 12), solved here with eq. 4 and 5.

    t : [s] times, not negative, any shape
    speed : [m/s] V, not negative, below the wave speed
    force : [N] F₀ on the undeflected wire
    stiffness : [N/m] k, by how much the force falls with the wire's rise
    """
    decay = non_negative("stiffness", stiffness, "N/m") / _damping(string, speed)
    return np.asarray(finite("force", force, "N") * np.exp(-decay * times(t)))


def sliding_oscillator(
    string: String,
    t: ArrayLike,
    *,
    speed: float,
    mass: float,
    contact_stiffness: float,
    uplift_force: float,
    base_stiffness: float = 0.0,
    base_damping: float = 0.0,
) -> SlidingOscillator:
    """Mass on a contact spring, pushed up against the string while it moves along it.

    m z̈ + d ż + b z = F₀ − F, F = k (z − u), 2√(Tρ) u̇ = F at x = Vt, V < c; z = ż = u = 0 at t = 0, wire
    straight and at rest. Bilateral contact: valid while F ≥ 0. Solved by the matrix exponential, exact for
    every t. Force [N], height and deflection [m], each in the shape of t.
    Source: eq. 4 and 5 of the paper for the wire's part; derived here.

    t : [s] times, not negative, any shape
    speed : [m/s] V, not negative, below the wave speed
    mass : [kg] m
    contact_stiffness : [N/m] k between mass and wire
    uplift_force : [N] F₀ on the mass, positive upwards
    base_stiffness : [N/m] b between mass and ground
    base_damping : [N s/m] d between mass and ground
    """
    from scipy.linalg import expm

    time, wire = times(t), _damping(string, speed)
    k, m = positive("contact_stiffness", contact_stiffness, "N/m"), positive("mass", mass, "kg")
    b = non_negative("base_stiffness", base_stiffness, "N/m")
    d = non_negative("base_damping", base_damping, "N s/m")
    # state (z, ż, u, 1): the constant carries the uplift force
    rates = np.array(
        [
            [0.0, 1.0, 0.0, 0.0],
            [-(k + b) / m, -d / m, k / m, finite("uplift_force", uplift_force, "N") / m],
            [k / wire, 0.0, -k / wire, 0.0],
            [0.0, 0.0, 0.0, 0.0],
        ]
    )
    state = np.asarray(expm(rates * time[..., None, None]), dtype=np.float64)[..., 3]
    height, deflection = state[..., 0], state[..., 2]
    return SlidingOscillator(k * (height - deflection), height, deflection)
