"""Slots in which linearised runs advance side by side; a slot whose run is over takes the next one."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines import arrays as shared
from catenary_fe.engines import contact_solver, generalized_alpha, kernels, lanes, pantograph_laws
from catenary_fe.engines.arrays import (
    SLOTS,
    PantographParameters,
    PantographState,
    Records,
    Wires,
    Work,
)
from catenary_fe.engines.compiled import compiled, kept, stamp, vectorising
from catenary_fe.engines.contact_solver import advance_heads
from catenary_fe.engines.generalized_alpha import Scheme, predict
from catenary_fe.engines.history import History
from catenary_fe.engines.kernels import add_loads, begin, lower, upper
from catenary_fe.engines.lanes import aligned
from catenary_fe.engines.linearised import arrays, forces, stretch
from catenary_fe.engines.linearised.arrays import Line, Near, Operator
from catenary_fe.engines.linearised.forces import record, solve_contacts
from catenary_fe.engines.linearised.leg import Leg
from catenary_fe.engines.linearised.setup import Setup
from catenary_fe.engines.linearised.stretch import take_elements
from catenary_fe.engines.recorder import (
    InitialState,
    Sizes,
    load_pantographs,
    make_pantographs,
    make_records,
    read_history,
)
from catenary_fe.engines.sections import Computed, sections_met
from catenary_fe.fe.system import System

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
FEW = 3  # runs that take less time one by one than in slots, most of which stay empty (measured)
BLOCK = 250  # steps between looks at which slots are free


class Batch:
    """Room for runs that advance together, one or ``SLOTS`` at once."""

    def __init__(
        self, setup: Setup, sizes: Sizes, slots: int, every: int = 0, signals: Floats | None = None
    ) -> None:
        assert slots in (1, SLOTS)
        n, line = setup.size, setup.line
        j, m = sizes.contacts, sizes.coordinates
        self._setup, self.count = setup, slots
        self._leg: Leg | None = None
        self._start: InitialState | None = None
        self._computed = Computed(setup.model.section_starts.size - 1)
        self._operator = setup.operator
        self.signals = np.zeros((0, sizes.steps + 2)) if signals is None else signals
        self.wires = Wires(*(aligned((n, slots)) for _ in range(5)))
        self.heads, self.pantographs = make_pantographs(slots, sizes, setup.nominal, setup.base_line)
        width = 2 * line.contact_compliance.value.shape[1]
        self.work = Work(
            force=np.zeros((slots, j)),
            law_force=np.zeros((slots, sizes.laws)),
            slack=np.zeros((slots, line.k.size)),
            arm_force=np.zeros((slots, line.links.k.size, 2)),
            tension=aligned((line.tensions.size, slots)),
            active=np.zeros((slots, line.k.size), dtype=np.int64),
            active_count=np.zeros(slots, dtype=np.int64),
            column=np.zeros((slots, j, width)),
            first=np.zeros((slots, j), dtype=np.int64),
            width=np.zeros((slots, j), dtype=np.int64),
            shape=np.zeros((slots, j, 5)),
            rise=np.zeros((slots, j, 5)),
            at=np.zeros((slots, j, 4), dtype=np.int64),
            node=np.zeros((slots, j), dtype=np.int64),
            on=np.zeros((slots, j), dtype=np.int64),
            base=np.zeros((slots, j)),
            head=np.zeros((slots, j, m)),
            head_compliance=np.zeros((slots, j, m)),
        )
        room = 4 * j + line.rows.column.size + line.links.at.size
        self.near = Near(
            at=np.zeros(room, dtype=np.int64),
            many=np.zeros(1, dtype=np.int64),
            free=np.zeros(room),
            owed=np.zeros(j + line.k.size + line.links.at.size),
        )
        counts = line.k.size, line.supports.size, line.heights.size, line.tensions.size
        self._new_records = partial(make_records, slots, sizes, counts, every, spatial=setup.model.spatial)
        self.records = self._new_records()

    def load(self, slot: int, start: InitialState, steps: int) -> None:
        """Put a run at its start into a slot."""
        if self.count == 1:
            self.records = self._new_records()  # a history keeps those that it is of
        zero, self._start, self._leg = np.zeros_like(start.q), start, None
        self._computed = Computed(len(self._computed.steps))
        # at rest q* = q and v* = 0
        for array, values in zip(self.wires, (start.q, zero, zero, zero, start.q), strict=True):
            array[:, slot] = values
        self.work.active_count[slot] = 0
        for array in (self.work.force, self.work.slack, self.work.arm_force):
            array[slot] = 0.0  # forces with which the run before ended
        self.work.tension[:, slot] = start.q[self._setup.line.tensions]
        load_pantographs(self.heads, self.pantographs, self.records, slot, self._setup.scheme, start, steps)
        supports, heights = self._setup.line.supports, self._setup.model.heights
        self.records.supports[slot, supports >= 0, 0] = start.q[supports[supports >= 0]]
        if self.records.every:
            self.records.wire[slot, 0, heights >= 0] = start.q[heights[heights >= 0]]

    def advance(self, steps: int = BLOCK) -> None:
        """Take steps in all slots; slots that are at their end stay there."""
        own: tuple[Any, ...] = self._operator, self._setup.line, self.wires, self.work, self.records
        if self._setup.relays and self.count == 1:
            own = self._leg_of(steps)
        operator, line, wires, work, records = own
        rows, tension = wires, work.tension
        if self.count == 1:
            rows, tension = Wires(*(array.reshape(-1) for array in wires)), tension.reshape(-1)
        state = self.heads, self.pantographs, work, self.near, records
        with vectorising():
            _advance(self._setup.scheme, operator, line, self.signals, wires, rows, tension, *state, steps)

    def _leg_of(self, steps: int) -> tuple[Operator, Line, Wires, Work, Records]:
        """Arrays of the sections that the run's pantographs are on during the next steps."""
        assert self._start is not None
        done, last = int(self.pantographs.step[0]), int(self.heads.last[0])
        after, metre = min(done + steps, last), self._start.speed * self._setup.scheme.h
        paths = self._setup.model.contacts
        met = sections_met(paths, self._start.contacts, metre * done, metre * after)
        if not self._leg or self._leg.sections != met:
            before, self._leg = self._leg, Leg.of(self._setup, met)
            if before:
                self._leg.take_over(self.work, before)
        if after > done:
            self._computed.add(met, done, after)
        leg = self._leg
        own = leg.wires(self.wires), leg.work(self.work), leg.records(self.records)
        return leg.operator, leg.line, *own

    def history(self, slot: int, start: InitialState, steps: int, system: System) -> History:
        """What a slot's run recorded."""
        computed, step = self._computed if self._leg else None, self._setup.scheme.h
        found = read_history(self.records, self.heads, slot, start, steps, step, system, computed)
        return found if self.count == 1 else replace(found, dropper_force=found.dropper_force.copy())

    def tension_changes(self, slot: int) -> tuple[Floats, Integers]:
        """[N], shape (gaps,): largest change of each gap's tension, and the steps at whose ends they are."""
        return self.records.change[slot], self.records.changed[slot]

    def shortenings(self, slot: int) -> tuple[Floats, Integers]:
        """[m], shape (droppers,): largest shortening of each dropper while slack, and likewise the steps."""
        return self.records.shortening[slot], self.records.shortened[slot]

    def free(self) -> list[int]:
        """Slots whose run is over."""
        return np.flatnonzero(self.pantographs.step >= self.heads.last).tolist()


@compiled
def _finish(
    scheme: Scheme,
    line: Line,
    wires: Wires,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    near: Near,
    records: Records,
) -> None:
    """Forces and records of all slots."""
    for c in range(pantographs.step.size):
        if pantographs.step[c] < heads.last[c]:
            advance_heads(scheme, pantographs, c)
            solve_contacts(scheme, line, wires, heads, pantographs, work, near, records, c)
            record(scheme, line, wires, heads, pantographs, work, records, c)
            pantographs.step[c] += 1


def _loop(sources: str) -> Any:
    """Steps; ``sources`` is the stamp of all that they call."""

    @kept
    def advance(
        scheme: Scheme,
        operator: Operator,
        line: Line,
        signals: Floats,
        wires: Wires,
        rows: Wires,
        tension: Floats,
        heads: PantographParameters,
        pantographs: PantographState,
        work: Work,
        near: Near,
        records: Records,
        steps: int,
    ) -> int:
        """Take steps in all slots; ``rows`` and ``tension`` are of one dimension if there is one slot."""
        groups = line.load.size // 4
        for _ in range(steps):
            predict(scheme, operator.beta, rows)
            begin(line.load, operator.stiffness, rows.w, operator.rest, rows.v, rows.x)
            for c in range(pantographs.step.size):
                add_loads(line.patterns, signals[:, pantographs.step[c] + 1], wires.x[:, c])
            take_elements(line, rows.q, tension, rows.w, rows.x)
            lower(operator.factor, rows.x, 0, groups)
            upper(operator.factor, rows.x, 0, groups)
            _finish(scheme, line, wires, heads, pantographs, work, near, records)
        return len(sources)

    return advance


_advance = _loop(
    stamp(shared, lanes, generalized_alpha, contact_solver, pantograph_laws, kernels, arrays, forces, stretch)
)


def most_slots(setup: Setup, sizes: Sizes, runs: int, memory: float = 1.5e9) -> int:
    """``SLOTS`` if there are more than few runs and their histories fit into the memory [bytes], else 1.

    Runs that compute some of the sections alone go one by one: side by side they were on all of them.
    """
    line = setup.line
    histories = (
        line.k.size + line.supports.size + 3 * sizes.contacts + sizes.pantographs * sizes.coordinates + 2
    )
    size = 8.0 * SLOTS * (sizes.steps * histories + sizes.shapes * line.heights.size)
    return SLOTS if runs > FEW and size <= memory and not setup.relays else 1
