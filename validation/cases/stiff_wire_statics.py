"""A tensioned beam under a point force, and its boundary layer."""

from __future__ import annotations

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireProblem, graded_nodes
from catenary_fe.studies.single_wire import wire_at_rest
from validation.case import Case
from validation.check import Check, compare, compare_curves
from validation.paper_wire import FORCE, TENSION, Floats, wire
from validation.pictures import REFERENCE, label

LENGTH, MIDDLE = 60.0, 30.0
BENDING = (195.0, 200e3)  # contact wire, paper's fig. 7
Curves = dict[float, tuple[Floats, Floats]]
SOURCE = (
    "textbook ties: w = (F L/4T)(1 − tanh u/u), u = (L/2)√(T/EI); near the force −(F/2T)[d − ℓ(1 −"
    " exp(−d/ℓ))]"
)
REASON = (
    "elements start at the force with a fifth of the boundary layer ℓ = √(EI/T), where cubics err by 1e-5"
)


def compute(quick: bool) -> Curves:
    curves = {}
    for bending in BENDING:
        layer = wire(bending).beam.boundary_layer_length
        x = graded_nodes([0, LENGTH], 0.5, kinks=[MIDDLE], finest=min(0.5, layer / 5), growth=1.25)
        load = theory.MovingForce(force=FORCE, speed=0.0, start=MIDDLE)
        curves[bending] = x, wire_at_rest(WireProblem(wire=wire(bending), x=x, loads=[load]))
    return curves


def exact(x: Floats, bending: float, tension: float = TENSION) -> Floats:
    beam = wire(bending, tension=tension).beam
    return theory.static_deflection(beam, x, length=LENGTH, position=MIDDLE, force=FORCE)


def near(x: Floats, bending: float) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
    return np.asarray(np.abs(x - MIDDLE) <= 4 * wire(bending).beam.boundary_layer_length)


def compare_curves_(curves: Curves, perturbation: float) -> list[Check]:
    checks = []
    for bending, (x, u) in curves.items():
        reference, under = exact(x, bending, perturbation * TENSION), int(np.abs(x - MIDDLE).argmin())
        name = f"EI = {bending:g} N m²"
        checks.append(
            compare(
                f"{name}: deflection under the force",
                u[under],
                reference[under],
                1e-4,
                source=SOURCE,
                reason=REASON,
                unit="m",
            )
        )
        inside = near(x, bending)
        beam = wire(bending, tension=perturbation * TENSION).beam
        layer = theory.static_deflection_unbounded(beam, x[inside], force=FORCE, position=MIDDLE)
        checks.append(
            compare_curves(
                f"{name}: drop within four boundary layers of the force",
                x[inside],
                u[inside] - u[under],
                layer,
                1e-3,
                source=SOURCE,
                reason="the drop is a small difference: 1e-4 of the deflection is up to 1e-3 of it",
                unit="m",
            )
        )
    return checks


def draw(curves: Curves, figure: Figure) -> None:
    for ax, (bending, (x, u)) in zip(figure.subplots(1, 2), curves.items(), strict=True):
        inside = near(x, bending)
        ax.plot(x[inside], 1e3 * u[inside], "o", markersize=3, color="#c1440e", label="ANCF, nodes")
        fine = np.linspace(x[inside][0], x[inside][-1], 400)
        ax.plot(fine, 1e3 * exact(fine, bending), **REFERENCE, label="tensioned beam")
        ax.plot(fine, 1e3 * exact(fine, 0.0), ":", color="grey", label="string")
        label(ax, "x in m", "deflection in mm", f"EI = {bending:g} N m²")
    figure.axes[0].legend(fontsize=8)


CASE = Case(
    name="stiff_wire_statics",
    kind="verification",
    title="Tensioned beam under a point force, and its boundary layer",
    text=(
        "200 N in the middle of 60 m of the paper's wire with bending stiffness, pulled at its end by 20 kN."
    ),
    off="the tension is 1 % larger",
    compute=compute,
    compare=compare_curves_,
    draw=draw,
)
