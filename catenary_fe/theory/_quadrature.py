"""Gauss–Legendre quadrature of a running upper limit, vectorised over the limit."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray

Function = Callable[[FloatArray], ArrayLike]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def panel_integrals(function: Function, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Integrate `function` from `lower` to `upper`, element by element (8 Gauss points each)."""
    half = 0.5 * (upper - lower)
    points = lower[..., None] + half[..., None] * (1.0 + _NODES)
    values = np.broadcast_to(np.asarray(function(points), dtype=np.float64), points.shape)
    return np.asarray(half * (values @ _WEIGHTS))


def antiderivative(
    function: Function, lower: float, upper: float, *, panels: int = 256, breakpoints: Sequence[float] = ()
) -> Callable[[FloatArray], FloatArray]:
    """Return s ↦ ∫ from `lower` to s of `function`, for `lower` ≤ s ≤ `upper`.

    The interval is cut into equal panels, and at `breakpoints`, where the function may jump or bend.
    """
    if upper <= lower:
        return lambda s: np.zeros_like(s)
    inner = [point for point in breakpoints if lower < point < upper]
    edges = np.unique(np.concatenate([np.linspace(lower, upper, panels + 1), inner]))
    sums = np.concatenate([[0.0], np.cumsum(panel_integrals(function, edges[:-1], edges[1:]))])

    def integral(s: FloatArray) -> FloatArray:
        index = np.clip(np.searchsorted(edges, s, side="right") - 1, 0, edges.size - 2)
        return np.asarray(sums[index] + panel_integrals(function, edges[index], np.asarray(s)))

    return integral
