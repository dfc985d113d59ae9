"""Strings and tensioned beams, free or on an elastic foundation, and how waves travel on them (eq. 1)."""

from __future__ import annotations

from dataclasses import dataclass
from math import sqrt

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._numerics import FloatArray, counted, non_negative, numbers, positive, refuse


@dataclass(frozen=True, kw_only=True)
class String:
    """A wire under a constant tension that does not bend: ρ ü − T u'' = f (eq. 2).

    tension : [N] T along the wire, positive
    mass_per_length : [kg/m] ρ, positive

    Raises ValueError for a value out of its range.
    """

    tension: float
    mass_per_length: float

    def __post_init__(self) -> None:
        positive("tension", self.tension, "N")
        positive("mass_per_length", self.mass_per_length, "kg/m")

    @property
    def bending_stiffness(self) -> float:
        """[N m²] 0 of a string."""
        return 0.0

    @property
    def foundation_stiffness(self) -> float:
        """[N/m²] 0 of a string."""
        return 0.0

    @property
    def wave_speed(self) -> float:
        """[m/s] c = √(T/ρ) of transverse waves without bending (paper, below eq. 2)."""
        return sqrt(self.tension / self.mass_per_length)

    @property
    def impedance(self) -> float:
        """[N s/m] Z₀ = √(Tρ), transverse force over velocity of a wave that runs one way (from eq. 3)."""
        return self.mass_per_length * self.wave_speed


@dataclass(frozen=True, kw_only=True)
class Beam(String):
    """A wire that bends, perhaps on a foundation: ρ ü + EI u'''' − T u'' + k u = f (eq. 1 with P = −T).

    bending_stiffness : [N m²] EI, not negative
    foundation_stiffness : [N/m²] k of the foundation per length of the wire, not negative; 0: a free wire

    Raises ValueError for a value out of its range.
    """

    bending_stiffness: float = 0.0
    foundation_stiffness: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        non_negative("bending_stiffness", self.bending_stiffness, "N m²")
        non_negative("foundation_stiffness", self.foundation_stiffness, "N/m²")

    @property
    def boundary_layer_length(self) -> float:
        """[m] √(EI/T) over which bending rounds the kinks of a string (eq. 1 at rest)."""
        return sqrt(self.bending_stiffness / self.tension)

    @property
    def critical_speed(self) -> float:
        """[m/s] v_cr = √((T + 2 √(k EI))/ρ), above which a moving force radiates waves; of a string c.

        The least phase velocity, at the wavenumber (k/EI)^¼, where it equals the group velocity, so that the
        energy put in stays with the force. Source: textbook (Frýba, Vibration of Solids and Structures under
        Moving Loads: recalled, not read); derived here.
        """
        stiffened = self.tension + 2.0 * sqrt(self.foundation_stiffness * self.bending_stiffness)
        return sqrt(stiffened / self.mass_per_length)


def known(wire: String, *, bending: bool = True, foundation: bool = True) -> String:
    """The wire, if a closed form covers its stiffnesses.

    bending, foundation : whether the form does
    """
    if not isinstance(wire, String):
        raise refuse("wire", repr(wire), "must be a theory.String or a theory.Beam", "pass the wire first")
    for name, unit, covered in (("bending", "N m²", bending), ("foundation", "N/m²", foundation)):
        value = getattr(wire, f"{name}_stiffness")
        if value and not covered:
            rule = "must be 0, this closed form does not cover it"
            raise refuse(f"{name}_stiffness", f"{value:g} {unit}", rule, "use the method of lines")
    return wire


def string_speed(wire: String) -> float:
    """[m/s] wave speed of a wire that neither bends nor has a foundation; any other is refused."""
    return known(wire, bending=False, foundation=False).wave_speed


def angular_frequency(wire: String, wavenumber: ArrayLike) -> FloatArray:
    """[rad/s] of waves exp(i(kx − ωt)), ω(k) = √((T k² + EI k⁴ + k_f)/ρ), in the shape of ``wavenumber``.

    Source: paper, eq. 1 with P = −T (the print's P compresses).

    wavenumber : [rad/m] k, any shape
    """
    return np.asarray(np.sqrt(_squared_frequency(wire, numbers("wavenumber", wavenumber))))


def _squared_frequency(wire: String, k: FloatArray) -> FloatArray:
    elastic = known(wire).tension * k**2 + wire.bending_stiffness * k**4 + wire.foundation_stiffness
    return np.asarray(elastic / wire.mass_per_length)


def wavenumber(wire: String, angular_frequency: ArrayLike) -> FloatArray:
    """[rad/m] k(ω) ≥ 0 of a running wave, in the shape of ``angular_frequency``.

    k² = 2q/(T + √(T² + 4 EI q)), q = ρω² − k_f, the positive root of EI k⁴ + T k² = q.
    Source: derived from eq. 1 of the paper.

    angular_frequency : [rad/s] ω, any shape; on a foundation at least √(k_f/ρ), below which nothing runs
    """
    omega = numbers("angular_frequency", angular_frequency)
    driven = known(wire).mass_per_length * omega**2 - wire.foundation_stiffness
    if np.any(driven < -1e-12 * wire.foundation_stiffness):
        least = sqrt(wire.foundation_stiffness / wire.mass_per_length)
        rule = f"must be at least {least:g} rad/s, below which no wave runs on this foundation"
        raise refuse("angular_frequency", f"{np.abs(omega).min():g} rad/s", rule, "leave those out")
    driven = np.maximum(driven, 0.0)  # at the limit itself, rounding may leave it below
    root = np.sqrt(wire.tension**2 + 4.0 * wire.bending_stiffness * driven)
    return np.asarray(np.sqrt(2.0 * driven / (wire.tension + root)))


def phase_velocity(wire: String, wavenumber: ArrayLike) -> FloatArray:
    """[m/s] ω/k = √((T + EI k² + k_f/k²)/ρ), in the shape of ``wavenumber``. Source: as `angular_frequency`.

    wavenumber : [rad/m] k, any shape; not 0 on a foundation
    """
    k, rho = numbers("wavenumber", wavenumber), known(wire).mass_per_length
    if wire.foundation_stiffness == 0.0:  # k² taken out, so that long waves need no 0/0
        return np.asarray(np.sqrt(wire.tension / rho + wire.bending_stiffness * k**2 / rho))
    if np.any(k == 0.0):
        raise refuse("wavenumber", "0 rad/m", "has no finite phase velocity on a foundation", "leave 0 out")
    return np.asarray(np.sqrt(_squared_frequency(wire, k)) / np.abs(k))


def group_velocity(wire: String, wavenumber: ArrayLike) -> FloatArray:
    """[m/s] dω/dk = (T + 2 EI k²) k/(ρω) of the energy, in the shape of ``wavenumber``.

    Never below c on a free wire. Source: as `angular_frequency`.

    wavenumber : [rad/m] k, not negative, any shape
    """
    k = numbers("wavenumber", wavenumber)
    if np.any(k < 0.0):
        raise refuse("wavenumber", f"{k.min():g} rad/m", "must not be negative", "use its magnitude")
    stiffened = known(wire).tension + 2.0 * wire.bending_stiffness * k**2
    if wire.foundation_stiffness == 0.0:
        return np.asarray(stiffened / (wire.mass_per_length * phase_velocity(wire, k)))
    return np.asarray(stiffened * k / (wire.mass_per_length * angular_frequency(wire, k)))


def natural_frequencies(wire: String, count: int, *, length: float) -> FloatArray:
    """[rad/s] shape (count,), rising: angular frequencies of a wire on pinned ends, shapes sin(nπx/L).

    Source: paper, eq. 7 (shapes corrected to sines) with eq. 1; any textbook on vibrations.

    count : [-] how many, from the first
    length : [m] L between the ends
    """
    k = np.arange(1, counted("count", count) + 1) * np.pi / positive("length", length, "m")
    return angular_frequency(wire, k)
