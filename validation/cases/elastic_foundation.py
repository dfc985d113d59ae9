"""A force that moves steadily along a wire on an elastic foundation."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireMotion, WireProblem, even_nodes
from validation.case import Case
from validation.check import Check, compare_curves
from validation.engines import ENGINES
from validation.paper_wire import FORCE, C, Floats, run, wire
from validation.pictures import COMPUTED, REFERENCE, label

TIME, SPEED, FOUNDATION = 0.3, 0.725 * C, 2000.0
BENDING = (0.0, 195.0, 200e3)  # string, contact wire, paper's fig. 7
SOURCE = (
    "textbook problem (Frýba, recalled, not read); w = F/(2√(kT')) exp(−|ξ|√(k/T')), beam likewise, derived"
)
REASON = "of order h for the string, whose kink has no width: 0.7, 0.3 and 0.1 % at 0.25, 0.125 and 0.0625 m"


def exact(x: Floats, t: float, bending: float, foundation: float = FOUNDATION) -> Floats:
    beam = replace(wire(bending).beam, foundation_stiffness=foundation)
    return theory.steady_moving_force(beam, x - SPEED * t, speed=SPEED, force=FORCE)


def compute(quick: bool) -> dict[float, WireMotion]:
    element, step = (0.25, 5e-4) if quick else (0.125, 2.5e-4)
    chosen = BENDING[1:] if quick else BENDING
    return {bending: run(problem(bending, element), TIME, step=step, interval=TIME) for bending in chosen}


def problem(bending: float, element: float) -> WireProblem:
    """Start from the steady state, which must travel on unchanged."""

    def deflection(x: Floats) -> Floats:
        return exact(x, 0.0, bending)

    def velocity(x: Floats) -> Floats:
        return (exact(x, 1e-6, bending) - exact(x, -1e-6, bending)) / 2e-6

    return WireProblem(
        wire=wire(bending),
        # the force starts in the middle of an element: a string's kink at a node has no slope to start from
        x=even_nodes([-35, -element / 2, element / 2, SPEED * TIME + 35], element),
        foundation_stiffness=FOUNDATION,
        initial_deflection=deflection,
        initial_velocity=velocity,
        loads=[theory.MovingForce(force=FORCE, speed=SPEED)],
    )


def compare_runs(runs: dict[float, WireMotion], perturbation: float) -> list[Check]:
    return [
        compare_curves(
            f"EI = {bending:g} N m²: deflection after {TIME:g} s",
            motion.x,
            motion.deflection[-1],
            exact(motion.x, TIME, bending, perturbation * FOUNDATION),
            0.005,
            source=SOURCE,
            reason=REASON,
            unit="m",
        )
        for bending, motion in runs.items()
    ]


def draw(runs: dict[float, WireMotion], figure: Figure) -> None:
    for ax, (bending, motion) in zip(figure.subplots(1, 3, sharey=True), runs.items(), strict=True):
        near = np.abs(motion.x - SPEED * TIME) < 15
        x = motion.x[near]
        ax.plot(x, 1e3 * motion.deflection[-1, near], **COMPUTED, label="ANCF")
        ax.plot(x, 1e3 * exact(x, TIME, bending), **REFERENCE, label="closed form")
        label(ax, "x in m", "", f"EI = {bending:g} N m², t = {TIME:g} s")
    figure.axes[0].set_ylabel("deflection in mm")
    figure.axes[0].legend(fontsize=8)


CASE = Case(
    name="elastic_foundation",
    kind="verification",
    title="Steadily moving force on an elastic foundation",
    text=(
        "200 N at V = 0.725 c on a foundation of 2 kN/m²; the run starts from the steady state, which"
        " must travel on."
    ),
    off="the foundation is 1 % stiffer",
    engines=ENGINES,
    compute=compute,
    compare=compare_runs,
    draw=draw,
)
