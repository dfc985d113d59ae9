"""Designs: which values of a line, its pantographs and conditions make a figure of the run the best one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.mesh import MeshSettings
from catenary_fe.layout import Catenary, DesignVariable, InputError, Study, counted
from catenary_fe.layout.arguments import checked, numbers, whole
from catenary_fe.layout.members import Members, members_of_line, members_of_pantograph
from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.layout.variation import PANTOGRAPH, Variable, kind_of
from catenary_fe.results import Criterion, judge
from catenary_fe.studies.sampling import unit_cube
from catenary_fe.studies.scatter_cases import Case, Plan
from catenary_fe.studies.simulate import Method
from catenary_fe.studies.sweep import SweepCase, SweepSettings, run_sweep
from catenary_fe.studies.sweep_figures import key_figures_of
from catenary_fe.studies.sweep_store import Record

Floats = NDArray[np.float64]
Row = dict[str, Any]
_MISSED = 1 + 1e-9  # the least share of a limit that is missed
_FROM_BELOW = ("min_N", "statistical_min_N")  # the larger, the better


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class Evaluation:
    """What a design is worth.

    x : shape (variables,), values in their own units
    values : by place of layout, pantograph and conditions
    objective : to be made small; of minima the negative value. Not a number where no line can be made of it
    used : largest share of a criterion's limit that a case uses, 1 at the limit; 0 without criteria
    cases : one a speed, pantograph and sample (0: as drawn): its figure, what it uses and misses
    error : why it cannot be run, or nothing
    """

    x: Floats
    values: Mapping[str, Any]
    objective: float
    used: float
    cases: Sequence[Row]
    error: str = ""

    @property
    def is_good(self) -> bool:
        """Whether it can be run, and meets all criteria."""
        return not self.error and self.used <= 1


@dataclass(frozen=True)
class _Place:
    """A variable of the study: its members in the layout, the conditions or each pantograph."""

    name: str
    variable: DesignVariable
    members: Members
    lengths: tuple[float, ...] = ()  # [m] of spans, of numbers of droppers

    @property
    def size(self) -> int:
        return len(self.members.nominal) if self.variable.apart else 1

    @property
    def start(self) -> list[float]:
        """Nominal values, moved to within the bounds."""
        nominal = [
            len(v) if self.variable.evenly and isinstance(v, list) else v for v in self.members.nominal
        ]
        for value in nominal:
            if isinstance(value, bool) or not isinstance(value, int | float):
                raise InputError(f"design: {self.name}: is {value!r} in the layout; write a number there")
        own = [float(v) for v in nominal] if self.variable.apart else [float(np.mean(nominal))]
        low, high = self.variable.between
        moved = np.clip(own, low, high)
        return [float(v) for v in (np.round(moved) if self.variable.is_whole else moved)]

    def changes(self, x: Floats) -> dict[str, Any]:
        """Values by the places of the members."""
        drawn = np.broadcast_to(x, len(self.members.nominal)).tolist()
        if self.variable.is_whole:
            drawn = [round(value) for value in drawn]
        if self.variable.evenly is not None:
            edge = self.variable.evenly
            drawn = [_evenly(int(n), length, edge) for n, length in zip(drawn, self.lengths, strict=True)]
        return self.members.changes(drawn)


def _evenly(count: int, length: float, edge: float) -> list[float]:
    """[m] of so many droppers in a span."""
    places = np.linspace(edge, length - edge, count) if count > 1 else np.array([length / 2])
    return [float(f"{x:.6g}") for x in places]


class DesignProblem:
    """What a study asks to be designed: variables, bounds, and what a design is worth.

    study : with ``design``; its objective is made small, its criteria are met
    folder : where runs are kept, in ``cases``: what was run once is not run again
    jobs : number of processes, -1: one a core

    Raises InputError for places that do not exist, and where nothing is to be designed.
    """

    @checked
    def __init__(
        self,
        study: Study,
        *,
        folder: str | Path,
        jobs: int = -1,
        time: TimeSettings | None = None,
        mesh: MeshSettings | None = None,
    ) -> None:
        if not study.design:
            raise InputError(
                "design: nothing is to be designed; write places and bounds into the study's [design], such"
                ' as "contact_wire.tension" = { between = [15e3, 27e3] }'
            )
        if study.objective.samples and not study.scatter:
            raise InputError("objective: samples = 0 is all there is where nothing scatters; add [scatter]")
        if both := [p for p in study.design if kind_of(p) == PANTOGRAPH and p in study.scatter]:
            raise InputError(f"design: {both[0]}: a place of a pantograph is designed or scatters, not both")
        self.study, self._folder, self._jobs = study, folder, jobs
        self._settings = SweepSettings(time=time or TimeSettings(), mesh=mesh or MeshSettings(), short=True)
        self._variable = Variable(study.layout, study.conditions)
        self._variable.catenary({})  # its faults come before those of places
        self._places = [self._place(name, variable) for name, variable in study.design.items()]

    def _place(self, name: str, variable: DesignVariable) -> _Place:
        if kind_of(name) == PANTOGRAPH:
            own = members_of_pantograph(self.study.pantographs[0], name.removeprefix(PANTOGRAPH))
            places = tuple(f"{PANTOGRAPH}{place}" for place in own.places)
            return _Place(name, variable, Members(name, places, own.nominal))
        members = members_of_line(self._variable, name, together=not variable.apart)
        if variable.evenly is None:
            return _Place(name, variable, members)
        steps = [place.split(".") for place in members.places]
        if any(len(s) != 3 or s[0] != "span" or s[2] != "droppers" for s in steps):
            raise InputError(
                f"design: {name}: evenly is of droppers, span.*.droppers; leave it out elsewhere"
            )
        spans = self._variable.record["span"]
        return _Place(name, variable, members, tuple(float(spans[int(s[1]) - 1]["length"]) for s in steps))

    @property
    def names(self) -> list[str]:
        """Of the variables; those of members apart are numbered from 1."""
        return [
            f"{place.name} {n}" if place.size > 1 else place.name
            for place in self._places
            for n in range(1, place.size + 1)
        ]

    @property
    def bounds(self) -> Floats:
        """Shape (variables, 2)."""
        return np.array([place.variable.between for place in self._places for _ in range(place.size)])

    @property
    def are_whole(self) -> NDArray[np.bool_]:
        """Shape (variables,): which of them are whole numbers."""
        return np.array([place.variable.is_whole for place in self._places for _ in range(place.size)])

    @cached_property
    def start(self) -> Floats:
        """Shape (variables,): the files' own values, moved to within the bounds."""
        return np.array([value for place in self._places for value in place.start])

    def values(self, x: Sequence[float] | Floats) -> dict[str, Any]:
        """Values by place, of variables of shape (variables,). Raises InputError for another shape."""
        x = numbers("x", x)
        if x.shape != self.start.shape:
            raise InputError(f"x: {counted(x.size, 'value')} for {counted(self.start.size, 'variable')}")
        found: dict[str, Any] = {}
        at = 0
        for place in self._places:
            found |= place.changes(x[at : at + place.size])
            at += place.size
        return {name: _rounded(value) for name, value in found.items()}

    def line(self, x: Sequence[float] | Floats) -> Catenary:
        """The line with these values. Raises InputError where they break a rule."""
        made = self._variable.catenary(self.values(x))
        spans = self.study.evaluated_spans
        return made if spans is None else made.replace(evaluated_spans=spans)

    def evaluate(
        self, x: Sequence[float] | Floats, *, method: Method = "linearised", samples: int | None = None,
        seed: int | None = None,
    ) -> Evaluation:  # fmt: skip
        """What a design is worth, from runs at all speeds; other optimisers may be given it.

        x : shape (variables,), in the units of the places
        samples : of what scatters; unset: those of the objective
        seed : of them; unset: the study's
        """
        return self.evaluate_all([x], method=method, samples=samples, seed=seed)[0]

    def evaluate_all(
        self, designs: Sequence[Sequence[float] | Floats], *, method: Method = "linearised",
        samples: int | None = None, seed: int | None = None, progress: Callable[[float], None] | None = None,
    ) -> list[Evaluation]:  # fmt: skip
        """As :meth:`evaluate`, several designs on all cores.

        progress : called with the share of the runs done, 0 to 1
        """
        count = self.study.objective.samples if samples is None else whole("samples", samples, least=0)
        seed = self.study.seed if seed is None else whole("seed", seed, least=0)
        plans = [self._cases(np.asarray(x, dtype=float), count, seed) for x in designs]
        cases = [case for plan in plans if not isinstance(plan, InputError) for case in plan]
        settings = replace(self._settings, method=method)
        records: Iterator[Record] = iter(())
        if cases:
            told = (lambda done, all_: progress(done / all_)) if progress else None
            records = iter(run_sweep(cases, settings, self._folder, jobs=self._jobs, progress=told))
        found = []
        for x, plan in zip(designs, plans, strict=True):
            x, own = np.asarray(x, dtype=float), [] if isinstance(plan, InputError) else plan
            error = str(plan) if isinstance(plan, InputError) else ""
            found.append(self._worth(x, own, [next(records) for _ in own], error))
        return found

    def _cases(self, x: Floats, samples: int, seed: int) -> list[Case] | InputError:
        values = self.values(x)
        heads = {place: value for place, value in values.items() if kind_of(place) == PANTOGRAPH}
        try:
            plan = Plan(self.study, self._variable.changed(values), heads)
            scattered = (
                plan.cases(unit_cube("latin-hypercube", samples, plan.dimension, seed)) if samples else []
            )
        except InputError as error:
            return error
        return [*plan.nominal(), *scattered]

    def _worth(self, x: Floats, cases: Sequence[Case], records: Sequence[Record], error: str) -> Evaluation:
        figure, over = self.study.objective.figure, self.study.objective.over
        rows, values = [], self.values(x)
        for case, record in zip(cases, records, strict=True):
            if "error" in record or not isinstance(case, SweepCase):
                error = error or record["error"]
                continue
            rows += _case_rows(case, record, figure, self.study.criteria)
        if error:
            return Evaluation(x=x, values=values, objective=np.nan, used=np.inf, cases=rows, error=error)
        worth = [(-1 if figure in _FROM_BELOW else 1) * row[figure] for row in rows]
        return Evaluation(
            x=x,
            values=values,
            objective=float(max(worth) if over == "worst" else np.mean(worth)),
            used=max(row["used"] for row in rows),
            cases=rows,
        )


def _rounded(value: Any) -> Any:
    """Twelve digits: the same design has the same runs."""
    return float(f"{value:.12g}") if isinstance(value, float) else value


def _used(row: Criterion) -> float:
    """Share of a limit, above 1 where it is missed, and only there; none of what the run itself sets."""
    used = float(row.used or 0.0)
    if row.passed is False:
        return max(used, _MISSED)
    return 0.0 if row.tolerance else min(used, 1.0)


def _case_rows(case: SweepCase, record: Record, figure: str, system: Any) -> list[Row]:
    """One row a pantograph."""
    summary, known = record["summary"], {k: case.values[k] for k in ("sample", "speed_kmh", "pantograph")}
    judged = [r for r in judge(key_figures_of(record, case), system) if r.used is not None] if system else []
    return [
        known
        | {
            "number": number,
            figure: float(own.get(figure, summary.get(figure))),
            "used": max(map(_used, judged), default=0.0),
            "missed": "; ".join(r.name for r in judged if r.passed is False),
        }
        for number, own in enumerate(summary["pantographs"], start=1)
    ]
