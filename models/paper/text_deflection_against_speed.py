"""Text: largest deflection against V/c from 0 to 2, free, supported and two-wire: where is the motion stable?

Question: "the influence of the travelling speed on stability".
Parameters: the paper's wire (20 kN, 1.33 kg/m) without supports after 0.5 s; on rigid supports every 6 m,
first ten bays; the contact wire of the two-wire system of fig. 6, spans 3 to 6. A constant force; the answers
are linear in it and are given per newton.
Model: closed forms for the single wire; for the two-wire system the sum of all modes up to 100 Hz, and
nonlinear ANCF runs up to 1.25 c (50 N keep the droppers taut; faster ones the program takes for a mistake in
units).
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
from paper_common import DURATION, MASS, STRING, TENSION, C, Floats, Numbers, paper_shape, publish, run_script

import catenary_fe as cf
from catenary_fe import theory
from catenary_fe.views.style import finish, new_axes

RATIOS = np.round(np.arange(0.0, 2.01, 0.05), 2)
CHECKED = (0.25, 0.5, 0.75, 1.0, 1.25)
PUSH = cf.ElasticPantograph(force=50.0)
SUPPORTS = np.arange(0.0, 61.0, 6.0)


def free(ratio: float) -> float:
    """[m/N] largest deflection after the paper's 0.5 s."""
    x = np.linspace(-C * DURATION, max(1.0, ratio) * C * DURATION, 2001)
    return float(theory.moving_force(STRING, x, DURATION, speed=ratio * C, force=1.0).max())


def supported(ratio: float) -> float:
    """[m/N] largest deflection while the force runs over ten bays."""
    if ratio == 0.0:
        return float((SUPPORTS[1] - SUPPORTS[0]) / (4 * TENSION))  # at rest in the middle of a bay
    t = np.linspace(0.0, SUPPORTS[-1] / (ratio * C), 1200)
    x = np.linspace(SUPPORTS[0], SUPPORTS[-1], 241)
    u = theory.moving_force_on_supports(STRING, x, t[:, None], supports=SUPPORTS, speed=ratio * C, force=1.0)
    return float(np.abs(u).max())


def by_modes(shape: cf.Shape, modes: cf.Modes, ratio: float) -> float:
    """[m/N] largest uplift of the contact wire in spans 3 to 6 while the force runs there."""
    x = np.linspace(96, 288, 385)
    if ratio == 0.0:
        return float(modes.compliance(x).max())
    run = cf.modal_run(shape, modes, PUSH, speed=ratio * C, step=min(1e-3, 0.1 / (ratio * C)))
    inside = (run.position >= 96) & (run.position <= 288)
    every = max(1, int(inside.sum()) // 600)
    uplift = run.coordinates[inside][::every] @ modes.contact.at(x)
    return float(np.abs(uplift).max() / PUSH.contact_force(0.0))


def by_ancf(shape: cf.Shape, ratio: float) -> float:
    """The same by a nonlinear run."""
    run = cf.simulate(shape, [PUSH], speed=ratio * C, store_wire=2e-3, time=cf.TimeSettings(step=5e-4))
    data = run.data
    head = np.interp(data["wire_time"].values, run.time, data["position"].values[0])
    places = (data["x"].values >= 96) & (data["x"].values <= 288)
    times = (head >= 96) & (head <= 288)
    uplift = (data["contact_wire_height"] - data["static_contact_wire_height"]).values
    return float(np.abs(uplift[times][:, places]).max() / PUSH.contact_force(0.0))


def main(folder: Path) -> Numbers:
    shape = paper_shape()
    modes = cf.solve_modes(shape, below=100.0)
    curves: dict[str, Floats] = {
        "free, after 0.5 s (closed form)": np.array([free(r) for r in RATIOS]),
        "supports every 6 m (closed form)": np.array([supported(r) for r in RATIOS]),
        "two-wire system (modes to 100 Hz)": np.array([by_modes(shape, modes, r) for r in RATIOS]),
    }
    runs = np.array([by_ancf(shape, r) for r in CHECKED])
    ax = new_axes(None, (9.5, 5.0))
    for (name, values), colour in zip(curves.items(), ("#7b4fa3", "#1f5a85", "#c44e1c"), strict=True):
        ax.semilogy(RATIOS, 1e3 * values, ".-", color=colour, linewidth=1.4, label=name)
    ax.semilogy(CHECKED, 1e3 * runs, "ko", markersize=6, fillstyle="none", label="two-wire system (ANCF)")
    ax.axvline(1.0, color="#444444", linewidth=0.8, linestyle=":")
    ax.legend(fontsize=8, loc="lower right", bbox_to_anchor=(1.0, 0.2))
    finish(ax, "V/c", "largest deflection per newton (mm/N)", "Largest deflection against speed")
    _, _, two_wire = curves.values()
    at = np.interp(CHECKED, RATIOS, two_wire)
    numbers = {
        "free, any V up to c (mm/N)": 1e3 * float(curves["free, after 0.5 s (closed form)"][0]),
        "the same by F t/(2ρc) (mm/N)": 1e3 * DURATION / (2 * MASS * C),
        "supported at V = 0.7 c (mm/N)": 1e3 * float(np.interp(0.7, RATIOS, list(curves.values())[1])),
        "supported, largest of all speeds (mm/N)": 1e3 * float(list(curves.values())[1].max()),
        "two-wire at V = 0.7 c (mm/N)": 1e3 * float(np.interp(0.7, RATIOS, two_wire)),
        "two-wire, largest of all speeds (mm/N)": 1e3 * float(two_wire.max()),
        "two-wire, V/c of the largest": float(RATIOS[two_wire.argmax()]),
        "modes against ANCF up to 0.75 c, largest difference (%)": 100
        * float(np.abs(at / runs - 1)[:3].max()),
        "modes against ANCF at c and above, largest difference (%)": 100
        * float(np.abs(at / runs - 1)[3:].max()),
    }
    caption = (
        "Without supports the deflection grows with time at any speed (0.5 s here), and falls only beyond c."
        " Supports and the two-wire system bound it; both answer most strongly around the wave speed"
        f" (two-wire: V = {numbers['two-wire, V/c of the largest']:.2f} c)."
    )
    return publish(folder, __file__, ax.figure, caption, numbers)


if __name__ == "__main__":
    run_script(main)
