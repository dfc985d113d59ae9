"""Force laws that Exudyn runs in C++: springs that act one way only.

A function object serves all connectors of its law in a system, which keeps it alive.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout.bodies import DAMPER, FRICTION, STOP, ContactLaw, Joint
from catenary_fe.layout.substructure import Substructure

Floats = NDArray[np.float64]

SLIDES = 1e-3  # [m/s] from which on dry friction has its full force in Exudyn's runs


def tension_only(mbs: exu.MainSystem) -> object:
    """The law of droppers."""

    def pull(mbs, t, itemNumber, deltaL, deltaL_t, stiffness, damping, force):  # type: ignore[no-untyped-def]
        spring = exu.symbolic.max(exu.symbolic.Real(0.0), stiffness * deltaL)
        return _damped(spring, damping * deltaL_t)

    return _in_cpp(mbs, pull, "ObjectConnectorSpringDamper", "tension only")


def push_only(mbs: exu.MainSystem, up: int, contact: ContactLaw) -> object:
    """The law of contacts between strips and wires, upwards.

    up : number of the vertical axis

    Stiffness and damping are the connector's, upright; preload and points are in the law. The connector's
    damping along the track, which has no use here, holds what the wire's inclination adds to its velocity as
    the strip sees it. Its offset, by which the running surface lies above the wire's line, Exudyn takes off.
    """
    zero = exu.symbolic.Real(0.0)

    def push(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):  # type: ignore[no-untyped-def]
        depth = displacement[up]
        if contact.points:
            spring = exu.symbolic.Real(contact.points[0][1])
            for height, change in _corners(contact.points):
                spring = spring + change * exu.symbolic.max(zero, -depth - height)
        else:
            spring = exu.symbolic.max(zero, contact.preload + stiffness[up] * depth)
        force = [zero, zero, zero]
        force[up] = _damped(spring, damping[up] * (velocity[up] - damping[0]))
        return force

    name = f"push only {up} {contact.preload} {contact.points}"
    return _in_cpp(mbs, push, "ObjectConnectorCartesianSpringDamper", name)


def joint_law(mbs: exu.MainSystem, joint: Joint) -> object:
    """What a pantograph's joint has beside spring and damper: stops, a damper that differs, dry friction.

    Friction grows with the velocity up to ``SLIDES``, where it has its full force: Newton's method knows no
    standstill. The connector's displacement is the lower end's above the upper one's. Its stiffness and
    damping, which have no use here, hold by how much and how fast the base moves up.
    """
    zero = exu.symbolic.Real(0.0)

    def pull(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):  # type: ignore[no-untyped-def]
        shorter, rate, force = displacement + stiffness, velocity + damping, zero
        for kind, sign, values in joint.laws:
            if kind == STOP:
                force = force - sign * values[1] * exu.symbolic.max(zero, -sign * shorter - values[0])
            elif kind == DAMPER:
                force = force - sign * values[0] * exu.symbolic.max(zero, -sign * rate)
            else:
                most = exu.symbolic.Real(values[0])
                force = force + exu.symbolic.max(-most, exu.symbolic.min(most, rate * (values[0] / SLIDES)))
        return force

    return _in_cpp(mbs, pull, "ObjectConnectorCoordinateSpringDamper", f"joint {joint.laws}")


def drag_of_laws(body: Substructure, w: Floats, rate: float) -> Floats:
    """[N], shape (coordinates,): of dampers that differ and friction, at these rates and the base's [m/s]."""
    drag = np.zeros(body.size)
    for law in body.laws:
        row = np.array(law.row)
        moved = np.array(row @ w + law.to_base * rate)
        if law.kind == DAMPER:
            drag += float(law.push(moved, moved)) * row
        elif law.kind == FRICTION:
            drag += law.values[0] * float(np.clip(moved / SLIDES, -1.0, 1.0)) * row
    return drag


def _damped(spring: Any, damper: Any) -> Any:
    """A one-sided spring with a damper, whose part is at most the spring's.

    So the force is continuous where the spring goes slack, which Newton's method needs, and keeps its sense.
    """
    return spring + exu.symbolic.max(-spring, exu.symbolic.min(spring, damper))


def _corners(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Heights of a law's points, and the change of its slope there; before and after them it is constant."""
    heights, forces = np.transpose(points)
    slopes = np.diff(forces) / np.diff(heights)
    return list(zip(heights.tolist(), np.diff([0.0, *slopes, 0.0]).tolist(), strict=True))


def _in_cpp(mbs: exu.MainSystem, law: Callable[..., Any], kind: str, name: str) -> object:
    from exudyn.advancedUtilities import CreateSymbolicUserFunction

    if name not in dict(mbs.variables):
        function = CreateSymbolicUserFunction(mbs, law, "springForceUserFunction", itemTypeName=kind)
        mbs.variables[name] = function
    return mbs.variables[name]
