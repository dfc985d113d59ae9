"""What the commands share: tables, progress, JSON, options."""

from __future__ import annotations

import json
import os
import re
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from typing import TYPE_CHECKING, Any

import click

from catenary_fe.cli.surroundings import writes_unicode
from catenary_fe.layout import Catenary, CatenaryError, load_catenary
from catenary_fe.layout.files import MOST_SPANS

_RANGE = re.compile(r"\s*(-?\d+)\s*(?:[-–]\s*(\d+)\s*)?")  # of spans; zero and less are refused by the line

if TYPE_CHECKING:
    from catenary_fe.statics import Shape

layout_argument = click.argument("layout", type=click.Path())
planar_option = click.option(
    "--planar", is_flag=True, help="Take the layout's equivalent in the vertical plane."
)
json_option = click.option("--json", "as_json", is_flag=True, help="Print one JSON object and nothing else.")
quiet_option = click.option("--quiet", is_flag=True, help="No progress, no table.")
output_option = click.option(
    "-o", "--output", type=click.Path(), metavar="DIR", help="Folder for results and pictures."
)


def _span_numbers(context: click.Context, parameter: click.Parameter, text: str | None) -> list[int] | None:
    """Numbers and ranges, each span once, in the order given."""
    if text is None:
        return None
    numbers: dict[int, None] = {}
    for part in text.split(","):
        found = _RANGE.fullmatch(part)
        first, last = (int(found[1]), int(found[2] or found[1])) if found else (1, 0)
        if not 0 <= last - first < MOST_SPANS:
            raise click.BadParameter(
                f"{text!r} is not a list of spans or rising ranges such as 5,6 or 5-17,20"
            )
        numbers |= dict.fromkeys(range(first, last + 1))
    return list(numbers)


spans_option = click.option(
    "--spans", callback=_span_numbers, help="Spans to evaluate, e.g. 5,6 or 5-17; unset: the layout's."
)
shown_spans_option = click.option(
    "--spans",
    callback=_span_numbers,
    help="Spans to show, e.g. 5,6 or 5-17; unset: around the evaluated ones.",
)
drawn_spans_option = click.option(
    "--spans", callback=_span_numbers, help="Spans to draw, e.g. 5,6; unset: the line, and two spans closer."
)


def read_layout(path: str, planar: bool) -> Catenary:
    """The catenary of a layout file, or its equivalent in the vertical plane. Raises InputError."""
    catenary = load_catenary(path)
    return catenary.planar() if planar else catenary


def print_json(value: Any) -> None:
    """One JSON document on standard output; not-a-number never appears in it."""
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
    """One line on standard error where a line hangs with dropper lengths that its layout gives."""
    if shape.catenary.gives_dropper_lengths and not quiet:
        say("note", shape.lengths_note, "cyan")


def print_warnings(warnings: Sequence[str]) -> None:
    """One line each on standard error."""
    for warning in warnings:
        say("warning", warning, "yellow")


def working(text: str, shown: bool) -> AbstractContextManager[Any]:
    """A sign of life on standard error for work of a few seconds, if that is a terminal."""
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
    """What tells a log that long work goes on: share done and time left, at most so often in s."""
    begin = last = time.monotonic()

    def say(share: float) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= every and share < 1:
            last = now
            left = f", {(now - begin) * (1 / share - 1):.0f} s left" if share > 0 else ""
            click.echo(f"{text}: {100 * share:.0f} % after {now - begin:.0f} s{left}", err=True)

    return say


@contextmanager
def progress_bar(text: str, shown: bool) -> Iterator[Callable[[float], None] | None]:
    """A progress bar with the time left on standard error; where that is no terminal, a line now and then."""
    if not shown:
        yield None
        return
    if not sys.stderr.isatty():
        yield progress_lines(text)
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(), TimeElapsedColumn(), TimeRemainingColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task(text, total=1.0)
        yield lambda share: bars.update(task, completed=share)
