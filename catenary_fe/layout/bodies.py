"""What a pantograph is made of for the engines: bodies, joints and their laws, strips, the contact's law."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.theory.linkage import Linkage

Floats = NDArray[np.float64]

STOP, DAMPER, FRICTION, FRAME = range(4)  # kinds of laws
ORDER = 8  # powers of the place across the track, of a strip's height
BASE = -1  # number of the base, which moves along the track


@dataclass(frozen=True)
class Mode:
    """A bending mode of a strip that a body is, hung free; its modal mass is the body's.

    frequency, ratio : [Hz], and of damping
    shape : coefficients of 1, y, y², … over the place y [m] to the left of the middle
    """

    frequency: float
    ratio: float
    shape: tuple[float, ...]

    def at(self, lateral: float) -> float:
        """Of the shape, at a place [m]."""
        return float(np.polynomial.polynomial.polyval(lateral, self.shape))


@dataclass(frozen=True)
class Body:
    """A body that moves up and down, perhaps rolls about the track's direction, pitches, bends.

    mass : [kg]
    inertia : [kg m²] of a body that rolls; unset: it stays level
    pitch_inertia : [kg m²] of a body that pitches, its front going up; unset: it does not
    modes : of bending
    """

    mass: float
    inertia: float | None = None
    pitch_inertia: float | None = None
    modes: tuple[Mode, ...] = ()


@dataclass(frozen=True)
class Joint:
    """A spring and damper between two bodies, or a body and the base.

    upper, lower : numbers of the bodies; the lower one may be ``BASE``
    stiffness, damping : [N/m], [N s/m]
    lever : [m] lateral distance of each half of the spring from the middle; the upper body rolls and bends on
        them
    reach : [m] likewise along the track; the upper body pitches on them
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
    reach: float = 0.0

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

    def push(self, risen: float) -> float:
        """[N] up of the bars by themselves, driven by the torque, at their apex there; 0 with a cam."""
        if self.torque is None:
            return 0.0
        angle, torque = self.angle(risen), self.torque
        if isinstance(torque, tuple):
            torque = float(np.interp(angle, *np.transpose(torque)))
        return float(torque / abs(self.linkage.rise(angle)) - self.linkage.weight(angle))
