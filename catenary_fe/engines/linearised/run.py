"""Linearised runs: the same model about its static state, with what is truly nonlinear kept.

Contact that never pulls, droppers that go slack and arms that swing are solved in each step, and tension
changes with the wires' inclination; other large motions are not there. Runs on one catenary share one
factorisation and advance side by side.
"""

from __future__ import annotations

import time as clock
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.linearised.batch import BLOCK, Batch, most_slots
from catenary_fe.engines.linearised.doubts import slack_doubts, tension_doubts
from catenary_fe.engines.linearised.setup import Setup, set_up
from catenary_fe.engines.linearised.start import InitialState, assemble_pantograph, static_contact
from catenary_fe.engines.recorder import Sizes
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.layout import AnyPantograph, CatenaryError, SolverError
from catenary_fe.results import Run
from catenary_fe.statics import Shape
from catenary_fe.studies.mean_force import MeanForce
from catenary_fe.studies.record import make_run

Floats = NDArray[np.float64]
Progress = Callable[[float], None]

AIMS = 2  # runs for an uplift: means are straight lines over it to 0.01 N
NEAR = 0.3  # [N] from a mean force, where the slope of a single run, to 10 %, is good enough


@dataclass(frozen=True)
class Case:
    """One run to do.

    start : [m], shape (pantographs,)
    distance : [m] that each pantograph runs
    warnings : known before the run
    """

    pantographs: Sequence[AnyPantograph]
    speed: float
    start: Floats
    distance: float
    warnings: Sequence[str] = ()


@dataclass
class _Job:
    """A case on its way: tried with one uplift after the other until the mean forces are reached."""

    case: Case
    number: int
    steps: int
    uplifts: MeanForce
    start: InitialState | None = None
    spent: float = 0.0


class LinearisedCatenary:
    """A catenary linearised about its static state, for any number of runs with one time step.

    Raises SolverError if there is no static equilibrium.
    """

    def __init__(
        self, shape: Shape, time: TimeSettings | None = None, store_wire: float | None = None
    ) -> None:
        from catenary_fe.fe.reduction import linear_model

        self._shape, self._time = shape, time or TimeSettings()
        catenary = shape.catenary
        model = linear_model(catenary, shape.mesh, shape.installation)
        self._setup: Setup = set_up(model, self._time, catenary.damping.beta, catenary.contact_wire_height)
        self._every = round(store_wire / self._time.step) if store_wire else 0

    def run(self, cases: Sequence[Case], progress: Progress | None = None) -> list[Run | CatenaryError]:
        """Run all cases; where one fails, its error stands in its place.

        progress : called with the share done, 0 to 1
        """
        results: list[Run | CatenaryError | None] = [None] * len(cases)
        jobs = []
        for number, case in enumerate(cases):
            try:
                jobs.append(self._job(case, number))
            except CatenaryError as error:
                results[number] = error
        waiting = sorted(jobs, key=lambda job: -job.steps)  # long ones first: the slots end together
        if not waiting:
            return [r for r in results if r is not None]
        sizes = self._sizes(jobs)
        slots = Batch(self._setup, sizes, most_slots(self._setup, sizes, len(jobs)), self._every)
        active: dict[int, _Job] = {}
        done = len(cases) - len(jobs)
        while waiting or active:
            for slot in slots.free():
                job = active.pop(slot, None)
                if job:
                    result = self._finish(job, slots, slot)
                    if result is None:
                        waiting.insert(0, job)
                    else:
                        results[job.number] = result
                        done += 1
                while waiting and slot not in active:
                    job = waiting.pop(0)
                    failure = self._begin(job, slots, slot)
                    if failure:
                        results[job.number] = failure
                        done += 1
                    else:
                        active[slot] = job
            if active:
                begin = clock.perf_counter()
                slots.advance(BLOCK)
                for job in active.values():
                    job.spent += (clock.perf_counter() - begin) / len(active)
            if progress:
                under_way = sum(min(slots.heads.step[slot] / job.steps, 1.0) for slot, job in active.items())
                progress((done + under_way) / len(cases))
        return [r for r in results if r is not None]

    def _job(self, case: Case, number: int) -> _Job:
        steps = int(np.floor(case.distance / (case.speed * self._time.step) + 1e-9))
        return _Job(case, number, steps, MeanForce(case.pantographs, case.speed))

    def _sizes(self, jobs: Sequence[_Job]) -> Sizes:
        """Of the cases that can be run; those that cannot fail when they begin."""
        bodies = []
        for job in jobs:
            with suppress(CatenaryError):
                bodies.append([assemble_pantograph(self._setup.model, p) for p in job.case.pantographs])
        steps = max(job.steps for job in jobs)
        return Sizes(
            pantographs=max((len(c) for c in bodies), default=1),
            contacts=max((sum(len(body.touches) for body in c) for c in bodies), default=1),
            coordinates=max([1, *(len(body.K) for c in bodies for body in c)]),
            steps=steps,
            shapes=steps // self._every + 1 if self._every else 0,
        )

    def _begin(self, job: _Job, slots: Batch, slot: int) -> CatenaryError | None:
        begin = clock.perf_counter()
        case = job.case
        try:
            start = static_contact(self._setup, case.pantographs, job.uplifts.uplifts, case.start, case.speed)
        except CatenaryError as error:
            return error
        slots.load(slot, start, job.steps)
        job.start = start
        job.spent += clock.perf_counter() - begin
        return None

    def _finish(self, job: _Job, slots: Batch, slot: int) -> Run | CatenaryError | None:
        """The run, its error, or None if it has to be run again with another uplift."""
        case = job.case
        assert job.start is not None
        history = slots.history(slot, job.start, job.steps, self._shape)
        if not np.isfinite(history.contact_force).all():
            return SolverError(
                f"linearised run at {3.6 * case.speed:g} km/h: the contact force is not finite, or did not"
                " settle in a step; look for stiffnesses far from usual values, or use a smaller time step"
            )
        step, catenary = self._time.step, self._shape.catenary
        warnings = [
            *case.warnings,
            *tension_doubts(catenary, self._setup.model.gaps, *slots.tension_changes(slot), step),
            *slack_doubts(catenary, *slots.shortenings(slot), step),
        ]
        run = make_run(
            self._shape, case.pantographs, job.uplifts.uplifts, case.speed, self._time, history, warnings,
            method="linearised",
        )  # fmt: skip
        try:
            reached = job.uplifts.reached(run)
        except CatenaryError as error:
            return error
        return Run(run.data, job.spent) if reached else None


def aimed(shape: Shape, case: Case, time: TimeSettings, progress: Progress | None = None) -> MeanForce:
    """Uplifts for a run of another method: a mean depends on its uplift almost alike in all of them.

    They are found by linearised runs; where such a run fails, they are the pantographs' own first guess.
    Raises InputError where uplift and air push a pantograph down.
    """
    force = MeanForce(case.pantographs, case.speed)
    try:
        line = LinearisedCatenary(shape, time)
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
