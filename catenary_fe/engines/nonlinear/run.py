"""Nonlinear runs in compiled code: large motions of the assembled line."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import Records
from catenary_fe.engines.base import Progress, RunCase
from catenary_fe.engines.checkpoint import Checkpoint
from catenary_fe.engines.compiled import vectorising
from catenary_fe.engines.faults import place_of_heads, smaller_steps
from catenary_fe.engines.generalized_alpha import Scheme, at_start, make_scheme
from catenary_fe.engines.history import History, RunStopped
from catenary_fe.engines.nonlinear.arrays import Factor
from catenary_fe.engines.nonlinear.leg import Arrays, Leg
from catenary_fe.engines.nonlinear.recorder import EnergyRecord, RunRecorder
from catenary_fe.engines.nonlinear.setup import Parameters, by_kind
from catenary_fe.engines.nonlinear.state import State
from catenary_fe.engines.nonlinear.steps import advance
from catenary_fe.engines.recorder import (
    InitialState,
    Sizes,
    load_pantographs,
    make_pantographs,
    make_records,
    read_history,
)
from catenary_fe.engines.sections import Computed, sections_met
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.engines.tension import INTERVAL, TensionGauge, TensionRecord
from catenary_fe.fe.contact import EvenCurve, PlacedPantograph
from catenary_fe.fe.system import System
from catenary_fe.layout import SolverError
from catenary_fe.statics.newton import static_contact

Floats = NDArray[np.float64]
_STEERED = ("load", "start", "place", "speed", "pace")  # of the heads
PARTS = (1, 2, 4, 8, 16)  # of a step, where the run does not converge with the matrix at rest


class NonlinearEngine:
    """A line for any number of compiled nonlinear runs with one time step.

    iterations : of the last run
    """

    def __init__(
        self, system: System, time: TimeSettings | None = None, store_wire: float | None = None
    ) -> None:
        self._system, self._time = system, time or TimeSettings()
        self._every = round(store_wire / self._time.step) if store_wire else 0
        self._scheme = make_scheme(self._time)
        self._parameters = Parameters(system)
        self._factor = self._parameters.factor(self._scheme, np.zeros_like(system.reference))
        self.iterations = 0
        self._notes: list[str] = []

    def begin(self, case: RunCase, uplifts: Floats, steps: int, bases: Floats | None = None) -> NonlinearRun:
        """A run of so many steps, in static contact at its start. Raises SolverError where there is none.

        bases : [m], shape (pantographs,), heights of bases that stand elsewhere; unset: none does
        """
        placed = case.placed(uplifts, self._system)
        placed = self._system.base_line.moving(placed, case.speed, self._time.step, steps)
        if bases is None:
            moved, placed = static_contact(self._system, placed)
            return NonlinearRun(self, moved, placed, case.speed, steps)
        curves = [EvenCurve(0.0, 1.0, np.array([[height, 0.0]] * 2)) for height in bases]
        lifted = [replace(p, base=curve) for p, curve in zip(placed, curves, strict=True)]
        moved, placed = static_contact(self._system, lifted)
        run = NonlinearRun(self, moved, [replace(p, base=None) for p in placed], case.speed, steps)
        run.base_curves()[:, :, 0] = bases[:, None]
        return run

    def run(
        self,
        case: RunCase,
        uplifts: Floats,
        progress: Progress | None = None,
        checkpoint: Checkpoint | None = None,
    ) -> History:
        """Run pantographs, each with its uplift [N], from static contact at constant speed.

        checkpoint : keeps the run's state now and then; the run goes on from what was found in it

        Raises SolverError without static contact, RunStopped with the history until then where steps do not
        converge, not even much shorter ones, or the user interrupts.
        """
        steps, interval = case.steps(self._time.step), max(1, round(INTERVAL / self._time.step))
        run = self.begin(case, uplifts, steps)
        run.take_up(checkpoint)
        try:
            while run.done < steps:
                run.advance(min(interval, steps - run.done), read=run.done + interval <= steps)
                if progress:
                    progress(run.done / steps)
                if checkpoint:
                    checkpoint.save_when_due(run.arrays)
        except (SolverError, KeyboardInterrupt) as error:
            raise RunStopped(run.history().until(run.done), error) from None
        self.iterations = run.iterations
        return run.history()


class NonlinearRun:
    """A run under way.

    moved : [m], shape (all,), displacements at its start
    pantographs : with their heights and contact forces there
    speed : [m/s]
    steps : how many it may take
    """

    def __init__(
        self,
        engine: NonlinearEngine,
        moved: Floats,
        pantographs: Sequence[PlacedPantograph],
        speed: float,
        steps: int,
    ) -> None:
        self._engine, system = engine, engine._system
        self._parameters, self._steps, self._step = engine._parameters, steps, engine._time.step
        self._start = _initial_state(self._parameters, moved, pantographs, speed)
        self._leg: Leg | None = None
        self._own: Arrays | None = None  # of the leg
        self._computed = Computed(self._parameters.rows.starts.size - 1)
        self._all = bool(system.time_loads)
        paths = system.contact_paths
        sizes = Sizes.of([pantographs], len(paths), steps, engine._every)
        heads, own = make_pantographs(1, sizes, system.contact_wire_height, system.base_line)
        total = system.reference + moved
        self.records = self._records(sizes, total, engine._every)
        load_pantographs(heads, own, self.records, 0, engine._scheme, self._start, steps)
        self.state = State.at(
            self._start, by_kind(total, 2 * system.axes), self._parameters.equations, (heads, own), sizes
        )
        energy = EnergyRecord(self._parameters, pantographs)
        self._recorder = RunRecorder(self.state, self.records, TensionRecord(TensionGauge(system)), energy)
        self._recorder.read(engine._scheme, moved)
        self._strips = [np.flatnonzero(heads.owner[0] == p) for p in range(len(pantographs))]
        self.iterations, self.done = 0, 0
        self._notes: list[str] = []

    def _records(self, sizes: Sizes, total: Floats, every: int) -> Records:
        stations, droppers = self._parameters.stations, self._parameters.system.droppers
        counts = droppers.length.size, stations.supports.size, stations.heights.size, 0
        records = make_records(1, sizes, counts, every, spatial=self._engine._system.spatial)
        heights = total[self._parameters.system.heights]
        records.supports[0, :, 0] = heights[stations.supports] - stations.rest_supports
        if every:
            records.wire[0, 0] = heights - stations.rest
        return records

    def set_in_motion(self, v: Floats, x: Floats, heads: Floats) -> None:
        """Begin with velocities and accelerations instead of at rest; all sections are computed then.

        v, x : [m/s], [m/s²], shape (free,)
        heads : [m/s²], shape (pantographs, coordinates)
        """
        scheme, wires, own = self._engine._scheme, self.state.wires, self.state.pantographs
        rows = self._parameters.rows
        parts = at_start(scheme, wires.q[:, 0].copy(), rows.spread(v), rows.spread(x))
        for array, values in zip(wires[:4], parts, strict=True):
            array[:, 0] = values
        self._all = True
        parts = at_start(scheme, own.q[0].copy(), np.zeros_like(own.q[0]), heads)
        for array, values in zip(own[:4], parts, strict=True):
            array[0] = values

    def motion(self) -> tuple[Floats, Floats]:
        """Displacements and velocities now, shape (free,) each."""
        scheme, wires, rows = self._engine._scheme, self.state.wires, self._parameters.rows.place
        q, v = wires.q + scheme.b * wires.x, wires.v + scheme.g * wires.x
        return q[rows, 0], v[rows, 0]

    @property
    def placed(self) -> list[PlacedPantograph]:
        """The pantographs where they started."""
        return self._start.pantographs

    @property
    def speed(self) -> float:
        """[m/s] at which it started."""
        return self._start.speed

    def push(self, uplifts: Floats) -> None:
        """Lift the pantographs with other forces [N] from here on, shape (pantographs,)."""
        for p, (placed, uplift) in enumerate(zip(self.placed, uplifts, strict=True)):
            self.state.heads.load[0, p, : placed.body.size] = uplift * placed.body.load

    def move_base(self, heights: Floats) -> None:
        """Move the bases in the next step to heights [m], shape (pantographs,), above those at rest."""
        for curve, height in zip(self.base_curves(), heights, strict=True):
            rate = (height - curve[self.done, 0]) / self._step
            curve[self.done + 1 :] = height, 0.0
            curve[self.done + 1, 1] = rate

    def base_curves(self) -> Floats:
        """[m] and [m/s], shape (pantographs, steps + 1, 2), of the bases, to be changed in place."""
        heads = self.state.heads
        if not heads.base.values.shape[1]:
            values = np.zeros((len(self.placed), self._steps + 1, 2))
            base = heads.base._replace(
                step=np.full(len(values), self._step), last=np.full(len(values), self._steps), values=values
            )
            self.state.heads = heads._replace(base=base)
        return self.state.heads.base.values

    def drive(self, speed: float) -> None:
        """Run on at another speed [m/s] from where the pantographs are; all sections are computed then."""
        heads, time = self.state.heads, self._step * self.done
        slower = heads.pace[0] - speed
        heads.start[0] += slower * time
        heads.place[0] += slower * time
        heads.speed[0], heads.pace[0], self._all = speed, speed, True

    def heads_in_motion(self) -> tuple[list[Floats], list[Floats], list[Floats]]:
        """Places, velocities and accelerations of each pantograph's coordinates now."""
        scheme, own = self._engine._scheme, self.state.pantographs
        found: tuple[list[Floats], list[Floats], list[Floats]] = ([], [], [])
        for p, placed in enumerate(self.placed):
            part = (0, p, slice(placed.body.size))
            x: Floats = own.x[part].copy()
            for values, kept in zip(
                (own.q[part] + scheme.b * x, own.v[part] + scheme.g * x, x), found, strict=True
            ):
                kept.append(values)
        return found

    def contact_forces(self) -> Floats:
        """[N], shape (pantographs,), now."""
        force = self.state.work.force[0]
        return np.array([force[own].sum() for own in self._strips])

    def wire_heights(self) -> Floats:
        """[m], shape (pantographs,), above the nominal contact wire height: of the lowest over each head."""
        heights = self.records.height[0, :, self.done]
        return np.array([np.fmin.reduce(heights[own]) for own in self._strips])

    def take_up(self, checkpoint: Checkpoint | None) -> None:
        """Go on from what a checkpoint kept, if it kept anything."""
        if checkpoint and checkpoint.kept:
            self.go_on(checkpoint.kept)

    def go_on(self, kept: Mapping[str, NDArray[Any]]) -> None:
        """Go on from :meth:`arrays`."""
        self.done = self._recorder.go_on(kept)
        self._computed.steps[:] = kept["computed"]
        first, end = kept["sections"].tolist()
        self._leg = Leg.of(self._parameters, (first, end)) if end > first else None
        self._own = None
        self._notes = kept["notes"].tolist()

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a run needs to go on from here with the same result."""
        sections = self._leg.sections if self._leg else (0, 0)
        own = {"computed": self._computed.steps, "sections": np.array(sections)}
        return self._recorder.arrays() | own | {"notes": np.array(self._notes, dtype=np.str_)}

    def steered(self) -> dict[str, NDArray[Any]]:
        """What :meth:`push`, :meth:`move_base` and :meth:`drive` changed, for :meth:`steer`."""
        heads = self.state.heads
        found = {f"steered_{name}": getattr(heads, name) for name in _STEERED}
        own = {"steered_base": self.base_curves()[:, : self.done + 1], "steered_all": np.array(self._all)}
        return found | own

    def steer(self, kept: Mapping[str, NDArray[Any]]) -> None:
        """Go on as :meth:`steered` kept it, after :meth:`go_on`."""
        for name in _STEERED:
            getattr(self.state.heads, name)[...] = kept[f"steered_{name}"]
        curves, before = self.base_curves(), kept["steered_base"]
        curves[:, : self.done + 1] = before
        curves[:, self.done + 1 :, 0], curves[:, self.done + 1 :, 1] = before[:, -1:, 0], 0.0
        self._all = bool(kept["steered_all"])

    def history(self) -> History:
        """What was recorded so far."""
        found = read_history(
            self.records,
            self.state.heads,
            0,
            self._start,
            self._steps,
            self._step,
            self._parameters.system,
            self._computed if len(self._computed.steps) > 1 else None,
        )
        return replace(self._recorder.joined(found), notes=tuple(self._notes))

    def advance(self, steps: int, *, read: bool) -> None:
        """Take steps; where that fails, again with the matrix of their beginning, in more and more parts.

        read : whether tensions and energy are taken at their end
        """
        engine, state = self._engine, self.state
        leg = self._leg_of(steps)
        before = state.snapshot()
        if not self._take(steps, 1, engine._scheme, engine._factor):
            self._take_again(steps, before)
        self.done += steps
        if read:
            moved = self._parameters.system.spread(state.motion.q[self._parameters.rows.place])
            self._recorder.read(engine._scheme, moved, leg.sections)

    def _take_again(self, steps: int, before: list[NDArray[np.generic]]) -> None:
        engine, state = self._engine, self.state
        for parts in PARTS:
            state.restore(before)
            scheme = make_scheme(replace(engine._time, step=self._step / parts))
            moved = self._parameters.system.spread(state.motion.q[self._parameters.rows.place])
            factor = self._parameters.factor(scheme, moved)
            state.rescale(engine._scheme, scheme, self._start.pantographs)
            done = self._take(steps, parts, scheme, factor)
            state.rescale(scheme, engine._scheme, self._start.pantographs)
            if done:
                if parts > 1:
                    self._note(parts, steps)
                return
        raise SolverError(self._failure())

    def _leg_of(self, steps: int) -> Leg:
        """The sections that pantographs are on during the next steps."""
        metre, met = self._step * self._start.speed, (0, len(self._computed.steps))
        if not self._all:
            paths = self._parameters.system.contact_paths
            met = sections_met(paths, self._start.contacts, metre * self.done, metre * (self.done + steps))
        if not self._leg or self._leg.sections != met:
            before, self._leg, self._own = self._leg, Leg.of(self._parameters, met), None
            if before:
                self._leg.take_over(self.state, before)
        self._computed.add(met, self.done, self.done + steps)
        return self._leg

    def _positions(self, time: float) -> list[float]:
        heads = self.state.heads
        return [float(place + heads.pace[0] * time) for place in heads.place[0, : len(self.placed)]]

    def _note(self, parts: int, steps: int) -> None:
        """Remember for the result that steps were divided."""
        begin, supports = self._step * self.done, self._parameters.system.support_positions
        self._notes.append(
            smaller_steps(supports, self._positions(begin), begin, parts, 1e3 * steps * self._step)
        )

    def _take(self, steps: int, parts: int, scheme: Scheme, factor: Factor) -> bool:
        state, leg, tolerance = self.state, self._leg, self._engine._time.tolerance
        assert leg
        own = self._own = self._own or leg.arrays(state, self.records)
        begin = int(state.pantographs.step[0])
        times = self._step * (begin + np.arange(steps * parts + 1) / parts)
        signals = self._parameters.system.signals(times)
        with vectorising():
            done, iterations = advance(
                scheme, leg.equations, leg.stations, leg.factor(factor), own.wires, own.flat,
                own.motion, own.slack, state.heads, state.pantographs, state.work, own.records, own.energy,
                signals, steps, parts, tolerance,
            )  # fmt: skip
        self.iterations += iterations
        return bool(done)

    def _failure(self) -> str:
        reached = self._step * int(self.state.pantographs.step[0])
        where = place_of_heads(self._parameters.system.support_positions, self._positions(reached))
        return (
            f"run at {3.6 * self.state.heads.pace[0]:g} km/h: no convergence at t = {reached:.4f} s, {where},"
            f" with steps of {self._step:g} s nor with {PARTS[-1]} in the place of each; try a smaller time"
            " step, and look at the contact and dropper stiffnesses"
        )


def _initial_state(
    parameters: Parameters, moved: Floats, pantographs: Sequence[PlacedPantograph], speed: float
) -> InitialState:
    system = parameters.system
    free = np.zeros(system.size)
    moves = system.dof >= 0
    free[system.dof[moves]] = moved[moves]
    tensions = system.droppers.tension(system.droppers.span(system.reference + moved))
    return InitialState(
        parameters.rows.spread(free), list(pantographs), tensions, speed, len(system.contact_paths)
    )
