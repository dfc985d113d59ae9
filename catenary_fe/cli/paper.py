"""The paper's figures, each by a script of its own in ``models/paper`` of the checkout."""

from __future__ import annotations

import ast
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import TYPE_CHECKING

import click

from catenary_fe.cli.folder import writable_folder
from catenary_fe.cli.terminal import json_option, print_json, progress_bar, quiet_option
from catenary_fe.layout import InputError, counted
from catenary_fe.results.files import write_text

if TYPE_CHECKING:
    from catenary_fe.views.report.page import PageEntry

TITLE = "Selected problems of wave phenomena in catenaries: all figures, computed"
EPILOG = """\b
Examples:
  catenary-fe paper -o figures
  catenary-fe paper 5 8 dispersion"""


@click.command(epilog=EPILOG)
@click.argument("figures", nargs=-1, metavar="[FIGURE]...")
@click.option(
    "-o",
    "--output",
    type=click.Path(),
    default="out/paper",
    show_default=True,
    help="Folder for all pictures.",
)
@click.option("--jobs", type=click.IntRange(1), default=2, show_default=True, help="Processes.")
@json_option
@quiet_option
def paper(figures: tuple[str, ...], output: str, jobs: int, as_json: bool, quiet: bool) -> int:
    """Draw the figures of the paper from live computations, all of them or some, and an index page.

    FIGURE is a number (5), or part of a script's name (dispersion). Exit code 1 when a figure fails; the
    others are drawn all the same.
    """
    from catenary_fe.views.report.page import index_page

    scripts = chosen_scripts(_scripts_folder(), figures)
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


def _scripts_folder() -> Path:
    """The checkout's ``models/paper``: beside the working directory or beside the package."""
    for root in (Path.cwd(), Path(__file__).resolve().parents[2]):
        if (root / "models" / "paper" / "paper_common.py").is_file():
            return root / "models" / "paper"
    raise InputError("the paper's figures are part of the source checkout; run this command there")
