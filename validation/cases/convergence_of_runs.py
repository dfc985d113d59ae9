"""Rates of convergence in mesh and step of each engine's runs, where the solution is smooth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from catenary_fe.fe.wire_problem import WireProblem, even_nodes
from validation.case import PERTURBED, Case
from validation.check import Check, rms
from validation.engines import ENGINES
from validation.paper_wire import TENSION, Floats, run, wire
from validation.pictures import label
from validation.rates import compare_rate, draw_rate

LENGTH, HEIGHT = 30.0, 1e-3  # m
NUMBER = 3 * np.pi / LENGTH  # rad/m, of the third sine shape
STEPS = np.array([4e-3, 2e-3, 1e-3, 5e-4])
STRING_END, STRING_ELEMENT = 0.4, 0.5  # s, m
ELEMENTS, FINE = np.array([3.0, 2.5, 2.0, 1.5]), 0.25  # m
BEAM, BEAM_END, BEAM_STEP = 200e3, 0.05, 2.5e-4  # N m², s, s
MESH = "finite-element theory: cubic elements err by h^4, here of the same run with elements of 0.25 m"
STEP = "generalised-α theory (Chung and Hulbert): second order in the step, here of the closed form"


@dataclass(frozen=True)
class Study:
    """Nodes [m] and deflections [m] at the end: of a string by step, of a beam by element length.

    fine : of the beam in fine elements
    off : the same with 1 % more tension
    """

    string: list[tuple[Floats, Floats]]
    beam: list[tuple[Floats, Floats]]
    fine: tuple[Floats, Floats]
    off: tuple[Floats, Floats]


def compute(quick: bool) -> Study:
    return Study(
        string=[swing(STRING_ELEMENT, 0.0, STRING_END, step) for step in STEPS],
        beam=[swing(element, BEAM, BEAM_END, BEAM_STEP) for element in ELEMENTS],
        fine=swing(FINE, BEAM, BEAM_END, BEAM_STEP),
        off=swing(FINE, BEAM, BEAM_END, BEAM_STEP, PERTURBED),
    )


def swing(
    element: float, bending: float, end: float, step: float, perturbation: float = 1.0
) -> tuple[Floats, Floats]:
    """Nodes [m] and deflections [m] at the end of the third sine shape, let go from rest."""
    problem = WireProblem(
        wire=wire(bending, tension=perturbation * TENSION),
        x=even_nodes([0, LENGTH], element),
        initial_deflection=lambda x: HEIGHT * np.sin(NUMBER * x),
    )
    motion = run(problem, end, step=step, interval=end, tolerance=1e-9)
    return motion.x, motion.deflection[-1]


def string_errors(study: Study, perturbation: float = 1.0) -> Floats:
    """By step, relative to the root mean square of the shape."""
    omega = NUMBER * wire(tension=perturbation * TENSION).wave_speed
    exact = HEIGHT * np.cos(omega * STRING_END)
    found = [rms(x, u - exact * np.sin(NUMBER * x)) for x, u in study.string]
    return np.array(found) / HEIGHT * 2**0.5


def beam_errors(study: Study, fine: tuple[Floats, Floats]) -> Floats:
    """By element length, likewise; all nodes are nodes of the fine mesh."""
    return np.array([rms(x, u - np.interp(x, *fine)) for x, u in study.beam]) / HEIGHT * 2**0.5


def compare_study(study: Study, perturbation: float) -> list[Check]:
    beam = beam_errors(study, study.off if perturbation == PERTURBED else study.fine)
    string = string_errors(study, perturbation)
    return [
        compare_rate("swinging beam, order in h", ELEMENTS, beam, 4, source=MESH),
        compare_rate("swinging string, order in Δt", STEPS, string, 2, source=STEP),
    ]


def draw(study: Study, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    draw_rate(left, ELEMENTS, beam_errors(study, study.fine), 4, "beam let go")
    label(left, "element in m", "relative error of the deflection")
    draw_rate(right, 1e3 * STEPS, string_errors(study), 2, "string let go")
    label(right, "time step in ms", "relative error of the deflection")


CASE = Case(
    name="convergence_of_runs",
    kind="verification",
    title="Rates of convergence in mesh and step, in motion",
    text=(
        "The third sine shape of 30 m of the paper's wire, 1 mm high, let go: with EI = 200 kN m² in elements"
        " of 3 to 1.5 m for 0.05 s, as a string in steps of 4 to 0.5 ms for 0.4 s."
    ),
    off="the tension is 1 % larger",
    engines=ENGINES,
    compute=compute,
    compare=compare_study,
    draw=draw,
)
