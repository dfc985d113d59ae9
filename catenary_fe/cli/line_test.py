"""A run beside a line test: the part of ``compare`` whose second argument is a table of measurements."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Any

import click

from catenary_fe.cli.folder import output_folder, run_in
from catenary_fe.cli.surroundings import readable
from catenary_fe.cli.terminal import Answer, print_table, say, working
from catenary_fe.cli.verdicts import exit_code, kept_evaluation
from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import number, whole
from catenary_fe.results.signal import FilterKind

_OF_TESTS = "of a line test, and no table of measurements is given"


@dataclass(frozen=True)
class TestOptions:
    """What the command line says of a measurement; None and empty where it does not.

    mapped : texts such as "force[N]=CH7"
    shift_m, speed_kmh : in the units of their names
    support : number of the support whose uplift it is
    pantograph : number, from 1, of the pantograph that was measured
    is_filtered : whether the force was low-passed when it was measured
    scatter : folder of a scatter study
    """

    mapped: tuple[str, ...]
    shift_m: float | None
    speed_kmh: float | None
    support: int | None
    pantograph: int | None
    is_filtered: bool
    scatter: str | None

    def refuse(self) -> None:
        """Raises InputError where there are any, for a comparison of runs."""
        given = {
            "--map": self.mapped, "--shift-m": self.shift_m is not None,
            "--measured-speed-kmh": self.speed_kmh is not None, "--support": self.support is not None,
            "--pantograph": self.pantograph is not None, "--measured-filtered": self.is_filtered,
            "--scatter": self.scatter is not None,
        }  # fmt: skip
        if faults := [f"{name}: is {_OF_TESTS}" for name, there in given.items() if there]:
            raise InputError(*faults)

    @property
    def columns(self) -> dict[str, list[str]]:
        """Headings by quantity. Raises InputError for what names none."""
        found: dict[str, list[str]] = {}
        for text in self.mapped:
            key, equals, heading = text.partition("=")
            if not equals or not key.strip() or not heading.strip():
                raise InputError(f"--map {text}: must be QUANTITY=HEADING, such as 'force[N]=CH7'")
            found.setdefault(key.strip(), []).append(heading.strip())
        return found


def test_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Options of a line test; the command takes them as one ``test``."""

    @wraps(command)
    def with_options(
        mapped: tuple[str, ...], shift_m: float | None, measured_speed_kmh: float | None, support: int | None,
        pantograph: int | None, measured_filtered: bool, scatter: str | None, **given: Any,
    ) -> Any:  # fmt: skip
        test = TestOptions(
            mapped, shift_m, measured_speed_kmh, support, pantograph, measured_filtered, scatter
        )
        return command(test=test, **given)

    wrapped: Callable[..., Any] = with_options
    for option in reversed(_OPTIONS):
        wrapped = option(wrapped)
    return wrapped


_OPTIONS = (
    click.option("--map", "mapped", multiple=True, metavar="QUANTITY=HEADING",
                 help="Which column holds what, e.g. 'force[N]=CH7'; - for none; may be repeated."),
    click.option("--shift-m", type=float,
                 help="m to add to measured positions; unset: found by correlation of the forces."),
    click.option("--measured-speed-kmh", type=float,
                 help="Speed of the measured train, where the table does not say it; unset: the run's."),
    click.option("--support", type=click.IntRange(1), help="Support of an uplift whose heading names none."),
    click.option("--pantograph", type=click.IntRange(1), help="Which of the run's was measured; unset: 1."),
    click.option("--measured-filtered", is_flag=True,
                 help="The measured force was low-passed at 20 Hz already."),
    click.option("--scatter", type=click.Path(), metavar="FOLDER",
                 help="A scatter study's folder: does the measurement lie in its bands?"),
)  # fmt: skip


def compare_line_test(
    folder: str, files: Sequence[str], kind: FilterKind | None, test: TestOptions, answer: Answer
) -> int:
    """Compare the run in a folder with files of measurements; 1 where a limit is missed."""
    from catenary_fe.results.comparison import failed_checks
    from catenary_fe.results.criteria import criteria_table
    from catenary_fe.results.line_test import compare_with_line_test, read_line_test
    from catenary_fe.results.line_test.tables import all_tables

    run = run_in(folder)
    columns = test.columns
    speed = test.speed_kmh
    if speed is not None:
        number("--measured-speed-kmh", speed, "km/h", above=0.0)
    if test.pantograph is not None:
        whole("--pantograph", test.pantograph, least=1, most=run.data.sizes["pantograph"])
    measured = read_line_test(files, columns=columns, support=test.support)
    compared = compare_with_line_test(
        run,
        measured,
        shift=test.shift_m,
        speed=None if speed is None else speed / 3.6,
        pantograph=(test.pantograph or 1) - 1,
        filter=kind or kept_evaluation(folder)[0],
        is_filtered=test.is_filtered,
        scatter=test.scatter,
    )
    result = compared.as_dict()
    result["warnings"] = [*failed_checks([run], ["run"]), *compared.warnings]
    title = f"{readable(Path(folder).resolve().name)} and {', '.join(readable(Path(f).name) for f in files)}"
    with output_folder(answer.folder) as target, working("pictures", bool(target) and not answer.quiet):
        if target:
            from catenary_fe.views.line_test import plot_line_test
            from catenary_fe.views.report import line_test_page

            target.json("line_test.json", result)
            target.table("line_test.csv", _rows(result))
            target.picture("line_test.png", plot_line_test(compared))
            target.text("line_test.html", line_test_page(compared, title))

    def tables() -> None:
        for caption, table in all_tables(compared):
            print_table(caption, *table)
        print_table("deviations", *criteria_table(compared.criteria))

    answer.show(result, tables)
    if not (answer.quiet or answer.as_json):
        for note in compared.notes:
            say("note", note, "cyan")
    return exit_code(compared.criteria)


def _rows(result: dict[str, Any]) -> list[dict[str, Any]]:
    """Figures of run and passes, over all and by span, and uplifts: rows of one table."""
    whole = [("run", result["run"]), *((p["name"], p) for p in result["passes"])]
    spans = [
        (name, n["span"], n[key])
        for n in result["spans"]
        for name, key in (("run", "run"), ("all passes", "measured"))
    ]
    keys = [key for key in result["run"] if key.endswith(("_N", "_mm")) and result["run"][key] is not None]
    found = [
        {"of": name, "span": "", "support": ""} | {k: row.get(k, "") for k in keys} for name, row in whole
    ]
    found += [
        {"of": name, "span": n, "support": ""} | {k: row.get(k, "") for k in keys} for name, n, row in spans
    ]
    uplift = [
        {"of": name, "span": "", "support": row["support"], "uplift_mm": row[key]}
        for row in result["supports"]
        for name, key in (("run", "run_uplift_mm"), ("all passes", "measured_uplift_mm"))
    ]
    names = ["of", "span", "support", *keys, *(["uplift_mm"] if uplift else [])]
    return [{name: row.get(name, "") for name in names} for row in [*found, *uplift]]
