"""Fig. 12: an elastic pantograph on the unsupported wire, without and with bending stiffness.

Question: what if the force falls as the wire rises?
Parameters: as fig. 3 (20 kN, 1.33 kg/m, 320 km/h, no supports); F = max(0, 200 N - k u), the paper leaves the
law open, k = 1 kN/m is ours; bending 0 and 200 kN m². Also a given nonlinear law: 200 N up to 50 mm, then
falling to 0 at 150 mm (ours).
Model: ANCF wire, method of lines, and for the string with the linear law the closed form F = F₀ exp(-k
t/2√(Tρ)).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from paper_common import (
    COMPUTED,
    DURATION,
    FORCE,
    REFERENCE,
    SLACKENING,
    SPEED,
    STIFF,
    STRING,
    Floats,
    Numbers,
    difference,
    paper_wire,
    publish,
    run_script,
    wave_lines,
)

import catenary_fe as cf
from catenary_fe import theory
from catenary_fe.views import plot_space_time

LINEAR = cf.ElasticPantograph(force=FORCE, stiffness=SLACKENING)
GIVEN = cf.ElasticPantograph(law=((0.05, FORCE), (0.15, 0.0)))
CASES = {
    "string, linear law": (0.0, LINEAR),
    "S = 200 kN m², linear law": (STIFF, LINEAR),
    "string, law of points": (0.0, GIVEN),
}
ENDS = (-90.0, 130.0)  # m
LIMIT = 0.16  # m, of the maps' colours: beyond the largest deflection of all cases


def run_both(bending: float, pantograph: cf.ElasticPantograph) -> tuple[cf.WireMotion, Floats]:
    """Motion of the ANCF wire, and contact force at the same times by the method of lines."""
    load = theory.ElasticPantograph(law=pantograph.contact_force, speed=SPEED)
    problem = cf.WireProblem(
        wire=paper_wire(bending), x=cf.even_nodes([ENDS[0], 0.0, ENDS[1]], 0.25), loads=[load]
    )
    motion = cf.run_wire(problem, duration=DURATION, interval=2.5e-3)
    lines = theory.solve_by_lines(paper_wire(bending).beam, motion.t, ends=ENDS, intervals=1760, loads=[load])
    return motion, lines.forces[:, 0]


def main(folder: Path) -> Numbers:
    figure = Figure(figsize=(13.0, 7.5), layout="constrained")
    maps, forces = figure.subplots(2, 3, height_ratios=[2, 1])
    numbers: Numbers = {}
    for above, below, (name, (bending, law)) in zip(maps, forces, CASES.items(), strict=True):
        motion, by_lines = run_both(bending, law)
        force = motion.forces[:, 0]
        off = difference(motion.t, force, by_lines)
        lines = wave_lines(DURATION, SPEED)
        plot_space_time(motion.x, motion.t, motion.deflection, lines=lines, limit=LIMIT, title=name, ax=above)
        below.plot(motion.t, force, **COMPUTED, label="ANCF")
        below.plot(motion.t, by_lines, **REFERENCE, label="method of lines")
        if name == "string, linear law":
            exact = theory.elastic_pantograph_force(
                STRING, motion.t, speed=SPEED, force=FORCE, stiffness=SLACKENING
            )
            below.plot(motion.t[::10], exact[::10], "ko", markersize=3, fillstyle="none", label="closed form")
            numbers["difference to the closed form, string (%)"] = 100 * difference(motion.t, force, exact)
        below.set(xlabel="time (s)", ylabel="contact force (N)", ylim=(0, 215))
        below.set_title(f"ANCF and lines differ by {100 * off:.2f} %", fontsize=9, loc="left")
        below.grid(color="#dddddd", linewidth=0.6)
        below.legend(fontsize=7, loc="lower left" if law is GIVEN else "upper right")
        numbers[f"difference to the lines, {name} (%)"] = 100 * off
        numbers[f"largest deflection, {name} (mm)"] = 1e3 * float(np.nanmax(motion.under_loads))
        numbers[f"force at 0.5 s, {name} (N)"] = float(force[-1])
    caption = (
        "An elastic pantograph, F = max(0, 200 N - 1 kN/m u), at 320 km/h on the paper's wire without"
        " supports: the deflection stays bounded. The string's answer fills the cone between ±c; with S ="
        " 200 kN m² waves run in front of and behind it. Right: another law, 200 N up to 50 mm, 0 from 150"
        " mm on."
    )
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
