"""Histories of a run as CSV files."""

from __future__ import annotations

from pathlib import Path

import click

from catenary_fe.cli.criteria import filter_option, kept_evaluation
from catenary_fe.cli.folder import run_in
from catenary_fe.cli.terminal import json_option, print_json, quiet_option
from catenary_fe.layout.arguments import number
from catenary_fe.results.signal import FilterKind


@click.command(
    epilog="\b\nExamples:\n  catenary-fe export run300\n  catenary-fe export run300 --every-ms 5 -o tables"
)
@click.argument("folder", type=click.Path())
@click.option(
    "-o", "--output", type=click.Path(), metavar="DIR", help="Folder for the files; unset: FOLDER/csv."
)
@click.option("--every-ms", type=float, help="Interval of the rows in ms, rounded to time steps; unset: one.")
@filter_option
@json_option
@quiet_option
def export(
    folder: str,
    output: str | None,
    every_ms: float | None,
    filter_kind: FilterKind | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Write the histories of the run in FOLDER as CSV files: forces, heights, uplifts, dropper forces.

    From Python, the same data are an xarray Dataset: catenary_fe.load_run("FOLDER/run.nc").data.
    """
    from catenary_fe.results.export import history_tables, write_tables

    run = run_in(folder)
    every = 1
    if every_ms is not None:
        number(
            "--every-ms", every_ms, "ms", least=1e3 * run.step, remedy="the run's time step is the shortest"
        )
        every = round(every_ms / 1e3 / run.step)
    target = (
        Path(output) if output else Path(folder if Path(folder).is_dir() else Path(folder).parent) / "csv"
    )
    kind = filter_kind or kept_evaluation(folder)[0]
    files = write_tables(history_tables(run, kind), target, every)
    if as_json:
        print_json({"files": [str(file) for file in files]})
    elif not quiet:
        for file in files:
            click.echo(file)
