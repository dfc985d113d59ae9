"""Terms of second order: inclination lengthens the wire between two clamps, whose tension works on it."""

from __future__ import annotations

from catenary_fe.engines.arrays import SLOTS, Floats
from catenary_fe.engines.compiled import compiled
from catenary_fe.engines.linearised.arrays import Line


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
