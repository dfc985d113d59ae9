"""Contact: the wires that a pantograph can meet, where it meets them, and what it is made of there."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import hermite
from catenary_fe.layout import AnyPantograph
from catenary_fe.layout.substructure import Strip, Substructure

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


_SURFACE = 0.05  # [m] between places of a running surface: ten of them in the shortest wave that matters


def surface_places(x: Floats) -> Floats:
    """[m] along a wire with nodes at x [m], where its running surface is given."""
    count = int(np.ceil((x[-1] - x[0]) / _SURFACE - 1e-6)) + 1
    places: Floats = x[0] + _SURFACE * np.arange(count)
    return places


@dataclass(frozen=True)
class Irregularity:
    """By how much the running surface of a contact wire lies above its axis line, over the place.

    first, step : [m] along the track: the first place, and from one to the next
    values : [m and 1], shape (places, 2), heights and their slopes; cubic between places
    """

    first: float
    step: float
    values: Floats

    @classmethod
    def through(cls, x: Floats, heights: Floats) -> Irregularity | None:
        """A smooth surface through heights [m] at even places [m]; None of an even surface."""
        from scipy.interpolate import CubicSpline

        if not heights.any():
            return None
        values = np.column_stack([heights, CubicSpline(x, heights)(x, 1)])
        return cls(float(x[0]), float(x[1] - x[0]), values)

    def over(self, other: Irregularity | None) -> Irregularity:
        """This one on top of another at the same places."""
        return replace(self, values=self.values + other.values) if other else self

    def moved(self, along: float) -> Irregularity:
        """The same further along the track by so many metres."""
        return replace(self, first=self.first + along)

    @cached_property
    def _curve(self) -> Any:
        from scipy.interpolate import CubicHermiteSpline

        x = self.first + self.step * np.arange(len(self.values))
        return CubicHermiteSpline(x, *self.values.T)

    def at(self, position: float) -> tuple[float, float]:
        """Height [m] and slope at a place [m]; that of the nearest end beyond them."""
        x = np.clip(position, self._curve.x[0], self._curve.x[-1])
        return float(self._curve(x)), float(self._curve(x, 1))


@dataclass(frozen=True)
class ContactPath:
    """A contact wire as a pantograph meets it, between its first and last node.

    x : [m], shape (nodes,), stations
    lengths : [m], shape (nodes - 1,), of the elements
    profile : [m and 1], shape (nodes, 2), height and vertical slope where it was installed
    lateral : [m and 1], shape (nodes, 2), likewise to the left
    index : shape (nodes, 2), numbers of height and vertical slope among all coordinates
    dof : shape (nodes, 2), likewise among the free ones, or FIXED
    supports : numbers of the nodes at the supports
    section : number of its tension section, from 0
    across, across_dof : as ``index`` and ``dof``, of place and slope to the left; in the plane no rows
    irregularity : of its running surface, or None where that is even
    """

    x: Floats
    lengths: Floats
    profile: Floats
    lateral: Floats
    index: Integers
    dof: Integers
    supports: Integers
    section: int = 0
    across: Integers = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    across_dof: Integers = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    irregularity: Irregularity | None = None

    def surface(self, position: float) -> tuple[float, float]:
        """[m] and slope of the running surface above the wire's line, at a place [m] along the track."""
        return self.irregularity.at(position) if self.irregularity else (0.0, 0.0)

    def meets(self, position: float) -> bool:
        """Whether a place [m] along the track lies between its ends."""
        return bool(self.x[0] <= position <= self.x[-1])

    def at(self, position: float) -> tuple[int, Floats]:
        """Number of the element at a place [m] along the track, and weights of its two heights and slopes."""
        e, share = self.locate(position)
        return e, hermite(share, self.lengths[e])

    def rest_lateral(self, position: float) -> float:
        """[m] to the left where it was installed, at a place [m] on the track; no number beyond its ends."""
        if not self.meets(position):
            return float(np.nan)
        e, weights = self.at(position)
        return float(weights @ self.lateral[e : e + 2].ravel())

    def locate(self, position: float) -> tuple[int, float]:
        """Number of the element at a place [m] along the track, and the share of its length before it."""
        e = min(max(int(np.searchsorted(self.x, position, side="right")) - 1, 0), self.x.size - 2)
        return e, float((position - self.x[e]) / (self.x[e + 1] - self.x[e]))


@dataclass(frozen=True)
class PlacedPantograph:
    """A pantograph on the line: what it is made of, its uplift [N] and its position [m] along the track.

    heights : shape (coordinates,), its coordinates at the start of a run
    forces, wire_heights : [N], [m], shape (contacts,), contact forces there, and heights of the wires above
        the nominal contact wire height
    """

    body: Substructure
    uplift: float
    position: float
    heights: Floats = field(default_factory=lambda: np.zeros(0))
    forces: Floats = field(default_factory=lambda: np.zeros(0))
    wire_heights: Floats = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True)
class Contact:
    """A collector strip on a contact wire: numbers of pantograph and wire, and where it starts [m]."""

    pantograph: int
    strip: Strip
    wire: int
    position: float


@dataclass(frozen=True)
class BaseLine:
    """What a pantograph's base follows: the contact wire's design line, straight between its points.

    x : [m], shape (points,), along the track
    z : [m], shape (points,), above the nominal contact wire height
    """

    x: Floats
    z: Floats

    @property
    def varies(self) -> bool:
        """Whether it ever leaves the nominal height."""
        return bool(self.z.any())

    def under(self, body: Substructure, position: float) -> float:
        """[m] that the base of a pantograph has risen at a place [m]; 0 where it follows the rail."""
        return float(np.interp(position, self.x, self.z)) if body.follows else 0.0


def place(
    pantographs: Sequence[AnyPantograph], uplifts: Floats, positions: Floats, *, spatial: bool
) -> list[PlacedPantograph]:
    """Pantographs with their uplifts [N] at positions [m] along the track."""
    return [
        PlacedPantograph(pantograph.assemble(spatial=spatial), float(uplift), float(position))
        for pantograph, uplift, position in zip(pantographs, uplifts, positions, strict=True)
    ]


def contacts_of(pantographs: Sequence[PlacedPantograph], wires: int) -> list[Contact]:
    """Each strip of each pantograph on each of so many contact wires, in the order of histories."""
    return [
        Contact(number, strip, wire, placed.position + strip.ahead)
        for number, placed in enumerate(pantographs)
        for strip in placed.body.strips
        for wire in range(wires)
    ]
