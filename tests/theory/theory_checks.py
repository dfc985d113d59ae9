"""What the tests of the theory share: the paper's wire, differences, and how far two answers are apart."""

from __future__ import annotations

import numpy as np

from catenary_fe.theory import Beam, String

T, RHO = 20e3, 1.33
STRING = String(tension=T, mass_per_length=RHO)
HEAVIER = String(tension=T, mass_per_length=1.01 * RHO)
TIGHTER = String(tension=1.01 * T, mass_per_length=RHO)
C = STRING.wave_speed
SPEEDS = [0.0, 0.3 * C, 0.725 * C, C, 1.5 * C, 2.0 * C]


def beam_with(bending_stiffness: float = 0.0, **changed: float) -> Beam:
    """The paper's wire with a bending stiffness [N m²]."""
    values = {"tension": T, "mass_per_length": RHO, "bending_stiffness": bending_stiffness, **changed}
    return Beam(**values)


def apart(computed, reference) -> float:
    """Largest difference over the largest reference value."""
    return float(np.max(np.abs(np.asarray(computed) - reference)) / np.max(np.abs(reference)))


def apart_l2(computed, reference) -> float:
    """Root-mean-square difference over the root-mean-square reference."""
    return float(np.linalg.norm(computed - reference) / np.linalg.norm(reference))


def string_residual(u, x, t, *, c=C, load=0.0, step=0.05) -> float:
    """|ü − c² u'' − f/ρ| by central differences over the largest |ü|, at smooth places x and t.

    The time step is not step/c: there the differences cancel for every running wave, whatever its shape.
    """
    tau = 0.6 * step / C
    acceleration = (u(x, t + tau) - 2.0 * u(x, t) + u(x, t - tau)) / tau**2
    curvature = (u(x + step, t) - 2.0 * u(x, t) + u(x - step, t)) / step**2
    return float(np.max(np.abs(acceleration - c**2 * curvature - load)) / np.max(np.abs(acceleration)))


def fitted_rate(steps, errors) -> float:
    """Exponent p of error ∝ step^p."""
    return float(np.polyfit(np.log(steps), np.log(errors), 1)[0])
