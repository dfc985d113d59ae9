"""An initial deflection that splits into two waves (fig. 2), and their inverted echoes."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireMotion, WireProblem, even_nodes
from validation.case import Case
from validation.check import Check, compare_curves
from validation.engines import ENGINES
from validation.paper_wire import PAPER, TENSION, Floats, run, wire
from validation.pictures import COMPUTED, REFERENCE, label

LENGTH, PLACE, WIDTH, HEIGHT = 60.0, 20.0, 2.0, 0.005
TIMES = (0.1, 0.25, 0.6)  # two waves, one of them inverted, both and again
SOURCE = f"{PAPER}, eq. 3 (d'Alembert), odd and periodic beyond the ends"
REASON = "steps of 0.125 ms delay the pulse's waves by (ωΔt)²/12, 0.1 % of its width after 0.6 s"


def bell(x: Floats) -> Floats:
    return HEIGHT * np.exp(-(((x - PLACE) / WIDTH) ** 2))


def compute(quick: bool) -> WireMotion:
    problem = WireProblem(wire=wire(), x=even_nodes([0, LENGTH], 0.25), initial_deflection=bell)
    return run(problem, TIMES[-1], step=2.5e-4 if quick else 1.25e-4, interval=0.05, spectral_radius=1.0)


def exact(x: Floats, t: float, perturbation: float = 1.0) -> Floats:
    string = wire(tension=perturbation * TENSION).beam
    return theory.reflected_waves(string, x, t, length=LENGTH, initial_deflection=bell)


def compare_motion(motion: WireMotion, perturbation: float) -> list[Check]:
    return [
        compare_curves(
            f"deflection at {t:g} s",
            motion.x,
            motion.at(t),
            exact(motion.x, t, perturbation),
            0.005,
            source=SOURCE,
            reason=REASON,
            unit="m",
        )
        for t in TIMES
    ]


def draw(motion: WireMotion, figure: Figure) -> None:
    for ax, t in zip(figure.subplots(1, len(TIMES), sharey=True), TIMES, strict=True):
        ax.plot(motion.x, 1e3 * bell(motion.x), color="grey", linewidth=0.8, label="at the start")
        ax.plot(motion.x, 1e3 * motion.at(t), **COMPUTED, label="ANCF")
        ax.plot(motion.x, 1e3 * exact(motion.x, t), **REFERENCE, label="closed form")
        label(ax, "x in m", "", f"t = {t:g} s")
    figure.axes[0].set_ylabel("deflection in mm")
    figure.axes[0].legend(fontsize=8, loc="lower right")


CASE = Case(
    name="pulse_and_echo",
    kind="verification",
    title="A pulse, its two waves and their inverted echoes",
    text="A bell 5 mm high on 60 m of the paper's wire is let go from rest.",
    off="the tension is 1 % larger",
    engines=ENGINES,
    compute=compute,
    compare=compare_motion,
    draw=draw,
)
