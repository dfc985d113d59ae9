"""Set one wire in motion and write down how it moves.

The model behind the paper's figures; without weight and from a straight line unless asked otherwise, so that
it may be compared with closed forms.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.energy import EnergyMeter
from catenary_fe.engines.exudyn.solver import release, solve_dynamic
from catenary_fe.engines.exudyn.wire_build import WireSystem, build_wire, set_initial_velocity
from catenary_fe.engines.exudyn.wire_loads import WireLoad, WireTrack, add_load
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.wire_problem import SlidingPantograph, WireMotion, WireProblem
from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import checked, number

Floats = NDArray[np.float64]
Progress = Callable[[float], None]
MOST_STEPS = 10_000_000  # what they record would fill the memory


@checked
def run_wire(
    problem: WireProblem,
    *,
    duration: float,
    time: TimeSettings | None = None,
    interval: float | None = None,
    energy: bool = False,
    progress: Progress | None = None,
) -> WireMotion:
    """Integrate from the initial deflection and velocity.

    duration : [s], a whole number of steps
    time : settings of the integration; unset: steps of 0.5 ms
    interval : [s] between stored times, a whole number of steps; unset: every step
    energy : store the energy of the wire and its springs too; not with a sliding pantograph
    progress : called with the share done, 0 to 1

    Raises InputError for a duration or interval that is no whole number of steps, SolverError if a step does
    not converge.
    """
    time = time or TimeSettings(step=5e-4, tolerance=1e-6)
    steps = _steps("duration", duration, time.step)
    every = 1 if interval is None else _steps("interval", interval, time.step)
    if energy and any(isinstance(load, SlidingPantograph) for load in problem.loads):
        raise InputError("energy: not known for a wire with a sliding pantograph; leave it out")
    system = build_wire(problem)
    mbs = system.mbs
    meter = EnergyMeter(mbs) if energy else None
    track = WireTrack(mbs, system.wire, system.ground, contact_wire_height=0.0)
    loads = [add_load(track, load) for load in problem.loads]
    mbs.Assemble()
    set_initial_velocity(system, problem)
    for load in loads:
        load.move_to(0.0)
    recorder = Recorder(system, loads, steps, every, meter)

    def before_step(mbs: exu.MainSystem, end: float) -> bool:
        count = round(end / time.step)
        recorder.record(count - 1)
        for load in loads:
            load.move_to(end)
        if progress and count % 50 == 0:
            progress(count / steps)
        return True

    mbs.SetPreStepUserFunction(before_step)
    solve_dynamic(mbs, steps=steps, time=time, what="wire")
    recorder.record(steps)
    motion = recorder.motion(time.step)
    release(mbs)
    return motion


def _steps(name: str, value: float, step: float) -> int:
    count = round(number(name, value, "s", above=0.0, most=MOST_STEPS * step) / step)
    if count < 1 or abs(count * step - value) > 1e-6 * step:
        raise InputError(f"{name} = {value!r} s: must be a whole number of steps of {step:g} s")
    return count


class Recorder:
    """Reads the state at every so many steps."""

    def __init__(
        self,
        system: WireSystem,
        loads: Sequence[WireLoad],
        steps: int,
        every: int,
        meter: EnergyMeter | None = None,
    ) -> None:
        self._system, self._loads, self._meter, self._every = system, loads, meter, every
        self._counts = np.arange(0, steps + 1, every)
        shape = (self._counts.size, len(system.wire.nodes))
        self._deflection, self._velocity = np.empty(shape), np.empty(shape)
        self._at_loads = np.full((3, self._counts.size, len(loads)), np.nan)
        self._energy = np.empty(self._counts.size if meter else 0)

    def record(self, count: int) -> None:
        if count % self._every:
            return
        row = count // self._every
        self._deflection[row], self._velocity[row] = self._system.deflection(), self._system.velocity()
        for i, load in enumerate(self._loads):
            self._at_loads[:, row, i] = load.force(), load.deflection(), load.head()
        if self._meter:
            self._energy[row] = self._meter.energy() + self._system.carried_energy()

    def motion(self, step: float) -> WireMotion:
        return WireMotion(
            t=np.asarray(self._counts * step, dtype=np.float64),
            x=self._system.wire.line.x,
            deflection=self._deflection,
            velocity=self._velocity,
            forces=self._at_loads[0],
            under_loads=self._at_loads[1],
            heads=self._at_loads[2],
            energy=self._energy,
        )
