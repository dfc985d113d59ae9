"""Pantographs and histories of compiled runs: from a static start into arrays, from arrays to a history."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import Laws, PantographParameters, PantographState, Records, Surfaces
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.history import History, of_contacts, section_forces, where_pressed
from catenary_fe.engines.sections import Computed
from catenary_fe.fe.contact import BaseLine, Contact, ContactPath, PlacedPantograph, contacts_of
from catenary_fe.fe.system import System
from catenary_fe.layout.bodies import ORDER

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def surfaces_of(paths: Sequence[ContactPath]) -> Surfaces:
    """The contact wires' running surfaces as arrays."""
    each = [path.irregularity for path in paths]
    most = max((len(one.values) for one in each if one), default=0)
    values = np.zeros((len(each), most, 2))
    for n, one in enumerate(each):
        if one:
            values[n, : len(one.values)] = one.values
    return Surfaces(
        first=np.array([one.first if one else 0.0 for one in each]),
        step=np.array([one.step if one else 1.0 for one in each]),
        last=np.array([len(one.values) - 1 if one else -1 for one in each]),
        values=values,
    )


@dataclass(frozen=True)
class Sizes:
    """The most that any run of a batch needs."""

    pantographs: int
    contacts: int
    coordinates: int
    steps: int
    shapes: int = 0
    points: int = 0
    laws: int = 0
    frames: int = 0
    powers: int = ORDER

    @classmethod
    def of(cls, runs: Sequence[Sequence[PlacedPantograph]], wires: int, steps: int, every: int) -> Sizes:
        """The most that runs with these pantographs on so many contact wires need.

        every : steps between shapes of the wires, 0: none
        """
        bodies = [placed.body for run in runs for placed in run]
        return cls(
            pantographs=max((len(run) for run in runs), default=1),
            contacts=max((len(contacts_of(run, wires)) for run in runs), default=1),
            coordinates=max([1, *(body.size for body in bodies)]),
            steps=steps,
            shapes=steps // every + 1 if every else 0,
            points=max((len(body.contact.points) for body in bodies), default=0),
            laws=max((sum(len(placed.body.laws) for placed in run) for run in runs), default=0),
            powers=max((body.powers for body in bodies), default=1),
            frames=max((len(law.table) for body in bodies for law in body.laws), default=0),
        )


@dataclass(frozen=True)
class InitialState:
    """Where a run starts, at rest in static contact.

    q : [m], shape (coordinates of the engine,), displacements
    dropper_force : [N], shape (droppers,)
    speed : [m/s]
    wires : number of contact wires
    """

    q: Floats
    pantographs: list[PlacedPantograph]
    dropper_force: Floats
    speed: float
    wires: int

    @property
    def contact_forces(self) -> Floats:
        """[N], shape (contacts,)."""
        return np.concatenate([np.zeros(0), *(placed.forces for placed in self.pantographs)])

    @property
    def wire_heights(self) -> Floats:
        """[m], shape (contacts,), above the nominal contact wire height."""
        return np.concatenate([np.zeros(0), *(placed.wire_heights for placed in self.pantographs)])

    @property
    def contacts(self) -> list[Contact]:
        """Each strip on each contact wire."""
        return contacts_of(self.pantographs, self.wires)


def make_pantographs(
    slots: int, sizes: Sizes, nominal: float, base: BaseLine
) -> tuple[PantographParameters, PantographState]:
    """Room for pantographs."""
    each, own = (slots, sizes.contacts), (slots, sizes.pantographs, sizes.coordinates)
    square, rows = (*own, sizes.coordinates), (*each, sizes.coordinates)
    parameters = PantographParameters(
        K=np.zeros(square),
        D=np.zeros(square),
        inverse=np.zeros(square),
        load=np.zeros(own),
        base_load=np.zeros(own),
        follows=np.zeros(own[:2]),
        place=np.zeros(own[:2]),
        owner=np.full(each, -1),
        wire=np.zeros(each, dtype=np.int64),
        start=np.zeros(each),
        shape=np.zeros((*rows, sizes.powers)),
        k=np.zeros(each),
        d=np.zeros(each),
        preload=np.zeros(each),
        points=np.zeros(each, dtype=np.int64),
        law=np.zeros((*each, sizes.points, 2)),
        speed=np.zeros(each),
        pace=np.zeros(slots),
        last=np.zeros(slots, dtype=np.int64),
        nominal=nominal,
        base_x=base.x,
        base_z=base.z,
        base_stiffness=np.zeros(own),
        base_damping=np.zeros(own),
        base=Surfaces(
            first=np.zeros(own[0] * own[1]),
            step=np.ones(own[0] * own[1]),
            last=np.full(own[0] * own[1], -1),
            values=np.zeros((own[0] * own[1], sizes.steps + 1 if base.motions else 0, 2)),
        ),
        laws=_no_laws(slots, sizes),
    )
    state = PantographState(
        q=np.zeros(own),
        v=np.zeros(own),
        c=np.zeros(own),
        x=np.zeros(own),
        step=np.zeros(slots, dtype=np.int64),
    )
    return parameters, state


def _no_laws(slots: int, sizes: Sizes) -> Laws:
    each = (slots, sizes.laws)
    return Laws(
        kind=np.full(each, -1),
        owner=np.zeros(each, dtype=np.int64),
        row=np.zeros((*each, sizes.coordinates)),
        to_base=np.zeros(each),
        values=np.zeros((*each, 2)),
        frame=np.zeros((*each, sizes.frames, 4)),
    )


def _load_laws(laws: Laws, slot: int, pantographs: Sequence[PlacedPantograph]) -> None:
    laws.kind[slot], laws.row[slot], n = -1, 0.0, 0
    for p, placed in enumerate(pantographs):
        for law in placed.body.laws:
            laws.kind[slot, n], laws.owner[slot, n] = law.kind, p
            laws.row[slot, n, : len(law.row)] = law.row
            laws.to_base[slot, n] = law.to_base
            laws.values[slot, n, : len(law.values)] = law.values
            if law.table:
                laws.frame[slot, n] = law.table[-1]  # what is beyond its own points is as at the last
                laws.frame[slot, n, : len(law.table)] = law.table
            n += 1


def make_records(
    slots: int, sizes: Sizes, counts: tuple[int, int, int, int], every: int, *, spatial: bool = False
) -> Records:
    """Room for histories.

    counts : numbers of droppers, of supports on all contact wires, of nodes of all wires, of gaps whose
        tension is followed
    every : steps between shapes of the wires, 0: none
    spatial : whether the wires' places across the track are recorded at the contacts
    """
    p, j, m, t = sizes.pantographs, sizes.contacts, sizes.coordinates, sizes.steps + 1
    droppers, supports, nodes, gaps = counts
    return Records(
        force=np.zeros((slots, j, t)),
        height=np.zeros((slots, j, t)),
        lateral=np.zeros((slots, j, t if spatial else 0)),
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


def load_pantographs(
    heads: PantographParameters,
    state: PantographState,
    records: Records,
    slot: int,
    scheme: Scheme,
    start: InitialState,
    steps: int,
) -> None:
    """Put the pantographs of a run at its start into a slot."""
    for array in (
        *state[:4],
        heads.K,
        heads.D,
        heads.inverse,
        heads.load,
        heads.base_load,
        heads.base_stiffness,
        heads.base_damping,
        heads.shape,
    ):
        array[slot] = 0.0
    heads.owner[slot] = -1
    _load_laws(heads.laws, slot, start.pantographs)
    heads.base.last.reshape(heads.follows.shape)[slot] = -1
    for p, placed in enumerate(start.pantographs):
        body, m = placed.body, placed.body.size
        state.q[slot, p, :m] = placed.heights
        heads.K[slot, p, :m, :m], heads.D[slot, p, :m, :m] = body.stiffness, body.damping
        matrix = body.mass + scheme.g * body.damping + scheme.b * body.stiffness
        heads.inverse[slot, p, :m, :m] = np.linalg.inv(matrix)
        heads.load[slot, p, :m] = placed.uplift * body.load
        heads.base_load[slot, p, :m] = body.base_load
        heads.base_stiffness[slot, p, :m] = body.base_stiffness
        heads.base_damping[slot, p, :m] = body.base_damping
        if placed.base:
            n, row = len(placed.base.values), slot * heads.follows.shape[1] + p
            heads.base.step[row], heads.base.last[row] = placed.base.step, n - 1
            heads.base.values[row, :n] = placed.base.values
        heads.follows[slot, p] = body.follows and heads.base_z.any()
        heads.place[slot, p] = placed.position
        records.masses[slot, p, :m, 0] = placed.heights
    for j, contact in enumerate(start.contacts):
        body = start.pantographs[contact.pantograph].body
        heads.owner[slot, j], heads.wire[slot, j] = contact.pantograph, contact.wire
        heads.start[slot, j] = contact.position
        heads.shape[slot, j, : body.size] = body.shape(contact.strip)[:, : heads.shape.shape[3]]
        law = body.contact
        heads.k[slot, j], heads.d[slot, j], heads.preload[slot, j] = law.stiffness, law.damping, law.preload
        heads.points[slot, j] = len(law.points)
        if law.points:
            heads.law[slot, j, : len(law.points)] = law.points
    count = len(start.contacts)
    records.force[slot, :count, 0] = start.contact_forces
    records.height[slot, :count, 0] = start.wire_heights
    heads.pace[slot] = start.speed
    heads.speed[slot, :], state.step[slot], heads.last[slot] = start.speed, 0, steps
    records.droppers[slot, :, 0] = start.dropper_force
    for found in (records.change, records.changed, records.shortening, records.shortened):
        found[slot] = 0


def read_history(
    records: Records,
    heads: PantographParameters,
    slot: int,
    start: InitialState,
    steps: int,
    step: float,
    system: System,
    computed: Computed | None = None,
) -> History:
    """What a slot's run recorded; its dropper forces are the records themselves.

    computed : in which steps each section was; unset: all in all steps
    """
    n, every, pantographs = steps + 1, records.every, start.pantographs
    time: Floats = np.arange(n, dtype=np.float64) * step
    owner = heads.owner[slot]
    at = np.array([placed.position for placed in pantographs])
    supports = np.concatenate([path.profile[path.supports, 0] for path in system.contact_paths])
    section = np.array([path.section for path in system.contact_paths])[heads.wire[slot]]
    stored = records.wire[slot, : steps // every + 1] if every else np.zeros((0, 0))
    droppers, uplifts = records.droppers[slot, :, :n], records.supports[slot, :, :n]
    if computed:
        at_supports = np.concatenate([path.index[path.supports, 0] for path in system.contact_paths])
        computed.hold(droppers, system.section[system.droppers.first], np.arange(n))
        computed.hold(uplifts, system.section[at_supports], np.arange(n))
        if every:
            computed.hold(stored.T, system.section[system.heights], np.arange(0, n, every))
    rest, nothing = system.reference[system.heights], np.array([])
    parts = [slice(wire.first, wire.first + wire.x.size) for wire in system.wires]
    of_each = [owner == p for p in range(len(pantographs))]
    found = [
        of_contacts(records.force[slot, mine, :n], records.height[slot, mine, :n], section[mine])
        for mine in of_each
    ]
    return History(
        time=time,
        position=at[:, None] + start.speed * time,
        contact_force=np.array([force for force, _, _ in found]),
        wire_height=np.array([height for _, height, _ in found]),
        mass_heights=[
            records.masses[slot, p, : len(placed.body.bodies), :n].copy()
            for p, placed in enumerate(pantographs)
        ],
        dropper_force=droppers,
        support_height=supports[:, None] + uplifts,
        wire_x=[wire.x for wire in system.wires],
        wire_z=[rest[part] + stored[:, part] for part in parts] if every else [],
        wire_times=time[::every] if every else None,
        energy=nothing,
        energy_times=nothing,
        driven_work=nothing,
        section_force=section_forces(found),
        contact_lateral=[_lateral(records, slot, mine, start, step, n, system) for mine in of_each],
    )


def _lateral(
    records: Records, slot: int, mine: Any, start: InitialState, step: float, n: int, system: System
) -> Floats:
    """[m], shape (contacts, n), of a pantograph's contacts to the left; no number where there is none.

    mine : shape (contacts of all,), whether they are the pantograph's
    """
    found = records.lateral[slot, mine, :n].copy()
    if not found.size:
        return found
    own = [contact for contact, its in zip(start.contacts, mine, strict=False) if its]
    for y, contact in zip(found, own, strict=True):
        path = system.contact_paths[contact.wire]
        here = path.rest_lateral(contact.position)
        there = path.rest_lateral(contact.position + start.speed * step)
        y[0] = here if n < 2 else y[1] + here - there  # the wire was not written down at the start itself
    return where_pressed(found, records.force[slot, mine, :n])
