"""Work of a linearised run's step that concerns all coordinates: residual, solution, prediction of the next.

Generalised-α: with x the accelerations at the step's end, q = q* + b x and v = v* + g x, where q* and v* are
known, and (M + g D + b K) x = f - D v* - K q*. Arrays of coordinates have the shape (size,) for one slot, and
(size, SLOTS) for eight.
"""

from __future__ import annotations

from typing import Any

from catenary_fe.engines.arrays import CsrRows, Floats, PackedFactor, PackedRows
from catenary_fe.engines.compiled import compiled
from catenary_fe.engines.lanes import load, number, store


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
def take(A: PackedRows, u: Floats, x: Floats) -> None:
    """x -= A u"""
    for k in range(A.start.size - 1):
        i = 4 * k
        a, b, c, d = take_rows(A, u, k, load(x, i), load(x, i + 1), load(x, i + 2), load(x, i + 3))
        store(x, i, a)
        store(x, i + 1, b)
        store(x, i + 2, c)
        store(x, i + 3, d)


@compiled
def begin(f: Floats, A: PackedRows, u: Floats, B: PackedRows, v: Floats, x: Floats) -> None:
    """x = f - A u - B v, with the same f, shape (size,), in all slots"""
    for k in range(A.start.size - 1):
        i = 4 * k
        a, b = number(x, f[i]), number(x, f[i + 1])
        c, d = number(x, f[i + 2]), number(x, f[i + 3])
        a, b, c, d = take_rows(A, u, k, a, b, c, d)
        a, b, c, d = take_rows(B, v, k, a, b, c, d)
        store(x, i, a)
        store(x, i + 1, b)
        store(x, i + 2, c)
        store(x, i + 3, d)


@compiled
def take_rows(A: PackedRows, u: Floats, k: int, a: Any, b: Any, c: Any, d: Any) -> tuple[Any, Any, Any, Any]:
    """What four rows leave of values: less A u"""
    for m in range(A.start[k], A.start[k + 1]):
        p, r = load(u, A.column[m]), A.value[m]
        a, b, c, d = a - r[0] * p, b - r[1] * p, c - r[2] * p, d - r[3] * p
    return a, b, c, d


@compiled
def lower(A: PackedFactor, x: Floats, first: int, last: int) -> None:
    """Solve (I + V)ᵀ z = x in place; for the groups of four rows from ``first`` to before ``last``."""
    for k in range(first, last):
        i = 4 * k
        _solve_rows(A.lower, x, k, load(x, i), load(x, i + 1), load(x, i + 2), load(x, i + 3))


@compiled
def upper(A: PackedFactor, x: Floats, first: int, last: int) -> None:
    """Solve (I + V) y = S x in place; for the groups from ``last`` - 1 down to ``first``."""
    for k in range(last - 1, first - 1, -1):
        i, s = 4 * k, A.inner[k]
        p, q, r, t = load(x, i), load(x, i + 1), load(x, i + 2), load(x, i + 3)
        a = s[0] * p + s[1] * q + s[2] * r + s[3] * t
        b = s[1] * p + s[4] * q + s[5] * r + s[6] * t
        c = s[2] * p + s[5] * q + s[7] * r + s[8] * t
        d = s[3] * p + s[6] * q + s[8] * r + s[9] * t
        _solve_rows(A.upper, x, k, a, b, c, d)


@compiled
def _solve_rows(V: PackedRows, x: Floats, k: int, a: Any, b: Any, c: Any, d: Any) -> None:
    """Four rows less what is solved already, in two sums: each waits for the last of it half as often."""
    i, nothing = 4 * k, number(x, 0.0)
    e, f, g, h = nothing, nothing, nothing, nothing
    for m in range(V.start[k], V.start[k + 1], 2):
        p, r = load(x, V.column[m]), V.value[m]
        a, b, c, d = a - r[0] * p, b - r[1] * p, c - r[2] * p, d - r[3] * p
        p, r = load(x, V.column[m + 1]), V.value[m + 1]
        e, f, g, h = e + r[0] * p, f + r[1] * p, g + r[2] * p, h + r[3] * p
    store(x, i, a - e)
    store(x, i + 1, b - f)
    store(x, i + 2, c - g)
    store(x, i + 3, d - h)
