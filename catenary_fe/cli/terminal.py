"""What the commands share: tables, progress, JSON."""

from __future__ import annotations

import json
import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from catenary_fe.cli.folder import Folder, output_folder
from catenary_fe.cli.surroundings import writes_unicode
from catenary_fe.layout import Catenary, CatenaryError
from catenary_fe.layout.rules import layout_warnings

if TYPE_CHECKING:
    from catenary_fe.fe import MeshSettings
    from catenary_fe.statics import Shape


@dataclass(frozen=True)
class Answer:
    """Where a command's results go: into a folder, and as JSON or as tables on standard output.

    folder : its path; unset: none
    as_json : JSON in place of tables, and nothing else
    quiet : neither tables nor progress
    """

    folder: str | None
    as_json: bool
    quiet: bool

    def show(self, result: dict[str, Any], tables: Callable[[], None], shape: Shape | None = None) -> None:
        """The result as JSON or as its tables, and its warnings; a note on given dropper lengths."""
        if self.as_json:
            print_json(result)
        elif not self.quiet:
            tables()
        if shape:
            say_lengths(shape, self.quiet)
        if not self.as_json:
            print_warnings(result["warnings"])


def print_json(value: Any) -> None:
    """One JSON document on standard output; it never contains NaN."""
    text = json.dumps(value, indent=2, allow_nan=False, ensure_ascii=False)
    try:
        text.encode(sys.stdout.encoding or "ascii")
    except UnicodeEncodeError:
        text = json.dumps(value, indent=2, allow_nan=False)
    click.echo(text)


def print_table(title: str, columns: Sequence[str], rows: Sequence[Sequence[Any]]) -> None:
    """A table on standard output; numbers are right-aligned."""
    from rich.console import Console
    from rich.table import Table

    table = Table(title=title, title_justify="left", title_style="bold")
    numeric = [all(_is_numeric(row[i]) for row in rows) for i in range(len(columns))]
    for name, right in zip(columns, numeric, strict=True):
        table.add_column(name, justify="right" if right else "left")
    for row in rows:
        table.add_row(*(_cell(value) for value in row))
    Console(width=None if sys.stdout.isatty() else 110).print(table)


def _is_numeric(value: Any) -> bool:
    try:
        float(value)
    except ValueError:
        return bool(value == "")
    return not isinstance(value, bool)


def _cell(value: Any) -> str:
    if isinstance(value, float):
        return f"{value:.4g}" if abs(value) < 1000 else f"{value:.1f}"
    return str(value)


def say(kind: str, text: str, colour: str) -> None:
    """One line on standard error, its first word in colour on a terminal (unless NO_COLOR is set)."""
    coloured = sys.stderr.isatty() and not os.environ.get("NO_COLOR")
    head = click.style(f"{kind}:", fg=colour, bold=True) if coloured else f"{kind}:"
    with suppress(OSError):  # there is nowhere else to say it
        click.echo(f"{head} {text}", err=True)


def say_lengths(shape: Shape, quiet: bool) -> None:
    """One line on standard error where a line hangs otherwise than its design does."""
    line = shape.catenary
    if (line.gives_dropper_lengths or line.departs_from_design) and not quiet:
        say("note", shape.lengths_note, "cyan")


def print_warnings(warnings: Sequence[str]) -> None:
    """One line each on standard error."""
    for warning in warnings:
        say("warning", warning, "yellow")


def working(text: str, shown: bool) -> AbstractContextManager[Any]:
    """A spinner on standard error for work of a few seconds, if that is a terminal."""
    if not shown or not sys.stderr.isatty():
        return nullcontext()
    from rich.console import Console

    spinner = "dots" if writes_unicode(sys.stderr) else "line"
    return Console(stderr=True).status(text, spinner=spinner)


@contextmanager
def warned(warnings: Sequence[str]) -> Iterator[None]:
    """If the work fails, say the warnings before the error: they may be its cause."""
    try:
        yield
    except CatenaryError:
        print_warnings(warnings)
        raise


def progress_lines(text: str, every: float = 30.0) -> Callable[[float], None]:
    """Progress for a log: share done and time left, at most one line every so many seconds."""
    begin = last = time.monotonic()

    def say(share: float) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= every and share < 1:
            last = now
            left = f", {(now - begin) * (1 / share - 1):.0f} s left" if share > 0 else ""
            click.echo(f"{text}: {100 * share:.0f} % after {now - begin:.0f} s{left}", err=True)

    return say


def said_of_compilation() -> str:
    """Words on the time that this process has compiled; none where that was a moment."""
    from catenary_fe.engines.compiled import compilation

    seconds = compilation.seconds
    return f"; before that, compiled for {seconds:.0f} s, once on this machine" if seconds > 1 else ""


@contextmanager
def progress_bar(text: str, shown: bool) -> Iterator[Callable[[float], None] | None]:
    """A progress bar with the time left on standard error; where that is not a terminal, occasional lines."""
    if not shown:
        yield None
        return
    if not sys.stderr.isatty():
        yield progress_lines(text)
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    from catenary_fe.engines.compiled import compilation

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task(text, total=1.0)
        compilation.told = lambda: bars.print("compiling, once on this machine: up to half a minute")
        try:
            yield lambda share: bars.update(task, completed=share)
        finally:
            compilation.told = None


@contextmanager
def static_shape(
    catenary: Catenary, answer: Answer, mesh: MeshSettings | None = None
) -> Iterator[tuple[Shape, Folder | None]]:
    """The line at rest and the output folder, which is filled when the work that follows is done.

    Raises InputError and SolverError, the layout's warnings said before them.
    """
    from catenary_fe.statics import find_form

    with warned(layout_warnings(catenary)), output_folder(answer.folder) as folder:
        with working("form finding", not answer.quiet):
            shape = find_form(catenary, mesh)
        yield shape, folder
