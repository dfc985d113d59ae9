"""A force that stays where it is and varies in time: Duhamel's integral."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireMotion, WireProblem, even_nodes
from validation.case import Case
from validation.check import Check, compare_curves
from validation.engines import ENGINES
from validation.paper_wire import PAPER, STRING, C, Floats, run, wire
from validation.pictures import COMPUTED, REFERENCE, label

TIME = 0.5
SOURCE = f"{PAPER}, eq. 4 with V = 0: w = ∫ F dt/(2 √(Tρ)) (Duhamel)"
REASON = "the kink under the force is rounded over one element, less than 0.1 % of the deflection"


def force() -> theory.HarmonicForce:
    return theory.HarmonicForce(mean=120.0, amplitude=80.0, angular_frequency=2 * np.pi * 6.0)


def compute(quick: bool) -> WireMotion:
    x = even_nodes([-C * TIME - 3, 0, C * TIME + 3], 0.5 if quick else 0.25)
    problem = WireProblem(wire=wire(), x=x, loads=[theory.MovingForce(force=force(), speed=0.0)])
    return run(problem, TIME, step=1e-3 if quick else 5e-4)


def exact(x: Floats | float, t: Floats | float) -> Floats:
    return theory.force_at_rest(STRING, x, t, force=force())


def compare_motion(motion: WireMotion, perturbation: float) -> list[Check]:
    x, t = motion.x, motion.t
    whole, under = perturbation * exact(x, TIME), perturbation * exact(0.0, t)
    return [
        compare_curves(
            "deflection at 0.5 s", x, motion.at(TIME), whole, 0.005, source=SOURCE, reason=REASON, unit="m"
        ),
        compare_curves(
            "deflection under the force",
            t,
            motion.under_loads[:, 0],
            under,
            0.005,
            source=SOURCE,
            reason=REASON,
            unit="m",
        ),
    ]


def draw(motion: WireMotion, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    left.plot(motion.x, 1e3 * motion.at(TIME), **COMPUTED, label="ANCF")
    left.plot(motion.x, 1e3 * exact(motion.x, TIME), **REFERENCE, label="closed form")
    label(left, "x in m", "deflection in mm", f"t = {TIME:g} s")
    right.plot(motion.t, 1e3 * motion.under_loads[:, 0], **COMPUTED, label="ANCF")
    right.plot(motion.t, 1e3 * exact(0.0, motion.t), **REFERENCE, label="closed form")
    label(right, "t in s", "deflection in mm", "under the force")
    left.legend(fontsize=8)


CASE = Case(
    name="force_at_rest",
    kind="verification",
    title="Varying force at rest on an infinite string",
    text="F = 120 N + 80 N sin Ωt with 6 Hz for 0.5 s at x = 0 of the paper's wire.",
    off="the force is 1 % larger",
    engines=ENGINES,
    compute=compute,
    compare=compare_motion,
    draw=draw,
)
