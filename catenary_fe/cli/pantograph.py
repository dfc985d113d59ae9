"""A pantograph by itself."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click
import numpy as np

from catenary_fe.cli import options
from catenary_fe.cli.folder import output_folder
from catenary_fe.cli.terminal import Answer, print_table
from catenary_fe.layout import load_pantograph

if TYPE_CHECKING:
    from catenary_fe.results import PantographResponse

SHOWN = 0.5, 1.0, 2.0, 5.0, 10.0, 20.0  # [Hz]
EPILOG = """\b
Examples:
  catenary-fe pantograph DSA380
  catenary-fe pantograph my_pantograph.toml -o my_pantograph"""


@click.command(epilog=EPILOG)
@click.argument("pantograph", metavar="NAME_OR_FILE", shell_complete=options.pantograph_names)
@click.option("--speed-kmh", type=float, default=0.0, show_default=True, help="Of the uplift force.")
@options.answer("Folder for the table of the receptance and a picture.")
def pantograph(pantograph: str, speed_kmh: float, answer: Answer) -> None:
    """Own frequencies, receptance and static force of a pantograph, its base at rest, without the wire.

    NAME_OR_FILE is a name of the library or a file. The receptance is how far the head moves for each newton
    on it, from 0.1 to 50 Hz; its table (with -o) may describe a pantograph in its turn.
    """
    from catenary_fe.results.pantograph import pantograph_response, receptance_text

    given = load_pantograph(pantograph)
    response = pantograph_response(given, speed=speed_kmh / 3.6)
    result: dict[str, Any] = response.as_dict() | {
        "speed_kmh": speed_kmh,
        "fit": _fit(response),
        "warnings": given.fit_warnings(),
    }
    with output_folder(answer.folder) as folder:
        if folder:
            from catenary_fe.views import plot_pantograph

            folder.json("pantograph.json", result)
            if response.receptance.size:
                folder.text("receptance.csv", receptance_text(response))
            folder.picture("pantograph.png", plot_pantograph(response))
    answer.show(result, lambda: _print(response))


def _fit(response: PantographResponse) -> dict[str, Any] | None:
    """How near a chain of masses is to the table that it stands for."""
    given = response.pantograph
    if given.measured is None:
        return None
    errors, frequency = given.errors, given.measured[0]
    return {
        "masses": len(given.masses),
        "rms_error_percent": 100 * float(np.sqrt((errors**2).mean())),
        "largest_error_percent": 100 * float(errors.max()),
        "largest_error_at_Hz": float(frequency[errors.argmax()]),
    }


def _print(response: PantographResponse) -> None:
    from catenary_fe.results import pantograph_response

    given = response.pantograph
    rows = [
        *given.in_words(),
        *(
            [("own frequencies, receptance", "of the linear part: no stops, no friction, the smaller damper")]
            if given.assemble(spatial=False).laws
            else []
        ),
        ("static uplift", f"{response.uplift:.4g} N"),
        *(
            (f"static force at {z:+g} m", f"{np.interp(z, response.height, response.force):.4g} N")
            for z in (response.height[0], response.height[-1])
            if response.force_varies
        ),
        *(
            (f"own frequency {n}", f"{f:.4g} Hz" + ("" if np.isnan(d) else f", {100 * d:.3g} % of critical"))
            for n, (f, d) in enumerate(
                zip(response.own_frequencies, response.damping_ratios, strict=True), start=1
            )
        ),
    ]
    if response.receptance.size:
        shown = pantograph_response(given, SHOWN).receptance
        rows += [
            (f"receptance at {f:g} Hz", f"{1e3 * abs(z):.3g} mm/N, {np.rad2deg(np.angle(z)):.0f}°")
            for f, z in zip(SHOWN, shown.tolist(), strict=True)
        ]
    print_table(given.name, ("", "value"), rows)
