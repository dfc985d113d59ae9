"""Elements of wires: their stiffness, and terms of second order.

Inclination lengthens the wire between two clamps, whose tension works on it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from catenary_fe.engines.arrays import Floats, Integers
from catenary_fe.engines.compiled import compiled
from catenary_fe.engines.lanes import load, number, store
from catenary_fe.engines.linearised.arrays import Line

# entries of a stiffness that an element brings in: first and second place and slope are 0 to 3, the tension 4
_ROWS = np.array([2, 2, 3, 0, 0, 1, 1, 4, 4, 4, 4])
_COLUMNS = np.array([2, 3, 3, 2, 3, 2, 3, 0, 1, 2, 3])


def by_elements(stiffness: Any, at: Integers, tensions: Integers) -> tuple[Floats, Any]:
    """What of a stiffness couples the coordinates of elements, and the rest of it, sparse.

    What several elements share belongs to the first of them alone.

    at : shape (elements, 4), numbers of place and slope at the first node, then at the second, or FIXED
    tensions : shape (elements,), numbers of the coordinates that are their tensions

    Returns shape (elements, 11), in the order of ``_ROWS`` and ``_COLUMNS``.
    """
    from scipy.sparse import csr_matrix

    size = stiffness.shape[0]
    places = np.column_stack([at, tensions])
    row, column = places[:, _ROWS], places[:, _COLUMNS]
    key = np.where((row >= 0) & (column >= 0), row * size + column, -1).ravel()
    taken, first = np.unique(key, return_index=True)
    whole = stiffness.tocoo()
    here, there = (a.astype(np.int64) * size + b for a, b in ((whole.row, whole.col), (whole.col, whole.row)))
    order = np.argsort(here)
    found = order[np.minimum(np.searchsorted(here, taken, sorter=order), order.size - 1)]
    values = np.zeros(key.size)
    values[first] = np.where(here[found] == taken, whole.data[found], 0.0)
    left = ~(_among(here, taken) | _among(there, taken))
    rest = csr_matrix((whole.data[left], (whole.row[left], whole.col[left])), shape=whole.shape)
    return values.reshape(row.shape), rest


def _among(values: Integers, ordered: Integers) -> Any:
    """Which of the values are among ordered ones."""
    found: Any = ordered[np.minimum(np.searchsorted(ordered, values), ordered.size - 1)] == values
    return found


@compiled
def take_elements(line: Line, q: Floats, tension: Floats, w: Floats, x: Floats) -> None:
    """Forces of elements taken from x: linear ones at w, and what tension does at q, which lengthens gaps.

    tension : [N], shape (gaps,) or (gaps, SLOTS), change of it
    """
    at, length, gap = line.stretch.at, line.stretch.length, line.stretch.gap
    for r in range(length.size):
        i, j, k, m = at[r, 0], at[r, 1], at[r, 2], at[r, 3]
        L, g, K = length[r], line.tensions[gap[r]], line.stretch.stiffness[r]
        t, wt = load(tension, gap[r]), load(w, g)
        y, s, z, e = _value(q, i), _value(q, j), _value(q, k), _value(q, m)
        wy, ws, wz, we = _value(w, i), _value(w, j), _value(w, k), _value(w, m)
        across, first, last, longer = stretch_forces(L, y, s, z, e)
        _take(x, i, t * across + K[3] * wz + K[4] * we + K[7] * wt)
        _take(x, j, t * first + K[5] * wz + K[6] * we + K[8] * wt)
        _take(x, k, K[0] * wz + K[1] * we + K[3] * wy + K[5] * ws + K[9] * wt - t * across)
        _take(x, m, t * last + K[1] * wz + K[2] * we + K[4] * wy + K[6] * ws + K[10] * wt)
        _take(x, g, longer + K[7] * wy + K[8] * ws + K[9] * wz + K[10] * we)


@compiled
def _value(q: Floats, i: int) -> Any:
    if i >= 0:
        return load(q, i)
    return number(q, 0.0)


@compiled
def _take(x: Floats, i: int, force: Any) -> None:
    if i >= 0:
        store(x, i, load(x, i) - force)


@compiled
def stretch_forces(L: float, y: Any, s: Any, z: Any, e: Any) -> tuple[Any, Any, Any, Any]:
    """Of an element with places y and z and slopes s and e at its ends: forces per tension, lengthening."""
    chord = y - z
    across = 1.2 / L * chord + 0.1 * (s + e)
    first = 0.1 * chord + L / 30 * (4.0 * s - e)
    last = 0.1 * chord + L / 30 * (4.0 * e - s)
    return across, first, last, 0.5 * (across * chord + first * s + last * e)
