"""Forces of ANCF cable elements, in the plane and in space.

The elements are Exudyn's (Gerstmayr and Irschik 2008): cubic positions r, axial strain ε = |r'| - 1,
curvature κ = |r' × r''| / |r'|². Four Gauss points integrate axial forces, two bending moments.
Tuples of one axis hold r' at the six points, then L r'' at the last two.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from catenary_fe.engines.arrays import Floats, Integers
from catenary_fe.engines.compiled import compiled

Tuple = tuple[float, ...]


class Elements(NamedTuple):
    """Cable elements: number of the first coordinate, length L, EA, EI, and 1 + strain without force."""

    first: Integers
    length: Floats
    axial: Floats
    bending: Floats
    rest: Floats


def _gauss(count: int) -> tuple[Tuple, ...]:
    """Shares of the length; weights of chord / L and the two ends' slopes in r', and in L r''."""
    nodes, shares = np.polynomial.legendre.leggauss(count)
    xi = (nodes + 1) / 2
    weights = [6 * xi - 6 * xi**2, 1 - 4 * xi + 3 * xi**2, 3 * xi**2 - 2 * xi]
    bends = [6 - 12 * xi, 6 * xi - 4, 6 * xi - 2]
    return tuple(tuple(values.tolist()) for values in (shares / 2, *weights, *bends))


_SHARE, _CHORD, _FIRST, _LAST = _gauss(4)[:4]
_B_SHARE, _B_CHORD, _B_FIRST, _B_LAST, _C_CHORD, _C_FIRST, _C_LAST = _gauss(2)


@compiled
def _at_points(chord: float, first: float, last: float) -> Tuple:
    """r' and L r'' of one axis."""
    return (
        _CHORD[0] * chord + _FIRST[0] * first + _LAST[0] * last,
        _CHORD[1] * chord + _FIRST[1] * first + _LAST[1] * last,
        _CHORD[2] * chord + _FIRST[2] * first + _LAST[2] * last,
        _CHORD[3] * chord + _FIRST[3] * first + _LAST[3] * last,
        _B_CHORD[0] * chord + _B_FIRST[0] * first + _B_LAST[0] * last,
        _B_CHORD[1] * chord + _B_FIRST[1] * first + _B_LAST[1] * last,
        _C_CHORD[0] * chord + _C_FIRST[0] * first + _C_LAST[0] * last,
        _C_CHORD[1] * chord + _C_FIRST[1] * first + _C_LAST[1] * last,
    )


@compiled
def _products(r: Tuple) -> Tuple:
    """One axis' part of r'·r' at the points, and of L² r''·r'' and L r'·r'' at the last two."""
    return (
        r[0] * r[0],
        r[1] * r[1],
        r[2] * r[2],
        r[3] * r[3],
        r[4] * r[4],
        r[5] * r[5],
        r[6] * r[6],
        r[7] * r[7],
        r[4] * r[6],
        r[5] * r[7],
    )


@compiled
def _plus(a: Tuple, b: Tuple) -> Tuple:
    return (
        a[0] + b[0],
        a[1] + b[1],
        a[2] + b[2],
        a[3] + b[3],
        a[4] + b[4],
        a[5] + b[5],
        a[6] + b[6],
        a[7] + b[7],
        a[8] + b[8],
        a[9] + b[9],
    )


@compiled
def _bend(stiffness: float, g: float, bb: float, ab: float) -> Tuple:
    """Moment's work on r' per r' and per L r'', and on L r'' per L r'', from ½ EI κ²."""
    inverse = 1 / g
    along = ab * inverse
    curved = (bb - ab * along) * inverse  # (L κ)² |r'|⁰
    return (
        stiffness * inverse * (bb * inverse - 2 * curved),
        -stiffness * along * inverse,
        stiffness * inverse,
    )


@compiled
def _factors(L: float, EA: float, EI: float, rest: float, p: Tuple) -> Tuple:
    """Force on r' per r' at the axial points, then of each bending point its three factors."""
    n, m = EA * L, EI / L
    a, b, c = _bend(_B_SHARE[0] * m, p[4], p[6], p[8])
    d, e, f = _bend(_B_SHARE[1] * m, p[5], p[7], p[9])
    return (
        _SHARE[0] * n * (1 - rest / np.sqrt(p[0])),
        _SHARE[1] * n * (1 - rest / np.sqrt(p[1])),
        _SHARE[2] * n * (1 - rest / np.sqrt(p[2])),
        _SHARE[3] * n * (1 - rest / np.sqrt(p[3])),
        a,
        b,
        c,
        d,
        e,
        f,
    )


@compiled
def _generalised(r: Tuple, k: Tuple) -> tuple[float, float, float]:
    """Forces of one axis that work on chord / L and on the two slopes."""
    a, b, c, d = k[0] * r[0], k[1] * r[1], k[2] * r[2], k[3] * r[3]
    e, f = k[4] * r[4] + k[5] * r[6], k[7] * r[5] + k[8] * r[7]
    g, h = k[6] * r[6] + k[5] * r[4], k[9] * r[7] + k[8] * r[5]
    return (
        _CHORD[0] * a + _CHORD[1] * b + _CHORD[2] * c + _CHORD[3] * d
        + _B_CHORD[0] * e + _B_CHORD[1] * f + _C_CHORD[0] * g + _C_CHORD[1] * h,
        _FIRST[0] * a + _FIRST[1] * b + _FIRST[2] * c + _FIRST[3] * d
        + _B_FIRST[0] * e + _B_FIRST[1] * f + _C_FIRST[0] * g + _C_FIRST[1] * h,
        _LAST[0] * a + _LAST[1] * b + _LAST[2] * c + _LAST[3] * d
        + _B_LAST[0] * e + _B_LAST[1] * f + _C_LAST[0] * g + _C_LAST[1] * h,
    )  # fmt: skip


@compiled
def _axis(X: Floats, i: int, axes: int, L: float) -> Tuple:
    """Points of an element's axis whose first coordinate has the number i."""
    return _at_points((X[i + 2 * axes] - X[i]) / L, X[i + axes], X[i + 3 * axes])


@compiled
def _take(F: Floats, i: int, axes: int, L: float, r: Tuple, k: Tuple) -> None:
    """Take an element's forces of one axis off F."""
    chord, first, last = _generalised(r, k)
    F[i] += chord / L
    F[i + axes] -= first
    F[i + 2 * axes] -= chord / L
    F[i + 3 * axes] -= last


@compiled
def take_cables(axes: int, elements: Elements, X: Floats, F: Floats) -> None:
    """Take the elements' inner forces at the coordinates X off F; both of shape (all coordinates,)."""
    if axes == 2:
        _take_in_plane(elements, X, F)
    else:
        _take_in_space(elements, X, F)


@compiled
def _take_in_plane(elements: Elements, X: Floats, F: Floats) -> None:
    for e in range(elements.first.size):
        i, L = elements.first[e], elements.length[e]
        x, z = _axis(X, i, 2, L), _axis(X, i + 1, 2, L)
        p = _plus(_products(x), _products(z))
        k = _factors(L, elements.axial[e], elements.bending[e], elements.rest[e], p)
        _take(F, i, 2, L, x, k)
        _take(F, i + 1, 2, L, z, k)


@compiled
def _take_in_space(elements: Elements, X: Floats, F: Floats) -> None:
    for e in range(elements.first.size):
        i, L = elements.first[e], elements.length[e]
        x, y, z = _axis(X, i, 3, L), _axis(X, i + 1, 3, L), _axis(X, i + 2, 3, L)
        p = _plus(_plus(_products(x), _products(y)), _products(z))
        k = _factors(L, elements.axial[e], elements.bending[e], elements.rest[e], p)
        _take(F, i, 3, L, x, k)
        _take(F, i + 1, 3, L, y, k)
        _take(F, i + 2, 3, L, z, k)
