"""The main job: run pantographs along a layout."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from catenary_fe.cli import options
from catenary_fe.cli.design import write_schedules
from catenary_fe.cli.folder import PARTIAL, Folder, InputFiles, output_folder, read_record
from catenary_fe.cli.terminal import (
    Answer,
    print_table,
    progress_bar,
    said_of_compilation,
    say,
    static_shape,
    working,
)
from catenary_fe.cli.verdicts import evaluated, exit_code, with_elasticity
from catenary_fe.layout import (
    InputError,
    PowerSystem,
    RunInterrupted,
    SolverError,
)
from catenary_fe.layout.arguments import listed
from catenary_fe.results import checks_in_words, criteria_in_words
from catenary_fe.results.check import checks_table
from catenary_fe.results.criteria import criteria_table
from catenary_fe.results.quantities import FORCE, NON_UNIFORMITY, UPLIFT, figure_rows

if TYPE_CHECKING:
    from catenary_fe.results import Criterion, Run
    from catenary_fe.statics import Shape

EPILOG = """\b
Examples:
  catenary-fe run models/layouts/en50318_2002.toml --pantograph "EN 50318:2002" --speed-kmh 300 -o out
  catenary-fe run LAYOUT --pantograph my.toml --pantograph-at 110 10 --speed-kmh 250 --json
  catenary-fe run LAYOUT --pantograph "EN 50318:2018 AC" --speed-kmh 275 --criteria AC

\b
Ten spans at 1 ms with the wires every 10 ms take 10 MB on disk and 0.4 GB of memory; what is too
much for the machine is refused before the run. A run that is stopped or fails in the middle is kept
in DIR/partial."""


WIRE_INTERVAL = 10.0  # [ms] a wave of 440 km/h runs 1.2 m, about an element, from shape to shape


@click.command(cls=options.ManyValues, many=("--pantograph-at",), numbers=True, epilog=EPILOG)
@options.layout
@options.pantographs
@options.positions
@click.option("--speed-kmh", type=float, required=True, help="Speed in km/h.")
@options.method(
    "nonlinear", "linearised", "exudyn", help="Linearised: about the static state, many times faster."
)
@click.option(
    "--checkpoint",
    type=click.Path(dir_okay=False),
    help="File that keeps the state of a nonlinear run: started again after a kill, the run goes on from it.",
)
@options.time_step
@options.element
@options.low_pass(None, default="causal", show_default=True)
@options.spans
@options.planar
@click.option(
    "--store-wire-ms",
    type=click.FloatRange(0.0),
    help="Interval of the stored shapes of the whole wires, rounded to time steps, 0 for none; unset: 10 with"
    " -o, which reports and films need.",
)
@options.conditions("Wind, ice and temperature that the line is under.")
@options.flag("--energy", "Record energy and check its balance with the method exudyn, too: a tenth slower.")
@options.flag("--elasticity", "Compute the elasticity of the evaluated spans, too, and keep it with the run.")
@options.criteria("Judge the run by the limits of this system; exit code 1 on a miss.")
@options.answer()
def run(  # long: an argument an option
    layout: str,
    names: tuple[str, ...],
    positions: tuple[float, ...],
    speed_kmh: float,
    method: Any,
    checkpoint: str | None,
    time_step_ms: float,
    element_m: float | None,
    filter_kind: Any,
    spans: list[int] | None,
    store_wire_ms: float | None,
    conditions: str | None,
    energy: bool,
    planar: bool,
    elasticity: bool,
    system: PowerSystem | None,
    answer: Answer,
) -> int:
    """Run pantographs along a LAYOUT at constant speed: contact force, uplift, loss of contact."""
    from catenary_fe.statics import settle
    from catenary_fe.studies import simulate

    catenary, output = options.read_layout(layout, planar), answer.folder
    if spans:
        catenary = catenary.replace(evaluated_spans=tuple(spans))
    pantographs = options.read_pantographs(names, positions)
    weather = options.read_conditions(conditions) if conditions else None
    files = InputFiles.read(layout, names, conditions) if output else InputFiles(b"", ())
    if store_wire_ms and not output:
        raise click.UsageError("--store-wire-ms has no effect without -o, whose folder keeps the shapes")
    if store_wire_ms is None:
        store_wire_ms = max(WIRE_INTERVAL, time_step_ms) if output else 0.0
    mesh = options.mesh_of(element_m)
    time = options.time_of(time_step_ms)
    with static_shape(catenary, answer, mesh) as (shape, folder):
        if weather:
            shape = settle(shape, weather)
        given = options.given(click.get_current_context())
        kept = partial_kept(output, shape, files, given, filter_kind)
        with progress_bar(f"run at {speed_kmh:g} km/h", not answer.quiet) as progress, kept:
            result = simulate(
                shape,
                pantographs,
                speed=speed_kmh / 3.6,
                positions=positions or None,
                time=time,
                store_wire=store_wire_ms / 1e3 if store_wire_ms else None,
                progress=progress,
                method=method,
                energy=energy,
                checkpoint=checkpoint,
            )
        if elasticity:
            result = with_elasticity(result, shape, answer.quiet)
        summary, rows = evaluated(result, filter_kind, system)
        if folder:
            files.keep(folder, result, given)
            with working("pictures", not answer.quiet):
                write_run(folder, shape, result, summary, rows)
            forget_partial(folder)

    def tables() -> None:
        _print_summary(catenary.name, summary)
        print_table(checks_in_words(result.checks), *checks_table(result.checks))
        if system:
            print_table(f"{system}: {criteria_in_words(rows)}", *criteria_table(rows))
        if output:
            size = sum(file.stat().st_size for file in Path(output).iterdir() if file.is_file())
            click.echo(f"results and pictures in {output}, {size / 1e6:.1f} MB")

    answer.show(summary, tables, shape)
    return exit_code(rows)


@contextmanager
def partial_kept(
    output: str | None, shape: Shape, files: InputFiles, options: Sequence[str], filter_kind: Any
) -> Iterator[None]:
    """Where a run is stopped, write its results so far into a folder inside the output folder."""
    try:
        yield
    except (SolverError, RunInterrupted) as error:
        if output and error.partial is not None:
            place, run = str(Path(output) / PARTIAL), error.partial
            try:
                with output_folder(place) as folder:
                    assert folder is not None
                    files.keep(folder, run, options)
                    write_run(folder, shape, run, run.summary(filter=filter_kind))
                said = f"{run.partial.reached_s:.2f} of {run.partial.planned_s:.2f} s are kept in {place}"
            except InputError as fault:
                said = f"what there is of the run is lost: {fault}"
            say("partial", said, "yellow")
        raise


def forget_partial(folder: Folder) -> None:
    """Remove what an earlier run that was stopped left in the folder: it is complete now."""
    place = folder.path.parent / PARTIAL
    if (place / "summary.json").is_file() and "partial" in read_record(place / "summary.json"):
        shutil.rmtree(place, ignore_errors=True)


_OF_A_RUN = (  # they would describe another run
    "contact_lateral.png", "criteria.png", "energy.png", "handover.png", "heights.png", "plan.png",
    "report.html",
    "csv/pantograph_[0-9].csv", "csv/support_uplift.csv", "csv/dropper_force.csv",
)  # fmt: skip


def write_run(
    folder: Folder, shape: Shape, result: Run, summary: dict[str, Any], rows: Sequence[Criterion] = ()
) -> None:
    """Results, pictures and summary of a run; its criteria where it was judged."""
    from catenary_fe.views.run import plot_criteria, run_pictures

    result.save(folder.path / "run.nc")
    folder.json("summary.json", summary)
    write_schedules(folder, shape)
    another = (folder.path.parent / "run.nc").is_file()
    folder.keep()  # the run is safe whatever happens to its pictures
    if another:
        folder.forget(*_OF_A_RUN)
    for name, ax in run_pictures(result, shape, summary["filter"]):
        folder.picture(f"{name}.png", ax)
    if rows:
        title = _heading(shape.catenary.name, summary)
        folder.picture("criteria.png", plot_criteria(rows, title=title))


def _print_summary(title: str, summary: dict[str, Any]) -> None:
    pantographs = summary["pantographs"]
    blank = [""] * (len(pantographs) - 1)
    rows = figure_rows(FORCE.values(), pantographs)
    of_line = [q for q in (UPLIFT, NON_UNIFORMITY) if summary[q.key] is not None]
    rows += [(*row, *blank) for row in figure_rows(of_line, [summary])]
    print_table(_heading(title, summary), ("", *(p["name"] for p in pantographs)), rows)
    if blank:
        click.echo(f"governing pantograph: {summary['governing_pantograph']}")
    click.echo(
        f"{summary['simulated_s']:.2f} s simulated in {summary['wall_s']:.1f} s,"
        f" {summary['real_time_factor']:.2f} of real time"
        f"{said_of_compilation()}"
    )


def _heading(title: str, summary: dict[str, Any]) -> str:
    spans = listed(summary["evaluated_spans"])
    return f"{title}, {summary['speed_kmh']:g} km/h, spans {spans}, {summary['filter']} 20 Hz filter"
