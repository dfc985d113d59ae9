"""Many runs at once: speeds, pantographs, and any values of the layout."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from typing import TYPE_CHECKING, Any

import click
import numpy as np

from catenary_fe.cli import options
from catenary_fe.cli.sweep_table import print_sweep, rows_of, sweep_record, write_sweep
from catenary_fe.cli.terminal import Answer, print_json, progress_bar, say
from catenary_fe.cli.verdicts import sweep_exit_code, verdict_of, warn_once
from catenary_fe.layout import Catenary, InputError, PowerSystem, counted
from catenary_fe.layout.variation import CONDITIONS, PANTOGRAPH, Variable, kind_of, varied_pantograph

if TYPE_CHECKING:
    from catenary_fe.studies.sweep import BrokenCase, SweepCase

EPILOG = """\b
Examples:
  catenary-fe sweep LAYOUT --speed-kmh 200:320:10 --pantograph "EN 50318:2002" -o sweep
  catenary-fe sweep LAYOUT --speed-kmh 250 275 300 --pantograph DSA380 "SSS400+" -o sweep
  catenary-fe sweep LAYOUT --speed-kmh 300 --pantograph DSA380 --vary contact_wire.tension=20e3:30e3:6 \\
      --vary span.*.pre_sag=0:0.03:4 -o sweep

\b
--speed-kmh and --distance-m take numbers, or first:last:step. --vary takes PLACE=first:last:count or
PLACE=a,b,c; a place is written as in the layout file with dots between tables, numbers (from 1) or * for
members of a list; values of the pantograph start with 'pantograph.', those of the conditions with
'conditions.', whether there is a file of them or not. All combinations are run.
A sweep that was stopped goes on when it is started again with the same folder. 'catenary-fe report DIR' makes
one page of it."""

_MOST = 100_000
DISTANCE, DIRECTION, DIRECTIONS = "distance_m", "direction", ("forward", "backward")


@click.command(
    cls=options.ManyValues,
    many=("--speed-kmh", "--pantograph", "--vary", "--pantograph-at", "--distance-m", "--direction"),
    epilog=EPILOG,
)
@options.layout
@click.option("--speed-kmh", "speeds", multiple=True, required=True, help="Speeds, or first:last:step.")
@click.option(
    "--pantograph", "names", multiple=True, required=True, help="Names in the library, or TOML files."
)
@click.option(
    "--pantograph-at", "positions", multiple=True, type=float,
    help="Positions in m at the start: each case runs one pantograph at each.",
)  # fmt: skip
@click.option(
    "--distance-m",
    "distances",
    multiple=True,
    help="Distances of two pantographs, or first:last:step; the rear one starts where one alone does.",
)
@click.option(
    "--direction", "directions", multiple=True, type=click.Choice(DIRECTIONS),
    help="Run along the line, or from its other end.",
)  # fmt: skip
@click.option("--vary", "variations", multiple=True, metavar="PLACE=VALUES", help="Vary a value.")
@options.conditions("Wind, ice and temperature that the line is under.")
@options.flag("--keep-force", "Write the contact force along the evaluated spans, too: force.csv.")
@options.flag("--keep-runs", "Keep each run whole, too, in runs/NUMBER; report makes a page of each.")
@options.method("linearised", "nonlinear", "exudyn")
@options.time_step
@options.element
@options.spans
@options.criteria("Judge the cases by the limits of this system; exit code 1 where one misses any.")
@click.option("--jobs", type=click.IntRange(1), help="Number of processes; unset: one a core.")
@click.option("--scheduler", metavar="ADDRESS", help="Run on the Dask cluster at this address.")
@options.flag("--retry-failed", "Run failed cases of an earlier start again.")
@options.answer("Folder for table and pictures.", required=True)
def sweep(  # long: an argument an option
    layout: str,
    speeds: tuple[str, ...],
    names: tuple[str, ...],
    positions: tuple[float, ...],
    distances: tuple[str, ...],
    directions: tuple[str, ...],
    variations: tuple[str, ...],
    conditions: str | None,
    keep_force: bool,
    keep_runs: bool,
    method: Any,
    time_step_ms: float,
    element_m: float | None,
    spans: list[int] | None,
    system: PowerSystem | None,
    jobs: int | None,
    scheduler: str | None,
    retry_failed: bool,
    answer: Answer,
) -> int:
    """Run a LAYOUT at many speeds, with many pantographs and values: one table, and pictures."""
    from catenary_fe.studies.sweep import LOST, SweepSettings, run_sweep

    output = str(answer.folder)
    if jobs and scheduler:
        raise click.UsageError("--jobs and --scheduler: the cluster has its own processes; give one of them")
    axes = _axes(speeds, names, distances, directions, positions)
    axes |= dict(_variation(text) for text in variations)
    count = math.prod(len(values) for values in axes.values())
    if count > _MOST:
        raise InputError(f"sweep: {count} cases are more than {_MOST}; take fewer values")
    settings = SweepSettings(
        method=method,
        mesh=options.mesh_of(element_m),
        time=options.time_of(time_step_ms),
        keep_force=keep_force,
        keep_runs=keep_runs,
    )
    cases = _cases(Variable(layout, conditions), axes, positions, spans)
    with progress_bar(counted(count, "case"), not answer.quiet) as progress, kept(output):
        records = run_sweep(
            cases,
            settings,
            output,
            jobs=jobs or -1,
            scheduler=scheduler,
            retry=retry_failed,
            progress=(lambda done, all_: progress(done / all_)) if progress else None,
        )
    verdicts = [verdict_of(record, case, system) for record, case in zip(records, cases, strict=True)]
    made = sweep_record(cases, records, verdicts, settings, system, axes)
    write_sweep(output, made, verdicts, records)
    if answer.as_json:
        print_json(rows_of(made))
    elif not answer.quiet:
        print_sweep(made)
        for words in made["said"]:
            click.echo(words)
        click.echo(f"table and pictures in {output}")
    if not answer.quiet:
        _say_lengths(cases)
    if not answer.as_json:
        warn_once(verdicts)
    failed = [record for record in records if "error" in record]
    for record in failed:
        said = ", ".join(f"{name} = {value}" for name, value in record["values"].items())
        click.echo(f"failed: {said}: {record['error']}", err=True)
    lost = [record for record in failed if LOST in record]
    if lost:
        click.echo(
            f"lost with their processes: {len(lost)} of {counted(len(records), 'case')}; the others are kept"
            f" in {output}: start again to try the lost ones once more",
            err=True,
        )
    if failed and (lost or len(failed) == len(records)):
        raise click.exceptions.Exit((lost or failed)[0]["exit_code"])
    return sweep_exit_code(verdicts, system)


def _say_lengths(cases: Sequence[SweepCase | BrokenCase]) -> None:
    """One line on standard error where cases hang with dropper lengths that their layout gives."""
    from catenary_fe.studies.sweep import SweepCase

    given = sum(isinstance(case, SweepCase) and case.catenary.gives_dropper_lengths for case in cases)
    if given:
        what = f"{given} of {len(cases)} cases are hung with dropper lengths that the layout gives"
        say("note", what, "cyan")


@contextmanager
def kept(output: str) -> Iterator[None]:
    """Say what a stopped sweep or study leaves behind."""
    try:
        yield
    except KeyboardInterrupt:
        click.echo(f"stopped: finished cases are kept in {output}; start again to go on", err=True)
        raise


def _axes(
    speeds: Sequence[str],
    names: Sequence[str],
    distances: Sequence[str],
    directions: Sequence[str],
    positions: Sequence[float],
) -> dict[str, list[Any]]:
    """Values by what each case has one of."""
    found: dict[str, list[Any]] = {"speed_kmh": _numbers("--speed-kmh", speeds), "pantograph": list(names)}
    if distances and len(positions) > 1:
        raise click.UsageError("--distance-m and --pantograph-at: give one position at most, the rear one's")
    if distances:
        found[DISTANCE] = _numbers("--distance-m", distances)
    if directions:
        found[DIRECTION] = list(dict.fromkeys(directions))
    return found


def _numbers(option: str, texts: Sequence[str]) -> list[float]:
    values: list[float] = []
    for text in texts:
        parts = [_number(part, option, text) for part in text.split(":")]
        if len(parts) == 1:
            values += parts
            continue
        if len(parts) != 3 or parts[2] <= 0 or parts[1] < parts[0]:
            raise click.BadParameter(f"{option} {text}: must be a number or first:last:step, rising")
        count = int(np.floor((parts[1] - parts[0]) / parts[2] + 1e-9)) + 1
        values += [round(parts[0] + i * parts[2], 9) for i in range(count)]
    return list(dict.fromkeys(values))


def _variation(text: str) -> tuple[str, list[Any]]:
    place, equals, values = text.partition("=")
    if not (place and equals and values):
        raise click.BadParameter(f"--vary {text}: must be PLACE=first:last:count or PLACE=a,b,c")
    if values.count(":") == 2:
        first, last, count = (_number(part, "--vary", text) for part in values.split(":"))
        if count != int(count) or count < 1:
            raise click.BadParameter(f"--vary {text}: the count must be a whole number of at least 1")
        return place, [float(f"{v:.12g}") for v in np.linspace(first, last, int(count))]
    return place, [_value(part) for part in values.split(",")]


def _value(text: str) -> Any:
    """A number, true, false, or a text. Whole numbers stay so: a seed is none otherwise."""
    if text in ("true", "false"):
        return text == "true"
    try:
        return int(text) if text.strip().lstrip("+-").isdecimal() else float(text)
    except ValueError:
        return text


def _number(text: str, option: str, whole: str) -> float:
    value = _value(text)
    if isinstance(value, bool | str) or not np.isfinite(value):
        raise click.BadParameter(f"{option} {whole}: {text!r} is not a number")
    return float(value)


def _cases(
    variable: Variable, axes: dict[str, list[Any]], positions: tuple[float, ...], spans: list[int] | None
) -> list[SweepCase | BrokenCase]:
    """All combinations. Raises the first one's InputError if none of them can be run."""
    from catenary_fe.studies.sweep import BrokenCase, SweepCase

    @cache
    def catenary(varied: tuple[tuple[str, Any], ...]) -> Catenary:
        made = variable.catenary(dict(varied))
        return made.replace(evaluated_spans=tuple(spans)) if spans else made

    backward = cache(lambda line: line.mirrored())
    weather = cache(lambda varied: variable.conditions(dict(varied)))
    pantograph = cache(lambda name, varied: varied_pantograph(name, dict(varied)))
    cases: list[SweepCase | BrokenCase] = []
    own = ("speed_kmh", "pantograph", DISTANCE, DIRECTION)
    for combination in itertools.product(*axes.values()):
        values = dict(zip(axes, combination, strict=True))
        of_line, of_head, of_day = (
            tuple(item for item in values.items() if item[0] not in own and kind_of(item[0]) == kind)
            for kind in ("", PANTOGRAPH, CONDITIONS)
        )
        try:
            line, day = catenary(of_line), weather(of_day)
            head = pantograph(values["pantograph"], of_head)
        except InputError as error:
            cases.append(BrokenCase(values=values, error=error))
            continue
        if values.get(DIRECTION) == DIRECTIONS[1]:
            line = backward(line)
        starts = _starts(line, positions, values.get(DISTANCE))
        case = SweepCase(
            values=values,
            catenary=line,
            pantographs=(head,) * max(1, len(starts)),
            speed=values["speed_kmh"] / 3.6,
            positions=starts,
            conditions=day,
        )
        cases.append(case)
    faults = [case.error for case in cases if isinstance(case, BrokenCase)]
    if len(faults) == len(cases):
        raise faults[0]
    return cases


def _starts(line: Catenary, positions: tuple[float, ...], distance: float | None) -> tuple[float, ...]:
    """[m] of the pantographs; of two at a distance [m], the front one first."""
    from catenary_fe.studies.checks import two_apart

    if distance is None:
        return positions
    return two_apart(line, distance, positions[0] if positions else None)
