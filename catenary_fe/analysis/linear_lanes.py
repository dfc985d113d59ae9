"""Lanes in which linearised runs advance side by side; a lane whose run is over takes the next one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.analysis import linear_arrays, linear_forces, linear_kernel
from catenary_fe.analysis.compiled import COMPILED, compiled, kept, stamp, vectorising
from catenary_fe.analysis.linear_arrays import (
    LANES,
    Heads,
    Line,
    Operator,
    Records,
    Scheme,
    Wires,
    Work,
)
from catenary_fe.analysis.linear_forces import advance_heads, meet, record
from catenary_fe.analysis.linear_kernel import (
    advance,
    lower_eight,
    lower_one,
    predict,
    take_eight,
    take_one,
    upper_eight,
    upper_one,
)
from catenary_fe.analysis.linear_setup import Setup, make_operator
from catenary_fe.analysis.linear_start import Start
from catenary_fe.equilibrium import Shape

if TYPE_CHECKING:
    from catenary_fe.fe.drive import Journey

Floats = NDArray[np.float64]
BLOCK = 250  # steps between looks at which lanes are free


@dataclass(frozen=True)
class Sizes:
    """The most that any run of a batch needs."""

    pantographs: int
    contacts: int
    coordinates: int
    steps: int
    shapes: int = 0


class Lanes:
    """Room for runs that advance together, one or ``LANES`` at once."""

    def __init__(self, setup: Setup, sizes: Sizes, lanes: int, every: int = 0) -> None:
        assert lanes in (1, LANES)
        n, line = setup.size, setup.line
        p, j, m = sizes.pantographs, sizes.contacts, sizes.coordinates
        self._setup, self.count = setup, lanes
        self._operator = make_operator(setup, lanes) if COMPILED else None
        self.wires = Wires(*(np.zeros((n, lanes)) for _ in range(5)))
        self.heads = _heads(lanes, sizes, setup.nominal)
        width = 2 * line.give.value.shape[1]
        self.work = Work(
            force=np.zeros((lanes, j)),
            slack=np.zeros((lanes, line.k.size)),
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
        t = sizes.steps + 1
        self.records = Records(
            force=np.zeros((lanes, j, t)),
            height=np.zeros((lanes, j, t)),
            masses=np.zeros((lanes, p, m, t)),
            droppers=np.zeros((lanes, line.k.size, t)),
            supports=np.zeros((lanes, line.supports.size, t)),
            share=np.zeros((lanes, t)),
            slack=np.zeros((lanes, t)),
            wire=np.zeros((lanes, sizes.shapes, line.heights.size)),
            every=every,
        )

    def load(self, lane: int, start: Start, steps: int) -> None:
        """Put a run at its start into a lane."""
        scheme, heads, records = self._setup.scheme, self.heads, self.records
        zero = np.zeros_like(start.q)
        # at rest q* = q and v* = 0
        for array, values in zip(self.wires, (start.q, zero, zero, zero, start.q), strict=True):
            array[:, lane] = values
        for array in (
            heads.q,
            heads.v,
            heads.c,
            heads.x,
            heads.K,
            heads.D,
            heads.inverse,
            heads.load,
            heads.heave,
            heads.roll,
        ):
            array[lane] = 0.0
        heads.owner[lane], self.work.active_count[lane] = -1, 0
        j = 0
        for p, chain in enumerate(start.chains):
            m = chain.q.size
            heads.q[lane, p, :m] = chain.q
            heads.K[lane, p, :m, :m], heads.D[lane, p, :m, :m] = chain.K, chain.D
            heads.inverse[lane, p, :m, :m] = np.linalg.inv(chain.M + scheme.g * chain.D + scheme.b * chain.K)
            heads.load[lane, p, :m] = chain.uplift * chain.load
            records.masses[lane, p, :m, 0] = chain.q
            for touch in chain.touches:
                heads.owner[lane, j], heads.wire[lane, j] = p, touch.wire
                heads.start[lane, j] = chain.position + touch.ahead
                heads.heave[lane, j, :m], heads.roll[lane, j, :m] = touch.heave, touch.roll
                heads.k[lane, j], heads.d[lane, j] = chain.contact_stiffness, chain.contact_damping
                heads.preload[lane, j] = chain.preload
                records.force[lane, j, 0], records.height[lane, j, 0] = touch.force, touch.wire_height
                j += 1
        heads.speed[lane], heads.step[lane], heads.last[lane] = start.speed, 0, steps
        self._record_start(lane, start)

    def _record_start(self, lane: int, start: Start) -> None:
        records, model = self.records, self._setup.model
        records.droppers[lane, :, 0] = start.dropper_force
        supports, heights = self._setup.line.supports, model.heights
        records.supports[lane, supports >= 0, 0] = start.q[supports[supports >= 0]]
        records.share[lane, 0] = records.slack[lane, 0] = 0.0
        if records.every:
            records.wire[lane, 0, heights >= 0] = start.q[heights[heights >= 0]]

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
        from catenary_fe.fe.drive import Journey

        records, heads, mesh = self.records, self.heads, shape.mesh
        n, every, chains = steps + 1, self.records.every, start.chains
        time: Floats = np.arange(n, dtype=np.float64) * self._setup.scheme.h
        owner = heads.owner[lane]
        at = np.array([chain.position for chain in chains])
        supports = [w.z[m.supports] for w, m in zip(shape.contact_wires, mesh.wires, strict=False)]
        uplift = records.supports[lane, :, :n].reshape(len(supports), -1, n)
        stored = records.wire[lane, : steps // every + 1] if every else np.zeros((0, 0))
        nodes = zip(shape.wires, mesh.first_nodes[:-1], mesh.first_nodes[1:], strict=True)
        nothing = np.array([])
        return Journey(
            time=time,
            position=at[:, None] + heads.speed[lane] * time,
            contact_force=np.array(
                [records.force[lane, owner == p, :n].sum(axis=0) for p in range(len(chains))]
            ),
            wire_height=np.array(
                [records.height[lane, owner == p, :n].mean(axis=0) for p in range(len(chains))]
            ),
            mass_heights=[records.masses[lane, p, : c.masses, :n].copy() for p, c in enumerate(chains)],
            dropper_force=records.droppers[lane, :, :n].copy(),
            support_height=np.array(supports)[:, :, None] + uplift,
            wire_x=[wire.x for wire in mesh.wires],
            wire_z=[hanging.z + stored[:, a:b] for hanging, a, b in nodes] if every else [],
            wire_times=time[::every] if every else None,
            energy=nothing,
            energy_times=nothing,
            driven_work=nothing,
        )

    def doubts(self, lane: int, steps: int) -> tuple[Floats, Floats]:
        """Histories of the tension's change over the tension, and of the shortening of slack droppers [m]."""
        return self.records.share[lane, : steps + 1], self.records.slack[lane, : steps + 1]

    def free(self) -> list[int]:
        """Lanes whose run is over."""
        return np.flatnonzero(self.heads.step >= self.heads.last).tolist()


def _heads(lanes: int, sizes: Sizes, nominal: float) -> Heads:
    each, chain = (lanes, sizes.contacts), (lanes, sizes.pantographs, sizes.coordinates)
    square, rows = (*chain, sizes.coordinates), (*each, sizes.coordinates)
    return Heads(
        q=np.zeros(chain),
        v=np.zeros(chain),
        c=np.zeros(chain),
        x=np.zeros(chain),
        K=np.zeros(square),
        D=np.zeros(square),
        inverse=np.zeros(square),
        load=np.zeros(chain),
        owner=np.full(each, -1),
        wire=np.zeros(each, dtype=np.int64),
        start=np.zeros(each),
        heave=np.zeros(rows),
        roll=np.zeros(rows),
        k=np.zeros(each),
        d=np.zeros(each),
        preload=np.zeros(each),
        speed=np.zeros(lanes),
        step=np.zeros(lanes, dtype=np.int64),
        last=np.zeros(lanes, dtype=np.int64),
        nominal=nominal,
    )


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
        for _ in range(steps):
            flat.x[:] = 0.0
            take_one(operator.stiffness, flat.w, flat.x)
            take_one(operator.rest, flat.v, flat.x)
            lower_one(operator.lower, flat.x)
            upper_one(operator.upper, operator.inverse, flat.x)
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
            flat.x[:] = 0.0
            take_eight(operator.stiffness, wires.w, wires.x)
            take_eight(operator.rest, wires.v, wires.x)
            lower_eight(operator.lower, wires.x)
            upper_eight(operator.upper, operator.inverse, wires.x)
            _finish(scheme, line, wires, heads, work, records)
            predict(scheme, operator.beta, flat)
        return len(sources)

    return one, eight


_advance_one, _advance_eight = _loops(stamp(linear_arrays, linear_forces, linear_kernel))


def _advance_plainly(
    setup: Setup, wires: Wires, heads: Heads, work: Work, records: Records, steps: int
) -> None:
    """Without a compiler: scipy's products and solves, the few forces in Python."""
    model, scheme = setup.model, setup.scheme
    for _ in range(steps):
        if (heads.step >= heads.last).all():
            return
        right = model.stiffness @ wires.q + model.damping @ wires.v
        wires.x[:] = setup.factor.solve(-right)
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
