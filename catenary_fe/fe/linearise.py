"""Mass and stiffness matrices of wires at the current state, sparse, in closed form.

The elements are Exudyn's ANCF cables (Gerstmayr and Irschik 2008): cubic positions r, energy ½ EA (ε - ε₀)²
and ½ EI κ² with ε = |r'| - 1 and κ = |r' × r''| / |r'|², at four and two Gauss points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.wire import WireItems

Floats = NDArray[np.float64]
_AXIAL = np.polynomial.legendre.leggauss(4)
_BENDING = np.polynomial.legendre.leggauss(2)


def mass_matrix(mbs: exu.MainSystem, wires: Sequence[WireItems], factors: Floats | None = None) -> Any:
    """Sparse (scipy CSR) mass matrix [kg] over all second-order coordinates of the system.

    factors : shape (elements,), by which each element's matrix is multiplied; unset: 1
    """
    blocks = [mass_blocks(wire) for wire in wires]
    if factors is not None:
        parts = np.split(factors, np.cumsum([len(b) for b in blocks])[:-1])
        blocks = [block * part[:, None, None] for block, part in zip(blocks, parts, strict=True)]
    return _assemble(mbs, wires, blocks)


def stiffness_matrix(mbs: exu.MainSystem, wires: Sequence[WireItems]) -> Any:
    """Sparse (scipy CSR) tangent stiffness [N/m], with what the tension adds."""
    return _assemble(mbs, wires, [stiffness_blocks(mbs, wire) for wire in wires])


def mass_blocks(wire: WireItems) -> Floats:
    """[kg], shape (elements, 4 * axes, 4 * axes)."""
    L, axes = wire.line.lengths, wire.line.axes
    one = np.ones_like(L)
    row = np.array(
        [
            [156 * one, 22 * L, 54 * one, -13 * L],
            [22 * L, 4 * L**2, 13 * L, -3 * L**2],
            [54 * one, 13 * L, 156 * one, -22 * L],
            [-13 * L, -3 * L**2, -22 * L, 4 * L**2],
        ]
    )
    of_axis = np.moveaxis(row * wire.kind.mass_per_length * L / 420, 2, 0)
    blocks: Floats = np.einsum("eij,kl->eikjl", of_axis, np.eye(axes)).reshape(L.size, 4 * axes, 4 * axes)
    return blocks


def stiffness_blocks(mbs: exu.MainSystem, wire: WireItems) -> Floats:
    """[N/m], shape (elements, 4 * axes, 4 * axes), at the current state."""
    axes, kind = wire.line.axes, wire.kind
    first, each = first_coordinate(mbs, wire), np.ones_like(wire.line.lengths)
    moved = mbs.systemData.GetODE2Coordinates()[first : first + wire.coordinates * (each.size + 1)]
    nodes = (wire.line.coordinates().ravel() + moved).reshape(-1, 2, axes)
    cable = Cables(
        length=wire.line.lengths,
        axial_stiffness=kind.axial_stiffness * each,
        bending_stiffness=kind.bending_stiffness * each,
        rest_strain=-kind.tension / kind.axial_stiffness * each,
    )
    return tangent_blocks(cable, np.concatenate([nodes[:-1], nodes[1:]], axis=1))


@dataclass(frozen=True)
class Cables:
    """Cable elements, each array of shape (elements,).

    length : [m]
    axial_stiffness, bending_stiffness : [N], [N m²]
    rest_strain : axial strain without force
    """

    length: Floats
    axial_stiffness: Floats
    bending_stiffness: Floats
    rest_strain: Floats


def tangent_blocks(cables: Cables, values: Floats) -> Floats:
    """Tangent stiffness [N/m], shape (elements, 4 * axes, 4 * axes).

    values : shape (elements, 4, axes), position and slope of the first node, then of the second
    """
    count, _, axes = values.shape
    total = np.zeros((count, 4, axes, 4, axes))
    for xi, share in zip(*_AXIAL, strict=True):
        a, _ = _weights((xi + 1) / 2, cables.length)
        total += share / 2 * _spread(a, _axial(cables, np.einsum("ei,eik->ek", a, values)), a)
    for xi, share in zip(*_BENDING, strict=True):
        a, b = _weights((xi + 1) / 2, cables.length)
        r, bend = (np.einsum("ei,eik->ek", w, values) for w in (a, b))
        both, cross = _bending(cables, r, bend)
        mixed = _spread(a, cross, b)
        total += share / 2 * (_spread(a, both[0], a) + _spread(b, both[1], b))
        total += share / 2 * (mixed + np.transpose(mixed, (0, 3, 4, 1, 2)))
    return total.reshape(count, 4 * axes, 4 * axes)


def strain_energy(cables: Cables, values: Floats) -> Floats:
    """[J], shape (elements,), of elements with positions and slopes ``values``, shape (elements, 4, axes)."""
    found = np.zeros(cables.length.size)
    for xi, share in zip(*_AXIAL, strict=True):
        a, _ = _weights((xi + 1) / 2, cables.length)
        stretch = np.linalg.norm(np.einsum("ei,eik->ek", a, values), axis=1) - 1 - cables.rest_strain
        found += share / 4 * cables.axial_stiffness * cables.length * stretch**2
    for xi, share in zip(*_BENDING, strict=True):
        r, bend = (np.einsum("ei,eik->ek", w, values) for w in _weights((xi + 1) / 2, cables.length))
        g, bb, ab = ((u * v).sum(axis=1) for u, v in ((r, r), (bend, bend), (r, bend)))
        found += share / 4 * cables.bending_stiffness * cables.length * (g * bb - ab**2) / g**2
    return found


def _weights(xi: float, L: Floats) -> tuple[Floats, Floats]:
    """Weights of an element's four vectors in r' and in r'', shape (elements, 4) each."""
    one = np.ones_like(L)
    chord, bend = (6 * xi - 6 * xi**2) / L, (6 - 12 * xi) / L**2
    first = [-chord, (1 - 4 * xi + 3 * xi**2) * one, chord, (3 * xi**2 - 2 * xi) * one]
    second = [-bend, (6 * xi - 4) / L, bend, (6 * xi - 2) / L]
    return np.stack(first, axis=1), np.stack(second, axis=1)


def _axial(cables: Cables, r: Floats) -> Floats:
    """Second derivative of ½ EA (ε - ε₀)² L by r'."""
    length = np.linalg.norm(r, axis=1)
    t = r / length[:, None]
    along = t[:, :, None] * t[:, None, :]
    turning = (1 - (1 + cables.rest_strain) / length)[:, None, None] * (np.eye(r.shape[1]) - along)
    found: Floats = (cables.axial_stiffness * cables.length)[:, None, None] * (along + turning)
    return found


def _bending(cables: Cables, a: Floats, b: Floats) -> tuple[tuple[Floats, Floats], Floats]:
    """Second derivatives of ½ EI φ / g² L with φ = g b·b - (a·b)², g = a·a: by a and b twice, and by both."""
    identity = np.eye(a.shape[1])
    g, bb, ab = ((u * v).sum(axis=1)[:, None, None] for u, v in ((a, a), (b, b), (a, b)))
    phi = g * bb - ab**2
    aa, ba, b2 = (u[:, :, None] * v[:, None, :] for u, v in ((a, a), (b, a), (b, b)))
    abt = np.transpose(ba, (0, 2, 1))
    scale = (cables.bending_stiffness * cables.length)[:, None, None] / g**2
    # φ_a = 2 bb a - 2 ab b, φ_b = 2 g b - 2 ab a, g_a = 2 a
    by_a = (bb - 2 * phi / g) * identity - b2 - 4 / g * (2 * bb * aa - ab * (ba + abt)) + 12 * phi / g**2 * aa
    by_b = g * identity - aa
    mixed = 2 * abt - ba - ab * identity - 4 * (g * abt - ab * aa) / g
    return (scale * by_a, scale * by_b), scale * mixed


def _spread(left: Floats, middle: Floats, right: Floats) -> Floats:
    """Shape (elements, 4, axes, 4, axes)."""
    found: Floats = left[:, :, None, None, None] * middle[:, None, :, None, :] * right[:, None, None, :, None]
    return found


def first_coordinate(mbs: exu.MainSystem, wire: WireItems) -> int:
    """Number of a wire's first coordinate; those of its nodes follow one another."""
    return int(mbs.systemData.GetNodeLTGODE2(wire.nodes[0])[0])


def _assemble(mbs: exu.MainSystem, wires: Sequence[WireItems], blocks: Sequence[Floats]) -> Any:
    from scipy.sparse import coo_matrix

    rows, columns = [], []
    for wire, values in zip(wires, blocks, strict=True):
        count, m = values.shape[:2]
        index = first_coordinate(mbs, wire) + wire.coordinates * np.arange(count)[:, None] + np.arange(m)
        rows.append(np.repeat(index, m, axis=1).ravel())
        columns.append(np.tile(index, (1, m)).ravel())
    size = mbs.systemData.ODE2Size()
    triplets = (np.concatenate([b.ravel() for b in blocks]), (np.concatenate(rows), np.concatenate(columns)))
    return coo_matrix(triplets, shape=(size, size)).tocsr()
