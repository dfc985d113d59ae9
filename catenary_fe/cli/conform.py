"""The pack that an assessor asks for: one folder, one page, every number in a file."""

from __future__ import annotations

import hashlib
import platform
import shlex
import shutil
from collections.abc import Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from catenary_fe.cli import options
from catenary_fe.cli.design import elasticity_table, write_schedules
from catenary_fe.cli.folder import InputFiles, output_folder
from catenary_fe.cli.line_test import TestOptions, compare_line_test
from catenary_fe.cli.sweep import kept
from catenary_fe.cli.sweep_report import report_run
from catenary_fe.cli.sweep_table import keep_run
from catenary_fe.cli.terminal import Answer, print_json, print_table, progress_bar, working
from catenary_fe.layout import PowerSystem, load_pantograph
from catenary_fe.layout.rules import layout_warnings

if TYPE_CHECKING:
    from catenary_fe.statics import Shape
    from catenary_fe.studies.conform import Conformity, JudgedRun

EPILOG = """\b
Examples:
  catenary-fe conform LAYOUT --pantograph DSA380 --speed-kmh 250 300 -o conform
  catenary-fe conform LAYOUT --pantograph my.toml --speed-kmh 200 --criteria "DC 3 kV" \\
      --measured pass_1.csv --measured-speed-kmh 198 -o conform

\b
What was computed is kept: a command that was stopped goes on when it is started again with its folder."""

VERSIONS = ("catenary_fe", "exudyn", "numpy", "scipy", "numba")


@click.command(cls=options.ManyValues, many=("--speed-kmh", "--measured"), epilog=EPILOG)
@options.layout
@click.option("--pantograph", "name", required=True, help="Name in the library, or TOML file.")
@click.option("--speed-kmh", "speeds", multiple=True, type=float, required=True, help="Speeds in km/h.")
@click.option(
    "--distance-m", "distance", type=click.FloatRange(1.0), default=200.0, show_default=True,
    help="Distance of two pantographs in m.",
)  # fmt: skip
@options.criteria("Whose limits judge the runs; unset: AC.")
@options.conditions("Wind, ice and temperature that the line is under.")
@click.option(
    "--measured", "tables", multiple=True, type=click.Path(),
    help="Tables of a line test, compared with the run of one pantograph.",
)  # fmt: skip
@click.option("--map", "mapped", multiple=True, metavar="QUANTITY=HEADING", help="As of compare.")
@click.option("--measured-speed-kmh", type=float, help="As of compare; also which of the runs is compared.")
@options.flag("--measured-filtered", "As of compare.")
@options.time_step
@options.element
@options.spans
@click.option("--jobs", type=click.IntRange(1), help="Number of processes; unset: one a core.")
@options.answer("Folder of the pack.", required=True)
def conform(  # long: an argument an option
    layout: str,
    name: str,
    speeds: tuple[float, ...],
    distance: float,
    system: PowerSystem | None,
    conditions: str | None,
    tables: tuple[str, ...],
    mapped: tuple[str, ...],
    measured_speed_kmh: float | None,
    measured_filtered: bool,
    time_step_ms: float,
    element_m: float | None,
    spans: list[int] | None,
    jobs: int | None,
    answer: Answer,
) -> int:
    """Everything that an assessor asks for of a LAYOUT, in one folder with one page.

    The reference model of EN 50318:2002 and known answers on this installation; the line at rest; nonlinear
    runs of one and two pantographs at each speed, judged; the run nearest to a limit again with halved
    elements, halved steps and linearised; a line test beside it, if given. Exit code 1 where anything misses.
    """
    from catenary_fe.studies.conform import Asked
    from catenary_fe.studies.conform import conform as compute

    if not tables and (mapped or measured_speed_kmh is not None or measured_filtered):
        raise click.UsageError("--map, --measured-speed-kmh and --measured-filtered are of --measured tables")
    catenary = options.read_layout(layout, planar=False)
    if spans:
        catenary = catenary.replace(evaluated_spans=tuple(spans))
    asked = Asked(
        catenary=catenary,
        pantograph=load_pantograph(name),
        speeds_kmh=list(dict.fromkeys(speeds)),
        distance=distance,
        system=system or "AC",
        conditions=options.read_conditions(conditions) if conditions else None,
        time=options.time_of(time_step_ms),
        mesh=options.mesh_of(element_m),
    )
    output = str(answer.folder)
    files = InputFiles.read(layout, [name], conditions)
    with working("form finding", not answer.quiet):
        shape = asked.shape()
    with progress_bar("conformity", not answer.quiet) as progress, kept(output):
        found = compute(asked, shape, output, jobs=jobs or -1, progress=progress)
    measured = _compare(found, output, tables, TestOptions(
        mapped, None, measured_speed_kmh, None, None, measured_filtered, None))  # fmt: skip
    record = found.as_dict()
    record["verdicts"] += measured
    record["warnings"] = layout_warnings(catenary)
    record["inputs"] = _keep_inputs(output, files, tables, options.given(click.get_current_context()))
    with working("pictures", not answer.quiet):
        _write(output, found, shape, record)
    if answer.as_json:
        print_json(record)
    elif not answer.quiet:
        rows = [(row["part"], row["verdict"]) for row in record["verdicts"]]
        print_table(f"{catenary.name}: conformity", ("part", "verdict"), rows)
        click.echo(f"page and files in {output}: open report.html")
    return _said(record)


def _compare(
    found: Conformity, output: str, tables: Sequence[str], test: TestOptions
) -> list[dict[str, Any]]:
    """The line test beside the run of one pantograph at the nearest speed: the row of its verdict."""
    if not tables:
        return []
    alone = [run for run in found.runs if run.pantographs == 1 and not run.error]
    file = "measured/line_test.json"
    if not alone:
        said, passed, file = "no run to compare with", False, "conform.json"
    else:
        wanted = test.speed_kmh if test.speed_kmh is not None else alone[0].speed_kmh
        run = min(alone, key=lambda run: abs(run.speed_kmh - wanted))
        place = str(Path(output) / "measured")
        passed = compare_line_test(run.file, list(tables), "causal", test, Answer(place, False, True)) == 0
        said = f"deviations {'within' if passed else 'beyond'} EN 50318's limits (recalled), from {run.name}"
    return [{"part": "line test", "verdict": said, "passed": passed, "file": file}]


def _keep_inputs(
    output: str, files: InputFiles, tables: Sequence[str], options: Sequence[str]
) -> dict[str, Any]:
    """Copies of all that went in, with their checksums, and the command that makes the pack from them."""
    with output_folder(str(Path(output) / "inputs")) as folder:
        assert folder is not None
        words, sums = files.write(folder.path)
        for number, table in enumerate(tables, start=1):
            name = f"measured_{number}{Path(table).suffix}"
            shutil.copyfile(table, folder.path / name)
            sums[name] = hashlib.sha256((folder.path / name).read_bytes()).hexdigest()
            words += ["--measured", name]
        command = shlex.join(["catenary-fe", "conform", *words, *options, "-o", "../again"])
        found = {
            "command": command,
            "files_sha256": sums,
            "versions": {name: version(name) for name in VERSIONS},
            "python": platform.python_version(),
            "machine": platform.platform(),
        }
        folder.json("inputs.json", found)
    return found


def _write(output: str, found: Conformity, shape: Shape, record: dict[str, Any]) -> None:
    from catenary_fe.results import load_run
    from catenary_fe.studies.conform import slug
    from catenary_fe.views.report import conformity_page

    places = {f"runs/{run.name}": run for run in found.runs}
    places |= {f"refined/{slug(name)}": run for name, run in found.refined.items() if run not in found.runs}
    for place, run in places.items():
        if not run.error:
            keep_run(Path(output, place), run.file, run.summary | _criteria(found, run))
            report_run(Path(output, place))
    for speed, file in found.reference.items():
        if file:
            place = str(Path("reference", f"{speed}_kmh"))
            keep_run(Path(output, place), file, load_run(file).summary())
            report_run(Path(output, place))
    _write_static(str(Path(output) / "static"), found, shape, record["warnings"])
    with output_folder(output) as folder:
        assert folder is not None
        folder.json("conform.json", record)
        folder.table("selfcheck.csv", record["known_answers"])
        if found.ranges:
            folder.table("reference.csv", [row.as_dict() for row in found.ranges])
        rows = [{"run": run.name} | row.as_dict() for run in found.runs for row in run.criteria]
        if rows:
            folder.table("criteria.csv", [{k: "" if v is None else v for k, v in r.items()} for r in rows])
        columns = dict.fromkeys(key for row in record["refined"] for key in row)
        folder.table("refined.csv", [{k: row.get(k, "") for k in columns} for row in record["refined"]])
        folder.text("report.html", conformity_page(found, shape, record))


def _criteria(found: Conformity, run: JudgedRun) -> dict[str, Any]:
    return {
        "criteria_system": found.asked.system,
        "criteria": [row.as_dict() for row in run.criteria],
    }


def _write_static(output: str, found: Conformity, shape: Shape, warnings: Sequence[str]) -> None:
    from catenary_fe import views

    with output_folder(output) as folder:
        assert folder is not None
        folder.json(
            "static.json",
            {
                "checks": [check.as_dict() for check in found.static],
                "elasticity_force_N": found.curve.force,
                "elasticity_non_uniformity_percent": 100 * found.curve.non_uniformity,
                "warnings": list(warnings),
            },
        )
        folder.table("elasticity.csv", elasticity_table(found.curve, shape.catenary))
        write_schedules(folder, shape)
        folder.picture("layout.png", views.plot_layout(shape.catenary, shape))
        folder.picture("elasticity.png", views.plot_elasticity(found.curve))


def _said(record: dict[str, Any]) -> int:
    """What misses, on standard error; the exit code."""
    missed = [row for row in record["verdicts"] if not row["passed"]]
    for row in missed:
        click.echo(f"missed: {row['part']}: {row['verdict']}", err=True)
    return 1 if missed else 0
