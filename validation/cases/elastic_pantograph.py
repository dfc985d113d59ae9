"""A pantograph whose force falls as the wire rises (fig. 12)."""

from __future__ import annotations

from matplotlib.figure import Figure

from catenary_fe import theory
from catenary_fe.fe.wire_problem import WireMotion, WireProblem, even_nodes
from validation.case import Case
from validation.check import Check, compare_curves
from validation.engines import ENGINES
from validation.paper_wire import FORCE, PAPER, STRING, C, Floats, run, wire
from validation.pictures import COMPUTED, REFERENCE, label

TIME, SPEED, STIFFNESS = 0.5, 0.725 * C, 1000.0
SOURCE = f"{PAPER}, section 3.1 (fig. 12), solved with eq. 4 and 5: F = F₀ exp(−k t/(2√(Tρ)))"
REASON = (
    "the kink under the force is rounded over one element, 0.1 to 0.2 % of the deflection that the"
    " force follows"
)


def compute(quick: bool) -> WireMotion:
    law = theory.linear_law(force=FORCE, stiffness=STIFFNESS)
    problem = WireProblem(
        wire=wire(),
        x=even_nodes([-C * TIME - 3, 0, C * TIME + 3], 0.5 if quick else 0.25),
        loads=[theory.ElasticPantograph(law=law, speed=SPEED)],
    )
    return run(problem, TIME, step=1e-3 if quick else 5e-4)


def exact(t: Floats, force: float = FORCE) -> Floats:
    return theory.elastic_pantograph_force(STRING, t, speed=SPEED, force=force, stiffness=STIFFNESS)


def compare_motion(motion: WireMotion, perturbation: float) -> list[Check]:
    force = exact(motion.t, perturbation * FORCE)
    under = (perturbation * FORCE - force) / STIFFNESS
    return [
        compare_curves(
            "contact force",
            motion.t,
            motion.forces[:, 0],
            force,
            0.005,
            source=SOURCE,
            reason=REASON,
            unit="N",
        ),
        compare_curves(
            "deflection under it",
            motion.t,
            motion.under_loads[:, 0],
            under,
            0.005,
            source=SOURCE,
            reason=REASON,
            unit="m",
        ),
    ]


def draw(motion: WireMotion, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    force = exact(motion.t)
    left.plot(motion.t, motion.forces[:, 0], **COMPUTED, label="ANCF")
    left.plot(motion.t, force, **REFERENCE, label="closed form")
    label(left, "t in s", "contact force in N")
    left.legend(fontsize=8)
    right.plot(motion.t, 1e3 * motion.under_loads[:, 0], **COMPUTED)
    right.plot(motion.t, 1e3 * (FORCE - force) / STIFFNESS, **REFERENCE)
    label(right, "t in s", "deflection under it in mm")


CASE = Case(
    name="elastic_pantograph",
    kind="verification",
    title="Elastic pantograph on an infinite string",
    text="F = max(0, 200 N − 1 kN/m · u) at V = 0.725 c for 0.5 s on the paper's wire.",
    off="the force on the undeflected wire is 1 % larger",
    engines=ENGINES,
    compute=compute,
    compare=compare_motion,
    draw=draw,
)
