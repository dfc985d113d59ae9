"""Completion of commands, options and names in the shell."""

from __future__ import annotations

import shlex

import click
from click.shell_completion import CompletionItem, get_completion_class


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


def pantograph_names(
    context: click.Context, parameter: click.Parameter, incomplete: str
) -> list[CompletionItem]:
    """The library's pantographs, and files."""
    from catenary_fe.layout import library

    begun = incomplete.strip("'\"").casefold()
    names = [name for name in library.names("pantographs") if name.casefold().startswith(begun)]
    return [CompletionItem(shlex.quote(name)) for name in names] + [CompletionItem(incomplete, type="file")]
