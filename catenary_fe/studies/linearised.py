"""Linearised runs of cases on one line, and the uplifts with which pantographs reach their mean forces."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.base import Progress, RunCase
from catenary_fe.engines.checkpoint import Checkpoint
from catenary_fe.engines.history import History
from catenary_fe.engines.linearised.doubts import slack_doubts, tension_doubts
from catenary_fe.engines.linearised.run import Extremes, LinearisedEngine
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.reduction import linear_model
from catenary_fe.layout import AnyPantograph, CatenaryError, InputError, SolverError
from catenary_fe.layout.current_collection import MEAN_FORCE_TOLERANCE
from catenary_fe.results import Run
from catenary_fe.statics import Shape
from catenary_fe.statics.cases import pushed_arms
from catenary_fe.studies.record import make_run

Floats = NDArray[np.float64]

MEAN_FORCE_RUNS = 6
SLOPES = 0.3, 3.0  # of a mean over its uplift, at least and at most: others are chance
TOO_SMALL = 1e-6  # [N]


class MeanForce:
    """Uplifts [N] of a run's pantographs, and the next ones to try, by secants.

    uplifts : shape (pantographs,), to run with
    sought : whether any pantograph asks for a mean force

    Raises InputError where uplift and air push a pantograph down.
    """

    def __init__(self, pantographs: Sequence[AnyPantograph], speed: float) -> None:
        self.uplifts = np.array([p.static_uplift(speed) for p in pantographs])
        self._pantographs = pantographs
        self._targets = [p.target_mean_force(speed) for p in pantographs]
        self.sought = any(target is not None for target in self._targets)
        self._before: tuple[Floats, Floats] | None = None
        self._slope: Floats | None = None  # what a newton more adds to a mean, by the last runs
        self._known: Floats | None = None  # likewise, by runs of another kind
        self._runs = 0

    def state(self) -> dict[str, Floats]:
        """What is known so far, as arrays."""
        nothing = np.full_like(self.uplifts, np.nan)
        before = self._before or (self.uplifts, nothing)
        slope = nothing if self._known is None else self._known
        runs = np.array(float(self._runs))
        return {"uplifts": self.uplifts, "before": np.array(before), "slope": slope, "runs": runs}

    def take_up(self, checkpoint: Checkpoint) -> None:
        """Go on from what a checkpoint carries, and let it carry on."""
        if state := checkpoint.kept:
            self.uplifts, self._runs = state["uplifts"], int(state["runs"])
            uplifts, means = state["before"]
            self._before = None if np.isnan(means).any() else (uplifts, means)
            self._known = None if np.isnan(state["slope"]).any() else state["slope"]
        checkpoint.carried = self.state()

    def given(self) -> list[AnyPantograph]:
        """The pantographs with these uplifts, not asking for a mean force. Raises InputError."""
        return [
            p.with_uplift(float(uplift)) for p, uplift in zip(self._pantographs, self.uplifts, strict=True)
        ]

    def aim(self, run: Run) -> float:
        """Set the next uplifts by a run with these ones; returns by how much [N] it misses a mean force."""
        means, goals = self._means(run)
        self._slope = self._slope_at(means)
        self._before = self.uplifts, means
        self.uplifts = self.uplifts + (goals - means) / self._slope
        return float(np.abs(goals - means).max())

    def begin_anew(self) -> None:
        """Runs to come are of another kind: of those before, only how a mean follows its uplift is kept."""
        self._known = self._slope
        self._before, self._runs = None, 0

    def reached(self, run: Run) -> bool:
        """Whether a run with these uplifts has the means that are asked for; if not, other uplifts are set.

        Raises SolverError when it takes too many runs.
        """
        if not self.sought:
            return True
        self._runs += 1
        if self.aim(run) <= MEAN_FORCE_TOLERANCE:
            return True
        if self._runs == MEAN_FORCE_RUNS:
            means, goals = self._means(run)
            raise SolverError(
                f"mean contact force: after {self._runs} runs the means are {np.round(means, 2).tolist()} N,"
                f" not {np.round(goals, 2).tolist()} N; give an uplift_force instead of a mean_force"
            )
        return False

    def _means(self, run: Run) -> tuple[Floats, Floats]:
        """Mean contact forces of a run, and those that it should have, the same where none is asked for."""
        means = np.array([s.mean for s in run.contact_force_statistics()])
        return means, np.array([m if t is None else t for m, t in zip(means, self._targets, strict=True)])

    def _slope_at(self, means: Floats) -> Floats:
        low, high = SLOPES
        slope = self._known
        if slope is None:
            slope = np.clip(means / np.maximum(self.uplifts, TOO_SMALL), low, high)
        if self._before is None:
            return slope
        step = self.uplifts - self._before[0]
        moved = np.abs(step) > TOO_SMALL
        secant = (means - self._before[1]) / np.where(moved, step, 1.0)
        return np.where(moved & (secant > low) & (secant < high), secant, slope)


AIMS = 2  # runs for an uplift: means are straight lines over it to 0.01 N
NEAR = 0.3  # [N] from a mean force, where the slope of a single run, to 10 %, is good enough


class LinearisedLine:
    """A line in static equilibrium, linearised, for any number of runs with one time step.

    Raises InputError where the wind pushes a steady arm.
    """

    def __init__(
        self, shape: Shape, time: TimeSettings | None = None, store_wire: float | None = None
    ) -> None:
        if pushed := pushed_arms(shape):
            raise InputError(
                f"conditions: at support {pushed[0]} the wind pushes the steady arm, which has no tangent to"
                " linearise about; take the method nonlinear, less wind, or more stagger"
            )
        self.shape, self.time = shape, time or TimeSettings()
        model = linear_model(shape.system)
        self.engine = LinearisedEngine(shape.system, model, self.time, store_wire)

    def run(
        self,
        cases: Sequence[RunCase],
        progress: Progress | None = None,
        *,
        part_of: int | None = None,
    ) -> list[Run | CatenaryError]:
        """Run all cases; where one fails, its error stands in its place.

        progress : called with the share done, 0 to 1
        part_of : number of cases that these are some of, see :meth:`LinearisedEngine.run`
        """
        tasks: list[_Task] = []
        results: list[Run | CatenaryError | _Task] = []
        for case in cases:
            try:
                tasks.append(_Task(self, case))
                results.append(tasks[-1])
            except CatenaryError as error:
                results.append(error)
        self.engine.run(tasks, progress, part_of=part_of)
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
            *tension_doubts(
                line.shape.system,
                catenary.support_positions,
                gaps,
                extremes.tension,
                extremes.tension_step,
                step,
            ),
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
