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
    L = cables.length[:, None]
    chord, first, last = (values[:, 2] - values[:, 0]) / L, values[:, 1], values[:, 3]
    on_chord, on_first, on_last = (np.zeros_like(chord) for _ in range(3))
    for xi, share in zip((_AXIAL[0] + 1) / 2, _AXIAL[1] / 2, strict=True):
        c, f, m = 6 * xi - 6 * xi**2, 1 - 4 * xi + 3 * xi**2, 3 * xi**2 - 2 * xi
        r = c * chord + f * first + m * last
        tension = 1 - (1 + cables.rest_strain) / np.sqrt(np.einsum("ek,ek->e", r, r))
        pull = (share * cables.axial_stiffness * cables.length * tension)[:, None] * r
        on_chord += c * pull
        on_first += f * pull
        on_last += m * pull
    for xi, share in zip((_BENDING[0] + 1) / 2, _BENDING[1] / 2, strict=True):
        c, f, m = 6 * xi - 6 * xi**2, 1 - 4 * xi + 3 * xi**2, 3 * xi**2 - 2 * xi
        cc, ff, mm = (w / L for w in (6 - 12 * xi, 6 * xi - 4, 6 * xi - 2))
        r, bend = c * chord + f * first + m * last, cc * chord + ff * first + mm * last
        g, bb, ab = (np.einsum("ek,ek->e", u, v)[:, None] for u, v in ((r, r), (bend, bend), (r, bend)))
        scale = share * cables.bending_stiffness[:, None] * L / g**2
        by_a = scale * ((2 * ab**2 / g - bb) * r - ab * bend)
        by_b = scale * (g * bend - ab * r)
        on_chord += c * by_a + cc * by_b
        on_first += f * by_a + ff * by_b
        on_last += m * by_a + mm * by_b
    return np.stack([-on_chord / L, on_first, on_chord / L, on_last], axis=1)


def tangent_blocks(cables: Cables, values: Floats, *, definite: bool = False) -> Floats:
    """Tangent stiffness [N/m], shape (elements, 4 * axes, 4 * axes).

    values : shape (elements, 4, axes), position and slope of the first node, then of the second
    definite : where an element is slack, it resists turning as if under half its tension without strain
    """
    count, _, axes = values.shape
    total = np.zeros((count, 4, axes, 4, axes))
    for xi, share in zip(*_AXIAL, strict=True):
        a, _ = _weights((xi + 1) / 2, cables.length)
        total += share / 2 * _spread(a, _axial(cables, np.einsum("ei,eik->ek", a, values), definite), a)
    for xi, share in zip(*_BENDING, strict=True):
        a, b = _weights((xi + 1) / 2, cables.length)
        r, bend = (np.einsum("ei,eik->ek", w, values) for w in (a, b))
        both, cross = _bending(cables, r, bend)
        mixed = _spread(a, cross, b)
        total += share / 2 * (_spread(a, both[0], a) + _spread(b, both[1], b))
        total += share / 2 * (mixed + np.transpose(mixed, (0, 3, 4, 1, 2)))
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


def _axial(cables: Cables, r: Floats, definite: bool) -> Floats:
    """Second derivative of ½ EA (ε - ε₀)² L by r'."""
    length = np.linalg.norm(r, axis=1)
    t = r / length[:, None]
    along = t[:, :, None] * t[:, None, :]
    tension = 1 - (1 + cables.rest_strain) / length
    if definite:
        tension = np.maximum(tension, -cables.rest_strain / 2)
    turning = tension[:, None, None] * (np.eye(r.shape[1]) - along)
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
