"""What commands that judge a run have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from catenary_fe.cli.terminal import print_table, progress_bar
from catenary_fe.system import Catenary, PowerSystem

if TYPE_CHECKING:
    from catenary_fe.equilibrium import Shape
    from catenary_fe.results import Criterion, Run


def judged(shape: Shape, result: Run, system: PowerSystem, filter_kind: Any, quiet: bool) -> list[Criterion]:
    """Rows of a run, with the elasticity of the spans that it is evaluated over."""
    from catenary_fe.analysis import elasticity
    from catenary_fe.results import criteria_rows

    with progress_bar("elasticity", not quiet) as progress:
        curve = elasticity(shape, spans=_kinds_of_spans(shape.catenary), progress=progress)
    return criteria_rows(result, system, non_uniformity=curve.non_uniformity, filter=filter_kind)


def _kinds_of_spans(catenary: Catenary) -> list[int]:
    """One evaluated span of each kind, with its supports: equal ones have the same elasticity."""
    kinds: list[Any] = []
    numbers = []
    for n in catenary.spans_to_evaluate:
        kind = (catenary.spans[n - 1], catenary.supports[n - 1 : n + 1])
        if kind not in kinds:
            kinds.append(kind)
            numbers.append(n)
    return numbers


def print_criteria(system: PowerSystem, rows: Sequence[Criterion]) -> None:
    """A table of all criteria."""
    from catenary_fe.results import labels

    table = [
        (label, row.value_text, row.limit_text, row.verdict, row.source)
        for label, row in zip(labels(rows), rows, strict=True)
    ]
    print_table(
        f"criteria, {system}", ("criterion", "value", "limit", "verdict", "source of the limit"), table
    )


def exit_code(rows: Sequence[Criterion]) -> int:
    """1 where a criterion is missed, which is said on standard error; else 0."""
    from catenary_fe.results import labels, missed

    misses = missed(rows)
    for row, label in zip(rows, labels(rows), strict=True):
        if row in misses:
            click.echo(f"missed: {label}: {row.value_text}, must be {row.limit_text}", err=True)
    return 1 if misses else 0
