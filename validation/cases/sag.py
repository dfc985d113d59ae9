"""Sag of a wire under its weight, with a tensioned end."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from catenary_fe.fe.wire_problem import WireProblem, even_nodes
from catenary_fe.layout import GRAVITY
from catenary_fe.studies.single_wire import wire_at_rest
from validation.case import Case
from validation.check import Check, compare
from validation.paper_wire import MASS, TENSION, Floats, wire
from validation.pictures import COMPUTED, REFERENCE, label

LENGTH = 60.0
PARABOLA = "textbook sag of a taut string, ρ g L²/(8T)"
CATENARY = "textbook catenary, (H/w)(cosh(wL/2H) − 1) with H = T, w = ρ g"
REASON = "cubic elements carry the parabola exactly; the catenary is 0.003 % deeper"


def weight() -> float:
    return MASS * GRAVITY


def catenary(x: Floats | float, tension: float = TENSION) -> Floats:
    scale = tension / weight()
    return np.asarray(scale * (np.cosh((x - LENGTH / 2) / scale) - np.cosh(LENGTH / 2 / scale)))


def parabola(x: Floats, tension: float = TENSION) -> Floats:
    return -weight() * x * (LENGTH - x) / (2 * tension)


def compute(quick: bool) -> tuple[Floats, Floats]:
    """Started from the parabola, so that the tensioned end stays at 60 m."""
    x = even_nodes([0, LENGTH / 2, LENGTH], 1.0)
    return x, wire_at_rest(WireProblem(wire=wire(), x=x, weight=True, initial_deflection=parabola))


def compare_curve(curve: tuple[Floats, Floats], perturbation: float) -> list[Check]:
    sag, tension = -float(curve[1].min()), perturbation * TENSION
    references = (
        ("sag, catenary", -float(catenary(LENGTH / 2, tension)), CATENARY),
        ("sag, parabola", weight() * LENGTH**2 / (8 * tension), PARABOLA),
    )
    return [
        compare(name, sag, reference, 1e-4, source=source, reason=REASON, unit="m")
        for name, reference, source in references
    ]


def draw(curve: tuple[Floats, Floats], figure: Figure) -> None:
    x, z = curve
    left, right = figure.subplots(1, 2)
    left.plot(x, 1e3 * z, **COMPUTED, label="ANCF")
    left.plot(x, 1e3 * catenary(x), **REFERENCE, label="catenary")
    label(left, "x in m", "height in mm")
    left.legend(fontsize=8)
    right.plot(x, 1e6 * (z - catenary(x)), **COMPUTED, label="ANCF")
    right.plot(x, 1e6 * (parabola(x) - catenary(x)), ":", color="grey", label="parabola")
    label(right, "x in m", "difference from the catenary in µm")
    right.legend(fontsize=8)


CASE = Case(
    name="sag",
    kind="verification",
    title="Sag with a tensioned end",
    text="60 m of the paper's wire under its weight, pulled at its end by 20 kN.",
    off="the tension is 1 % larger",
    compute=compute,
    compare=compare_curve,
    draw=draw,
)
