"""Receptances at the head of the library's pantographs, base held, without contact; each with its source.

Run it with ``python models/studies/library_pantographs.py``; it draws the picture of the how-to
page. What is not linear in a pantograph is left out.
"""

from __future__ import annotations

import textwrap
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import catenary_fe as cf

FREQUENCIES = np.geomspace(0.2, 60.0, 800)  # Hz
PICTURE = Path(__file__).parents[2] / "docs/pictures/library_pantographs.png"
COLUMNS, WIDTH, LINES = 4, 46, 6  # panels in a row, letters in a line of a source, lines of the longest one


def main() -> None:
    """Draw."""
    names = cf.library.names("pantographs")
    rows = -(-len(names) // COLUMNS)
    figure, axes = plt.subplots(
        rows, COLUMNS, figsize=(13, 4.1 * rows), sharex=True, sharey=True, layout="constrained"
    )
    for ax, name in zip(axes.flat, names, strict=False):
        found = cf.pantograph_response(cf.library.pantograph(name), FREQUENCIES.tolist())
        ax.loglog(found.frequency, 1e3 * np.abs(found.receptance), color="#1f5a86")
        own = found.own_frequencies[found.own_frequencies > 0]
        for frequency in own:
            ax.axvline(frequency, color="#999999", linewidth=0.7, linestyle=":")
        listed = ", ".join(f"{f:.2g}" for f in own)
        ax.set_title(f"{name}: {listed} Hz", fontsize="medium", loc="left")
        source = textwrap.shorten(found.pantograph.source, WIDTH * LINES, placeholder=" …")
        text = textwrap.fill(source, WIDTH)
        ax.text(0.03, 0.03, text, transform=ax.transAxes, fontsize=6, va="bottom")
        ax.grid(which="major", color="#dddddd", linewidth=0.6)
        ax.set(xlim=FREQUENCIES[[0, -1]], ylim=(1e-5, 1e2))
    for ax in axes.flat[len(names) :]:
        ax.set_axis_off()
    for n, ax in enumerate(axes.flat[: len(names)]):
        ax.xaxis.set_tick_params(labelbottom=True)
        if n + COLUMNS >= len(names):
            ax.set_xlabel("frequency (Hz)")
        if n % COLUMNS == 0:
            ax.set_ylabel("receptance at the head (mm/N)")
    figure.savefig(PICTURE, dpi=110)


if __name__ == "__main__":
    main()
