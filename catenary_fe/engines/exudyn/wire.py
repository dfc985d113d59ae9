"""A tensioned wire as a row of ANCF cable elements, in the plane or in space.

Arrays of points and slopes have the plane's two axes (along the track, up) or the space's three (along the
track, to the left, up) as their last one: up is always its last entry.
"""

from __future__ import annotations

from dataclasses import dataclass

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.installation import WireLine
from catenary_fe.layout import Wire

Floats = NDArray[np.float64]

ALONG = 0


@dataclass(frozen=True)
class WireItems:
    """Numbers of a wire's items in an Exudyn system, its parameters, and its line as built."""

    nodes: list[int]
    elements: list[int]
    kind: Wire
    line: WireLine

    @property
    def up(self) -> int:
        """Number of the vertical axis, among a point's and also among Exudyn's own vectors."""
        return self.line.axes - 1

    @property
    def coordinates(self) -> int:
        """How many a node has: its point, then its slope."""
        return 2 * self.line.axes

    def position_marker(self, mbs: exu.MainSystem, node: int) -> int:
        """A marker on the wire's node of this number."""
        return int(mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=self.nodes[node])))

    def coordinate_marker(self, mbs: exu.MainSystem, node: int, axis: int) -> int:
        """A marker on one coordinate of the wire's node of this number."""
        return int(mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=self.nodes[node], coordinate=axis)))


def add_wire(mbs: exu.MainSystem, wire: Wire, line: WireLine) -> WireItems:
    """Add nodes and elements of a wire that carries its tension along the given line."""
    in_space = line.axes == 3
    new_node = eii.NodePointSlope1 if in_space else eii.NodePoint2DSlope1
    new_element = eii.ObjectANCFCable if in_space else eii.ObjectANCFCable2D
    nodes = [int(mbs.AddNode(new_node(referenceCoordinates=list(row)))) for row in line.coordinates()]
    elements = [
        int(
            mbs.AddObject(
                new_element(
                    length=length,
                    massPerLength=wire.mass_per_length,
                    bendingStiffness=wire.bending_stiffness,
                    axialStiffness=wire.axial_stiffness,
                    referenceAxialStrain=-wire.tension / wire.axial_stiffness,
                    nodeNumbers=nodes[i : i + 2],
                    useReducedOrderIntegration=1,
                )
            )
        )
        for i, length in enumerate(line.lengths.tolist())
    ]
    return WireItems(nodes, elements, wire, line)


def anchor_and_tension(mbs: exu.MainSystem, items: WireItems, ground: int, wire: Wire) -> None:
    """Fix the first node along the track; let the last one move there, pulled by the weights."""
    hold(mbs, items, 0, ALONG, ground)
    end = items.coordinate_marker(mbs, len(items.nodes) - 1, ALONG)
    mbs.AddLoad(eii.LoadCoordinate(markerNumber=end, load=wire.tension))


def hold(mbs: exu.MainSystem, items: WireItems, node: int, axis: int, ground: int) -> None:
    """Hold a coordinate where the line has it."""
    markers = [ground, items.coordinate_marker(mbs, node, axis)]
    mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=markers))


def add_ground_coordinate(mbs: exu.MainSystem) -> int:
    """A coordinate marker that never moves."""
    node = mbs.AddNode(eii.NodePointGround())
    return int(mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=0)))
