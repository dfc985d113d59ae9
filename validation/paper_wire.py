"""The wire of the paper, and what the cases on it share."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from catenary_fe import theory
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.wire_problem import WireMotion, WireProblem
from catenary_fe.layout import Wire
from catenary_fe.studies.single_wire import run_wire
from validation.engines import engine

Floats = NDArray[np.float64]

TENSION, MASS, FORCE = 20e3, 1.33, 200.0  # N, kg/m, N
STRING = theory.String(tension=TENSION, mass_per_length=MASS)
C = STRING.wave_speed  # 122.6 m/s
AXIAL_STIFFNESS = 1.7e7  # N, of 150 mm² copper: the paper names none
PAPER = 'paper, "Selected problems of wave phenomena in catenaries"'


def wire(bending_stiffness: float = 0.0, **changed: float) -> Wire:
    """The paper's wire; a string unless it is given a bending stiffness."""
    values = {"tension": TENSION, "mass_per_length": MASS, "axial_stiffness": AXIAL_STIFFNESS, **changed}
    return Wire(bending_stiffness=bending_stiffness, **values)


def run(
    problem: WireProblem,
    duration: float,
    *,
    step: float = 5e-4,
    interval: float | None = None,
    tolerance: float = 1e-6,
    spectral_radius: float = 0.9,
    energy: bool = False,
) -> WireMotion:
    """Integrate with the steps that most cases take, on the engine that the case is computed with."""
    time = TimeSettings(step=step, tolerance=tolerance, spectral_radius=spectral_radius)
    return run_wire(problem, duration=duration, time=time, interval=interval, energy=energy, method=engine())
