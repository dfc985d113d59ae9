"""Checks of what the caller passes: one line that says what, value, rule and remedy."""

from __future__ import annotations

from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray: TypeAlias = NDArray[np.float64]
ComplexArray: TypeAlias = NDArray[np.complex128]


def refuse(name: str, value: object, rule: str, remedy: str) -> ValueError:
    """Return the error to raise: ``name = value: rule; remedy``."""
    return ValueError(f"{name} = {value}: {rule}; {remedy}")


def finite(name: str, value: float, unit: str) -> float:
    """Return `value` as a float if it is a finite number."""
    number = float(value)
    if not np.isfinite(number):
        raise refuse(
            name, f"{number:g} {unit}", "must be a finite number", "look for a division by zero upstream"
        )
    return number


def positive(
    name: str, value: float, unit: str, *, remedy: str = "give it in SI units, greater than 0"
) -> float:
    """Return `value` as a float if it is finite and greater than zero."""
    number = float(value)
    if not (np.isfinite(number) and number > 0.0):
        raise refuse(name, f"{number:g} {unit}", "must be positive and finite", remedy)
    return number


def non_negative(
    name: str, value: float, unit: str, *, remedy: str = "give it in SI units, 0 or greater"
) -> float:
    """Return `value` as a float if it is finite and not below zero."""
    number = float(value)
    if not (np.isfinite(number) and number >= 0.0):
        raise refuse(name, f"{number:g} {unit}", "must be finite and not negative", remedy)
    return number


def counted(name: str, value: int, *, at_least: int = 1) -> int:
    """Return `value` if it is a whole number of at least `at_least`."""
    if int(value) != value or value < at_least:
        raise refuse(name, value, f"must be a whole number of at least {at_least}", "give more")
    return int(value)


def numbers(name: str, values: ArrayLike) -> FloatArray:
    """Return `values` as an array of finite floats."""
    array = np.asarray(values, dtype=np.float64)
    if not np.all(np.isfinite(array)):
        raise refuse(name, "nan or inf", "every entry must be finite", "remove or mask those entries")
    return array


def times(values: ArrayLike, name: str = "t") -> FloatArray:
    """Return times as an array of finite floats, none before the start."""
    array = numbers(name, values)
    if np.any(array < 0.0):
        rule = "must not be negative, the motion starts at t = 0"
        raise refuse(name, f"{array.min():g} s", rule, "shift the time axis")
    return array


def within(name: str, values: ArrayLike, lower: float, upper: float) -> FloatArray:
    """Return positions as an array, all inside the wire (rounding of the ends is forgiven)."""
    array = numbers(name, values)
    slack = 1e-9 * (upper - lower)
    outside = (array < lower - slack) | (array > upper + slack)
    if np.any(outside):
        rule = f"must lie on the wire, {lower:g} m to {upper:g} m"
        raise refuse(name, f"{array[outside].flat[0]:g} m", rule, "move the point or lengthen the wire")
    return np.clip(array, lower, upper)
