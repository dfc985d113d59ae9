"""Modal analysis: eigenfrequencies and shapes of a line about its static state."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.installation import wire_kinds
from catenary_fe.fe.system import System
from catenary_fe.layout import InputError, SolverError, counted
from catenary_fe.layout.arguments import checked, number, whole
from catenary_fe.results.modes import Modes, WireShapes
from catenary_fe.statics import LineShape, Shape

Floats = NDArray[np.float64]
# above this share of all modes, and up to this size, a dense solver is quicker than Lanczos iterations
_DENSE_SHARE, _DENSE_LARGEST = 0.15, 5000
_LANCZOS_SHARE = 1 / 3  # of all modes: the highest mean nothing, and would take for ever
_HIGHEST = 1e4  # [Hz] no mesh of a line resolves more
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class EigenPairs:
    """Eigenpairs in rising order, the shapes mass-normalised.

    frequencies : [Hz], shape (modes,)
    shapes : [1/√kg], for each wire shape (modes, nodes, 2 * axes): positions and slopes of the nodes
    longitudinal, lateral : shape (modes,), shares of the kinetic energy along and across the track
    damping_ratios : shape (modes,), of critical damping, from the diagonal of the modal damping matrix
    """

    frequencies: Floats
    shapes: list[Floats]
    longitudinal: Floats
    lateral: Floats
    damping_ratios: Floats


@checked
def solve_modes(shape: Shape, *, count: int | None = None, below: float | None = None) -> Modes:
    """Eigenfrequencies and shapes about the static state, droppers taut; sparse, so that long lines work.

    shape : the catenary in static equilibrium, with its mesh
    count : how many modes, from the lowest, as far as the mesh holds them; unset, and with no ``below``: 40
    below : [Hz] all modes up to this frequency (with ``count``: at most so many)

    Raises InputError for a count or frequency that is not positive, more than a third of all modes of a long
    line, or a dropper that is slack at rest; SolverError where the eigenvalue iteration fails.
    """
    if count is not None:
        whole("modes: count", count, least=1)
    if below is not None:
        number("modes: below", below, "Hz", above=0.0, most=_HIGHEST)
    if isinstance(shape, LineShape):
        raise InputError(
            f"modes: {shape.catenary.name} has {len(shape.sections)} tension sections, which do not move each"
            " other; take the modes of one, of line.sections"
        )
    _check_taut(shape)
    system = shape.system
    wanted = count or (40 if below is None else _expected(shape, below))
    pairs = solve_eigen(system, wanted)
    while below is not None and count is None and pairs.frequencies[-1] <= below:
        if wanted >= system.size - 1:
            break
        wanted = min(int(1.3 * wanted) + 10, system.size - 1)
        pairs = solve_eigen(system, wanted)
    up = system.axes - 1
    contact, *messenger = (
        WireShapes(
            shape.wires[wire].x,
            pairs.shapes[wire][:, :, up],
            pairs.shapes[wire][:, :, -1],
            pairs.shapes[wire][:, :, 1] if up > 1 else None,
        )
        for wire in (0, *range(shape.mesh.contact_wires, shape.mesh.first_stitch))
    )
    modes = Modes(
        shape.catenary,
        pairs.frequencies,
        contact,
        messenger[0] if messenger else None,
        pairs.longitudinal,
        pairs.lateral,
        pairs.damping_ratios,
    )
    modes = modes if below is None else modes.below(below)
    for warning in mode_warnings(shape, modes):
        _log.warning(warning)
    return modes


def mode_warnings(shape: Shape, modes: Modes) -> list[str]:
    """What to know before trusting modes: the rule and both numbers."""
    wires = zip(wire_kinds(shape.catenary, shape.mesh), shape.mesh.wires, strict=True)
    running = list(wires)[: shape.mesh.first_stitch]
    resolved = min(wire.wave_speed / (2 * float(np.diff(mesh.x).max())) for wire, mesh in running)
    above = int((modes.frequencies > resolved).sum())
    if not above:
        return []
    return [
        f"above {resolved:.0f} Hz waves are shorter than two elements: {counted(above, 'mode')}, up to"
        f" {modes.frequencies[-1]:.0f} Hz; refine the mesh, or leave them out"
    ]


def _expected(shape: Shape, below: float) -> int:
    """Modes of the two wires as strings with as many half-waves along the line, and some to spare."""
    wires = shape.catenary.contact_wire, shape.catenary.messenger_wire
    strings = sum(2 * shape.catenary.length * below / wire.wave_speed for wire in wires if wire)
    return int(1.1 * strings) + 10


def _check_taut(shape: Shape) -> None:
    catenary, system = shape.catenary, shape.system
    slack = np.flatnonzero(system.droppers.tension(system.droppers.span(system.reference)) <= 0)
    if slack.size:
        dropper, span = catenary.droppers[slack[0]], catenary.dropper_spans[slack[0]]
        raise InputError(
            f"span {span}: the dropper at {dropper.position:g} m is slack at rest ({slack.size} of"
            f" {len(catenary.droppers)} are): modal analysis takes all droppers as taut; change its"
            " length, or the form"
        )


def solve_eigen(system: System, count: int) -> EigenPairs:
    """The lowest ``count`` eigenpairs about the static state, all droppers taut.

    Raises SolverError if the iteration fails or the static state is not stable.
    """
    mass, T = system.free(system.mass), system.transformation
    stiffness = system.tangent(np.zeros(system.dof.size))
    squares, vectors = _lowest(stiffness, mass, min(count, system.size - 1))
    if squares[0] <= 0:
        raise SolverError(f"modal analysis: ω² = {squares[0]:g} 1/s² is not positive: the state is unstable")
    filled, axes = T @ vectors, system.axes
    shapes = [
        filled[2 * axes * wire.first : 2 * axes * (wire.first + wire.x.size)].T.reshape(
            squares.size, -1, 2 * axes
        )
        for wire in system.wires
    ]
    energies = vectors * (mass @ vectors)
    longitudinal, *lateral, _ = (
        energies[T.T @ (np.arange(len(filled)) % axes == axis) > 0].sum(axis=0) for axis in range(axes)
    )
    omega = np.sqrt(squares)
    damping = system.free(system.damping() + system.taut_damping())
    ratios = np.einsum("ij,ij->j", vectors, damping @ vectors) / (2 * omega)
    aside = lateral[0] if lateral else np.zeros(squares.size)
    return EigenPairs(omega / (2 * np.pi), shapes, longitudinal, aside, ratios)


def _lowest(stiffness: Any, mass: Any, count: int) -> tuple[Floats, Floats]:
    """ω² [1/s²] in rising order and mass-normalised vectors, by the method that is the quicker one."""
    from scipy.linalg import eigh
    from scipy.sparse.linalg import ArpackError, eigsh

    dimension = mass.shape[0]
    if dimension >= _DENSE_LARGEST and count > _LANCZOS_SHARE * dimension:
        raise InputError(
            f"modes: {counted(count, 'mode')} of a mesh with {dimension} coordinates: at most a third of them"
            " can be found; ask for less"
        )
    if count > _DENSE_SHARE * dimension and dimension < _DENSE_LARGEST:
        whole = stiffness.toarray(), mass.toarray()
        squares, vectors = eigh(*whole, subset_by_index=[0, count - 1])
        return squares, vectors
    try:
        squares, vectors = eigsh(
            stiffness.tocsc(),
            k=count,
            M=mass.tocsc(),
            sigma=0.0,
            v0=np.ones(dimension),  # the same answer every time
        )
    except (ArpackError, RuntimeError) as error:
        raise SolverError(f"modal analysis: no eigenpairs found ({error}); look for a loose part") from None
    order = np.argsort(squares)
    return squares[order], vectors[:, order]
