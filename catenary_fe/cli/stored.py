"""Commands on runs' folders: report, comparison, histories as CSV, pictures, the same run again."""

from __future__ import annotations

import json
import shutil
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from catenary_fe.cli import options
from catenary_fe.cli.folder import changed_files, folder_of, output_folder, run_in, save_picture
from catenary_fe.cli.line_test import TestOptions, compare_line_test, test_options
from catenary_fe.cli.run import write_run
from catenary_fe.cli.surroundings import readable
from catenary_fe.cli.sweep_report import is_sweep, report_sweep
from catenary_fe.cli.terminal import (
    Answer,
    print_json,
    print_table,
    print_warnings,
    progress_bar,
    say_lengths,
    working,
)
from catenary_fe.cli.verdicts import evaluated, kept_evaluation, with_elasticity
from catenary_fe.layout import InputError, PowerSystem, counted, load_catenary
from catenary_fe.layout.arguments import number
from catenary_fe.results.files import write_text
from catenary_fe.results.line_test.files import is_measurement
from catenary_fe.results.signal import FilterKind

if TYPE_CHECKING:
    from catenary_fe.results import Run
    from catenary_fe.statics import Shape

INPUTS = ("layout.toml", "pantograph_*.toml", "pantograph_*_receptance.csv", "conditions.toml", "inputs.json")
TOLERANCE = 0.1  # [N] of mean and standard deviation


@click.command(
    epilog="\b\nExamples:\n  catenary-fe report run300\n  catenary-fe report sweep -o to_send.html"
)
@options.folder
@options.output("Name of the page; unset: FOLDER/report.html.", "FILE")
@options.low_pass("Low-pass of the contact force; unset: as in the run's summary.")
@options.criteria("Whose limits judge the run; unset: as in the run's summary, or AC.")
@options.quiet
def report(
    folder: str, output: str | None, filter_kind: FilterKind | None, system: PowerSystem | None, quiet: bool
) -> None:
    """Write a report of the run or sweep in FOLDER: one HTML page that needs no other file and no network.

    Of a sweep that kept its runs, each run gets its own page, too, which the sweep's page names.
    """
    if is_sweep(folder):
        if filter_kind or system:
            raise click.UsageError("--filter and --criteria are of a single run; a sweep has its own")
        report_sweep(folder, output, quiet)
        return
    from catenary_fe.studies.rerun import shape_of
    from catenary_fe.views.report import report_page

    run = run_in(folder)
    kept_filter, kept_system = kept_evaluation(folder)
    target = Path(output) if output else folder_of(folder) / "report.html"
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


@click.command(
    epilog="\b\nExamples:\n  catenary-fe compare run250 run300\n"
    "  catenary-fe compare before after -o comparison\n"
    "  catenary-fe compare run250 measured.csv --map 'force[N]=CH7' -o line_test"
)
@click.argument("folders", nargs=-1, required=True, type=click.Path(), metavar="FOLDER FOLDER|TABLE...")
@options.low_pass(
    "Low-pass of the contact forces; unset: as in the runs' summaries, causal where they differ."
)
@test_options
@options.answer()
def compare(
    folders: tuple[str, ...], filter_kind: FilterKind | None, test: TestOptions, answer: Answer
) -> int:
    """Put the runs in two or more FOLDERs side by side: what went in differently, and what came out.

    With a TABLE of measurements (.csv, .xlsx, .mat, .tdms) in place of a second run: the run beside a line
    test. Headings name position or time, force, height, uplift, with units. Exit code 1 where a limit of
    EN 50318's comparison with line tests (recalled) is missed.

    With -o, also pictures, and a page comparison.html or line_test.html.
    """
    measured = [name for name in folders if is_measurement(name) and not Path(name).is_dir()]
    if measured:
        runs_given = [name for name in folders if name not in measured]
        if len(runs_given) != 1:
            raise InputError(
                f"{counted(len(runs_given), 'run')} and {counted(len(measured), 'table')} of measurements:"
                " give one run, and tables of it"
            )
        return compare_line_test(runs_given[0], measured, filter_kind, test, answer)
    test.refuse()
    _compare_runs(folders, filter_kind, answer)
    return 0


def _compare_runs(folders: tuple[str, ...], filter_kind: FilterKind | None, answer: Answer) -> None:
    from catenary_fe.results.comparison import failed_checks, figures_table, input_differences, key_figures

    runs, labels = [run_in(folder) for folder in folders], _labels(folders)
    kind, warnings = common_filter(folders, labels, filter_kind)
    warnings += failed_checks(runs, labels)
    columns, inputs = key_figures(runs, labels, kind), input_differences(runs)
    result: dict[str, Any] = {
        "inputs_that_differ": [{"name": d.name} | dict(zip(labels, d.values, strict=True)) for d in inputs],
        "runs": [{"label": column.label, **column.values} for column in columns],
        "filter": kind,
        "warnings": warnings,
    }
    shown = bool(answer.folder) and not answer.quiet
    with output_folder(answer.folder) as folder, working("pictures", shown):
        if folder:
            from catenary_fe.views.comparison import plot_force_comparison, plot_uplift_comparison
            from catenary_fe.views.report import comparison_page

            folder.json("comparison.json", result)
            folder.table("comparison.csv", result["runs"])
            folder.picture("contact_force.png", plot_force_comparison(runs, labels, filter=kind))
            folder.picture("support_uplift.png", plot_uplift_comparison(runs, labels))
            folder.text("comparison.html", comparison_page(runs, labels, filter=kind))

    def tables() -> None:
        if inputs:
            print_table("what went in differently", ("input", *labels), [(d.name, *d.values) for d in inputs])
        else:
            click.echo("the inputs are the same")
        print_table(f"what came out, {kind} filter", *figures_table(columns))

    answer.show(result, tables)


def common_filter(
    folders: tuple[str, ...], labels: list[str], chosen: FilterKind | None
) -> tuple[FilterKind, list[str]]:
    """The filter of all figures, and warnings of runs whose own summary used another filter."""
    kinds = [kept_evaluation(folder)[0] for folder in folders]
    kind: FilterKind = chosen or (kinds[0] if len(set(kinds)) == 1 else "causal")
    return kind, [
        f"{label}: its own summary has figures of the {own} filter, here they are of the {kind} one"
        for label, own in zip(labels, kinds, strict=True)
        if own != kind
    ]


def _labels(folders: tuple[str, ...]) -> list[str]:
    """Last parts of the paths, or the whole paths where those are not unique."""
    names = [readable(Path(folder).resolve().name) for folder in folders]
    return names if len(set(names)) == len(names) else [readable(folder) for folder in folders]


@click.command(
    epilog="\b\nExamples:\n  catenary-fe export run300\n  catenary-fe export run300 --every-ms 5 -o tables"
)
@options.folder
@options.output("Folder for the files; unset: FOLDER/csv.")
@click.option("--every-ms", type=float, help="Interval of the rows in ms, rounded to time steps; unset: one.")
@options.low_pass("Low-pass of the contact force; unset: as in the run's summary.")
@options.as_json
@options.quiet
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
    target = Path(output) if output else folder_of(folder) / "csv"
    kind = filter_kind or kept_evaluation(folder)[0]
    files = write_tables(history_tables(run, kind), target, every)
    if as_json:
        print_json({"files": [str(file) for file in files]})
    elif not quiet:
        for file in files:
            click.echo(file)


@click.command(
    epilog="\b\nExamples:\n  catenary-fe film run300 -o run300.gif\n"
    "  catenary-fe film run300 --spans 5 --slowed 10 -o span5.mp4"
)
@options.folder
@options.output("Name with .gif or .mp4.", "FILE", required=True)
@options.shown_spans
@click.option("--slowed", type=float, default=4.0, show_default=True, help="Times slower than real time.")
@click.option("--fps", type=int, default=20, show_default=True, help="Frames a second, at most 50.")
@click.option(
    "--magnified", type=float, default=5.0, show_default=True, help="Times that motion is drawn larger."
)
@options.quiet
def film(
    folder: str, output: str, spans: list[int] | None, slowed: float, fps: int, magnified: float, quiet: bool
) -> None:
    """Film the run in FOLDER: wires, droppers (slack ones marked), pantographs, contact force."""
    from catenary_fe.views.film import film as draw

    run = run_in(folder)
    with progress_bar("film", not quiet) as progress:
        path = draw(
            run,
            output,
            spans=spans,
            slowed=slowed,
            frames_per_second=fps,
            magnified=magnified,
            progress=progress,
        )
    if not quiet:
        click.echo(f"{path}: {path.stat().st_size / 1e6:.1f} MB")


@click.command(
    epilog="\b\nExamples:\n  catenary-fe waves run300 -o waves.png\n"
    "  catenary-fe waves run300 --quantity deflection --spans 4,5,6 -o uplift.png"
)
@options.folder
@options.output("Name with .png, .svg or .pdf.", "FILE", required=True)
@click.option(
    "--quantity", type=click.Choice(["velocity", "deflection"]), default="velocity", show_default=True
)
@click.option("--wire", default="contact wire", show_default=True, help="Which of the stored wires.")
@options.shown_spans
@options.quiet
def waves(folder: str, output: str, quantity: Any, wire: str, spans: list[int] | None, quiet: bool) -> None:
    """Draw the waves of the run in FOLDER over place and time, with the rays of the wave speed."""
    from catenary_fe.views import plot_run_waves

    axes = plot_run_waves(run_in(folder), quantity=quantity, spans=spans, wire=wire)
    save_picture(Path(output), axes)
    if not quiet:
        click.echo(output)


@click.command(
    epilog="\b\nExamples:\n  catenary-fe view models/layouts/en50318_2002.toml --spans 1,2\n"
    "  catenary-fe view run300 -o model.png"
)
@click.argument("layout_or_folder", type=click.Path())
@options.shown_spans
@options.output("Save the picture and close, as .png.", "FILE")
@options.quiet
def view(layout_or_folder: str, spans: list[int] | None, output: str | None, quiet: bool) -> None:
    """Open the model of a LAYOUT, or of a run's FOLDER, in Exudyn's viewer; needs a screen."""
    from catenary_fe.engines.exudyn.viewer import require_screen, view_model

    require_screen()
    with working("form finding", not quiet):
        shape = _shape_of(layout_or_folder)
    say_lengths(shape, quiet)
    last = len(shape.catenary.spans)
    shown = spans or [min(2, last)]
    if not (min(shown) >= 1 and max(shown) <= last):
        raise InputError(f"spans {shown}: the line has spans 1 to {last}")
    if not (quiet or output):
        click.echo("Exudyn's viewer: mouse moves and turns, wheel zooms, Q or Escape closes.", err=True)
    picture = view_model(shape, (min(shown), max(shown)), wait=output is None)
    if output:
        save_picture(Path(output), picture)


def _shape_of(layout_or_folder: str) -> Shape:
    from catenary_fe.statics import find_form
    from catenary_fe.studies.rerun import shape_of

    path = Path(layout_or_folder)
    if path.is_dir() or path.suffix == ".nc":
        return shape_of(run_in(path))
    return find_form(load_catenary(path))


@click.command(epilog="\b\nExamples:\n  catenary-fe rerun run300\n  catenary-fe rerun run300 -o run300_again")
@options.folder
@options.answer()
def rerun(folder: str, answer: Answer) -> int:
    """Repeat the run in FOLDER from what it recorded, and say whether the result is the same.

    The inputs come from run.nc, library values filled in, not from the files beside it. Exit code 1 when mean
    or standard deviation of the contact force come out more than 0.1 N away.
    """
    from catenary_fe.studies.rerun import rerun

    run = run_in(folder)
    warnings = _changes_since(run, Path(folder))
    with output_folder(answer.folder) as target:
        with progress_bar(f"run at {3.6 * run.speed:g} km/h again", not answer.quiet) as progress:
            found = rerun(run, progress)
        if target:
            for file in (f for pattern in INPUTS for f in Path(folder).glob(pattern)):
                shutil.copyfile(file, target.path / file.name)
            again = found.again
            if run.elasticity is not None:
                again = with_elasticity(again, found.shape, answer.quiet)
            summary, rows = evaluated(again, *kept_evaluation(folder))
            write_run(target, found.shape, again, summary, rows)
    result = {
        "identical": found.identical,
        "largest_difference_of_contact_force_N": found.contact_force,
        "largest_difference_of_support_uplift_mm": 1e3 * found.support_uplift,
        "largest_difference_of_statistics_N": found.statistics,
        "warnings": warnings,
    }
    if answer.as_json:
        print_json(result)
    else:
        print_warnings(warnings)
        if not answer.quiet:
            click.echo(
                "the same to the last bit"
                if found.identical
                else f"mean and standard deviation within {found.statistics:.3g} N, the contact force within"
                f" {found.contact_force:.3g} N, the uplift at supports within"
                f" {1e3 * found.support_uplift:.3g} mm"
            )
    return 0 if found.statistics <= TOLERANCE else 1


def _changes_since(run: Run, folder: Path) -> list[str]:
    """Versions and files that changed since the run was computed."""
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
