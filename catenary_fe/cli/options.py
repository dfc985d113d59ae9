"""Arguments and options that several commands have, each declared once."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable, Sequence
from functools import wraps
from typing import TYPE_CHECKING, Any, get_args

import click
from click.shell_completion import CompletionItem

from catenary_fe.cli.terminal import Answer
from catenary_fe.layout import (
    Catenary,
    Conditions,
    DescribedPantograph,
    InputError,
    PowerSystem,
    counted,
    load_catenary,
    load_conditions,
    load_pantograph,
)
from catenary_fe.layout.conditions import one_of_a_run
from catenary_fe.layout.files import MOST_SPANS
from catenary_fe.results.signal import FilterKind

if TYPE_CHECKING:
    from catenary_fe.engines.settings import TimeSettings
    from catenary_fe.fe import MeshSettings

Decorator = Callable[[Any], Any]
_RANGE = re.compile(r"\s*(-?\d+)\s*(?:[-–]\s*(\d+)\s*)?")  # of spans; zero and less are refused by the line

_OF_FILES = ("layout", "names", "name", "conditions", "tables", "jobs", "output", "as_json", "quiet")
layout = click.argument("layout", type=click.Path())
folder = click.argument("folder", type=click.Path())
jobs = click.option("--jobs", type=click.IntRange(1), default=2, show_default=True, help="Processes.")
time_step = click.option(
    "--time-step-ms", type=float, default=1.0, show_default=True, help="Time step in ms."
)
element = click.option("--element-m", type=float, help="Largest element of the contact wire in m.")


def output(what: str, metavar: str = "DIR", **others: Any) -> Decorator:
    """``-o``, which names a folder or a file."""
    return click.option("-o", "--output", type=click.Path(), metavar=metavar, help=what, **others)


def criteria(what: str) -> Decorator:
    """``--criteria``, which names a power system."""
    systems = click.Choice(get_args(PowerSystem), case_sensitive=False)
    return click.option("--criteria", "system", type=systems, help=what)


def low_pass(what: str | None, **others: Any) -> Decorator:
    """``--filter``."""
    return click.option(
        "--filter", "filter_kind", type=click.Choice(get_args(FilterKind)), help=what, **others
    )


def flag(name: str, what: str, parameter: str | None = None) -> Decorator:
    """An option without a value."""
    return click.option(name, parameter or name[2:].replace("-", "_"), is_flag=True, help=what)


def method(*names: str, help: str | None = None) -> Decorator:
    """``--method``, the first one unless another is chosen."""
    return click.option("--method", type=click.Choice(names), default=names[0], show_default=True, help=help)


def answer(what: str = "Folder for results and pictures.", **others: Any) -> Decorator:
    """Options on where a command's results go; the command takes them as one ``answer``."""

    def decorated(command: Callable[..., Any]) -> Callable[..., Any]:
        @wraps(command)
        def with_answer(output: str | None, as_json: bool, quiet: bool, **given: Any) -> Any:
            return command(answer=Answer(output, as_json, quiet), **given)

        wrapped: Callable[..., Any] = output(what, **others)(as_json(quiet(with_answer)))
        return wrapped

    return decorated


def conditions(what: str, **others: Any) -> Decorator:
    """``--conditions``, which names a file."""
    return click.option("--conditions", type=click.Path(), metavar="FILE", help=what, **others)


def read_conditions(path: str) -> Conditions:
    """The circumstances of one run. Raises InputError for a file with several cases."""
    return one_of_a_run(load_conditions(path), path)


planar = flag("--planar", "Take the layout's equivalent in the vertical plane.")
as_json = flag("--json", "Print one JSON object and nothing else.", "as_json")
quiet = flag("--quiet", "No progress, no table.")


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


def _spans(what: str) -> Decorator:
    return click.option("--spans", callback=_span_numbers, help=what)


spans = _spans("Spans to evaluate, e.g. 5,6 or 5-17; unset: the layout's.")
shown_spans = _spans("Spans to show, e.g. 5,6 or 5-17; unset: around the evaluated ones.")
drawn_spans = _spans("Spans to draw, e.g. 5,6; unset: the line, and two spans closer.")


def read_layout(path: str, planar: bool) -> Catenary:
    """The catenary of a layout file, or its equivalent in the vertical plane. Raises InputError."""
    catenary = load_catenary(path)
    return catenary.planar() if planar else catenary


def pantograph_names(
    context: click.Context, parameter: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """The library's pantographs, and files."""
    from catenary_fe.layout import library

    begun = incomplete.strip("'\"").casefold()
    names = [name for name in library.names("pantographs") if name.casefold().startswith(begun)]
    return [CompletionItem(shlex.quote(name)) for name in names] + [CompletionItem(incomplete, type="file")]


pantographs = click.option(
    "--pantograph",
    "names",
    multiple=True,
    required=True,
    shell_complete=pantograph_names,
    help="Name in the library, or TOML file.",
)
positions = click.option(
    "--pantograph-at", "positions", multiple=True, type=float, help="Positions in m at the start."
)


def read_pantographs(names: tuple[str, ...], positions: tuple[float, ...]) -> list[DescribedPantograph]:
    """One pantograph a position; a single name serves for all positions. Raises InputError."""
    loaded = [load_pantograph(name) for name in names]
    if len(loaded) == 1 and len(positions) > 1:
        return loaded * len(positions)
    if len(loaded) > 1 and len(positions) not in (0, len(loaded)):
        raise InputError(
            f"{counted(len(positions), 'position')} for {len(loaded)} pantographs: give one for each"
        )
    return loaded


class ManyValues(click.Command):
    """A command some of whose options go on until the next option.

    many : names of those options
    numbers : they take numbers only, so that an argument after them is still seen as one
    """

    def __init__(self, *args: Any, many: Sequence[str] = (), numbers: bool = False, **others: Any) -> None:
        super().__init__(*args, **others)
        self._many, self._numbers = many, numbers

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        spread: list[str] = []
        option: str | None = None
        taken = 0
        for argument in args:
            is_option = argument.startswith("-") and not _is_number(argument)
            if is_option:
                option, taken = (argument if argument in self._many else None), 0
            elif option and self._numbers and not _is_number(argument):
                option = None
            elif option:
                taken += 1
                if taken > 1:
                    spread.append(option)
            spread.append(argument)
        return super().parse_args(ctx, spread)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def time_of(time_step_ms: float) -> TimeSettings:
    """Settings of the time integration by what :func:`time_step` takes."""
    from catenary_fe.engines.settings import TimeSettings

    return TimeSettings(step=time_step_ms / 1e3)


def mesh_of(element_m: float | None) -> MeshSettings:
    """Settings of the mesh by what :func:`element` takes; unset: the usual ones."""
    from catenary_fe.fe import MeshSettings

    return MeshSettings() if element_m is None else MeshSettings(contact_wire_element=element_m)


def given(context: click.Context) -> list[str]:
    """The options as they were given, but for files and what only concerns the output."""
    words: list[str] = []
    for option in context.command.params:
        name = option.name or ""
        is_given = context.get_parameter_source(name) is click.core.ParameterSource.COMMANDLINE
        if not is_given or name in _OF_FILES:
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
