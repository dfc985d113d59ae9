"""Eigenfrequencies and shapes of a layout."""

from __future__ import annotations

from typing import Any

import click

from catenary_fe.cli.folder import output_folder
from catenary_fe.cli.terminal import (
    json_option,
    layout_argument,
    output_option,
    planar_option,
    print_json,
    print_table,
    print_warnings,
    quiet_option,
    read_layout,
    say_lengths,
    warned,
    working,
)
from catenary_fe.layout.preflight import layout_warnings

DRAWN = 6  # shapes in an output folder


@click.command(epilog="\b\nExample:\n  catenary-fe modes models/layouts/paper_cell.toml --below 20 -o modes")
@layout_argument
@click.option("--count", type=click.IntRange(1), help="How many modes; unset, and with no --below: 40.")
@click.option("--below", type=float, metavar="HZ", help="All modes up to this frequency.")
@planar_option
@output_option
@json_option
@quiet_option
def modes(
    layout: str,
    count: int | None,
    below: float | None,
    planar: bool,
    output: str | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Eigenfrequencies and shapes of a LAYOUT about its static state, droppers taut."""
    from catenary_fe.engines.modal.modes import mode_warnings, solve_modes
    from catenary_fe.fe import MeshSettings
    from catenary_fe.statics import find_form

    catenary = read_layout(layout, planar)
    with warned(layout_warnings(catenary)), output_folder(output) as folder:
        # the usual mesh leaves 0.1 % in the lowest frequencies, half of it 0.02 %
        with working("modes", not quiet):
            shape = find_form(catenary, MeshSettings().halved())
            found = solve_modes(shape, count=count, below=below)
        rows = found.table()
        result: dict[str, Any] = {
            "modes": rows,
            "dropper_lengths_given": catenary.gives_dropper_lengths,
            "warnings": [*layout_warnings(catenary), *mode_warnings(shape, found)],
        }
        if folder:
            from catenary_fe.views import plot_mode, plot_spectrum

            folder.json("modes.json", result)
            folder.table("modes.csv", rows)
            folder.picture("spectrum.png", plot_spectrum(found))
            for i in range(min(DRAWN, len(found))):
                folder.picture(f"mode_{i + 1:02d}.png", plot_mode(found, i))
    if as_json:
        print_json(result)
    elif not quiet:
        table = [
            (
                row["mode"],
                f"{row['frequency_Hz']:.4f}",
                f"{100 * row['damping_ratio']:.3f}",
                str(kind),
            )
            for row, kind in zip(rows, found.kinds(), strict=True)
        ]
        columns = ("mode", "frequency Hz", "damping %", "kind")
        print_table(f"{catenary.name}: modes about the static state", columns, table)
    say_lengths(shape, quiet)
    if not as_json:
        print_warnings(result["warnings"])
