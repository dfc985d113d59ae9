"""The tensioned beam at rest and under a steadily moving force on a foundation; modes of the free beam."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._numerics import (
    FloatArray,
    finite,
    non_negative,
    numbers,
    positive,
    refuse,
    within,
)
from catenary_fe.theory.wires import Beam, String, known

# Characteristic roots nearer than this (relatively) are taken as double: their difference would only be
# rounding.
_DOUBLE_ROOT = 1e-5
# Wavenumbers times length of the free beam's first two bending modes.
_FREE = 4.730040744862704, 7.853204624095838
# Nearer to the critical speed than this (relatively) no steady state is returned.
_CRITICAL = 1e-9


def _layer(wire: String) -> float:
    """[m] √(EI/T) of a wire without a foundation; any other is refused."""
    return float(np.sqrt(known(wire, foundation=False).bending_stiffness / wire.tension))


def static_deflection(
    wire: String, x: ArrayLike, *, length: float, position: float, force: float
) -> FloatArray:
    """[m] static deflection of a wire on pinned ends under a point force anywhere.

    EI w'''' − T w'' = F δ(x − a), w = w'' = 0 at x = 0 and L: the string's triangle F x_< (L − x_>)/(T L),
    less the rounding (F/T) sinh(λx_<) sinh(λ(L − x_>))/(λ sinh λL), λ = √(T/EI), x_< and x_> the smaller and
    larger of x and a. Under a load at mid-span: w = (F L/4T) (1 − tanh u/u), u = λL/2.
    Source: textbook statics of ties; derived here for any position.

    x : [m] positions, 0 ≤ x ≤ L, any shape
    length : [m] L between the ends
    position : [m] a of the force, 0 ≤ a ≤ L
    force : [N] F, positive upwards
    """
    layer, load, tension = _layer(wire), finite("force", force, "N"), wire.tension
    x = within("x", x, 0.0, positive("length", length, "m"))
    a = float(within("position", position, 0.0, length))
    near, far = np.minimum(x, a), length - np.maximum(x, a)
    triangle = np.asarray(load / tension * (near * far / length))
    if layer == 0.0:
        return triangle
    before, after, whole = near / layer, far / layer, length / layer
    # sinh p · sinh q/sinh r with the growing exponentials taken out: a thin layer must not overflow
    decay = -np.expm1(-2.0 * before) * np.expm1(-2.0 * after) / np.expm1(-2.0 * whole)
    rounding = load * layer / (2.0 * tension) * np.exp(before + after - whole) * decay
    return np.asarray(triangle - rounding)


def static_uniform_load(wire: String, x: ArrayLike, *, length: float, load: float) -> FloatArray:
    """[m] static deflection of a wire on pinned ends under a uniform load.

    EI w'''' − T w'' = q, w = w'' = 0 at x = 0 and L:
    w = q x (L − x)/(2T) − (q EI/T²) [1 − cosh(λ(x − L/2))/cosh(λL/2)], λ = √(T/EI).
    Source: textbook statics of ties; derived here. With EI = 0 the sag is q L²/(8T).

    x : [m] positions, 0 ≤ x ≤ L, any shape
    length : [m] L between the ends
    load : [N/m] q, positive upwards (a weight is negative)
    """
    layer, q = _layer(wire), finite("load", load, "N/m")
    x = within("x", x, 0.0, positive("length", length, "m"))
    parabola = np.asarray(q * x * (length - x) / (2.0 * wire.tension))
    if layer == 0.0:
        return parabola
    near, far = np.minimum(x, length - x) / layer, np.maximum(x, length - x) / layer
    ratio = (np.exp(-near) + np.exp(-far)) / (1.0 + np.exp(-length / layer))
    return np.asarray(parabola - q * layer**2 / wire.tension * (1.0 - ratio))


def static_deflection_unbounded(
    wire: String, x: ArrayLike, *, force: float, position: float = 0.0
) -> FloatArray:
    """[m] static deflection of an infinite wire below the point under the force; negative for F > 0.

    EI w'''' − T w'' = F δ(x − a), slopes ∓ F/2T far away, w(a) = 0:
    w = −(F/2T) [d − ℓ (1 − exp(−d/ℓ))], d = |x − a|, ℓ = √(EI/T).
    Source: derived from eq. 1 at rest.

    x : [m] positions, any shape
    force : [N] F, positive upwards
    position : [m] a of the force
    """
    distance, layer = np.abs(numbers("x", x) - finite("position", position, "m")), _layer(wire)
    rounding = 0.0 if layer == 0.0 else -layer * np.expm1(-distance / layer)
    return np.asarray(-finite("force", force, "N") / (2.0 * wire.tension) * (distance - rounding))


def free_beam_shapes(count: int, length: float) -> FloatArray:
    """Coefficients of 1, y, y², … y⁷, shape (count, 8): bending modes of a uniform beam that hangs free.

    count : 1 or 2, of modes: the first is symmetric about the middle, y = 0, the second antisymmetric
    length : [m]

    Each shape's square has the mean 1, so that its modal mass is the beam's mass. The exact shapes,
    cosh(βξ)/cosh(β/2) + cos(βξ)/cos(β/2) and the same of sines, ξ = y/L, tan(β/2) ± tanh(β/2) = 0, are
    projected on Legendre polynomials to the seventh degree: without motion as a rigid body.
    Source: textbook; projection derived here.
    """
    if count not in (1, 2):
        raise refuse("count", count, "must be 1 or 2", "higher ones are not there")
    length = positive("length", length, "m")
    points, weights = np.polynomial.legendre.leggauss(40)
    found = np.zeros((count, 8))
    for n, beta in enumerate(_FREE[:count]):
        even = n % 2 == 0
        circular, hyperbolic = (np.cos, np.cosh) if even else (np.sin, np.sinh)
        exact = hyperbolic(beta * points / 2) / hyperbolic(beta / 2) + circular(beta * points / 2) / circular(
            beta / 2
        )
        series = np.zeros(8)
        for k in (2, 4, 6) if even else (3, 5, 7):
            polynomial = np.polynomial.legendre.legval(points, np.eye(8)[k])
            series[k] = (2 * k + 1) / 2 * np.sum(weights * exact * polynomial)
        series /= np.sqrt(np.sum(series**2 / (2 * np.arange(8) + 1)))
        plain = np.polynomial.legendre.leg2poly(series)
        found[n, : plain.size] = plain * (2 / length) ** np.arange(plain.size)
    return found


def steady_moving_force(beam: Beam, distance: ArrayLike, *, speed: float, force: float) -> FloatArray:
    """[m] steady deflection under a force that has moved for ever along a wire on a foundation.

    ρ ü + EI u'''' − T u'' + k u = F δ(x − Vt), u = w(ξ), ξ = x − Vt: EI w'''' − T' w'' + k w = F δ(ξ),
    T' = T − ρV², w bounded, and above the critical speed waves only where their group velocity carries them.
    String, V < c: w = F/(2 √(kT')) exp(−|ξ| √(k/T')). String, V > c: w = F/√(k|T'|) sin(κ|ξ|) behind, κ =
    √(k/|T'|), nothing ahead. Beam below v_cr: from the two roots r of EI r⁴ − T' r² + k = 0 with Re r < 0,
    w = F/(2 EI) [exp(r₁|ξ|)/r₁ − exp(r₂|ξ|)/r₂]/(r₁² − r₂²). Beam above v_cr: w = F sin(κ₁|ξ|)/(κ₁Δ) behind
    and −F sin(κ₂ξ)/(κ₂Δ) ahead, κ₁ < κ₂ the imaginary roots, Δ = √(T'² − 4 k EI).
    Source: textbook problem (Frýba, recalled, not read); all four forms derived here.

    beam : wire with a foundation, k > 0; it need not bend
    distance : [m] ξ = x − Vt ahead of the force, any shape
    speed : [m/s] V, not negative
    force : [N] F, positive upwards

    Raises ValueError at the critical speed, where no steady state exists.
    """
    xi = numbers("distance", distance)
    bedding, bending = known(beam).foundation_stiffness, beam.bending_stiffness
    positive("foundation_stiffness", bedding, "N/m²", remedy="pass a Beam on a foundation")
    critical, v = beam.critical_speed, non_negative("speed", speed, "m/s")
    if abs(v - critical) <= _CRITICAL * critical:
        rule = "is the critical speed, where the deflection grows without bound"
        raise refuse("speed", f"{v:g} m/s", rule, "choose another speed")
    effective = beam.tension - beam.mass_per_length * v**2
    if v < critical:
        unit = _bound(np.abs(xi), effective, bedding, bending)
    else:
        unit = _radiating(xi, effective, bedding, bending)
    return np.asarray(finite("force", force, "N") * unit)


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
