"""A string under a point force, at rest."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireProblem, graded_nodes
from catenary_fe.studies.single_wire import wire_at_rest
from validation.case import Case
from validation.check import Check, compare, compare_curves
from validation.paper_wire import FORCE, TENSION, Floats, wire
from validation.pictures import COMPUTED, REFERENCE, label

LENGTH, PLACE = 60.0, 20.0
SOURCE = "textbook statics of a string, F x (L − x)/(T L)"
REASON = "the aim of the suite: the kink, rounded over elements of 5 mm, lowers the deflection by 4e-5"


def compute(quick: bool) -> tuple[Floats, Floats]:
    x = graded_nodes([0, LENGTH], 0.5, kinks=[PLACE], finest=0.005)
    load = theory.MovingForce(force=FORCE, speed=0.0, start=PLACE)
    return x, wire_at_rest(WireProblem(wire=wire(), x=x, loads=[load]))


def exact(x: Floats, tension: float = TENSION) -> Floats:
    beam = wire(tension=tension).beam
    return theory.static_deflection(beam, x, length=LENGTH, position=PLACE, force=FORCE)


def compare_curve(curve: tuple[Floats, Floats], perturbation: float) -> list[Check]:
    x, u = curve
    reference = exact(x, perturbation * TENSION)
    under = int(np.abs(x - PLACE).argmin())
    return [
        compare(
            "deflection under the force",
            u[under],
            reference[under],
            1e-4,
            source=SOURCE,
            reason=REASON,
            unit="m",
        ),
        compare_curves("deflection", x, u, reference, 1e-4, source=SOURCE, reason=REASON, unit="m"),
    ]


def draw(curve: tuple[Floats, Floats], figure: Figure) -> None:
    x, u = curve
    left, right = figure.subplots(1, 2)
    left.plot(x, 1e3 * u, **COMPUTED, label="ANCF")
    left.plot(x, 1e3 * exact(x), **REFERENCE, label="closed form")
    label(left, "x in m", "deflection in mm")
    left.legend(fontsize=8)
    right.plot(x, 1e6 * (u - exact(x)), **COMPUTED)
    label(right, "x in m", "difference in µm")


CASE = Case(
    name="point_force",
    kind="verification",
    title="Static point force on a string",
    text=(
        "200 N at a third of 60 m of the paper's wire, pulled at its end by 20 kN: with a tensioned"
        " end the pull along"
        " the track is T everywhere, and the triangle exact at any inclination. The wire's one slope"
        " at the node under"
        " the force rounds the kink over an element: 0.5 m leaves 0.2 % there, 5 mm 0.004 %."
    ),
    off="the tension is 1 % larger",
    compute=compute,
    compare=compare_curve,
    draw=draw,
)
