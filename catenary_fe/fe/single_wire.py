"""Statics of one wire alone, held and loaded at nodes: what is left when the droppers are cut."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.overlay import Overlay, add_overlay
from catenary_fe.fe.solver import new_system, release, solve_static
from catenary_fe.fe.wire import WireLine, add_ground_coordinate, add_wire, anchor_and_tension, hold
from catenary_fe.system import Wire

Floats = NDArray[np.float64]
At = tuple[int, int]  # node, axis


@dataclass(frozen=True)
class Cut:
    """How a wire is held and loaded where its droppers and supports are cut.

    held : (node, axis) to the coordinate [m] at which it is held
    loads : (node, axis) to a force [N]
    springs : (node, axis) to stiffness [N/m] and force-free coordinate [m] of a spring to the ground
    side_pull : as in :class:`~catenary_fe.fe.overlay.Overlay`
    """

    held: Mapping[At, float]
    loads: Mapping[At, float] = field(default_factory=dict)
    springs: Mapping[At, tuple[float, float]] = field(default_factory=dict)
    side_pull: Floats | None = None


@dataclass(frozen=True)
class WireStatics:
    """Static equilibrium of one wire.

    points : [m], shape (nodes, axes)
    inclinations : shape (nodes, axes - 1), derivatives along the track
    reactions : [N], force that holds each held coordinate, by node and axis
    """

    points: Floats
    inclinations: Floats
    reactions: dict[At, float]

    @classmethod
    def from_coordinates(cls, q: Floats, reactions: dict[At, float] | None = None) -> WireStatics:
        """From total coordinates of shape (nodes, 2 * axes)."""
        axes = q.shape[1] // 2
        return cls(q[:, :axes], q[:, axes + 1 :] / q[:, axes : axes + 1], reactions or {})


def solve_wire(wire: Wire, line: WireLine, cut: Cut, *, what: str) -> WireStatics:
    """Equilibrium of a wire under its weight, its tension and what is left of the cuts.

    line : where the wire is started from
    what : the case in words, for errors

    Raises SolverError if there is no convergence.
    """
    mbs = new_system()
    items = add_wire(mbs, wire, line)
    add_overlay(mbs, [items], Overlay(side_pull=cut.side_pull))
    ground = add_ground_coordinate(mbs)
    anchor_and_tension(mbs, items, ground, wire)
    constraints = {
        (node, axis): hold(mbs, items, node, axis, ground, value - float(line.points[node, axis]))
        for (node, axis), value in cut.held.items()
    }
    for (node, axis), force in cut.loads.items():
        marker = items.coordinate_marker(mbs, node, axis)
        mbs.AddLoad(eii.LoadCoordinate(markerNumber=marker, load=float(force)))
    for (node, axis), (stiffness, at_rest) in cut.springs.items():
        markers = [ground, items.coordinate_marker(mbs, node, axis)]
        offset = at_rest - float(line.points[node, axis])
        mbs.AddObject(
            eii.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=markers, stiffness=stiffness, offset=offset
            )
        )
    mbs.Assemble()
    solve_static(mbs, what=what)
    q = line.coordinates() + mbs.systemData.GetODE2Coordinates().reshape(-1, items.coordinates)
    reactions = {
        at: float(mbs.GetObjectOutput(constraint, exu.OutputVariableType.Force))
        for at, constraint in constraints.items()
    }
    release(mbs)
    return WireStatics.from_coordinates(q, reactions)
