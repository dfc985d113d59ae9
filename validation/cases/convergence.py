"""Rates of convergence in mesh and step, where the solution is smooth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from catenary_fe.fe.wire_problem import WireProblem, even_nodes
from validation.case import PERTURBED, Case
from validation.cases.natural_frequencies import exact, frequencies
from validation.check import Check, compare, rms
from validation.engines import ENGINES
from validation.paper_wire import C, Floats, run, wire
from validation.pictures import label

LENGTH, MODE = 30.0, 5  # m, six metres a half wave
ELEMENTS = np.array([1.0, 0.75, 0.6, 0.5])
STEPS = np.array([4e-3, 2e-3, 1e-3, 5e-4])
BEAM = 20e6  # N m², so stiff that bending decides
MESH = (
    "finite-element theory: eigenvalues of cubic elements err by h^2(4−m), m the order of the"
    " energy's derivative"
)
STEP = "generalised-α theory (Chung and Hulbert): second order in the step"
REASON = "the rate that theory gives ± 0.2: a slope fitted over a factor of 2 to 8 is not yet the limit"


@dataclass(frozen=True)
class Study:
    """Errors by element length of a string's and a beam's frequency, by step of a swinging string."""

    string: Floats
    beam: Floats
    step: Floats


def compute(quick: bool) -> Study:
    return Study(
        string=np.array([frequency_error(h, 0.0) for h in ELEMENTS]),
        beam=np.array([frequency_error(h, BEAM) for h in ELEMENTS]),
        step=np.array([step_error(step) for step in STEPS]),
    )


def frequency_error(element: float, bending: float) -> float:
    found = frequencies(even_nodes([0, LENGTH], element), bending, MODE)[-1]
    return float(abs(found / exact(MODE, bending, length=LENGTH)[-1] - 1))


def step_error(step: float) -> float:
    """After 0.4 s of the third sine shape, let go from rest."""
    k, height, end = 3 * np.pi / LENGTH, 1e-3, 0.4
    problem = WireProblem(
        wire=wire(), x=even_nodes([0, LENGTH], 0.5), initial_deflection=lambda x: height * np.sin(k * x)
    )
    motion = run(problem, end, step=step, interval=end, tolerance=1e-9)
    omega = k * C
    reference = height * np.sin(k * motion.x) * np.cos(omega * end)
    return rms(motion.x, motion.deflection[-1] - reference) / height * 2**0.5


def slope(size: Floats, error: Floats) -> float:
    return float(np.polyfit(np.log(size), np.log(error), 1)[0])


def compare_study(study: Study, perturbation: float) -> list[Check]:
    # the negative control's errors are to a reference that is 1 % off: they do not fall
    off = 0.01 if perturbation == PERTURBED else 0.0
    rows = (
        ("frequency of a string, order in h", ELEMENTS, study.string, 6.0, MESH),
        ("frequency of a beam, order in h", ELEMENTS, study.beam, 4.0, MESH),
        ("swinging string, order in Δt", STEPS, study.step, 2.0, STEP),
    )
    return [
        compare(name, slope(size, error + off), order, 0.2, source=source, reason=REASON, absolute=True)
        for name, size, error, order, source in rows
    ]


def draw(study: Study, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    for error, order, name in ((study.string, 6, "string"), (study.beam, 4, "beam")):
        _draw_rate(left, ELEMENTS, error, order, name)
    label(left, "element in m", "relative error of the fifth frequency")
    _draw_rate(right, 1e3 * STEPS, study.step, 2, "string let go")
    label(right, "time step in ms", "relative error of the deflection")
    for ax, sizes in ((left, ELEMENTS), (right, 1e3 * STEPS)):
        ax.set_xticks(sizes, [f"{size:g}" for size in sizes])
        ax.set_xticks([], minor=True)
        ax.legend(fontsize=8)


def _draw_rate(ax: Axes, size: Floats, error: Floats, order: int, name: str) -> None:
    (line,) = ax.loglog(size, error, "o", markersize=5, label=f"{name}: order {slope(size, error):.2f}")
    ax.loglog(
        size, error[-1] * (size / size[-1]) ** order, "--", color=line.get_color(), label=f"order {order}"
    )


CASE = Case(
    name="convergence",
    kind="verification",
    title="Rates of convergence in mesh and step",
    text=(
        "Fifth frequency of 30 m of the paper's wire as a string (m = 1) and with EI = 20 MN m² (m ="
        " 2), in elements"
        " of 1 to 0.5 m; and the third shape let go, in steps of 4 to 0.5 ms."
    ),
    off="the errors are taken to a reference 1 % off",
    engines=ENGINES,
    compute=compute,
    compare=compare_study,
    draw=draw,
)
