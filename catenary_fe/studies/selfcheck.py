"""Whether this installation computes what it should: closed forms, and a short run against pinned numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from catenary_fe import theory
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.wire_problem import WireProblem, even_nodes, graded_nodes
from catenary_fe.layout import Wire, library
from catenary_fe.statics import find_form
from catenary_fe.studies.reference_models import PANTOGRAPH, reference_line
from catenary_fe.studies.simulate import simulate

Progress = Callable[[float], None]

_TENSION, _MASS, _FORCE = 20e3, 1.33, 200.0  # [N], [kg/m], [N] of the paper's wire
_SPANS, _SPEED = 4, 250 / 3.6  # [m/s] of the run
_PINNED = "pinned: this version's own result, which other machines and library versions repeat"
_RUN = (  # name, value, unit, relative tolerance
    ("mean contact force", 115.4527, "N", 0.002),
    ("standard deviation", 25.5841, "N", 0.01),
    ("largest force", 167.9848, "N", 0.01),
    ("largest uplift at a support", 49.6512, "mm", 0.01),
    ("dropper force at mid-span", 86.0828, "N", 0.001),
)


@dataclass(frozen=True)
class SelfCheck:
    """A computed value beside what it should be; the tolerance is relative."""

    name: str
    computed: float
    reference: float
    unit: str
    tolerance: float
    source: str

    @property
    def error(self) -> float:
        """Relative."""
        return abs(self.computed / self.reference - 1)

    @property
    def passed(self) -> bool:
        """False also where the computed value is not a number."""
        return self.error <= self.tolerance


def selfcheck(progress: Progress | None = None) -> list[SelfCheck]:
    """Closed forms of wires at rest and in motion, and a run on four spans of the EN 50318:2002 model.

    progress : called with the share done, 0 to 1

    Raises SolverError where a solve fails.
    """
    parts = (_point_force, _frequencies, _moving_force)
    found: list[SelfCheck] = []
    for i, part in enumerate(parts, start=1):
        found += part()
        if progress:
            progress(0.05 * i)
    begun = 0.05 * len(parts)
    found += _reference_run(progress and (lambda share: progress(begun + (1 - begun) * share)))
    return found


def _wire(bending_stiffness: float = 0.0) -> Wire:
    return Wire(
        mass_per_length=_MASS,
        tension=_TENSION,
        axial_stiffness=1.7e7,
        bending_stiffness=bending_stiffness,
    )


def _beam(bending_stiffness: float = 0.0) -> theory.Beam:
    """The wire of the closed forms, by itself."""
    return theory.Beam(tension=_TENSION, mass_per_length=_MASS, bending_stiffness=bending_stiffness)


def _point_force() -> Iterator[SelfCheck]:
    from catenary_fe.studies.single_wire import wire_at_rest

    length, place = 60.0, 20.0
    x = graded_nodes([0, length], 0.5, kinks=[place], finest=0.005)
    load = theory.MovingForce(force=_FORCE, speed=0.0, start=place)
    u = wire_at_rest(WireProblem(wire=_wire(), x=x, loads=[load]))
    exact = float(theory.static_deflection(_beam(), place, length=length, position=place, force=_FORCE))
    under = float(u[int(np.abs(x - place).argmin())])
    yield SelfCheck("deflection under a force", under, exact, "m", 1e-4, "statics of a string, F a b/(T L)")


def _frequencies() -> Iterator[SelfCheck]:
    from scipy.sparse.linalg import eigsh

    from catenary_fe.studies.single_wire import vertical_matrices

    length, bending = 60.0, 195.0
    K, M = vertical_matrices(WireProblem(wire=_wire(bending), x=even_nodes([0, length], 1.0)))
    K = (K + K.T) / 2
    values = eigsh(K.tocsc(), 10, M.tocsc(), sigma=0.0, v0=np.ones(K.shape[0]), return_eigenvectors=False)
    exact = theory.natural_frequencies(_beam(bending), 10, length=length)
    for n in (0, 9):
        found, wanted = np.sqrt(np.sort(values)[n]) / (2 * np.pi), exact[n] / (2 * np.pi)
        name = f"natural frequency {n + 1} of a wire"
        yield SelfCheck(name, float(found), float(wanted), "Hz", 1e-4, "√((T k² + EI k⁴)/ρ)/2π, k = nπ/L")


def _moving_force() -> Iterator[SelfCheck]:
    from catenary_fe.studies.single_wire import run_wire

    string, duration = _beam(), 0.2
    c = string.wave_speed
    speed = 0.725 * c
    load = theory.MovingForce(force=_FORCE, speed=speed)
    x = even_nodes([-c * duration - 5, 0.0, c * duration + 5], 0.5)
    problem = WireProblem(wire=_wire(), x=x, loads=[load])
    motion = run_wire(
        problem, duration=duration, time=TimeSettings(step=5e-4, tolerance=1e-6), interval=duration
    )
    exact = theory.moving_force(string, motion.x, duration, speed=speed, force=_FORCE)
    behind = int(np.abs(motion.x).argmin())
    source = "d'Alembert, paper eq. 4"
    name = "deflection behind a moving force"
    yield SelfCheck(name, float(motion.deflection[-1][behind]), float(exact[behind]), "m", 0.002, source)


def _reference_run(progress: Progress | None) -> Iterator[SelfCheck]:
    shape = find_form(reference_line(_SPANS, (3,)))
    run = simulate(shape, [library.pantograph(PANTOGRAPH)], speed=_SPEED, progress=progress)
    (force,) = run.contact_force_statistics()
    computed = (
        force.mean,
        force.std,
        force.max,
        1e3 * run.largest_support_uplift(),
        float(shape.dropper_forces[22]),
    )
    for value, (name, pinned, unit, tolerance) in zip(computed, _RUN, strict=True):
        yield SelfCheck(f"run: {name}", value, pinned, unit, tolerance, _PINNED)
