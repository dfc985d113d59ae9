"""Fig. 13: an elastic pantograph on the two-wire system.

Question: what do droppers and messenger wire do to the waves of fig. 12?
Parameters: ``models/layouts/paper_cell.toml`` (contact wire 20 kN, 1.33 kg/m), 320 km/h, F = max(0, 200 N - 1
kN/m z), z the height above the nominal one (law ours); contact wire without bending and with the small
stiffness of copper (195 N m²).
Model: ANCF of both wires, droppers that go slack; the run starts from static contact.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from paper_common import (
    CELL,
    COPPER,
    FORCE,
    SLACKENING,
    SPEED,
    C,
    Floats,
    Numbers,
    publish,
    run_script,
    uplift_map,
)

import catenary_fe as cf
from catenary_fe.views import plot_space_time

PANTOGRAPH = cf.ElasticPantograph(force=FORCE, stiffness=SLACKENING)
WINDOW = (1.6, 2.6)  # s


def run_with(bending: float) -> cf.Run:
    line = cf.load_catenary(CELL)
    line = line.replace(contact_wire=line.contact_wire.replace(bending_stiffness=bending))
    return cf.simulate(cf.find_form(line), [PANTOGRAPH], speed=SPEED, store_wire=5e-3)


def main(folder: Path) -> Numbers:
    figure = Figure(figsize=(12.0, 8.0), layout="constrained")
    top, bottom = figure.add_gridspec(2, 1, height_ratios=[2, 1])
    maps = top.subgridspec(1, 2).subplots()
    force_axes = figure.add_subplot(bottom)
    numbers: Numbers = {}
    forces: list[Floats] = []
    for ax, bending in zip(maps, (0.0, COPPER), strict=True):
        run = run_with(bending)
        name = f"contact wire with S = {bending:g} N m²"
        x, t, uplift = uplift_map(run, WINDOW)
        head = run.data["position"].values[0]
        at = 8.0 + SPEED * t
        lines = {"pantograph": (at, t), "±c from mid-window": _fronts(t)}
        plot_space_time(x, t, uplift, lines=lines, title=f"{name}: uplift", ax=ax)
        droppers = run.data["dropper_position"].values
        ax.set_xlim(40, 330)
        ax.vlines(droppers, t[0], t[-1], color="black", linewidth=0.3, alpha=0.5)
        forces.append(run.data["contact_force"].values[0])
        force_axes.plot(head, forces[-1], linewidth=1.4 if not bending else 0.9, label=name)
        statistics = run.contact_force_statistics()[0]
        numbers[f"mean force, S = {bending:g} N m² (N)"] = statistics.mean
        numbers[f"standard deviation, S = {bending:g} N m² (N)"] = statistics.std
        numbers[f"largest uplift under the pantograph, S = {bending:g} N m² (mm)"] = 1e3 * float(
            run.data["wire_height"].values[0].max() - 5.3
        )
    for x in run.data["dropper_position"].values:
        force_axes.axvline(x, color="#bbbbbb", linewidth=0.5)
    for x in run.data["support_position"].values:
        force_axes.axvline(x, color="#444444", linewidth=0.8, linestyle=":")
    force_axes.set(xlabel="position of the pantograph (m)", ylabel="contact force (N)", xlim=(8, 376))
    force_axes.set_title("contact force; droppers grey, supports dotted", fontsize=10, loc="left")
    force_axes.legend(fontsize=8, loc="upper right")
    numbers["influence of the bending stiffness on the force (N, rms)"] = float(
        np.sqrt(np.mean((forces[1] - forces[0]) ** 2))
    )
    caption = (
        "An elastic pantograph at 320 km/h on the contact wire of the two-wire system: the uplift stays"
        f" within {numbers['largest uplift under the pantograph, S = 195 N m² (mm)']:.0f} mm, and every"
        " dropper (thin lines) reflects part of the waves. A small bending stiffness changes little."
    )
    return publish(folder, __file__, figure, caption, numbers)


def _fronts(t: Floats) -> tuple[Floats, Floats]:
    """The string's waves from the pantograph at the middle of the window."""
    middle = (t[0] + t[-1]) / 2
    start, end = 8.0 + SPEED * middle, t[-1]
    reach = C * (end - middle)
    return np.array([start - reach, start, start + reach]), np.array([end, middle, end])


if __name__ == "__main__":
    run_script(main)
