"""Fig. 8: supports every 6 m and bending stiffness, below and at the wave speed, regular and mistuned.

Question: what is left of the decoupled bays of fig. 5 when the wire bends?
Parameters (paper): 20 kN, 1.33 kg/m, 200 N, supports every 6 m; S = 200 kN m² as in fig. 7. Speeds 320 km/h
and c. The supports run on behind the start, which is above one of them. Mistuned: each support moved by up to
1 m (ours).
Model: ANCF wire; method of lines (0.2 and 0.1 m, extrapolated to zero) at 0.5 s.
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
    SPEED,
    STIFF,
    C,
    Floats,
    Numbers,
    difference,
    paper_wire,
    publish,
    run_force,
    run_script,
)
from scipy.interpolate import CubicSpline

import catenary_fe as cf
from catenary_fe import theory
from catenary_fe.views import plot_space_time

REGULAR = np.arange(-60.0, 97.0, 6.0)
ENDS = (REGULAR[0], REGULAR[-1])


def mistuned() -> Floats:
    """The same supports, each but the ends and the one at the start moved by up to 1 m, on a grid of 0.2"
    " m."""
    moved = np.round(np.random.default_rng(8).uniform(-1, 1, REGULAR.size) / 0.2) * 0.2
    moved[[0, -1]], moved[REGULAR == 0] = 0.0, 0.0
    return np.round(REGULAR + moved, 9)


def by_lines(x: Floats, supports: Floats, speed: float) -> Floats:
    """Deflection at the end of the run by the method of lines, second order, extrapolated from two grids."""
    found = []
    for interval in (0.2, 0.1):
        lines = theory.solve_by_lines(
            paper_wire(STIFF).beam,
            [DURATION],
            ends=ENDS,
            intervals=round((ENDS[1] - ENDS[0]) / interval),
            supports=supports,
            loads=[theory.MovingForce(force=FORCE, speed=speed)],
        )
        found.append(np.asarray(CubicSpline(lines.x, lines.deflection[-1])(x)))
    return found[1] + (found[1] - found[0]) / 3


def main(folder: Path) -> Numbers:
    cases = {
        "regular, V = 0.725 c": (REGULAR, SPEED),
        "regular, V = c": (REGULAR, C),
        "mistuned, V = 0.725 c": (mistuned(), SPEED),
    }
    figure = Figure(figsize=(13.0, 7.5), layout="constrained")
    maps, curves = figure.subplots(2, 3, sharex=True, height_ratios=[2, 1])
    numbers: Numbers = {}
    for above, below, (name, (supports, speed)) in zip(maps, curves, cases.items(), strict=True):
        x = cf.even_nodes(supports, 0.25)
        inner = supports[1:-1].tolist()
        motion = run_force(x, speed=speed, bending_stiffness=STIFF, supports=inner, step=1.25e-4)
        last, lines = motion.at(DURATION), by_lines(x, supports, speed)
        off = difference(x, last, lines)
        track = {"force": (speed * motion.t, motion.t)}
        plot_space_time(
            x, motion.t, motion.deflection, lines=track, supports=supports, limit=3e-3, title=name, ax=above
        )
        below.plot(x, 1e3 * last, **COMPUTED, label="ANCF")
        below.plot(x, 1e3 * lines, **REFERENCE, label="method of lines")
        below.plot(supports, 0 * supports, "k^", markersize=3)
        below.set_title(f"t = 0.5 s: difference {100 * off:.2f} %", fontsize=9, loc="left")
        below.set(xlabel="position (m)", ylabel="deflection (mm)")
        below.grid(color="#dddddd", linewidth=0.6)
        numbers[f"difference, {name} (%)"] = 100 * off
        numbers[f"largest deflection, {name} (mm)"] = 1e3 * float(np.abs(motion.deflection).max())
        numbers[f"largest deflection behind the start, {name} (mm)"] = 1e3 * float(
            np.abs(motion.deflection[:, x < 0]).max()
        )
        ahead = x > speed * motion.t[:, None] + 6.0
        numbers[f"largest deflection more than 6 m ahead of the force, {name} (mm)"] = 1e3 * float(
            np.abs(motion.deflection[ahead]).max()
        )
    curves[0].legend(fontsize=7, loc="lower left")
    caption = (
        "200 N over rigid supports every 6 m, S = 200 kN m². Bending carries waves over the supports: they"
        " run ahead of the force even at V = c, and the wake reaches behind the start. Mistuned: supports"
        " moved by up to 1 m. The maps' colours end at 3 mm."
    )
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
