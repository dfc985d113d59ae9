"""What commands that judge a run have in common."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import click

from catenary_fe.cli.folder import read_record
from catenary_fe.cli.terminal import print_table, progress_bar
from catenary_fe.layout import PowerSystem
from catenary_fe.results.signal import FilterKind

if TYPE_CHECKING:
    from catenary_fe.results import Criterion, Run
    from catenary_fe.statics import Shape

filter_option = click.option(
    "--filter",
    "filter_kind",
    type=click.Choice(get_args(FilterKind)),
    help="Low-pass of the contact force; unset: as in the run's summary.",
)


def evaluated(
    run: Run, filter: FilterKind, system: PowerSystem | None
) -> tuple[dict[str, Any], list[Criterion]]:
    """Summary of a run and, where a system is given, its criteria, which the summary holds too."""
    from catenary_fe.results import criteria_rows, excess, governing

    summary = run.summary(filter=filter)
    if system is None:
        return summary, []
    rows = criteria_rows(run, system, filter=filter)
    summary["governing_pantograph"] = governing(run.figures(filter), excess(rows))
    summary["criteria_system"] = system
    summary["criteria"] = [row.as_dict() for row in rows]
    return summary, rows


def with_elasticity(run: Run, shape: Shape, quiet: bool) -> Run:
    """The run with the elasticity of its evaluated spans."""
    from catenary_fe.statics.elasticity import elasticity

    with progress_bar("elasticity", not quiet) as progress:
        return run.with_elasticity(elasticity(shape, progress=progress))


def kept_evaluation(folder: str | Path) -> tuple[FilterKind, PowerSystem | None]:
    """How the run in a folder was evaluated, by its summary: the filter, and the system if it was judged.

    Raises InputError where the summary is damaged.
    """
    place = Path(folder) if Path(folder).is_dir() else Path(folder).parent
    said = read_record(place / "summary.json")
    kinds: tuple[FilterKind, ...] = get_args(FilterKind)
    systems: tuple[PowerSystem, ...] = get_args(PowerSystem)
    return (
        next((kind for kind in kinds if kind == said.get("filter")), "causal"),
        next((system for system in systems if system == said.get("criteria_system")), None),
    )


def print_criteria(system: PowerSystem, rows: Sequence[Criterion]) -> None:
    """A table of all criteria."""
    from catenary_fe.results.criteria import criteria_in_words, criteria_table

    print_table(f"{system}: {criteria_in_words(rows)}", *criteria_table(rows))


def exit_code(rows: Sequence[Criterion]) -> int:
    """1 where a criterion is missed, which is said on standard error; else 0."""
    from catenary_fe.results import labels, missed

    misses = missed(rows)
    for row, label in zip(rows, labels(rows), strict=True):
        if row in misses:
            click.echo(f"missed: {label}: {row.value_text}, must be {row.limit_text}", err=True)
    return 1 if misses else 0
