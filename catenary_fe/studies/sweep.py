"""Sweeps: many runs, on all cores or an existing Dask cluster; finished cases are kept."""

from __future__ import annotations

import hashlib
import json
import logging
import os
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from dataclasses import asdict, dataclass, field, replace
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from catenary_fe.engines.arrays import SLOTS
from catenary_fe.engines.base import RunCase
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.joining import mesh_of
from catenary_fe.fe.mesh import MeshSettings
from catenary_fe.layout import AnyPantograph, Catenary, CatenaryError, Conditions, SolverError
from catenary_fe.layout.arguments import whole
from catenary_fe.results import Run
from catenary_fe.results.signal import FilterKind
from catenary_fe.statics import Shape, find_form, settle
from catenary_fe.studies.checks import plan_run
from catenary_fe.studies.linearised import LinearisedLine
from catenary_fe.studies.processes import deadly, manager_may_stumble, processes_of
from catenary_fe.studies.resources import Demand, check_memory, demand, workers_that_fit
from catenary_fe.studies.simulate import Method, simulate
from catenary_fe.studies.sweep_figures import force_along
from catenary_fe.studies.sweep_store import Record, Store, open_store

Progress = Callable[[int, int], None]
LOST = "lost"  # marks the record of a case that was killed: it is not kept
_log = logging.getLogger(__name__)
RESULTS = 3  # rises when the same inputs give other results: cases that were kept are then computed anew


@dataclass(frozen=True, kw_only=True)
class SweepSettings:
    """What all cases of a sweep have in common.

    keep_force : records have the filtered contact force along the evaluated spans, too, as ``force``
    keep_runs : the folder has each run whole, too: ``run`` of a record is the path of its file
    short : linearised runs end a span behind the last evaluated one
    """

    method: Method = "linearised"
    mesh: MeshSettings = field(default_factory=MeshSettings)
    time: TimeSettings = field(default_factory=TimeSettings)
    filter: FilterKind = "causal"
    keep_force: bool = False
    keep_runs: bool = False
    short: bool = False


@dataclass(frozen=True, kw_only=True)
class SweepCase:
    """One run of a sweep.

    values : what tells it from the others, by column of the table
    positions : [m] of the pantographs at the start, empty for one near the first support
    conditions : that the line is under, without further cases
    part_of : cases that the sweep has of this line, which it sets itself; see :meth:`LinearisedEngine.run`
    """

    values: dict[str, Any]
    catenary: Catenary
    pantographs: tuple[AnyPantograph, ...]
    speed: float
    positions: tuple[float, ...] = ()
    conditions: Conditions | None = None
    part_of: int | None = None

    def key(self, settings: SweepSettings) -> str:
        """A name that is the same only for the same inputs."""
        inputs = [
            self.catenary.model_dump_json(),
            *(p.model_dump_json() for p in self.pantographs),
            repr((self.speed, self.positions)),
            json.dumps(asdict(settings), sort_keys=True),
            version("catenary_fe"),
            str(RESULTS),
            *([self.conditions.model_dump_json()] if self.conditions else []),
        ]
        return hashlib.sha256("\n".join(inputs).encode()).hexdigest()[:20]


@dataclass(frozen=True, kw_only=True)
class BrokenCase:
    """A run that cannot be described: its values break a rule."""

    values: dict[str, Any]
    error: CatenaryError


def run_sweep(
    cases: Sequence[SweepCase | BrokenCase],
    settings: SweepSettings,
    folder: str | Path,
    *,
    jobs: int = -1,
    scheduler: str | None = None,
    retry: bool = False,
    progress: Progress | None = None,
) -> list[Record]:
    """Run all cases that the folder does not hold yet; one record a case, in the order of the cases.

    A record has ``values``, and either ``summary`` (see :meth:`Run.summary`) or ``error``. Each is written
    into ``folder/cases`` as soon as it is there: a sweep that was stopped goes on from where it was.

    jobs : number of processes, -1: one a core, fewer where the memory has no room for so many
    scheduler : address of a Dask cluster to run on instead
    retry : run cases again that failed
    progress : called with the numbers of cases done and of all cases

    A case whose worker process is killed is tried again; where that happens also when it runs alone, its
    record says ``error`` and ``lost``, and it is tried again at the next start.

    Raises InputError if the folder cannot be written, another process writes there, the memory has no room,
    or the cluster is not there.
    """
    with open_store(Path(folder) / "cases") as store:
        records = [
            _failed(case.error) if isinstance(case, BrokenCase) else _kept(store, case, settings, retry)
            for case in cases
        ]
        missing = [i for i, record in enumerate(records) if record is None]
        done = len(cases) - len(missing)
        if done:
            _log.info("%d of %d cases are there already", done, len(cases))
        whole_lines = {i: case for i, case in enumerate(cases) if isinstance(case, SweepCase)}
        sizes = {i: len(group) for group in _by_line(whole_lines) for i in group}
        to_run = {i: replace(whole_lines[i], part_of=sizes[i]) for i in missing}
        workers = (os.cpu_count() or 1) if jobs == -1 else whole("jobs", jobs, least=1)
        if to_run and not scheduler:
            needs = _largest_demand(list(to_run.values()), settings)
            workers = workers_that_fit(needs, workers) if jobs <= 0 else workers
            check_memory(needs, "sweep", workers)
        tasks = _tasks(to_run, settings, workers)
        with closing(_spread(tasks, to_run, settings, workers, scheduler)) as finished:
            for numbers, found in finished:
                for i, record in zip(numbers, found, strict=True):
                    key = to_run[i].key(settings)
                    run = record.pop("run", None)
                    if LOST not in record:
                        store.write(key, record, run)
                    records[i] = record | ({"run": str(store.run(key))} if run else {})
                done += len(numbers)
                if progress:
                    progress(done, len(cases))
        return [
            record | {"values": case.values} for case, record in zip(cases, records, strict=True) if record
        ]


def _kept(store: Store, case: SweepCase, settings: SweepSettings, retry: bool) -> Record | None:
    """The record of a case that is finished; of one that failed only if it shall not be tried again."""
    key = case.key(settings)
    record = store.read(key)
    if record is None or ("summary" in record) == ("error" in record):
        return None
    if "error" in record:
        return None if retry else record
    if not settings.keep_runs:
        return record
    return record | {"run": str(store.run(key))} if store.run(key).is_file() else None


def _largest_demand(cases: Sequence[SweepCase], settings: SweepSettings) -> Demand:
    """Of a process at its largest: the longest line at the lowest speed, in all slots."""
    longest = max(cases, key=lambda case: case.catenary.length)
    most = max(cases, key=lambda case: len(case.pantographs))
    speed = min(case.speed for case in cases)
    steps = int(longest.catenary.length / (speed * settings.time.step)) if speed > 0 else 0
    slots = min(SLOTS, len(cases)) if settings.method == "linearised" else 1
    mesh = mesh_of(longest.catenary, settings.mesh)
    return demand(longest.catenary, mesh, most.pantographs, steps, 0, settings.method, slots)


def _by_line(cases: Mapping[int, SweepCase]) -> list[list[int]]:
    groups: dict[tuple[Catenary, Conditions | None], list[int]] = {}
    for i, case in cases.items():
        groups.setdefault((case.catenary, case.conditions), []).append(i)
    return list(groups.values())


def _tasks(cases: Mapping[int, SweepCase], settings: SweepSettings, workers: int) -> list[list[int]]:
    """Numbers of cases to run together: of one line, of similar length, no more than fill the slots."""
    if settings.method != "linearised":
        return [[i] for i in cases]
    groups, tasks = _by_line(cases), []
    for group in groups:
        group.sort(key=lambda i: cases[i].speed)
        parts = max(int(np.ceil(len(group) / SLOTS)), min(workers // len(groups), len(group)))
        tasks += [part.tolist() for part in np.array_split(group, parts)]
    return tasks


def _spread(
    tasks: Sequence[list[int]],
    cases: Mapping[int, SweepCase],
    settings: SweepSettings,
    workers: int,
    scheduler: str | None,
) -> Generator[tuple[list[int], list[Record]], None, None]:
    """Results of the tasks as they come.

    Where a worker process dies, what is not finished is tried again; where more of them die, with half as
    many at a time. A case whose process dies while it runs alone is recorded as lost.
    """
    left, deaths = [list(task) for task in tasks], 0
    while left:
        alone = deaths > 0 and workers == 1
        batch = left[:1] if alone else list(left)
        processes = max(2, workers) if deaths else min(workers, len(batch))  # one: in this process
        try:
            with closing(_in_parallel(batch, cases, settings, processes, scheduler)) as finished:
                for numbers, found in finished:
                    left.remove(numbers)
                    yield numbers, found
        except deadly(scheduler):
            deaths += 1
            _log.warning("a worker process died; what it was at is tried again")
            if not alone:
                workers = workers if deaths == 1 and workers > 1 else max(1, workers // 2)
            elif len(batch[0]) > 1:
                left[:1] = [[number] for number in batch[0]]
            else:
                yield left.pop(0), [_lost()]


def _in_parallel(
    tasks: Sequence[list[int]],
    cases: Mapping[int, SweepCase],
    settings: SweepSettings,
    processes: int,
    scheduler: str | None,
) -> Generator[tuple[list[int], list[Record]], None, None]:
    from joblib import Parallel, delayed

    with processes_of(scheduler), manager_may_stumble():
        parallel = Parallel(
            n_jobs=-1 if scheduler else processes,
            return_as="generator_unordered",
            batch_size=1,
            pre_dispatch="all",
        )
        yield from parallel(delayed(_run_task)(task, [cases[i] for i in task], settings) for task in tasks)


def _lost() -> Record:
    error = SolverError(
        "the process that ran this case was killed, also when it ran alone, perhaps for lack of memory; start"
        " the sweep again to try once more, on a larger machine or with a shorter line"
    )
    return _failed(error) | {LOST: True}


def _run_task(
    numbers: list[int], cases: Sequence[SweepCase], settings: SweepSettings
) -> tuple[list[int], list[Record]]:
    """Run cases of one line; what fails is recorded, not raised."""
    try:
        with _without_warnings():
            if settings.method == "linearised":
                return numbers, _run_together(cases, settings)
            return numbers, [_run_alone(case, settings) for case in cases]
    except CatenaryError as error:
        return numbers, [_failed(error)] * len(numbers)
    except Exception as error:  # one broken case must not stop the others
        text = f"unexpected {type(error).__name__}: {error}; please report it"
        return numbers, [_failed(SolverError(text))] * len(numbers)


@contextmanager
def _without_warnings() -> Iterator[None]:
    """They are in the records."""
    logger = logging.getLogger("catenary_fe")
    before = logger.level
    logger.setLevel(logging.ERROR)
    try:
        yield
    finally:
        logger.setLevel(before)


def _run_together(cases: Sequence[SweepCase], settings: SweepSettings) -> list[Record]:
    line = _linearised(cases[0].catenary, settings.mesh, cases[0].conditions, settings.time)
    records: list[Record] = []
    good: list[RunCase] = []
    for case in cases:
        try:
            positions = case.positions or None
            own = line.shape, case.pantographs, case.speed, positions, settings.time
            good.append(plan_run(*own, short=settings.short))
            records.append({})
        except CatenaryError as error:
            records.append(_failed(error))
    results = iter(line.run(good, part_of=cases[0].part_of))
    return [record or _record(next(results), settings) for record in records]


def _run_alone(case: SweepCase, settings: SweepSettings) -> Record:
    try:
        shape = _settled(case.catenary, settings.mesh, case.conditions)
        run = simulate(
            shape,
            case.pantographs,
            speed=case.speed,
            positions=case.positions or None,
            time=settings.time,
            method=settings.method,
        )
    except CatenaryError as error:
        return _failed(error)
    return _record(run, settings)


def _record(result: Run | CatenaryError, settings: SweepSettings) -> Record:
    if isinstance(result, CatenaryError):
        return _failed(result)
    summary = result.summary(filter=settings.filter)
    for key in ("wall_s", "real_time_factor"):
        del summary[key]  # a table is the same whenever and wherever it was computed
    for i, pantograph in enumerate(summary["pantographs"]):
        pantograph["uplift_force_N"] = float(result.data["uplift_force"].values[i])
    return (
        {"summary": summary}
        | ({"force": force_along(result, settings.filter)} if settings.keep_force else {})
        | ({"run": _bytes(result)} if settings.keep_runs else {})
    )


def _bytes(run: Run) -> bytes:
    """The run's file: a process on another machine has no folder in common with this one."""
    with TemporaryDirectory() as folder:
        return run.save(Path(folder) / "run.nc").read_bytes()


def _failed(error: CatenaryError) -> Record:
    return {"error": str(error), "exit_code": error.exit_code}


@lru_cache(maxsize=2)
def _shape(catenary: Catenary, mesh: MeshSettings) -> Shape:
    return find_form(catenary, mesh)


@lru_cache(maxsize=2)
def _settled(catenary: Catenary, mesh: MeshSettings, conditions: Conditions | None) -> Shape:
    shape = _shape(catenary, mesh)
    return settle(shape, conditions) if conditions else shape


@lru_cache(maxsize=2)
def _linearised(
    catenary: Catenary, mesh: MeshSettings, conditions: Conditions | None, time: TimeSettings
) -> LinearisedLine:
    return LinearisedLine(_settled(catenary, mesh, conditions), time)
