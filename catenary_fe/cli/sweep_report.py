"""The report of a sweep: one page of all cases, and one of each run that was kept."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from catenary_fe.cli.folder import read_record, run_in
from catenary_fe.cli.sweep_table import RECORD, axis_of
from catenary_fe.cli.terminal import progress_bar
from catenary_fe.cli.verdicts import kept_evaluation
from catenary_fe.layout import InputError
from catenary_fe.results.files import write_text


def is_sweep(folder: str) -> bool:
    """Whether a sweep wrote this folder."""
    return (Path(folder) / RECORD).is_file()


def report_sweep(folder: str, output: str | None, quiet: bool) -> None:
    """Write the page of a sweep, and the pages of its kept runs beside them.

    Raises InputError where the record is damaged, or a kept run is not there any more.
    """
    from catenary_fe.studies.sweep_store import Store
    from catenary_fe.views.report import sweep_page

    made, store = read_record(Path(folder) / RECORD), Store(Path(folder) / "cases")
    target = Path(output) if output else Path(folder) / "report.html"
    try:
        runs = [Path(folder) / case["run"] for case in made["cases"] if case["run"]]
        forces = {case["number"]: (store.read(case["key"]) or {}).get("force") for case in made["cases"]}
        page = sweep_page(made, *axis_of(made["axes"]), {k: v for k, v in forces.items() if v})
    except (KeyError, TypeError, AttributeError):
        raise InputError(
            f"{Path(folder) / RECORD}: damaged, or of another version; start the sweep again with this folder"
        ) from None
    with progress_bar(f"{len(runs)} runs", bool(runs) and not quiet) as progress:
        for n, run in enumerate(runs, start=1):
            report_run(run)
            if progress:
                progress(n / len(runs))
    write_text(target, page)
    if not quiet:
        beside = f", and pages of {len(runs)} runs" if runs else ""
        click.echo(f"{target}: {target.stat().st_size / 1e6:.1f} MB{beside}")


def report_run(folder: Path) -> None:
    """Write the page of a kept run into its folder, judged as its summary says."""
    from catenary_fe.studies.rerun import shape_of
    from catenary_fe.views.report import report_page

    run = run_in(folder)
    filter_kind, system = kept_evaluation(folder)
    options: dict[str, Any] = {"system": system or "AC", "filter": filter_kind}
    write_text(folder / "report.html", report_page(run, shape_of(run), **options))
