"""Newton's method on an energy, the step shortened where it would raise it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.system import System

Floats = NDArray[np.float64]

_ITERATIONS, _LEAST_STEP = 60, 1e-4
_SETTLED = 1e-9  # of the largest force on a coordinate; rounding of EA ε leaves 1e-5 N
_FLOOR = 1e-4  # [N]


def minimise(
    x: Floats,
    residual: Callable[[Floats], Floats],
    tangent: Callable[[Floats], Any],
    energy: Callable[[Floats], float],
    floor: float,
) -> tuple[Floats, bool]:
    """Coordinates with the least energy, from a first guess, and whether they were found.

    x : shape (size,)
    residual : forces out of balance, less the derivative of the energy, shape (size,)
    tangent : its second derivative, sparse
    floor : [N] out of balance that is good enough
    """
    from scipy.sparse.linalg import splu

    for _ in range(_ITERATIONS):
        out = residual(x)
        if not np.isfinite(out).all():
            break
        if np.abs(out).max(initial=0.0) <= floor:
            return x, True
        try:
            step = splu(tangent(x).tocsc()).solve(out)
        except RuntimeError:  # singular
            break
        before, slope, share = energy(x), float(out @ step), 1.0
        while share > _LEAST_STEP:
            rise = energy(x + share * step) - before
            if rise <= -1e-4 * share * slope + 1e-11 * abs(before):
                break
            share /= 2
        x = x + share * step
    return x, False


def force_floor(system: System, load: Floats) -> float:
    """[N] out of balance that counts as equilibrium.

    load : [N], shape (all,), besides the constant forces
    """
    return max(_FLOOR, _SETTLED * float(np.abs(system.force + load).max()))
