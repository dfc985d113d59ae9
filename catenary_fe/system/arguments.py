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
_ROUNDED = 1e-6  # [m] by which positions may lie beyond a wire's end
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
    found = float(value) if isinstance(value, Real) and is_number else float("nan")
    low = above if above is not None else least
    in_bounds = (low is None or found > low or found == least) and (most is None or found <= most)
    if np.isfinite(found) and in_bounds:
        return found
    words = [("above", above), ("at least", least), ("at most", most)]
    bounds = " and ".join(f"{word} {bound:g}" for word, bound in words if bound is not None)
    said = f"{found:g}{' ' + unit if unit else ''}" if is_number else shorten(value)
    rule = f"must be {bounds}" if is_number and bounds else "must be a finite number"
    raise InputError(f"{name} = {said}: {rule}" + (f"; {remedy}" if remedy else ""))


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


def on_the_wire(name: str, values: object, nodes: Floats) -> Floats:
    """Positions [m] along a wire, any shape. Raises InputError for those beyond its ends.

    nodes : [m], of the wire
    """
    x, first, last = numbers(name, values), float(nodes[0]), float(nodes[-1])
    outside = (x < first - _ROUNDED) | (x > last + _ROUNDED)
    if outside.any():
        raise InputError(
            f"{name} = {x[outside][0]:g} m lies beyond the wire, which runs from {first:g} to {last:g} m"
        )
    return np.clip(x, first, last)


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
