"""Fig. 14: two elastic pantographs 37 m apart.

Question: what does the trailing pantograph meet in the leading one's wake, and what does it send forward?
Parameters: as fig. 13 with the small bending stiffness: contact wire held by droppers only, 320 km/h, law of
fig. 12; distance 37 m (paper). Beside it one pantograph alone.
Model: ANCF of both wires; the run starts from static contact of both.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from paper_common import FORCE, SLACKENING, SPEED, Numbers, paper_shape, publish, run_script, uplift_map

import catenary_fe as cf
from catenary_fe.views import plot_space_time
from catenary_fe.views.style import PANTOGRAPHS

DISTANCE, START = 37.0, 8.0  # m
WINDOW = (1.6, 2.6)  # s
PANTOGRAPH = cf.ElasticPantograph(force=FORCE, stiffness=SLACKENING)


def main(folder: Path) -> Numbers:
    shape = paper_shape()
    pair = cf.simulate(
        shape, [PANTOGRAPH] * 2, speed=SPEED, positions=[START + DISTANCE, START], store_wire=5e-3
    )
    alone = cf.simulate(shape, [PANTOGRAPH], speed=SPEED, positions=[START])
    figure = Figure(figsize=(11.0, 8.5), layout="constrained")
    top, bottom = figure.subplots(2, 1, height_ratios=[1.6, 1])
    x, t, uplift = uplift_map(pair, WINDOW)
    lines = {
        name: (start + SPEED * t, t) for name, start in (("leading", START + DISTANCE), ("trailing", START))
    }
    plot_space_time(x, t, uplift, lines=lines, title="uplift of the contact wire", ax=top)
    top.set_xlim(40, 370)
    top.vlines(shape.catenary.dropper_positions, t[0], t[-1], color="black", linewidth=0.3, alpha=0.5)
    numbers: Numbers = {}
    curves = {
        "leading": (pair, 0, PANTOGRAPHS[0]),
        "trailing": (pair, 1, PANTOGRAPHS[1]),
        "alone": (alone, 0, "#888888"),
    }
    for name, (run, i, colour) in curves.items():
        statistics = run.contact_force_statistics()[i]
        numbers[f"mean force, {name} (N)"] = statistics.mean
        numbers[f"standard deviation, {name} (N)"] = statistics.std
        position, force = run.data["position"].values[i], run.data["contact_force"].values[i]
        label = f"{name}: mean {statistics.mean:.1f} N, σ {statistics.std:.1f} N"
        bottom.plot(position, force, color=colour, linewidth=0.9 if name == "alone" else 1.3, label=label)
    low, high = 96.0, 336.0
    at = np.linspace(low, high, 2000)
    of_leading, of_alone = (
        np.interp(at, run.data["position"].values[0], run.data["contact_force"].values[0])
        for run in (pair, alone)
    )
    numbers["what the trailing one does to the leading one (N, rms)"] = float(np.std(of_leading - of_alone))
    for support in shape.catenary.support_positions:
        bottom.axvline(support, color="#444444", linewidth=0.8, linestyle=":")
    bottom.set(xlim=(low, high), xlabel="position of each pantograph (m)", ylabel="contact force (N)")
    bottom.set_title(
        "contact force where each pantograph is; spans 4 and 5 evaluated", fontsize=10, loc="left"
    )
    bottom.legend(fontsize=8, loc="upper right", ncols=3)
    bottom.margins(y=0.2)
    caption = (
        f"Two elastic pantographs {DISTANCE:g} m apart at 320 km/h on the two-wire system: the trailing one"
        f" runs in the leading one's wake (σ {numbers['standard deviation, trailing (N)']:.1f} N against"
        f" {numbers['standard deviation, alone (N)']:.1f} N alone), and sends waves forward that reach the"
        " leading one."
    )
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
