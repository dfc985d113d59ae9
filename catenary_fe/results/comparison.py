"""Runs side by side: their key figures, and what went into them differently."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

from catenary_fe.layout import InputError
from catenary_fe.results.check import FAILED
from catenary_fe.results.run import Run
from catenary_fe.results.signal import FilterKind

QUANTITIES = {
    "mean_N": "mean force (N)",
    "std_N": "standard deviation (N)",
    "std_0_5_Hz_N": "of which 0 to 5 Hz (N)",
    "std_5_20_Hz_N": "of which 5 to 20 Hz (N)",
    "statistical_max_N": "statistical maximum (N)",
    "statistical_min_N": "statistical minimum (N)",
    "max_N": "actual maximum (N)",
    "min_N": "actual minimum (N)",
    "contact_loss_percent": "contact loss, however short (% of the time)",
    "contact_loss_over_5_ms_percent": "contact loss over 5 ms (% of the time)",
    "losses_over_5_ms": "number of losses over 5 ms",
    "longest_loss_ms": "longest loss (ms)",
    "contact_point_range_mm": "range of the contact point (mm)",
    "max_support_uplift_mm": "largest uplift at a support (mm)",
    "slack_droppers": "droppers that went slack",
    "elasticity_non_uniformity_percent": "non-uniformity of the elasticity (%)",
    "checks_failed": "checks failed",
}
_LISTED = 12  # values by themselves


@dataclass(frozen=True)
class Column:
    """Key figures of one pantograph of one run.

    label : of the run, and of the pantograph where there are several
    values : by the keys of ``QUANTITIES``; None where a run does not hold it
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
        summary["checks_failed"] = len(run.failed_checks)
        pantographs = summary["pantographs"]
        for statistics in pantographs:
            values = {key: statistics.get(key, summary.get(key)) for key in QUANTITIES}
            columns.append(
                Column(f"{label}: {statistics['name']}" if len(pantographs) > 1 else label, values)
            )
    return columns


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
        "evaluated spans": ", ".join(map(str, run.evaluated_spans)),
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
    """The different values in their order; many of them by how many they are and how far they reach."""
    different = list(dict.fromkeys(v for v in values if v is not None))
    if not different:
        return "–"
    text = ", ".join(f"{v:g}" if isinstance(v, float) else str(v) for v in different[:_LISTED])
    if len(different) > _LISTED:
        numbers = [v for v in different if isinstance(v, int | float)]
        reach = f", {min(numbers):g} to {max(numbers):g}" if numbers else ""
        text = f"{len(different)} different values{reach}"
    return text
