"""Columns of the inverse of the step's matrix, where they are not negligible: a force is felt nearby only."""

from __future__ import annotations

from typing import Any

import numpy as np

from catenary_fe.engines.arrays import SLOTS, Floats, Integers
from catenary_fe.engines.compiled import compiled, kept, vectorising
from catenary_fe.engines.linearised.arrays import ComplianceColumns

NEGLIGIBLE = 1e-6  # of a column's largest entry
_FEW = 2 * SLOTS  # columns that tell how wide all are
_EDGE = 64  # part of the window, at either end, where a column must have become negligible


def compliance_columns(factor: Any, right: Any, starts: Integers) -> ComplianceColumns:
    """Columns of the inverse times ``right``.

    factor : of a symmetric matrix, L D Lᵀ, as scipy has it, narrow and in the order of the rows
    right : sparse, shape (size, columns), each column with entries near each other
    starts : shape (sections + 1,), rows where sections begin; a column stays in its own one if that has room
    """
    size, count = right.shape
    if not count:
        return ComplianceColumns(np.zeros(0, dtype=np.int64), np.zeros((0, 1)))
    right = right.tocsc()
    owner = np.repeat(np.arange(count), np.diff(right.indptr))
    middle = (np.bincount(owner, right.indices) / np.bincount(owner)).astype(np.int64)
    order = np.argsort(middle, kind="stable")
    lower, inverse = factor.L, 1 / factor.U.diagonal()
    triangle, sides = ((A.indptr, A.indices, A.data) for A in (lower, right))
    few = order[:: -(-count // _FEW)]
    part = right[:, few]
    first_few = (part.indptr, part.indices, part.data), np.arange(few.size), middle[few] - size
    _, begin, end = _windows(triangle, inverse, *first_few, 2 * size)
    reach = max(int((size - begin).max()), int((end - size).max()))
    window = int(2.4 * reach) + _EDGE
    while True:
        low = middle - window // 2
        values, begin, end = _windows(triangle, inverse, sides, order, low, window)
        edge = window // _EDGE
        if window > 2 * size or (begin.min() >= edge and end.max() <= window - edge):
            break
        window *= 2  # others are wider
    width = int((end - begin).max())
    # all are as wide as the widest: the room to spare, to both sides
    section = np.searchsorted(starts, middle, side="right")
    first = np.clip(low + (begin + end - width) // 2, starts[section - 1], starts[section] - width)
    first = np.clip(first, 0, size - width)
    cut = np.zeros((count, width))
    _cut(values, first - low, cut)
    return ComplianceColumns(first, cut)


def _windows(
    triangle: tuple[Any, Any, Floats],
    inverse: Floats,
    sides: tuple[Any, Any, Floats],
    order: Integers,
    low: Integers,
    window: int,
) -> tuple[Floats, Integers, Integers]:
    """Each column from its row ``low`` on, shape (columns, window), and where in it it is not negligible."""
    values = np.zeros((order.size, window))
    begin, end = np.full(order.size, window), np.zeros(order.size, np.int64)
    with vectorising():
        _solve_all(triangle, inverse, sides, order, low, values, begin, end, np.zeros((inverse.size, SLOTS)))
    return values, begin, end


@kept
def _solve_all(
    triangle: tuple[Any, Any, Floats],
    inverse: Floats,
    sides: tuple[Any, Any, Floats],
    order: Integers,
    low: Integers,
    values: Floats,
    begin: Integers,
    end: Integers,
    x: Floats,
) -> None:
    """Fill what :func:`_windows` returns; as many neighbours as there are slots side by side, in ``x``."""
    size, count, window = inverse.size, order.size, values.shape[1]
    for group in range(0, count, SLOTS):
        mine = order[group : group + SLOTS]
        top, bottom = max(low[mine[0]], 0), min(low[mine[-1]] + window, size)
        x[top:bottom, :] = 0.0
        head = bottom
        for c in range(mine.size):
            for m in range(sides[0][mine[c]], sides[0][mine[c] + 1]):
                x[sides[1][m], c] = sides[2][m]
                head = min(head, sides[1][m])
        _solve(triangle, inverse, x, (top, head, bottom))
        for c in range(mine.size):
            k = mine[c]
            first, last = max(low[k], 0), min(low[k] + window, size)
            least = 0.0
            for i in range(first, last):
                values[k, i - low[k]] = x[i, c]
                least = max(least, NEGLIGIBLE * abs(x[i, c]))
            for i in range(first, last):
                if abs(x[i, c]) > least:
                    begin[k] = min(begin[k], i - low[k])
                    end[k] = i - low[k] + 1


@compiled
def _solve(triangle: tuple[Any, Any, Floats], inverse: Floats, x: Floats, rows: tuple[int, int, int]) -> None:
    """Solve L D Lᵀ y = x in place; written out, the slots make vectors.

    rows : where y begins, where x does, before which both end
    """
    start, row, value = triangle
    top, head, bottom = rows
    for i in range(head, bottom):
        r = x[i]
        a, b, c, d, e, f, g, h = r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7]
        for m in range(start[i] + 1, start[i + 1]):
            if row[m] < bottom:
                k, p = value[m], x[row[m]]
                p[0], p[1], p[2], p[3] = p[0] - k * a, p[1] - k * b, p[2] - k * c, p[3] - k * d
                p[4], p[5], p[6], p[7] = p[4] - k * e, p[5] - k * f, p[6] - k * g, p[7] - k * h
    for n in range(bottom - top):
        i = bottom - 1 - n
        r, v = x[i], inverse[i]
        a, b, c, d = v * r[0], v * r[1], v * r[2], v * r[3]
        e, f, g, h = v * r[4], v * r[5], v * r[6], v * r[7]
        for m in range(start[i] + 1, start[i + 1]):
            if row[m] < bottom:
                k, p = value[m], x[row[m]]
                a, b, c, d = a - k * p[0], b - k * p[1], c - k * p[2], d - k * p[3]
                e, f, g, h = e - k * p[4], f - k * p[5], g - k * p[6], h - k * p[7]
        r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7] = a, b, c, d, e, f, g, h


@kept
def _cut(values: Floats, first: Integers, cut: Floats) -> None:
    """Fill each row of ``cut`` from its place ``first`` on; what lies beyond the row's ends stays 0."""
    width = cut.shape[1]
    for k in range(first.size):
        for i in range(max(-first[k], 0), min(width, values.shape[1] - first[k])):
            cut[k, i] = values[k, first[k] + i]
