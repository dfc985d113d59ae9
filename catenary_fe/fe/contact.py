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
from catenary_fe.layout.bodies import Strip
from catenary_fe.layout.conditions import BaseSignal
from catenary_fe.layout.substructure import Substructure

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


_SURFACE = 0.05  # [m] between places of a running surface: ten of them in the shortest wave that matters


def surface_places(x: Floats) -> Floats:
    """[m] along a wire with nodes at x [m], where its running surface is given."""
    count = int(np.ceil((x[-1] - x[0]) / _SURFACE - 1e-6)) + 1
    places: Floats = x[0] + _SURFACE * np.arange(count)
    return places


@dataclass(frozen=True)
class EvenCurve:
    """Heights at even places [m] along the track or times [s], and cubic between them.

    first, step : the first place or time, and from one to the next
    values : shape (places, 2), heights [m], and their slopes [1] or rates [m/s]
    """

    first: float
    step: float
    values: Floats

    @classmethod
    def smooth(cls, x: Floats, heights: Floats) -> EvenCurve:
        """Through heights [m] at even places [m] or times [s]."""
        from scipy.interpolate import CubicSpline

        values = np.column_stack([heights, CubicSpline(x, heights)(x, 1)])
        return cls(float(x[0]), float(x[1] - x[0]), values)

    @classmethod
    def through(cls, x: Floats, heights: Floats) -> EvenCurve | None:
        """A smooth surface; None of an even one."""
        return cls.smooth(x, heights) if heights.any() else None

    def over(self, other: EvenCurve | None) -> EvenCurve:
        """This one on top of another at the same places."""
        return replace(self, values=self.values + other.values) if other else self

    def moved(self, along: float) -> EvenCurve:
        """The same further along the track by so many metres."""
        return replace(self, first=self.first + along)

    @cached_property
    def _curve(self) -> Any:
        from scipy.interpolate import CubicHermiteSpline

        x = self.first + self.step * np.arange(len(self.values))
        return CubicHermiteSpline(x, *self.values.T)

    def at(self, place: float) -> tuple[float, float]:
        """Height and slope at a place or time; those of the nearest end beyond them."""
        x = np.clip(place, self._curve.x[0], self._curve.x[-1])
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
    irregularity : by how much its running surface lies above its line, or None where that is even
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
    irregularity: EvenCurve | None = None

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
    base : by how much its base has moved up, over the time of a run; None where it does not
    """

    body: Substructure
    uplift: float
    position: float
    heights: Floats = field(default_factory=lambda: np.zeros(0))
    forces: Floats = field(default_factory=lambda: np.zeros(0))
    wire_heights: Floats = field(default_factory=lambda: np.zeros(0))
    base: EvenCurve | None = None


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
    motions : what moves all bases up and down beside that, in runs
    """

    x: Floats
    z: Floats
    motions: tuple[BaseSignal, ...] = ()

    @property
    def varies(self) -> bool:
        """Whether it ever leaves the nominal height."""
        return bool(self.z.any())

    def under(self, body: Substructure, position: float) -> float:
        """[m] that the base of a pantograph has risen at a place [m]; 0 where it follows the rail."""
        return float(np.interp(position, self.x, self.z)) if body.follows else 0.0

    def moving(
        self, pantographs: Sequence[PlacedPantograph], speed: float, step: float, steps: int
    ) -> list[PlacedPantograph]:
        """The same on bases that move in a run at a speed [m/s], in so many time steps [s]."""
        courses = self.courses([p.position for p in pantographs], speed, step, steps)
        return [replace(p, base=course) for p, course in zip(pantographs, courses, strict=True)]

    def courses(
        self, starts: Sequence[float] | Floats, speed: float, step: float, steps: int
    ) -> list[EvenCurve | None]:
        """How bases move up that start at places [m]; None where nothing moves them."""
        if not self.motions:
            return [None] * len(starts)
        times = step * np.arange(steps + 1.0)
        found: list[EvenCurve | None] = []
        for start in starts:
            each = [np.asarray(motion(float(start), speed, times)) for motion in self.motions]
            found.append(EvenCurve.smooth(times, np.sum(each, axis=0)))
        return found

    def height_at_rest(self, placed: PlacedPantograph) -> float:
        """[m] of a base where a run begins, above the height that it has at the nominal contact wire."""
        return self.under(placed.body, placed.position) + (placed.base.values[0, 0] if placed.base else 0.0)

    def load_at_rest(self, placed: PlacedPantograph) -> Floats:
        """[N], shape (coordinates,), of uplift and base where a run begins."""
        body = placed.body
        load: Floats = placed.uplift * body.load + self.under(body, placed.position) * body.base_load
        return load + placed.base.values[0, 0] * body.base_stiffness if placed.base else load


def place(
    pantographs: Sequence[AnyPantograph],
    uplifts: Floats,
    positions: Floats,
    *,
    spatial: bool,
    height: float | None = None,
    speed: float | None = None,
) -> list[PlacedPantograph]:
    """Pantographs with their uplifts [N] at positions [m] along the track.

    height : [m] of the contact wire above the rail; unset: that at which each pantograph works
    speed : [m/s]; None: at a standstill
    """
    return [
        PlacedPantograph(
            pantograph.assemble(spatial=spatial, height=height, speed=speed), float(uplift), float(position)
        )
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
