"""The line as an FMU, for a co-simulation."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from catenary_fe.cli import options
from catenary_fe.cli.terminal import print_warnings, warned, working
from catenary_fe.layout import layout_warnings

EPILOG = """\b
Examples:
  catenary-fe fmu models/layouts/re330.toml --pantograph DSA250 --speed-kmh 280 -o catenary.fmu
  catenary-fe fmu LAYOUT --pantograph my.toml --speed-kmh 250 --cut none -o whole.fmu

\b
It needs pythonfmu (pip install "catenary_fe[fmu]"), and catenary_fe where it runs: an FMU of Python code
starts the Python that it finds there."""


@click.command(cls=options.ManyValues, many=("--pantograph-at",), numbers=True, epilog=EPILOG)
@options.layout
@options.pantographs
@options.positions
@click.option("--speed-kmh", type=float, required=True, help="Speed in km/h at the start.")
@click.option(
    "--cut",
    type=click.Choice(["head", "none"]),
    default="head",
    show_default=True,
    help="What of the pantographs is inside: the head alone, or all of it.",
)
@options.time_step
@options.planar
@options.conditions("Wind, ice and temperature that the line is under.")
@options.output("The FMU to write.", metavar="FILE", required=True)
@options.quiet
def fmu(
    layout: str,
    names: tuple[str, ...],
    positions: tuple[float, ...],
    speed_kmh: float,
    cut: Any,
    time_step_ms: float,
    planar: bool,
    conditions: str | None,
    output: str,
    quiet: bool,
) -> None:
    """A LAYOUT with the heads of its pantographs as an FMU (FMI 2.0, co-simulation).

    Another program then moves what the heads stand on, and gets the force on it. With --cut none the whole
    pantographs are inside, and it sets their uplift forces.
    """
    from catenary_fe.engines.settings import TimeSettings
    from catenary_fe.studies.fmu import check_fmu_packages, record_of, write_fmu

    check_fmu_packages()
    catenary = options.read_layout(layout, planar)
    pantographs = options.read_pantographs(names, positions)
    weather = options.read_conditions(conditions) if conditions else None
    with warned(layout_warnings(catenary)), working("static contact", not quiet):
        record = record_of(
            catenary,
            pantographs,
            cut=cut,
            speed=speed_kmh / 3.6,
            positions=positions or None,
            conditions=weather,
            time=TimeSettings(step=time_step_ms / 1e3),
        )
        write_fmu(output, record)
    print_warnings(layout_warnings(catenary))
    if not quiet:
        click.echo(
            f"{output}: {Path(output).stat().st_size / 1e6:.1f} MB, {record.duration:.2f} s at this speed"
        )
