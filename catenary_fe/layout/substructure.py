"""What a pantograph is to the engines: bodies on springs, strips, and a contact law."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.theory.linkage import Linkage

Floats = NDArray[np.float64]

STOP, DAMPER, FRICTION, FRAME = range(4)  # kinds of laws
_GUIDE = 1e-3  # [kg] of a frame's coordinate where bars have its mass
BASE = -1  # number of the base, which moves along the track


@dataclass(frozen=True)
class Body:
    """A body that moves up and down, and perhaps rolls about the track's direction.

    mass : [kg]
    inertia : [kg m²] of a body that rolls; unset: it stays level
    """

    mass: float
    inertia: float | None = None


@dataclass(frozen=True)
class Joint:
    """A spring and damper between two bodies, or a body and the base.

    upper, lower : numbers of the bodies; the lower one may be ``BASE``
    stiffness, damping : [N/m], [N s/m]
    lever : [m] lateral distance of each half of the spring from the middle; the upper body rolls on them
    rising, falling : [N s/m] of a damper beside that which acts while the upper body rises or falls alone
    friction : [N] dry
    travel : [m] by which it may become shorter and longer before it meets its stops; unset: none
    stop_stiffness : [N/m] of these
    """

    upper: int
    lower: int
    stiffness: float
    damping: float
    lever: float = 0.0
    rising: float = 0.0
    falling: float = 0.0
    friction: float = 0.0
    travel: tuple[float, float] | None = None
    stop_stiffness: float = 0.0

    @property
    def laws(self) -> list[tuple[int, float, tuple[float, ...]]]:
        """What is not linear: kind, sign of the elongation that it is of, values, see :class:`Law`."""
        dampers = ((self.rising, 1.0), (self.falling, -1.0))
        found = [(DAMPER, sign, (damping,)) for damping, sign in dampers if damping]
        if self.friction:
            found.append((FRICTION, 1.0, (self.friction,)))
        stops = zip(self.travel or (), (-1.0, 1.0), strict=False)
        return found + [(STOP, sign, (limit, self.stop_stiffness)) for limit, sign in stops]


@dataclass(frozen=True)
class Law:
    """A force that is not linear, against one row of a substructure's coordinates.

    kind : ``STOP``: values (limit [m], stiffness [N/m]), pushes back beyond the limit; ``DAMPER``: (damping
        [N s/m],), while the row grows; ``FRICTION``: (force [N],); ``FRAME``: (first, step [m]), and a table
    row : shape (coordinates,), whose sum of products with them is the law's elongation
    to_base : by how much that grows with each metre that the base rises
    table : shape (points, 4), of a frame over its height: mass [kg] and force down [N] beyond the linear
        ones, each with its slope
    """

    kind: int
    row: tuple[float, ...]
    values: tuple[float, ...]
    to_base: float = 0.0
    table: tuple[tuple[float, float, float, float], ...] = ()

    def static(self, u: float) -> tuple[float, float, float]:
        """Force [N], its slope [N/m] and stored energy [J] at an elongation [m], at rest."""
        if self.kind == STOP:
            limit, stiffness = self.values
            beyond = max(u - limit, 0.0)
            return stiffness * beyond, stiffness if beyond > 0 else 0.0, stiffness * beyond**2 / 2
        if self.kind == FRAME:
            force = self._cubic(2)
            return float(force(u)), float(force(u, 1)), float(force.antiderivative()(u))
        return 0.0, 0.0, 0.0

    def push(self, u: Floats, w: Floats) -> Floats:
        """[N], shape of u and w: force at elongations [m] and their rates [m/s], where these alone decide.

        They do of stops and dampers.
        """
        if self.kind == STOP:
            limit, stiffness = self.values
            return stiffness * np.maximum(u - limit, 0.0)
        return self.values[0] * np.maximum(w, 0.0)

    def kinetic(self, u: float, w: float) -> float:
        """[J] beyond that of the linear mass, at an elongation [m] and its rate [m/s]."""
        return float(self._cubic(0)(u)) * w**2 / 2 if self.kind == FRAME else 0.0

    def _cubic(self, column: int) -> Any:
        from scipy.interpolate import CubicHermiteSpline

        first, step = self.values
        rows = np.array(self.table)
        x = first + step * np.arange(len(rows))
        return CubicHermiteSpline(x, rows[:, column], rows[:, column + 1])


@dataclass(frozen=True)
class Strip:
    """A collector strip.

    ahead : [m] of the pantograph's position
    body : number of the body that carries it; unset: none, its height is the nominal contact wire height
    """

    ahead: float = 0.0
    body: int | None = None


@dataclass(frozen=True)
class ContactLaw:
    """Force between strip and wire: max(0, preload + stiffness · depth), with a damper that never pulls.

    stiffness, damping : [N/m], [N s/m]
    preload : [N] at the depth 0
    points : pairs of the wire's height above the strip [m] and force [N], straight between, constant
        outside, in the place of the straight law
    """

    stiffness: float
    damping: float = 0.0
    preload: float = 0.0
    points: tuple[tuple[float, float], ...] = ()

    def force(self, depth: float) -> float:
        """[N] at a depth [m] of the strip above the wire, at rest."""
        if self.points:
            return float(np.interp(-depth, *np.transpose(self.points)))
        return max(0.0, self.preload + self.stiffness * depth)

    def slope(self, depth: float) -> float:
        """[N/m] derivative of :meth:`force`."""
        if not self.points:
            return self.stiffness if self.preload + self.stiffness * depth > 0 else 0.0
        heights, forces = np.transpose(self.points)
        i = int(np.searchsorted(heights, -depth, side="right"))
        inside = 0 < i < heights.size
        return float((forces[i - 1] - forces[i]) / (heights[i] - heights[i - 1])) if inside else 0.0

    def energy(self, depth: float) -> float:
        """[J] integral of :meth:`force` from the depth 0."""
        if self.points:
            heights, forces = np.transpose(self.points)
            at = np.unique([*heights[(heights - 0.0) * (heights + depth) < 0], 0.0, -depth])
            area = float(np.trapezoid(np.interp(at, heights, forces), at))
            return area if depth > 0 else -area
        if not self.stiffness:
            return self.preload * depth
        compression = max(0.0, depth + self.preload / self.stiffness)
        return self.stiffness * compression**2 / 2


@dataclass(frozen=True)
class Mechanism:
    """A frame of bars, for a model that has bodies of its own for them.

    linkage : the bars
    apex : [m] of the apex above the base pivot where the frame's coordinate is 0
    torque : [N m] that drives it, or a table over the lower arm's angle; None: a cam balances all weight
    lifted : [N] of the uplift force that torque and weights make themselves
    carried : [N] weight of what stands on the apex
    """

    linkage: Linkage
    apex: float
    torque: float | tuple[tuple[float, float], ...] | None = None
    lifted: float = 0.0
    carried: float = 0.0

    def angle(self, risen: float) -> float:
        """[rad] of the lower arm with the apex so many metres above its place at rest."""
        return self.linkage.angle_at(self.apex + risen)


@dataclass(frozen=True)
class Substructure:
    """A pantograph's equations: M ÿ + D ẏ + K y = uplift · load − contact forces · rows of the strips.

    The coordinates y count from the nominal contact wire height, where its springs are force-free: heights
    [m] of the bodies, then rolls [rad] of those that roll.

    bodies, joints : those that carry strips first
    lifted : shape (bodies,), share of each in the uplift force
    strips : collector strips
    contact : the law between each strip and a wire
    follows : whether the base's height follows the contact wire's design height, else the rail
    frame : of a frame's motion that is not linear, or None
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
        found: list[Law] = [self.frame] if self.frame else []
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

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return len(self.bodies) + len(self.rolling)

    @cached_property
    def mass(self) -> Floats:
        """M [kg] and [kg m²], shape (size, size)."""
        inertias = [self.bodies[i].inertia or 0.0 for i in self.rolling]
        return np.diag(np.array([*(body.mass for body in self.bodies), *inertias]))

    @cached_property
    def stiffness(self) -> Floats:
        """K [N/m] and [N m], shape (size, size)."""
        return self._joined([joint.stiffness for joint in self.joints])

    @cached_property
    def damping(self) -> Floats:
        """D [N s/m] and [N m s], shape (size, size)."""
        return self._joined([joint.damping for joint in self.joints])

    @cached_property
    def load(self) -> Floats:
        """Shape (size,): force on each coordinate by an uplift of 1 N."""
        return np.array([*self.lifted, *(0.0 for _ in self.rolling)])

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
                found[joint.upper] += value
        return found

    def row(self, strip: Strip, lateral: float = 0.0) -> Floats:
        """Shape (size,): the strip's height over a place [m] to the left, as made of the coordinates."""
        return self.heave(strip) + lateral * self.roll(strip)

    def heave(self, strip: Strip) -> Floats:
        """Shape (size,): the height of the strip's middle as made of the coordinates."""
        row = np.zeros(self.size)
        if strip.body is not None:
            row[strip.body] = 1.0
        return row

    def roll(self, strip: Strip) -> Floats:
        """Shape (size,): what the strip's height gains with each metre to the left."""
        row = np.zeros(self.size)
        if strip.body in self.rolling:
            row[len(self.bodies) + self.rolling.index(strip.body)] = 1.0
        return row

    def _elongation(self, joint: Joint) -> Floats:
        """Shape (size,): a joint's elongation as made of the coordinates."""
        row = np.zeros(self.size)
        row[joint.upper] = 1.0
        if joint.lower != BASE:
            row[joint.lower] = -1.0
        return row

    def _joined(self, values: list[float]) -> Floats:
        total = np.zeros((self.size, self.size))
        for joint, value in zip(self.joints, values, strict=True):
            row = self._elongation(joint)
            total += value * np.outer(row, row)
            if joint.upper in self.rolling:
                at = len(self.bodies) + self.rolling.index(joint.upper)
                total[at, at] += value * joint.lever**2
        return total
