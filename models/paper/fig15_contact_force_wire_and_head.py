"""Fig. 15: contact force in dependence on wire and pantograph motion.

Question: how do contact force, wire height and head height depend on each other when the pantograph is a
multibody system (the paper's outlook)?
Parameters: two-mass pantograph of EN 50318:2002 at 250 km/h (0.57 c) on the two-wire system of fig. 6; the
paper shows another author's result without parameters, so these are ours.
Model: ANCF of both wires, mass-spring pantograph in unilateral contact (50 kN/m).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from paper_common import Floats, Numbers, paper_shape, publish, run_script

import catenary_fe as cf
from catenary_fe.results import low_pass

PANTOGRAPH = cf.library.pantograph("EN 50318:2002")
SPEED = 250 / 3.6  # m/s
NOMINAL = 5.3  # m


def balance(run: cf.Run) -> Floats:
    """[N] contact force that the masses' motion asks for: uplift less inertia and the lowest stage's pull."""
    heights = run.data["mass_height"].values[0] - NOMINAL
    velocity = np.gradient(heights, run.step, axis=1)
    acceleration = np.gradient(velocity, run.step, axis=1)
    masses = np.array([stage.mass for stage in PANTOGRAPH.stages])
    lowest = PANTOGRAPH.stages[-1]
    inertia = masses @ acceleration
    pull = lowest.stiffness * heights[-1] + lowest.damping * velocity[-1]
    force: Floats = float(run.data["uplift_force"].values[0]) - inertia - pull
    return force


def draw(x: Floats, force: Floats, wire: Floats, head: Floats, smooth: list[Floats]) -> Figure:
    """Force and heights along two spans; force against distance of head and wire, and against wire height."""
    figure = Figure(figsize=(12.0, 8.5), layout="constrained")
    top, middle, low = figure.add_gridspec(3, 1, height_ratios=[1, 1, 1.25])
    forces, heights = figure.add_subplot(top), figure.add_subplot(middle)
    law, loops = low.subgridspec(1, 2).subplots()
    forces.plot(x, force, color="#b9c7d3", linewidth=0.7, label="contact force")
    forces.plot(x, smooth[0], color="#1f5a85", linewidth=1.4, label="0 to 20 Hz")
    forces.plot(x, smooth[1], "k--", linewidth=0.8, label="from the masses' motion, 0 to 20 Hz")
    forces.set(ylabel="contact force (N)", xlabel="position (m)")
    heights.plot(
        x, 1e3 * (wire - NOMINAL), color="#c44e1c", linewidth=1.4, label="contact wire over the head"
    )
    heights.plot(x, 1e3 * (head - NOMINAL), color="#1f5a85", linewidth=0.9, label="head")
    heights.set(ylabel="height above nominal (mm)", xlabel="position (m)")
    depth = 1e3 * (head - wire)
    law.plot(depth, force, ".", color="#1f5a85", markersize=2, label="run")
    line = np.array([min(depth.min(), 0.0), 0.0, depth.max()])
    law.plot(
        line,
        1e-3 * PANTOGRAPH.contact_stiffness * np.maximum(line, 0),
        "k--",
        linewidth=0.9,
        label="50 kN/m, no pull",
    )
    law.set(xlabel="head above wire (mm)", ylabel="contact force (N)")
    law.set_title("force against the distance of head and wire: the contact's spring", loc="left", fontsize=9)
    points = loops.scatter(
        1e3 * (wire - NOMINAL), smooth[0], c=(x - x[0]) % 48.0, s=5, cmap="viridis", zorder=3
    )
    figure.colorbar(points, ax=loops, label="position in the span (m)")
    loops.set(xlabel="wire above nominal (mm)", ylabel="contact force, 0 to 20 Hz (N)")
    loops.set_title("force against the wire's height: a loop in each of two spans", loc="left", fontsize=9)
    for ax in (forces, heights, law):
        ax.legend(fontsize=8, loc="best", ncols=3)
    for ax in (forces, heights, law, loops):
        ax.grid(color="#dddddd", linewidth=0.6)
    return figure


def main(folder: Path) -> Numbers:
    run = cf.simulate(paper_shape(), [PANTOGRAPH], speed=SPEED)
    inside = run.window(0)
    x, force, wire = (
        run.data[name].values[0][inside] for name in ("position", "contact_force", "wire_height")
    )
    head = run.data["mass_height"].values[0, 0][inside]
    smooth = [
        low_pass(v, run.step, kind="zero-phase")[inside]
        for v in (run.data["contact_force"].values[0], balance(run))
    ]
    figure = draw(x, force, wire, head, smooth)
    statistics = run.contact_force_statistics()[0]
    caption = (
        "Two-mass pantograph of EN 50318:2002 at 250 km/h on the two-wire system, spans 4 and 5: contact"
        " force, wire and head height. The force is the contact's spring times the distance of head and wire"
        " (left), and it is what the masses' motion asks for (dashed); on the wire's height it depends in"
        " loops, one a span (right)."
    )
    missing = float(np.sqrt(np.mean((smooth[0] - smooth[1]) ** 2)))
    numbers = {
        "mean force (N)": statistics.mean,
        "standard deviation (N)": statistics.std,
        "contact loss (%)": 100 * statistics.contact_loss,
        "range of the wire's height (mm)": 1e3 * float(np.ptp(wire)),
        "correlation of force and wire height": float(np.corrcoef(smooth[0], wire)[0, 1]),
        "force balance of the masses, 0 to 20 Hz (N, rms)": missing,
    }
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
