"""Fig. 4: deflection at t = 0.5 s for V = 0, 0.5, 1, 1.5 and 2 times the wave speed.

Question: what does the travelling speed do to the shape under a moving force?
Parameters (paper): 20 kN, 1.33 kg/m, 200 N, no supports.
Model: closed form and the ANCF wire. At V = c the exact front is a jump; ANCF is run with 1 % of the force
there and scaled, because a jump of 0.3 m is no small inclination on any mesh.
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
    STRING,
    C,
    Numbers,
    difference,
    publish,
    run_force,
    run_script,
    undisturbed_ends,
)

import catenary_fe as cf
from catenary_fe import theory

RATIOS = (0.0, 0.5, 1.0, 1.5, 2.0)
LIGHT = 0.01  # of the force, at V = c


def main(folder: Path) -> Numbers:
    figure = Figure(figsize=(9.0, 10.0), layout="constrained")
    numbers = {}
    for ax, ratio in zip(figure.subplots(len(RATIOS), 1, sharex=True), RATIOS, strict=True):
        share = LIGHT if ratio == 1.0 else 1.0
        x = cf.even_nodes(undisturbed_ends(ratio * C), 0.25)
        motion = run_force(x, speed=ratio * C, force=share * FORCE, interval=DURATION)
        computed = motion.at(DURATION) / share
        exact = theory.moving_force(STRING, x, DURATION, speed=ratio * C, force=FORCE)
        away = np.abs(x - C * DURATION) > 2.0 if ratio == 1.0 else np.ones(x.size, dtype=bool)
        off = difference(x[away], computed[away], exact[away])
        numbers[f"difference at V = {ratio:g} c (%)"] = 100 * off
        numbers[f"largest deflection at V = {ratio:g} c (m)"] = float(exact.max())
        ax.plot(x, 1e3 * computed, **COMPUTED, label="ANCF")
        ax.plot(x, 1e3 * exact, **REFERENCE, label="closed form")
        ax.plot(ratio * C * DURATION, -22, "k^", markersize=7, label="force")
        text = " (2 m around the force left out)" if ratio == 1.0 else ""
        ax.set_title(f"V = {ratio:g} c: difference {100 * off:.2f} %{text}", fontsize=9, loc="left")
        ax.set(ylabel="deflection (mm)", ylim=(-40, 390))
        ax.grid(color="#dddddd", linewidth=0.6)
    figure.axes[0].legend(fontsize=8, loc="upper right")
    figure.axes[-1].set_xlabel("position (m)")
    caption = (
        "200 N on the paper's wire (20 kN, 1.33 kg/m) after 0.5 s, no supports. Below c the wire kinks under"
        " the force; at V = c the slope there is infinite; above c nothing moves ahead of the force, which"
        " drags a cone."
    )
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
