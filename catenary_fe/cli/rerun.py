"""Repeat a run from its folder."""

from __future__ import annotations

import json
import shutil
from importlib.metadata import version
from pathlib import Path

import click

from catenary_fe.cli.criteria import evaluated, kept_evaluation, with_elasticity
from catenary_fe.cli.folder import output_folder, run_in
from catenary_fe.cli.inputs import changed_files
from catenary_fe.cli.run import write_run
from catenary_fe.cli.terminal import (
    json_option,
    output_option,
    print_json,
    print_warnings,
    progress_bar,
    quiet_option,
)
from catenary_fe.results import Run

INPUTS = ("layout.toml", "pantograph_*.toml", "inputs.json")
TOLERANCE = 0.1  # [N] of mean and standard deviation


@click.command(epilog="\b\nExamples:\n  catenary-fe rerun run300\n  catenary-fe rerun run300 -o run300_again")
@click.argument("folder", type=click.Path())
@output_option
@json_option
@quiet_option
def rerun(folder: str, output: str | None, as_json: bool, quiet: bool) -> int:
    """Repeat the run in FOLDER from what it recorded, and say whether the result is the same.

    The inputs come from run.nc, library values filled in, not from the files beside it. Exit code 1 when mean
    or standard deviation of the contact force come out more than 0.1 N away.
    """
    from catenary_fe.studies.rerun import rerun

    run = run_in(folder)
    warnings = _changes_since(run, Path(folder))
    with output_folder(output) as target:
        with progress_bar(f"run at {3.6 * run.speed:g} km/h again", not quiet) as progress:
            found = rerun(run, progress)
        if target:
            for file in (f for pattern in INPUTS for f in Path(folder).glob(pattern)):
                shutil.copyfile(file, target.path / file.name)
            again = (
                found.again if run.elasticity is None else with_elasticity(found.again, found.shape, quiet)
            )
            summary, rows = evaluated(again, *kept_evaluation(folder))
            write_run(target, found.shape, again, summary, rows)
    result = {
        "identical": found.identical,
        "largest_difference_of_contact_force_N": found.contact_force,
        "largest_difference_of_support_uplift_mm": 1e3 * found.support_uplift,
        "largest_difference_of_statistics_N": found.statistics,
        "warnings": warnings,
    }
    if as_json:
        print_json(result)
    else:
        print_warnings(warnings)
        if not quiet:
            click.echo(
                "the same to the last bit"
                if found.identical
                else f"mean and standard deviation within {found.statistics:.3g} N, the contact force within"
                f" {found.contact_force:.3g} N, the uplift at supports within"
                f" {1e3 * found.support_uplift:.3g} mm"
            )
    return 0 if found.statistics <= TOLERANCE else 1


def _changes_since(run: Run, folder: Path) -> list[str]:
    """What is not as it was when the run was computed."""
    found = []
    for name, before in json.loads(run.data.attrs["versions"]).items():
        if version(name) != before:
            found.append(f"{name} is {version(name)} now; the run was computed with {before}")
    for name in changed_files(folder):
        found.append(
            f"{folder / name} was changed since the run, which is repeated as it was; to run what it says"
            " now, use catenary-fe run"
        )
    return found
