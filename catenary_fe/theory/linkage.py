"""A pantograph's frame as the four-bar mechanism that it is: how it moves, and what it weighs and carries.

In the plane of x along the track and z up, the base pivot at the origin. The lower arm leads from there to
the knee, the upper arm from the knee to the apex, on which the head stands. Beyond the knee a lever of the
upper arm is held by the coupling rod, whose other end has a fixed pivot: lower arm, lever and rod make the
four-bar mechanism that leaves one degree of freedom, here the lower arm's angle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
_GRAVITY = 9.81  # [m/s²]
_SCAN = 4001  # angles of the lower arm at which the working range is looked for
_RISES = 0.5, 4.0  # of the apex with the lower arm's angle, over that arm's length: else near a dead point
_POLISH = 5  # steps of Newton's method from a neighbour in the scan: two are enough
_LEAST_RISE = 0.2  # of the upper arm's length: what rises less is no frame


@dataclass(frozen=True)
class Bar:
    """A rigid bar.

    length : [m] between its joints
    mass : [kg]
    centre : [m] of its centre of mass from its first joint, on the line to the second
    inertia : [kg m²] about its centre of mass
    """

    length: float
    mass: float = 0.0
    centre: float = 0.0
    inertia: float = 0.0


@dataclass(frozen=True)
class Pose:
    """The mechanism at angles of the lower arm, and how its parts move with that angle.

    lower, upper, rod : [rad], shape of the angles, of the bars from their first joints, anticlockwise from x
    upper_rate, rod_rate : by how much these turn with the lower arm, shape of the angles
    knee, apex, tip : [m], shape (2, ...), of the knee, the apex and the lever's end
    knee_rate, apex_rate : [m/rad], likewise, derivatives by the lower arm's angle
    """

    lower: Floats
    upper: Floats
    rod: Floats
    upper_rate: Floats
    rod_rate: Floats
    knee: Floats
    apex: Floats
    tip: Floats
    knee_rate: Floats
    apex_rate: Floats


@dataclass(frozen=True)
class Linkage:
    """A frame of lower arm (base pivot to knee), upper arm (knee to apex) and coupling rod (pivot to lever).

    lever : [m] from the knee to where the rod holds the upper arm
    lever_angle : [rad] from the upper arm's direction to the lever's, anticlockwise
    rod_pivot : [m] along the track and up, of the rod's fixed end
    apex_mass : [kg] that moves with the apex without turning: head guide and what stands on it
    """

    lower: Bar
    upper: Bar
    rod: Bar
    lever: float
    lever_angle: float
    rod_pivot: tuple[float, float]
    apex_mass: float = 0.0

    def pose(self, lower: ArrayLike, branch: int | None = None) -> Pose:
        """At angles [rad] of the lower arm, any shape; no number where the mechanism does not close.

        branch : 1 or -1, on which side of the line from knee to rod pivot the lever stands; unset: where the
            apex goes up most nearly in a straight line
        """
        angle = np.asarray(lower, dtype=float)
        side = self.branch if branch is None else branch
        knee = self.lower.length * _along(angle)
        pivot = np.reshape(self.rod_pivot, (2,) + (1,) * angle.ndim)
        to_pivot = pivot - knee
        distance = np.hypot(*to_pivot)
        with np.errstate(invalid="ignore", divide="ignore"):
            inner = np.arccos(
                (self.lever**2 + distance**2 - self.rod.length**2) / (2 * self.lever * distance)
            )
        lever = np.arctan2(to_pivot[1], to_pivot[0]) + side * inner
        upper = lever - self.lever_angle
        tip = knee + self.lever * _along(lever)
        held, knee_rate = tip - pivot, self.lower.length * _across(angle)
        with np.errstate(invalid="ignore", divide="ignore"):
            upper_rate = -(held * knee_rate).sum(axis=0) / (held * self.lever * _across(lever)).sum(axis=0)
        rod = np.arctan2(held[1], held[0])
        tip_rate = knee_rate + upper_rate * self.lever * _across(lever)
        rod_rate = (tip_rate * _across(rod)).sum(axis=0) / self.rod.length
        return Pose(
            lower=angle,
            upper=upper,
            rod=rod,
            upper_rate=upper_rate,
            rod_rate=rod_rate,
            knee=knee,
            apex=knee + self.upper.length * _along(upper),
            tip=tip,
            knee_rate=knee_rate,
            apex_rate=knee_rate + upper_rate * self.upper.length * _across(upper),
        )

    @cached_property
    def branch(self) -> int:
        """The side on which the lever stands: where the apex goes up most nearly straight."""
        return self._reach[0]

    @property
    def working(self) -> tuple[float, float]:
        """[rad] first and last angle of the lower arm between which the apex rises, from low to high.

        A lower arm that leans back falls in angle as the apex rises. Where the apex rises less than half, or
        more than four times as fast as the knee turns, the mechanism is near a dead point.
        """
        return self._reach[1]

    @cached_property
    def _reach(self) -> tuple[int, tuple[float, float]]:
        found = [(*each, side) for side in (1, -1) for each in self._runs(side)]
        if not found:
            raise ValueError("lower arm, lever and coupling rod do not close, or never lift the apex")
        _, angles, side = min(found, key=lambda each: each[0])
        return side, angles

    def _runs(self, side: int) -> Iterator[tuple[float, tuple[float, float]]]:
        """Of each range of angles in which the apex rises: its drift over its rise, and the ends."""
        angles = np.linspace(-np.pi, np.pi, _SCAN)
        pose = self.pose(angles, side)
        rises = np.nan_to_num(pose.apex_rate[1]) / self.lower.length
        slow, fast = _RISES
        for sign in (1, -1):
            for begin, end in _runs((sign * rises > slow) & (sign * rises < fast)):
                drift = np.ptp(pose.apex[0][begin : end + 1])
                gained = np.ptp(pose.apex[1][begin : end + 1])
                first, last = (begin, end)[::sign]
                if gained > _LEAST_RISE * self.upper.length:
                    yield float(drift / gained), (float(angles[first]), float(angles[last]))

    @property
    def heights(self) -> tuple[float, float]:
        """[m] of the apex above the base pivot at the ends of what the mechanism can reach."""
        low, high = (float(self.pose(angle).apex[1]) for angle in self.working)
        return low, high

    def angle_at(self, height: float) -> float:
        """[rad] of the lower arm with the apex at a height [m] above the base pivot.

        Raises ValueError for one that it does not reach.
        """
        return float(self.angles_at([height])[0])

    def angles_at(self, heights: ArrayLike) -> Floats:
        """[rad] of the lower arm with the apex at heights [m] above the base pivot, shape (heights,).

        Raises ValueError where it does not reach one.
        """
        wanted, (low, high) = np.asarray(heights, dtype=float), self.heights
        if not ((low <= wanted) & (wanted <= high)).all():
            raise ValueError(f"the apex reaches {low:.3f} to {high:.3f} m above the base pivot")
        first, last = self.working
        scan = np.linspace(first, last, _SCAN)
        found = np.interp(wanted, self.pose(scan).apex[1], scan)
        for _ in range(_POLISH):
            pose = self.pose(found)
            found = np.clip(
                found - (pose.apex[1] - wanted) / pose.apex_rate[1], min(first, last), max(first, last)
            )
        angles: Floats = found
        return angles

    def rise(self, lower: ArrayLike) -> Floats:
        """[m/rad] by which the apex rises with the lower arm's angle."""
        rise: Floats = self.pose(lower).apex_rate[1]
        return rise

    def mass(self, lower: ArrayLike) -> Floats:
        """[kg] at the apex that moves up and down as the mechanism does: M with ½ M ż² its kinetic energy."""
        pose = self.pose(lower)
        energy = self.lower.mass * self.lower.centre**2 + self.lower.inertia + 0.0 * pose.upper
        centre = pose.knee_rate + pose.upper_rate * self.upper.centre * _across(pose.upper)
        energy = energy + self.upper.mass * (centre**2).sum(axis=0) + self.upper.inertia * pose.upper_rate**2
        energy += (self.rod.mass * self.rod.centre**2 + self.rod.inertia) * pose.rod_rate**2
        energy += self.apex_mass * (pose.apex_rate**2).sum(axis=0)
        found: Floats = energy / pose.apex_rate[1] ** 2
        return found

    def weight(self, lower: ArrayLike) -> Floats:
        """[N] down at the apex that holds the bars and the apex mass up: by virtual work."""
        pose = self.pose(lower)
        work = self.lower.mass * self.lower.centre * np.cos(pose.lower)
        upper = pose.knee_rate[1] + pose.upper_rate * self.upper.centre * np.cos(pose.upper)
        work = (
            work
            + self.upper.mass * upper
            + self.rod.mass * self.rod.centre * np.cos(pose.rod) * pose.rod_rate
        )
        found: Floats = _GRAVITY * (work / pose.apex_rate[1] + self.apex_mass)
        return found

    def joint_rates(self, lower: ArrayLike) -> Floats:
        """[rad/m], shape (4, ...): turns of base pivot, knee, lever's end, rod pivot as the apex rises."""
        pose = self.pose(lower)
        turns = np.array(
            [np.ones_like(pose.upper), pose.upper_rate - 1, pose.upper_rate - pose.rod_rate, pose.rod_rate]
        )
        found: Floats = turns / pose.apex_rate[1]
        return found


def _along(angle: Floats) -> Floats:
    return np.stack([np.cos(angle), np.sin(angle)])


def _across(angle: Floats) -> Floats:
    return np.stack([-np.sin(angle), np.cos(angle)])


def _runs(good: NDArray[np.bool_]) -> Iterator[tuple[int, int]]:
    """First and last numbers of the runs of what is true."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]]).astype(int)))
    for begin, end in zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True):
        if end - begin > 1:
            yield begin, end - 1
