"""The model in Exudyn's own viewer."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from catenary_fe.cli.folder import run_in
from catenary_fe.cli.terminal import quiet_option, say_lengths, shown_spans_option, working
from catenary_fe.layout import InputError, load_catenary

if TYPE_CHECKING:
    from catenary_fe.statics import Shape


@click.command(
    epilog="\b\nExamples:\n  catenary-fe view models/layouts/en50318_2002.toml --spans 1,2\n"
    "  catenary-fe view run300 -o model.png"
)
@click.argument("layout_or_folder", type=click.Path())
@shown_spans_option
@click.option(
    "-o", "--output", type=click.Path(), metavar="FILE", help="Save the picture and close, as .png."
)
@quiet_option
def view(layout_or_folder: str, spans: list[int] | None, output: str | None, quiet: bool) -> None:
    """Open the model of a LAYOUT, or of a run's FOLDER, in Exudyn's viewer; needs a screen."""
    from catenary_fe.engines.exudyn.viewer import require_screen, view_model

    require_screen()
    with working("form finding", not quiet):
        shape = _shape(layout_or_folder)
    say_lengths(shape, quiet)
    last = len(shape.catenary.spans)
    shown = spans or [min(2, last)]
    if not (min(shown) >= 1 and max(shown) <= last):
        raise InputError(f"spans {shown}: the line has spans 1 to {last}")
    if not (quiet or output):
        click.echo("Exudyn's viewer: mouse moves and turns, wheel zooms, Q or Escape closes.", err=True)
    picture = view_model(shape, (min(shown), max(shown)), wait=output is None)
    if output:
        from catenary_fe.views.film import save_pixels

        save_pixels(Path(output), picture)


def _shape(layout_or_folder: str) -> Shape:
    from catenary_fe.statics import find_form
    from catenary_fe.studies.rerun import shape_of

    path = Path(layout_or_folder)
    if path.is_dir() or path.suffix == ".nc":
        return shape_of(run_in(path))
    return find_form(load_catenary(path))
