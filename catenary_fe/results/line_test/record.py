"""What a line test measured: passes of a pantograph, each with its histories."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import numbers, whole
from catenary_fe.layout.parameters import changed_by_copy, shorten

Floats = NDArray[np.float64]
_HISTORIES = ("position", "time", "speed", "force", "height")


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class MeasuredPass:
    """One pass of a train over a line, as it was measured: histories on the train, uplifts at supports.

    name : for tables
    position : [m], shape (rows,), along the line, rising or falling all the way; None where it is not known
    time : [s], shape (rows,), ascending; None where it is not known
    speed : [m/s], shape (rows,), above 0; None where it was not measured
    force : [N], shape (rows,), of the contact; None where it was not measured
    height : [m], shape (rows,), of the contact wire at the head, above any level; None where it was not
    uplift : [m], of the contact wire against its rest, any number of values by the number of a support from 1

    Raises InputError for lists of different lengths, places and times out of order, and a force or a height
    without a place or a time.
    """

    name: str = "measured"
    position: Floats | None = None
    time: Floats | None = None
    speed: Floats | None = None
    force: Floats | None = None
    height: Floats | None = None
    uplift: Mapping[int, Floats] = field(default_factory=dict)

    def __post_init__(self) -> None:
        rows: int | None = None
        for name in _HISTORIES:
            values = getattr(self, name)
            if values is None:
                continue
            found = numbers(f"{self.name}: {name}", values)
            object.__setattr__(self, name, found)
            rows = found.size if rows is None else rows
            if found.shape != (rows,) or found.size < 2:
                raise InputError(
                    f"{self.name}: {name}: must be a list of at least 2 numbers, as many as of the others"
                )
        self._check_axes()
        if not isinstance(self.uplift, Mapping):
            raise InputError(f"{self.name}: uplift = {shorten(self.uplift)}: must be values by support")
        uplift = {}
        for number, values in self.uplift.items():
            whole(f"{self.name}: support", number, least=1)
            uplift[number] = np.atleast_1d(numbers(f"{self.name}: uplift", values))
            if not uplift[number].size:
                raise InputError(f"{self.name}: uplift of support {number} is empty")
        object.__setattr__(self, "uplift", uplift)

    def _check_axes(self) -> None:
        if self.position is None and self.time is None:
            for name in ("force", "height"):
                if getattr(self, name) is not None:
                    raise InputError(f"{self.name}: {name} has neither position nor time; add one of them")
        if self.speed is not None and not (self.speed > 0).all():
            v = self.speed[~(self.speed > 0)][0]
            raise InputError(f"{self.name}: speed = {v:g} m/s: must be above 0; leave out where it stood")
        if self.time is not None:
            self._check_order("time", "s", self.time, strict=True)
        if self.position is not None:
            way = self.position if self.position[-1] >= self.position[0] else -self.position
            self._check_order("position", "m", way, strict=self.time is None)

    def _check_order(self, name: str, unit: str, values: Floats, strict: bool) -> None:
        steps = np.diff(values)
        wrong = np.flatnonzero(steps <= 0 if strict else steps < 0)
        if wrong.size:
            i, own = int(wrong[0]) + 1, getattr(self, name)
            remedy = "sort the rows, each once" if strict else "sort the rows"
            raise InputError(
                f"{self.name}: {name} {i + 1} = {own[i]:g} {unit} after {own[i - 1]:g} {unit}: must go one"
                f" way all along; {remedy}"
            )
        if values[-1] == values[0]:
            raise InputError(f"{self.name}: {name} is {values[0]:g} {unit} all along; look at the column")

    @property
    def has_history(self) -> bool:
        """Whether there is a force or a height along the line."""
        return self.force is not None or self.height is not None


@changed_by_copy
@dataclass(frozen=True)
class LineTest:
    """What was measured on a line.

    passes : of the train
    notes : on how files were read; for a user to see

    Raises InputError where there is none, for two of one name, and where they measured different things.
    """

    passes: Sequence[MeasuredPass]
    notes: Sequence[str] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.passes, Sequence) or not all(isinstance(p, MeasuredPass) for p in self.passes):
            raise InputError(f"passes = {shorten(self.passes)}: must be a list of MeasuredPass")
        object.__setattr__(self, "passes", tuple(self.passes))
        names = [p.name for p in self.passes]
        if not names:
            raise InputError("passes is empty: give at least one MeasuredPass")
        if len(set(names)) < len(names):
            raise InputError(f"passes: {', '.join(names)}: give each a name of its own")
        for what in ("force", "height"):
            have = [getattr(p, what) is not None for p in self.passes if p.has_history]
            if any(have) and not all(have):
                name = next(p.name for p in self.passes if p.has_history and getattr(p, what) is None)
                raise InputError(f"{name}: {what} is missing, which other passes have; compare it by itself")
        if not any(p.has_history or p.uplift for p in self.passes):
            raise InputError("passes: there is no force, height or uplift among what was measured")
