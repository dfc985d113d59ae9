"""Fig. 9: a symmetric low-frequency mode of the two-wire system.

Question: how does the two-wire system swing at low frequency?
Model: ``models/layouts/paper_cell.toml`` about its static state, droppers taut. Whether a mode is symmetric,
and whether the whole line or its bays swing, is computed from its shape (``Modes.kind``).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from paper_common import Numbers, paper_shape, publish, run_script

import catenary_fe as cf
from catenary_fe.views import plot_mode, plot_spectrum


def main(folder: Path) -> Numbers:
    modes = cf.solve_modes(paper_shape(cf.MeshSettings().halved()), below=20.0)
    kinds = modes.kinds()
    low = [i for i, k in enumerate(kinds) if (k.symmetry, k.kind) == ("symmetric", "whole line")]
    lowest, per_span = low[0], next(i for i in low if kinds[i].half_waves >= len(modes.catenary.spans) - 1)
    figure = Figure(figsize=(10.0, 9.0), layout="constrained")
    top, middle, bottom = figure.subplots(3, 1, height_ratios=[1, 1, 1.3])
    plot_mode(modes, lowest, ax=top)
    top.legend(fontsize=8, loc="upper right", ncols=3)
    plot_mode(modes, per_span, ax=middle)
    plot_spectrum(modes, ax=bottom)
    squares = [
        float(np.trapezoid(wire.values[lowest] ** 2, wire.x)) for wire in (modes.contact, modes.messenger)
    ]
    caption = (
        f"The lowest symmetric mode, {modes.frequencies[lowest]:.3f} Hz: both wires swing together, and"
        " within each span the shape is that of a string. It is not quite symmetric: the wires are fixed at"
        " the left end and pulled by weights at the right one. Below: a symmetric mode whose spans"
        " alternate, and all modes up to 20 Hz by what they are."
    )
    numbers = {
        "lowest symmetric mode (Hz)": float(modes.frequencies[lowest]),
        "its half-waves along the line": kinds[lowest].half_waves,
        "its mean square on the messenger wire over that on the contact wire": squares[1] / squares[0],
        "modes of the whole line below 20 Hz": modes.count_by_kind()["whole line"],
        "modes of bays in first shape below 20 Hz": modes.count_by_kind()["bays 1"],
        "modes of bays in second shape below 20 Hz": modes.count_by_kind()["bays 2"],
    }
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
