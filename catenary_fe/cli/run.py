"""The main job: run pantographs along a layout."""

from __future__ import annotations

import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, get_args

import click

from catenary_fe.cli.completion import pantograph_names
from catenary_fe.cli.criteria import evaluated, exit_code, print_criteria, with_elasticity
from catenary_fe.cli.folder import PARTIAL, Folder, output_folder, read_record
from catenary_fe.cli.inputs import InputFiles
from catenary_fe.cli.many_values import ManyValues
from catenary_fe.cli.schedules import write_schedules
from catenary_fe.cli.terminal import (
    json_option,
    layout_argument,
    output_option,
    planar_option,
    print_json,
    print_table,
    print_warnings,
    progress_bar,
    quiet_option,
    read_layout,
    say,
    say_lengths,
    spans_option,
    warned,
    working,
)
from catenary_fe.layout import (
    DescribedPantograph,
    InputError,
    PowerSystem,
    RunInterrupted,
    SolverError,
    counted,
    layout_warnings,
    load_pantograph,
)

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


@click.command(cls=ManyValues, many=("--pantograph-at",), numbers=True, epilog=EPILOG)
@layout_argument
@click.option(
    "--pantograph",
    "names",
    multiple=True,
    required=True,
    shell_complete=pantograph_names,
    help="Name in the library, or TOML file.",
)
@click.option("--pantograph-at", "positions", multiple=True, type=float, help="Positions in m at the start.")
@click.option("--speed-kmh", type=float, required=True, help="Speed in km/h.")
@click.option(
    "--method",
    type=click.Choice(["nonlinear", "linearised", "exudyn"]),
    default="nonlinear",
    show_default=True,
    help="Linearised: about the static state, many times faster.",
)
@click.option(
    "--checkpoint",
    type=click.Path(dir_okay=False),
    help="File that keeps the state of a nonlinear run: started again after a kill, the run goes on from it.",
)
@click.option("--time-step-ms", type=float, default=1.0, show_default=True, help="Time step in ms.")
@click.option("--element-m", type=float, help="Largest element of the contact wire in m.")
@click.option(
    "--filter",
    "filter_kind",
    type=click.Choice(["causal", "zero-phase"]),
    default="causal",
    show_default=True,
)
@spans_option
@planar_option
@click.option(
    "--store-wire-ms",
    type=click.FloatRange(0.0),
    help="Interval of the stored shapes of the whole wires, rounded to time steps, 0 for none; unset: 10 with"
    " -o, which reports and films need.",
)
@click.option(
    "--energy",
    is_flag=True,
    help="Record energy and check its balance with the method exudyn, too: a tenth slower.",
)
@click.option(
    "--elasticity",
    "with_curve",
    is_flag=True,
    help="Compute the elasticity of the evaluated spans, too, and keep it with the run.",
)
@click.option(
    "--criteria",
    "system",
    type=click.Choice(get_args(PowerSystem), case_sensitive=False),
    help="Judge the run by the limits of this system; exit code 1 on a miss.",
)
@output_option
@json_option
@quiet_option
def run(
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
    energy: bool,
    planar: bool,
    with_curve: bool,
    system: PowerSystem | None,
    output: str | None,
    as_json: bool,
    quiet: bool,
) -> int:
    """Run pantographs along a LAYOUT at constant speed: contact force, uplift, loss of contact."""
    from catenary_fe.engines.settings import TimeSettings
    from catenary_fe.fe import MeshSettings
    from catenary_fe.statics import find_form
    from catenary_fe.studies import simulate

    catenary = read_layout(layout, planar)
    if spans:
        catenary = catenary.replace(evaluated_spans=tuple(spans))
    pantographs = _pantographs(names, positions)
    files = InputFiles.read(layout, names) if output else InputFiles(b"", ())
    if store_wire_ms and not output:
        raise click.UsageError("--store-wire-ms has no effect without -o, whose folder keeps the shapes")
    if store_wire_ms is None:
        store_wire_ms = max(WIRE_INTERVAL, time_step_ms) if output else 0.0
    mesh = MeshSettings(contact_wire_element=element_m) if element_m is not None else MeshSettings()
    time = TimeSettings(step=time_step_ms / 1e3)
    with warned(layout_warnings(catenary)), output_folder(output) as folder:
        with working("form finding", not quiet):
            shape = find_form(catenary, mesh)
        options = _options(click.get_current_context())
        kept = partial_kept(output, shape, files, options, filter_kind)
        with progress_bar(f"run at {speed_kmh:g} km/h", not quiet) as progress, kept:
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
        if with_curve:
            result = with_elasticity(result, shape, quiet)
        summary, rows = evaluated(result, filter_kind, system)
        if folder:
            files.keep(folder, result, options)
            with working("pictures", not quiet):
                write_run(folder, shape, result, summary, rows)
            forget_partial(folder)
    if as_json:
        print_json(summary)
    elif not quiet:
        _print_summary(catenary.name, summary)
        print_checks(result)
        if system:
            print_criteria(system, rows)
        if output:
            click.echo(f"results and pictures in {output}, {_megabytes(output):.1f} MB")
    say_lengths(shape, quiet)
    if not as_json:
        print_warnings(summary["warnings"])
    return exit_code(rows)


def _options(context: click.Context) -> list[str]:
    """The options as they were given, but for pantographs and what only concerns the output."""
    words: list[str] = []
    for option in context.command.params:
        name = option.name or ""
        given = context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE
        if not given or name in ("layout", "names", "output", "as_json", "quiet"):
            continue
        value = context.params[name]
        if value is True:
            words.append(option.opts[0])
            continue
        if name == "spans":
            value = ",".join(map(str, value))
        for each in value if isinstance(value, tuple) else (value,):
            words += [option.opts[0], f"{each:g}" if isinstance(each, float) else str(each)]
    return words


@contextmanager
def partial_kept(
    output: str | None, shape: Shape, files: InputFiles, options: Sequence[str], filter_kind: Any
) -> Iterator[None]:
    """Where a run is stopped, write what there is of it into a folder inside the output folder."""
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
    """Remove what an earlier run that was stopped left in the folder: now there is a whole one."""
    place = folder.path.parent / PARTIAL
    if (place / "summary.json").is_file() and "partial" in read_record(place / "summary.json"):
        shutil.rmtree(place, ignore_errors=True)


_OF_A_RUN = (  # of another one they would say what is not so
    "criteria.png", "energy.png", "plan.png", "report.html",
    "csv/pantograph_[0-9].csv", "csv/support_uplift.csv", "csv/dropper_force.csv",
)  # fmt: skip


def write_run(
    folder: Folder, shape: Shape, result: Run, summary: dict[str, Any], rows: Sequence[Criterion] = ()
) -> None:
    """Results, pictures and summary of a run; its criteria where it was judged."""
    from catenary_fe import views
    from catenary_fe.views.plan import head_width

    result.save(folder.path / "run.nc")
    folder.json("summary.json", summary)
    write_schedules(folder, shape)
    another = (folder.path.parent / "run.nc").is_file()
    folder.keep()  # the run is safe whatever happens to its pictures
    if another:
        folder.forget(*_OF_A_RUN)
    folder.picture("layout.png", views.plot_layout(shape.catenary, shape))
    folder.picture("static_shape.png", views.plot_static_shape(shape))
    if shape.catenary.is_spatial:
        width = head_width(result.pantographs)
        folder.picture("plan.png", views.plot_plan(shape, head_width=width))
    folder.picture("contact_force.png", views.plot_contact_force(result, filter=summary["filter"]))
    folder.picture("support_uplift.png", views.plot_support_uplift(result))
    folder.picture("dropper_forces.png", views.plot_dropper_forces(result))
    if result.has_energy:
        folder.picture("energy.png", views.plot_energy(result))
    if rows:
        folder.picture(
            "criteria.png", views.plot_criteria(rows, title=_heading(shape.catenary.name, summary))
        )


def _pantographs(names: tuple[str, ...], positions: tuple[float, ...]) -> list[DescribedPantograph]:
    """One pantograph a position; a single name serves for all positions."""
    loaded = [load_pantograph(name) for name in names]
    if len(loaded) == 1 and len(positions) > 1:
        return loaded * len(positions)
    if len(loaded) > 1 and len(positions) not in (0, len(loaded)):
        raise InputError(
            f"{counted(len(positions), 'position')} for {len(loaded)} pantographs: give one for each"
        )
    return loaded


_ROWS = (
    ("mean force (N)", "mean_N", ".1f"),
    ("standard deviation (N)", "std_N", ".1f"),
    ("  0 to 5 Hz (N)", "std_0_5_Hz_N", ".1f"),
    ("  5 to 20 Hz (N)", "std_5_20_Hz_N", ".1f"),
    ("statistical maximum (N)", "statistical_max_N", ".1f"),
    ("statistical minimum (N)", "statistical_min_N", ".1f"),
    ("actual maximum (N)", "max_N", ".1f"),
    ("actual minimum (N)", "min_N", ".1f"),
    ("contact loss, however short (% of the time)", "contact_loss_percent", ".2f"),
    ("  in losses over 5 ms (% of the time)", "contact_loss_over_5_ms_percent", ".2f"),
    ("  number of losses over 5 ms", "losses_over_5_ms", "d"),
    ("  longest loss (ms)", "longest_loss_ms", ".1f"),
    ("range of the contact point (mm)", "contact_point_range_mm", ".1f"),
)


def _print_summary(title: str, summary: dict[str, Any]) -> None:
    pantographs = summary["pantographs"]
    rows = [(text, *(format(p[key], form) for p in pantographs)) for text, key, form in _ROWS]
    uplift = f"{summary['max_support_uplift_mm']:.1f}"
    blank = [""] * (len(pantographs) - 1)
    rows.append(("largest uplift at a support (mm)", uplift, *blank))
    if (uniformity := summary["elasticity_non_uniformity_percent"]) is not None:
        rows.append(("non-uniformity of the elasticity (%)", f"{uniformity:.2f}", *blank))
    print_table(_heading(title, summary), ("", *(p["name"] for p in pantographs)), rows)
    if blank:
        click.echo(f"governing pantograph: {summary['governing_pantograph']}")
    click.echo(
        f"{summary['simulated_s']:.2f} s simulated in {summary['wall_s']:.1f} s,"
        f" {summary['real_time_factor']:.2f} of real time"
    )


def _megabytes(folder: str) -> float:
    return sum(file.stat().st_size for file in Path(folder).iterdir() if file.is_file()) / 1e6


def print_checks(run: Run) -> None:
    """The quality checks as a table."""
    from catenary_fe.results import checks_in_words

    rows = [(c.name, c.value_text, c.bound_text, c.verdict) for c in run.checks]
    print_table(checks_in_words(run.checks), ("check", "value", "bound", "verdict"), rows)


def _heading(title: str, summary: dict[str, Any]) -> str:
    spans = ", ".join(map(str, summary["evaluated_spans"]))
    return f"{title}, {summary['speed_kmh']:g} km/h, spans {spans}, {summary['filter']} 20 Hz filter"
