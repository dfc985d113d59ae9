"""Rates of convergence in the mesh of the assembled wire, at rest and of its frequencies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireProblem, even_nodes
from catenary_fe.studies.single_wire import wire_at_rest
from validation.case import Case
from validation.cases.natural_frequencies import exact, frequencies
from validation.check import Check
from validation.paper_wire import TENSION, Floats, wire
from validation.pictures import label
from validation.rates import compare_rate, draw_rate

LENGTH, MODE = 30.0, 5  # m, six metres a half wave
MIDDLE, FORCE, TIE = LENGTH / 2, 1.0, 200e3  # m, N, N m²: a boundary layer of 3.2 m
ELEMENTS = np.array([1.0, 0.75, 0.6, 0.5])
COARSE = np.array([3.0, 2.5, 1.875, 1.5])  # m, halves of the wire are whole numbers of them
BEAM = 20e6  # N m², so stiff that bending decides
EIGENVALUES = (
    "finite-element theory: eigenvalues of cubic elements err by h^2(4−m), m the order of the"
    " energy's derivative"
)
NODES = "finite-element theory: deflections of cubic elements at nodes err by h^2(4−m), m = 2 with bending"

TEXT = """30 m of the paper's wire, as assembled for every engine: deflection under 1 N in the middle with
EI = 200 kN m² in elements of 3 to 1.5 m (of 200 N the large motion, which the closed form leaves out, is
1e-5 and would hide the rate); fifth frequency as a string (m = 1) and with EI = 20 MN m² (m = 2), in elements
of 1 to 0.5 m."""


@dataclass(frozen=True)
class Study:
    """By element length: deflection [m] under a force on a tie, fifth frequency [Hz] of string and beam."""

    tie: Floats
    string: Floats
    beam: Floats


def compute(quick: bool) -> Study:
    return Study(
        tie=np.array([under_force(element) for element in COARSE]),
        string=np.array([frequency(element, 0.0) for element in ELEMENTS]),
        beam=np.array([frequency(element, BEAM) for element in ELEMENTS]),
    )


def under_force(element: float) -> float:
    load = theory.MovingForce(force=FORCE, speed=0.0, start=MIDDLE)
    problem = WireProblem(wire=wire(TIE), x=even_nodes([0, MIDDLE, LENGTH], element), loads=[load])
    return float(wire_at_rest(problem)[problem.node(MIDDLE)])


def frequency(element: float, bending: float) -> float:
    return float(frequencies(even_nodes([0, LENGTH], element), bending, MODE)[-1])


def errors(study: Study, perturbation: float = 1.0) -> tuple[Floats, Floats, Floats]:
    """Relative, of the deflection and the two frequencies."""
    tie = wire(TIE, tension=perturbation * TENSION).beam
    wanted = theory.static_deflection(
        tie, np.array([MIDDLE]), length=LENGTH, position=MIDDLE, force=FORCE
    ).item()
    string, beam = (exact(MODE, bending, perturbation, LENGTH)[-1] for bending in (0.0, BEAM))
    return abs(study.tie / wanted - 1), abs(study.string / string - 1), abs(study.beam / beam - 1)


def compare_study(study: Study, perturbation: float) -> list[Check]:
    tie, string, beam = errors(study, perturbation)
    return [
        compare_rate("deflection under a force on a tie, order in h", COARSE, tie, 4, source=NODES),
        compare_rate("frequency of a string, order in h", ELEMENTS, string, 6, source=EIGENVALUES),
        compare_rate("frequency of a beam, order in h", ELEMENTS, beam, 4, source=EIGENVALUES),
    ]


def draw(study: Study, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    tie, string, beam = errors(study)
    draw_rate(left, COARSE, tie, 4, "tie under a force")
    label(left, "element in m", "relative error of the deflection")
    draw_rate(right, ELEMENTS, string, 6, "string")
    draw_rate(right, ELEMENTS, beam, 4, "beam")
    label(right, "element in m", "relative error of the fifth frequency")


CASE = Case(
    name="convergence",
    kind="verification",
    title="Rates of convergence in the mesh, at rest",
    text=TEXT,
    off="the tension is 1 % larger",
    compute=compute,
    compare=compare_study,
    draw=draw,
)
