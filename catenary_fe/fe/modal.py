"""Eigenfrequencies and shapes of a model about its static state, sparse: as many spans as one likes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.dropper_matrices import taut_droppers
from catenary_fe.fe.linearise import mass_matrix, stiffness_matrix
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.model import Installation, Model, build_model, point_masses
from catenary_fe.fe.solver import release, solve_static
from catenary_fe.system import Catenary, InputError, SolverError, counted

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

# above this share of all modes, and up to this size, a dense solver is quicker than Lanczos iterations
_DENSE_SHARE, _DENSE_LARGEST = 0.15, 5000
_LANCZOS_SHARE = 1 / 3  # of all modes: the highest mean nothing, and would take for ever


@dataclass(frozen=True)
class LinearSystem:
    """Small motions about the static state: M ẍ + D ẋ + K x = 0, droppers taut; q = T x.

    mass, stiffness, damping : sparse, over the free coordinates x
    transformation : T, sparse, from the free to all coordinates: those that are held stay 0, those of clamps
        that sit on another wire follow it
    node_width : coordinates of a node
    """

    mass: Any
    stiffness: Any
    damping: Any
    transformation: Any
    node_width: int

    @property
    def size(self) -> int:
        """Number of free coordinates."""
        return int(self.mass.shape[0])


@dataclass(frozen=True)
class EigenPairs:
    """Eigenpairs in rising order, the shapes mass-normalised.

    frequencies : [Hz], shape (modes,)
    shapes : [1/√kg], for each wire shape (modes, nodes, 2 * axes): positions and slopes of the nodes
    along, sideways : shape (modes,), shares of the kinetic energy that move along the track and to its sides
    damping_ratios : shape (modes,), of critical damping, from the diagonal of the modal damping matrix
    """

    frequencies: Floats
    shapes: list[Floats]
    along: Floats
    sideways: Floats
    damping_ratios: Floats


def linear_system(catenary: Catenary, mesh: Mesh, installation: Installation) -> LinearSystem:
    """Mass and stiffness matrix of a catenary in static equilibrium.

    Raises SolverError if there is no equilibrium, InputError where a dropper is slack in it.
    """
    model = build_model(catenary, mesh, installation)
    mbs = model.mbs
    mbs.Assemble()
    solve_static(mbs, what="static state for modal analysis")
    masses, _ = point_masses(catenary, mesh, installation.dropper_lengths)
    M, K = mass_matrix(mbs, model.wires), stiffness_matrix(mbs, model.wires)
    _check_taut(model)
    droppers, dropper_damping = taut_droppers(model)
    D = catenary.damping.alpha * M + catenary.damping.beta * K
    D = D + dropper_damping + spring_values(model, "damping")
    moves = np.repeat([1.0, 0.0], model.axes)
    M = M + _diagonal(np.outer(masses, moves).ravel())
    K = K + droppers + spring_values(model, "stiffness") + link_stiffness(model)
    T = transformation(model)
    M, K, D = (T.T @ matrix @ T for matrix in (M, K, D))
    release(mbs)
    return LinearSystem(M, K, D, T, model.node_width)


def _check_taut(model: Model) -> None:
    tension = model.dropper_forces()
    if (tension <= 0).any():
        raise InputError(
            f"dropper {int(np.argmin(tension)) + 1} of the line is slack at rest: modal analysis takes all"
            " droppers as taut; change its length, or the form"
        )


def solve_eigen(system: LinearSystem, nodes: Sequence[int], count: int) -> EigenPairs:
    """The lowest ``count`` eigenpairs; ``nodes`` on each wire.

    Raises SolverError if the iteration fails or the static state is not stable.
    """
    squares, vectors = _lowest(system, min(count, system.size - 1))
    if squares[0] <= 0:
        raise SolverError(f"modal analysis: ω² = {squares[0]:g} 1/s² is not positive: the state is unstable")
    count, width = squares.size, system.node_width
    weighted = system.mass @ vectors
    filled = system.transformation @ vectors
    ends = width * np.cumsum([0, *nodes])
    shapes = [filled[a:b].T.reshape(count, -1, width) for a, b in pairwise(ends)]
    axes = width // 2
    along, *sideways, _ = (
        (vectors * weighted)[system.transformation.T @ (np.arange(len(filled)) % axes == axis) > 0].sum(
            axis=0
        )
        for axis in range(axes)
    )
    omega = np.sqrt(squares)
    damping = np.einsum("ij,ij->j", vectors, system.damping @ vectors) / (2 * omega)
    aside = sideways[0] if sideways else np.zeros(count)
    return EigenPairs(omega / (2 * np.pi), shapes, along, aside, damping)


def _lowest(system: LinearSystem, count: int) -> tuple[Floats, Floats]:
    """ω² [1/s²] in rising order and mass-normalised vectors, by the method that is the quicker one."""
    from scipy.linalg import eigh
    from scipy.sparse.linalg import ArpackError, eigsh

    dimension = system.size
    if dimension >= _DENSE_LARGEST and count > _LANCZOS_SHARE * dimension:
        raise InputError(
            f"modes: {counted(count, 'mode')} of a mesh with {dimension} coordinates: at most a third of them"
            " can be found; ask for less"
        )
    if count > _DENSE_SHARE * dimension and dimension < _DENSE_LARGEST:
        whole = system.stiffness.toarray(), system.mass.toarray()
        squares, vectors = eigh(*whole, subset_by_index=[0, count - 1])
        return squares, vectors
    try:
        squares, vectors = eigsh(
            system.stiffness.tocsc(),
            k=count,
            M=system.mass.tocsc(),
            sigma=0.0,
            v0=np.ones(dimension),  # the same answer every time
        )
    except (ArpackError, RuntimeError) as error:
        raise SolverError(f"modal analysis: no eigenpairs found ({error}); look for a loose part") from None
    order = np.argsort(squares)
    return squares[order], vectors[:, order]


def _diagonal(values: Floats) -> Any:
    from scipy.sparse import diags

    return diags(values).tocsr()


def transformation(model: Model) -> Any:
    """Sparse, shape (coordinates, free ones): held coordinates stay 0, clamped ones follow the other wire."""
    from scipy.sparse import csr_matrix

    mbs, size = model.mbs, model.mbs.systemData.ODE2Size()
    leader = np.arange(size)
    held = np.zeros(size, dtype=bool)
    for item in _objects(model, "ConnectorCoordinate"):
        first, second = item["markerNumbers"]
        if int(first) == model.ground:
            held[_coordinate(mbs, second)] = True
        else:
            leader[_coordinate(mbs, second)] = _coordinate(mbs, first)
    leads = (leader == np.arange(size)) & ~held
    column = np.cumsum(leads) - 1
    rows = np.flatnonzero(~held[leader] & ~held)
    entries = np.ones(rows.size), (rows, column[leader[rows]])
    return csr_matrix(entries, shape=(size, int(leads.sum())))


def _coordinate(mbs: exu.MainSystem, marker: int) -> int:
    item = mbs.GetMarker(marker)
    return int(mbs.systemData.GetNodeLTGODE2(item["nodeNumber"])[item["coordinate"]])


def _objects(model: Model, kind: str) -> list[dict[str, Any]]:
    mbs = model.mbs
    elements = {e for wire in model.wires for e in wire.elements}  # many, and slow to look at
    numbers = [i for i in range(mbs.systemData.NumberOfObjects()) if i not in elements]
    items = [mbs.GetObject(i) for i in numbers]
    return [item for item in items if item["objectType"] == kind]


def spring_values(model: Model, what: str) -> Any:
    """Stiffness or damping of steady arms and supports: vertical springs to the ground."""
    diagonal = np.zeros(model.mbs.systemData.ODE2Size())
    for item in _objects(model, "ConnectorCoordinateSpringDamper"):
        diagonal[_coordinate(model.mbs, item["markerNumbers"][1])] += item[what]
    return _diagonal(diagonal)


@dataclass(frozen=True)
class Link:
    """A steady arm that is a link: a stiff spring from a wire's node to a fixed pivot.

    first : number of the node's first coordinate
    point, pivot : [m], shape (axes,), the node now, and the other end
    length : [m], without force
    stiffness : [N/m]
    """

    first: int
    point: Floats
    pivot: Floats
    length: float
    stiffness: float


def links(model: Model) -> list[Link]:
    """Steady arms that are links to the ground."""
    mbs, position = model.mbs, exu.OutputVariableType.Position
    found = []
    for item in _objects(model, "ConnectorSpringDamper"):
        if item["springForceUserFunction"]:
            continue
        node = mbs.GetMarker(item["markerNumbers"][0])["nodeNumber"]
        point, pivot = (
            np.array(mbs.GetMarkerOutput(m, position))[: model.axes] for m in item["markerNumbers"]
        )
        first = int(mbs.systemData.GetNodeLTGODE2(node)[0])
        found.append(Link(first, point, pivot, item["referenceLength"], item["stiffness"]))
    return found


def link_stiffness(model: Model) -> Any:
    """Stiffness matrix of :func:`links`."""
    from scipy.sparse import coo_matrix

    size = model.mbs.systemData.ODE2Size()
    matrix = coo_matrix((size, size)).tocsr()
    for link in links(model):
        span = link.pivot - link.point
        block = link_blocks(span[None], np.array([link.length]), np.array([link.stiffness]))
        index = link.first + np.arange(span.size)
        place = np.repeat(index, index.size), np.tile(index, index.size)
        matrix = matrix + coo_matrix((block.ravel(), place), shape=(size, size)).tocsr()
    return matrix


def link_blocks(span: Floats, length: Floats, stiffness: Floats, *, pulls_only: bool = False) -> Floats:
    """Stiffness [N/m] of springs at one end, shape (springs, axes, axes).

    span : [m], shape (springs, axes), from end to end
    length, stiffness : [m] without force, [N/m], shape (springs,)
    pulls_only : springs that would push count as just taut
    """
    now = np.linalg.norm(span, axis=1)
    direction = span / now[:, None]
    axial = direction[:, :, None] * direction[:, None, :]
    tension = stiffness * (now - length)
    tension = np.maximum(tension, 0.0) if pulls_only else tension
    across = (tension / now)[:, None, None] * (np.eye(span.shape[1]) - axial)
    blocks: Floats = stiffness[:, None, None] * axial + across
    return blocks
