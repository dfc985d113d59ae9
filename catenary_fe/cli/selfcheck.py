"""Whether this installation computes what it should."""

from __future__ import annotations

from dataclasses import asdict

import click

from catenary_fe.cli.terminal import json_option, print_json, print_table, progress_bar, quiet_option


@click.command(epilog="\b\nExample:\n  catenary-fe selfcheck")
@json_option
@quiet_option
def selfcheck(as_json: bool, quiet: bool) -> int:
    """Compute known answers, in half a minute; exit code 1 when this installation misses one."""
    from catenary_fe.studies.selfcheck import selfcheck as known_answers

    with progress_bar("selfcheck", not quiet) as progress:
        checks = known_answers(progress)
    if as_json:
        print_json([asdict(c) | {"error": c.error, "passed": bool(c.passed)} for c in checks])
    elif not quiet:
        columns = ("quantity", "computed", "reference", "unit", "error", "tolerance", "passed")
        rows = [
            (
                c.name,
                f"{c.computed:.6g}",
                f"{c.reference:.6g}",
                c.unit,
                f"{c.error:.1e}",
                f"{c.tolerance:g}",
                "yes" if c.passed else "NO",
            )
            for c in checks
        ]
        print_table("selfcheck", columns, rows)
    missed = sum(not c.passed for c in checks)
    click.echo(f"{len(checks) - missed} passed, {missed} missed", err=True)
    return 1 if missed else 0
