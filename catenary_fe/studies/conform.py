"""What an assessor asks to see: that the program computes what it should here, and the runs of a line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.mesh import MeshSettings
from catenary_fe.layout import AnyPantograph, Catenary, Conditions, PowerSystem, library
from catenary_fe.results import Criterion, Elasticity, checks_in_words, criteria_in_words, judge
from catenary_fe.results.check import Check
from catenary_fe.results.quantities import FORCE, UPLIFT
from catenary_fe.statics import LineShape, Shape, find_form, settle
from catenary_fe.statics.elasticity import elasticity, solve_statics
from catenary_fe.studies.checks import run_margin, two_apart
from catenary_fe.studies.processes import manager_may_stumble, processes_of
from catenary_fe.studies.reference_models import PANTOGRAPH, RANGES, InRange, in_ranges, reference_line
from catenary_fe.studies.selfcheck import SelfCheck, selfcheck
from catenary_fe.studies.sweep import SweepCase, SweepSettings, run_sweep
from catenary_fe.studies.sweep_figures import key_figures_of
from catenary_fe.studies.sweep_store import Record

Progress = Callable[[float], None]
_MOVED, _HEIGHT = 0.1, 1.0  # [mm] of a line at rest that is solved again; of the wire from its design height
LINEARISED = "linearised"
_ALL_RANGES = sum(map(len, RANGES.values()))
_FIGURES = (*(FORCE[name] for name in ("mean", "std", "max", "min")), UPLIFT)


@dataclass(frozen=True, kw_only=True)
class Asked:
    """What is to be shown, and how.

    speeds_kmh : of runs of one and of two pantographs each
    distance : [m] of the two
    system : whose limits judge the runs
    """

    catenary: Catenary
    pantograph: AnyPantograph
    speeds_kmh: Sequence[float]
    distance: float
    system: PowerSystem
    conditions: Conditions | None = None
    time: TimeSettings = field(default_factory=TimeSettings)
    mesh: MeshSettings = field(default_factory=MeshSettings)

    def shape(self) -> Shape:
        """The line at rest, under the conditions. Raises SolverError where it does not hang."""
        shape = find_form(self.catenary, self.mesh)
        return settle(shape, self.conditions) if self.conditions else shape

    @property
    def cases(self) -> list[SweepCase]:
        """One and two pantographs at each speed; the rear one starts where one alone does."""
        starts = {1: (run_margin(self.catenary),), 2: two_apart(self.catenary, self.distance)}
        return [
            SweepCase(
                values={"speed_kmh": speed, "pantographs": count},
                catenary=self.catenary,
                pantographs=(self.pantograph,) * count,
                speed=speed / 3.6,
                positions=at,
                conditions=self.conditions,
            )
            for speed in self.speeds_kmh
            for count, at in starts.items()
        ]


@dataclass(frozen=True, kw_only=True)
class JudgedRun:
    """One of the runs asked for.

    summary : empty where it did not run
    file : of the whole run; empty likewise
    """

    speed_kmh: float
    pantographs: int
    summary: dict[str, Any] = field(default_factory=dict)
    criteria: Sequence[Criterion] = ()
    file: str = ""
    error: str = ""

    @property
    def name(self) -> str:
        """For folders and tables."""
        return f"{self.speed_kmh:g}_kmh_{'one' if self.pantographs == 1 else 'two'}"

    @property
    def title(self) -> str:
        """In words."""
        count = "one pantograph" if self.pantographs == 1 else "two pantographs"
        return f"{self.speed_kmh:g} km/h, {count}"

    @property
    def missed(self) -> list[Criterion]:
        """Criteria whose limit is not met."""
        return [row for row in self.criteria if row.passed is False]

    @property
    def used(self) -> float:
        """The largest share of a limit, of those that the run does not set itself."""
        return max((row.used or 0.0 for row in self.criteria if not row.tolerance), default=0.0)

    @property
    def figures(self) -> dict[str, float]:
        """By key, of the pantograph that governs."""
        governing = self.summary["governing_pantograph"]
        own = next(p for p in self.summary["pantographs"] if p["name"] == governing)
        return {q.key: float(own.get(q.key, self.summary.get(q.key))) for q in _FIGURES}


@dataclass(frozen=True, kw_only=True)
class Conformity:
    """All that was found.

    known : answers of this installation beside known ones
    ranges : the reference model's figures beside the standard's ranges
    reference : files of its runs, by speed
    static : checks of the line at rest; ``curve`` its elasticity
    refined : the run that uses most of a limit again: as it was, with halved elements, with halved steps, and
        linearised, by what was changed
    """

    asked: Asked
    known: Sequence[SelfCheck]
    ranges: Sequence[InRange]
    reference: dict[int, str]
    static: Sequence[Check]
    curve: Elasticity
    runs: Sequence[JudgedRun]
    refined: dict[str, JudgedRun]

    @property
    def moved(self) -> list[dict[str, Any]]:
        """Rows of a table: figures of the refined runs, and by how much they are off those of the first."""
        rows: list[dict[str, Any]] = []
        base = self.refined["as run"]
        for name, run in self.refined.items():
            if run.error or base.error:
                rows.append({"changed": name, "run": run.name, "error": run.error})
                continue
            off = {
                f"{key}_change_percent": 100 * (value / base.figures[key] - 1) if base.figures[key] else 0.0
                for key, value in run.figures.items()
            }
            missed = "; ".join(row.name for row in run.missed)
            rows.append(
                {"changed": name, "run": run.name} | run.figures | off | {"missed": missed, "error": ""}
            )
        return rows

    @property
    def verdict_stays(self) -> bool:
        """Whether halved elements and steps leave all verdicts on the line as they are."""
        finer = [run for name, run in self.refined.items() if name != LINEARISED]
        verdicts = {tuple(row.name for row in run.missed) for run in finer}
        return len(finer) > 1 and len(verdicts) == 1 and not any(run.error for run in finer)

    @property
    def verdicts(self) -> list[dict[str, Any]]:
        """Rows of a table: each part in words, whether it passed, and the file with its numbers."""
        good = [check.passed for check in self.known]
        inside = [row.passed for row in self.ranges]
        rows = [
            _verdict("known answers, here", f"{sum(good)} of {len(good)} met", all(good), "selfcheck.csv"),
            _verdict(
                "EN 50318:2002 reference model, here",
                f"{sum(inside)} of {_ALL_RANGES} figures in their ranges",
                sum(inside) == _ALL_RANGES,
                "reference.csv",
            ),
            _verdict(
                "line at rest",
                checks_in_words(self.static),
                all(check.passed for check in self.static),
                "static/static.json",
            ),
        ]
        for run in self.runs:
            said = f"did not run: {run.error}" if run.error else criteria_in_words(run.criteria)
            if failed := run.summary.get("checks_failed"):
                said += f"; checks of the run failed: {', '.join(failed)}"
            passed = not run.error and not run.missed
            file = "conform.json" if run.error else f"runs/{run.name}/summary.json"
            rows.append(_verdict(run.title, said, passed, file))
        said = "the same verdicts" if self.verdict_stays else "verdicts differ, or a run failed"
        rows.append(_verdict("elements halved, steps halved", said, self.verdict_stays, "refined.csv"))
        return rows

    def as_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        return {
            "line": self.asked.catenary.name,
            "criteria_system": self.asked.system,
            "verdicts": self.verdicts,
            "known_answers": [asdict(c) | {"error": c.error, "passed": bool(c.passed)} for c in self.known],
            "reference_model": [row.as_dict() for row in self.ranges],
            "static": [check.as_dict() for check in self.static],
            "elasticity_non_uniformity_percent": 100 * self.curve.non_uniformity,
            "runs": [
                {"run": run.name, "error": run.error, "criteria": [row.as_dict() for row in run.criteria]}
                for run in self.runs
            ],
            "refined": self.moved,
        }


def _verdict(part: str, said: str, passed: bool, file: str) -> dict[str, Any]:
    return {"part": part, "verdict": said, "passed": bool(passed), "file": file}


def conform(
    asked: Asked, shape: Shape, folder: str | Path, *, jobs: int = -1, progress: Progress | None = None
) -> Conformity:
    """Compute all of it; finished runs are kept in the folder, and not run again.

    shape : the line at rest, under the conditions asked for
    jobs : number of processes, -1: one a core
    progress : called with the share done, 0 to 1

    Raises InputError where the folder cannot be written.
    """

    def part(begin: float, end: float) -> Progress | None:
        return (lambda share: progress(begin + share * (end - begin))) if progress else None

    settings = SweepSettings(method="nonlinear", mesh=asked.mesh, time=asked.time, keep_runs=True)
    known = selfcheck(part(0.0, 0.1))
    own, reference = asked.cases, _reference_cases()
    usual = replace(settings, mesh=MeshSettings(), time=TimeSettings())
    found = _records(reference, usual, folder, jobs, part(0.1, 0.2))
    ranges = [
        row
        for case, record in zip(reference, found, strict=True)
        if "summary" in record
        for row in in_ranges(record["summary"], case.values["speed_kmh"])
    ]
    records = _records(own, settings, folder, jobs, part(0.2, 0.5))
    runs = [_judged(*both, asked.system) for both in zip(own, records, strict=True)]
    worst = max(range(len(runs)), key=lambda i: (not runs[i].error, runs[i].used))
    refined = _refined(asked, own[worst], runs[worst], settings, folder, jobs, part(0.5, 0.95))
    curve = elasticity(shape, progress=part(0.95, 1.0))
    return Conformity(
        asked=asked,
        known=known,
        ranges=ranges,
        reference={c.values["speed_kmh"]: r.get("run", "") for c, r in zip(reference, found, strict=True)},
        static=static_checks(shape),
        curve=curve,
        runs=runs,
        refined=refined,
    )


def _reference_cases() -> list[SweepCase]:
    line, head = reference_line(), library.pantograph(PANTOGRAPH)
    return [
        SweepCase(values={"speed_kmh": v}, catenary=line, pantographs=(head,), speed=v / 3.6) for v in RANGES
    ]


def _records(
    cases: Sequence[SweepCase], settings: SweepSettings, folder: str | Path, jobs: int,
    progress: Progress | None,
) -> list[Record]:  # fmt: skip
    told = (lambda done, all_: progress(done / all_)) if progress else None
    return run_sweep(cases, settings, folder, jobs=jobs, progress=told)


def _judged(case: SweepCase, record: Record, system: PowerSystem) -> JudgedRun:
    known = {"speed_kmh": case.values["speed_kmh"], "pantographs": len(case.pantographs)}
    if "error" in record:
        return JudgedRun(**known, error=record["error"])
    criteria = judge(key_figures_of(record, case), system)
    return JudgedRun(**known, summary=record["summary"], criteria=criteria, file=record["run"])


def _refined(
    asked: Asked, case: SweepCase, run: JudgedRun, settings: SweepSettings, folder: str | Path, jobs: int,
    progress: Progress | None,
) -> dict[str, JudgedRun]:  # fmt: skip
    """The same run on a finer mesh, with a finer step, and linearised, side by side."""
    from joblib import Parallel, delayed

    half = replace(asked.time, step=asked.time.step / 2)
    variants = {
        "elements halved": replace(settings, mesh=asked.mesh.halved()),
        "steps halved": replace(settings, time=half),
        LINEARISED: replace(settings, method="linearised"),
    }
    found = {"as run": run}
    if run.error:
        return found
    with processes_of(None), manager_may_stumble():
        tasks = [
            delayed(_records)([case], own, Path(folder, "refined", slug(name)), 1, None)
            for name, own in variants.items()
        ]
        records = Parallel(n_jobs=jobs, return_as="generator", batch_size=1, pre_dispatch="all")(tasks)
        for n, (name, (record,)) in enumerate(zip(variants, records, strict=True), start=1):
            found[name] = _judged(case, record, asked.system)
            if progress:
                progress(n / len(variants))
    return found


def slug(name: str) -> str:
    """What was changed, as a folder's name."""
    return name.replace(" ", "_")


def static_checks(shape: Shape) -> list[Check]:
    """Of a line at rest: that it is in balance, hangs on its droppers, and where its design wants it."""
    sections = shape.sections if isinstance(shape, LineShape) else (shape,)
    states = [solve_statics(section) for section in sections]
    moved = max(float(np.abs(state.contact_wire_uplift).max()) for state in states)
    slack = sum(int((state.dropper_forces <= 0).sum()) for state in states)
    found = [
        Check("equilibrium", 1e3 * moved, "mm", "at most", _MOVED,
              "motion of the contact wire when the line at rest is solved once more, with all its nonlinear"
              " forces"),
        Check("slack droppers at rest", slack, "", "at most", 0, "droppers that hold nothing; look at their"
              " lengths, and at the gradient of the wire"),
    ]  # fmt: skip
    catenary = shape.catenary
    as_designed = not (catenary.gives_dropper_lengths or catenary.departs_from_design or shape.settlement)
    if as_designed and shape.height_errors.size:
        error = 1e3 * float(np.abs(shape.height_errors).max())
        text = "largest distance of the contact wire from its design height at a dropper"
        found.append(Check("contact wire height", error, "mm", "at most", _HEIGHT, text))
    return found
