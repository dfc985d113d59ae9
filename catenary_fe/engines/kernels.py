"""Work of a linearised run's step that concerns all coordinates: residual, solution, prediction of the next.

Generalised-α: with x the accelerations at the step's end, q = q* + b x and v = v* + g x, where q* and v* are
known, and (M + g D + b K) x = f - D v* - K q*. Functions come for one slot and for ``SLOTS`` of them.
"""

from __future__ import annotations

from catenary_fe.engines.arrays import CsrRows, Floats, PackedRows
from catenary_fe.engines.compiled import compiled


@compiled
def copy(values: Floats, x: Floats) -> None:
    """x = values; as a slice it would make room for another copy, should the two overlap."""
    for i in range(x.size):
        x[i] = values[i]


@compiled
def add_loads(rows: CsrRows, signals: Floats, x: Floats) -> None:
    """Loads that vary in time, at one time; signals of shape (loads,)."""
    start, column, value = rows
    if signals.size > 0:
        for i in range(x.size):
            for m in range(start[i], start[i + 1]):
                x[i] += value[m] * signals[column[m]]


@compiled
def take_one(A: PackedRows, u: Floats, x: Floats) -> None:
    """x -= A u"""
    start, index, value, _ = A
    for k in range(start.size - 1):
        i = 4 * k
        a, b, c, d = x[i], x[i + 1], x[i + 2], x[i + 3]
        for m in range(start[k], start[k + 1]):
            p, r = u[index[m]], value[m]
            a, b, c, d = a - r[0] * p, b - r[1] * p, c - r[2] * p, d - r[3] * p
        x[i], x[i + 1], x[i + 2], x[i + 3] = a, b, c, d


@compiled
def lower_one(L: PackedRows, x: Floats, first: int, last: int) -> None:
    """Solve L y = x in place; for the groups of four rows from ``first`` to before ``last``."""
    start, index, value, inner = L
    for k in range(first, last):
        i = 4 * k
        a, b, c, d = x[i], x[i + 1], x[i + 2], x[i + 3]
        for m in range(start[k], start[k + 1]):
            p, r = x[index[m]], value[m]
            a, b, c, d = a - r[0] * p, b - r[1] * p, c - r[2] * p, d - r[3] * p
        t = inner[k]
        b -= t[0] * a
        c -= t[1] * a + t[2] * b
        d -= t[3] * a + t[4] * b + t[5] * c
        x[i], x[i + 1], x[i + 2], x[i + 3] = a, b, c, d


@compiled
def upper_one(U: PackedRows, inverse: Floats, x: Floats, first: int, last: int) -> None:
    """Solve diag(1 / inverse) Lᵀ y = x in place; for the groups from ``last`` - 1 down to ``first``."""
    start, index, value, inner = U
    for n in range(last - first):
        k = last - 1 - n
        i = 4 * k
        a, b, c, d = x[i], x[i + 1], x[i + 2], x[i + 3]
        a, b, c, d = a * inverse[i], b * inverse[i + 1], c * inverse[i + 2], d * inverse[i + 3]
        for m in range(start[k], start[k + 1]):
            p, r = x[index[m]], value[m]
            a, b, c, d = a - r[0] * p, b - r[1] * p, c - r[2] * p, d - r[3] * p
        t = inner[k]
        c -= t[5] * d
        b -= t[4] * d + t[3] * c
        a -= t[2] * d + t[1] * c + t[0] * b
        x[i], x[i + 1], x[i + 2], x[i + 3] = a, b, c, d


# eight slots are written out: so the compiler makes vectors of them


@compiled
def take_eight(A: CsrRows, u: Floats, x: Floats) -> None:
    """x -= A u"""
    start, index, value = A
    for i in range(x.shape[0]):
        r = x[i]
        a, b, c, d, e, f, g, h = r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7]
        for m in range(start[i], start[i + 1]):
            k, p = value[m], u[index[m]]
            a, b, c, d = a - k * p[0], b - k * p[1], c - k * p[2], d - k * p[3]
            e, f, g, h = e - k * p[4], f - k * p[5], g - k * p[6], h - k * p[7]
        r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7] = a, b, c, d, e, f, g, h


@compiled
def lower_eight(L: CsrRows, x: Floats) -> None:
    """Solve L y = x in place."""
    take_eight(L, x, x)  # rows that come before are solved already


@compiled
def upper_eight(U: CsrRows, inverse: Floats, x: Floats) -> None:
    """Solve diag(1 / inverse) Lᵀ y = x in place."""
    start, index, value = U
    for n in range(x.shape[0]):
        i = x.shape[0] - 1 - n
        r, v = x[i], inverse[i]
        a, b, c, d = v * r[0], v * r[1], v * r[2], v * r[3]
        e, f, g, h = v * r[4], v * r[5], v * r[6], v * r[7]
        for m in range(start[i], start[i + 1]):
            k, p = value[m], x[index[m]]
            a, b, c, d = a - k * p[0], b - k * p[1], c - k * p[2], d - k * p[3]
            e, f, g, h = e - k * p[4], f - k * p[5], g - k * p[6], h - k * p[7]
        r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7] = a, b, c, d, e, f, g, h
