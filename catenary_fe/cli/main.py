"""The group of commands, and how errors leave the program."""

from __future__ import annotations

import logging
import os
import signal
import sys
from contextlib import suppress
from typing import Any

import click

from catenary_fe.cli.cases import cases
from catenary_fe.cli.conform import conform
from catenary_fe.cli.design import form, info, modes, static
from catenary_fe.cli.fmu import fmu
from catenary_fe.cli.layouts import layout
from catenary_fe.cli.optimise import optimise
from catenary_fe.cli.pantograph import pantograph
from catenary_fe.cli.program import completion, paper, schema, selfcheck, validate
from catenary_fe.cli.run import run
from catenary_fe.cli.scatter import scatter
from catenary_fe.cli.stored import compare, export, film, report, rerun, view, waves
from catenary_fe.cli.surroundings import leave, prepare
from catenary_fe.cli.sweep import sweep
from catenary_fe.cli.terminal import say
from catenary_fe.layout import CatenaryError, InputError, RunInterrupted, counted

EPILOG = """\b
Examples:
  catenary-fe info models/layouts/en50318_2002.toml
  catenary-fe form models/layouts/en50318_2002.toml -o form
  catenary-fe run models/layouts/en50318_2002.toml --pantograph "EN 50318:2002" --speed-kmh 300 -o run300
  catenary-fe report run300
  catenary-fe compare run250 run300

Exit codes: 0 good, 1 a criterion or a validation missed, 2 usage, 3 bad input, 4 solver, 130 or 143
stopped by Ctrl-C or SIGTERM."""

MOST_LINES = 20  # of one error: a slip in a span repeats in all spans like it


class _InOrder(click.Group):
    """Lists commands in the order of work, not of the alphabet."""

    def list_commands(self, context: click.Context) -> list[str]:
        return list(self.commands)


@click.group(
    cls=_InOrder,
    epilog=EPILOG,
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100},
)
@click.version_option(package_name="catenary_fe")
def commands() -> None:
    """Simulate railway catenaries and the pantographs that slide along them."""


_SHORT_HELP = {
    info: "Check a layout: wave speeds, masses, drawing.",
    layout: "Make layouts, from tables or by rules.",
    pantograph: "Own frequencies, receptance and static force of a pantograph.",
    form: "Dropper lengths and the static shape.",
    static: "Elasticity along the line.",
    cases: "The line under wind, ice and temperature.",
    modes: "Eigenfrequencies and mode shapes.",
    run: "Run pantographs along a layout.",
    sweep: "Runs over speeds, pantographs and values of a layout.",
    optimise: "Values of a line that make a figure the best.",
    scatter: "Samples of values that scatter, and what matters.",
    fmu: "The line for a co-simulation, as an FMU.",
    conform: "All that an assessor asks for of a line, in one folder.",
    report: "One HTML page of a run or a sweep, to read and hand on.",
    compare: "Runs side by side, or a run beside a line test.",
    film: "Film of a run, as GIF or MP4.",
    waves: "Waves of a run over place and time.",
    view: "The model in Exudyn's own viewer.",
    export: "Histories of a run as CSV files.",
    rerun: "Repeat a run from its folder.",
    paper: "The figures of the paper, computed and drawn.",
    validate: "Computed beside reference values.",
    selfcheck: "Whether this installation computes what it should.",
    schema: "JSON Schema of layout, pantograph, conditions and study files.",
    completion: "Completion script for the shell.",
}
for command, text in _SHORT_HELP.items():
    command.short_help = text
    commands.add_command(command)


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    logging.getLogger("catenary_fe").addHandler(logging.NullHandler())  # warnings are printed with results
    try:
        result = commands.main(arguments, prog_name="catenary-fe", standalone_mode=False)
        sys.stdout.flush()
        return result if isinstance(result, int) else 0
    except CatenaryError as error:
        lines = str(error).splitlines()
        for line in lines[:MOST_LINES]:
            say("error", line, "red")
        if len(lines) > MOST_LINES:
            say("error", f"and {counted(len(lines) - MOST_LINES, 'more fault')} like these", "red")
        return error.exit_code
    except click.ClickException as error:
        with suppress(OSError):  # there is nowhere else to say it
            error.show()
        return 2
    except (click.Abort, KeyboardInterrupt) as stopped:
        cause = stopped.__cause__ if isinstance(stopped, click.Abort) else stopped
        click.echo("interrupted", err=True)
        return cause.exit_code if isinstance(cause, RunInterrupted) else RunInterrupted().exit_code
    except BrokenPipeError:
        sys.stderr.close()
        return 0
    except OSError as error:
        say("error", f"{error.filename or 'output'}: {error.strerror or error}", "red")
        sys.stdout = open(os.devnull, "w")  # noqa: SIM115 what is left in the old one has nowhere to go
        return InputError.exit_code


def entry() -> None:
    """Entry point of the installed command."""
    prepare()
    signal.signal(signal.SIGTERM, _stop)
    code = main()
    leave()
    sys.exit(code)


def _stop(number: int, _frame: Any) -> None:
    """Stop as after Ctrl-C: unfinished files are removed, finished ones kept."""
    signal.signal(number, signal.SIG_IGN)  # once is enough
    raise RunInterrupted(number)
