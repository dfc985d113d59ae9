"""A pulse that meets a mass, spring or damper on an infinite string, in time: echo and what goes on."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray, finite, non_negative, numbers, positive
from catenary_fe.theory._quadrature import Function
from catenary_fe.theory.infinite_string import wave_speed


def pulse_at_obstacle(
    x: ArrayLike,
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    incident: Function,
    begin: float,
    mass: float = 0.0,
    stiffness: float = 0.0,
    damping: float = 0.0,
    longest_step: float = np.inf,
) -> FloatArray:
    """Deflection while a running pulse meets an obstacle at x = 0.

    ρ ü − T u'' = −δ(x) (m ẅ + d ẇ + k w), w = u(0, t), on −∞ < x < ∞; before `begin` only s(t − x/c) runs
    in from the left. The obstacle follows m ẅ + (d + 2Z₀) ẇ + k w = 2Z₀ ṡ, Z₀ = √(Tρ); behind it u = w(t −
    x/c), before it u = s(t − x/c) + w(t + x/c) − s(t + x/c). Its spectrum is `scatter_at_obstacle`.
    Source: derived here from eq. 2 and 3; w by an integrator of order 8 to nearly rounding.

    Parameters
    ----------
    x : [m] positions, the obstacle at 0, any shape
    t : [s] times, any shape that broadcasts with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    incident : [m] s, deflection that the undisturbed pulse would give at x = 0, function of an array of times
    begin : [s] time before which s is negligible
    mass : [kg] m of the obstacle
    stiffness : [N/m] k of its spring to ground
    damping : [N s/m] d of its damper to ground
    longest_step : [s] less than the pulse's duration if it comes so late that the integrator may leap over it

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension or mass per length is not positive, mass, stiffness or damping is negative, or an entry not
        finite.
    """
    x, t = np.broadcast_arrays(numbers("x", x), numbers("t", t))
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    arriving, leaving = t - x / c, t - np.abs(x) / c
    obstacle = _obstacle_motion(
        leaving,
        wire=2.0 * mass_per_length * c,
        incident=incident,
        begin=finite("begin", begin, "s"),
        mass=non_negative("mass", mass, "kg"),
        stiffness=non_negative("stiffness", stiffness, "N/m"),
        damping=non_negative("damping", damping, "N s/m"),
        longest_step=longest_step,
    )
    before = np.asarray(incident(arriving)) + obstacle - np.asarray(incident(leaving))
    return np.where(x < 0.0, before, obstacle)


def _obstacle_motion(
    t: FloatArray,
    *,
    wire: float,
    incident: Function,
    begin: float,
    mass: float,
    stiffness: float,
    damping: float,
    longest_step: float,
) -> FloatArray:
    """Return w(t). With y = m ẇ + (d + 2Z₀) w − 2Z₀ s, ẏ = −k w: no derivative of the pulse is needed."""
    from scipy.integrate import solve_ivp

    resistance = damping + wire
    end = float(np.max(t, initial=begin))
    if end <= begin:
        return np.zeros(t.shape)
    settings = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-14, "dense_output": True}
    max_step = min(positive("longest_step", min(longest_step, 1e300), "s"), (end - begin) / 50.0)

    def pushed(time: FloatArray | float) -> FloatArray:
        return wire * np.asarray(incident(np.asarray(time, dtype=np.float64)), dtype=np.float64)

    def light(time: float, y: FloatArray) -> FloatArray:
        return -stiffness * (y + pushed(time)) / resistance

    def heavy(time: float, y: FloatArray) -> FloatArray:
        return np.array([(y[1] - resistance * y[0] + float(pushed(time))) / mass, -stiffness * y[0]])

    rates, states = (heavy, 2) if mass > 0.0 else (light, 1)
    motion = solve_ivp(rates, (begin, end), np.zeros(states), max_step=max_step, **settings).sol
    felt = np.maximum(t, begin)
    state = np.asarray(motion(felt.ravel()))[0].reshape(t.shape)
    w = state if mass > 0.0 else (state + pushed(felt)) / resistance
    return np.where(t > begin, w, 0.0)
