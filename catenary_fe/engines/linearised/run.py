"""Linearised runs: the same model about its static state, with what is truly nonlinear kept.

Contact that never pulls, droppers that go slack and arms that swing are solved in each step, and tension
changes with the wires' inclination; other large motions are not there. Runs on one line share one
factorisation and advance side by side.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.base import Progress, RunCase
from catenary_fe.engines.compiled import run_clock
from catenary_fe.engines.history import History
from catenary_fe.engines.linearised.batch import BLOCK, Batch, most_slots
from catenary_fe.engines.linearised.setup import Setup, set_up
from catenary_fe.engines.linearised.start import static_contact
from catenary_fe.engines.recorder import InitialState, Sizes
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.reduction import LinearModel
from catenary_fe.fe.system import System
from catenary_fe.layout import CatenaryError, SolverError

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Extremes:
    """Where a run's motions were largest.

    tension, tension_step : [N], shape (gaps,), largest change of each gap's tension, and the step of it
    shortening, shortening_step : [m], shape (droppers,), likewise of each dropper while slack
    """

    tension: Floats
    tension_step: Integers
    shortening: Floats
    shortening_step: Integers


class Task(Protocol):
    """A run to do, perhaps again and again with other uplifts."""

    @property
    def case(self) -> RunCase: ...

    @property
    def uplifts(self) -> Floats:
        """[N], shape (pantographs,), of the next run."""

    def finished(self, history: History, extremes: Extremes, seconds: float) -> bool:
        """Take a run's history; false where it has to be run again."""

    def failed(self, error: CatenaryError) -> None:
        """Take a run's error."""


@dataclass
class _Job:
    """A task on its way through the batch."""

    task: Task
    steps: int
    start: InitialState | None = None
    spent: float = 0.0


class LinearisedEngine:
    """A line linearised about its static state, for any number of runs with one time step."""

    def __init__(
        self,
        system: System,
        model: LinearModel,
        time: TimeSettings | None = None,
        store_wire: float | None = None,
    ) -> None:
        self._system, self._time = system, time or TimeSettings()
        self.setup: Setup = set_up(model, self._time, system)
        self._every = round(store_wire / self._time.step) if store_wire else 0

    def run(
        self, tasks: Sequence[Task], progress: Progress | None = None, *, part_of: int | None = None
    ) -> None:
        """Run all tasks.

        progress : called with the share done, 0 to 1
        part_of : number of runs that these are some of: it decides whether they go side by side, which moves
            the last digits, so that each gives the same bytes in whatever parts they are run
        """
        jobs = [_Job(task, task.case.steps(self._time.step)) for task in tasks]
        waiting = sorted(jobs, key=lambda job: -job.steps)  # long ones first: the slots end together
        if not waiting:
            return
        sizes = self._sizes(jobs)
        times = self._time.step * np.arange(sizes.steps + 2, dtype=float)
        signals = self._system.signals(times)
        slots = most_slots(self.setup, sizes, part_of or len(jobs))
        batch = Batch(self.setup, sizes, slots, self._every, signals)
        active: dict[int, _Job] = {}
        while waiting or active:
            for slot in batch.free():
                job = active.pop(slot, None)
                if job and not self._finish(job, batch, slot):
                    waiting.insert(0, job)
                while waiting and slot not in active:
                    job = waiting.pop(0)
                    if self._begin(job, batch, slot):
                        active[slot] = job
            if active:
                begin = run_clock()
                batch.advance(BLOCK)
                for job in active.values():
                    job.spent += (run_clock() - begin) / len(active)
            if progress:
                reached = batch.pantographs.step
                under_way = sum(min(reached[slot] / job.steps, 1.0) for slot, job in active.items())
                progress((len(jobs) - len(waiting) - len(active) + under_way) / len(jobs))

    def _sizes(self, jobs: Sequence[_Job]) -> Sizes:
        """Of the tasks that can be run; those that cannot fail when they begin."""
        placed = []
        for job in jobs:
            with suppress(CatenaryError):
                case = job.task.case
                placed.append(case.placed(job.task.uplifts, self._system))
        steps = max(job.steps for job in jobs)
        return Sizes.of(placed, len(self.setup.model.contacts), steps, self._every)

    def _begin(self, job: _Job, batch: Batch, slot: int) -> bool:
        begin, case = run_clock(), job.task.case
        try:
            placed = case.placed(job.task.uplifts, self._system)
            placed = self._system.base_line.moving(placed, case.speed, self._time.step, job.steps)
            job.start = static_contact(self.setup, placed, case.speed, batch.signals[:, 0])
        except CatenaryError as error:
            job.task.failed(error)
            return False
        batch.load(slot, job.start, job.steps)
        job.spent += run_clock() - begin
        return True

    def _finish(self, job: _Job, batch: Batch, slot: int) -> bool:
        """Hand over the run or its error; false if it has to be run again with another uplift."""
        assert job.start is not None
        history = batch.history(slot, job.start, job.steps, self._system)
        if not np.isfinite(history.contact_force).all():
            error = SolverError(
                f"linearised run at {3.6 * job.task.case.speed:g} km/h: the contact force is not finite, or"
                " did not settle in a step; look for stiffnesses far from usual values, or use a smaller time"
                " step"
            )
            job.task.failed(error)
            return True
        extremes = Extremes(*batch.tension_changes(slot), *batch.shortenings(slot))
        return job.task.finished(history, extremes, job.spent)
