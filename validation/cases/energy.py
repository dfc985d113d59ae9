"""Energy: a free wave keeps it, a moving force brings what the closed form says."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireMotion, WireProblem, even_nodes
from validation.case import Case
from validation.check import Check, compare, compare_curves
from validation.paper_wire import FORCE, MASS, PAPER, STRING, TENSION, C, Floats, run, wire
from validation.pictures import COMPUTED, REFERENCE, label

TIME, SPEED = 0.4, 0.725 * C
LENGTH, START = 100.0, 30.0
SOURCE_FREE = "conservation of energy; the initial energy from ½ ∫ T u'² dx"
SOURCE_REST = f"{PAPER}, eq. 4 with V = 0: work of the force, F² t/(2ρc)"
SOURCE_BEAM = f"{PAPER}, eq. 7 with 1: ½ ∫ (ρ u̇² + T u'² + EI u''²) dx of the sine series"
KEPT = "the trapezoidal rule keeps the energy of a linear system, which the wire nearly is"
FED = "of order h, from the kinks at the fronts and under the force"
SMOOTH = "the deflection is smooth; the step rounds off the first waves after the force's sudden start"
BENDING = 200e3
TEXT = """Linearised runs have no energy of the whole wire.
A pulse 20 mm high between fixed ends for 1 s; a force of 200 N at rest on a string, and one at V =
0.725 c on the wire with 200 kN m². No damping. On a string the moving force brings 1.3 % more energy than the
closed form's 103 J with elements of 0.5 m and of 0.25 m alike: presumably waves as short as the elements that
it passes, with hardly any deflection. With a bending stiffness that the mesh resolves the excess is gone."""


@dataclass(frozen=True)
class Runs:
    """A free pulse, a force at rest, a force that moves along the stiff wire."""

    free: WireMotion
    rest: WireMotion
    moving: WireMotion


def pulse(x: Floats) -> Floats:
    return 0.02 * np.exp(-(((x - 20) / 2.0) ** 2))


def compute(quick: bool) -> Runs:
    element, step = (0.5, 1e-3) if quick else (0.25, 2.5e-4)
    problem = WireProblem(wire=wire(), x=even_nodes([0, 60], element), initial_deflection=pulse)
    free = run(problem, 1.0, step=step, energy=True, interval=0.01, tolerance=1e-9, spectral_radius=1.0)
    x = even_nodes([-C * TIME - 3, 0, C * TIME + 3], element)
    load = theory.MovingForce(force=FORCE, speed=0.0)
    rest = run(WireProblem(wire=wire(), x=x, loads=[load]), TIME, step=step, energy=True, interval=0.01)
    load = theory.MovingForce(force=FORCE, speed=SPEED, start=START)
    problem = WireProblem(wire=wire(BENDING), x=even_nodes([0, LENGTH], 2 * element), loads=[load])
    moving = run(problem, TIME, step=step, energy=True, interval=TIME / 8)
    return Runs(free, rest, moving)


def pulse_energy() -> float:
    """[J] ½ T ∫ u'² of the bell: T A² √(π/2)/(2 b)."""
    return float(TENSION * 0.02**2 * np.sqrt(np.pi / 2) / (2 * 2.0))


def fed_at_rest(t: Floats, force: float = FORCE) -> Floats:
    """[J]"""
    return np.asarray(force**2 * t / (2 * STRING.impedance))


def fed_moving(t: Floats, force: float = FORCE) -> Floats:
    """[J] by differences of the series, whose terms beyond 400 carry nothing."""
    x, tick = np.linspace(0, LENGTH, 4001), 1e-5
    instants = np.maximum(t, tick)[:, None] + tick * np.array([-1, 0, 1])[:, None, None]
    beam = wire(BENDING).beam
    values: dict[str, Any] = {"length": LENGTH, "speed": SPEED, "start": START, "force": force, "modes": 400}
    before, now, after = (theory.moving_force_series(beam, x, at, **values) for at in instants)
    velocity = (after - before) / (2 * tick)
    slope = np.gradient(now, x, axis=1)
    curvature = np.gradient(slope, x, axis=1)
    density = MASS * velocity**2 + TENSION * slope**2 + BENDING * curvature**2
    return np.asarray(np.trapezoid(density, x, axis=1) / 2)


def compare_runs(runs: Runs, perturbation: float) -> list[Check]:
    change = float(np.ptp(runs.free.energy)) / pulse_energy()
    rest, moving = (motion.energy - motion.energy[0] for motion in (runs.rest, runs.moving))
    force = perturbation * FORCE
    return [
        compare(
            "free pulse: change in 1 s over the initial energy",
            change,
            0.0,
            1e-3,
            source=SOURCE_FREE,
            reason=KEPT,
            absolute=True,
            negative_control=False,
        ),
        compare_curves(
            "force at rest on a string: energy",
            runs.rest.t,
            rest,
            fed_at_rest(runs.rest.t, force),
            0.005,
            source=SOURCE_REST,
            reason=FED,
            unit="J",
        ),
        compare_curves(
            "moving force on a beam: energy",
            runs.moving.t,
            moving,
            fed_moving(runs.moving.t, force),
            0.005,
            source=SOURCE_BEAM,
            reason=SMOOTH,
            unit="J",
        ),
    ]


def draw(runs: Runs, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    change = (runs.free.energy - runs.free.energy[0]) / pulse_energy()
    left.plot(runs.free.t, 1e6 * change, **COMPUTED)
    label(left, "t in s", "change of energy in 1e-6 of the initial", "free pulse, through its echoes")
    for motion, fed, name in ((runs.rest, fed_at_rest, "at rest"), (runs.moving, fed_moving, "moving")):
        t = motion.t
        right.plot(t, motion.energy - motion.energy[0], **COMPUTED)
        right.plot(t, fed(t), **REFERENCE)
        right.annotate(f" {name}", (t[-1], fed(t)[-1]), fontsize=8, va="center")
    right.set_xlim(0, 1.2 * TIME)
    label(right, "t in s", "energy in J", "force of 200 N")
    right.legend(["ANCF", "closed form"], fontsize=8)


CASE = Case(
    name="energy",
    kind="verification",
    title="Energy of a free wave and of a driven one",
    text=TEXT,
    off="the force is 1 % larger: the energy goes with its square",
    engines=("nonlinear", "exudyn"),
    compute=compute,
    compare=compare_runs,
    draw=draw,
)
