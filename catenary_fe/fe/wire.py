"""A tensioned wire as a row of ANCF cable elements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import ArrayLike, NDArray

from catenary_fe.fe.linearise import mass_matrix, stiffness_matrix
from catenary_fe.system import RayleighDamping, Wire

Floats = NDArray[np.float64]

GRAVITY = 9.81  # [m/s²]
ALONG, UP = 0, 1  # the plane's axes: along the track, vertical
COORDINATES = 4  # of a node: position along and up, slope along and up
_GAUSS_X, _GAUSS_W = np.polynomial.legendre.leggauss(5)


@dataclass(frozen=True)
class WireLine:
    """Where a wire hangs: positions and unit slopes at its nodes, arc lengths between them.

    x, z : [m], shape (nodes,)
    slope_x, slope_z : shape (nodes,), derivatives along the wire
    lengths : [m], shape (nodes - 1,), of the elements under the wire's nominal tension
    """

    x: Floats
    z: Floats
    slope_x: Floats
    slope_z: Floats
    lengths: Floats

    @classmethod
    def through(cls, wire: Wire, x: ArrayLike, z: ArrayLike, dz_dx: ArrayLike) -> WireLine:
        """The wire that hangs through given points with given inclinations (cubic between the points).

        Its pull along the track is the nominal tension everywhere, so where it is inclined it is stretched
        a little more than nominally.
        """
        x, z, dz_dx = (np.array(values, dtype=float) for values in (x, z, dz_dx))
        h = np.diff(x)[:, None]
        xi = (_GAUSS_X + 1) / 2
        inclination = (
            6 * (xi - xi**2) * np.diff(z)[:, None] / h
            + (1 - 4 * xi + 3 * xi**2) * dz_dx[:-1, None]
            + (3 * xi**2 - 2 * xi) * dz_dx[1:, None]
        )
        arc = np.hypot(1.0, inclination)
        lengths = h[:, 0] * ((arc / _stretch(wire, arc)) @ _GAUSS_W) / 2
        arc = np.hypot(1.0, dz_dx)
        slope_x = _stretch(wire, arc) / arc
        return cls(x, z, slope_x, dz_dx * slope_x, lengths)

    def coordinates(self) -> Floats:
        """Shape (nodes, 4): reference coordinates of the nodes."""
        return np.column_stack([self.x, self.z, self.slope_x, self.slope_z])


@dataclass(frozen=True)
class WireItems:
    """Numbers of a wire's items in an Exudyn system, and its line as built."""

    nodes: list[int]
    elements: list[int]
    line: WireLine

    def position_marker(self, mbs: exu.MainSystem, node: int) -> int:
        """A marker on the wire's node of this number."""
        return int(mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=self.nodes[node])))

    def coordinate_marker(self, mbs: exu.MainSystem, node: int, axis: int) -> int:
        """A marker on one coordinate of the wire's node of this number."""
        return int(mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=self.nodes[node], coordinate=axis)))


def add_wire(mbs: exu.MainSystem, wire: Wire, line: WireLine) -> WireItems:
    """Add nodes and elements of a wire that carries its tension along the given line."""
    nodes = [
        int(mbs.AddNode(eii.NodePoint2DSlope1(referenceCoordinates=list(row)))) for row in line.coordinates()
    ]
    elements = [
        int(
            mbs.AddObject(
                eii.ObjectANCFCable2D(
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
    return WireItems(nodes, elements, line)


def add_overlay(
    mbs: exu.MainSystem,
    wires: Sequence[WireItems],
    point_masses: Floats | None = None,
    damping: RayleighDamping | None = None,
) -> None:
    """Add weight, point masses and Rayleigh damping of the system's wires, as one object.

    wires : all wires of the system so far, in the order they were added, before anything else with nodes
    point_masses : [kg], shape (nodes of all wires,)

    The damping matrix includes the tension's stiffness, on which a wire's waves live; the cable's own damping
    knows only of EA and EI. The weight as one constant vector costs a third of a load on each element.
    """
    from scipy.sparse import csr_matrix, diags

    mbs.Assemble()
    elements = [element for wire in wires for element in wire.elements]
    nodes = [node for wire in wires for node in wire.nodes]
    M = mass_matrix(mbs, elements)
    up = np.tile(np.eye(COORDINATES)[UP], len(nodes))
    matrices: dict[str, Any] = {}
    if point_masses is not None and point_masses.any():
        moves = np.tile([1.0, 1.0, 0.0, 0.0], len(nodes))
        added = diags(np.repeat(point_masses, COORDINATES) * moves)
        matrices["massMatrix"] = exu.MatrixContainer(csr_matrix(added))
        weight = -GRAVITY * (M + added) @ up
    else:
        weight = -GRAVITY * M @ up
    if damping and (damping.alpha or damping.beta):
        D = csr_matrix(damping.alpha * M + damping.beta * stiffness_matrix(mbs, elements))
        matrices["dampingMatrix"] = exu.MatrixContainer(D)
    nothing = exu.MatrixContainer(csr_matrix(([0.0], ([0], [0])), shape=M.shape))
    mbs.AddObject(
        eii.ObjectGenericODE2(
            nodeNumbers=nodes,
            forceVector=weight,
            # with a function of its own the object adds its matrices to the Jacobian as they are; without
            # one Exudyn differentiates it numerically, coordinate by coordinate
            jacobianUserFunction=lambda *_: nothing,
            **matrices,
        )
    )


def anchor_and_tension(mbs: exu.MainSystem, items: WireItems, ground: int, wire: Wire) -> None:
    """Fix the first node along the track; let the last one move there, pulled by the weights."""
    hold(mbs, items, 0, ALONG, ground)
    end = items.coordinate_marker(mbs, len(items.nodes) - 1, ALONG)
    mbs.AddLoad(eii.LoadCoordinate(markerNumber=end, load=wire.tension))


def hold(mbs: exu.MainSystem, items: WireItems, node: int, axis: int, ground: int) -> int:
    """Hold one coordinate of a node where it is in the reference line; returns the constraint's number."""
    markers = [ground, items.coordinate_marker(mbs, node, axis)]
    return int(mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=markers)))


def add_ground_coordinate(mbs: exu.MainSystem) -> int:
    """A coordinate marker that never moves."""
    node = mbs.AddNode(eii.NodePointGround())
    return int(mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=0)))


def hermite(xi: ArrayLike, length: ArrayLike) -> Floats:
    """Shape functions of the cable element, shape (..., 4), at the fraction ``xi`` of its length."""
    xi, length = np.asarray(xi, dtype=float), np.asarray(length, dtype=float)
    return np.stack(
        [
            1 - 3 * xi**2 + 2 * xi**3,
            length * (xi - 2 * xi**2 + xi**3),
            3 * xi**2 - 2 * xi**3,
            length * (xi**3 - xi**2),
        ],
        axis=-1,
    )


def _stretch(wire: Wire, arc: Floats) -> Floats:
    """Length over nominal length of a wire with the nominal pull along the track; arc = ds/dx."""
    return 1 + (arc - 1) * wire.tension / wire.axial_stiffness
