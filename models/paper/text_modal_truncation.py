"""Text: a run as a sum of eigenforms below a cut-off, beside the full run (section 2.2).

Question: how much of the answer is left when the sum is cut at 20 Hz?
Parameters: two-wire system of fig. 6 at 250 km/h under a constant force of 50 N, an elastic pantograph (100 N
- 1 kN/m z) and the two-mass pantograph of EN 50318:2002 with 60 N: small enough that droppers hardly go
slack, since eigenforms know only taut ones.
Model: ANCF run against modal runs of 5 to 200 Hz, same mesh and step.
"""

from __future__ import annotations

from pathlib import Path

from matplotlib.figure import Figure
from paper_common import Numbers, paper_shape, publish, run_script

import catenary_fe as cf

SPEED = 250 / 3.6  # m/s
CUT_OFFS = (5.0, 10.0, 20.0, 50.0, 100.0, 200.0)  # Hz
PANTOGRAPHS = {
    "constant force": cf.ElasticPantograph(force=50.0),
    "elastic pantograph": cf.ElasticPantograph(force=100.0, stiffness=1000.0),
    "two-mass pantograph": cf.library.pantograph("EN 50318:2002").replace(uplift_force=60.0),
}
COLOURS = ("#1f5a85", "#c44e1c", "#3a7d44")


def main(folder: Path) -> Numbers:
    shape = paper_shape()
    modes = cf.solve_modes(shape, below=CUT_OFFS[-1])
    figure = Figure(figsize=(11.0, 8.0), layout="constrained")
    top, bottom = figure.subplots(2, 1, height_ratios=[1.2, 1])
    numbers: Numbers = {}
    counts = [len(modes.below(cut_off)) for cut_off in CUT_OFFS]
    for (name, pantograph), colour in zip(PANTOGRAPHS.items(), COLOURS, strict=True):
        full = cf.simulate(shape, [pantograph], speed=SPEED)
        height = full.data["wire_height"].values[0]
        parts = [cf.modal_run(shape, modes.below(f), pantograph, speed=SPEED) for f in CUT_OFFS]
        errors = [100 * part.error_against(height, of="wire_height") for part in parts]
        bottom.loglog(CUT_OFFS, errors, "o-", color=colour, label=f"{name}: height of the wire over the head")
        numbers[f"{name}: error of the wire's height, 20 Hz (%)"] = errors[2]
        numbers[f"{name}: error of the wire's height, 200 Hz (%)"] = errors[-1]
        if name == "two-mass pantograph":
            force = [100 * p.error_against(full.data["contact_force"].values[0]) for p in parts]
            bottom.loglog(CUT_OFFS, force, "o--", color=colour, label=f"{name}: contact force")
            numbers[f"{name}: error of the contact force, 200 Hz (%)"] = force[-1]
        if name == "elastic pantograph":
            x = full.data["position"].values[0]
            top.plot(x, 1e3 * (height - 5.3), "k", linewidth=1.6, label="full run")
            for i, style in ((0, "#c8d6e0"), (2, "#c44e1c"), (4, "#1f5a85")):
                label = f"{counts[i]} modes up to {CUT_OFFS[i]:g} Hz"
                top.plot(x, 1e3 * (parts[i].wire_height - 5.3), color=style, linewidth=1.0, label=label)
    top.set(xlim=(96, 288), xlabel="position (m)", ylabel="wire above nominal (mm)")
    top.set_title("wire over an elastic pantograph: full run and sums of modes", loc="left", fontsize=10)
    ticks = [f"{f:g}\n{n} modes" for f, n in zip(CUT_OFFS, counts, strict=True)]
    bottom.set_xticks(CUT_OFFS, ticks)
    bottom.minorticks_off()
    bottom.set(xlabel="cut-off (Hz)", ylabel="error over standard deviation (%)")
    for ax in (top, bottom):
        ax.grid(color="#dddddd", linewidth=0.6)
        ax.legend(fontsize=8, ncols=2)
    at_20 = numbers["elastic pantograph: error of the wire's height, 20 Hz (%)"]
    caption = (
        f"Runs at 250 km/h on the two-wire system as sums of eigenforms. Cut at 20 Hz ({counts[2]} modes),"
        f" the wire's height over the head misses {at_20:.0f} % of its deviation with an elastic pantograph;"
        " the error falls with the cut-off towards the full run."
    )
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
