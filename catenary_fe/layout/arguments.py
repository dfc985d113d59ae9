"""Checks of arguments from Python: one line that says what, value, rule and remedy."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterable, Sequence
from functools import cached_property, wraps
from numbers import Integral, Real
from typing import Any, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout.errors import InputError
from catenary_fe.layout.parameters import shorten

Floats = NDArray[np.float64]
_ROUNDED = 1e-6  # [m] by which positions may lie beyond a wire's end
_Given = ParamSpec("_Given")
_Result = TypeVar("_Result")


def fixed_array(function: Callable[[Any], NDArray[Any]]) -> cached_property[NDArray[Any]]:
    """A property that is computed once, an array that nobody can change in place."""

    @wraps(function)
    def compute(owner: Any) -> NDArray[Any]:
        array = function(owner)
        array.setflags(write=False)
        return array

    return cached_property(compute)


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


def runs(numbers: Iterable[int]) -> list[tuple[int, int]]:
    """First and last of each run of consecutive numbers."""
    found: list[tuple[int, int]] = []
    for n in sorted(set(numbers)):
        if found and n == found[-1][1] + 1:
            found[-1] = (found[-1][0], n)
        else:
            found.append((n, n))
    return found


def listed(numbers: Iterable[int]) -> str:
    """``2, 3`` or ``5 to 14, 16``: how texts list numbers of spans; three and more in a row are shortened."""
    parts = [
        f"{first} to {last}" if last - first > 1 else ", ".join(map(str, range(first, last + 1)))
        for first, last in runs(numbers)
    ]
    return ", ".join(parts)


def one_of(name: str, value: object, choices: Sequence[Any]) -> None:
    """Raises InputError for what is not among the choices."""
    if not isinstance(value, str) or value not in choices:
        listed = ", ".join(map(repr, choices))
        raise InputError(f"{name} = {shorten(value)}: must be one of {listed}")


def instance(name: str, value: object, kind: type[Any], remedy: str) -> None:
    """Raises InputError for a value that is not of a kind."""
    if not isinstance(value, kind):
        raise InputError(f"{name} = {shorten(value)}: must be a {kind.__name__}; {remedy}")


_OBJECTS = {  # by the name of their class: what they are, and where to get one
    "Catenary": ("a Catenary", "load_catenary reads a file"),
    "Shape": ("a static shape", "give find_form(catenary)"),
    "ExudynModel": ("a multibody model", "exudyn_model(shape, pantographs) builds one"),
    "Run": ("a run", "simulate makes one, load_run reads one"),
    "LineTest": ("a line test", "read_line_test reads files, LineTest(passes=[...]) makes one"),
    "LineTestComparison": ("a comparison with a line test", "compare_with_line_test makes one"),
    "PantographResponse": ("the response of a pantograph", "pantograph_response(pantograph) gives it"),
    "Study": ("a Study", "load_study reads a file"),
    "DesignProblem": ("a design problem", "DesignProblem(study, folder=...) makes one"),
    "Optimum": ("what optimise found", "optimise(problem) gives it"),
    "Modes": ("modes of a line", "give solve_modes(shape)"),
    "MeshSettings": ("MeshSettings", "give MeshSettings(contact_wire_element=...), or leave it out"),
    "TimeSettings": ("TimeSettings", "give TimeSettings(step=...), or leave it out"),
    "Wire": ("a Wire", "library.wire(name, tension=...) gives one"),
    "Support": ("a Support", "give Support(...)"),
    "SteadyArm": ("a SteadyArm", "give SteadyArm(stiffness=...) or SteadyArm(length=...)"),
    "Pantograph": ("a Pantograph", "such as library.pantograph('DSA250')"),
    "WireProblem": ("a WireProblem", "give WireProblem(wire=..., x=...)"),
}
_UNIONS = {
    "DescribedPantograph": ("Pantograph", "ElasticPantograph", "ReceptancePantograph", "LinkagePantograph"),
    "AnyPantograph": (
        "Pantograph",
        "ElasticPantograph",
        "ReceptancePantograph",
        "LinkagePantograph",
        "AttachedPantograph",
    ),
}
_PLAIN: dict[str, tuple[str, Callable[[Any], bool]]] = {
    "float": ("a number", lambda v: isinstance(v, Real) and not isinstance(v, bool | np.bool_)),
    "int": ("a whole number", lambda v: isinstance(v, Integral) and not isinstance(v, bool)),
    "bool": ("true or false", lambda v: isinstance(v, bool | np.bool_)),
    "str": ("a text", lambda v: isinstance(v, str)),
    "Path": ("a path", lambda v: isinstance(v, os.PathLike)),
    "Progress": ("a function", callable),
    "Callable[[float], None]": ("a function", callable),
}
_NUMBERS = {"ArrayLike", "Floats", "NDArray[np.float64]", "Sequence[float]"}


def checked(function: Callable[_Given, _Result]) -> Callable[_Given, _Result]:
    """Refuse arguments that are not what the annotations say, before the function meets them.

    Of annotations that are not known here, the function itself must check the values. Raises InputError.
    """
    parameters = inspect.signature(function).parameters
    names = [name for name, p in parameters.items() if p.kind <= p.POSITIONAL_OR_KEYWORD]
    kinds = {
        name: str(parameter.annotation).split(" | ")
        for name, parameter in parameters.items()
        if parameter.annotation is not parameter.empty
    }

    @wraps(function)
    def call(*args: _Given.args, **kwargs: _Given.kwargs) -> _Result:
        for name, value in (*zip(names, args, strict=False), *kwargs.items()):
            if name in kinds and not (value is None and "None" in kinds[name]):
                _check_kind(name, value, kinds[name])
        return function(*args, **kwargs)

    return call


def _check_kind(name: str, value: object, kinds: Sequence[str]) -> None:
    rules, remedy = [], ""
    for kind in kinds:
        if kind in _NUMBERS:
            numbers(name, value)
            return
        if kind in _PLAIN:
            rule, holds = _PLAIN[kind]
            if holds(value):
                return
            rules.append(rule)
            continue
        for owner in _UNIONS.get(kind, (kind,)):
            if any(base.__name__ == owner for base in type(value).__mro__):
                return
            if owner in _OBJECTS:
                rules.append(_OBJECTS[owner][0])
                remedy = f"; {_OBJECTS[owner][1]}"
            elif kind not in _UNIONS and kind != "None":
                return
    raise InputError(f"{name} = {shorten(value)}: must be {' or '.join(rules)}{remedy}")
