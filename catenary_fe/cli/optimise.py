"""Designs: the best values of a line for a figure of its runs, within the criteria."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from catenary_fe.cli import options
from catenary_fe.cli.folder import output_folder
from catenary_fe.cli.sweep import kept
from catenary_fe.cli.terminal import Answer, print_json, print_table, progress_bar
from catenary_fe.layout import load_study

if TYPE_CHECKING:
    from catenary_fe.studies.design import Evaluation
    from catenary_fe.studies.optimise import Optimum

EPILOG = """\b
Examples:
  catenary-fe optimise models/studies/design_five_droppers.toml -o design
  catenary-fe optimise STUDY --search global --most 300 -o design

\b
STUDY is a file that names a layout, pantographs and speeds, in [design] places with their bounds, and in
[objective] the figure to be made best; 'criteria' are its limits.
A search that was stopped goes on when it is started again with the same folder."""


@click.command(epilog=EPILOG)
@click.argument("study", type=click.Path())
@click.option(
    "--search", type=click.Choice(["local", "global"]), default="local", show_default=True,
    help="From the files' own values, or everywhere between the bounds.",
)  # fmt: skip
@click.option(
    "--most", type=click.IntRange(2), default=60, show_default=True, help="Designs to be evaluated."
)
@click.option(
    "--fresh", type=click.IntRange(0), default=32, show_default=True,
    help="Samples in the end that the search has not seen, where something scatters.",
)  # fmt: skip
@options.flag("--no-nonlinear", "Leave out the nonlinear runs of start and best in the end.")
@options.time_step
@options.element
@click.option("--jobs", type=click.IntRange(1), help="Number of processes; unset: one a core.")
@options.answer("Folder for the best layout, tables and pictures.", required=True)
def optimise(
    study: str,
    search: Any,
    most: int,
    fresh: int,
    no_nonlinear: bool,
    time_step_ms: float,
    element_m: float | None,
    jobs: int | None,
    answer: Answer,
) -> int:
    """Look for the values of a STUDY that make a figure of its runs the best, within its criteria.

    Exit code 1 where the best design misses a criterion.
    """
    from catenary_fe.studies.design import DesignProblem
    from catenary_fe.studies.optimise import optimise as look_for

    output = str(answer.folder)
    problem = DesignProblem(
        load_study(study),
        folder=output,
        jobs=jobs or -1,
        time=options.time_of(time_step_ms),
        mesh=options.mesh_of(element_m),
    )
    with progress_bar(f"at most {most} designs", not answer.quiet) as progress, kept(output):
        found = look_for(
            problem,
            search=search,
            most=most,
            confirm=not no_nonlinear,
            fresh=fresh,
            progress=progress,
        )
    _write(output, found)
    if answer.as_json:
        print_json(found.as_dict())
    elif not answer.quiet:
        _print(found)
        click.echo(f"best layout, tables and pictures in {output}")
    return _said(found)


def _said(found: Optimum) -> int:
    """What the best design misses, on standard error; the exit code."""
    missed = sorted({name for row in found.best.cases for name in row["missed"].split("; ") if name})
    if missed:
        click.echo(f"missed: the best design misses {', '.join(missed)}", err=True)
    if found.fresh:
        cases = found.fresh.cases
        bad = {row["sample"] for row in cases if row["missed"]}
        count = len({row["sample"] for row in cases}) - 1
        click.echo(
            f"fresh samples: {len(bad - {0})} of {count} miss a criterion; the largest share of a limit is"
            f" {100 * found.fresh.used:.1f} %",
            err=True,
        )
    return 1 if missed else 0


def _write(output: str, found: Optimum) -> None:
    from catenary_fe import views
    from catenary_fe.results import save_catenary

    problem = found.problem
    with output_folder(output) as folder:
        assert folder is not None
        folder.json("design.json", found.as_dict())
        rows = [
            {"evaluation": n, "objective": e.objective, "largest_share_of_limit": e.used, "error": e.error}
            | dict(zip(problem.names, e.x.tolist(), strict=True))
            for n, e in enumerate(found.history, start=1)
        ]
        folder.table("history.csv", rows)
        save_catenary(problem.line(found.best.x), folder.path / "best.toml")
        folder.keep()
        folder.picture("way.png", views.plot_design(found))


def _print(found: Optimum) -> None:
    figure, over = found.problem.study.objective.figure, found.problem.study.objective.over
    rows = [
        [name, f"{a:g}", f"{b:g}"]
        for name, a, b in zip(found.problem.names, found.start.x.tolist(), found.best.x.tolist(), strict=True)
    ]
    pairs: list[tuple[str, tuple[Evaluation, Evaluation]]] = [("linearised", (found.start, found.best))]
    if len(found.confirmed) == 2:
        pairs.append(("nonlinear", (found.confirmed[0], found.confirmed[1])))
    for method, pair in pairs:
        rows.append([f"{over} {figure}, {method}", *(f"{abs(e.objective):.2f}" for e in pair)])
        if found.problem.study.criteria:
            rows.append([f"largest share of a limit, {method}", *(f"{100 * e.used:.1f} %" for e in pair)])
    print_table(f"{found.problem.study.name}: {len(found.history)} designs", ["", "start", "best"], rows)
