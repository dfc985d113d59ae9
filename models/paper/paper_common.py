"""What the paper's figures share: the paper's wire and cell, and how a figure is published.

Source of all figures: "Selected problems of wave phenomena in catenaries". What the text does not say is
chosen here, in one place, and called ours.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

import catenary_fe as cf
from catenary_fe import theory
from catenary_fe.results.files import atomic_write, write_text

Floats = NDArray[np.float64]
Numbers = dict[str, float]

TENSION, MASS, FORCE = 20e3, 1.33, 200.0  # N, kg/m, N
STRING = theory.String(tension=TENSION, mass_per_length=MASS)
C = STRING.wave_speed  # 122.6 m/s
SPEED = 320 / 3.6  # m/s, 0.725 c; the text rounds to 0.75 c
DURATION = 0.5  # s
STIFF = 200e3  # N m², the "considerable" bending stiffness of fig. 7
COPPER = 195.0  # N m², of a solid round wire of 150 mm²; ours
AXIAL_STIFFNESS = 1.7e7  # N, likewise; the closed forms know no such thing
SLACKENING = 1000.0  # N/m by which an elastic pantograph's force falls; ours
CELL = Path(__file__).parents[1] / "layouts" / "paper_cell.toml"

COMPUTED = {"color": "#c44e1c", "linewidth": 1.5}
REFERENCE = {"color": "black", "linewidth": 0.9, "linestyle": "--"}


def paper_wire(bending_stiffness: float = 0.0) -> cf.Wire:
    """The paper's wire; a string unless it is given a bending stiffness [N m²]."""
    return cf.Wire(
        tension=TENSION,
        mass_per_length=MASS,
        axial_stiffness=AXIAL_STIFFNESS,
        bending_stiffness=bending_stiffness,
    )


def run_force(
    x: Floats,
    *,
    speed: float,
    force: float = FORCE,
    bending_stiffness: float = 0.0,
    supports: Sequence[float] = (),
    duration: float = DURATION,
    step: float = 5e-4,
    interval: float = 5e-3,
) -> cf.WireMotion:
    """The ANCF wire on nodes x [m] under a force that starts at 0 and moves at ``speed`` [m/s]."""
    problem = cf.WireProblem(
        wire=paper_wire(bending_stiffness),
        x=x,
        supports=supports,
        loads=[theory.MovingForce(force=force, speed=speed)],
    )
    return cf.run_wire(
        problem, duration=duration, time=cf.TimeSettings(step=step, tolerance=1e-6), interval=interval
    )


def undisturbed_ends(speed: float, duration: float = DURATION, wave_speed: float = C) -> list[float]:
    """[m] a wire so long that nothing comes back from its ends while the force runs from 0."""
    return [-wave_speed * duration - 5, 0.0, max(speed, wave_speed) * duration + 5]


def wave_lines(duration: float, speed: float) -> dict[str, tuple[Floats, Floats]]:
    """Where the force and the fronts of the string's waves run."""
    t = np.array([0.0, duration])
    return {
        f"force, {speed:.1f} m/s": (speed * t, t),
        f"±c, {C:.1f} m/s": (
            np.array([-C * duration, 0.0, C * duration]),
            duration * np.array([1, 0, 1]),
        ),
    }


def rms(x: Floats, values: Floats) -> float:
    """Root mean square over places or times that need not be evenly spread."""
    return float(np.sqrt(np.trapezoid(values**2, x) / (x[-1] - x[0])))


def difference(x: Floats, computed: Floats, reference: Floats) -> float:
    """Root mean square of the difference over that of the reference."""
    return rms(x, computed - reference) / rms(x, reference)


def paper_shape(mesh: cf.MeshSettings | None = None) -> cf.Shape:
    """The two-wire system of figs. 1 and 6 in its static state."""
    return cf.find_form(cf.load_catenary(CELL), mesh)


def uplift_map(run: cf.Run, window: tuple[float, float]) -> tuple[Floats, Floats, Floats]:
    """Places [m], times [s] within a window, and uplift [m] of the contact wire above its static shape."""
    data = run.data
    t = data["wire_time"].values
    inside = (t >= window[0] - 1e-9) & (t <= window[1] + 1e-9)
    uplift = data["contact_wire_height"].values - data["static_contact_wire_height"].values
    return data["x"].values, t[inside], uplift[inside]


def publish(folder: Path | str, script: str, figure: Figure, caption: str, numbers: Numbers) -> Numbers:
    """Write the picture, and beside it a JSON file with caption and numbers; returns the numbers."""
    folder, name = Path(folder), Path(script).stem
    folder.mkdir(parents=True, exist_ok=True)
    with atomic_write(folder / f"{name}.png") as aside:
        figure.savefig(aside, dpi=130, metadata={"Software": None})
    facts = {"caption": caption, "numbers": {key: float(value) for key, value in numbers.items()}}
    text = json.dumps(facts, indent=2, ensure_ascii=False) + "\n"
    write_text(folder / f"{name}.json", text)
    return facts["numbers"]  # type: ignore[return-value]


def run_script(main: Callable[[Path], Numbers]) -> None:
    """Draw one figure into the folder named on the command line, or out/paper; print its numbers."""
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out/paper")
    for key, value in main(folder).items():
        print(f"{key}: {value:.6g}")
    print(f"picture in {folder}")
