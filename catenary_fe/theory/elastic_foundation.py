"""A string or tensioned beam on an elastic foundation under a steadily moving force; critical speeds."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray, finite, non_negative, numbers, positive, refuse

# Characteristic roots nearer than this (relatively) are taken as double: their difference would only be
# rounding.
_DOUBLE_ROOT = 1e-5
# Nearer to the critical speed than this (relatively) no steady state is returned.
_CRITICAL = 1e-9


def critical_speed(
    *,
    tension: float,
    mass_per_length: float,
    bending_stiffness: float = 0.0,
    foundation_stiffness: float = 0.0,
) -> float:
    """Speed above which a moving force radiates waves.

    v_cr = √((T + 2 √(k EI))/ρ), for a string the wave speed. It is the least phase velocity of ρ ü + EI
    u'''' − T u'' + k u = 0, reached at wavenumber (k/EI)^¼, where phase and group velocity agree, so that
    the energy put in stays with the force.
    Source: textbook (Frýba, Vibration of Solids and Structures under Moving Loads: recalled, not read);
    derived here.

    Parameters
    ----------
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string
    foundation_stiffness : [N/m²] k per length of the wire, 0 for a free one

    Returns
    -------
    float
        [m/s]

    Raises
    ------
    ValueError
        Tension or mass is not positive, EI or k negative.
    """
    bending = non_negative("bending_stiffness", bending_stiffness, "N m²")
    bedding = non_negative("foundation_stiffness", foundation_stiffness, "N/m²")
    stiffened = positive("tension", tension, "N") + 2.0 * np.sqrt(bedding * bending)
    return float(np.sqrt(stiffened / positive("mass_per_length", mass_per_length, "kg/m")))


def steady_moving_force(
    distance: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    foundation_stiffness: float,
    speed: float,
    force: float,
    bending_stiffness: float = 0.0,
) -> FloatArray:
    """Steady deflection under a force that has moved for ever at constant speed, seen from the force.

    ρ ü + EI u'''' − T u'' + k u = F δ(x − Vt), u = w(ξ), ξ = x − Vt: EI w'''' − T' w'' + k w = F δ(ξ),
    T' = T − ρV², w bounded, and above the critical speed waves only where their group velocity carries them.
    String, V < c: w = F/(2 √(kT')) exp(−|ξ| √(k/T')). String, V > c: w = F/√(k|T'|) sin(κ|ξ|) behind, κ =
    √(k/|T'|), nothing ahead. Beam below v_cr: from the two roots r of EI r⁴ − T' r² + k = 0 with Re r < 0,
    w = F/(2 EI) [exp(r₁|ξ|)/r₁ − exp(r₂|ξ|)/r₂]/(r₁² − r₂²). Beam above v_cr: w = F sin(κ₁|ξ|)/(κ₁Δ) behind
    and −F sin(κ₂ξ)/(κ₂Δ) ahead, κ₁ < κ₂ the imaginary roots, Δ = √(T'² − 4 k EI).
    Source: textbook problem (Frýba, recalled, not read); all four forms derived here.

    Parameters
    ----------
    distance : [m] ξ = x − Vt ahead of the force, any shape
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    foundation_stiffness : [N/m²] k per length of the wire, positive
    speed : [m/s] V, not negative, not the critical speed
    force : [N] F, positive upwards
    bending_stiffness : [N m²] EI, 0 for a string

    Returns
    -------
    FloatArray
        [m] deflection, shape of `distance`

    Raises
    ------
    ValueError
        Tension, mass or foundation stiffness is not positive, EI or V negative, or V is the critical speed,
        where no steady state exists.
    """
    xi = numbers("distance", distance)
    critical = critical_speed(
        tension=tension,
        mass_per_length=mass_per_length,
        bending_stiffness=bending_stiffness,
        foundation_stiffness=positive("foundation_stiffness", foundation_stiffness, "N/m²"),
    )
    v, load = non_negative("speed", speed, "m/s"), finite("force", force, "N")
    if abs(v - critical) <= _CRITICAL * critical:
        rule = "is the critical speed, where the deflection grows without bound"
        raise refuse("speed", f"{v:g} m/s", rule, "choose another speed")
    effective = tension - mass_per_length * v**2
    if v < critical:
        unit = _bound(np.abs(xi), effective, foundation_stiffness, bending_stiffness)
    else:
        unit = _radiating(xi, effective, foundation_stiffness, bending_stiffness)
    return np.asarray(load * unit)


def _bound(distance: FloatArray, effective: float, bedding: float, bending: float) -> FloatArray:
    """Deflection under a unit force below the critical speed: it dies away on both sides."""
    if bending == 0.0:
        decay = np.sqrt(bedding / effective)
        return np.asarray(np.exp(-decay * distance) / (2.0 * np.sqrt(bedding * effective)))
    root = np.sqrt(complex(effective**2 - 4.0 * bedding * bending))
    # of the two squares, the one without cancellation; their product is k/EI
    large = (effective + (root if effective > 0.0 else -root)) / (2.0 * bending)
    r1, r2 = -np.sqrt(large), -np.sqrt(bedding / (bending * large))
    if abs(r1 - r2) < _DOUBLE_ROOT * abs(r1):
        r = 0.5 * (r1 + r2)
        unit = np.exp(r * distance) * (distance / r - 1.0 / r**2) / (2.0 * r)
    else:
        unit = (np.exp(r1 * distance) / r1 - np.exp(r2 * distance) / r2) / (r1**2 - r2**2)
    return np.asarray(unit.real / (2.0 * bending))


def _radiating(xi: FloatArray, effective: float, bedding: float, bending: float) -> FloatArray:
    """Deflection under a unit force above the critical speed: long waves trail, short bending waves lead."""
    split = np.sqrt(effective**2 - 4.0 * bedding * bending)
    long = np.sqrt(2.0 * bedding / (split - effective))
    behind = np.sin(long * np.abs(xi)) / (long * split)
    if bending == 0.0:
        return np.where(xi < 0.0, behind, 0.0)
    short = np.sqrt((split - effective) / (2.0 * bending))
    return np.asarray(np.where(xi < 0.0, behind, -np.sin(short * xi) / (short * split)))
