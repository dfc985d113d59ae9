"""Checks of arguments, one line that says what, value, rule and remedy; and quadrature."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray: TypeAlias = NDArray[np.float64]
ComplexArray: TypeAlias = NDArray[np.complex128]
Function: TypeAlias = Callable[[FloatArray], ArrayLike]
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def refuse(name: str, value: object, rule: str, remedy: str) -> ValueError:
    """The error to raise: ``name = value: rule; remedy``."""
    return ValueError(f"{name} = {value}: {rule}; {remedy}")


def finite(
    name: str,
    value: float,
    unit: str,
    *,
    least: float = -np.inf,
    rule: str = "must be a finite number",
    remedy: str = "look for a division by zero upstream",
) -> float:
    """The value as a float, if it is finite and not below the least."""
    number = float(value)
    if not (np.isfinite(number) and number >= least):
        raise refuse(name, f"{number:g} {unit}", rule, remedy)
    return number


def positive(name: str, value: float, unit: str, *, remedy: str = "use SI units, greater than 0") -> float:
    """The value as a float, if it is finite and above zero."""
    above = float(np.nextafter(0.0, 1.0))
    return finite(name, value, unit, least=above, rule="must be positive and finite", remedy=remedy)


def non_negative(name: str, value: float, unit: str) -> float:
    """The value as a float, if it is finite and not below zero."""
    rule, remedy = "must be finite and not negative", "use SI units, 0 or greater"
    return finite(name, value, unit, least=0.0, rule=rule, remedy=remedy)


def counted(name: str, value: int, *, at_least: int = 1) -> int:
    """The value, if it is a whole number of at least so many."""
    if int(value) != value or value < at_least:
        raise refuse(name, value, f"must be a whole number of at least {at_least}", "use more")
    return int(value)


def numbers(name: str, values: ArrayLike) -> FloatArray:
    """The values as an array of finite floats."""
    try:
        array = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise refuse(name, values, "must be numbers", "pass the wire first, then arrays") from None
    if not np.all(np.isfinite(array)):
        raise refuse(name, "nan or inf", "every entry must be finite", "remove or mask those entries")
    return array


def times(values: ArrayLike) -> FloatArray:
    """Times as an array of finite floats, none before the start."""
    array = numbers("t", values)
    if np.any(array < 0.0):
        rule = "must not be negative, the motion starts at t = 0"
        raise refuse("t", f"{array.min():g} s", rule, "shift the time axis")
    return array


def within(name: str, values: ArrayLike, lower: float, upper: float) -> FloatArray:
    """Positions as an array, all on the wire (rounding at the ends is forgiven)."""
    array = numbers(name, values)
    slack = 1e-9 * (upper - lower)
    outside = (array < lower - slack) | (array > upper + slack)
    if np.any(outside):
        rule = f"must lie on the wire, {lower:g} m to {upper:g} m"
        raise refuse(name, f"{array[outside].flat[0]:g} m", rule, "move the point or lengthen the wire")
    return np.clip(array, lower, upper)


def antiderivative(
    function: Function, lower: float, upper: float, *, panels: int = 256, breakpoints: Sequence[float] = ()
) -> Callable[[FloatArray], FloatArray]:
    """s ↦ ∫ of a function from ``lower`` to s, for ``lower`` ≤ s ≤ ``upper``: 8 Gauss points a panel.

    breakpoints : where the function jumps or bends, and the panels are cut
    """
    if upper <= lower:
        return lambda s: np.zeros_like(s)
    inner = [point for point in breakpoints if lower < point < upper]
    edges = np.unique(np.concatenate([np.linspace(lower, upper, panels + 1), inner]))
    sums = np.concatenate([[0.0], np.cumsum(_panel_integrals(function, edges[:-1], edges[1:]))])

    def integral(s: FloatArray) -> FloatArray:
        index = np.clip(np.searchsorted(edges, s, side="right") - 1, 0, edges.size - 2)
        return np.asarray(sums[index] + _panel_integrals(function, edges[index], np.asarray(s)))

    return integral


def _panel_integrals(function: Function, lower: FloatArray, upper: FloatArray) -> FloatArray:
    """Integrals from ``lower`` to ``upper``, element by element."""
    half = 0.5 * (upper - lower)
    points = lower[..., None] + half[..., None] * (1.0 + _NODES)
    values = np.broadcast_to(np.asarray(function(points), dtype=np.float64), points.shape)
    return np.asarray(half * (values @ _WEIGHTS))
