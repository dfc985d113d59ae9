"""A pulse that meets a lumped mass, and a spring: echo and what goes on."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireMotion, WireProblem, graded_nodes
from validation.case import Case
from validation.check import Check, compare_curves
from validation.engines import ENGINES
from validation.paper_wire import STRING, C, Floats, run, wire
from validation.pictures import COMPUTED, REFERENCE, label

HEIGHT, WIDTH, BEGIN = (
    0.002,
    1.0,
    12.0,
)  # m: of a bell-shaped pulse, and how far before the obstacle it starts
TIME = 0.16
OBSTACLES = {"mass of 2 kg": {"mass": 2.0}, "spring of 20 kN/m": {"stiffness": 20e3}}
SOURCE = (
    "r = −Z/(Z + 2√(Tρ)), in time: m ẅ + 2√(Tρ) ẇ + k w = 2√(Tρ) ṡ at the obstacle, derived from eq. 2 and 3"
)
REASON = (
    "a pulse 20 elements wide keeps its shape within 0.1 %; the kink at the obstacle, on 5 mm, adds as much"
)


def pulse(x: Floats) -> Floats:
    return HEIGHT * np.exp(-(((x + BEGIN) / WIDTH) ** 2))


def incident(t: Floats) -> Floats:
    """What the pulse alone would give at the obstacle."""
    return pulse(-C * t)


def compute(quick: bool) -> dict[str, WireMotion]:
    x = graded_nodes([-25, 15], 0.1, kinks=[0.0], finest=0.005)
    runs = {}
    for name, values in OBSTACLES.items():
        problem = WireProblem(
            wire=wire(),
            x=x,
            masses={0.0: values["mass"]} if "mass" in values else {},
            springs={0.0: values["stiffness"]} if "stiffness" in values else {},
            initial_deflection=pulse,
            initial_velocity=lambda x: C * 2 * (x + BEGIN) / WIDTH**2 * pulse(x),
        )
        step = 1e-4 if quick else 5e-5
        runs[name] = run(problem, TIME, step=step, interval=TIME, spectral_radius=1.0)
    return runs


def exact(x: Floats, name: str, perturbation: float = 1.0) -> Floats:
    values: dict[str, Any] = {key: perturbation * value for key, value in OBSTACLES[name].items()}
    step = WIDTH / C
    return theory.pulse_at_obstacle(
        STRING, x, TIME, incident=incident, begin=BEGIN / C - 6 * step, longest_step=step, **values
    )


def compare_runs(runs: dict[str, WireMotion], perturbation: float) -> list[Check]:
    checks = []
    for name, motion in runs.items():
        x, u, reference = motion.x, motion.deflection[-1], exact(motion.x, name, perturbation)
        for side, part in (("echo", x <= 0), ("what goes on", x >= 0)):
            checks.append(
                compare_curves(
                    f"{name}: {side}",
                    x[part],
                    u[part],
                    reference[part],
                    0.0025,
                    source=SOURCE,
                    reason=REASON,
                    unit="m",
                )
            )
    return checks


def draw(runs: dict[str, WireMotion], figure: Figure) -> None:
    for ax, (name, motion) in zip(figure.subplots(1, 2, sharey=True), runs.items(), strict=True):
        ax.plot(motion.x, 1e3 * pulse(motion.x), color="grey", linewidth=0.8, label="pulse at the start")
        ax.plot(motion.x, 1e3 * motion.deflection[-1], **COMPUTED, label="ANCF")
        ax.plot(motion.x, 1e3 * exact(motion.x, name), **REFERENCE, label="reference")
        label(ax, "x in m", "", f"{name}, t = {TIME:g} s")
    figure.axes[0].set_ylabel("deflection in mm")
    figure.axes[0].legend(fontsize=8)


CASE = Case(
    name="obstacle",
    kind="verification",
    title="Reflection at a lumped mass and at a spring",
    text="A bell-shaped pulse 2 mm high runs along the paper's wire into a mass or a spring at x = 0.",
    off="mass and spring are 1 % larger",
    engines=ENGINES,
    compute=compute,
    compare=compare_runs,
    draw=draw,
)
