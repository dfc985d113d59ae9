"""A mass on a contact spring that slides along an infinite string."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import SlidingPantograph, WireMotion, WireProblem, even_nodes
from catenary_fe.layout import Pantograph, Stage
from validation.case import Case
from validation.check import Check, compare_curves
from validation.engines import ENGINES
from validation.paper_wire import STRING, C, Floats, run, wire
from validation.pictures import COMPUTED, REFERENCE, label

TIME, SPEED = 0.5, 0.725 * C
MASS, CONTACT, BASE, DAMPING, UPLIFT = 8.0, 10e3, 2000.0, 50.0, 100.0
SOURCE = "m z̈ + d ż + b z = F₀ − F, F = k (z − u), 2√(Tρ) u̇ = F, derived from eq. 4 and 5"
REASON = (
    "the wire's kink under the head is rounded over one element, which softens the contact by about 0.2 %"
)


def compute(quick: bool) -> WireMotion:
    stage = Stage(mass=MASS, stiffness=BASE, damping=DAMPING)
    pantograph = Pantograph(stages=(stage,), uplift_force=UPLIFT, contact_stiffness=CONTACT)
    problem = WireProblem(
        wire=wire(),
        x=even_nodes([-C * TIME - 3, 0, C * TIME + 3], 0.25 if quick else 0.125),
        loads=[SlidingPantograph(pantograph=pantograph, uplift=UPLIFT, speed=SPEED)],
    )
    return run(problem, TIME, step=1e-3 if quick else 5e-4)


def exact(t: Floats, perturbation: float = 1.0) -> theory.SlidingOscillator:
    return _exact(tuple(t.tolist()), perturbation)


@lru_cache(maxsize=4)
def _exact(t: tuple[float, ...], perturbation: float) -> theory.SlidingOscillator:
    """At these times [s]; engines share them, and what costs more than their runs."""
    values: dict[str, Any] = {"base_stiffness": BASE, "base_damping": DAMPING}
    return theory.sliding_oscillator(
        STRING,
        t,
        speed=SPEED,
        mass=MASS,
        contact_stiffness=CONTACT,
        uplift_force=perturbation * UPLIFT,
        **values,
    )


def compare_motion(motion: WireMotion, perturbation: float) -> list[Check]:
    reference = exact(motion.t, perturbation)
    pairs = (
        ("contact force", motion.forces, reference.force, "N"),
        ("height of the mass", motion.heads, reference.mass_height, "m"),
        ("deflection under the mass", motion.under_loads, reference.deflection, "m"),
    )
    return [
        compare_curves(name, motion.t, computed[:, 0], wanted, 0.005, source=SOURCE, reason=REASON, unit=unit)
        for name, computed, wanted, unit in pairs
    ]


def draw(motion: WireMotion, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    reference = exact(motion.t)
    left.plot(motion.t, motion.forces[:, 0], **COMPUTED, label="ANCF")
    left.plot(motion.t, reference.force, **REFERENCE, label="closed form")
    label(left, "t in s", "contact force in N")
    left.legend(fontsize=8)
    for name, computed, wanted in (
        ("mass", motion.heads, reference.mass_height),
        ("wire", motion.under_loads, reference.deflection),
    ):
        right.plot(motion.t, 1e3 * computed[:, 0], **COMPUTED)
        right.plot(motion.t, 1e3 * np.asarray(wanted), **REFERENCE)
        place = (0.14, 1e3 * np.interp(0.14, motion.t, wanted))
        ends: dict[str, Any] = (
            {"ha": "right", "va": "bottom"} if name == "mass" else {"ha": "left", "va": "top"}
        )
        right.annotate(f" {name} ", place, fontsize=8, **ends)
    label(right, "t in s", "height in mm")


CASE = Case(
    name="sliding_oscillator",
    kind="verification",
    title="Linear oscillator sliding on a string",
    text=(
        "8 kg with a base spring and damper, pushed by 100 N against the paper's wire over a contact"
        " spring of"
        " 10 kN/m, at V = 0.725 c: the moving contact of the runs on a catenary."
    ),
    off="the uplift force is 1 % larger",
    engines=ENGINES,
    compute=compute,
    compare=compare_motion,
    draw=draw,
)
