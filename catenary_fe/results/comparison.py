"""Runs side by side: their key figures, and the inputs that differ."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import listed
from catenary_fe.results.check import FAILED
from catenary_fe.results.quantities import (
    CHECKS_FAILED,
    FORCE,
    NON_UNIFORMITY,
    SLACK_DROPPERS,
    UPLIFT,
    Quantity,
    figure_rows,
)
from catenary_fe.results.run import Run
from catenary_fe.results.signal import FilterKind

COMPARED = (*FORCE.values(), UPLIFT, SLACK_DROPPERS, NON_UNIFORMITY, CHECKS_FAILED)
_LISTED = 12  # values by themselves


@dataclass(frozen=True)
class Column:
    """Key figures of one pantograph of one run.

    label : of the run, and of the pantograph where there are several
    values : by the keys of ``COMPARED``; None where a run does not hold it
    """

    label: str
    values: dict[str, float | None]


@dataclass(frozen=True)
class InputDifference:
    """One input that is not the same in all runs.

    name : in words, such as "catenary: contact wire: tension"
    values : one text a run
    """

    name: str
    values: tuple[str, ...]


def key_figures(runs: Sequence[Run], labels: Sequence[str], filter: FilterKind = "causal") -> list[Column]:
    """Key figures of all pantographs of all runs, over each run's evaluated spans.

    Raises InputError for fewer than two runs, and for partial ones that did not pass these spans.
    """
    if len(runs) < 2:
        raise InputError(f"{len(runs)} run to compare: give at least two")
    for run in runs:
        run.contact_force_statistics(filter=filter)
    columns = []
    for run, label in zip(runs, labels, strict=True):
        summary = run.summary(filter=filter)
        summary[CHECKS_FAILED.key] = len(run.failed_checks)
        pantographs = summary["pantographs"]
        for statistics in pantographs:
            values = {q.key: statistics.get(q.key, summary.get(q.key)) for q in COMPARED}
            columns.append(
                Column(f"{label}: {statistics['name']}" if len(pantographs) > 1 else label, values)
            )
    return columns


def figures_table(columns: Sequence[Column]) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Names of the columns, and rows of key figures; of two runs with their difference."""
    names = ("", *(column.label for column in columns))
    rows = figure_rows(COMPARED, [column.values for column in columns])
    if len(columns) == 2:
        names = (*names, "difference")
        for i, q in enumerate(COMPARED):
            rows[i] = (*rows[i], _change(q, *(column.values[q.key] for column in columns)))
    return names, [row for row in rows if set(row[1:]) != {"–"}]


def _change(quantity: Quantity, before: float | None, after: float | None) -> str:
    if before is None or after is None:
        return "–"
    return f"{round(after - before, quantity.digits) + 0.0:+.{quantity.digits}f}"


def failed_checks(runs: Sequence[Run], labels: Sequence[str]) -> list[str]:
    """One line for each check that a run fails."""
    return [
        f"{label}: {FAILED}{check}"
        for run, label in zip(runs, labels, strict=True)
        for check in run.checks
        if not check.passed
    ]


def input_differences(runs: Sequence[Run]) -> list[InputDifference]:
    """Inputs that differ, values of the same meaning (all droppers' positions, say) taken together."""
    found = [_inputs(run) for run in runs]
    names = dict.fromkeys(name for inputs in found for name in inputs)
    differences = []
    for name in names:
        values = [inputs.get(name, []) for inputs in found]
        texts = [_text(v) for v in values]
        for i, each in enumerate(values):
            if texts[i] == texts[0] and len(each) == len(values[0]) and each != values[0]:
                texts[i] += ", in other places"
        if len(set(texts)) > 1:
            differences.append(InputDifference(name, tuple(texts)))
    return differences


def _inputs(run: Run) -> dict[str, list[Any]]:
    attrs, values = run.data.attrs, defaultdict(list)
    record = {
        "speed (km/h)": round(3.6 * run.speed, 9),
        "method": run.method,
        "evaluated spans": listed(run.evaluated_spans),
        "start (m)": run.data["position"].values[:, 0].round(9).tolist(),
        "number of spans": len(run.catenary.spans),
        "number of droppers": len(run.catenary.droppers),
        "catenary": json.loads(attrs["catenary"]) | {"evaluated_spans": None},
        **{f"pantograph {i}": p for i, p in enumerate(json.loads(attrs["pantographs"]), start=1)},
        "settings": json.loads(attrs["settings"]),
        "version": json.loads(attrs["versions"]),
    }
    for name, value in _leaves(record, ""):
        values[name].append(value)
    return dict(values)


def _leaves(value: Any, name: str) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            text = key.replace("_", " ")
            yield from _leaves(inner, f"{name}: {text}" if name else text)
    elif isinstance(value, list):
        for inner in value:
            yield from _leaves(inner, name)
    elif not name.endswith(": source"):
        yield name, value


def _text(values: list[Any]) -> str:
    """The distinct values in order; of many, their number and range."""
    different = list(dict.fromkeys(v for v in values if v is not None))
    if not different:
        return "–"
    text = ", ".join(f"{v:g}" if isinstance(v, float) else str(v) for v in different[:_LISTED])
    if len(different) > _LISTED:
        numbers = [v for v in different if isinstance(v, int | float)]
        reach = f", {min(numbers):g} to {max(numbers):g}" if numbers else ""
        text = f"{len(different)} different values{reach}"
    return text
