"""Reflection and transmission of running waves at lumped obstacles and droppers; a catenary's key numbers.

Waves are harmonic, proportional to exp(iωt); coefficients are ratios of deflection (or velocity)
amplitudes. Obstacles are described by their impedance, force over velocity. A point force f gives an
infinite string the velocity f/(2Z₀), Z₀ = √(Tρ), which is all that the formulas below need.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import (
    ComplexArray,
    FloatArray,
    non_negative,
    numbers,
    positive,
    refuse,
)


@dataclass(frozen=True, kw_only=True)
class Scattering:
    """What an obstacle makes of an incoming wave of unit amplitude.

    Parameters
    ----------
    reflection : [-] complex amplitude of the wave sent back
    transmission : [-] complex amplitude of the wave that goes on
    onward_ratio : [-] Z₀ of the wire on which it goes on over Z₀ of the one on which it came
    """

    reflection: ComplexArray
    transmission: ComplexArray
    onward_ratio: float = 1.0

    @property
    def energy(self) -> FloatArray:
        """Outgoing over incoming energy, |r|² + (Z₂/Z₁) |t|²; 1 for an obstacle that loses none."""
        return np.asarray(np.abs(self.reflection) ** 2 + self.onward_ratio * np.abs(self.transmission) ** 2)


@dataclass(frozen=True, kw_only=True)
class DropperScattering(Scattering):
    """What a dropper makes of a wave of unit amplitude on one wire.

    Parameters
    ----------
    reflection : [-] complex amplitude of the wave sent back
    transmission : [-] complex amplitude of the wave that goes on
    crossing : [-] complex amplitude of the two waves, one each way, on the other wire
    impedance_ratio : [-] Z₀ of the other wire over Z₀ of this one
    """

    crossing: ComplexArray
    impedance_ratio: float = 1.0

    @property
    def energy(self) -> FloatArray:
        """Outgoing over incoming energy on both wires, |r|² + |t|² + 2 (Z₂/Z₁) |s|²; 1 without loss."""
        return np.asarray(super().energy + 2.0 * self.impedance_ratio * np.abs(self.crossing) ** 2)


def characteristic_impedance(*, tension: float, mass_per_length: float) -> float:
    """Impedance Z₀ = √(Tρ) of a running wave: transverse force over transverse velocity.

    Source: derived from T u' = ∓ Z₀ u̇ on a wave running right or left (eq. 3).

    Parameters
    ----------
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant

    Returns
    -------
    float
        [N s/m]

    Raises
    ------
    ValueError
        Tension or mass per length is not positive.
    """
    product = positive("tension", tension, "N") * positive("mass_per_length", mass_per_length, "kg/m")
    return float(np.sqrt(product))


def lumped_impedance(
    angular_frequency: ArrayLike, *, mass: float = 0.0, stiffness: float = 0.0, damping: float = 0.0
) -> ComplexArray:
    """Impedance of a mass, a spring to ground and a damper to ground fixed to the same point.

    m ẅ + d ẇ + k w = f, w ∝ exp(iωt): Z = f/ẇ = iωm + d + k/(iω).
    Source: definition.

    Parameters
    ----------
    angular_frequency : [rad/s] ω, positive, any shape
    mass : [kg] m
    stiffness : [N/m] k
    damping : [N s/m] d

    Returns
    -------
    ComplexArray
        [N s/m] shape of `angular_frequency`

    Raises
    ------
    ValueError
        A frequency is not positive, or mass, stiffness or damping is negative.
    """
    omega = _positive_frequency(angular_frequency)
    inertia = omega * non_negative("mass", mass, "kg")
    spring = non_negative("stiffness", stiffness, "N/m") / omega
    return np.asarray(non_negative("damping", damping, "N s/m") + 1j * (inertia - spring))


def _positive_frequency(angular_frequency: ArrayLike) -> FloatArray:
    omega = numbers("angular_frequency", angular_frequency)
    if np.any(omega <= 0.0):
        rule = "must be positive, a wave has a frequency"
        raise refuse("angular_frequency", f"{omega.min():g} rad/s", rule, "leave 0 out or take its limit")
    return omega


def scatter_at_obstacle(impedance: ArrayLike, *, tension: float, mass_per_length: float) -> Scattering:
    """Reflection and transmission at a point obstacle on an infinite string.

    At the obstacle the deflection is continuous, 1 + r = t, and the slope jumps by the obstacle's force, T
    [u'] = Z u̇: r = −Z/(Z + 2Z₀), t = 2Z₀/(Z + 2Z₀), Z₀ = √(Tρ).
    Source: derived from eq. 2 and 3; agrees with r = −Z_m/(Z_m + 2√(Tρ)) of any textbook on waves.

    Parameters
    ----------
    impedance : [N s/m] Z of the obstacle, complex, any shape (see `lumped_impedance`)
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant

    Returns
    -------
    Scattering
        coefficients in the shape of `impedance`

    Raises
    ------
    ValueError
        Tension or mass per length is not positive.
    """
    obstacle = np.asarray(impedance, dtype=np.complex128)
    wire = 2.0 * characteristic_impedance(tension=tension, mass_per_length=mass_per_length)
    total = obstacle + wire
    return Scattering(reflection=np.asarray(-obstacle / total), transmission=np.asarray(wire / total))


def scatter_at_joint(
    *, tension: float, mass_per_length: float, other_tension: float, other_mass_per_length: float
) -> Scattering:
    """Reflection and transmission where one string continues as another.

    Deflection and transverse force are continuous: r = (Z₁ − Z₂)/(Z₁ + Z₂), t = 2Z₁/(Z₁ + Z₂). A fixed end is
    Z₂ → ∞ (r = −1), a free one Z₂ → 0 (r = 1).
    Source: derived from eq. 2 and 3.

    Parameters
    ----------
    tension : [N] of the wire on which the wave arrives
    mass_per_length : [kg/m] of the wire on which the wave arrives
    other_tension : [N] of the wire on which it goes on
    other_mass_per_length : [kg/m] of the wire on which it goes on

    Returns
    -------
    Scattering
        scalar coefficients

    Raises
    ------
    ValueError
        A tension or mass per length is not positive.
    """
    here = characteristic_impedance(tension=tension, mass_per_length=mass_per_length)
    there = characteristic_impedance(tension=other_tension, mass_per_length=other_mass_per_length)
    return Scattering(
        reflection=np.asarray((here - there) / (here + there), dtype=np.complex128),
        transmission=np.asarray(2.0 * here / (here + there), dtype=np.complex128),
        onward_ratio=there / here,
    )


def scatter_at_dropper(
    angular_frequency: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    other_tension: float,
    other_mass_per_length: float,
    stiffness: float = np.inf,
    clamp_mass: float = 0.0,
    other_clamp_mass: float = 0.0,
) -> DropperScattering:
    """Reflection, transmission and crossing at a dropper between two infinite strings.

    The dropper is a taut massless spring k (rigid if infinite), clamps are lumped masses. The other wire
    and its clamp are Z' = 2Z₂ + iωm₂ to it, so that the wave meets Z = iωm₁ + 1/(iω/k + 1/Z'): r and t as
    in `scatter_at_obstacle`, and on the other wire s = t/(1 + iωZ'/k). Rigid and without clamps: r =
    −Z₂/(Z₁ + Z₂), which is minus `reflection_coefficient` for a wave on the contact wire.
    Source: derived here from eq. 2 and 3.

    Parameters
    ----------
    angular_frequency : [rad/s] ω, positive, any shape
    tension : [N] of the wire on which the wave arrives
    mass_per_length : [kg/m] of the wire on which the wave arrives
    other_tension : [N] of the other wire
    other_mass_per_length : [kg/m] of the other wire
    stiffness : [N/m] k of the dropper; infinite for a rigid link, 0 for none
    clamp_mass : [kg] m₁ on the wire on which the wave arrives
    other_clamp_mass : [kg] m₂ on the other wire

    Returns
    -------
    DropperScattering
        coefficients in the shape of `angular_frequency`

    Raises
    ------
    ValueError
        A tension, mass per length or frequency is not positive, or stiffness or a clamp's mass is negative.
    """
    omega = _positive_frequency(angular_frequency)
    here = characteristic_impedance(tension=tension, mass_per_length=mass_per_length)
    there = characteristic_impedance(tension=other_tension, mass_per_length=other_mass_per_length)
    if not stiffness >= 0.0:
        rule = "must be 0 or greater (infinite for a rigid link)"
        raise refuse("stiffness", f"{stiffness:g} N/m", rule, "give the dropper's tensile stiffness")
    other = 2.0 * there + lumped_impedance(omega, mass=other_clamp_mass)
    own = lumped_impedance(omega, mass=clamp_mass)
    # share of this end's velocity that reaches the other end; written so that neither k = 0 nor k = ∞
    # divides by 0
    passed = np.ones(omega.shape) if np.isinf(stiffness) else stiffness / (stiffness + 1j * omega * other)
    met = scatter_at_obstacle(own + passed * other, tension=tension, mass_per_length=mass_per_length)
    return DropperScattering(
        reflection=met.reflection,
        transmission=met.transmission,
        crossing=np.asarray(met.transmission * passed),
        impedance_ratio=there / here,
    )


def doppler_factor(*, speed: float, wave_speed: float) -> float:
    """Doppler factor α = (c − v)/(c + v) of a contact wire and a running speed.

    A wave sent ahead by a pantograph of speed v and thrown back meets it again with its frequency raised by
    1/α.
    Source: the field's standard definition (Kiessling, Puschmann, Schmieder, Contact Lines for Electric
    Railways): recalled, not read; the frequency ratio is derived: (1 + v/c) received over (1 − v/c) sent.

    Parameters
    ----------
    speed : [m/s] v of the pantograph, not negative
    wave_speed : [m/s] c of the contact wire

    Returns
    -------
    float
        [-] 1 at rest, 0 at the wave speed, negative above

    Raises
    ------
    ValueError
        v is negative or c not positive.
    """
    v, c = non_negative("speed", speed, "m/s"), positive("wave_speed", wave_speed, "m/s")
    return (c - v) / (c + v)


def reflection_coefficient(
    *,
    contact_tension: float,
    contact_mass_per_length: float,
    messenger_tension: float,
    messenger_mass_per_length: float,
) -> float:
    """Reflection coefficient of a dropper, r = √(T_m ρ_m)/(√(T_m ρ_m) + √(T_c ρ_c)).

    Magnitude of the wave that a rigid, massless dropper throws back on the contact wire (it returns
    inverted).
    Source: the field's standard definition (Kiessling, Puschmann, Schmieder): recalled, not read; derived by
    `scatter_at_dropper` for a rigid link.

    Parameters
    ----------
    contact_tension : [N] of the contact wire
    contact_mass_per_length : [kg/m] of the contact wire
    messenger_tension : [N] of the messenger wire
    messenger_mass_per_length : [kg/m] of the messenger wire

    Returns
    -------
    float
        [-] between 0 and 1

    Raises
    ------
    ValueError
        A tension or mass per length is not positive.
    """
    contact = characteristic_impedance(tension=contact_tension, mass_per_length=contact_mass_per_length)
    messenger = characteristic_impedance(tension=messenger_tension, mass_per_length=messenger_mass_per_length)
    return messenger / (messenger + contact)


def amplification_coefficient(*, reflection: float, doppler: float) -> float:
    """Amplification coefficient γ = r/α of a catenary at a running speed.

    The part r of a wave that a dropper throws back returns to the pantograph squeezed by 1/α; below 1 the
    force variations die out from echo to echo, above 1 they grow.
    Source: the field's standard definition (Kiessling, Puschmann, Schmieder): recalled, not read.

    Parameters
    ----------
    reflection : [-] r of `reflection_coefficient`, 0 to 1
    doppler : [-] α of `doppler_factor`, positive

    Returns
    -------
    float
        [-] γ

    Raises
    ------
    ValueError
        r is outside 0 to 1, or α is not positive (the pantograph runs at or above the wave speed).
    """
    if not 0.0 <= reflection <= 1.0:
        raise refuse(
            "reflection", reflection, "must lie between 0 and 1", "take it from reflection_coefficient"
        )
    remedy = "choose a speed below the wave speed"
    return reflection / positive("doppler", doppler, "", remedy=remedy)
