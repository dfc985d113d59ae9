"""Eigenfrequencies and shapes of a model about its static state, sparse: as many spans as one likes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.installation import Installation
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.system import System, assemble
from catenary_fe.layout import Catenary, InputError, SolverError, counted

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

    Raises InputError where a dropper is slack in it.
    """
    system = assemble(catenary, mesh, installation)
    _check_taut(catenary, system)
    damping = system.free(system.damping() + system.taut_damping())
    stiffness = system.tangent(np.zeros(system.place.size))
    return LinearSystem(system.free(system.mass), stiffness, damping, system.transformation, 2 * system.axes)


def _check_taut(catenary: Catenary, system: System) -> None:
    slack = np.flatnonzero(system.droppers.tension(system.droppers.span(system.reference)) <= 0)
    if slack.size:
        dropper, span = catenary.droppers[slack[0]], catenary.dropper_spans[slack[0]]
        raise InputError(
            f"span {span}: the dropper at {dropper.position:g} m is slack at rest ({slack.size} of"
            f" {len(catenary.droppers)} are): modal analysis takes all droppers as taut; change its"
            " length, or the form"
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
