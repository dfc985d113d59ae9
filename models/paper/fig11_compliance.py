"""Fig. 11: static deflection under 1 N as a function of its position on the contact wire.

Question: how does the compliance that a pantograph meets vary along a span, the source of parametric
excitation?
Parameters (paper): 1 N downward, evaluated where it acts.
Model: nonlinear statics of ``models/layouts/paper_cell.toml``; beside it the lift under 1 N upward
(``elasticity``), and the superposition of modes Σ φ²/ω² up to a cut-off. What the modes above it hold is
close to what they would on an infinite wire, ∫ dk/(π (T k² + S k⁴)) from the cut-off's wavenumber on.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from paper_common import (
    COMPUTED,
    COPPER,
    TENSION,
    Floats,
    Numbers,
    paper_shape,
    paper_wire,
    publish,
    run_script,
)

import catenary_fe as cf
from catenary_fe import theory
from catenary_fe.views.style import finish, mark_supports, new_axes

SPAN = 4
CUT_OFFS = {5.0: "#b9c7d3", 20.0: "#7fa3bd", 100.0: "#1f5a85"}  # Hz


def nodes_of_span(shape: cf.Shape) -> Floats:
    """[m] nodes of the contact wire in the span, where a kink needs no interpolation."""
    start, end = shape.catenary.support_positions[SPAN - 1 : SPAN + 1]
    nodes = shape.mesh.contact.x
    return nodes[(nodes >= start - 1e-9) & (nodes <= end + 1e-9)]


def above(cut_off: float) -> float:
    """[m/N] share of the modes above a cut-off [Hz] in the compliance, as on an infinite wire."""
    beam = paper_wire(COPPER).beam
    k, layer = float(theory.wavenumber(beam, 2 * np.pi * cut_off)), beam.boundary_layer_length
    return (1 / k - layer * (np.pi / 2 - np.arctan(layer * k))) / (np.pi * TENSION)


def downward(shape: cf.Shape, positions: Floats) -> Floats:
    """[m] deflection under 1 N downward, each position from a static solution of its own."""
    found = []
    for x in positions:
        state = cf.solve_statics(shape, [(float(x), -1.0)])
        found.append(np.interp(x, state.contact_wire_x, state.contact_wire_uplift))
    return np.array(found)


def main(folder: Path) -> Numbers:
    shape = paper_shape()
    nodes = nodes_of_span(shape)
    between = np.linspace(nodes[0], nodes[-1], 97)
    up = cf.elasticity(shape, force=1.0, positions=np.union1d(nodes, np.round(between, 9)))
    x, lift = up.position, up.values
    some = nodes[::4]
    down = downward(shape, some)
    modes = cf.solve_modes(shape, below=max(CUT_OFFS))
    ax = new_axes(None, (10.0, 4.6))
    mark_supports(ax, up.support_position)
    for cut_off, colour in CUT_OFFS.items():
        part = modes.below(cut_off)
        label = f"{len(part)} modes up to {cut_off:g} Hz"
        ax.plot(x, -1e3 * part.compliance(x), color=colour, linewidth=1.1, label=label)
    summed = modes.compliance(x) + above(max(CUT_OFFS))
    ax.plot(
        x,
        -1e3 * summed,
        color="black",
        linewidth=0.9,
        linestyle="--",
        label="and an infinite wire's share above",
    )
    ax.plot(x, -1e3 * lift, **COMPUTED, label="statics, 1 N upward, mirrored")
    ax.plot(
        some, 1e3 * down, "o", color="#c44e1c", markersize=4, fillstyle="none", label="statics, 1 N downward"
    )
    droppers = shape.catenary.dropper_positions
    ax.plot(droppers, np.zeros(droppers.size), "|", color="#777777", markersize=10, label="dropper")
    ax.set(xlim=(x[0] - 1, x[-1] + 1), ylim=(-1.65e3 * lift.max(), 0.02))
    ax.legend(fontsize=8, ncols=2, loc="lower center")
    finish(
        ax, "position of the force (m)", "deflection there (mm)", "Compliance of the contact wire, per newton"
    )
    caption = (
        "Deflection under 1 N where it acts, over one span: stiff at the droppers and supports, soft in the"
        " bays and at mid-span. The nonlinear statics, the elasticity curve and the superposition of modes"
        " agree: with the modes up to 100 Hz and an infinite wire's share above, within"
        f" {100 * np.abs(summed / lift - 1).max():.1f} %."
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
