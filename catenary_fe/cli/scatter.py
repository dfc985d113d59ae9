"""Monte Carlo studies: many samples of values that scatter, bands of the figures, and what matters."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import click

from catenary_fe.cli import options
from catenary_fe.cli.folder import output_folder
from catenary_fe.cli.sweep import kept
from catenary_fe.cli.terminal import Answer, print_json, print_table, progress_bar
from catenary_fe.layout import Study, counted, load_catenary, load_study
from catenary_fe.layout.variation import unit_of
from catenary_fe.results.export import check_xlsx, write_xlsx
from catenary_fe.results.quantities import FORCE, UPLIFT

if TYPE_CHECKING:
    from catenary_fe.cli.folder import Folder
    from catenary_fe.studies.scatter import Scatter

EPILOG = """\b
Examples:
  catenary-fe scatter models/studies/scatter_re330.toml --samples 100 -o scatter
  catenary-fe scatter STUDY --samples 64 --sensitivity -o scatter

\b
STUDY is a file that names a layout, pantographs, speeds, and in [scatter] places with distributions; the
places are those of 'sweep --vary'. With --sensitivity N samples take N (places + 2) runs at each speed.
A study that was stopped goes on when it is started again with the same folder."""

_FIGURES = FORCE["mean"], FORCE["std"], FORCE["max"], UPLIFT
_SAID = 5  # failures by themselves


@click.command(epilog=EPILOG)
@click.argument("study", type=click.Path())
@click.option("--samples", type=click.IntRange(2), required=True, help="Number of samples.")
@options.flag("--sensitivity", "Share the variance out among the places: Sobol' indices.")
@click.option(
    "--sampling",
    type=click.Choice(["latin-hypercube", "sobol"]),
    help="How samples are drawn; unset: latin-hypercube, with --sensitivity sobol.",
)
@options.method("linearised", "nonlinear", "exudyn")
@options.time_step
@options.element
@click.option("--jobs", type=click.IntRange(1), help="Number of processes; unset: one a core.")
@click.option("--scheduler", metavar="ADDRESS", help="Run on the Dask cluster at this address.")
@options.flag("--retry-failed", "Run failed cases of an earlier start again.")
@options.flag("--xlsx", "Write the tables as a workbook, too.")
@options.answer("Folder for tables and pictures.", required=True)
def scatter(  # long: an argument an option
    study: str,
    samples: int,
    sensitivity: bool,
    sampling: Any,
    method: Any,
    time_step_ms: float,
    element_m: float | None,
    jobs: int | None,
    scheduler: str | None,
    retry_failed: bool,
    xlsx: bool,
    answer: Answer,
) -> int:
    """Run samples of a STUDY whose values scatter: bands of the figures, and which values matter.

    Exit code 1 where a sample misses a criterion, if the study names a system of criteria.
    """
    from catenary_fe.studies.scatter import run_scatter

    output = str(answer.folder)
    if jobs and scheduler:
        raise click.UsageError("--jobs and --scheduler: the cluster has its own processes; give one of them")
    if xlsx:
        check_xlsx()
    given = load_study(study)
    with progress_bar(counted(samples, "sample"), not answer.quiet) as progress, kept(output):
        found = run_scatter(
            given,
            samples=samples,
            folder=output,
            sensitivity=sensitivity,
            sampling=sampling,
            method=method,
            time=options.time_of(time_step_ms),
            mesh=options.mesh_of(element_m),
            jobs=jobs or -1,
            scheduler=scheduler,
            retry=retry_failed,
            progress=progress,
        )
    _write(output, given, found, xlsx)
    if answer.as_json:
        print_json(found.as_dict())
    elif not answer.quiet:
        _print(found)
        click.echo(f"tables and pictures in {output}")
    return _said(found)


def _said(found: Scatter) -> int:
    """Failures and missed criteria on standard error; the exit code."""
    for record in found.failed[:_SAID]:
        said = ", ".join(f"{k} = {v}" for k, v in record.items() if k not in ("error", "exit_code"))
        click.echo(f"failed: {said}: {record['error']}", err=True)
    if found.failed:
        click.echo(
            f"{len(found.failed)} of {counted(found.cases, 'case')} did not run and are left out: all are in"
            " scatter.json",
            err=True,
        )
    if len(found.failed) == found.cases:
        raise click.exceptions.Exit(found.failed[0]["exit_code"])
    missed = [row for row in found.missed if row["missed_share"]]
    for row in missed:
        named = ", ".join(f"{name} in {n}" for name, n in row["missed"].items())
        click.echo(
            f"missed: criteria of {found.study.criteria} by {row['pantograph']} at {row['speed_kmh']:g} km/h"
            f" in {100 * row['missed_share']:.3g} % of {counted(row['samples'], 'sample')}: {named}",
            err=True,
        )
    return 1 if missed else 0


def _write(output: str, study: Study, found: Scatter, xlsx: bool) -> None:
    """Tables, pictures and the summary."""
    from catenary_fe.studies.scatter_tables import force_table

    tables = {
        "scatter": [_with_units(row, found.scalars) for row in found.rows],
        "bands": found.bands,
        "force_band": list(force_table(found.force)),
        "sensitivity": found.sensitivity,
    }
    with output_folder(output) as folder:
        assert folder is not None
        folder.json("scatter.json", found.as_dict())
        for name, rows in tables.items():
            if rows:
                columns = _columns(rows)
                folder.table(f"{name}.csv", [{key: _blank(row.get(key)) for key in columns} for row in rows])
            else:
                folder.forget(f"{name}.csv")
        if xlsx:
            sheets = {
                name: (columns, [{key: row.get(key) for key in columns} for row in rows])
                for name, rows in tables.items()
                if rows and (columns := _columns(rows))
            }
            write_xlsx(folder.path / "scatter.xlsx", sheets)
        folder.keep()  # tables are safe whatever happens to pictures
        _pictures(folder, study, found)


def _pictures(folder: Folder, study: Study, found: Scatter) -> None:
    from catenary_fe import views

    folder.forget("scatter.png", "force_band.png", "inputs.png", "sensitivity*.png")
    if not found.bands:
        return
    folder.picture("scatter.png", views.plot_scatter(found.rows, found.bands))
    if found.force:
        supports = load_catenary(study.layout).support_positions
        folder.picture("force_band.png", views.plot_force_bands(found.force, supports))
    numeric = [place for place in found.scalars if _is_numeric(found.rows, place)]
    if numeric:
        folder.picture("inputs.png", views.plot_scatter_inputs(found.rows, numeric))
    groups = dict.fromkeys((row["pantograph"], row["number"]) for row in found.sensitivity)
    for n, (pantograph, number) in enumerate(groups, start=1):
        name = "sensitivity.png" if n == 1 else f"sensitivity_{n}.png"
        folder.picture(name, views.plot_sensitivity(found.sensitivity, pantograph, number))


def _is_numeric(rows: Sequence[dict[str, Any]], place: str) -> bool:
    values = [row[place] for row in rows if place in row]
    return bool(values) and not any(isinstance(value, bool | str) for value in values)


def _columns(rows: Sequence[dict[str, Any]]) -> list[str]:
    return list(dict.fromkeys(key for row in sorted(rows, key=len, reverse=True) for key in row))


def _blank(value: Any) -> Any:
    return "" if value is None else value


def _with_units(row: dict[str, Any], places: Sequence[str]) -> dict[str, Any]:
    """A row with the columns of what scatters named with their units."""
    return {
        f"{key} [{unit}]" if key in places and (unit := unit_of(key)) else key: value
        for key, value in row.items()
    }


def _print(found: Scatter) -> None:
    several = len({(row["pantograph"], row["number"]) for row in found.bands}) > 1
    lines = []
    for q in _FIGURES:
        for row in (band for band in found.bands if band["figure"] == q.key):
            who = [row["pantograph"], row["number"]] if several else []
            columns = ("nominal", "mean", "deviation", "low_5", "median", "high_95")
            values = ["" if row[c] is None else f"{row[c]:.{q.digits + 1}f}" for c in columns]
            lines.append([f"{q.short} {q.unit}", f"{row['speed_kmh']:g}", *who, *values])
    titles = ["figure", "km/h", *(["pantograph", "no."] if several else [])]
    titles += ["nominal", "mean", "deviation", "5 %", "median", "95 %"]
    print_table(f"{found.study.name}: {counted(found.samples, 'sample')}", titles, lines)
    shares = [row for row in found.sensitivity if row["figure"] == FORCE["std"].key]
    if shares:
        _print_shares(shares, several)


def _print_shares(shares: Sequence[dict[str, Any]], several: bool) -> None:
    lines = [
        [
            row["input"],
            f"{row['speed_kmh']:g}",
            *([row["pantograph"], row["number"]] if several else []),
            *(f"{row[kind]:.2f} ({row[f'{kind}_at_least']:.2f} to {row[f'{kind}_at_most']:.2f})"
              for kind in ("first_order", "total")),
        ]
        for row in shares
    ]  # fmt: skip
    titles = ["place", "km/h", *(["pantograph", "no."] if several else []), "alone", "total"]
    print_table("share of the variance of σ (95 % confidence)", titles, lines)
