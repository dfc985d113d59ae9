"""Text: a force that moves at the wave speed, V = c, on a wire with bending stiffness.

Question: the string's slope under the force is infinite at V = c; what does bending make of it?
Parameters: 20 kN, 1.33 kg/m, 200 N at V = c for 0.5 s, no supports; S = 2, 20 and 200 kN m². Run with 1 % of
the force and scaled, so that the answer stays linear.
Model: ANCF wire (0.25 m), method of lines for 200 kN m², closed form for the string.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from paper_common import (
    DURATION,
    FORCE,
    MASS,
    STRING,
    C,
    Floats,
    Numbers,
    difference,
    paper_wire,
    publish,
    run_force,
    run_script,
)

import catenary_fe as cf
from catenary_fe import theory

BENDING = {2e3: "#b9c7d3", 20e3: "#5f8fb0", 200e3: "#1f5a85"}  # N m²
LIGHT = 0.01
ENDS = (-90.0, 140.0)  # m


def by_lines(x: Floats, bending: float) -> Floats:
    lines = theory.solve_by_lines(
        paper_wire(bending).beam,
        [DURATION],
        ends=ENDS,
        intervals=1150,
        loads=[theory.MovingForce(force=FORCE, speed=C)],
    )
    return np.interp(x, lines.x, lines.deflection[-1])


def main(folder: Path) -> Numbers:
    figure = Figure(figsize=(10.0, 7.5), layout="constrained")
    shapes, under = figure.subplots(2, 1, height_ratios=[1.4, 1])
    x = cf.even_nodes([ENDS[0], 0.0, ENDS[1]], 0.25)
    string = theory.moving_force(STRING, x, DURATION, speed=C, force=FORCE)
    shapes.plot(x, 1e3 * string, "k--", linewidth=0.9, label="string, closed form")
    numbers: Numbers = {}
    for bending, colour in BENDING.items():
        motion = run_force(
            x, speed=C, force=LIGHT * FORCE, bending_stiffness=bending, step=2.5e-4, interval=2.5e-3
        )
        last, name = motion.at(DURATION) / LIGHT, f"S = {bending / 1e3:g} kN m²"
        shapes.plot(x, 1e3 * last, color=colour, linewidth=1.5, label=name)
        under.plot(motion.t, 1e3 * motion.under_loads[:, 0] / LIGHT, color=colour, linewidth=1.5, label=name)
        numbers[f"deflection under the force, {name} (mm)"] = 1e3 * float(motion.under_loads[-1, 0]) / LIGHT
        numbers[f"steepest slope, {name}"] = float(np.abs(np.gradient(last, x)).max())
    off = difference(x, last, by_lines(x, bending))
    numbers["ANCF against method of lines, S = 200 kN m² (%)"] = 100 * off
    numbers["just behind the force, string (mm)"] = 1e3 * FORCE * DURATION / (2 * MASS * C)
    shapes.axvline(C * DURATION, color="#444444", linewidth=0.8, linestyle=":", label="force")
    shapes.set(xlabel="position (m)", ylabel="deflection (mm)", xlim=(-75, 135))
    shapes.set_title(f"t = {DURATION:g} s, V = c", fontsize=10, loc="left")
    t = np.linspace(0, DURATION, 50)
    under.plot(t, 1e3 * FORCE * t / (2 * MASS * C), "k--", linewidth=0.9, label="string, F t/(2ρc)")
    under.set(xlabel="time (s)", ylabel="deflection under the force (mm)")
    for ax in (shapes, under):
        ax.grid(color="#dddddd", linewidth=0.6)
        ax.legend(fontsize=8, loc="upper left")
    caption = (
        "200 N at the wave speed for 0.5 s: bending lets waves run ahead of the force and rounds the"
        " string's jump, the slope stays finite. Under the force the deflection still grows with time. ANCF"
        f" and method of lines differ by {100 * off:.2f} % at S = 200 kN m²."
    )
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
