"""The cable element: forces, tangent, mass and energy of many at once, in the plane and in space.

The elements are Exudyn's ANCF cables (Gerstmayr and Irschik 2008): cubic positions r, energy ½ EA (ε - ε₀)²
and ½ EI κ² with ε = |r'| - 1 and κ = |r' × r''| / |r'|², at four and two Gauss points.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
_AXIAL = np.polynomial.legendre.leggauss(4)
_BENDING = np.polynomial.legendre.leggauss(2)


def _of_parts(points: Floats) -> tuple[Floats, Floats]:
    """Weights, shape (points, 3), of an element's chord and slopes in r', and in r'' times its length."""
    xi = (points + 1) / 2
    slopes = np.stack([6 * xi - 6 * xi**2, 1 - 4 * xi + 3 * xi**2, 3 * xi**2 - 2 * xi], axis=1)
    return slopes, np.stack([6 - 12 * xi, 6 * xi - 4, 6 * xi - 2], axis=1)


_AXIAL_SLOPES, _ = _of_parts(_AXIAL[0])
_BENDING_SLOPES, _BENDS = _of_parts(_BENDING[0])
_AXIAL_SHARES, _BENDING_SHARES = _AXIAL[1] / 2, _BENDING[1] / 2


_PAIRS = np.concatenate(  # shape (points, 9): what each second derivative adds to those by two parts
    [
        np.einsum("g,gp,gq->gpq", shares, left, right).reshape(-1, 9)
        for shares, left, right in (
            (_AXIAL_SHARES, _AXIAL_SLOPES, _AXIAL_SLOPES),
            (_BENDING_SHARES, _BENDING_SLOPES, _BENDING_SLOPES),
            (_BENDING_SHARES, _BENDS, _BENDS),
            (_BENDING_SHARES, _BENDING_SLOPES, _BENDS),
            (_BENDING_SHARES, _BENDS, _BENDING_SLOPES),
        )
    ]
)


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


def inner_forces(cables: Cables, values: Floats) -> Floats:
    """[N] and [N m], shape (elements, 4, axes): derivative of the energy by positions and slopes.

    values : shape (elements, 4, axes), position and slope of the first node, then of the second
    """
    L = cables.length
    parts = _parts(L, values)
    r = np.einsum("gp,pke->gke", _AXIAL_SLOPES, parts)
    stretched = 1 - (1 + cables.rest_strain) / np.sqrt(_dot(r, r))
    pull = _AXIAL_SHARES[:, None, None] * (cables.axial_stiffness * L) * stretched * r
    r, bend = (np.einsum("gp,pke->gke", weights, parts) for weights in (_BENDING_SLOPES, _BENDS))
    bend /= L
    g, bb, ab = _dot(r, r), _dot(bend, bend), _dot(r, bend)
    scale = _BENDING_SHARES[:, None, None] * (cables.bending_stiffness * L) / g**2
    by_a = scale * ((2 * ab**2 / g - bb) * r - ab * bend)
    by_b = scale / L * (g * bend - ab * r)
    on_points = ((_AXIAL_SLOPES, pull), (_BENDING_SLOPES, by_a), (_BENDS, by_b))
    chord, first, last = sum(np.einsum("gp,gke->pek", weights, part) for weights, part in on_points)
    chord = chord / L[:, None]
    return np.stack([-chord, first, chord, last], axis=1)


def tangent_blocks(cables: Cables, values: Floats, *, definite: bool = False) -> Floats:
    """Tangent stiffness [N/m], shape (elements, 4 * axes, 4 * axes).

    values : shape (elements, 4, axes), position and slope of the first node, then of the second
    definite : where an element is slack, it resists turning as if under half its tension without strain
    """
    (count, _, axes), L = values.shape, cables.length
    parts = _parts(L, values)
    axial = _axial(cables, np.einsum("gp,pke->gke", _AXIAL_SLOPES, parts), definite)
    r, bend = (np.einsum("gp,pke->gke", weights, parts) for weights in (_BENDING_SLOPES, _BENDS))
    (by_a, by_b), mixed = _bending(cables, r, bend / L)
    mixed = mixed / L
    points = np.concatenate([axial, by_a, by_b / L**2, mixed, np.swapaxes(mixed, 1, 2)])
    of_parts = np.einsum("gp,gx->px", _PAIRS, points.reshape(len(points), -1))
    of_parts = of_parts.reshape(3, 3, axes, axes, count).transpose(0, 1, 4, 2, 3)
    total = np.empty((count, 4, axes, 4, axes))
    of_vector = ((0, -1 / L), (1, np.ones_like(L)), (0, 1 / L), (2, np.ones_like(L)))  # part and its factor
    for i, (p, by_p) in enumerate(of_vector):
        for j, (q, by_q) in enumerate(of_vector):
            total[:, i, :, j] = of_parts[p, q] * (by_p * by_q)[:, None, None]
    return total.reshape(count, 4 * axes, 4 * axes)


def mean_stretch(cables: Cables, values: Floats) -> Floats:
    """Shape (elements,): mean of |r'| - 1, by the two Gauss points that make a cubic wire's exact.

    values : shape (elements, 4, axes), position and slope of the first node, then of the second
    """
    found = np.zeros(cables.length.size)
    for xi, share in zip(*_BENDING, strict=True):
        a, _ = _weights((xi + 1) / 2, cables.length)
        found += share / 2 * (np.linalg.norm(np.einsum("ei,eik->ek", a, values), axis=1) - 1)
    return found


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


def mass_blocks(length: Floats, mass_per_length: Floats | float, axes: int) -> Floats:
    """[kg], shape (elements, 4 * axes, 4 * axes).

    length : [m], shape (elements,)
    mass_per_length : [kg/m], a number or shape (elements,)
    """
    L, one = length, np.ones_like(length)
    row = np.array(
        [
            [156 * one, 22 * L, 54 * one, -13 * L],
            [22 * L, 4 * L**2, 13 * L, -3 * L**2],
            [54 * one, 13 * L, 156 * one, -22 * L],
            [-13 * L, -3 * L**2, -22 * L, 4 * L**2],
        ]
    )
    of_axis = np.moveaxis(row * mass_per_length * L / 420, 2, 0)
    blocks: Floats = np.einsum("eij,kl->eikjl", of_axis, np.eye(axes)).reshape(L.size, 4 * axes, 4 * axes)
    return blocks


def _weights(xi: float, L: Floats) -> tuple[Floats, Floats]:
    """Weights of an element's four vectors in r' and in r'', shape (elements, 4) each."""
    one = np.ones_like(L)
    chord, bend = (6 * xi - 6 * xi**2) / L, (6 - 12 * xi) / L**2
    first = [-chord, (1 - 4 * xi + 3 * xi**2) * one, chord, (3 * xi**2 - 2 * xi) * one]
    second = [-bend, (6 * xi - 4) / L, bend, (6 * xi - 2) / L]
    return np.stack(first, axis=1), np.stack(second, axis=1)


def _parts(length: Floats, values: Floats) -> Floats:
    """Shape (3, axes, elements): chord by length, slopes at both nodes."""
    v = values.transpose(1, 2, 0)
    return np.stack([(v[2] - v[0]) / length, v[1], v[3]])


def _dot(u: Floats, v: Floats) -> Floats:
    """Shape (points, 1, elements), of vectors of shape (points, axes, elements)."""
    product: Floats = u[:, :1] * v[:, :1]
    for k in range(1, u.shape[1]):
        product += u[:, k : k + 1] * v[:, k : k + 1]
    return product


def _axial(cables: Cables, r: Floats, definite: bool) -> Floats:
    """Second derivative of ½ EA (ε - ε₀)² L by r', shape (points, axes, axes, elements).

    r : shape (points, axes, elements)
    """
    length = np.sqrt(_dot(r, r))
    t = r / length
    along = t[:, :, None] * t[:, None]
    tension = 1 - (1 + cables.rest_strain) / length
    if definite:
        tension = np.maximum(tension, -cables.rest_strain / 2)
    turning = tension[:, None] * (np.eye(r.shape[1])[:, :, None] - along)
    found: Floats = cables.axial_stiffness * cables.length * (along + turning)
    return found


def _bending(cables: Cables, a: Floats, b: Floats) -> tuple[tuple[Floats, Floats], Floats]:
    """Second derivatives of ½ EI φ / g² L with φ = g b·b - (a·b)², g = a·a: by a and b twice, and by both.

    a, b : shape (points, axes, elements)
    """
    identity = np.eye(a.shape[1])[:, :, None]
    g, bb, ab = (_dot(u, v)[:, None] for u, v in ((a, a), (b, b), (a, b)))
    phi = g * bb - ab**2
    aa, ba, abt, b2 = (u[:, :, None] * v[:, None] for u, v in ((a, a), (b, a), (a, b), (b, b)))
    scale = cables.bending_stiffness * cables.length / g**2
    # φ_a = 2 bb a - 2 ab b, φ_b = 2 g b - 2 ab a, g_a = 2 a
    by_a = (bb - 2 * phi / g) * identity - b2 - 4 / g * (2 * bb * aa - ab * (ba + abt)) + 12 * phi / g**2 * aa
    by_b = g * identity - aa
    mixed = 2 * abt - ba - ab * identity - 4 * (g * abt - ab * aa) / g
    return (scale * by_a, scale * by_b), scale * mixed


def hermite(xi: ArrayLike, length: ArrayLike) -> Floats:
    """Shape functions of the cable element, shape (..., 4), at the fraction ``xi`` of its length."""
    xi, length = np.asarray(xi, dtype=float), np.asarray(length, dtype=float)
    return np.stack(
        [
            1 - 3 * xi**2 + 2 * xi**3,
            length * (xi - 2 * xi**2 + xi**3),
            3 * xi**2 - 2 * xi**3,
            length * (xi**3 - xi**2),
        ],
        axis=-1,
    )


def scattered(parts: Sequence[tuple[Integers, Floats]], size: int, place: Integers | None = None) -> Any:
    """Sparse (scipy CSR), shape (size, size): blocks added up at their coordinates.

    parts : pairs of coordinates, shape (blocks, m), and blocks, shape (blocks, m, m)
    place : shape (all coordinates,), number that each coordinate has in the matrix; below 0: left out. Unset:
        its own
    """
    from scipy.sparse import coo_matrix

    rows = np.concatenate([np.repeat(index, index.shape[1], axis=1).ravel() for index, _ in parts])
    columns = np.concatenate([np.tile(index, (1, index.shape[1])).ravel() for index, _ in parts])
    values = np.concatenate([blocks.ravel() for _, blocks in parts])
    if place is not None:
        rows, columns = place[rows], place[columns]
        kept = (rows >= 0) & (columns >= 0)
        rows, columns, values = rows[kept], columns[kept], values[kept]
    return coo_matrix((values, (rows, columns)), shape=(size, size)).tocsr()
