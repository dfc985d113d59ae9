"""A harmonic force that moves along an infinite string (eq. 6)."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireMotion, WireProblem, even_nodes
from validation.case import PERTURBED, Case
from validation.check import Check, compare_curves
from validation.engines import ENGINES
from validation.paper_wire import MASS, PAPER, STRING, C, Floats, run, wire
from validation.pictures import COMPUTED, REFERENCE, label

TIME, SPEED = 0.5, 0.725 * C
MEAN, AMPLITUDE, FREQUENCY = 120.0, 60.0, 2 * np.pi * 5.0
SOURCE = f"{PAPER}, eq. 4 to 6, sign of the F_d term and factor 1/(2ρc) put right"
REASON = "kinks at the fronts and under the force are rounded over one element, 0.1 % of the deflection"
FORCE = theory.HarmonicForce(mean=MEAN, amplitude=AMPLITUDE, angular_frequency=FREQUENCY)


def compute(quick: bool) -> WireMotion:
    x = even_nodes([-C * TIME - 3, 0, C * TIME + 3], 0.5 if quick else 0.25)
    problem = WireProblem(wire=wire(), x=x, loads=[theory.MovingForce(force=FORCE, speed=SPEED)])
    return run(problem, TIME, step=1e-3 if quick else 5e-4)


def under_force(t: Floats, sign: float = -1.0) -> Floats:
    """Eq. 6, which below the wave speed holds whatever V; the print has sign = +1."""
    varying = sign * (AMPLITUDE / FREQUENCY) * (np.cos(FREQUENCY * t) - 1)
    return np.asarray((MEAN * t + varying) / (2 * MASS * C))


def compare_motion(motion: WireMotion, perturbation: float) -> list[Check]:
    sign = 1.0 if perturbation == PERTURBED else -1.0
    force = theory.HarmonicForce(mean=MEAN, amplitude=-sign * AMPLITUDE, angular_frequency=FREQUENCY)
    exact = theory.moving_force(STRING, motion.x, TIME, speed=SPEED, force=force)
    under = motion.under_loads[:, 0]
    return [
        compare_curves(
            "deflection at 0.5 s",
            motion.x,
            motion.at(TIME),
            exact,
            0.005,
            source=SOURCE,
            reason=REASON,
            unit="m",
        ),
        compare_curves(
            "deflection under the force",
            motion.t,
            under,
            under_force(motion.t, sign),
            0.005,
            source=SOURCE,
            reason=REASON,
            unit="m",
        ),
    ]


def draw(motion: WireMotion, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    exact = theory.moving_force(STRING, motion.x, TIME, speed=SPEED, force=FORCE)
    left.plot(motion.x, 1e3 * motion.at(TIME), **COMPUTED, label="ANCF")
    left.plot(motion.x, 1e3 * exact, **REFERENCE, label="closed form")
    label(left, "x in m", "deflection in mm", f"t = {TIME:g} s, V = 0.725 c")
    right.plot(motion.t, 1e3 * motion.under_loads[:, 0], **COMPUTED, label="ANCF")
    right.plot(motion.t, 1e3 * under_force(motion.t), **REFERENCE, label="closed form")
    right.plot(motion.t, 1e3 * under_force(motion.t, 1.0), ":", color="grey", label="sign as printed")
    label(right, "t in s", "deflection in mm", "under the force")
    left.legend(fontsize=8)
    right.legend(fontsize=8)


CASE = Case(
    name="harmonic_force",
    kind="verification",
    title="Harmonic moving force on an infinite string",
    text="F = 120 N + 60 N sin Ωt with 5 Hz at V = 0.725 c for 0.5 s on the paper's wire.",
    off="the sign of the F_d term as it is printed in eq. 6",
    engines=ENGINES,
    compute=compute,
    compare=compare_motion,
    draw=draw,
)
