"""What differs between a terminal and a pipe, and completion in the shell."""

import os
import pty
import re
import select
import subprocess
import sys

import click
import pytest

from catenary_fe.cli import main
from catenary_fe.cli.options import _span_numbers


def at_a_terminal(arguments, **environment):
    """Everything that a command prints at a terminal of 80 columns, in its order."""
    leader, follower = pty.openpty()
    variables = {k: v for k, v in os.environ.items() if k != "NO_COLOR"}
    process = subprocess.Popen(
        [sys.executable, "-m", "catenary_fe", *arguments],
        stdin=follower, stdout=follower, stderr=follower,
        env=variables | {"COLUMNS": "80", "TERM": "xterm"} | environment,
    )  # fmt: skip
    os.close(follower)
    said = b""
    while process.poll() is None or select.select([leader], [], [], 0)[0]:
        try:
            if select.select([leader], [], [], 0.1)[0]:
                said += os.read(leader, 65536)
        except OSError:  # the process has closed its end
            break
    os.close(leader)
    return said.decode("utf-8")


def plain(said):
    """Without colours and movements of the cursor."""
    return re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", said)


def test_colour_at_a_terminal_only():
    assert "\x1b[31m\x1b[1merror:\x1b[0m nowhere.toml" in at_a_terminal(["info", "nowhere.toml"])
    assert "\x1b" not in at_a_terminal(["info", "nowhere.toml"], NO_COLOR="1")


def test_tables_fit_and_progress_is_shown(reference_layout):
    said = at_a_terminal(["info", str(reference_layout)], NO_COLOR="1")
    assert "messenger wire: tension kN" in said
    assert max(len(line) for line in plain(said).splitlines()) == 80
    said = plain(at_a_terminal(["static", str(reference_layout), "--spans", "5"]))
    assert "form finding" in said
    assert re.search(r"elasticity ━+ \d:\d\d:\d\d \d:\d\d:\d\d", said)  # time spent, time left
    said = at_a_terminal(["static", str(reference_layout), "--spans", "5", "--quiet"])
    assert said == ""


@pytest.mark.parametrize("shell", ["bash", "zsh", "fish"])
def test_completion_scripts(capsys, shell):
    assert main(["completion", shell]) == 0
    assert "_CATENARY_FE_COMPLETE" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("words", "number", "offered"),
    [
        ("catenary-fe re", 1, {"plain,report", "plain,rerun"}),
        ("catenary-fe run LAYOUT --pantograph EN", 4,
         {"plain,'EN 50318:2002'", "plain,'EN 50318:2018 AC'", "file,EN"}),
        ("catenary-fe waves run300 --quantity d", 4, {"plain,deflection"}),
    ],
)  # fmt: skip
def test_completion(words, number, offered):
    environment = os.environ | {
        "_CATENARY_FE_COMPLETE": "bash_complete", "COMP_WORDS": words, "COMP_CWORD": str(number),
    }  # fmt: skip
    program = "import sys; sys.argv[0] = 'catenary-fe'; from catenary_fe.cli.main import entry; entry()"
    done = subprocess.run(
        [sys.executable, "-c", program], env=environment, capture_output=True, text=True, check=False
    )
    assert set(done.stdout.split("\n")) - {""} == offered


def test_every_command_has_an_example_and_the_group_lists_them_in_order(capsys):
    from catenary_fe.cli.main import commands

    for name in commands.commands:
        assert main([name, "--help"]) == 0
        assert f"catenary-fe {name}" in capsys.readouterr().out
    main(["--help"])
    said = capsys.readouterr().out
    assert said.index("  info ") < said.index("  run ") < said.index("  report ") < said.index("  validate ")
    assert "..." not in said.split("Commands:")[1]


@pytest.mark.parametrize(
    ("text", "numbers"),
    [("5", [5]), ("5,6", [5, 6]), ("5-8", [5, 6, 7, 8]), (" 7 - 9, 3 ,8", [7, 8, 9, 3]), (None, None)],
)
def test_spans_are_numbers_and_ranges(text, numbers):
    assert spans_option_value(text) == numbers


@pytest.mark.parametrize("text", ["", "5,", "7-5", "a", "1-1000000000", "5.0"])
def test_what_is_no_list_of_spans(text):
    with pytest.raises(click.BadParameter, match="not a list of spans or rising ranges such as"):
        spans_option_value(text)


def spans_option_value(text):
    return _span_numbers(click.Context(click.Command("x")), click.Option(["--spans"]), text)
