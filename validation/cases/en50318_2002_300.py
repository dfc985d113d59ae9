"""EN 50318:2002 at 300 km/h: the accepted ranges and a published result."""

from __future__ import annotations

from matplotlib.figure import Figure

from validation.case import PERTURBED, Case
from validation.check import Check
from validation.en50318 import RunData, draw_run, range_checks, run
from validation.engines import ENGINES

SPEED, OTHER = 300, 250  # km/h


def compute(quick: bool) -> RunData:
    return run(SPEED)


def compare_run(data: RunData, perturbation: float) -> list[Check]:
    return range_checks(data, SPEED, ranges_of=OTHER if perturbation == PERTURBED else SPEED)


def draw(data: RunData, figure: Figure) -> None:
    draw_run(data, SPEED, figure)


CASE = Case(
    name="en50318_2002_300",
    kind="validation",
    title="EN 50318:2002 at 300 km/h",
    text=(
        "Reference model of the standard, one pantograph, spans 5 and 6, causal sixth-order"
        " Butterworth low-pass at"
        " 20 Hz. The loss of contact is counted on the unfiltered force. Without Exudyn, whose runs the tests"
        " compare with the nonlinear ones on shorter lines: ten spans cost it many times more."
    ),
    off="the ranges of 250 km/h",
    engines=ENGINES[:2],
    compute=compute,
    compare=compare_run,
    draw=draw,
    quick=True,
)
