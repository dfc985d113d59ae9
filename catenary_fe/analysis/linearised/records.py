"""Pantographs and histories of compiled runs: from a static start into arrays, from arrays to a journey."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.analysis.linearised.arrays import Heads, Records, Scheme
from catenary_fe.analysis.linearised.start import Start
from catenary_fe.equilibrium import Shape

if TYPE_CHECKING:
    from catenary_fe.fe.drive import Journey

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Sizes:
    """The most that any run of a batch needs."""

    pantographs: int
    contacts: int
    coordinates: int
    steps: int
    shapes: int = 0


def make_heads(lanes: int, sizes: Sizes, nominal: float) -> Heads:
    """Room for pantographs."""
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


def make_records(lanes: int, sizes: Sizes, counts: tuple[int, int, int, int], every: int) -> Records:
    """Room for histories.

    counts : numbers of droppers, of supports on all contact wires, of nodes of all wires, of gaps whose
        tension is followed
    every : steps between shapes of the wires, 0: none
    """
    p, j, m, t = sizes.pantographs, sizes.contacts, sizes.coordinates, sizes.steps + 1
    droppers, supports, nodes, gaps = counts
    return Records(
        force=np.zeros((lanes, j, t)),
        height=np.zeros((lanes, j, t)),
        masses=np.zeros((lanes, p, m, t)),
        droppers=np.zeros((lanes, droppers, t)),
        supports=np.zeros((lanes, supports, t)),
        change=np.zeros((lanes, gaps)),
        changed=np.zeros((lanes, gaps), dtype=np.int64),
        shortening=np.zeros((lanes, droppers)),
        shortened=np.zeros((lanes, droppers), dtype=np.int64),
        wire=np.zeros((lanes, sizes.shapes, nodes)),
        every=every,
    )


def load_heads(heads: Heads, records: Records, lane: int, scheme: Scheme, start: Start, steps: int) -> None:
    """Put the pantographs of a run at its start into a lane."""
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
    heads.owner[lane] = -1
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
    records.droppers[lane, :, 0] = start.dropper_force
    for found in (records.change, records.changed, records.shortening, records.shortened):
        found[lane] = 0


def read_journey(
    records: Records, heads: Heads, lane: int, start: Start, steps: int, step: float, shape: Shape
) -> Journey:
    """What a lane's run recorded."""
    from catenary_fe.fe.drive import Journey

    mesh = shape.mesh
    n, every, chains = steps + 1, records.every, start.chains
    time: Floats = np.arange(n, dtype=np.float64) * step
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
        contact_force=np.array([records.force[lane, owner == p, :n].sum(axis=0) for p in range(len(chains))]),
        wire_height=np.array([records.height[lane, owner == p, :n].mean(axis=0) for p in range(len(chains))]),
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
