"""How waves travel on a tensioned beam, free or bedded: frequency, wavenumber, phase and group velocity."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray, counted, non_negative, numbers, positive, refuse


def _squared_frequency(
    k: FloatArray, tension: float, rho: float, stiffness: float, bedding: float
) -> FloatArray:
    positive("tension", tension, "N")
    positive("mass_per_length", rho, "kg/m")
    non_negative("bending_stiffness", stiffness, "N m²")
    non_negative("foundation_stiffness", bedding, "N/m²")
    return np.asarray((tension * k**2 + stiffness * k**4 + bedding) / rho)


def angular_frequency(
    wavenumber: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    bending_stiffness: float = 0.0,
    foundation_stiffness: float = 0.0,
) -> FloatArray:
    """Dispersion relation ω(k) = √((T k² + EI k⁴ + k_f)/ρ) of waves exp(i(kx − ωt)).

    ρ ü + EI u'''' − T u'' + k_f u = 0 on −∞ < x < ∞. Source: paper, eq. 1 with P = −T (the print's P
    compresses).

    Parameters
    ----------
    wavenumber : [rad/m] k, any shape
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string
    foundation_stiffness : [N/m²] k_f per length of the wire, 0 for a free one

    Returns
    -------
    FloatArray
        [rad/s] ω, shape of `wavenumber`

    Raises
    ------
    ValueError
        Tension or mass is not positive, EI or k_f negative, or an entry is not finite.
    """
    k = numbers("wavenumber", wavenumber)
    squared = _squared_frequency(k, tension, mass_per_length, bending_stiffness, foundation_stiffness)
    return np.asarray(np.sqrt(squared))


def wavenumber(
    angular_frequency: ArrayLike, *, tension: float, mass_per_length: float, bending_stiffness: float = 0.0
) -> FloatArray:
    """Wavenumber k(ω) ≥ 0 of a running wave on a tensioned beam, the inverse of `angular_frequency`.

    k² = 2ρω²/(T + √(T² + 4 EI ρ ω²)), the positive root of EI k⁴ + T k² = ρω².
    Source: derived from eq. 1 of the paper.

    Parameters
    ----------
    angular_frequency : [rad/s] ω, any shape
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string

    Returns
    -------
    FloatArray
        [rad/m] k, shape of `angular_frequency`

    Raises
    ------
    ValueError
        Tension or mass is not positive, EI negative, or an entry is not finite.
    """
    omega = numbers("angular_frequency", angular_frequency)
    positive("tension", tension, "N")
    inertia = positive("mass_per_length", mass_per_length, "kg/m") * omega**2
    root = np.sqrt(tension**2 + 4.0 * non_negative("bending_stiffness", bending_stiffness, "N m²") * inertia)
    return np.asarray(np.sqrt(2.0 * inertia / (tension + root)))


def phase_velocity(
    wavenumber: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    bending_stiffness: float = 0.0,
    foundation_stiffness: float = 0.0,
) -> FloatArray:
    """Phase velocity ω/k = √((T + EI k² + k_f/k²)/ρ) of waves on a tensioned beam.

    Problem and source as in `angular_frequency`.

    Parameters
    ----------
    wavenumber : [rad/m] k, any shape; not 0 on a foundation
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string
    foundation_stiffness : [N/m²] k_f per length of the wire, 0 for a free one

    Returns
    -------
    FloatArray
        [m/s] shape of `wavenumber`

    Raises
    ------
    ValueError
        Tension or mass is not positive, EI or k_f negative, k = 0 on a foundation, or an entry is not finite.
    """
    k = numbers("wavenumber", wavenumber)
    if foundation_stiffness == 0.0:
        # k² taken out, so that long waves need no 0/0
        stiffened = _squared_frequency(np.ones(()), tension, mass_per_length, 0.0, 0.0)
        bending = non_negative("bending_stiffness", bending_stiffness, "N m²") * k**2 / mass_per_length
        return np.asarray(np.sqrt(stiffened + bending))
    if np.any(k == 0.0):
        raise refuse("wavenumber", "0 rad/m", "has no finite phase velocity on a foundation", "leave 0 out")
    squared = _squared_frequency(k, tension, mass_per_length, bending_stiffness, foundation_stiffness)
    return np.asarray(np.sqrt(squared) / np.abs(k))


def group_velocity(
    wavenumber: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    bending_stiffness: float = 0.0,
    foundation_stiffness: float = 0.0,
) -> FloatArray:
    """Group velocity dω/dk = (T + 2 EI k²) k/(ρω), with which energy travels; for k ≥ 0.

    Problem and source as in `angular_frequency`. On a free wire it never falls below c.

    Parameters
    ----------
    wavenumber : [rad/m] k, not negative, any shape
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string
    foundation_stiffness : [N/m²] k_f per length of the wire, 0 for a free one

    Returns
    -------
    FloatArray
        [m/s] shape of `wavenumber`

    Raises
    ------
    ValueError
        Tension or mass is not positive, EI or k_f negative, k negative, or an entry is not finite.
    """
    k = numbers("wavenumber", wavenumber)
    if np.any(k < 0.0):
        raise refuse("wavenumber", f"{k.min():g} rad/m", "must not be negative", "give its magnitude")
    stiffened = tension + 2.0 * bending_stiffness * k**2
    if foundation_stiffness == 0.0:
        wire = {
            "tension": tension,
            "mass_per_length": mass_per_length,
            "bending_stiffness": bending_stiffness,
        }
        return np.asarray(stiffened / (mass_per_length * phase_velocity(k, **wire)))
    squared = _squared_frequency(k, tension, mass_per_length, bending_stiffness, foundation_stiffness)
    return np.asarray(stiffened * k / (mass_per_length * np.sqrt(squared)))


def natural_frequencies(
    count: int, *, tension: float, mass_per_length: float, length: float, bending_stiffness: float = 0.0
) -> FloatArray:
    """Natural angular frequencies of a pinned tensioned beam, or of a string with EI = 0.

    ρ ü + EI u'''' − T u'' = 0, u = u'' = 0 at x = 0 and L: ω_n² = (T k² + EI k⁴)/ρ, k = nπ/L, shapes sin(kx).
    Source: paper, eq. 7 (shapes corrected to sines) with eq. 1; any textbook on vibrations.

    Parameters
    ----------
    count : [-] how many, from the first
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    length : [m] L between the supports
    bending_stiffness : [N m²] EI, 0 for a string

    Returns
    -------
    FloatArray
        [rad/s] ω_n, shape (count,), rising

    Raises
    ------
    ValueError
        Tension, mass or length is not positive, EI negative, or count below 1.
    """
    k = np.arange(1, counted("count", count) + 1) * np.pi / positive("length", length, "m")
    return angular_frequency(
        k, tension=tension, mass_per_length=mass_per_length, bending_stiffness=bending_stiffness
    )
