"""Exudyn's solvers, quiet, with our settings and our errors."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import exudyn as exu
import numpy as np

from catenary_fe.fe.solver_settings import TimeSettings
from catenary_fe.system import SolverError


def new_system() -> exu.MainSystem:
    """An empty system; its container lives as long as it does."""
    container = exu.SystemContainer()
    system = container.AddSystem()
    system.variables["container"] = container
    return system


def release(system: exu.MainSystem) -> None:
    """Free a system's memory; nothing of it may be used afterwards.

    A system holds its container and the container the system: no garbage collection frees that ring.
    """
    system.variables.pop("container").Reset()


def solve_static(mbs: exu.MainSystem, *, what: str) -> None:
    """Solve for static equilibrium in one load step and make the result the initial state.

    what : the case in words, for the error's text

    Raises SolverError if the Newton iteration does not converge.
    """
    settings = _common_settings()
    settings.staticSolver.useLoadFactor = False
    settings.staticSolver.adaptiveStep = False
    settings.staticSolver.verboseMode = 0
    settings.staticSolver.newton.relativeTolerance = 1e-9
    settings.staticSolver.newton.absoluteTolerance = _force_floor(mbs)
    settings.staticSolver.newton.maxIterations = 50
    try:
        with _quiet():
            mbs.SolveStatic(settings)
    except exu.SolverError:
        raise SolverError(
            f"{what}: no static equilibrium found in 50 Newton iterations; look for tensions, lengths or"
            " stiffnesses that are far from usual values, or refine the mesh"
        ) from None
    coordinates = mbs.systemData.GetODE2Coordinates()
    if not np.isfinite(coordinates).all():
        raise SolverError(f"{what}: the static solution is not finite; a stiffness may be missing")
    mbs.systemData.SetODE2Coordinates(coordinates, configuration=exu.ConfigurationType.Initial)
    mbs.systemData.SetAECoordinates(
        mbs.systemData.GetAECoordinates(), configuration=exu.ConfigurationType.Initial
    )


def solve_dynamic(mbs: exu.MainSystem, *, steps: int, time: TimeSettings, what: str) -> None:
    """Integrate from the initial state over a number of fixed steps.

    Raises SolverError with the time reached if a step does not converge.
    """
    settings = _common_settings()
    integration = settings.timeIntegration
    integration.numberOfSteps = steps
    integration.endTime = steps * time.step
    integration.verboseMode = 0
    integration.adaptiveStep = False
    integration.automaticStepSize = False
    integration.newton.useModifiedNewton = True
    integration.newton.relativeTolerance = time.tolerance
    integration.newton.absoluteTolerance = 1e-8
    integration.generalizedAlpha.spectralRadius = time.spectral_radius
    try:
        with _quiet():
            mbs.SolveDynamic(settings)
    except exu.SolverError:
        reached = mbs.systemData.GetTime()
        raise SolverError(
            f"{what}: no convergence at t = {reached:.4f} s with steps of {time.step:g} s; try a smaller time"
            " step, and look at the contact and dropper stiffnesses"
        ) from None


def _force_floor(mbs: exu.MainSystem) -> float:
    """[N] out of balance that is good enough: rounding of EA ε leaves 4e-5 N on 600 m of wire."""
    return float(1e-3 * max(1.0, mbs.systemData.ODE2Size() / 5000) ** 1.5)


def _common_settings() -> exu.SimulationSettings:
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.active = False
    settings.solution.solverInformationFileName = ""
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    settings.linearSolver.reuseAnalyzedPattern = False
    settings.linearSolver.showCausingItems = False
    settings.parallel.numberOfThreads = 1
    settings.show.globalTimers = False
    settings.show.statistics = False
    return settings


@contextmanager
def _quiet() -> Iterator[None]:
    """Keep Exudyn from printing: standard output belongs to the caller."""
    before = exu.config.printToConsole
    exu.config.printToConsole = False
    try:
        yield
    finally:
        exu.config.printToConsole = before
