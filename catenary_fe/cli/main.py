"""The group of commands, and how errors leave the program."""

from __future__ import annotations

import logging
import sys

import click

from catenary_fe.cli.design import form, info, static
from catenary_fe.cli.modes import modes
from catenary_fe.cli.paper import paper
from catenary_fe.cli.run import run
from catenary_fe.cli.schema import schema
from catenary_fe.cli.sweep import sweep
from catenary_fe.cli.validate import validate
from catenary_fe.system import CatenaryError

EPILOG = """\b
Examples:
  catenary-fe info models/layouts/en50318_2002.toml
  catenary-fe form models/layouts/en50318_2002.toml -o form
  catenary-fe run models/layouts/en50318_2002.toml --pantograph "EN 50318:2002" --speed-kmh 300 -o run300

Exit codes: 0 good, 1 a criterion or a validation missed, 2 usage, 3 bad input, 4 solver."""

MOST_LINES = 20  # of one error: a slip in a span repeats in all spans like it


@click.group(
    epilog=EPILOG, context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100}
)
@click.version_option(package_name="catenary_fe")
def commands() -> None:
    """Simulate railway catenaries and the pantographs that slide along them."""


for command in (info, form, static, modes, run, sweep, paper, validate, schema):
    commands.add_command(command)


def main(arguments: list[str] | None = None) -> int:
    """Run the command line; returns the exit code."""
    logging.getLogger("catenary_fe").addHandler(logging.NullHandler())  # warnings are printed with results
    try:
        result = commands.main(arguments, prog_name="catenary-fe", standalone_mode=False)
        return result if isinstance(result, int) else 0
    except CatenaryError as error:
        lines = str(error).splitlines()
        for line in lines[:MOST_LINES]:
            click.echo(f"error: {line}", err=True)
        if len(lines) > MOST_LINES:
            click.echo(f"error: and {len(lines) - MOST_LINES} more faults like these", err=True)
        return error.exit_code
    except click.ClickException as error:
        error.show()
        return 2
    except (click.Abort, KeyboardInterrupt):
        click.echo("interrupted", err=True)
        return 130
    except BrokenPipeError:
        sys.stderr.close()
        return 0


def entry() -> None:
    """Entry point of the installed command."""
    sys.exit(main())
