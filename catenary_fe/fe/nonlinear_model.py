"""A catenary's equations of motion as arrays, for large motions: what a compiled run integrates.

    M q̈ + D q̇ + f_cables(q) + f_droppers(q, q̇) + f_links(q) + K_springs q = f

Parameters, matrices and states are those of the Exudyn model; q are displacements from the lines on which the
wires were installed. Coordinates that are held or follow another one are left out of M and D.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import Cables, tangent_blocks
from catenary_fe.fe.contact import MovingContact
from catenary_fe.fe.drive import raise_heads
from catenary_fe.fe.dropper_matrices import taut_droppers
from catenary_fe.fe.energy import constant_forces
from catenary_fe.fe.installation import Installation, dropper_damping, point_masses
from catenary_fe.fe.linear_model import HELD, ContactLine, contact_lines
from catenary_fe.fe.linearise import mass_matrix, stiffness_matrix
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.modal import link_blocks, links, spring_values, transformation
from catenary_fe.fe.model import Model, build_model
from catenary_fe.fe.pantograph import PantographItems, add_pantographs
from catenary_fe.fe.solver import release, solve_static
from catenary_fe.system import AnyPantograph, Catenary

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Springs:
    """Springs between points: droppers, which only pull, and links to the ground.

    first : shape (springs,), number of the first coordinate of the point at the lower end
    last : shape (springs,), likewise of the other end; of links: nothing
    pivot : [m], shape (springs, axes), of links: the fixed end
    length : [m], shape (springs,), without force
    stiffness, damping : [N/m], [N s/m], shape (springs,)
    """

    first: Integers
    last: Integers
    pivot: Floats
    length: Floats
    stiffness: Floats
    damping: Floats


@dataclass(frozen=True)
class NonlinearModel:
    """Equations of motion of a catenary; "all" coordinates are those of the wires' nodes.

    reference : shape (all coordinates,), positions and slopes from which displacements count
    start : shape (all coordinates,), displacements in static equilibrium
    place : shape (all coordinates,), number of the free coordinate, or HELD
    mass, damping : sparse, over the free coordinates; droppers' damping is not in it
    tangent_damping : sparse, damping at static equilibrium, all droppers taut
    ground_stiffness : [N/m], shape (free coordinates,), of vertical and lateral springs to the ground
    force : [N], shape (free coordinates,), weight, tensions and preloads
    first : shape (elements,), number of each cable element's first coordinate among all; those of its two
        nodes follow one another
    contacts : the contact wires, their ``static`` and ``lateral`` those of the reference
    """

    axes: int
    reference: Floats
    start: Floats
    place: Integers
    mass: Any
    damping: Any
    tangent_damping: Any
    ground_stiffness: Floats
    force: Floats
    first: Integers
    cables: Cables
    droppers: Springs
    links: Springs
    contacts: tuple[ContactLine, ...]

    @property
    def size(self) -> int:
        """Number of free coordinates."""
        return int(self.mass.shape[0])

    @property
    def in_space(self) -> bool:
        """Whether it has coordinates to the side."""
        return self.axes == 3

    def tangent_at(self, moved: Floats) -> Any:
        """Stiffness over the free coordinates, all droppers taut; sparse.

        moved : shape (all coordinates,), displacements
        """
        from scipy.sparse import coo_matrix

        total, m = self.reference + moved, 4 * self.axes
        index = self.first[:, None] + np.arange(m)
        parts = [(index, tangent_blocks(self.cables, total[index].reshape(-1, 4, self.axes)))]
        axes = np.arange(self.axes)
        for springs, two_ends in ((self.droppers, True), (self.links, False)):
            lower = springs.first[:, None] + axes
            upper = springs.last[:, None] + axes
            span = (total[upper] if two_ends else springs.pivot) - total[lower]
            block = link_blocks(span, springs.length, springs.stiffness, pulls_only=two_ends)
            if two_ends:
                lower = np.hstack([lower, upper])
                block = np.block([[block, -block], [-block, block]])
            parts.append((lower, block))
        rows = np.concatenate([np.repeat(i, i.shape[1], axis=1).ravel() for i, _ in parts])
        columns = np.concatenate([np.tile(i, (1, i.shape[1])).ravel() for i, _ in parts])
        values = np.concatenate([block.ravel() for _, block in parts])
        rows, columns = self.place[rows], self.place[columns]
        moves = (rows >= 0) & (columns >= 0)
        shape = (self.size, self.size)
        K = coo_matrix((values[moves], (rows[moves], columns[moves])), shape=shape).tocsr()
        return K + _diagonal(self.ground_stiffness)


@dataclass(frozen=True)
class ContactStart:
    """Static contact at the start of a run.

    wires : shape (all coordinates,), displacements
    heads : for each pantograph shape (coordinates,): heights of its masses, then rolls of its strips
    forces : [N], for each pantograph shape (contacts,)
    """

    wires: Floats
    heads: list[Floats]
    forces: list[Floats]


def nonlinear_model(catenary: Catenary, mesh: Mesh, installation: Installation) -> NonlinearModel:
    """Equations of motion of a catenary.

    Raises SolverError if there is no static equilibrium.
    """
    model = build_model(catenary, mesh, installation)
    mbs = model.mbs
    mbs.Assemble()
    wire_mass, wire_stiffness = mass_matrix(mbs, model.wires), stiffness_matrix(mbs, model.wires)
    solve_static(mbs, what="static state")
    rayleigh = catenary.damping.alpha * wire_mass + catenary.damping.beta * wire_stiffness
    damping = rayleigh + spring_values(model, "damping")
    _, taut_damping = taut_droppers(model)
    springs = spring_values(model, "stiffness")
    masses, _ = point_masses(catenary, mesh, installation.dropper_lengths)
    M = wire_mass + _diagonal(np.outer(masses, np.repeat([1.0, 0.0], model.axes)).ravel())
    T, place = _by_station(model)
    q = mbs.systemData.GetODE2Coordinates()
    found = NonlinearModel(
        axes=model.axes,
        reference=np.concatenate([wire.line.coordinates().ravel() for wire in model.wires]),
        start=q,
        place=place,
        mass=(T.T @ M @ T).tocsr(),
        damping=(T.T @ damping @ T).tocsr(),
        tangent_damping=(T.T @ (damping + taut_damping) @ T).tocsr(),
        ground_stiffness=(T.T @ springs @ T).diagonal(),
        force=T.T @ constant_forces(mbs, [model.overlay]),
        first=_first(model),
        cables=_cables(model),
        droppers=_droppers(model),
        links=_links(model),
        contacts=contact_lines(model, place, 0 * q),
    )
    release(mbs)
    return found


def contact_start(
    catenary: Catenary,
    mesh: Mesh,
    installation: Installation,
    pantographs: Sequence[tuple[AnyPantograph, float]],
    positions: Floats,
) -> ContactStart:
    """Static contact of pantographs, each with its uplift [N], at positions [m] along the track.

    Raises SolverError if there is no equilibrium.
    """
    model = build_model(catenary, mesh, installation)
    items = add_pantographs(model, pantographs)
    contact = MovingContact(model, items)
    mbs = model.mbs
    mbs.Assemble()
    contact.move_to(positions, 0.0)
    raise_heads(model, items)
    solve_static(mbs, what="static contact at the start")
    contact.settle_laws(lambda: solve_static(mbs, what="static contact at the start"))
    q = mbs.systemData.GetODE2Coordinates()
    size = model.node_width * int(mesh.first_nodes[-1])
    found = ContactStart(
        wires=q[:size],
        heads=[_head_coordinates(model, item, q) for item in items],
        forces=[contact.forces(item) for item in items],
    )
    release(mbs)
    return found


def _head_coordinates(model: Model, item: PantographItems, q: Floats) -> Floats:
    number = [model.mbs.systemData.GetNodeLTGODE2(node)[k] for node, k in (*item.heights, *item.rolls)]
    return q[np.array(number, dtype=np.int64)]


def _by_station(model: Model) -> tuple[Any, Integers]:
    """T with q = T x, x the free coordinates by station, and the place of each q in x, or HELD."""
    T = transformation(model)
    station = np.concatenate([np.repeat(wire.line.x, model.node_width) for wire in model.wires])
    rows, columns = T.nonzero()
    of_free = np.zeros(T.shape[1])
    of_free[columns] = station[rows]
    order = np.argsort(of_free, kind="stable")
    new = np.empty_like(order)
    new[order] = np.arange(order.size)
    place = np.full(T.shape[0], HELD, dtype=np.int64)
    place[rows] = new[columns]
    return T[:, order].tocsr(), place


def _first(model: Model) -> Integers:
    first = [
        model.node_width * (number + np.arange(len(wire.elements)))
        for number, wire in zip(model.mesh.first_nodes, model.wires, strict=False)
    ]
    return np.concatenate(first).astype(np.int64)


def _cables(model: Model) -> Cables:
    counts = [len(wire.elements) for wire in model.wires]
    kinds = [wire.kind for wire in model.wires]
    return Cables(
        length=np.concatenate([wire.line.lengths for wire in model.wires]),
        axial_stiffness=np.repeat([float(k.axial_stiffness) for k in kinds], counts),
        bending_stiffness=np.repeat([float(k.bending_stiffness) for k in kinds], counts),
        rest_strain=np.repeat([-k.tension / k.axial_stiffness for k in kinds], counts),
    )


def _droppers(model: Model) -> Springs:
    mesh, width = model.mesh, model.node_width
    return Springs(
        first=width * mesh.nodes(mesh.lower).astype(np.int64),
        last=width * mesh.nodes(mesh.upper).astype(np.int64),
        pivot=np.zeros((len(model.droppers), model.axes)),
        length=np.asarray(model.dropper_lengths, dtype=float),
        stiffness=np.array([d.stiffness for d in model.catenary.droppers], dtype=float),
        damping=np.array(dropper_damping(model.catenary), dtype=float),
    )


def _links(model: Model) -> Springs:
    found = links(model)
    return Springs(
        first=np.array([link.first for link in found], dtype=np.int64),
        last=np.full(len(found), HELD, dtype=np.int64),
        pivot=np.array([link.pivot for link in found], dtype=float).reshape(-1, model.axes),
        length=np.array([link.length for link in found], dtype=float),
        stiffness=np.array([link.stiffness for link in found], dtype=float),
        damping=np.zeros(len(found)),
    )


def _diagonal(values: Floats) -> Any:
    from scipy.sparse import diags

    return diags(values).tocsr()
