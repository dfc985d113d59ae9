"""Searches for the best design, from where the files are or everywhere between the bounds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import checked, one_of, whole
from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.studies.design import DesignProblem, Evaluation

Floats = NDArray[np.float64]
Search = Literal["local", "global"]


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class Optimum:
    """What a search found.

    problem : what was asked
    history : all designs in the order in which they were evaluated
    best : the best one that meets all criteria, or where none does the one that misses them by least
    confirmed : start and best by nonlinear runs; empty where not asked for
    fresh : the best one with samples that the search has not seen; None where nothing scatters
    """

    problem: DesignProblem
    history: Sequence[Evaluation]
    best: Evaluation
    confirmed: Sequence[Evaluation] = field(default_factory=tuple)
    fresh: Evaluation | None = None

    @property
    def start(self) -> Evaluation:
        """The design that the search began with."""
        return self.history[0]

    def as_dict(self) -> dict[str, Any]:
        """Ready for JSON; without single cases of the history."""
        study = self.problem.study
        return {
            "name": study.name,
            "figure": study.objective.figure,
            "over": study.objective.over,
            "criteria_system": study.criteria,
            "evaluations": len(self.history),
            "variables": [
                {"place": name, "start": a, "best": b}
                for name, a, b in zip(
                    self.problem.names, self.start.x.tolist(), self.best.x.tolist(), strict=True
                )
            ],
            "values": dict(self.best.values),
            "start": _shown(self.start),
            "best": _shown(self.best),
            "nonlinear": {k: _shown(e) for k, e in zip(("start", "best"), self.confirmed, strict=False)},
            "fresh_samples": _shown(self.fresh) if self.fresh else None,
        }


def _shown(e: Evaluation) -> dict[str, Any]:
    used = None if not np.isfinite(e.used) else e.used
    objective = None if np.isnan(e.objective) else e.objective
    return {
        "objective": objective, "largest_share_of_limit": used, "error": e.error, "cases": list(e.cases),
    }  # fmt: skip


@checked
def optimise(
    problem: DesignProblem,
    *,
    search: Search = "local",
    most: int = 60,
    confirm: bool = True,
    fresh: int = 32,
    progress: Callable[[float], None] | None = None,
) -> Optimum:
    """Look for the best design.

    search : "local", from the files' own values (COBYQA, Ragonneau 2022), or "global" (differential
        evolution, Storn and Price 1997), which takes whole numbers, too, and some hundred evaluations
    most : evaluations
    confirm : run start and best by the nonlinear method in the end
    fresh : samples in the end that the search has not seen, where something scatters
    progress : called with the share of the evaluations done, 0 to 1

    The same study takes the same way; a search that was stopped goes on where it was, as its runs are kept.
    """
    one_of("search", search, get_args(Search))
    whole("most", most, least=2)
    whole("fresh", fresh, least=0)
    history: list[Evaluation] = []

    def seen(designs: Sequence[Floats]) -> list[Evaluation]:
        done = len(history)

        def share(part: float) -> None:
            if progress:
                progress(min(1.0, (done + part * len(designs)) / most))

        found = problem.evaluate_all(designs, progress=share)
        history.extend(found)
        return found

    first = seen([problem.start])[0]
    if first.error:
        raise InputError(f"design: the files' own values cannot be run: {first.error}")
    look = {"local": _local, "global": _global}[search]
    look(problem, seen, first, most - 1)
    best = min(history, key=_rank)
    confirmed = problem.evaluate_all([first.x, best.x], method="nonlinear", samples=0) if confirm else []
    new = None
    if problem.study.scatter and fresh:
        new = problem.evaluate(best.x, samples=fresh, seed=problem.study.seed + 1)
    return Optimum(problem=problem, history=history, best=best, confirmed=confirmed, fresh=new)


def _rank(e: Evaluation) -> tuple[float, float]:
    """The smaller, the better: designs that meet all criteria first."""
    if e.error:
        return np.inf, np.inf
    return (0.0, e.objective) if e.used <= 1 else (e.used, e.objective)


Seen = Callable[[Sequence[Floats]], list[Evaluation]]


def _local(problem: DesignProblem, seen: Seen, first: Evaluation, most: int) -> None:
    from scipy.optimize import Bounds, NonlinearConstraint, minimize

    if problem.are_whole.any():
        name = problem.names[int(np.argmax(problem.are_whole))]
        raise InputError(f"design: {name}: whole numbers are found by the global search alone")
    low, high = problem.bounds.T
    known: dict[bytes, Evaluation] = {_unit(first.x, low, high).tobytes(): first}

    def at(u: Floats) -> Evaluation:
        if u.tobytes() not in known:
            known[u.tobytes()] = seen([low + np.clip(u, 0.0, 1.0) * (high - low)])[0]
        return known[u.tobytes()]

    scale = abs(first.objective) or 1.0
    limits = NonlinearConstraint(lambda u: _finite(at(u).used) - 1.0, -np.inf, 0.0)
    minimize(
        lambda u: at(u).objective / scale,
        _unit(first.x, low, high),
        method="COBYQA",
        bounds=Bounds(np.zeros(low.size), np.ones(low.size)),
        constraints=[limits] if problem.study.criteria else [],
        options={"maxfev": most, "initial_tr_radius": 0.2, "final_tr_radius": 2e-3},
    )


def _unit(x: Floats, low: Floats, high: Floats) -> Floats:
    return (x - low) / (high - low)


def _finite(used: float) -> float:
    """Of a design that cannot be run, or has no margin at all, a large share."""
    return min(used, 10.0)


_EACH = 6  # designs of a generation for each variable
_FEWEST, _GENERATIONS = 12, 5


def _global(problem: DesignProblem, seen: Seen, first: Evaluation, most: int) -> None:
    from scipy.optimize import differential_evolution

    size = problem.start.size
    people = max(_FEWEST, min(_EACH * size, most // _GENERATIONS))
    low, high = problem.bounds.T
    order = abs(first.objective) or 1.0

    def cost(x: Floats) -> Any:
        """The objective, or beyond all objectives what is missed."""
        found = seen([*np.atleast_2d(x.T)])
        worth = [e.objective if e.is_good else 1e3 * order * _finite(e.used) for e in found]
        return np.array(worth) if x.ndim > 1 else worth[0]

    rng = np.random.default_rng(problem.study.seed)
    begin = low + (high - low) * rng.random((people, size))
    begin[0] = first.x
    differential_evolution(
        cost,
        list(zip(low, high, strict=True)),
        init=begin,
        maxiter=max(1, most // people - 1),
        integrality=problem.are_whole,
        rng=rng,
        polish=False,
        vectorized=True,
        updating="deferred",
        tol=1e-3,
    )
