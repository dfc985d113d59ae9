"""Checks of arguments from Python: one line that says what, value, rule and remedy."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from numbers import Integral, Real
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from catenary_fe.system.errors import InputError
from catenary_fe.system.parameters import shorten

Floats = NDArray[np.float64]
_Kind = TypeVar("_Kind")


def number(
    name: str,
    value: object,
    unit: str = "",
    *,
    above: float | None = None,
    least: float | None = None,
    most: float | None = None,
    remedy: str = "",
) -> float:
    """A finite number within bounds, as a float. Raises InputError."""
    is_number = isinstance(value, Real) and not isinstance(value, bool | np.bool_)
    bounds = [f"{word} {bound:g}" for word, bound in (("above", above), ("at least", least), ("at most", most))
              if bound is not None]  # fmt: skip
    good = (
        is_number
        and np.isfinite(found := float(value))  # type: ignore[arg-type]
        and (above is None or found > above)
        and (least is None or found >= least)
        and (most is None or found <= most)
    )
    if not good:
        said = f"{value:g}{' ' + unit if unit else ''}" if is_number else shorten(value)
        rule = "must be " + (" and ".join(bounds) if is_number and bounds else "a finite number")
        raise InputError(f"{name} = {said}: {rule}" + (f"; {remedy}" if remedy else ""))
    return found


def whole(name: str, value: object, *, least: int, most: int | None = None) -> int:
    """A whole number within bounds. Raises InputError."""
    found = int(value) if isinstance(value, Integral) and not isinstance(value, bool) else None
    if found is None or found < least or (most is not None and found > most):
        bounds = f"of at least {least}" if most is None else f"from {least} to {most}"
        raise InputError(f"{name} = {shorten(value)}: must be a whole number {bounds}")
    return found


def numbers(
    name: str, values: object, *, shape: tuple[int, ...] | None = None, each: str = "one each"
) -> Floats:
    """Finite numbers as an array. Raises InputError.

    shape : that the array must have; unset: any
    each : what to do where it has another one
    """
    try:
        array = np.asarray(values)
    except ValueError:  # lists of different lengths
        array = np.asarray(None)
    if array.size and array.dtype.kind not in "iuf":
        raise InputError(f"{name} = {shorten(values)}: must be numbers")
    array = array.astype(float) if array.size else np.zeros(array.shape)
    if not np.isfinite(array).all():
        raise InputError(f"{name}: {array[~np.isfinite(array)][0]} is among them: all must be finite numbers")
    if shape is not None and array.shape != shape:
        raise InputError(f"{name} has the shape {array.shape}: must have {shape}; give {each}")
    return array


def on_the_line(name: str, values: object, length: float, start: float = 0.0) -> Floats:
    """Positions [m] along a line or a wire, any shape. Raises InputError for those beyond its ends."""
    x = numbers(name, values)
    slack = 1e-6  # [m] the ends may be rounded
    outside = (x < start - slack) | (x > length + slack)
    if outside.any():
        raise InputError(
            f"{name} = {x[outside][0]:g} m lies beyond the line, which runs from {start:g} to {length:g} m"
        )
    return np.clip(x, start, length)


def span_numbers(spans: Iterable[int] | None, last: int, otherwise: Sequence[int]) -> list[int]:
    """Numbers of spans, from 1.

    last : number of the line's last span
    otherwise : what is taken where none are given

    Raises InputError for what is no list of them, and for those that the line does not have.
    """
    if spans is None:
        return list(otherwise)
    if isinstance(spans, str) or not isinstance(spans, Iterable):
        raise InputError(f"spans = {shorten(spans)}: must be a list of span numbers, such as [5, 6]")
    found = list(spans)
    if not found:
        raise InputError("spans is empty: name at least one, or leave it out")
    for value in found:
        if not isinstance(value, Integral) or isinstance(value, bool) or not 1 <= int(value) <= last:
            raise InputError(f"span {shorten(value)}: the line has spans 1 to {last}")
    return [int(value) for value in found]


def one_of(name: str, value: object, choices: Sequence[Any]) -> None:
    """Raises InputError for what is not among the choices."""
    if not isinstance(value, str) or value not in choices:
        listed = ", ".join(map(repr, choices))
        raise InputError(f"{name} = {shorten(value)}: must be one of {listed}")


def instance(name: str, value: object, kind: type[_Kind], remedy: str) -> _Kind:
    """The value, if it is of a kind. Raises InputError."""
    if not isinstance(value, kind):
        raise InputError(f"{name} = {shorten(value)}: must be a {kind.__name__}; {remedy}")
    return value
