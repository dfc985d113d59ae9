"""Fig. 11: static deflection under 1 N as a function of its position on the contact wire.

Question: how does the compliance that a pantograph meets vary along a span, the source of parametric excitation?
Parameters (paper): 1 N downward, evaluated where it acts.
Model: nonlinear statics of ``models/layouts/paper_cell.toml``; beside it the lift under 1 N upward (``elasticity``), and
the superposition of modes Σ φ²/ω² up to a cut-off. What the modes above it hold is close to a string's, 1/(πρcω).
"""

from __future__ import annotations

from pathlib import Path

import catenary_fe as cf
import numpy as np
from catenary_fe.views.style import finish, mark_supports, new_axes
from paper_common import COMPUTED, MASS, C, Floats, Numbers, paper_shape, publish, run_script

SPAN = 4
CUT_OFFS = {5.0: "#b9c7d3", 20.0: "#7fa3bd", 100.0: "#1f5a85"}  # Hz


def downward(shape: cf.Shape, positions: Floats) -> Floats:
    """[m] deflection under 1 N downward, each position from a static solution of its own."""
    found = []
    for x in positions:
        state = cf.solve_statics(shape, [(float(x), -1.0)])
        found.append(np.interp(x, state.contact_wire_x, state.contact_wire_uplift))
    return np.array(found)


def main(folder: Path) -> Numbers:
    shape = paper_shape(cf.MeshSettings().halved())
    up = cf.elasticity(shape, force=1.0, spans=[SPAN], points_per_span=48)
    x, lift = up.position, up.values
    some = x[::6]
    down = downward(shape, some)
    modes = cf.solve_modes(shape, below=max(CUT_OFFS))
    ax = new_axes(None, (10.0, 4.6))
    mark_supports(ax, up.support_position)
    for cut_off, colour in CUT_OFFS.items():
        part = modes.below(cut_off)
        label = f"{len(part)} modes up to {cut_off:g} Hz"
        ax.plot(x, -1e3 * part.compliance(x), color=colour, linewidth=1.1, label=label)
    summed = modes.compliance(x) + 1 / (np.pi * MASS * C * 2 * np.pi * max(CUT_OFFS))
    ax.plot(x, -1e3 * summed, color="black", linewidth=0.9, linestyle="--", label="and a string's share above it")
    ax.plot(x, -1e3 * lift, **COMPUTED, label="statics, 1 N upward, mirrored")
    ax.plot(some, 1e3 * down, "o", color="#c44e1c", markersize=4, fillstyle="none", label="statics, 1 N downward")
    droppers = shape.catenary.dropper_positions
    ax.plot(droppers, np.zeros(droppers.size), "|", color="#777777", markersize=10, label="dropper")
    ax.set(xlim=(x[0] - 1, x[-1] + 1), ylim=(-1.25e3 * lift.max(), 0.02))
    ax.legend(fontsize=8, ncols=2, loc="lower center")
    finish(ax, "position of the force (m)", "deflection there (mm)", "Compliance of the contact wire, per newton")
    caption = (
        "Deflection under 1 N where it acts, over one span: stiff at the droppers and supports, soft in the bays and at"
        " mid-span. The nonlinear statics, the elasticity curve and the superposition of modes agree: with the modes up"
        f" to 100 Hz and a string's share above, within {100 * np.abs(summed / lift - 1).max():.1f} %."
    )
    numbers = {
        "smallest compliance (mm/N)": 1e3 * float(lift.min()),
        "largest compliance (mm/N)": 1e3 * float(lift.max()),
        "non-uniformity (%)": 100 * up.non_uniformity,
        "downward against upward, largest difference (%)": 100
        * float(np.abs(-down / np.interp(some, x, lift) - 1).max()),
        "modes against statics, largest difference (%)": 100 * float(np.abs(summed / lift - 1).max()),
    }
    return publish(folder, __file__, ax.figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
