"""Runs the cases, on one process or more."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from functools import lru_cache
from io import BytesIO
from multiprocessing import get_context
from typing import Any

from matplotlib.figure import Figure

from catenary_fe.layout import InputError
from validation.case import Checks, Outcome
from validation.cases import CASES
from validation.engines import ENGINES, on

Progress = Callable[[float], None]


def run_cases(
    names: Sequence[str] | None = None,
    *,
    quick: bool = False,
    jobs: int = 1,
    pictures: bool | None = None,
    progress: Progress | None = None,
) -> Checks:
    """Run cases and compare.

    names : of cases; unset: all, or in a quick run the quick ones
    quick : reduced variants, seconds each
    jobs : number of processes
    pictures : draw too; unset: unless quick
    progress : called with the share of the cases done, 0 to 1

    Raises InputError for a name that there is no case of.
    """
    draw = not quick if pictures is None else pictures
    return _run(_chosen(names, quick), quick, jobs, draw, False, progress)


def run_negative_controls(
    names: Sequence[str] | None = None,
    *,
    quick: bool = False,
    jobs: int = 1,
    progress: Progress | None = None,
) -> Checks:
    """Run each case's negative control, wrong on purpose: checks marked so must not pass."""
    return _run(_chosen(names, quick), quick, jobs, False, True, progress)


def run_case(name: str, quick: bool, draw: bool, negative_control: bool) -> Outcome:
    """Run one case, or its negative control."""
    case, checks = CASES[name], []
    engines = case.engines or ("",)
    for engine in engines:
        data = _computed(name, quick, engine)
        checks += case.checks(data, engine, negative_control=negative_control)
    data = _computed(name, quick, engines[0])
    if not draw:
        return Outcome(checks)
    figure = Figure(figsize=(8, 4.5), layout="constrained")
    case.draw(data, figure)
    picture = BytesIO()
    figure.savefig(picture, format="png", dpi=110, metadata={"Software": None})
    return Outcome(checks, picture.getvalue())


@lru_cache(maxsize=16)
def _computed(name: str, quick: bool, engine: str) -> Any:
    """A case and its negative control share what costs time."""
    with on(engine or ENGINES[0]):
        return CASES[name].compute(quick)


def _chosen(names: Sequence[str] | None, quick: bool) -> list[str]:
    if names is None:
        return [name for name, case in CASES.items() if case.quick or not quick]
    for name in names:
        if name not in CASES:
            raise InputError(f"validation case {name!r} is unknown; there are {', '.join(CASES)}")
    return list(dict.fromkeys(names))


def _run(
    names: list[str], quick: bool, jobs: int, draw: bool, negative_control: bool, progress: Progress | None
) -> Checks:
    outcomes: dict[str, Outcome] = {}
    for name, outcome in _outcomes(names, quick, jobs, draw, negative_control):
        outcomes[name] = outcome
        if progress:
            progress(len(outcomes) / len(names))
    checks = [check for name in names for check in outcomes[name].checks]
    return Checks(checks, {name: p for name in names if (p := outcomes[name].picture)})


def _outcomes(
    names: list[str], quick: bool, jobs: int, draw: bool, negative_control: bool
) -> Iterator[tuple[str, Outcome]]:
    if jobs == 1 or len(names) == 1:
        for name in names:
            yield name, run_case(name, quick, draw, negative_control)
        return
    # the longest cases are the last of the registry: begin with them
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        running = {
            pool.submit(run_case, name, quick, draw, negative_control): name for name in reversed(names)
        }
        for future in as_completed(running):
            yield running[future], future.result()
