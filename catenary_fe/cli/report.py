"""The report of a run's folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any, get_args

import click

from catenary_fe.cli.folder import read_record, run_in
from catenary_fe.cli.terminal import progress_bar, quiet_option, working
from catenary_fe.results.files import write_text
from catenary_fe.results.signal import FilterKind
from catenary_fe.system import PowerSystem

_POINTS_A_SPAN = 20  # of the elasticity, besides droppers and supports


@click.command(
    epilog="\b\nExamples:\n  catenary-fe report run300\n  catenary-fe report run300 -o to_send.html"
)
@click.argument("folder", type=click.Path())
@click.option(
    "-o", "--output", type=click.Path(), metavar="FILE", help="Name of the page; unset: FOLDER/report.html."
)
@click.option(
    "--filter",
    "filter_kind",
    type=click.Choice(["causal", "zero-phase"]),
    help="Unset: as in the run's summary.",
)
@click.option(
    "--criteria",
    "system",
    type=click.Choice(get_args(PowerSystem), case_sensitive=False),
    help="Whose limits judge the run; unset: as in the run's summary, or AC.",
)
@quiet_option
def report(
    folder: str, output: str | None, filter_kind: Any, system: PowerSystem | None, quiet: bool
) -> None:
    """Write a report of the run in FOLDER: one HTML page that needs no other file and no network."""
    from catenary_fe.analysis import elasticity
    from catenary_fe.analysis.repeat import shape_of
    from catenary_fe.views.report import report_page

    run = run_in(folder)
    place = Path(folder) if Path(folder).is_dir() else Path(folder).parent
    said = read_record(place / "summary.json")
    target = Path(output) if output else place / "report.html"
    with progress_bar("elasticity", not quiet) as progress:
        shape = shape_of(run)
        curve = elasticity(
            shape, spans=run.evaluated_spans[:2], points_per_span=_POINTS_A_SPAN, progress=progress
        )
    with working("pictures", not quiet):
        page = report_page(
            run,
            shape,
            curve,
            system=system or _known(said.get("criteria_system"), get_args(PowerSystem)) or "AC",
            filter=filter_kind or _known(said.get("filter"), get_args(FilterKind)) or "causal",
        )
    write_text(target, page)
    if not quiet:
        click.echo(f"{target}: {target.stat().st_size / 1e6:.1f} MB")


def _known(value: Any, choices: tuple[str, ...]) -> Any:
    return value if value in choices else None
