"""A catenary's small motions about its static state, as sparse matrices of few coordinates.

What a wire does along the track matters through its tension only, which is even between two clamps up to
hundreds of hertz. So the coordinates along the track are kept at clamps and supports alone; between them the
wire is a spring whose tension is a coordinate of its own, and the matrices stay narrow:

    K_b q + G t = f      G_e the change of a gap's length with the coordinates q
    Gᵀ q − t / k = 0     t its tension, k its stiffness

Two terms of second order are kept beside the matrices, since a tension that changes by a per cent changes how
the wire moves by as much: inclinations lengthen a gap, and its change of tension works on inclined elements.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.dropper_matrices import dropper_motion, elongation, turning_stiffness
from catenary_fe.fe.linearise import first_coordinate, mass_blocks, stiffness_blocks
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.modal import link_stiffness, links, spring_values, transformation
from catenary_fe.fe.model import (
    Installation,
    Model,
    build_model,
    dropper_damping,
    element_pulls,
    point_masses,
)
from catenary_fe.fe.solver import release, solve_static
from catenary_fe.fe.wire import ALONG
from catenary_fe.system import Catenary

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

HELD = -1  # number of a coordinate that cannot move


@dataclass(frozen=True)
class ContactLine:
    """A contact wire as a pantograph meets it.

    x : [m], shape (nodes,), stations
    lengths : [m], shape (nodes - 1,), of the elements
    static : [m and 1], shape (nodes, 2), height and vertical slope at rest
    lateral : [m and 1], shape (nodes, 2), likewise to the left
    index : shape (nodes, 2), numbers of the coordinates of height and slope, or HELD
    supports : shape (spans + 1,), numbers of the height at the supports, or HELD
    """

    x: Floats
    lengths: Floats
    static: Floats
    lateral: Floats
    index: Integers
    supports: Integers


@dataclass(frozen=True)
class SwingingLinks:
    """Steady arms that are links: the wire on one swings on a circle, of which the matrices know the tangent.

    index : shape (links, 2), numbers of the coordinates to the left and up
    span : [m], shape (links, 2), likewise from the wire to the pivot, at rest
    length : [m], shape (links,), without force
    stiffness : [N/m], shape (links,)
    """

    index: Integers
    span: Floats
    length: Floats
    stiffness: Floats


@dataclass(frozen=True)
class Bows:
    """Elements seen along one axis across the track, of which each has one or two.

    index : shape (bows, 4), numbers of place and slope at the first node, then at the second, or HELD
    length : [m], shape (bows,)
    gap : shape (bows,), number of the element's gap in ``tensions``
    """

    index: Integers
    length: Floats
    gap: Integers


@dataclass(frozen=True)
class Gaps:
    """Lengths of wire between two clamps, over which the tension is even.

    wire : shape (gaps,), number of the wire in the mesh
    ends : [m], shape (gaps, 2), along the line
    tension : [N], shape (gaps,), nominal
    """

    wire: Integers
    ends: Floats
    tension: Floats


@dataclass(frozen=True)
class LinearModel:
    """M q̈ + D q̇ + K q = f with all droppers taut; coordinates in the order of their stations.

    mass, stiffness, damping : sparse, symmetric, shape (size, size)
    dropper_rows : sparse, shape (droppers, size), elongation of each dropper
    dropper_stiffness, dropper_damping : [N/m], [N s/m], shape (droppers,)
    dropper_tension : [N], shape (droppers,), at rest
    contacts : the contact wires
    heights : shape (nodes of all wires,), numbers of the coordinates up, or HELD
    tensions : shape (gaps,), numbers of the coordinates that are tensions [N]
    links : steady arms that swing
    bows : elements whose inclination lengthens a gap
    gaps : where these tensions are
    in_space : whether it has coordinates to the side
    """

    mass: Any
    stiffness: Any
    damping: Any
    dropper_rows: Any
    dropper_stiffness: Floats
    dropper_damping: Floats
    dropper_tension: Floats
    contacts: tuple[ContactLine, ...]
    heights: Integers
    tensions: Integers
    gaps: Gaps
    links: SwingingLinks
    bows: Bows
    in_space: bool

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return int(self.mass.shape[0])


def linear_model(catenary: Catenary, mesh: Mesh, installation: Installation) -> LinearModel:
    """The catenary's linearised model at static equilibrium.

    Raises SolverError if there is no equilibrium.
    """
    model = build_model(catenary, mesh, installation)
    mbs = model.mbs
    mbs.Assemble()
    solve_static(mbs, what="static state for the linearised run")
    pulls = element_pulls(catenary, mesh)
    wires = [_reduce(model, number, pull) for number, pull in enumerate(pulls)]
    whole = mbs.systemData.ODE2Size()
    gaps = sum(wire.gap_stiffness.size for wire in wires)
    M, K = _assemble(wires, whole)
    moved, span = dropper_motion(model, whole + gaps)
    tension = model.dropper_forces()
    rows = elongation(span) @ moved
    stiffness, damping = np.array([d.stiffness for d in catenary.droppers]), dropper_damping(catenary)
    D = catenary.damping.alpha * M + catenary.damping.beta * K
    D = D + rows.T @ _diagonal(damping) @ rows + _padded(spring_values(model, "damping"), gaps)
    K = K + rows.T @ _diagonal(stiffness) @ rows + moved.T @ turning_stiffness(span, tension) @ moved
    K = K + _padded(spring_values(model, "stiffness") + link_stiffness(model), gaps)
    masses, _ = point_masses(catenary, mesh, installation.dropper_lengths)
    M = M + _padded(_diagonal(np.outer(masses, np.repeat([1.0, 0.0], model.axes)).ravel()), gaps)
    T, place = _kept(model, wires, gaps)
    M, K, D = ((T.T @ matrix @ T).tocsr() for matrix in (M, K, D))
    width, up = model.node_width, model.axes - 1
    swinging = _swinging_links(model, place)
    contacts = contact_lines(model, place, mbs.systemData.GetODE2Coordinates())
    release(mbs)
    return LinearModel(
        mass=M,
        stiffness=K,
        damping=D,
        dropper_rows=(rows @ T).tocsr(),
        dropper_stiffness=stiffness,
        dropper_damping=damping,
        dropper_tension=tension,
        contacts=contacts,
        heights=place[width * np.arange(mesh.first_nodes[-1]) + up],
        tensions=place[whole:],
        gaps=_gaps(wires),
        links=swinging,
        bows=_bows(model, wires, place),
        in_space=model.axes == 3,
    )


def _gaps(wires: list[_ReducedWire]) -> Gaps:
    return Gaps(
        wire=np.repeat(np.arange(len(wires)), [wire.tension.size for wire in wires]),
        ends=np.concatenate([np.column_stack([wire.gap_x[:-1], wire.gap_x[1:]]) for wire in wires]),
        tension=np.concatenate([wire.tension for wire in wires]),
    )


def _bows(model: Model, wires: list[_ReducedWire], place: Integers) -> Bows:
    across = model.axes - 1
    index, length, gap, first = [], [], [], 0
    for wire, items in zip(wires, model.wires, strict=True):
        for axis in range(across):
            index.append(place[wire.across[:, axis::across]])
            length.append(items.line.lengths)
            gap.append(first + wire.gap_of)
        first += wire.gap_stiffness.size
    return Bows(np.concatenate(index), np.concatenate(length), np.concatenate(gap))


def _swinging_links(model: Model, place: Integers) -> SwingingLinks:
    found = links(model)
    first = np.array([link.first for link in found], dtype=np.int64)
    span = np.array([link.pivot - link.point for link in found]).reshape(len(found), model.axes)
    return SwingingLinks(
        index=place[first[:, None] + [model.axes - 2, model.axes - 1]],
        span=span[:, -2:],
        length=np.array([link.length for link in found], dtype=float),
        stiffness=np.array([link.stiffness for link in found], dtype=float),
    )


def contact_lines(model: Model, place: Integers, coordinates: Floats) -> tuple[ContactLine, ...]:
    """The contact wires with their coordinates at ``place``, at rest at these coordinates of the model."""
    lines = []
    shapes = model.wire_shapes(coordinates)
    axes, up = model.axes, model.axes - 1
    for items, wire, first, q in zip(
        model.contacts, model.mesh.wires, model.mesh.first_nodes, shapes, strict=False
    ):
        nodes = model.node_width * (first + np.arange(len(items.nodes)))
        index = place[nodes[:, None] + [up, up + axes]]
        lateral = q[:, [1, 1 + axes]] if axes == 3 else np.zeros((len(q), 2))
        lines.append(
            ContactLine(
                items.line.x, items.line.lengths, q[:, [up, up + axes]], lateral, index,
                index[wire.supports, 0],
            )
        )  # fmt: skip
    return tuple(lines)


@dataclass(frozen=True)
class _ReducedWire:
    """Elements of a wire without the coordinates along the track.

    across : shape (elements, m), numbers of their other coordinates
    stiffness, mass : shape (elements, m, m)
    lengthening : shape (elements, m), of an element with its other coordinates, its ends held along the track
    gap_of : shape (elements,)
    gap_ends : shape (gaps, 2), numbers of the coordinates along the track at the ends
    gap_stiffness, gap_mass : shape (gaps,)
    gap_x : [m], shape (gaps + 1,), stations of the gaps' ends
    tension : [N], shape (gaps,), nominal
    """

    across: Integers
    stiffness: Floats
    mass: Floats
    lengthening: Floats
    gap_of: Integers
    gap_ends: Integers
    gap_stiffness: Floats
    gap_mass: Floats
    gap_x: Floats
    tension: Floats


def _reduce(model: Model, number: int, pulls: Floats) -> _ReducedWire:
    """Condense slopes along the track in each element, and positions along the track between clamps."""
    mbs, wire, width = model.mbs, model.wires[number], model.node_width
    K, M = stiffness_blocks(mbs, wire), mass_blocks(wire)
    index = first_coordinate(mbs, wire) + width * np.arange(len(M))[:, None] + np.arange(2 * width)
    ends = np.array([ALONG, width + ALONG])
    slopes = ends + model.axes
    across = np.setdiff1d(np.arange(2 * width), [*ends, *slopes])
    kept = np.concatenate([ends, across])
    inner = np.linalg.solve(K[:, slopes[:, None], slopes], K[:, slopes[:, None], kept])
    K = K[:, kept[:, None], kept] - K[:, kept[:, None], slopes] @ inner
    k = (K[:, 0, 0] - K[:, 0, 1]) / 2
    lengthening = (K[:, 1, 2:] - K[:, 0, 2:]) / (2 * k[:, None])
    stiffness = K[:, 2:, 2:] - k[:, None, None] * lengthening[:, :, None] * lengthening[:, None, :]
    clamps = _clamps(model, number)
    gap_of = np.searchsorted(clamps, np.arange(len(wire.elements)), side="right") - 1
    element_mass = M[:, ends[:, None], ends].sum(axis=(1, 2))  # of a wire moved along the track
    first = index[0, 0] + width * clamps
    return _ReducedWire(
        across=index[:, across],
        stiffness=stiffness,
        mass=M[:, across[:, None], across],
        lengthening=lengthening,
        gap_of=gap_of,
        gap_ends=np.column_stack([first[:-1], first[1:]]),
        gap_stiffness=1 / np.bincount(gap_of, 1 / k),
        gap_mass=np.bincount(gap_of, element_mass).astype(float),
        gap_x=wire.line.x[clamps],
        tension=pulls[clamps[:-1]],
    )


def _clamps(model: Model, number: int) -> Integers:
    """Nodes of a wire that something is fixed to, its ends among them."""
    mesh = model.mesh
    fixed = [mesh.lower.node[mesh.lower.on(number)], mesh.upper.node[mesh.upper.on(number)]]
    fixed += [mesh.wires[number].supports, np.array([0, mesh.wires[number].x.size - 1])]
    if number == mesh.contact_wires:
        fixed.append(mesh.stitch_ends.ravel())
    return np.unique(np.concatenate(fixed))


def _assemble(wires: list[_ReducedWire], whole: int) -> tuple[Any, Any]:
    """Mass and stiffness of the wires over all coordinates and tensions."""
    from scipy.sparse import coo_matrix

    mass, stiffness = _Triplets(), _Triplets()
    first = whole
    for wire in wires:
        count = wire.gap_stiffness.size
        gaps = first + np.arange(count)
        first += count
        stiffness.add_blocks(wire.across, wire.stiffness)
        mass.add_blocks(wire.across, wire.mass)
        mass.add_blocks(wire.gap_ends, wire.gap_mass[:, None, None] * np.array([[2.0, 1.0], [1.0, 2.0]]) / 6)
        rows = np.repeat(gaps[wire.gap_of], wire.across.shape[1])
        stiffness.add_pairs(rows, wire.across.ravel(), wire.lengthening.ravel())
        stiffness.add_pairs(gaps, wire.gap_ends[:, 0], np.full(count, -1.0))
        stiffness.add_pairs(gaps, wire.gap_ends[:, 1], np.full(count, 1.0))
        stiffness.add(gaps, gaps, -1 / wire.gap_stiffness)
    shape = (first, first)
    return coo_matrix(mass.triplets(), shape=shape).tocsr(), coo_matrix(
        stiffness.triplets(), shape=shape
    ).tocsr()


class _Triplets:
    """Rows, columns and values of a sparse matrix that grows."""

    def __init__(self) -> None:
        self._parts: list[tuple[Integers, Integers, Floats]] = []

    def add(self, rows: Integers, columns: Integers, values: Floats) -> None:
        self._parts.append((rows, columns, values))

    def add_pairs(self, rows: Integers, columns: Integers, values: Floats) -> None:
        self.add(rows, columns, values)
        self.add(columns, rows, values)

    def add_blocks(self, index: Integers, blocks: Floats) -> None:
        m = index.shape[1]
        self.add(np.repeat(index, m, axis=1).ravel(), np.tile(index, (1, m)).ravel(), blocks.ravel())

    def triplets(self) -> tuple[Floats, tuple[Integers, Integers]]:
        rows, columns, values = (np.concatenate(part) for part in zip(*self._parts, strict=True))
        return values, (rows, columns)


def _kept(model: Model, wires: list[_ReducedWire], gaps: int) -> tuple[Any, Integers]:
    """T with q = T x, x the coordinates that are kept, by station; and the place of each q in x, or HELD.

    A gap's tension comes just before the gap's end.
    """
    from scipy.sparse import block_diag, identity

    T = block_diag([transformation(model), identity(gaps)]).tocsc()
    whole = T.shape[0] - gaps
    station = np.full(T.shape[0], np.nan)
    for wire, items, first in zip(wires, model.wires, model.mesh.first_nodes, strict=False):
        nodes = model.node_width * (first + np.arange(items.line.x.size))
        across = np.setdiff1d(np.arange(model.node_width), [ALONG, ALONG + model.axes])
        station[(nodes[:, None] + across).ravel()] = np.repeat(items.line.x, across.size)
        station[wire.gap_ends[:, 1]] = wire.gap_x[1:]
        station[wire.gap_ends[0, 0]] = wire.gap_x[0]
    station[whole:] = np.concatenate([wire.gap_x[1:] for wire in wires])
    rows, columns = T.nonzero()
    of_free = np.full(T.shape[1], np.nan)
    of_free[columns] = station[rows]
    is_tension = np.arange(T.shape[1]) >= T.shape[1] - gaps
    order = np.lexsort((~is_tension, of_free))[: int(np.isfinite(of_free).sum())]
    new = np.full(T.shape[1], HELD, dtype=np.int64)
    new[order] = np.arange(order.size)
    place = np.full(T.shape[0], HELD, dtype=np.int64)
    place[rows] = new[columns]
    return T[:, order].tocsr(), place


def _diagonal(values: Floats) -> Any:
    from scipy.sparse import diags

    return diags(values).tocsr()


def _padded(matrix: Any, extra: int) -> Any:
    from scipy.sparse import block_diag, csr_matrix

    return block_diag([matrix, csr_matrix((extra, extra))]).tocsr()
