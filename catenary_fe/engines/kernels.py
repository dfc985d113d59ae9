"""Work of a linearised run's step that concerns all coordinates: residual, solution, prediction of the next.

Generalised-α: with x the accelerations at the step's end, q = q* + b x and v = v* + g x, where q* and v* are
known, and (M + g D + b K) x = f - D v* - K q*. Functions come for one slot and for ``SLOTS`` of them.
"""

from __future__ import annotations

from catenary_fe.engines.arrays import SLOTS, CsrRows, Floats, Line, PackedRows
from catenary_fe.engines.compiled import compiled


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


@compiled
def couple_stretch_one(line: Line, q: Floats, tension: Floats, x: Floats) -> None:
    """Terms of second order: inclination lengthens gaps, and their tension works on it; added to x."""
    at, length, gap = line.stretch.at, line.stretch.length, line.stretch.gap
    for r in range(length.size):
        i, j, k, m = at[r, 0], at[r, 1], at[r, 2], at[r, 3]
        y = q[i] if i >= 0 else 0.0
        z = q[k] if k >= 0 else 0.0
        s = q[j] if j >= 0 else 0.0
        e = q[m] if m >= 0 else 0.0
        L, t = length[r], tension[gap[r]]
        across, first, last, longer = stretch_forces(L, y, s, z, e)
        if i >= 0:
            x[i] -= t * across
        if j >= 0:
            x[j] -= t * first
        if k >= 0:
            x[k] += t * across
        if m >= 0:
            x[m] -= t * last
        x[line.tensions[gap[r]]] -= longer


@compiled
def stretch_forces(L: float, y: float, s: float, z: float, e: float) -> tuple[float, float, float, float]:
    """Of an element with places y and z and slopes s and e at its ends: forces per tension, lengthening."""
    chord = y - z
    across = (36 * chord / L + 3 * (s + e)) / 30
    first = (3 * chord + 4 * L * s - L * e) / 30
    last = (3 * chord - L * s + 4 * L * e) / 30
    return across, first, last, 0.5 * (across * chord + first * s + last * e)


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


@compiled
def couple_stretch_eight(line: Line, q: Floats, tension: Floats, x: Floats) -> None:
    """Terms of second order: inclination lengthens gaps, and their tension works on it; added to x."""
    at, length, gap = line.stretch.at, line.stretch.length, line.stretch.gap
    for r in range(length.size):
        i, j, k, m = at[r, 0], at[r, 1], at[r, 2], at[r, 3]
        n, L = line.tensions[gap[r]], length[r]
        for c in range(SLOTS):
            y = q[i, c] if i >= 0 else 0.0
            z = q[k, c] if k >= 0 else 0.0
            s = q[j, c] if j >= 0 else 0.0
            e = q[m, c] if m >= 0 else 0.0
            t = tension[c, gap[r]]
            across, first, last, longer = stretch_forces(L, y, s, z, e)
            if i >= 0:
                x[i, c] -= t * across
            if j >= 0:
                x[j, c] -= t * first
            if k >= 0:
                x[k, c] += t * across
            if m >= 0:
                x[m, c] -= t * last
            x[n, c] -= longer
