"""Fig. 10: symmetric modes of medium and of elevated frequency.

Question: when do the bays between droppers swing on their own, in their first shape, in their second?
Model: as fig. 9. Of the symmetric modes of each kind the one is drawn whose energy lies most in the bays: the
ends of the bays, the clamps, move least.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure
from paper_common import Numbers, paper_shape, paper_wire, publish, run_script

import catenary_fe as cf
from catenary_fe import theory
from catenary_fe.views import plot_mode


def clamp_motion(modes: cf.Modes, mode: int) -> float:
    """Root mean square of a mode at the clamps of the contact wire over that of the whole wire."""
    at_clamps = modes.contact.at(modes.catenary.dropper_positions)[mode]
    return float(at_clamps.std() / modes.contact.values[mode].std())


def main(folder: Path) -> Numbers:
    modes = cf.solve_modes(paper_shape(cf.MeshSettings().halved()), below=20.0)
    kinds, wanted = modes.kinds(), {1: "medium", 2: "elevated"}
    bay = 8.0
    alone = theory.natural_frequencies(paper_wire(195.0).beam, 2, length=bay) / (2 * np.pi)
    figure = Figure(figsize=(11.0, 6.4), layout="constrained")
    numbers: Numbers = {}
    for ax, (shape, name) in zip(figure.subplots(2, 1), wanted.items(), strict=True):
        found = [
            i
            for i, k in enumerate(kinds)
            if (k.symmetry, k.kind, k.half_waves) == ("symmetric", "bays", shape)
        ]
        chosen = min(found, key=lambda i: clamp_motion(modes, i))
        plot_mode(modes, chosen, ax=ax)
        ax.set_title(f"{name}: {ax.get_title(loc='left')}", fontsize=10, loc="left")
        numbers[f"drawn mode in shape {shape} (Hz)"] = float(modes.frequencies[chosen])
        numbers[f"one bay of {bay:g} m alone, shape {shape} (Hz)"] = float(alone[shape - 1])
        first = next(i for i, k in enumerate(kinds) if (k.kind, k.half_waves) == ("bays", shape))
        numbers[f"first mode with bays in shape {shape} (Hz)"] = float(modes.frequencies[first])
    figure.axes[0].legend(fontsize=8, loc="upper right", ncols=3)
    caption = (
        "Symmetric modes in which the bays swing between clamps that stay: in their first shape at"
        f" {numbers['drawn mode in shape 1 (Hz)']:.2f} Hz, in their second at"
        f" {numbers['drawn mode in shape 2 (Hz)']:.2f} Hz. A bay of 8 m alone, pinned, has {alone[0]:.2f} and"
        f" {alone[1]:.2f} Hz."
    )
    return publish(folder, __file__, figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
