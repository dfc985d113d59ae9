"""Statics of one wire alone, held and loaded at nodes: what is left when the droppers are cut."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.solver import new_system, solve_static
from catenary_fe.fe.wire import (
    COORDINATES,
    UP,
    WireLine,
    add_ground_coordinate,
    add_overlay,
    add_wire,
    anchor_and_tension,
    hold,
)
from catenary_fe.system import Wire

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class WireStatics:
    """Static equilibrium of one wire.

    x, z : [m], shape (nodes,)
    dz_dx : shape (nodes,), inclination
    reactions : [N], force that holds each held node up, by node number
    """

    x: Floats
    z: Floats
    dz_dx: Floats
    reactions: dict[int, float]


def solve_wire(
    wire: Wire,
    line: WireLine,
    held: Mapping[int, float],
    loads: Mapping[int, float],
    springs: Mapping[int, tuple[float, float]],
    *,
    what: str,
) -> WireStatics:
    """Equilibrium of a wire under its weight, its tension and vertical forces.

    line : where the wire is started from
    held : node number to height [m] at which that node is held
    loads : node number to upward force [N] on that node
    springs : node number to stiffness [N/m] and force-free height [m] of a vertical spring to the ground
    what : the case in words, for errors

    Raises SolverError if there is no convergence.
    """
    mbs = new_system()
    items = add_wire(mbs, wire, line)
    add_overlay(mbs, [items])
    ground = add_ground_coordinate(mbs)
    anchor_and_tension(mbs, items, ground, wire)
    constraints = {node: hold(mbs, items, node, UP, ground) for node in held}
    for node, height in held.items():
        mbs.SetObjectParameter(constraints[node], "offset", height - line.z[node])
    for node, force in loads.items():
        marker = items.coordinate_marker(mbs, node, UP)
        mbs.AddLoad(eii.LoadCoordinate(markerNumber=marker, load=force))
    for node, (stiffness, height) in springs.items():
        markers = [ground, items.coordinate_marker(mbs, node, UP)]
        offset = height - float(line.z[node])
        mbs.AddObject(
            eii.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=markers, stiffness=stiffness, offset=offset
            )
        )
    mbs.Assemble()
    solve_static(mbs, what=what)
    q = line.coordinates() + mbs.systemData.GetODE2Coordinates().reshape(-1, COORDINATES)
    reactions = {
        node: float(mbs.GetObjectOutput(constraint, exu.OutputVariableType.Force))
        for node, constraint in constraints.items()
    }
    return WireStatics(q[:, 0], q[:, 1], q[:, 3] / q[:, 2], reactions)
