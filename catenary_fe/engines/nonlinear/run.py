"""A catenary ready for compiled nonlinear runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import Records, Wires
from catenary_fe.engines.checkpoint import Checkpoint
from catenary_fe.engines.generalized_alpha import Scheme, make_scheme
from catenary_fe.engines.linearised.start import InitialState, Substructure, assemble_pantograph
from catenary_fe.engines.nonlinear.arrays import Factor
from catenary_fe.engines.nonlinear.energy import EnergyRecord
from catenary_fe.engines.nonlinear.progress import RunRecorder
from catenary_fe.engines.nonlinear.setup import make_factor, make_stations, make_system
from catenary_fe.engines.nonlinear.state import State
from catenary_fe.engines.nonlinear.steps import advance
from catenary_fe.engines.recorder import Sizes, load_heads, make_heads, make_records, read_journey
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.engines.stopped import RunStopped
from catenary_fe.layout import AnyPantograph, SolverError
from catenary_fe.statics import Shape

if TYPE_CHECKING:
    from catenary_fe.engines.exudyn.run import History
    from catenary_fe.fe.nonlinear_model import ContactStart

Floats = NDArray[np.float64]
Progress = Callable[[float], None]
PARTS = (1, 2, 4, 8, 16)  # of a step, where the run does not converge with the matrix at rest


class NonlinearCatenary:
    """A catenary for any number of compiled nonlinear runs with one time step.

    iterations : of the last run

    Raises SolverError if there is no static equilibrium.
    """

    def __init__(
        self, shape: Shape, time: TimeSettings | None = None, store_wire: float | None = None
    ) -> None:
        from catenary_fe.engines.tension import TensionGauge
        from catenary_fe.fe.nonlinear_model import nonlinear_model

        self._shape, self._time = shape, time or TimeSettings()
        self._every = round(store_wire / self._time.step) if store_wire else 0
        self._scheme = make_scheme(self._time)
        self._gauge = TensionGauge(shape.catenary, shape.mesh, shape.installation.lines)
        self._model = nonlinear_model(shape.catenary, shape.mesh, shape.installation)
        self._system = make_system(self._model)
        self._stations = make_stations(self._model, shape)
        self._factor = make_factor(self._model, self._scheme, 0 * self._model.system.reference)
        self.iterations = 0
        self._notes: list[str] = []

    def drive(
        self,
        pantographs: Sequence[tuple[AnyPantograph, float]],
        speed: float,
        positions: Floats,
        steps: int,
        progress: Progress | None = None,
        checkpoint: Checkpoint | None = None,
    ) -> History:
        """Run pantographs, each with its uplift [N], from static contact at constant speed [m/s].

        checkpoint : keeps the run's state now and then; the run goes on from what was found in it

        Raises RunStopped with the history until then where steps do not converge, not even much
        shorter ones, or the user interrupts.
        """
        from catenary_fe.engines.tension import INTERVAL, TensionRecord
        from catenary_fe.fe.nonlinear_model import contact_start

        shape, h = self._shape, self._time.step
        begin = contact_start(shape.catenary, shape.mesh, shape.installation, pantographs, positions)
        start = self._start(pantographs, positions, speed, begin)
        sizes = _sizes(start.bodies, steps, self._every)
        heads = make_heads(1, sizes, shape.catenary.contact_wire_height)
        total = self._model.system.reference + begin.wires
        records = self._records(sizes, total)
        load_heads(heads, records, 0, self._scheme, start, steps)
        state = State.at(start, total, self._system, heads, sizes)
        block = max(1, round(INTERVAL / h))
        energy = EnergyRecord(self._model, start.bodies)
        recorder = RunRecorder(state, records, TensionRecord(self._gauge), energy)
        recorder.read(self._scheme, begin.wires)
        self.iterations, self._notes = 0, []
        done = 0
        if checkpoint and checkpoint.kept:
            done, self._notes = recorder.go_on(checkpoint.kept), checkpoint.kept["notes"].tolist()
        try:
            while done < steps:
                count = min(block, steps - done)
                self._advance(state, records, start, count)
                done += count
                if count == block:
                    recorder.read(self._scheme, state.motion.total - self._model.system.reference)
                if progress:
                    progress(done / steps)
                if checkpoint:
                    checkpoint.save_when_due(lambda: recorder.arrays() | {"notes": np.array(self._notes)})
        except (SolverError, KeyboardInterrupt) as error:
            history = read_journey(records, heads, 0, start, steps, h, shape)
            raise RunStopped(recorder.joined(history).until(done), error) from None
        history = recorder.joined(read_journey(records, heads, 0, start, steps, h, shape))
        return replace(history, notes=tuple(self._notes))

    def _records(self, sizes: Sizes, total: Floats) -> Records:
        stations = self._stations
        counts = self._system.droppers.k.size, stations.supports.size, stations.heights.size, 0
        records = make_records(1, sizes, counts, self._every)
        records.supports[0, :, 0] = total[stations.supports] - stations.rest_supports
        if self._every:
            records.wire[0, 0] = total[stations.heights] - stations.rest
        return records

    def _advance(self, state: State, records: Records, start: InitialState, steps: int) -> None:
        """Take steps; where that fails, again with the matrix of their beginning, in more and more parts."""
        before = state.snapshot()
        if self._take(state, records, steps, 1, self._scheme, self._factor):
            return
        for parts in PARTS:
            state.restore(before)
            scheme = make_scheme(replace(self._time, step=self._time.step / parts))
            factor = make_factor(self._model, scheme, state.motion.total - self._model.system.reference)
            state.rescale(self._scheme, scheme, start.bodies)
            done = self._take(state, records, steps, parts, scheme, factor)
            state.rescale(scheme, self._scheme, start.bodies)
            if done:
                if parts > 1:
                    self._note(parts, steps, int(state.heads.step[0]) - steps, start)
                return
        raise SolverError(self._failure(state, start))

    def _note(self, parts: int, steps: int, done: int, start: InitialState) -> None:
        """Remember for the result that steps were divided."""
        from catenary_fe.engines.faults import smaller_steps

        begin = self._time.step * done
        at = [body.position + start.speed * begin for body in start.bodies]
        self._notes.append(
            smaller_steps(self._shape.catenary, at, begin, parts, 1e3 * steps * self._time.step)
        )

    def _take(
        self, state: State, records: Records, steps: int, parts: int, scheme: Scheme, factor: Factor
    ) -> bool:
        flat = Wires(*(array.reshape(-1) for array in state.wires))
        done, iterations = advance(
            scheme, self._system, self._stations, factor, state.wires, flat, state.motion, state.slack,
            state.heads, state.work, records, state.energy, steps, parts, self._time.tolerance,
        )  # fmt: skip
        self.iterations += iterations
        return bool(done)

    def _failure(self, state: State, start: InitialState) -> str:
        reached = self._time.step * int(state.heads.step[0])
        at = [body.position + start.speed * reached for body in start.bodies]
        span = np.searchsorted(self._shape.catenary.support_positions, max(at))
        return (
            f"run at {3.6 * start.speed:g} km/h: no convergence at t = {reached:.4f} s, the first"
            f" pantograph at {max(at):.1f} m in span {span}, with steps of {self._time.step:g} s nor with"
            f" {PARTS[-1]} in the place of each; try a smaller time step, and look at the contact and dropper"
            " stiffnesses"
        )

    def _start(
        self,
        pantographs: Sequence[tuple[AnyPantograph, float]],
        positions: Floats,
        speed: float,
        begin: ContactStart,
    ) -> InitialState:
        model, bodies = self._model, []
        for (pantograph, uplift), position, q, forces in zip(
            pantographs, positions, begin.heads, begin.forces, strict=True
        ):
            body = assemble_pantograph(model, pantograph)
            touches = tuple(
                replace(
                    touch,
                    force=float(force),
                    wire_height=self._height(begin, touch.wire, position + touch.ahead),
                )
                for touch, force in zip(body.touches, forces, strict=True)
            )
            bodies.append(replace(body, uplift=uplift, position=float(position), q=q, touches=touches))
        free = np.zeros(self._system.force.size)
        place = model.system.place
        moves = place >= 0
        free[place[moves]] = begin.wires[moves]
        droppers = model.system.droppers
        tensions = droppers.tension(droppers.span(model.system.reference + begin.wires))
        return InitialState(free, bodies, tensions, speed)

    def _height(self, begin: ContactStart, wire: int, position: float) -> float:
        from catenary_fe.fe.cable import hermite

        line = self._model.contacts[wire]
        axes, up = self._model.system.axes, self._model.system.axes - 1
        first = int(self._shape.mesh.first_nodes[wire])
        e = int(np.clip(np.searchsorted(line.x, position, side="right") - 1, 0, line.x.size - 2))
        xi = (position - line.x[e]) / (line.x[e + 1] - line.x[e])
        nodes = 2 * axes * (first + np.array([e, e + 1]))
        moved = begin.wires[nodes[:, None] + [up, up + axes]]
        values = (line.static[e : e + 2] + moved).ravel()
        return float(hermite(xi, line.lengths[e]) @ values - self._shape.catenary.contact_wire_height)


def _sizes(bodies: Sequence[Substructure], steps: int, every: int) -> Sizes:
    return Sizes(
        pantographs=len(bodies),
        contacts=sum(len(body.touches) for body in bodies),
        coordinates=max([1, *(len(body.K) for body in bodies)]),
        steps=steps,
        shapes=steps // every + 1 if every else 0,
    )
