"""Rate of convergence in the step of a pantograph's run under a catenary."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

import catenary_fe as cf
from validation.case import PERTURBED, Case
from validation.check import Check, compare
from validation.en50318 import LAYOUT
from validation.engines import ENGINES, engine
from validation.paper_wire import Floats
from validation.pictures import label
from validation.rates import compare_rate, draw_rate

SPANS, SPEED, UPLIFT = 3, 45.0, 40.0  # m/s, N
ELEMENT = 2.0  # m
STEPS, QUICK = np.array([1e-3, 5e-4, 2.5e-4, 1.25e-4]), 2.0  # s; a quick run's are so many times as long
EVERY, UNTIL = 2e-3, 0.9  # s between compared instants; share of the run, which ends at the last support
SOURCE = (
    "generalised-α theory (Chung and Hulbert): second order in the step, here of the value that the two"
    " shortest steps extrapolate to"
)
TEXT = """A mass of 7 kg with 40 N under three spans of the model of EN 50318:2002 at 45 m/s, in elements of
2 m; steps of 1 to 0.25 ms, and of 0.125 ms for the reference, in a quick run twice as long. So light a push
keeps all droppers taut and the contact closed: slack and lift-off are kinks, at which no scheme of this kind
keeps its order. Without Exudyn, which takes the same steps, each at many times the cost."""


@dataclass(frozen=True)
class Histories:
    """Contact force [N] and support uplift [m] at common instants, an array a run.

    steps : [s] of the runs; the last one is for the reference
    off : with 1 % more uplift force, extrapolated
    kinks : steps of all runs in which a dropper is slack or the contact open
    """

    steps: Floats
    force: list[Floats]
    uplift: list[Floats]
    off: tuple[Floats, Floats]
    kinks: int


def compute(quick: bool) -> Histories:
    catenary = cf.load_catenary(LAYOUT)
    short = catenary.replace(
        spans=catenary.spans[:SPANS], supports=catenary.supports[: SPANS + 1], evaluated_spans=(2, 2)
    )
    mesh = cf.MeshSettings(contact_wire_element=ELEMENT, messenger_wire_element=ELEMENT, at_clamps=ELEMENT)
    shape = cf.find_form(short, mesh)
    steps = QUICK * STEPS if quick else STEPS
    found = [histories(shape, step, UPLIFT) for step in steps]
    off = [histories(shape, step, PERTURBED * UPLIFT) for step in steps[-2:]]
    force, uplift, off_force, off_uplift = (
        [run[i] for run in runs] for runs in (found, off) for i in range(2)
    )
    wrong = extrapolated(off_force), extrapolated(off_uplift)
    return Histories(steps, force, uplift, wrong, sum(run[2] for run in found))


def histories(shape: cf.Shape, step: float, uplift: float) -> tuple[Floats, Floats, int]:
    """Contact force [N] and support uplifts [m] at the common instants; steps with a kink."""
    mass = cf.Stage(mass=7.0, stiffness=50.0, damping=200.0)
    pantograph = cf.Pantograph(stages=(mass,), uplift_force=uplift)
    method = engine()
    newton = {} if method == "linearised" else {"tolerance": 1e-7}
    time = cf.TimeSettings(step=step, **newton)
    with _warnings_off():
        data = cf.simulate(shape, [pantograph], speed=SPEED, time=time, method=method).data
    until = slice(int(UNTIL * data["time"].size))
    contact, droppers, uplifts = (
        np.asarray(data[name].values, dtype=float)[:, until]
        for name in ("contact_force", "dropper_force", "support_uplift")
    )
    kinks = np.count_nonzero((contact <= 0).any(axis=0) | (droppers <= 0).any(axis=0))
    every = round(EVERY / step)
    return contact[:, ::every], uplifts[:, ::every], int(kinks)


@contextmanager
def _warnings_off() -> Iterator[None]:
    """The start's transient and the echo from the end, of which runs warn, belong to what is compared."""
    log = logging.getLogger("catenary_fe")
    level = log.level
    log.setLevel(logging.ERROR)
    try:
        yield
    finally:
        log.setLevel(level)


def extrapolated(runs: list[Floats]) -> Floats:
    """What the last two runs, the last one with half the step, tend to with errors of second order."""
    return np.asarray((4 * runs[-1] - runs[-2]) / 3)


def errors(runs: list[Floats], reference: Floats) -> Floats:
    """Root mean square of each run's difference but the last one's."""
    return np.array([np.sqrt(np.mean((run - reference) ** 2)) for run in runs[:-1]])


def compare_histories(data: Histories, perturbation: float) -> list[Check]:
    pairs = data.force, data.uplift
    references = data.off if perturbation == PERTURBED else tuple(extrapolated(runs) for runs in pairs)
    force, uplift = (errors(runs, wanted) for runs, wanted in zip(pairs, references, strict=True))
    return [
        compare_rate("contact force, order in Δt", data.steps[:-1], force, 2, source=SOURCE),
        compare_rate("uplift at supports, order in Δt", data.steps[:-1], uplift, 2, source=SOURCE),
        compare(
            "steps with a slack dropper or open contact",
            data.kinks,
            0,
            0.0,
            source="the case is chosen so",
            reason="one kink would be enough to hide the rate",
            absolute=True,
            negative_control=False,
        ),
    ]


def draw(data: Histories, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    for ax, runs, what in ((left, data.force, "contact force in N"), (right, data.uplift, "uplift in m")):
        draw_rate(ax, 1e3 * data.steps[:-1], errors(runs, extrapolated(runs)), 2, what.split(" in ")[0])
        label(ax, "time step in ms", f"error of the {what}")


CASE = Case(
    name="convergence_of_a_line",
    kind="verification",
    title="Rate of convergence in the step, of a pantograph under a catenary",
    text=TEXT,
    off="the reference has 1 % more uplift force",
    engines=ENGINES[:2],
    compute=compute,
    compare=compare_histories,
    draw=draw,
)
