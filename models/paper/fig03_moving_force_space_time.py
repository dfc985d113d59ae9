"""Fig. 3: deflection over place and time under a constant force that moves at 320 km/h.

Question: how does an unsupported wire answer a force that starts at t = 0 and moves below its wave speed?
Parameters (paper): 20 kN, 1.33 kg/m, 200 N, 320 km/h = 0.725 c ("0.75 c" in the text), t = 0 … 0.5 s, no
supports.
Model: closed form (eq. 4 and 5, factor 1/2ρc put right) and the ANCF wire.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from paper_common import (
    DURATION,
    FORCE,
    MASS,
    SPEED,
    STRING,
    C,
    Numbers,
    difference,
    publish,
    run_force,
    run_script,
    undisturbed_ends,
    wave_lines,
)

import catenary_fe as cf
from catenary_fe import theory
from catenary_fe.views import plot_space_time, plot_surface


def main(folder: Path) -> Numbers:
    motion = run_force(cf.even_nodes(undisturbed_ends(SPEED), 0.25), speed=SPEED)
    exact = theory.moving_force(STRING, motion.x, motion.t[:, None], speed=SPEED, force=FORCE)
    off = [difference(motion.x, u, e) for u, e in zip(motion.deflection[1:], exact[1:], strict=True)]
    figure = Figure(figsize=(11.0, 8.0), layout="constrained")
    grid = figure.add_gridspec(2, 2)
    plot_surface(
        motion.x, motion.t, exact, title="closed form", ax=figure.add_subplot(grid[0, 0], projection="3d")
    )
    plot_surface(
        motion.x,
        motion.t,
        motion.deflection,
        title="ANCF",
        ax=figure.add_subplot(grid[0, 1], projection="3d"),
    )
    lines = wave_lines(DURATION, SPEED)
    below = [figure.add_subplot(grid[1, i]) for i in (0, 1)]
    plot_space_time(motion.x, motion.t, motion.deflection, lines=lines, title="ANCF", ax=below[0])
    title = "ANCF minus closed form: the kinks at force and fronts"
    off_by = motion.deflection - exact
    plot_space_time(motion.x, motion.t, off_by, quantity="difference (mm)", title=title, ax=below[1])
    under = float(motion.under_loads[-1, 0])
    caption = (
        "200 N at 320 km/h (0.725 c) on the paper's wire without supports: the deflection under the force"
        f" grows as F t/(2ρc), to {1e3 * under:.0f} mm after 0.5 s. ANCF (0.25 m, 0.5 ms) and closed form"
        f" differ by {100 * off[-1]:.2f} % at 0.5 s (root mean square over the wire)."
    )
    numbers = {
        "difference at 0.5 s (%)": 100 * off[-1],
        "deflection under the force at 0.5 s, ANCF (m)": under,
        "deflection under the force at 0.5 s, closed form (m)": FORCE * DURATION / (2 * MASS * C),
        "V/c": SPEED / C,
        "largest difference anywhere (mm)": 1e3 * float(np.abs(off_by).max()),
    }
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
