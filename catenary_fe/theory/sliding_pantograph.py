"""A pantograph that answers the infinite string below the wave speed: elastic force, or mass on a spring.

A point moving at V < c on an undisturbed infinite string feels it as a damper, u̇ = F/(2√(Tρ)), whatever V
(eq. 4 with 5, read at x = Vt). That closes the problem without the wire; the wire follows from F(t) by
`moving_force`.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray, finite, non_negative, positive, refuse, times
from catenary_fe.theory.infinite_string import wave_speed


class SlidingOscillator(NamedTuple):
    """Contact force [N], height of the mass [m] and deflection of the wire at the pantograph [m]."""

    force: FloatArray
    mass_height: FloatArray
    deflection: FloatArray


def _wire_damping(tension: float, mass_per_length: float, speed: float) -> float:
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    if non_negative("speed", speed, "m/s") >= c:
        rule = f"must be below the wave speed {c:g} m/s"
        raise refuse("speed", f"{speed:g} m/s", rule, "slow down, or use the method of lines")
    return 2.0 * mass_per_length * c


def elastic_pantograph_force(
    t: ArrayLike, *, tension: float, mass_per_length: float, speed: float, force: float, stiffness: float
) -> FloatArray:
    """Contact force of a pantograph whose force falls as it rises, on an infinite string.

    F = F₀ − k u(Vt, t), ρ ü − T u'' = F(t) δ(x − Vt), u = u̇ = 0 at t = 0, V < c: F = F₀ exp(−k
    t/(2√(Tρ))), which never gets negative. The deflection under it is (F₀ − F)/k; anywhere else
    `moving_force` with this F.
    Source: paper, section 3.1 (fig. 12), solved here with eq. 4 and 5.

    Parameters
    ----------
    t : [s] times, not negative, any shape
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    speed : [m/s] V, not negative, below the wave speed
    force : [N] F₀ on the undeflected wire
    stiffness : [N/m] k, by how much the force falls with the wire's rise

    Returns
    -------
    FloatArray
        [N] contact force, shape of t

    Raises
    ------
    ValueError
        Tension or mass is not positive, a time, speed or stiffness is negative, or the speed reaches c.
    """
    damping = _wire_damping(tension, mass_per_length, speed)
    decay = non_negative("stiffness", stiffness, "N/m") / damping
    return np.asarray(finite("force", force, "N") * np.exp(-decay * times(t)))


def sliding_oscillator(
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    speed: float,
    mass: float,
    contact_stiffness: float,
    uplift_force: float,
    base_stiffness: float = 0.0,
    base_damping: float = 0.0,
) -> SlidingOscillator:
    """Mass on a contact spring, pushed up against an infinite string while it moves along it.

    m z̈ + d ż + b z = F₀ − F, F = k (z − u), 2√(Tρ) u̇ = F at x = Vt, V < c; z = ż = u = 0 at t = 0, wire
    straight and at rest. Bilateral contact: valid while F ≥ 0. Solved by the matrix exponential, exact for
    every t.
    Source: eq. 4 and 5 of the paper for the wire's part; derived here.

    Parameters
    ----------
    t : [s] times, not negative, any shape
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    speed : [m/s] V, not negative, below the wave speed
    mass : [kg] m
    contact_stiffness : [N/m] k between mass and wire
    uplift_force : [N] F₀ on the mass, positive upwards
    base_stiffness : [N/m] b between mass and ground
    base_damping : [N s/m] d between mass and ground

    Returns
    -------
    SlidingOscillator
        force [N], mass_height [m], deflection [m], each in the shape of t

    Raises
    ------
    ValueError
        Tension, mass per length, mass or contact stiffness is not positive, a time, speed, base stiffness
        or damping is negative, or the speed reaches c.
    """
    from scipy.linalg import expm

    time = times(t)
    wire = _wire_damping(tension, mass_per_length, speed)
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
