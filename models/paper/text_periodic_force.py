"""Text: a force that is periodic in time, F = F_m + F_d sin Ωt (eq. 6).

Question: what waves does a moving force send out that varies in time?
Parameters: 20 kN, 1.33 kg/m, 320 km/h; F_m = 200 N (paper), F_d = 100 N at 10 Hz (ours), 0.5 s.
Model: closed form (eq. 6 with ρc and the sign of F_d put right) and ANCF; ahead of the force the wire feels
Ω/(1 - V/c), behind it Ω/(1 + V/c).
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
    STRING,
    C,
    Numbers,
    difference,
    paper_wire,
    publish,
    run_script,
    undisturbed_ends,
)

import catenary_fe as cf
from catenary_fe import theory

SWING, FREQUENCY = 100.0, 10.0  # N, Hz
OMEGA = 2 * np.pi * FREQUENCY


def main(folder: Path) -> Numbers:
    force = theory.HarmonicForce(mean=FORCE, amplitude=SWING, angular_frequency=OMEGA)
    problem = cf.WireProblem(
        wire=paper_wire(),
        x=cf.even_nodes(undisturbed_ends(SPEED), 0.25),
        loads=[theory.MovingForce(force=force, speed=SPEED)],
    )
    motion = cf.run_wire(problem, duration=DURATION)
    x, t = motion.x, motion.t
    exact = theory.moving_force(STRING, x, DURATION, speed=SPEED, force=force)
    under = theory.deflection_under_moving_force(STRING, t, speed=SPEED, force=force)
    off, off_under = difference(x, motion.at(DURATION), exact), difference(t, motion.under_loads[:, 0], under)
    figure = Figure(figsize=(10.0, 6.5), layout="constrained")
    shape, history = figure.subplots(2, 1)
    shape.plot(x, 1e3 * motion.at(DURATION), **COMPUTED, label="ANCF")
    shape.plot(x, 1e3 * exact, **REFERENCE, label="closed form")
    shape.axvline(SPEED * DURATION, color="#444444", linewidth=0.8, linestyle=":", label="force")
    shape.set(xlabel="position (m)", ylabel="deflection (mm)")
    shape.set_title(f"t = {DURATION:g} s: difference {100 * off:.2f} %", fontsize=10, loc="left")
    history.plot(t, 1e3 * motion.under_loads[:, 0], **COMPUTED, label="ANCF")
    history.plot(t, 1e3 * under, **REFERENCE, label="eq. 6")
    history.set(xlabel="time (s)", ylabel="deflection under the force (mm)")
    history.set_title(f"under the force: difference {100 * off_under:.2f} %", fontsize=10, loc="left")
    for ax in (shape, history):
        ax.grid(color="#dddddd", linewidth=0.6)
        ax.legend(fontsize=8, loc="upper left")
    ahead, behind = FREQUENCY / (1 - SPEED / C), FREQUENCY / (1 + SPEED / C)
    caption = (
        "F = 200 N + 100 N sin(2π · 10 Hz · t) at 320 km/h on the paper's wire: short waves ahead"
        f" ({ahead:.1f} Hz for the wire), long ones behind ({behind:.1f} Hz). ANCF and closed form differ by"
        f" {100 * off:.2f} %."
    )
    numbers = {
        "difference at 0.5 s (%)": 100 * off,
        "difference under the force (%)": 100 * off_under,
        "frequency ahead of the force (Hz)": ahead,
        "frequency behind it (Hz)": behind,
    }
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
