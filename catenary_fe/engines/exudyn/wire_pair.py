"""Two wires, one above the other, joined by one dropper that goes slack instead of pushing."""

from __future__ import annotations

from dataclasses import dataclass

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.laws import dropper_function
from catenary_fe.engines.exudyn.solver import release, solve_dynamic
from catenary_fe.engines.exudyn.wire_build import WireSystem, build_wire, set_initial_velocity
from catenary_fe.engines.exudyn.wire_run import Recorder
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.wire_problem import WireMotion, WireProblem

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class WirePair:
    """Wires without moving loads, and the dropper between them.

    lower, upper : the wires; both have a node at the dropper
    height : [m] of the upper wire above the lower one
    position : [m] of the dropper along the track
    stiffness : [N/m] of the dropper in tension
    preload : [N] tension at rest, balanced by constant forces on the wires as by a weight and its support
    damping : [N s/m] of the dropper while it is taut
    """

    lower: WireProblem
    upper: WireProblem
    height: float
    position: float
    stiffness: float
    preload: float
    damping: float = 0.0


@dataclass(frozen=True)
class PairMotion:
    """Motion of both wires, complete.

    lower, upper : the wires' motions
    dropper_force : [N] shape (times,), tension
    """

    lower: WireMotion
    upper: WireMotion
    dropper_force: Floats


def run_pair(pair: WirePair, *, duration: float, time: TimeSettings) -> PairMotion:
    """Integrate from the wires' initial states; all steps are stored.

    Raises SolverError if a step does not converge.
    """
    lower = build_wire(pair.lower)
    upper = build_wire(pair.upper, lower.mbs, pair.height)
    mbs = lower.mbs
    dropper = _add_dropper(pair, lower, upper)
    mbs.Assemble()
    for system, problem in ((lower, pair.lower), (upper, pair.upper)):
        set_initial_velocity(system, problem)
    steps = round(duration / time.step)
    recorders = [Recorder(system, [], steps, 1) for system in (lower, upper)]
    force = np.empty(steps + 1)

    def record(count: int) -> None:
        for recorder in recorders:
            recorder.record(count)
        force[count] = np.linalg.norm(mbs.GetObjectOutput(dropper, exu.OutputVariableType.Force))

    def before_step(mbs: exu.MainSystem, end: float) -> bool:
        record(round(end / time.step) - 1)
        return True

    mbs.SetPreStepUserFunction(before_step)
    solve_dynamic(mbs, steps=steps, time=time, what="two wires")
    record(steps)
    motions = [recorder.motion(time.step) for recorder in recorders]
    release(mbs)
    return PairMotion(motions[0], motions[1], force)


def _add_dropper(pair: WirePair, lower: WireSystem, upper: WireSystem) -> int:
    mbs = lower.mbs
    nodes = [problem.node(pair.position) for problem in (pair.lower, pair.upper)]
    markers = [
        system.wire.position_marker(mbs, node) for system, node in zip((lower, upper), nodes, strict=True)
    ]
    for marker, force in zip(markers, (-pair.preload, pair.preload), strict=True):
        mbs.AddLoad(eii.LoadForceVector(markerNumber=marker, loadVector=[0, force, 0]))
    return int(
        mbs.AddObject(
            eii.ObjectConnectorSpringDamper(
                markerNumbers=markers,
                referenceLength=pair.height - pair.preload / pair.stiffness,
                stiffness=pair.stiffness,
                damping=pair.damping,
                springForceUserFunction=dropper_function(mbs),
            )
        )
    )
