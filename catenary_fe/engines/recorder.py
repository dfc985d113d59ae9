"""Pantographs and histories of compiled runs: from a static start into arrays, from arrays to a history."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import Heads, Records
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.linearised.start import InitialState
from catenary_fe.statics import Shape

if TYPE_CHECKING:
    from catenary_fe.engines.exudyn.run import History

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Sizes:
    """The most that any run of a batch needs."""

    pantographs: int
    contacts: int
    coordinates: int
    steps: int
    shapes: int = 0


def make_heads(slots: int, sizes: Sizes, nominal: float) -> Heads:
    """Room for pantographs."""
    each, body = (slots, sizes.contacts), (slots, sizes.pantographs, sizes.coordinates)
    square, rows = (*body, sizes.coordinates), (*each, sizes.coordinates)
    return Heads(
        q=np.zeros(body),
        v=np.zeros(body),
        c=np.zeros(body),
        x=np.zeros(body),
        K=np.zeros(square),
        D=np.zeros(square),
        inverse=np.zeros(square),
        load=np.zeros(body),
        owner=np.full(each, -1),
        wire=np.zeros(each, dtype=np.int64),
        start=np.zeros(each),
        heave=np.zeros(rows),
        roll=np.zeros(rows),
        k=np.zeros(each),
        d=np.zeros(each),
        preload=np.zeros(each),
        speed=np.zeros(slots),
        step=np.zeros(slots, dtype=np.int64),
        last=np.zeros(slots, dtype=np.int64),
        nominal=nominal,
    )


def make_records(slots: int, sizes: Sizes, counts: tuple[int, int, int, int], every: int) -> Records:
    """Room for histories.

    counts : numbers of droppers, of supports on all contact wires, of nodes of all wires, of gaps whose
        tension is followed
    every : steps between shapes of the wires, 0: none
    """
    p, j, m, t = sizes.pantographs, sizes.contacts, sizes.coordinates, sizes.steps + 1
    droppers, supports, nodes, gaps = counts
    return Records(
        force=np.zeros((slots, j, t)),
        height=np.zeros((slots, j, t)),
        masses=np.zeros((slots, p, m, t)),
        droppers=np.zeros((slots, droppers, t)),
        supports=np.zeros((slots, supports, t)),
        change=np.zeros((slots, gaps)),
        changed=np.zeros((slots, gaps), dtype=np.int64),
        shortening=np.zeros((slots, droppers)),
        shortened=np.zeros((slots, droppers), dtype=np.int64),
        wire=np.zeros((slots, sizes.shapes, nodes)),
        every=every,
    )


def load_heads(
    heads: Heads, records: Records, slot: int, scheme: Scheme, start: InitialState, steps: int
) -> None:
    """Put the pantographs of a run at its start into a slot."""
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
        array[slot] = 0.0
    heads.owner[slot] = -1
    j = 0
    for p, body in enumerate(start.bodies):
        m = body.q.size
        heads.q[slot, p, :m] = body.q
        heads.K[slot, p, :m, :m], heads.D[slot, p, :m, :m] = body.K, body.D
        heads.inverse[slot, p, :m, :m] = np.linalg.inv(body.M + scheme.g * body.D + scheme.b * body.K)
        heads.load[slot, p, :m] = body.uplift * body.load
        records.masses[slot, p, :m, 0] = body.q
        for touch in body.touches:
            heads.owner[slot, j], heads.wire[slot, j] = p, touch.wire
            heads.start[slot, j] = body.position + touch.ahead
            heads.heave[slot, j, :m], heads.roll[slot, j, :m] = touch.heave, touch.roll
            heads.k[slot, j], heads.d[slot, j] = body.contact_stiffness, body.contact_damping
            heads.preload[slot, j] = body.preload
            records.force[slot, j, 0], records.height[slot, j, 0] = touch.force, touch.wire_height
            j += 1
    heads.speed[slot], heads.step[slot], heads.last[slot] = start.speed, 0, steps
    records.droppers[slot, :, 0] = start.dropper_force
    for found in (records.change, records.changed, records.shortening, records.shortened):
        found[slot] = 0


def read_journey(
    records: Records, heads: Heads, slot: int, start: InitialState, steps: int, step: float, shape: Shape
) -> History:
    """What a slot's run recorded."""
    from catenary_fe.engines.exudyn.run import History

    mesh = shape.mesh
    n, every, bodies = steps + 1, records.every, start.bodies
    time: Floats = np.arange(n, dtype=np.float64) * step
    owner = heads.owner[slot]
    at = np.array([body.position for body in bodies])
    supports = [w.z[m.supports] for w, m in zip(shape.contact_wires, mesh.wires, strict=False)]
    uplift = records.supports[slot, :, :n].reshape(len(supports), -1, n)
    stored = records.wire[slot, : steps // every + 1] if every else np.zeros((0, 0))
    nodes = zip(shape.wires, mesh.first_nodes[:-1], mesh.first_nodes[1:], strict=True)
    nothing = np.array([])
    return History(
        time=time,
        position=at[:, None] + heads.speed[slot] * time,
        contact_force=np.array([records.force[slot, owner == p, :n].sum(axis=0) for p in range(len(bodies))]),
        wire_height=np.array([records.height[slot, owner == p, :n].mean(axis=0) for p in range(len(bodies))]),
        mass_heights=[records.masses[slot, p, : c.masses, :n].copy() for p, c in enumerate(bodies)],
        dropper_force=records.droppers[slot, :, :n].copy(),
        support_height=np.array(supports)[:, :, None] + uplift,
        wire_x=[wire.x for wire in mesh.wires],
        wire_z=[hanging.z + stored[:, a:b] for hanging, a, b in nodes] if every else [],
        wire_times=time[::every] if every else None,
        energy=nothing,
        energy_times=nothing,
        driven_work=nothing,
    )
