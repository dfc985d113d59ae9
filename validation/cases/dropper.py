"""A dropper that goes slack and taut under a pulse, against an independent small model."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.wire_problem import PairMotion, WirePair, WireProblem, graded_nodes
from catenary_fe.layout import Wire
from catenary_fe.studies.single_wire import run_pair
from validation.case import Case
from validation.check import Check, compare_curves
from validation.engines import ENGINES, engine
from validation.paper_wire import MASS, TENSION, C, Floats, wire
from validation.pictures import COMPUTED, REFERENCE, label

# pulse that lifts the lower wire: height, half width and distance from the dropper at the start
HEIGHT, WIDTH, BEGIN = 0.012, 1.5, 10.0
STIFFNESS, PRELOAD, CLAMP = 20e3, 60.0, 0.3
UPPER = Wire(mass_per_length=1.07, tension=16e3, axial_stiffness=1.2e7)
TIME = 0.2
SOURCE = (
    "m ü + 2√(Tρ) u̇ = incident wave ± dropper on both wires, F = max(0, F₀ + k Δ): scipy's DOP853, derived"
)
REASON = "elements grow from 5 mm at the dropper, and the pulse is 12 of them wide: 0.1 to 0.2 %"


def pulse(x: Floats) -> Floats:
    return HEIGHT * np.exp(-(((x + BEGIN) / WIDTH) ** 2))


def pulse_rate(x: Floats) -> Floats:
    """[m/s] of the pulse that runs to the right."""
    return C * 2 * (x + BEGIN) / WIDTH**2 * pulse(x)


def compute(quick: bool) -> PairMotion:
    x = graded_nodes([-25, 25], 0.25, kinks=[0.0], finest=0.005)
    lower = WireProblem(
        wire=wire(), x=x, masses={0.0: CLAMP}, initial_deflection=pulse, initial_velocity=pulse_rate
    )
    pair = WirePair(
        lower=lower,
        upper=WireProblem(wire=UPPER, x=x, masses={0.0: CLAMP}),
        height=1.0,
        position=0.0,
        stiffness=STIFFNESS,
        preload=PRELOAD,
    )
    time = TimeSettings(step=2e-4 if quick else 1e-4, tolerance=1e-6)
    return run_pair(pair, duration=TIME, time=time, method=engine())


def reference(t: Floats, perturbation: float = 1.0) -> tuple[Floats, Floats, Floats]:
    """Heights [m] of the clamps on lower and upper wire, and the dropper's force [N]."""
    from scipy.integrate import solve_ivp

    preload = perturbation * PRELOAD
    below, above = 2 * np.sqrt(TENSION * MASS), 2 * np.sqrt(UPPER.tension * UPPER.mass_per_length)

    def dropper(lower: Floats, upper: Floats) -> Floats:
        return np.maximum(0.0, preload + STIFFNESS * (upper - lower))

    def rates(now: float, state: Floats) -> list[float]:
        lower, lower_rate, upper, upper_rate = state
        change = float(dropper(lower, upper)) - preload
        incident = float(pulse_rate(np.array(-C * now)))
        return [
            lower_rate,
            (below * (incident - lower_rate) + change) / CLAMP,
            upper_rate,
            (-above * upper_rate - change) / CLAMP,
        ]

    found = solve_ivp(rates, (0, t[-1]), [0.0] * 4, "DOP853", t_eval=t, rtol=1e-9, atol=1e-12, max_step=1e-3)
    return found.y[0], found.y[2], dropper(found.y[0], found.y[2])


def clamps(motion: PairMotion) -> tuple[Floats, Floats]:
    node = int(np.abs(motion.lower.x).argmin())
    return motion.lower.deflection[:, node], motion.upper.deflection[:, node]


def compare_motion(motion: PairMotion, perturbation: float) -> list[Check]:
    t = motion.lower.t
    names = (("clamp on the lower wire", "m"), ("clamp on the upper wire", "m"), ("dropper force", "N"))
    computed = (*clamps(motion), motion.dropper_force)
    return [
        compare_curves(
            name,
            t,
            found,
            wanted,
            0.005,
            source=SOURCE,
            reason=REASON,
            unit=unit,
            negative_control=unit == "N",
        )
        for (name, unit), found, wanted in zip(names, computed, reference(t, perturbation), strict=True)
    ]


def draw(motion: PairMotion, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    t = motion.lower.t
    lower, upper, force = reference(t)
    for name, found, wanted in zip(("lower", "upper"), clamps(motion), (lower, upper), strict=True):
        left.plot(t, 1e3 * found, **COMPUTED)
        left.plot(t, 1e3 * wanted, **REFERENCE)
        peak = int(np.argmax(wanted))
        left.annotate(f" {name} wire", (t[peak], 1e3 * wanted[peak]), va="bottom", fontsize=8)
    label(left, "t in s", "height of the clamp in mm")
    right.plot(t, motion.dropper_force, **COMPUTED, label="ANCF")
    right.plot(t, force, **REFERENCE, label="reference")
    label(right, "t in s", "dropper force in N")
    right.legend(fontsize=8)


CASE = Case(
    name="dropper",
    kind="verification",
    title="A dropper that goes slack and taut",
    text=(
        "A pulse 12 mm high runs along the paper's wire under a dropper (60 N, 20 kN/m) to a second"
        " wire; the pulse"
        " lifts the dropper slack. Until an echo comes back from the wires' ends, each wire is a"
        " damper to its clamp."
    ),
    off="the dropper's tension at rest is 1 % larger",
    engines=ENGINES,
    compute=compute,
    compare=compare_motion,
    draw=draw,
)
