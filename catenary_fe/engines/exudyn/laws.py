"""Force laws that Exudyn runs in C++: springs that act one way only.

A function object serves all connectors of its kind in a system, which keeps it alive.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import exudyn as exu
import numpy as np

from catenary_fe.layout.substructure import ContactLaw


def one_sided(stretch: Any, rate: Any, stiffness: Any, damping: Any) -> Any:
    """Symbolic force of a spring and damper that act one way only.

    The damper's part is at most the spring's: the force is continuous where the spring goes slack, which
    Newton's method needs, and never turns round.
    """
    symbolic = exu.symbolic
    spring = symbolic.max(symbolic.Real(0.0), stiffness * stretch)
    return spring + symbolic.max(-spring, symbolic.min(spring, damping * rate))


def dropper_function(mbs: exu.MainSystem) -> object:
    """The law of droppers: tension only."""
    return _in_cpp(mbs, _tension_only, "ObjectConnectorSpringDamper")


def contact_function(mbs: exu.MainSystem, axes: int) -> object:
    """The law of contact between head and wire: push only, upwards."""
    law = _push_only_in_plane if axes == 2 else _push_only_in_space
    return _in_cpp(mbs, law, "ObjectConnectorCartesianSpringDamper")


def elastic_function(mbs: exu.MainSystem, axes: int) -> object:
    """The law of elastic pantographs: a force that falls as the wire rises, never pulling."""
    law = _slacken_in_plane if axes == 2 else _slacken_in_space
    return _in_cpp(mbs, law, "ObjectConnectorCartesianSpringDamper")


def _in_cpp(mbs: exu.MainSystem, law: Callable[..., Any], kind: str, name: str = "") -> object:
    from exudyn.advancedUtilities import CreateSymbolicUserFunction

    name = name or law.__name__
    if name not in dict(mbs.variables):
        function = CreateSymbolicUserFunction(mbs, law, "springForceUserFunction", itemTypeName=kind)
        mbs.variables[name] = function
    return mbs.variables[name]


def _tension_only(mbs, t, itemNumber, deltaL, deltaL_t, stiffness, damping, force):  # type: ignore[no-untyped-def]
    return one_sided(deltaL, deltaL_t, stiffness, damping)


# The laws below are upright: damping[0], the damping along the track, has no use in them and holds another
# number. (The offset, which would be the place for it, is taken off the displacement.) For contact it is
# what the wire's inclination adds to its velocity as seen by the head; for an elastic pantograph the force at
# the nominal height, from which the displacement counts. Exudyn's compiler of symbolic functions knows no
# closures: the axis must stand in each law.


def _push_only_in_plane(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):  # type: ignore[no-untyped-def]
    push = one_sided(displacement[1], velocity[1] - damping[0], stiffness[1], damping[1])
    return [0.0, push, 0.0]


def _push_only_in_space(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):  # type: ignore[no-untyped-def]
    push = one_sided(displacement[2], velocity[2] - damping[0], stiffness[2], damping[2])
    return [0.0, 0.0, push]


def _slacken_in_plane(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):  # type: ignore[no-untyped-def]
    push = exu.symbolic.max(exu.symbolic.Real(0.0), damping[0] + stiffness[1] * displacement[1])
    return [0.0, push, 0.0]


def _slacken_in_space(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):  # type: ignore[no-untyped-def]
    push = exu.symbolic.max(exu.symbolic.Real(0.0), damping[0] + stiffness[2] * displacement[2])
    return [0.0, 0.0, push]


def tension_only(mbs: exu.MainSystem) -> object:
    """The law of droppers, one function for all of them."""
    return dropper_function(mbs)


def push_only(mbs: exu.MainSystem, up: int, contact: ContactLaw) -> object:
    """The law of contacts between strips and wires that have this one in common: push only, upwards.

    up : number of the vertical axis

    Stiffness and damping are the connector's, upright. Its damping along the track, which has no use here,
    holds what the wire's inclination adds to its velocity as the strip sees it.
    """
    symbolic = exu.symbolic
    zero = symbolic.Real(0.0)

    def push(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):  # type: ignore[no-untyped-def]
        depth = displacement[up]
        if contact.points:
            spring = symbolic.Real(contact.points[0][1])
            for height, change in _kinks(contact.points):
                spring = spring + change * symbolic.max(zero, -depth - height)
        else:
            spring = symbolic.max(zero, contact.preload + stiffness[up] * depth)
        rate = velocity[up] - damping[0]
        force = [zero, zero, zero]
        force[up] = spring + symbolic.max(-spring, symbolic.min(spring, damping[up] * rate))
        return force

    name = f"push {up} {contact.preload} {contact.points}"
    return _in_cpp(mbs, push, "ObjectConnectorCartesianSpringDamper", name)


def _kinks(points: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """Places of a law of points, and the change of its slope there; before and after them it is constant."""
    heights, forces = np.transpose(points)
    slopes = np.diff(forces) / np.diff(heights)
    return list(zip(heights.tolist(), np.diff([0.0, *slopes, 0.0]).tolist(), strict=True))
