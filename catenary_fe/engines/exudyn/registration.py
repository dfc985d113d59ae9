"""What holds the wires at the masts: steady arms, messenger supports, the line's ends."""

from __future__ import annotations

from collections.abc import Sequence

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.wire import WireItems, hold
from catenary_fe.fe.assembly import LINK_STIFFNESS
from catenary_fe.fe.mesh import Mesh
from catenary_fe.layout import Catenary, SteadyArm

Floats = NDArray[np.float64]


def add_arms(
    mbs: exu.MainSystem,
    catenary: Catenary,
    mesh: Mesh,
    wires: Sequence[WireItems],
    ground: int,
    forces: Floats,
) -> None:
    """Steady arms on each contact wire; at the line's ends the wires are held where they are.

    forces : [N], shape (contact wires, spans + 1, axes - 1), of the arms on the wires where they hang
    """
    last = len(catenary.supports) - 1
    for number, (wire, stations) in enumerate(zip(wires, mesh.wires, strict=False)):
        sideways, up = range(1, wire.up), wire.up
        for i, support in enumerate(catenary.supports):
            node, arm, force = int(stations.supports[i]), support.steady_arm, forces[number, i]
            held_axes: list[int] = []
            if i in (0, last):
                held_axes = [*sideways, up]
            elif arm and arm.length is None:
                held_axes = [*sideways]
            for axis in held_axes:
                hold(mbs, wire, node, axis, ground)
            if arm and up not in held_axes:
                _add_arm(mbs, wire, node, arm, ground, force)


def _add_arm(
    mbs: exu.MainSystem,
    wire: WireItems,
    node: int,
    arm: SteadyArm,
    ground: int,
    force: Floats,
) -> None:
    if arm.stiffness is not None:
        _add_spring(mbs, wire, node, wire.up, ground, (arm.stiffness, arm.damping, force[-1]))
    else:
        _add_link(mbs, wire, node, arm, force)


def _add_link(mbs: exu.MainSystem, wire: WireItems, node: int, arm: SteadyArm, force: Floats) -> None:
    """A stiff spring to a pivot that lies where the force on the wire points to."""
    assert arm.length is not None
    pull = float(np.linalg.norm(force))
    pivot = wire.line.points[node] + arm.length * np.array([0.0, *force]) / pull
    fixed = mbs.AddNode(eii.NodePointGround(referenceCoordinates=list(pivot)))
    markers = [wire.position_marker(mbs, node), mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=fixed))]
    mbs.AddObject(
        eii.ObjectConnectorSpringDamper(
            markerNumbers=markers,
            referenceLength=arm.length - pull / LINK_STIFFNESS,
            stiffness=LINK_STIFFNESS,
        )
    )


def add_supports(
    mbs: exu.MainSystem,
    catenary: Catenary,
    mesh: Mesh,
    messenger: WireItems,
    ground: int,
    forces: Floats,
) -> None:
    """Supports of the messenger wire.

    forces : [N], shape (spans + 1, axes - 1), on the wire where it hangs
    """
    last = len(catenary.supports) - 1
    for i, support in enumerate(catenary.supports):
        node = int(mesh.messenger.supports[i])
        springs = {messenger.up: (support.messenger_stiffness, support.messenger_damping)}
        if messenger.up > 1:
            springs[1] = (support.messenger_lateral_stiffness, support.messenger_lateral_damping)
        for axis, (stiffness, damping) in springs.items():
            if i in (0, last) or stiffness is None:
                hold(mbs, messenger, node, axis, ground)
            else:
                force = float(forces[i, axis - 1])
                _add_spring(mbs, messenger, node, axis, ground, (stiffness, damping, force))


def _add_spring(
    mbs: exu.MainSystem,
    wire: WireItems,
    node: int,
    axis: int,
    ground: int,
    spring: tuple[float, float, float],
) -> None:
    """A spring to the ground along one axis: stiffness, damping, and the force on the wire where it hangs."""
    stiffness, damping, preload = spring
    marker = wire.coordinate_marker(mbs, node, axis)
    mbs.AddObject(
        eii.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[ground, marker], stiffness=stiffness, damping=damping
        )
    )
    mbs.AddLoad(eii.LoadCoordinate(markerNumber=marker, load=float(preload)))
