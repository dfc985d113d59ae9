"""Exudyn's solvers, quiet, with our settings and our errors."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType
from typing import Any, Self

import exudyn as exu
import numpy as np

from catenary_fe.engines.settings import TimeSettings
from catenary_fe.layout import SolverError

LOAD_STEPS = 20
STABILISER = 10.0  # [1/s²] times the mass: with it, 50 kN under a wire of 20 kN are found


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


def solve_static(
    mbs: exu.MainSystem, *, what: str, name: Callable[[int], str] = "coordinate {}".format
) -> None:
    """Solve for static equilibrium and make the result the initial state.

    In one load step; where that fails, in many, stabilised, and from there in one again.

    what : the case in words, for the error's text
    name : of a coordinate in words, likewise

    Raises SolverError, with the place where the solve ran away, if the Newton iteration does not converge.
    """
    start = mbs.systemData.GetODE2Coordinates(configuration=exu.ConfigurationType.Initial)
    if not (_settled(mbs) or (_settled(mbs, LOAD_STEPS) and _settled(mbs))):
        moved = np.nan_to_num(np.abs(mbs.systemData.GetODE2Coordinates() - start), nan=np.inf)
        raise SolverError(
            f"{what}: no static equilibrium found, neither at once nor in {LOAD_STEPS} steps of the load; the"
            f" solve ran away at the {name(int(moved.argmax()))}; look there for tensions, lengths,"
            " stiffnesses or forces that are far from usual values, or refine the mesh"
        )


def _settled(mbs: exu.MainSystem, load_steps: int = 1) -> bool:
    """Make static equilibrium the initial state; false if none is found.

    load_steps : if more than one, the Jacobian is stabilised, ever less from step to step and not in the last
    """
    settings = _common_settings()
    static = settings.staticSolver
    static.useLoadFactor = static.adaptiveStep = load_steps > 1
    static.numberOfLoadSteps = load_steps
    static.stabilizerODE2term = STABILISER if load_steps > 1 else 0.0
    static.verboseMode = 0
    static.newton.relativeTolerance = 1e-9
    static.newton.absoluteTolerance = _force_floor(mbs)
    static.newton.maxIterations = 50
    try:
        with _Computing():
            mbs.SolveStatic(settings)
    except exu.SolverError:
        return False
    coordinates = mbs.systemData.GetODE2Coordinates()
    if not np.isfinite(coordinates).all():
        return False
    mbs.systemData.SetODE2Coordinates(coordinates, configuration=exu.ConfigurationType.Initial)
    mbs.systemData.SetAECoordinates(
        mbs.systemData.GetAECoordinates(), configuration=exu.ConfigurationType.Initial
    )
    return True


def solve_dynamic(
    mbs: exu.MainSystem,
    steps: int,
    time: TimeSettings,
    before_step: Callable[[float], None],
    begin: float = 0.0,
) -> bool:
    """Integrate from the initial state over a number of fixed steps; false if one does not converge.

    before_step : called with the time of each step's end before the step
    begin : [s]

    Raises what ``before_step`` raises.
    """
    raised: list[BaseException] = []
    computing = _Computing()

    def called(_: exu.MainSystem, end: float) -> bool:
        try:
            computing.deliver()
            before_step(end)
        except BaseException as error:  # Exudyn would make an error of its own of it, of Ctrl-C, too
            raised.append(error)
        return not raised

    mbs.SetPreStepUserFunction(called)
    settings = _common_settings()
    integration = settings.timeIntegration
    integration.numberOfSteps = steps
    integration.startTime = begin
    integration.endTime = begin + steps * time.step
    integration.verboseMode = 0
    integration.adaptiveStep = False
    integration.automaticStepSize = False
    integration.newton.useModifiedNewton = True
    integration.newton.relativeTolerance = time.tolerance
    integration.newton.absoluteTolerance = 1e-8
    integration.generalizedAlpha.spectralRadius = time.spectral_radius
    converged = True
    try:
        with computing:
            mbs.SolveDynamic(settings)
    except exu.SolverError:
        converged = False
    finally:
        mbs.SetPreStepUserFunction(0)  # none: the static solver would call it, too
    if raised:
        raise raised[0]
    return converged


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


class _Computing:
    """While Exudyn computes, it prints nothing (standard output belongs to the caller), and signals wait.

    It asks Python for signals and leaves what their handlers raise lying about, to come up anywhere later.
    """

    def __enter__(self) -> Self:
        self._print = exu.config.printToConsole
        exu.config.printToConsole = False
        self._waiting: list[tuple[int, FrameType | None]] = []
        self._handlers: dict[int, Callable[[int, FrameType | None], Any]] = {}
        if threading.current_thread() is threading.main_thread():
            for number in (signal.SIGINT, signal.SIGTERM):
                handler = signal.getsignal(number)
                if callable(handler):
                    self._handlers[number] = handler
                    signal.signal(number, lambda *arguments: self._waiting.append(arguments))
        return self

    def deliver(self) -> None:
        """Handle the signals that came; raises what their handlers raise."""
        while self._waiting:
            number, frame = self._waiting.pop()
            self._handlers[number](number, frame)

    def __exit__(self, *_: object) -> None:
        exu.config.printToConsole = self._print
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        self.deliver()
