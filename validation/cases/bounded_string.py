"""A force that runs along a string between rigid ends, through the first echo (eq. 7)."""

from __future__ import annotations

from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireMotion, WireProblem, even_nodes
from validation.case import Case
from validation.check import Check, compare_curves
from validation.engines import ENGINES
from validation.paper_wire import FORCE, PAPER, STRING, C, Floats, run, wire
from validation.pictures import COMPUTED, REFERENCE, label

LENGTH, SPEED = 50.0, 0.725 * C
TIMES = (0.3, 0.45, 0.55)  # before the far end is reached, with its echo on the way, force in the echo
SOURCE = f"{PAPER}, eq. 7 with 5, summed by images"
REASON = "kinks at the force and the fronts are rounded over one element, 0.1 to 0.2 % of the deflection"


def compute(quick: bool) -> WireMotion:
    x = even_nodes([0, LENGTH], 0.5 if quick else 0.25)
    problem = WireProblem(wire=wire(), x=x, loads=[theory.MovingForce(force=FORCE, speed=SPEED)])
    return run(problem, TIMES[-1], step=1e-3 if quick else 5e-4, interval=0.01)


def exact(x: Floats, t: float, force: float = FORCE) -> Floats:
    return theory.moving_force_by_images(STRING, x, t, length=LENGTH, speed=SPEED, force=force)


def compare_motion(motion: WireMotion, perturbation: float) -> list[Check]:
    return [
        compare_curves(
            f"deflection at {t:g} s",
            motion.x,
            motion.at(t),
            exact(motion.x, t, perturbation * FORCE),
            0.005,
            source=SOURCE,
            reason=REASON,
            unit="m",
        )
        for t in TIMES
    ]


def draw(motion: WireMotion, figure: Figure) -> None:
    for ax, t in zip(figure.subplots(1, len(TIMES), sharey=True), TIMES, strict=True):
        ax.plot(motion.x, 1e3 * motion.at(t), **COMPUTED, label="ANCF")
        ax.plot(motion.x, 1e3 * exact(motion.x, t), **REFERENCE, label="closed form")
        label(ax, "x in m", "deflection in mm" if t == TIMES[0] else "", f"t = {t:g} s")
    figure.axes[0].legend(fontsize=8)


CASE = Case(
    name="bounded_string",
    kind="verification",
    title="Moving force on a bounded string, through the first echo",
    text=(
        "200 N at V = 0.725 c from one end of 50 m of the paper's wire to the other. Its wave reaches"
        " the far end"
        " at 0.41 s, and the echo meets the force at 0.47 s."
    ),
    off="the force is 1 % larger",
    engines=ENGINES,
    compute=compute,
    compare=compare_motion,
    draw=draw,
)
