"""Commands about the program itself: validation, the paper's figures, known answers, schemas, completion."""

from __future__ import annotations

import ast
import importlib
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.shell_completion import get_completion_class

from catenary_fe.cli import options
from catenary_fe.cli.folder import writable_folder
from catenary_fe.cli.terminal import print_json, print_table, progress_bar
from catenary_fe.layout import InputError, counted
from catenary_fe.results.files import write_text

if TYPE_CHECKING:
    from catenary_fe.views.report.page import PageEntry

_COLUMNS = ("case", "engine", "quantity", "computed", "reference", "error", "tolerance", "passed")
TITLE = "Selected problems of wave phenomena in catenaries: all figures, computed"
PAPER_EPILOG = """\b
Examples:
  catenary-fe paper -o figures
  catenary-fe paper 5 8 dispersion"""


@click.command(epilog="\b\nExample:\n  catenary-fe validate --quick")
@click.argument("cases", nargs=-1)
@options.flag("--quick", "Only what takes seconds.")
@options.jobs
@options.as_json
@options.quiet
def validate(cases: tuple[str, ...], quick: bool, jobs: int, as_json: bool, quiet: bool) -> int:
    """Compare computed with reference values; exit code 1 when a case misses."""
    folder = _of_checkout("validation/__init__.py", "the validation suite is")
    if str(folder.parent) not in sys.path:
        sys.path.insert(0, str(folder.parent))
    suite = importlib.import_module("validation")
    report = None if cases or quick else writable_folder(str(folder))
    with progress_bar("validation", not quiet) as progress:
        checks = suite.run_cases(list(cases) or None, quick=quick, jobs=jobs, progress=progress)
    if report:
        suite.write_report(checks, report)
    rows = [asdict(check) for check in checks]
    if as_json:
        keys = (
            "case",
            "engine",
            "quantity",
            "computed",
            "reference",
            "error",
            "tolerance",
            "source",
            "passed",
        )
        print_json([{key: row[key] for key in keys} for row in rows])
    elif not quiet:
        print_table("validation", _COLUMNS, [[row[key] for key in _COLUMNS] for row in rows])
    verdicts = [row["passed"] for row in rows]
    passed, missed = verdicts.count(True), verdicts.count(False)
    click.echo(f"{passed} passed, {missed} missed, {verdicts.count(None)} not judged", err=True)
    return 1 if missed else 0


@click.command(epilog="\b\nExample:\n  catenary-fe selfcheck")
@options.as_json
@options.quiet
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
            (c.name, f"{c.computed:.6g}", f"{c.reference:.6g}", c.unit, f"{c.error:.1e}", f"{c.tolerance:g}",
             "yes" if c.passed else "NO")
            for c in checks
        ]  # fmt: skip
        print_table("selfcheck", columns, rows)
    missed = sum(not c.passed for c in checks)
    click.echo(f"{len(checks) - missed} passed, {missed} missed", err=True)
    return 1 if missed else 0


@click.command(epilog="\b\nExample:\n  catenary-fe schema layout > layout.schema.json")
@click.argument("kind", type=click.Choice(["layout", "pantograph", "conditions", "study"]))
def schema(kind: str) -> None:
    """Print the JSON Schema with which an editor completes and checks files of this kind."""
    from catenary_fe.layout import conditions_schema, layout_schema, pantograph_schema, study_schema

    made = {
        "layout": layout_schema,
        "pantograph": pantograph_schema,
        "conditions": conditions_schema,
        "study": study_schema,
    }
    print_json(made[kind]())


@click.command(
    epilog="\b\nExamples:\n  catenary-fe completion bash >> ~/.bash_completion\n"
    "  catenary-fe completion zsh > ~/.zfunc/_catenary-fe\n"
    "  catenary-fe completion fish > ~/.config/fish/completions/catenary-fe.fish"
)
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
@click.pass_context
def completion(context: click.Context, shell: str) -> None:
    """Print the script with which a SHELL completes commands, options, files and library names."""
    made = get_completion_class(shell)
    assert made is not None
    root = context.find_root()
    click.echo(made(root.command, {}, "catenary-fe", "_CATENARY_FE_COMPLETE").source())


@click.command(epilog=PAPER_EPILOG)
@click.argument("figures", nargs=-1, metavar="[FIGURE]...")
@options.output("Folder for all pictures.", "PATH", default="out/paper", show_default=True)
@options.jobs
@options.as_json
@options.quiet
def paper(figures: tuple[str, ...], output: str, jobs: int, as_json: bool, quiet: bool) -> int:
    """Draw the figures of the paper from live computations, all of them or some, and an index page.

    FIGURE is a number (5), or part of a script's name (dispersion). Exit code 1 when a figure fails; the
    others are drawn all the same.
    """
    from catenary_fe.views.report.page import index_page

    scripts = chosen_scripts(_of_checkout("models/paper/paper_common.py", "the paper's figures are"), figures)
    folder = writable_folder(output)

    def say(text: str) -> None:
        if not (quiet or as_json):
            click.echo(text, err=True)

    with progress_bar("figures of the paper", not quiet) as progress:
        entries = draw_all(scripts, folder, jobs, progress, say)
    write_text(folder / "index.html", index_page(TITLE, entries))
    failed = [entry.name for entry in entries if entry.failure]
    if as_json:
        drawn = {e.name: {"caption": e.caption, "numbers": e.numbers} for e in entries if not e.failure}
        print_json({"figures": drawn, "failed": {e.name: e.failure for e in entries if e.failure}})
    elif not quiet:
        click.echo(
            f"{counted(len(entries) - len(failed), 'figure')} drawn, {len(failed)} failed:"
            f" {folder / 'index.html'}"
        )
    return 1 if failed else 0


def chosen_scripts(folder: Path, wanted: tuple[str, ...]) -> list[Path]:
    """Scripts by number or part of their name, in the paper's order. Raises InputError for others."""
    scripts = sorted([*folder.glob("fig*.py"), *folder.glob("text_*.py")])
    if not wanted:
        return scripts
    chosen: set[Path] = set()
    for word in wanted:
        stem = f"fig{int(word):02d}_" if word.isdecimal() else word.removesuffix(".py")
        found = [s for s in scripts if stem in s.stem]
        if not found:
            names = ", ".join(s.stem for s in scripts)
            raise InputError(f"figure {word}: there is none; give a number or part of a name of: {names}")
        chosen.update(found)
    return [s for s in scripts if s in chosen]


def draw_all(
    scripts: list[Path],
    folder: Path,
    jobs: int,
    progress: Callable[[float], None] | None,
    say: Callable[[str], None],
) -> list[PageEntry]:
    """Run the scripts, so many at a time, each in a process of its own that leaves the others alone."""
    entries: dict[Path, PageEntry] = {}
    with ThreadPoolExecutor(jobs) as pool:
        running = {pool.submit(draw, script, folder): script for script in scripts}
        try:
            for future in as_completed(running):
                script = running[future]
                entries[script], seconds = future.result()
                outcome = "FAILED" if entries[script].failure else "drawn"
                say(f"[{len(entries)}/{len(scripts)}] {script.stem}: {outcome} in {seconds:.0f} s")
                if progress:
                    progress(len(entries) / len(scripts))
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise
    return [entries[script] for script in scripts]


def draw(script: Path, folder: Path) -> tuple[PageEntry, float]:
    """Run one script; returns what the page shows of it, and the seconds it took."""
    from catenary_fe.views.report.page import PageEntry

    picture, facts = folder / f"{script.stem}.png", folder / f"{script.stem}.json"
    for old in (picture, facts):
        old.unlink(missing_ok=True)
    # one thread each: the processes share the machine
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    begin = time.perf_counter()
    done = subprocess.run(
        [sys.executable, str(script), str(folder)], capture_output=True, text=True, env=environment
    )
    seconds = time.perf_counter() - begin
    title = script_title(script)
    if done.returncode or not (picture.is_file() and facts.is_file()):
        failure = done.stderr.strip()[-2000:] or f"ended with code {done.returncode} and drew nothing"
        return PageEntry(script.stem, title, failure=failure), seconds
    said = json.loads(facts.read_text(encoding="utf-8"))
    return PageEntry(script.stem, title, said["caption"], said["numbers"]), seconds


def script_title(script: Path) -> str:
    """First line of a script's docstring."""
    try:
        text = ast.get_docstring(ast.parse(script.read_text(encoding="utf-8")))
    except SyntaxError:
        text = None
    return text.splitlines()[0] if text else script.stem


def _of_checkout(file: str, what: str) -> Path:
    """The folder of a file of the source checkout: beside the working directory or beside the package."""
    for root in (Path.cwd(), Path(__file__).resolve().parents[2]):
        if (root / file).is_file():
            return (root / file).parent
    raise InputError(f"{what} part of the source checkout; run this command there")
