"""The report of a run's folder."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import click

from catenary_fe.cli.criteria import filter_option, kept_evaluation, with_elasticity
from catenary_fe.cli.folder import run_in
from catenary_fe.cli.terminal import quiet_option, working
from catenary_fe.layout import PowerSystem
from catenary_fe.results.files import write_text
from catenary_fe.results.signal import FilterKind


@click.command(
    epilog="\b\nExamples:\n  catenary-fe report run300\n  catenary-fe report run300 -o to_send.html"
)
@click.argument("folder", type=click.Path())
@click.option(
    "-o", "--output", type=click.Path(), metavar="FILE", help="Name of the page; unset: FOLDER/report.html."
)
@filter_option
@click.option(
    "--criteria",
    "system",
    type=click.Choice(get_args(PowerSystem), case_sensitive=False),
    help="Whose limits judge the run; unset: as in the run's summary, or AC.",
)
@quiet_option
def report(
    folder: str,
    output: str | None,
    filter_kind: FilterKind | None,
    system: PowerSystem | None,
    quiet: bool,
) -> None:
    """Write a report of the run in FOLDER: one HTML page that needs no other file and no network."""
    from catenary_fe.studies.rerun import shape_of
    from catenary_fe.views.report import report_page

    run = run_in(folder)
    place = Path(folder) if Path(folder).is_dir() else Path(folder).parent
    kept_filter, kept_system = kept_evaluation(folder)
    target = Path(output) if output else place / "report.html"
    shape = shape_of(run)
    if run.elasticity is None:
        run = with_elasticity(run, shape, quiet)
    with working("pictures", not quiet):
        page = report_page(
            run, shape, system=system or kept_system or "AC", filter=filter_kind or kept_filter
        )
    write_text(target, page)
    if not quiet:
        click.echo(f"{target}: {target.stat().st_size / 1e6:.1f} MB")
