"""How a value scatters: one distribution, and values by it from numbers between 0 and 1."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from catenary_fe.layout.errors import InputError
from catenary_fe.layout.parameters import NonNegative, Number, Parameters, Positive, shorten

Floats = NDArray[np.float64]
_KINDS = ("normal", "relative_normal", "uniform", "relative_uniform", "integers", "values")
_ABOUT_NOMINAL = ("normal", "relative_normal", "relative_uniform")


class Distribution(Parameters):
    """How a value scatters; give one of `normal`, `relative_normal`, `uniform`, `relative_uniform`,
    `integers` and `values`."""

    normal: NonNegative | None = None
    """[of the value] standard deviation about the nominal value"""
    relative_normal: NonNegative | None = None
    """[1] likewise, as a share of the nominal value"""
    uniform: tuple[Number, Number] | None = None
    """[of the value] lowest and highest value, all between them equally likely"""
    relative_uniform: NonNegative | None = None
    """[1] largest deviation to either side as a share of the nominal value, all equally likely"""
    integers: tuple[Annotated[int, Field(strict=True)], Annotated[int, Field(strict=True)]] | None = None
    """[1] first and last whole number, all equally likely: for seeds"""
    values: tuple[Any, ...] | None = None
    """a list of values, all equally likely"""
    truncate: Positive = 3.0
    """[1] of normal distributions: standard deviations beyond which there are no values"""
    together: Annotated[bool, Field(strict=True)] = False
    """true: one number for all members of the place; false: one for each"""

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        given = [name for name in _KINDS if getattr(self, name) is not None]
        if len(given) != 1:
            said = f"gives {' and '.join(given)}" if given else "gives no distribution"
            raise ValueError(f"{said}; give one of {', '.join(_KINDS)}")
        if "truncate" in self.model_fields_set and "normal" not in given[0]:
            raise ValueError(f"truncate has no effect beside {given[0]}; leave it out")
        for name in ("uniform", "integers"):
            ends = getattr(self, name)
            if ends is not None and ends[0] > ends[1]:
                raise ValueError(f"{name} = {list(ends)}: the first one must not be above the last one")
        if self.values is not None and not self.values:
            raise ValueError("values is empty; give at least one")
        return self

    @property
    def kind(self) -> str:
        """Name of what is given."""
        return next(name for name in _KINDS if getattr(self, name) is not None)

    def draw(self, cube: Floats, nominal: Sequence[Any], place: str) -> list[list[Any]]:
        """Values of all members, a list a sample.

        cube : shape (samples, members) or (samples, 1), numbers between 0 and 1
        nominal : of each member, None where it is unset
        place : what an error calls it

        Raises InputError where the distribution is about a nominal value that is not there.
        """
        cube = np.broadcast_to(cube, (cube.shape[0], len(nominal)))
        if self.kind in ("integers", "values"):
            return self._chosen(cube)
        if self.uniform is not None:
            low, high = self.uniform
            between: list[list[Any]] = (low + (high - low) * cube).tolist()
            return between
        middle = self._nominal(nominal, place)
        share = getattr(self, self.kind) * (np.abs(middle) if self.kind.startswith("relative") else 1.0)
        drawn: list[list[Any]] = (middle + share * self._deviations(cube)).tolist()
        return drawn

    def _chosen(self, cube: Floats) -> list[list[Any]]:
        if self.integers is not None:
            first, last = self.integers
            chosen: list[list[Any]] = (first + np.floor((last - first + 1) * cube).astype(int)).tolist()
            return chosen
        values = self.values or ()
        return [[values[int(len(values) * u)] for u in row] for row in cube]

    def _deviations(self, cube: Floats) -> Floats:
        """Shape of the cube: in standard deviations, or from -1 to 1."""
        from scipy.stats import truncnorm

        if self.relative_uniform is not None:
            return 2 * cube - 1
        found: Floats = truncnorm.ppf(cube, -self.truncate, self.truncate)
        return found

    def _nominal(self, nominal: Sequence[Any], place: str) -> Floats:
        for value in nominal:
            if isinstance(value, bool) or not isinstance(value, int | float):
                said = "has no value of its own" if value is None else f"is {shorten(value)}"
                raise InputError(
                    f"scatter: {place}: {self.kind} is about a nominal number, and the place {said}; write"
                    " one there, or take uniform, integers or values"
                )
            if value == 0 and self.kind.startswith("relative"):
                raise InputError(
                    f"scatter: {place}: the nominal value is 0, of which a share is nothing; take normal or"
                    " uniform"
                )
        return np.array(nominal, dtype=float)
