"""Eigenfrequencies and shapes of a model about its static state, sparse: as many spans as one likes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.linearise import mass_matrix, stiffness_matrix
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.model import Installation, Model, build_model, dropper_damping, point_masses
from catenary_fe.fe.solver import solve_static
from catenary_fe.fe.wire import COORDINATES, UP
from catenary_fe.system import Catenary, InputError, SolverError

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

# above this share of all modes, and up to this size, a dense solver is quicker than Lanczos iterations
_DENSE_SHARE, _DENSE_LARGEST = 0.15, 5000
_LANCZOS_SHARE = 1 / 3  # of all modes: the highest mean nothing, and would take for ever


@dataclass(frozen=True)
class LinearSystem:
    """Small motions about the static state: M q̈ + D q̇ + K q = 0, droppers taut.

    mass, stiffness, damping : sparse, over the coordinates ``free`` of ``size``
    """

    mass: Any
    stiffness: Any
    damping: Any
    free: Integers
    size: int

    def whole(self, vectors: Floats) -> Floats:
        """Shape (size, vectors): columns over all coordinates, 0 where they are held."""
        filled = np.zeros((self.size, vectors.shape[1]))
        filled[self.free] = vectors
        return filled


@dataclass(frozen=True)
class EigenPairs:
    """Eigenpairs in rising order, the shapes mass-normalised.

    frequencies : [Hz], shape (modes,)
    contact, messenger : [1/√kg], shape (modes, nodes, 4): position and slope of the nodes, along and up
    along : shape (modes,), share of the kinetic energy that moves along the track
    damping_ratios : shape (modes,), of critical damping, from the diagonal of the modal damping matrix
    """

    frequencies: Floats
    contact: Floats
    messenger: Floats
    along: Floats
    damping_ratios: Floats


def linear_system(catenary: Catenary, mesh: Mesh, installation: Installation) -> LinearSystem:
    """Mass and stiffness matrix of a catenary in static equilibrium.

    Raises SolverError if there is no equilibrium, InputError where a dropper is slack in it.
    """
    model = build_model(catenary, mesh, installation)
    mbs = model.mbs
    mbs.Assemble()
    solve_static(mbs, what="static state for modal analysis")
    wires = [*model.contact.elements, *model.messenger.elements]
    masses = point_masses(catenary, mesh, installation.dropper_lengths)
    M, K = mass_matrix(mbs, wires), stiffness_matrix(mbs, wires)
    droppers = np.array([d.stiffness for d in catenary.droppers])
    D = catenary.damping.alpha * M + catenary.damping.beta * K
    D = D + _droppers(model, dropper_damping(catenary), pulled=False) + _springs(model, "damping")
    M = M + _diagonal(np.outer(masses, [1.0, 1.0, 0.0, 0.0]).ravel())
    K = K + _droppers(model, droppers) + _springs(model, "stiffness")
    size = mbs.systemData.ODE2Size()
    free = np.setdiff1d(np.arange(size), _held(model))
    M, K, D = (matrix[free][:, free] for matrix in (M, K, D))
    return LinearSystem(M, K, D, free, size)


def solve_eigen(system: LinearSystem, nodes: tuple[int, int], count: int) -> EigenPairs:
    """The lowest ``count`` eigenpairs; ``nodes`` on contact and messenger wire.

    Raises SolverError if the iteration fails or the static state is not stable.
    """
    squares, vectors = _lowest(system, min(count, system.free.size - 1))
    if squares[0] <= 0:
        raise SolverError(f"modal analysis: ω² = {squares[0]:g} 1/s² is not positive: the state is unstable")
    count = squares.size
    weighted = system.whole(system.mass @ vectors)
    filled = system.whole(vectors)
    is_along = np.arange(system.size) % 2 == 0
    along = (filled * weighted)[is_along].sum(axis=0)
    ends = COORDINATES * nodes[0], COORDINATES * (nodes[0] + nodes[1])
    contact, messenger = (
        part.T.reshape(count, -1, COORDINATES) for part in (filled[: ends[0]], filled[ends[0] : ends[1]])
    )
    omega = np.sqrt(squares)
    damping = np.einsum("ij,ij->j", vectors, system.damping @ vectors) / (2 * omega)
    return EigenPairs(omega / (2 * np.pi), contact, messenger, along, damping)


def _lowest(system: LinearSystem, count: int) -> tuple[Floats, Floats]:
    """ω² [1/s²] in rising order and mass-normalised vectors, by the method that is the quicker one."""
    from scipy.linalg import eigh
    from scipy.sparse.linalg import ArpackError, eigsh

    dimension = system.free.size
    if dimension >= _DENSE_LARGEST and count > _LANCZOS_SHARE * dimension:
        raise InputError(
            f"modes: {count} modes of a mesh with {dimension} coordinates: at most a third of them can be"
            " found; ask for less"
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


def _held(model: Model) -> Integers:
    """Numbers of the coordinates that constraints hold."""
    mbs = model.mbs
    constraints = _objects(model, "ConnectorCoordinate")
    return np.array([_coordinate(mbs, item["markerNumbers"][1]) for item in constraints], dtype=np.int64)


def _coordinate(mbs: exu.MainSystem, marker: int) -> int:
    item = mbs.GetMarker(marker)
    return int(mbs.systemData.GetNodeLTGODE2(item["nodeNumber"])[item["coordinate"]])


def _objects(model: Model, kind: str) -> list[dict[str, Any]]:
    mbs = model.mbs
    items = [mbs.GetObject(i) for i in range(mbs.systemData.NumberOfObjects())]
    return [item for item in items if item["objectType"] == kind]


def _springs(model: Model, what: str) -> Any:
    """Stiffness or damping of steady arms and supports: vertical springs to the ground."""
    diagonal = np.zeros(model.mbs.systemData.ODE2Size())
    for item in _objects(model, "ConnectorCoordinateSpringDamper"):
        diagonal[_coordinate(model.mbs, item["markerNumbers"][1])] += item[what]
    return _diagonal(diagonal)


def _droppers(model: Model, along: Floats, *, pulled: bool = True) -> Any:
    """Matrix of the taut droppers: ``along`` [N/m or N s/m] along them, tension over length across if pulled.

    In closed form, because Exudyn has no Jacobian for a connector with a force law of its own.
    """
    from scipy.sparse import coo_matrix

    size, count = model.mbs.systemData.ODE2Size(), len(model.droppers)
    if not count:
        return coo_matrix((size, size)).tocsr()
    contact, messenger = model.wire_shapes(model.mbs.systemData.GetODE2Coordinates())
    lower, upper = model.mesh.contact.droppers, model.mesh.messenger.droppers
    span = messenger[upper, :2] - contact[lower, :2]
    length = np.hypot(*span.T)
    tension = model.dropper_forces()
    if (tension <= 0).any():
        raise InputError(
            f"dropper {int(np.argmin(tension)) + 1} of the line is slack at rest: modal analysis takes all"
            " droppers as taut; change its length, or the form"
        )
    axis = span / length[:, None]
    axial = axis[:, :, None] * axis[:, None, :]
    across = (tension / length)[:, None, None] * (np.eye(2) - axial)
    block = along[:, None, None] * axial + (across if pulled else 0.0)
    blocks = np.block([[block, -block], [-block, block]])
    offset = COORDINATES * len(model.contact.nodes)
    index = np.hstack(
        [COORDINATES * lower[:, None] + [0, UP], offset + COORDINATES * upper[:, None] + [0, UP]]
    )
    rows, columns = np.repeat(index, 4, axis=1), np.tile(index, (1, 4))
    return coo_matrix((blocks.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsr()
