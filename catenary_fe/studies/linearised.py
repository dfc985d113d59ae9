"""Linearised runs of cases on one line, one uplift after the other until the mean forces are reached."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.base import Progress, RunCase
from catenary_fe.engines.history import History
from catenary_fe.engines.linearised.doubts import slack_doubts, tension_doubts
from catenary_fe.engines.linearised.run import Extremes, LinearisedEngine
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.reduction import linear_model
from catenary_fe.layout import CatenaryError
from catenary_fe.results import Run
from catenary_fe.statics import Shape
from catenary_fe.studies.mean_force import MeanForce
from catenary_fe.studies.record import make_run

Floats = NDArray[np.float64]

AIMS = 2  # runs for an uplift: means are straight lines over it to 0.01 N
NEAR = 0.3  # [N] from a mean force, where the slope of a single run, to 10 %, is good enough


class LinearisedLine:
    """A line in static equilibrium, linearised, for any number of runs with one time step."""

    def __init__(
        self, shape: Shape, time: TimeSettings | None = None, store_wire: float | None = None
    ) -> None:
        self.shape, self.time = shape, time or TimeSettings()
        model = linear_model(shape.system)
        self.engine = LinearisedEngine(shape.system, model, self.time, store_wire)

    def run(self, cases: Sequence[RunCase], progress: Progress | None = None) -> list[Run | CatenaryError]:
        """Run all cases; where one fails, its error stands in its place.

        progress : called with the share done, 0 to 1
        """
        tasks: list[_Task] = []
        results: list[Run | CatenaryError | _Task] = []
        for case in cases:
            try:
                tasks.append(_Task(self, case))
                results.append(tasks[-1])
            except CatenaryError as error:
                results.append(error)
        self.engine.run(tasks, progress)
        found = [result.result if isinstance(result, _Task) else result for result in results]
        return [result for result in found if result is not None]


class _Task:
    """A case on its way."""

    def __init__(self, line: LinearisedLine, case: RunCase) -> None:
        self._line, self.case = line, case
        self._force = MeanForce(case.pantographs, case.speed)
        self.result: Run | CatenaryError | None = None

    @property
    def uplifts(self) -> Floats:
        return self._force.uplifts

    def failed(self, error: CatenaryError) -> None:
        self.result = error

    def finished(self, history: History, extremes: Extremes, seconds: float) -> bool:
        line, case = self._line, self.case
        catenary, step = line.shape.catenary, line.time.step
        gaps = line.engine.setup.model.gaps
        warnings = [
            *case.warnings,
            *tension_doubts(catenary, gaps, extremes.tension, extremes.tension_step, step),
            *slack_doubts(catenary, extremes.shortening, extremes.shortening_step, step),
        ]
        run = make_run(line.shape, case, self.uplifts, line.time, history, warnings, method="linearised")
        try:
            if not self._force.reached(run):
                return False
            self.result = Run(run.data, seconds)
        except CatenaryError as error:
            self.result = error
        return True


def aimed(shape: Shape, case: RunCase, time: TimeSettings, progress: Progress | None = None) -> MeanForce:
    """Uplifts for a run of another method: a mean depends on its uplift almost alike in all of them.

    They are found by linearised runs; where such a run fails, they are the pantographs' own first guess.
    Raises InputError where uplift and air push a pantograph down.
    """
    force = MeanForce(case.pantographs, case.speed)
    try:
        line = LinearisedLine(shape, time)
        for n in range(AIMS):
            part = share_of(progress, n / AIMS, 1 / AIMS)
            (run,) = line.run([replace(case, pantographs=force.given())], part)
            if isinstance(run, CatenaryError):
                raise run
            if force.aim(run) <= NEAR:
                break
        force.given()  # refuses uplifts that are none
    except CatenaryError:
        return MeanForce(case.pantographs, case.speed)
    force.begin_anew()
    return force


def share_of(progress: Progress | None, begin: float, share: float) -> Progress | None:
    """Progress of a part of the work, which begins where a share is done already."""
    return (lambda done: progress(begin + share * done)) if progress else None
