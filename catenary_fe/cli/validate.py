"""The validation suite, which lives beside the package in a checkout."""

from __future__ import annotations

import importlib
import sys
from dataclasses import asdict
from pathlib import Path
from types import ModuleType

import click

from catenary_fe.cli.folder import writable_folder
from catenary_fe.cli.terminal import json_option, print_json, print_table, progress_bar, quiet_option
from catenary_fe.layout import InputError

_COLUMNS = ("case", "quantity", "computed", "reference", "error", "tolerance", "passed")


@click.command(epilog="\b\nExample:\n  catenary-fe validate --quick")
@click.argument("cases", nargs=-1)
@click.option("--quick", is_flag=True, help="Only what takes seconds.")
@click.option("--jobs", type=click.IntRange(1), default=2, show_default=True, help="Processes.")
@json_option
@quiet_option
def validate(cases: tuple[str, ...], quick: bool, jobs: int, as_json: bool, quiet: bool) -> int:
    """Compare computed with reference values; exit code 1 when a case misses."""
    suite = _suite()
    assert suite.__file__
    report = None if cases or quick else writable_folder(str(Path(suite.__file__).parent))
    with progress_bar("validation", not quiet) as progress:
        checks = suite.run_cases(list(cases) or None, quick=quick, jobs=jobs, progress=progress)
    if report:
        suite.write_report(checks, report)
    rows = [asdict(check) for check in checks]
    if as_json:
        keys = ("case", "quantity", "computed", "reference", "error", "tolerance", "source", "passed")
        print_json([{key: row[key] for key in keys} for row in rows])
    elif not quiet:
        print_table("validation", _COLUMNS, [[row[key] for key in _COLUMNS] for row in rows])
    verdicts = [row["passed"] for row in rows]
    passed, missed = verdicts.count(True), verdicts.count(False)
    click.echo(f"{passed} passed, {missed} missed, {verdicts.count(None)} not judged", err=True)
    return 1 if missed else 0


def _suite() -> ModuleType:
    """The checkout's validation package: beside the working directory or beside the package."""
    for root in (Path.cwd(), Path(__file__).resolve().parents[2]):
        if (root / "validation" / "__init__.py").is_file():
            if str(root) not in sys.path:
                sys.path.insert(0, str(root))
            return importlib.import_module("validation")
    raise InputError("the validation suite is part of the source checkout; run this command there")
