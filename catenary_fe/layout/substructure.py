"""What a pantograph is to the engines: the equations of its bodies on springs, and its strips."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout.bodies import BASE, ORDER, Body, ContactLaw, Joint, Law, Mechanism, Mode, Strip

Floats = NDArray[np.float64]

_GUIDE = 1e-3  # [kg] of a frame's coordinate where bars have its mass


@dataclass(frozen=True)
class Substructure:
    """A pantograph's equations: M ÿ + D ẏ + K y = uplift · load − contact forces · rows of the strips.

    The coordinates y count from the nominal contact wire height, where its springs are force-free: heights
    [m] of the bodies, rolls [rad] of those that roll, pitches [rad] of those that pitch, and bending [m] of
    those that bend, mode by mode.

    bodies, joints : those that carry strips first
    lifted : shape (bodies,), share of each in the uplift force
    strips : collector strips
    contact : the law between each strip and a wire
    follows : whether the base's height follows the contact wire's design height, else the rail
    frame : of a frame's motion that is not linear, whose row is one of the bodies, or None
    mechanism : of what that frame is made, or None
    """

    bodies: tuple[Body, ...]
    joints: tuple[Joint, ...]
    lifted: tuple[float, ...]
    strips: tuple[Strip, ...]
    contact: ContactLaw
    follows: bool = True
    frame: Law | None = None
    mechanism: Mechanism | None = None

    @cached_property
    def guide(self) -> int:
        """Number of a frame's coordinate; -1 without a frame."""
        return self.frame.row.index(1.0) if self.frame else -1

    def beside_bars(self) -> Substructure:
        """The same without the frame's mass and spring, where its mechanism has bodies of its own."""
        bodies = [Body(_GUIDE) if n == self.guide else body for n, body in enumerate(self.bodies)]
        joints = [
            replace(joint, stiffness=0.0) if (joint.upper, joint.lower) == (self.guide, BASE) else joint
            for joint in self.joints
        ]
        return replace(self, bodies=tuple(bodies), joints=tuple(joints))

    @cached_property
    def laws(self) -> tuple[Law, ...]:
        """What is not linear."""
        found: list[Law] = []
        if self.frame:
            rest = (0.0,) * (self.size - len(self.frame.row))
            found.append(replace(self.frame, row=(*self.frame.row, *rest)))
        for joint in self.joints:
            row = self._elongation(joint)
            grounded = float(joint.lower == BASE)
            found += [
                Law(kind, tuple((sign * row).tolist()), values, -sign * grounded)
                for kind, sign, values in joint.laws
            ]
        return tuple(found)

    def static_laws(self, y: Floats, risen: float = 0.0) -> tuple[Floats, Floats, float]:
        """What laws add at rest: forces against the coordinates, their tangent, and stored energy [J].

        y : shape (size,), coordinates
        risen : [m] of the base

        Returns arrays of shape (size,) and (size, size).
        """
        force, tangent, energy = np.zeros(self.size), np.zeros((self.size, self.size)), 0.0
        for law in self.laws:
            row = np.array(law.row)
            pull, slope, stored = law.static(float(row @ y) + law.to_base * risen)
            force += pull * row
            tangent += slope * np.outer(row, row)
            energy += stored
        return force, tangent, energy

    def energy(self, y: Floats, w: Floats, risen: float = 0.0) -> float:
        """[J] kinetic and stored, at coordinates and their rates, shape (size,) both.

        risen : [m] of the base, which moves stops; springs count as if it had not
        """
        linear = float((w @ self.mass @ w + y @ self.stiffness @ y) / 2)
        moving = sum(law.kinetic(float(np.dot(law.row, y)), float(np.dot(law.row, w))) for law in self.laws)
        return linear + moving + self.static_laws(y, risen)[2]

    @cached_property
    def rolling(self) -> tuple[int, ...]:
        """Numbers of the bodies that roll."""
        return tuple(i for i, body in enumerate(self.bodies) if body.inertia is not None)

    @cached_property
    def pitching(self) -> tuple[int, ...]:
        """Numbers of the bodies that pitch."""
        return tuple(i for i, body in enumerate(self.bodies) if body.pitch_inertia is not None)

    @cached_property
    def bending(self) -> tuple[tuple[int, Mode], ...]:
        """Numbers of the bodies that bend, each with one of its modes."""
        return tuple((i, mode) for i, body in enumerate(self.bodies) for mode in body.modes)

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.bodies) + len(self.rolling) + len(self.pitching) + len(self.bending)

    def roll_of(self, body: int) -> int:
        """Number of a rolling body's roll among the coordinates."""
        return len(self.bodies) + self.rolling.index(body)

    def pitch_of(self, body: int) -> int:
        """Number of a pitching body's pitch among the coordinates."""
        return len(self.bodies) + len(self.rolling) + self.pitching.index(body)

    def modes_of(self, body: int) -> list[tuple[int, Mode]]:
        """A body's modes, each with its number among the coordinates."""
        first = len(self.bodies) + len(self.rolling) + len(self.pitching)
        return [(first + n, mode) for n, (owner, mode) in enumerate(self.bending) if owner == body]

    @cached_property
    def mass(self) -> Floats:
        """M [kg] and [kg m²], shape (size, size)."""
        inertias = [self.bodies[i].inertia or 0.0 for i in self.rolling]
        inertias += [self.bodies[i].pitch_inertia or 0.0 for i in self.pitching]
        modal = [self.bodies[i].mass for i, _ in self.bending]
        return np.diag(np.array([*(body.mass for body in self.bodies), *inertias, *modal]))

    @cached_property
    def stiffness(self) -> Floats:
        """K [N/m] and [N m], shape (size, size)."""
        own = [self.bodies[i].mass * (2 * np.pi * mode.frequency) ** 2 for i, mode in self.bending]
        return self._joined([joint.stiffness for joint in self.joints]) + self._of_modes(own)

    @cached_property
    def damping(self) -> Floats:
        """D [N s/m] and [N m s], shape (size, size)."""
        own = [2 * mode.ratio * self.bodies[i].mass * 2 * np.pi * mode.frequency for i, mode in self.bending]
        return self._joined([joint.damping for joint in self.joints]) + self._of_modes(own)

    def _of_modes(self, values: list[float]) -> Floats:
        return np.diag(np.concatenate([np.zeros(self.size - len(values)), values]))

    @cached_property
    def load(self) -> Floats:
        """Shape (size,): force on each coordinate by an uplift of 1 N."""
        return np.array([*self.lifted, *(0.0 for _ in range(self.size - len(self.bodies)))])

    @cached_property
    def base_load(self) -> Floats:
        """[N/m], shape (size,): force on each coordinate for each metre that the followed height has risen.

        Of the springs alone: a frame keeps its force over its working range, but its dampers feel it move.
        """
        return self.base_stiffness * self.follows

    @cached_property
    def base_stiffness(self) -> Floats:
        """[N/m], shape (size,): of the springs to the base, on each coordinate."""
        return self._to_base([joint.stiffness for joint in self.joints])

    @cached_property
    def base_damping(self) -> Floats:
        """[N s/m], shape (size,): of the dampers to the base, on each coordinate."""
        return self._to_base([joint.damping for joint in self.joints])

    def _to_base(self, values: list[float]) -> Floats:
        found = np.zeros(self.size)
        for joint, value in zip(self.joints, values, strict=True):
            if joint.lower == BASE:
                found += value * self._elongation(joint)
        return found

    def row(self, strip: Strip, lateral: float = 0.0) -> Floats:
        """Shape (size,): the strip's height over a place [m] to the left, as made of the coordinates."""
        found: Floats = self.shape(strip) @ lateral ** np.arange(ORDER)
        return found

    def shape(self, strip: Strip) -> Floats:
        """Shape (size, 8): the strip's height as made of the coordinates, by powers of its place."""
        found, body = np.zeros((self.size, ORDER)), strip.body
        if body is None:
            return found
        found[body, 0] = 1.0
        if body in self.rolling:
            found[self.roll_of(body), 1] = 1.0
        if body in self.pitching:
            found[self.pitch_of(body), 0] = strip.ahead
        for at, mode in self.modes_of(body):
            found[at, : len(mode.shape)] = mode.shape
        return found

    @property
    def powers(self) -> int:
        """How many of the powers of the place across the track the heights of its strips have."""
        return ORDER if self.bending else 2 if self.rolling else 1

    def _elongation(self, joint: Joint) -> Floats:
        """Shape (size,): a joint's mean elongation as made of the coordinates."""
        row = np.zeros(self.size)
        row[joint.upper] = 1.0
        if joint.lower != BASE:
            row[joint.lower] = -1.0
        for at, mode in self.modes_of(joint.upper):
            row[at] = (mode.at(joint.lever) + mode.at(-joint.lever)) / 2
        return row

    def _tilt(self, joint: Joint) -> Floats:
        """Shape (size,): half the difference of the elongations of its two halves, left less right."""
        row = np.zeros(self.size)
        if joint.upper in self.rolling:
            row[self.roll_of(joint.upper)] = joint.lever
        for at, mode in self.modes_of(joint.upper):
            row[at] = (mode.at(joint.lever) - mode.at(-joint.lever)) / 2
        return row

    def _joined(self, values: list[float]) -> Floats:
        total = np.zeros((self.size, self.size))
        for joint, value in zip(self.joints, values, strict=True):
            for row in (self._elongation(joint), self._tilt(joint)):
                total += value * np.outer(row, row)
            if joint.upper in self.pitching:
                at = self.pitch_of(joint.upper)
                total[at, at] += value * joint.reach**2
        return total
