"""Forces of ANCF cable elements, in the plane and in space, eight elements at a time.

The elements are Exudyn's (Gerstmayr and Irschik 2008): cubic positions r, axial strain ε = |r'| - 1,
curvature κ = |r' × r''| / |r'|². Four Gauss points integrate axial forces, two bending moments.
Tuples of one axis hold r' at the six points, then L r'' at the last two. Mass and damping go with the
elements: as matrices of the line they would be so large that reading them took longer than the rest.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import SLOTS, Floats, Integers
from catenary_fe.engines.compiled import compiled
from catenary_fe.engines.lanes import load_eight, root, store_eight

Tuple = tuple[Any, ...]
Singles = NDArray[np.float32]
TINY = 1e-60  # added to |r'|²: places without an element have no r'


class Elements(NamedTuple):
    """Cable elements by the numbers of their first nodes, shape (places,) each, a multiple of eight.

    None begins at the last node of a wire: there EA, EI and mass are 0, and the length is 1.

    length, mass : [m], [kg]
    axial, bending, rest : EA, EI, and 1 + strain without force
    damping : shape (entries, places), β K at rest over chord / L and both slopes, each with all axes: row by
        row up to the diagonal, in single precision; no entries without such damping
    alpha : [1/s], damping by mass
    """

    length: Floats
    mass: Floats
    axial: Floats
    bending: Floats
    rest: Floats
    damping: Singles
    alpha: float

    @classmethod
    def by_node(cls, nodes: Integers, alpha: float, **arrays: Any) -> Elements:
        """From arrays of shape (..., elements), and the numbers of the elements' first nodes."""
        places, found = -(-(int(nodes[-1]) + 2) // SLOTS) * SLOTS, {}
        for name, values in arrays.items():
            found[name] = np.full((*values.shape[:-1], places), float(name == "length"), values.dtype)
            found[name][..., nodes] = values
        return cls(**found, alpha=alpha)

    def at(self, nodes: Integers) -> Elements:
        """Those that begin at some of the nodes, of whole wires, numbered anew."""
        arrays = {name: array[..., nodes] for name, array in self._asdict().items() if name != "alpha"}
        return self.by_node(np.arange(nodes.size), self.alpha, **arrays)

    def placed(self, values: NDArray[Any], nothing: float = 0.0) -> NDArray[Any]:
        """Values of shape (..., nodes) with places for the elements behind the last node, and eight more."""
        room = np.full((len(values), self.length.size + SLOTS - values.shape[1]), nothing, values.dtype)
        return np.ascontiguousarray(np.hstack([values, room]))


class Room(NamedTuple):
    """What is known of eight elements, shape (axes * values, SLOTS) each.

    points : see :func:`points_of`
    rates : of positions and slopes at both ends
    parts, pulls : rates of chord / L and both slopes, in the order of ``Elements.damping``; damping on these
    """

    points: Floats
    rates: Floats
    parts: Floats
    pulls: Floats

    @classmethod
    def of(cls, axes: int) -> Room:
        """Room."""
        return cls(*(np.zeros((axes * count, SLOTS)) for count in (8, 4, 3, 3)))


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
def _at_points(chord: Any, first: Any, last: Any) -> Tuple:
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
def plus(a: Tuple, b: Tuple) -> Tuple:
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
def _bend(stiffness: Any, g: Any, bb: Any, ab: Any) -> Tuple:
    """Moment's work on r' per r' and per L r'', and on L r'' per L r'', from ½ EI κ²."""
    inverse = 1.0 / g
    along = ab * inverse
    curved = (bb - ab * along) * inverse  # (L κ)² |r'|⁰
    return (
        stiffness * inverse * (bb * inverse - 2.0 * curved),
        -1.0 * stiffness * along * inverse,
        stiffness * inverse,
    )


@compiled
def _factors(L: Any, EA: Any, EI: Any, rest: Any, p: Tuple) -> Tuple:
    """Force on r' per r' at the axial points, then of each bending point its three factors."""
    n, m = EA * L, EI / L
    a, b, c = _bend(_B_SHARE[0] * m, p[4] + TINY, p[6], p[8])
    d, e, f = _bend(_B_SHARE[1] * m, p[5] + TINY, p[7], p[9])
    return (
        _SHARE[0] * n * (1.0 - rest / root(p[0] + TINY)),
        _SHARE[1] * n * (1.0 - rest / root(p[1] + TINY)),
        _SHARE[2] * n * (1.0 - rest / root(p[2] + TINY)),
        _SHARE[3] * n * (1.0 - rest / root(p[3] + TINY)),
        a,
        b,
        c,
        d,
        e,
        f,
    )


@compiled
def _generalised(r: Tuple, k: Tuple) -> tuple[Any, Any, Any]:
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
def points_of(elements: Elements, room: Room, e: int, axis: int, ends: Tuple) -> Tuple:
    """Keep r' and L r'' of an axis of eight elements from number e on; returns its part of their products.

    ends : positions and slopes at both ends
    """
    r = _at_points((ends[2] - ends[0]) / load_eight(elements.length, e), ends[1], ends[3])
    _store_four(room.points, 8 * axis, r[:4])
    _store_four(room.points, 8 * axis + 4, r[4:])
    return _products(r)


@compiled
def _store_four(array: Floats, row: int, values: Tuple) -> None:
    i = SLOTS * row
    store_eight(array, i, values[0])
    store_eight(array, i + SLOTS, values[1])
    store_eight(array, i + 2 * SLOTS, values[2])
    store_eight(array, i + 3 * SLOTS, values[3])


@compiled
def _load_four(array: Floats, row: int) -> tuple[Any, Any, Any, Any]:
    i = SLOTS * row
    return (
        load_eight(array, i),
        load_eight(array, i + SLOTS),
        load_eight(array, i + 2 * SLOTS),
        load_eight(array, i + 3 * SLOTS),
    )


@compiled
def nothing(elements: Elements) -> Tuple:
    """No products yet."""
    z = 0.0 * load_eight(elements.length, 0)
    return z, z, z, z, z, z, z, z, z, z


@compiled
def inner_forces(room: Room, axis: int, factors: Tuple) -> tuple[Any, Any, Any]:
    """Forces of one axis that work on chord / L and the two slopes, by :func:`factors_of` the elements."""
    first, last = _load_four(room.points, 8 * axis), _load_four(room.points, 8 * axis + 4)
    return _generalised(first + last, factors)


@compiled
def factors_of(elements: Elements, e: int, p: Tuple) -> Tuple:
    """Of eight elements, from the sums of their axes' products."""
    EA, EI = load_eight(elements.axial, e), load_eight(elements.bending, e)
    return _factors(load_eight(elements.length, e), EA, EI, load_eight(elements.rest, e), p)


@compiled
def rates_of(elements: Elements, room: Room, e: int, axis: int, ends: Tuple) -> None:
    """Keep the rates of an axis, of positions and slopes at both ends."""
    axes = room.rates.shape[0] // 4
    _store_four(room.rates, 4 * axis, ends)
    store_eight(room.parts, SLOTS * axis, (ends[2] - ends[0]) / load_eight(elements.length, e))
    store_eight(room.parts, SLOTS * (axes + axis), ends[1])
    store_eight(room.parts, SLOTS * (2 * axes + axis), ends[3])


@compiled
def damp(elements: Elements, room: Room, e: int) -> None:
    """From the rates' parts to the damping that works on them."""
    places, parts, pulls, m = elements.length.size, room.parts, room.pulls, e
    if elements.damping.shape[0] == 0:
        return
    for p in range(parts.shape[0]):
        own = load_eight(parts, SLOTS * p)
        pull = 0.0 * own
        for q in range(p):
            k = load_eight(elements.damping, m)
            pull = pull + k * load_eight(parts, SLOTS * q)
            store_eight(pulls, SLOTS * q, load_eight(pulls, SLOTS * q) + k * own)
            m += places
        store_eight(pulls, SLOTS * p, pull + load_eight(elements.damping, m) * own)
        m += places


@compiled
def taken(
    elements: Elements, room: Room, e: int, axis: int, inner: tuple[Any, Any, Any], speeding: Tuple
) -> Tuple:
    """What elements take from forces of one axis: position and slope at their first, then at their last node.

    inner : forces that work on chord / L and the two slopes
    speeding : accelerations of positions and slopes at both ends
    """
    axes, rates, alpha = room.rates.shape[0] // 4, _load_four(room.rates, 4 * axis), elements.alpha
    L, c = load_eight(elements.length, e), load_eight(elements.mass, e) * (1 / 420)
    y, s = speeding[0] + alpha * rates[0], (speeding[1] + alpha * rates[1]) * L
    z, t = speeding[2] + alpha * rates[2], (speeding[3] + alpha * rates[3]) * L
    push = (inner[0] + load_eight(room.pulls, SLOTS * axis)) / L
    first = inner[1] + load_eight(room.pulls, SLOTS * (axes + axis))
    last = inner[2] + load_eight(room.pulls, SLOTS * (2 * axes + axis))
    return (
        push - c * (156.0 * y + 22.0 * s + 54.0 * z - 13.0 * t),
        -1.0 * first - c * L * (22.0 * y + 4.0 * s + 13.0 * z - 3.0 * t),
        -1.0 * push - c * (54.0 * y + 13.0 * s + 156.0 * z - 22.0 * t),
        c * L * (13.0 * y + 3.0 * s + 22.0 * z - 4.0 * t) - last,
    )
