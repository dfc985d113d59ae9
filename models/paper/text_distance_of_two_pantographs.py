"""Text: two pantographs, and how their distance matters.

Question: at which distances does the trailing pantograph suffer from the leading one's wake?
Parameters: as fig. 14 (two-wire system, 320 km/h, elastic pantographs), distances from 13 to 109 m; the span
is 48 m.
Model: ANCF of both wires; standard deviation of the contact forces in spans 4 and 5.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from paper_common import FORCE, SLACKENING, SPEED, Numbers, paper_shape, publish, run_script

import catenary_fe as cf
from catenary_fe.views.style import PANTOGRAPHS, finish, new_axes

START = 8.0  # m
DISTANCES = np.arange(13.0, 110.0, 6.0)  # m, the paper's 37 m among them
PANTOGRAPH = cf.ElasticPantograph(force=FORCE, stiffness=SLACKENING)


def main(folder: Path) -> Numbers:
    shape = paper_shape()
    alone = cf.simulate(shape, [PANTOGRAPH], speed=SPEED, positions=[START]).contact_force_statistics()[0].std
    deviations = []
    for distance in DISTANCES:
        run = cf.simulate(shape, [PANTOGRAPH] * 2, speed=SPEED, positions=[START + distance, START])
        deviations.append([s.std for s in run.contact_force_statistics()])
    leading, trailing = np.array(deviations).T
    ax = new_axes(None, (9.5, 4.6))
    for name, values, colour in (
        ("leading", leading, PANTOGRAPHS[0]),
        ("trailing", trailing, PANTOGRAPHS[1]),
    ):
        ax.plot(DISTANCES, values, "o-", color=colour, label=name)
    ax.axhline(alone, color="#888888", linestyle="--", linewidth=1.0, label="alone")
    for spans in (1, 2):
        ax.axvline(
            48.0 * spans, color="#444444", linestyle=":", linewidth=0.8, label="span" if spans == 1 else None
        )
    ax.axvline(37.0, color="#3a7d44", linestyle="-.", linewidth=0.8, label="37 m, fig. 14")
    ax.set_ylim(0, 1.25 * max(trailing.max(), leading.max()))
    ax.legend(fontsize=8, ncols=5, loc="upper center")
    finish(
        ax,
        "distance of the pantographs (m)",
        "standard deviation of the contact force (N)",
        "Two pantographs",
    )
    caption = (
        f"Two elastic pantographs at 320 km/h on the two-wire system. Alone, σ is {alone:.1f} N; the trailing"
        f" one has between {trailing.min():.1f} N at {DISTANCES[trailing.argmin()]:g} m and"
        f" {trailing.max():.1f} N at {DISTANCES[trailing.argmax()]:g} m, the leading one up to"
        f" {leading.max():.1f} N."
    )
    numbers = {
        "alone (N)": alone,
        "trailing, largest (N)": float(trailing.max()),
        "trailing, distance of the largest (m)": float(DISTANCES[trailing.argmax()]),
        "trailing, smallest (N)": float(trailing.min()),
        "trailing, distance of the smallest (m)": float(DISTANCES[trailing.argmin()]),
        "leading, largest (N)": float(leading.max()),
    }
    return publish(folder, __file__, ax.figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
