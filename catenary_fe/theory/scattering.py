"""Waves at obstacles and droppers: reflection, transmission, a pulse in time; a catenary's key numbers.

Waves are harmonic, proportional to exp(iωt); coefficients are ratios of deflection (or velocity)
amplitudes. Obstacles are described by their impedance, force over velocity. A point force f gives an
infinite string the velocity f/(2Z₀), Z₀ = √(Tρ), which is all that the formulas below need.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._numerics import (
    ComplexArray,
    FloatArray,
    Function,
    finite,
    non_negative,
    numbers,
    positive,
    refuse,
)
from catenary_fe.theory.wires import String, known, string_speed


@dataclass(frozen=True, kw_only=True)
class Scattering:
    """What an obstacle or a dropper makes of an incoming wave of unit amplitude.

    reflection : [-] complex amplitude of the wave sent back
    transmission : [-] complex amplitude of the wave that goes on
    crossing : [-] complex amplitude of the two waves, one each way, on the other wire of a dropper
    impedance_ratio : [-] Z₀ of that wire over Z₀ of this one
    """

    reflection: ComplexArray
    transmission: ComplexArray
    crossing: ComplexArray | float = 0.0
    impedance_ratio: float = 1.0

    @property
    def energy(self) -> FloatArray:
        """[-] outgoing over incoming energy, |r|² + |t|² + 2 (Z₂/Z₁) |s|²; 1 without loss."""
        here = np.abs(self.reflection) ** 2 + np.abs(self.transmission) ** 2
        return np.asarray(here + 2.0 * self.impedance_ratio * np.abs(self.crossing) ** 2)


def lumped_impedance(
    angular_frequency: ArrayLike, *, mass: float = 0.0, stiffness: float = 0.0, damping: float = 0.0
) -> ComplexArray:
    """[N s/m] impedance of a mass, a spring and a damper to ground at one point, Z = iωm + d + k/(iω).

    m ẅ + d ẇ + k w = f, w ∝ exp(iωt), Z = f/ẇ, in the shape of ``angular_frequency``. Source: definition.

    angular_frequency : [rad/s] ω, positive, any shape
    mass : [kg] m, not negative
    stiffness : [N/m] k, not negative
    damping : [N s/m] d, not negative
    """
    omega = numbers("angular_frequency", angular_frequency)
    if np.any(omega <= 0.0):
        rule = "must be positive, a wave has a frequency"
        raise refuse("angular_frequency", f"{omega.min():g} rad/s", rule, "leave 0 out or take its limit")
    inertia = omega * non_negative("mass", mass, "kg")
    spring = non_negative("stiffness", stiffness, "N/m") / omega
    return np.asarray(non_negative("damping", damping, "N s/m") + 1j * (inertia - spring))


def _impedance(string: String) -> float:
    """[N s/m] Z₀ of a string; a beam is refused."""
    string_speed(string)
    return string.impedance


def scatter_at_obstacle(string: String, impedance: ArrayLike) -> Scattering:
    """Reflection and transmission at a point obstacle on an infinite string, in the shape of ``impedance``.

    At the obstacle the deflection is continuous, 1 + r = t, and the slope jumps by the obstacle's force, T
    [u'] = Z u̇: r = −Z/(Z + 2Z₀), t = 2Z₀/(Z + 2Z₀), Z₀ = √(Tρ).
    Source: derived from eq. 2 and 3; agrees with r = −Z_m/(Z_m + 2√(Tρ)) of any textbook on waves.

    impedance : [N s/m] Z of the obstacle, complex, any shape (see `lumped_impedance`)
    """
    obstacle, wire = np.asarray(impedance, dtype=np.complex128), 2.0 * _impedance(string)
    total = obstacle + wire
    return Scattering(reflection=np.asarray(-obstacle / total), transmission=np.asarray(wire / total))


def scatter_at_dropper(
    string: String,
    other: String,
    angular_frequency: ArrayLike,
    *,
    stiffness: float = np.inf,
    clamp_mass: float = 0.0,
    other_clamp_mass: float = 0.0,
) -> Scattering:
    """Reflection, transmission and crossing at a dropper between two infinite strings.

    The dropper is a taut massless spring k (rigid if infinite), clamps are lumped masses. The other wire
    and its clamp are Z' = 2Z₂ + iωm₂ to it, so that the wave meets Z = iωm₁ + 1/(iω/k + 1/Z'): r and t as
    in `scatter_at_obstacle`, and on the other wire s = t/(1 + iωZ'/k). Rigid and without clamps: r =
    −Z₂/(Z₁ + Z₂), which is minus `reflection_coefficient` for a wave on the contact wire.
    Source: derived here from eq. 2 and 3.

    string : wire on which the wave arrives
    other : wire at the dropper's other end
    angular_frequency : [rad/s] ω, positive, any shape, in which the coefficients come
    stiffness : [N/m] k of the dropper; infinite for a rigid link, 0 for none
    clamp_mass : [kg] m₁ on the wire on which the wave arrives
    other_clamp_mass : [kg] m₂ on the other wire
    """
    there, omega = _impedance(other), numbers("angular_frequency", angular_frequency)
    if not stiffness >= 0.0:
        rule = "must be 0 or greater (infinite for a rigid link)"
        raise refuse("stiffness", f"{stiffness:g} N/m", rule, "use the dropper's tensile stiffness")
    beyond = 2.0 * there + lumped_impedance(omega, mass=other_clamp_mass)
    own = lumped_impedance(omega, mass=clamp_mass)
    # share of this end's velocity that reaches the other end; written so that neither k = 0 nor k = ∞
    # divides by 0
    passed = np.ones(omega.shape) if np.isinf(stiffness) else stiffness / (stiffness + 1j * omega * beyond)
    met = scatter_at_obstacle(string, own + passed * beyond)
    return Scattering(
        reflection=met.reflection,
        transmission=met.transmission,
        crossing=np.asarray(met.transmission * passed),
        impedance_ratio=there / _impedance(string),
    )


def doppler_factor(wire: String, *, speed: float) -> float:
    """[-] α = (c − v)/(c + v) of a contact wire and a running speed: 0 at the wave speed, negative above.

    A wave sent ahead by a pantograph of speed v and thrown back meets it again with its frequency raised by
    1/α.
    Source: the field's standard definition (Kiessling, Puschmann, Schmieder, Contact Lines for Electric
    Railways): recalled, not read; the frequency ratio is derived: (1 + v/c) received over (1 − v/c) sent.

    speed : [m/s] v of the pantograph, not negative
    """
    v, c = non_negative("speed", speed, "m/s"), known(wire).wave_speed
    return (c - v) / (c + v)


def reflection_coefficient(contact: String, messenger: String) -> float:
    """[-] 0 to 1, r = √(T_m ρ_m)/(√(T_m ρ_m) + √(T_c ρ_c)) of a dropper.

    Magnitude of the wave that a rigid, massless dropper throws back on the contact wire (it returns
    inverted).
    Source: the field's standard definition (Kiessling, Puschmann, Schmieder): recalled, not read; derived by
    `scatter_at_dropper` for a rigid link.
    """
    there = known(messenger).impedance
    return there / (there + known(contact).impedance)


def amplification_coefficient(contact: String, messenger: String, *, speed: float) -> float:
    """[-] γ = r/α of a catenary at a running speed, r of `reflection_coefficient`, α of `doppler_factor`.

    The part r of a wave that a dropper throws back returns to the pantograph squeezed by 1/α; below 1 the
    force variations die out from echo to echo, above 1 they grow.
    Source: the field's standard definition (Kiessling, Puschmann, Schmieder): recalled, not read.

    speed : [m/s] v of the pantograph, not negative, below the contact wire's wave speed
    """
    alpha, remedy = doppler_factor(contact, speed=speed), "choose a speed below the wave speed"
    return reflection_coefficient(contact, messenger) / positive("doppler_factor", alpha, "", remedy=remedy)


def pulse_at_obstacle(
    string: String,
    x: ArrayLike,
    t: ArrayLike,
    *,
    incident: Function,
    begin: float,
    mass: float = 0.0,
    stiffness: float = 0.0,
    damping: float = 0.0,
    longest_step: float = np.inf,
) -> FloatArray:
    """[m] deflection while a running pulse meets an obstacle at x = 0.

    ρ ü − T u'' = −δ(x) (m ẅ + d ẇ + k w), w = u(0, t), on −∞ < x < ∞; before `begin` only s(t − x/c) runs
    in from the left. The obstacle follows m ẅ + (d + 2Z₀) ẇ + k w = 2Z₀ ṡ, Z₀ = √(Tρ); behind it u = w(t −
    x/c), before it u = s(t − x/c) + w(t + x/c) − s(t + x/c). Its spectrum is `scatter_at_obstacle`.
    Source: derived here from eq. 2 and 3; w by an integrator of order 8 to nearly rounding.

    x : [m] positions, the obstacle at 0, any shape
    t : [s] times, broadcasting with x
    incident : [m] s, what the undisturbed pulse would deflect at x = 0, function of an array of times
    begin : [s] time before which s is negligible
    mass : [kg] m of the obstacle, not negative
    stiffness : [N/m] k of its spring to ground, not negative
    damping : [N s/m] d of its damper to ground, not negative
    longest_step : [s] less than the pulse's duration if it comes so late that the integrator may leap over it
    """
    x, t = np.broadcast_arrays(numbers("x", x), numbers("t", t))
    c, wire = string_speed(string), 2.0 * string.impedance
    m, k = non_negative("mass", mass, "kg"), non_negative("stiffness", stiffness, "N/m")
    resistance, start = non_negative("damping", damping, "N s/m") + wire, finite("begin", begin, "s")
    most = positive("longest_step", min(longest_step, 1e300), "s")
    arriving, leaving = t - x / c, t - np.abs(x) / c

    def pushed(time: FloatArray | float) -> FloatArray:
        return wire * np.asarray(incident(np.asarray(time, dtype=np.float64)), dtype=np.float64)

    obstacle = _obstacle_motion(leaving, pushed, start, m, k, resistance, most)
    before = np.asarray(incident(arriving)) + obstacle - np.asarray(incident(leaving))
    return np.where(x < 0.0, before, obstacle)


def _obstacle_motion(
    t: FloatArray,
    pushed: Callable[[FloatArray | float], FloatArray],
    begin: float,
    m: float,
    k: float,
    resistance: float,
    longest_step: float,
) -> FloatArray:
    """w(t) by y = m ẇ + (d + 2Z₀) w − 2Z₀ s, ẏ = −k w: no derivative of the pulse 2Z₀ s is needed."""
    from scipy.integrate import solve_ivp

    end = float(np.max(t, initial=begin))
    if end <= begin:
        return np.zeros(t.shape)

    def light(time: float, y: FloatArray) -> FloatArray:
        return -k * (y + pushed(time)) / resistance

    def heavy(time: float, y: FloatArray) -> FloatArray:
        return np.array([(y[1] - resistance * y[0] + float(pushed(time))) / m, -k * y[0]])

    rates, states = (heavy, 2) if m > 0.0 else (light, 1)
    settings = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-14, "dense_output": True}
    step = min(longest_step, (end - begin) / 50.0)
    motion = solve_ivp(rates, (begin, end), np.zeros(states), max_step=step, **settings).sol
    felt = np.maximum(t, begin)
    state = np.asarray(motion(felt.ravel()))[0].reshape(t.shape)
    w = state if m > 0.0 else (state + pushed(felt)) / resistance
    return np.where(t > begin, w, 0.0)
