"""Fig. 2: an initial shift of the wire splits into two waves (eq. 3).

Question: what becomes of a shift around the origin that is let go?
Model: the paper's wire without bending, let go from a smooth shift of 10 mm on 10 m (ours); d'Alembert's two
waves and the ANCF wire.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from paper_common import STRING, C, Floats, Numbers, difference, paper_wire, publish, run_script

import catenary_fe as cf
from catenary_fe import theory
from catenary_fe.views import plot_family

HEIGHT, HALF_WIDTH = 0.01, 5.0  # m; so flat that it hardly adds to the tension
TIMES = (0.0, 0.02, 0.1, 0.2, 0.3)  # s


def shift(x: Floats) -> Floats:
    inside = np.abs(x) < HALF_WIDTH
    return np.where(inside, HEIGHT * np.cos(np.pi * x / (2 * HALF_WIDTH)) ** 2, 0.0)


def main(folder: Path) -> Numbers:
    problem = cf.WireProblem(
        wire=paper_wire(), x=cf.even_nodes([-50.0, 0.0, 50.0], 0.25), initial_deflection=shift
    )
    time = cf.TimeSettings(step=2.5e-4, tolerance=1e-6)
    motion = cf.run_wire(problem, duration=TIMES[-1], time=time, interval=0.01)
    x = motion.x
    exact = {t: theory.running_waves(STRING, x, t, initial_deflection=shift) for t in TIMES}
    off = [difference(x, motion.at(t), exact[t]) for t in TIMES]
    right = x > 0
    place = x[right][motion.at(TIMES[-1])[right].argmax()]
    ax = plot_family(
        x,
        {f"t = {t:g} s": motion.at(t) for t in TIMES},
        dashed={f"{t:g}": exact[t] for t in TIMES},
        title="A shift of the wire, let go: ANCF in colour, closed form dashed",
    )
    caption = (
        f"The paper's wire (20 kN, 1.33 kg/m, c = {C:.1f} m/s) let go from a shift of {1e3 * HEIGHT:g} mm on"
        " 10 m: two waves of half the height run apart at ±c. ANCF and d'Alembert's solution (eq. 3) differ"
        f" by at most {100 * max(off):.2f} %."
    )
    numbers = {
        "largest difference to the closed form (%)": 100 * max(off),
        "height of each wave (mm)": 1e3 * float(motion.at(TIMES[-1]).max()),
        "speed of the crest over c": place / TIMES[-1] / C,
    }
    return publish(folder, __file__, ax.figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
