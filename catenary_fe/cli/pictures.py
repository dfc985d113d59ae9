"""A film and a picture of the waves from a run's folder."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from catenary_fe.cli.folder import run_in, save_picture
from catenary_fe.cli.terminal import progress_bar, quiet_option, shown_spans_option


@click.command(
    epilog="\b\nExamples:\n  catenary-fe film run300 -o run300.gif\n"
    "  catenary-fe film run300 --spans 5 --slowed 10 -o span5.mp4"
)
@click.argument("folder", type=click.Path())
@click.option(
    "-o", "--output", type=click.Path(), required=True, metavar="FILE", help="Name with .gif or .mp4."
)
@shown_spans_option
@click.option("--slowed", type=float, default=4.0, show_default=True, help="Times slower than real time.")
@click.option("--fps", type=int, default=20, show_default=True, help="Frames a second, at most 50.")
@click.option(
    "--magnified", type=float, default=5.0, show_default=True, help="Times that motion is drawn larger."
)
@quiet_option
def film(
    folder: str,
    output: str,
    spans: list[int] | None,
    slowed: float,
    fps: int,
    magnified: float,
    quiet: bool,
) -> None:
    """Film the run in FOLDER: wires, droppers (slack ones marked), pantographs, contact force."""
    from catenary_fe.views.film import film as draw

    run = run_in(folder)
    with progress_bar("film", not quiet) as progress:
        path = draw(
            run,
            output,
            spans=spans,
            slowed=slowed,
            frames_per_second=fps,
            magnified=magnified,
            progress=progress,
        )
    if not quiet:
        click.echo(f"{path}: {path.stat().st_size / 1e6:.1f} MB")


@click.command(
    epilog="\b\nExamples:\n  catenary-fe waves run300 -o waves.png\n"
    "  catenary-fe waves run300 --quantity deflection --spans 4,5,6 -o uplift.png"
)
@click.argument("folder", type=click.Path())
@click.option(
    "-o", "--output", type=click.Path(), required=True, metavar="FILE", help="Name with .png, .svg or .pdf."
)
@click.option(
    "--quantity", type=click.Choice(["velocity", "deflection"]), default="velocity", show_default=True
)
@click.option("--wire", default="contact wire", show_default=True, help="Which of the stored wires.")
@shown_spans_option
@quiet_option
def waves(folder: str, output: str, quantity: Any, wire: str, spans: list[int] | None, quiet: bool) -> None:
    """Draw the waves of the run in FOLDER over place and time, with the rays of the wave speed."""
    from catenary_fe.views import plot_run_waves

    axes = plot_run_waves(run_in(folder), quantity=quantity, spans=spans, wire=wire)
    save_picture(Path(output), axes)
    if not quiet:
        click.echo(output)
