"""Lanes in which linearised runs advance side by side; a lane whose run is over takes the next one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.analysis.compiled import COMPILED, compiled, kept, stamp, vectorising
from catenary_fe.analysis.linearised import arrays, forces, kernel
from catenary_fe.analysis.linearised.arrays import (
    LANES,
    Heads,
    Line,
    Operator,
    Records,
    Scheme,
    Wires,
    Work,
)
from catenary_fe.analysis.linearised.forces import advance_heads, meet, record
from catenary_fe.analysis.linearised.kernel import (
    advance,
    bow_eight,
    bow_one,
    lower_eight,
    lower_one,
    predict,
    take_eight,
    take_one,
    upper_eight,
    upper_one,
)
from catenary_fe.analysis.linearised.records import Sizes, load_heads, make_heads, make_records, read_journey
from catenary_fe.analysis.linearised.setup import Setup, make_operator
from catenary_fe.analysis.linearised.start import Start
from catenary_fe.equilibrium import Shape

if TYPE_CHECKING:
    from catenary_fe.fe.drive import Journey

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
BLOCK = 250  # steps between looks at which lanes are free


class Lanes:
    """Room for runs that advance together, one or ``LANES`` at once."""

    def __init__(self, setup: Setup, sizes: Sizes, lanes: int, every: int = 0) -> None:
        assert lanes in (1, LANES)
        n, line = setup.size, setup.line
        j, m = sizes.contacts, sizes.coordinates
        self._setup, self.count = setup, lanes
        self._operator = make_operator(setup, lanes) if COMPILED else None
        self.wires = Wires(*(np.zeros((n, lanes)) for _ in range(5)))
        self.heads = make_heads(lanes, sizes, setup.nominal)
        width = 2 * line.give.value.shape[1]
        self.work = Work(
            force=np.zeros((lanes, j)),
            slack=np.zeros((lanes, line.k.size)),
            swing=np.zeros((lanes, line.links.k.size, 2)),
            tension=np.zeros((lanes, line.tensions.size)),
            active=np.zeros((lanes, line.k.size), dtype=np.int64),
            active_count=np.zeros(lanes, dtype=np.int64),
            column=np.zeros((lanes, j, width)),
            first=np.zeros((lanes, j), dtype=np.int64),
            width=np.zeros((lanes, j), dtype=np.int64),
            shape=np.zeros((lanes, j, 5)),
            rise=np.zeros((lanes, j, 5)),
            at=np.zeros((lanes, j, 4), dtype=np.int64),
            head=np.zeros((lanes, j, m)),
            soft=np.zeros((lanes, j, m)),
        )
        counts = line.k.size, line.supports.size, line.heights.size, line.tensions.size
        self.records = make_records(lanes, sizes, counts, every)

    def load(self, lane: int, start: Start, steps: int) -> None:
        """Put a run at its start into a lane."""
        zero = np.zeros_like(start.q)
        # at rest q* = q and v* = 0
        for array, values in zip(self.wires, (start.q, zero, zero, zero, start.q), strict=True):
            array[:, lane] = values
        self.work.active_count[lane] = 0
        for array in (self.work.force, self.work.slack, self.work.swing):
            array[lane] = 0.0  # forces with which the run before ended
        self.work.tension[lane] = start.q[self._setup.line.tensions]
        load_heads(self.heads, self.records, lane, self._setup.scheme, start, steps)
        supports, heights = self._setup.line.supports, self._setup.model.heights
        self.records.supports[lane, supports >= 0, 0] = start.q[supports[supports >= 0]]
        if self.records.every:
            self.records.wire[lane, 0, heights >= 0] = start.q[heights[heights >= 0]]

    def advance(self, steps: int = BLOCK) -> None:
        """Take steps in all lanes; lanes that are at their end stay there."""
        setup, wires = self._setup, self.wires
        rest = (self.heads, self.work, self.records, steps)
        if self._operator is None:
            _advance_plainly(setup, wires, *rest)
            return
        flat = Wires(*(array.reshape(-1) for array in wires))
        with vectorising():
            take = _advance_one if self.count == 1 else _advance_eight
            take(setup.scheme, self._operator, setup.line, wires, flat, *rest)

    def journey(self, lane: int, start: Start, steps: int, shape: Shape) -> Journey:
        """What a lane's run recorded."""
        return read_journey(self.records, self.heads, lane, start, steps, self._setup.scheme.h, shape)

    def tension_changes(self, lane: int) -> tuple[Floats, Integers]:
        """[N], shape (gaps,): largest change of each gap's tension, and the steps at whose ends they are."""
        return self.records.change[lane], self.records.changed[lane]

    def shortenings(self, lane: int) -> tuple[Floats, Integers]:
        """[m], shape (droppers,): largest shortening of each dropper while slack, and likewise the steps."""
        return self.records.shortening[lane], self.records.shortened[lane]

    def free(self) -> list[int]:
        """Lanes whose run is over."""
        return np.flatnonzero(self.heads.step >= self.heads.last).tolist()


@compiled
def _finish(scheme: Scheme, line: Line, wires: Wires, heads: Heads, work: Work, records: Records) -> None:
    """Forces and records of all lanes, and the next step's prediction of the masses."""
    for c in range(heads.step.size):
        if heads.step[c] < heads.last[c]:
            meet(scheme, line, wires, heads, work, records, c)
            record(scheme, line, wires, heads, work, records, c)
            advance_heads(scheme, heads, c)
            heads.step[c] += 1


def _loops(sources: str) -> tuple[Any, Any]:
    """Steps of one lane and of eight; ``sources`` is the stamp of all that they call."""

    @kept
    def one(
        scheme: Scheme,
        operator: Operator,
        line: Line,
        wires: Wires,
        flat: Wires,
        heads: Heads,
        work: Work,
        records: Records,
        steps: int,
    ) -> int:
        groups = flat.x.size // 4
        for _ in range(steps):
            flat.x[:] = line.load
            take_one(operator.stiffness, flat.w, flat.x)
            take_one(operator.rest, flat.v, flat.x)
            bow_one(line, flat.q, work.tension[0], flat.x)
            lower_one(operator.lower, flat.x, 0, groups)
            upper_one(operator.upper, operator.inverse, flat.x, 0, groups)
            _finish(scheme, line, wires, heads, work, records)
            predict(scheme, operator.beta, flat)
        return len(sources)

    @kept
    def eight(
        scheme: Scheme,
        operator: Operator,
        line: Line,
        wires: Wires,
        flat: Wires,
        heads: Heads,
        work: Work,
        records: Records,
        steps: int,
    ) -> int:
        for _ in range(steps):
            for i in range(line.load.size):
                wires.x[i, :] = line.load[i]
            take_eight(operator.stiffness, wires.w, wires.x)
            take_eight(operator.rest, wires.v, wires.x)
            bow_eight(line, wires.q, work.tension, wires.x)
            lower_eight(operator.lower, wires.x)
            upper_eight(operator.upper, operator.inverse, wires.x)
            _finish(scheme, line, wires, heads, work, records)
            predict(scheme, operator.beta, flat)
        return len(sources)

    return one, eight


_advance_one, _advance_eight = _loops(stamp(arrays, forces, kernel))


def _advance_plainly(
    setup: Setup, wires: Wires, heads: Heads, work: Work, records: Records, steps: int
) -> None:
    """Without a compiler: scipy's products and solves, the few forces in Python."""
    model, scheme = setup.model, setup.scheme
    for _ in range(steps):
        if (heads.step >= heads.last).all():
            return
        wires.x[:] = setup.line.load[:, None] - (model.stiffness @ wires.q + model.damping @ wires.v)
        for lane in range(wires.x.shape[1]):
            bow_one(setup.line, wires.q[:, lane], work.tension[lane], wires.x[:, lane])
        wires.x[:] = setup.factor.solve(wires.x)
        _finish(scheme, setup.line, wires, heads, work, records)
        state = advance(scheme, wires.q, wires.v, wires.c, wires.x)
        for array, values in zip(wires, state, strict=False):
            array[:] = values


def most_lanes(setup: Setup, sizes: Sizes, runs: int, memory: float = 1.5e9) -> int:
    """``LANES`` if there are several runs and their histories fit into the memory [bytes], else 1."""
    line = setup.line
    histories = (
        line.k.size + line.supports.size + 2 * sizes.contacts + sizes.pantographs * sizes.coordinates + 2
    )
    size = 8.0 * LANES * (sizes.steps * histories + sizes.shapes * line.heights.size)
    return LANES if runs > 1 and size <= memory else 1
