"""A catenary, as it was installed, as an Exudyn system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.laws import dropper_function
from catenary_fe.engines.exudyn.overlay import Overlay, add_overlay
from catenary_fe.engines.exudyn.registration import add_arms, add_supports
from catenary_fe.engines.exudyn.solver import new_system
from catenary_fe.engines.exudyn.wire import (
    WireItems,
    add_ground_coordinate,
    add_wire,
    anchor_and_tension,
)
from catenary_fe.fe.assembly import assemble
from catenary_fe.fe.installation import (
    Installation,
    curve_pulls,
    dropper_damping,
    point_masses,
    wire_kinds,
)
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.system import System
from catenary_fe.layout import Catenary

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Model:
    """An Exudyn system of a catenary, and where its parts are.

    mbs : the system, not yet assembled
    wires : contact wires, messenger wire, stitch wires, as in the mesh
    overlay : number of the object that carries what acts along the wires
    droppers : numbers of the dropper connectors
    installation : where the wires hang
    ground : number of a coordinate marker that never moves
    """

    mbs: Any
    catenary: Catenary
    mesh: Mesh
    wires: tuple[WireItems, ...]
    overlay: int
    droppers: list[int]
    installation: Installation
    ground: int

    @property
    def system(self) -> System:
        """The same line as arrays."""
        return assemble(self.catenary, self.mesh, self.installation)

    @property
    def contact(self) -> WireItems:
        """The contact wire; of two, the right one."""
        return self.wires[0]

    @property
    def contacts(self) -> tuple[WireItems, ...]:
        """The contact wires."""
        return self.wires[: self.mesh.contact_wires]

    @property
    def messenger(self) -> WireItems:
        """The messenger wire."""
        return self.wires[self.mesh.contact_wires]

    @property
    def contact_wire_height(self) -> float:
        """[m], nominal."""
        return self.catenary.contact_wire_height

    @property
    def dropper_lengths(self) -> Floats:
        """[m], shape (droppers,), stress-free."""
        return self.installation.dropper_lengths

    @property
    def axes(self) -> int:
        """2 in the plane, 3 in space; up is the last one."""
        return self.contact.line.axes

    @property
    def node_width(self) -> int:
        """Coordinates of a node. All wires' nodes come first among the system's coordinates."""
        return self.contact.coordinates

    def wire_shapes(self, coordinates: Floats) -> list[Floats]:
        """Total coordinates of each wire's nodes, each of shape (nodes, 2 * axes)."""
        ends = self.node_width * self.mesh.first_nodes
        return [
            wire.line.coordinates() + coordinates[a:b].reshape(-1, self.node_width)
            for wire, a, b in zip(self.wires, ends[:-1], ends[1:], strict=True)
        ]

    def dropper_forces(self) -> Floats:
        """[N], shape (droppers,), tension at the current state."""
        force = exu.OutputVariableType.Force
        axial = [np.linalg.norm(self.mbs.GetObjectOutput(d, force)) for d in self.droppers]
        return np.array(axial)


def build_model(catenary: Catenary, mesh: Mesh, installation: Installation) -> Model:
    """Build wires, droppers, supports and steady arms, in space or in the plane as the lines lie."""
    mbs = new_system()
    kinds = wire_kinds(catenary, mesh)
    wires = tuple(add_wire(mbs, kind, line) for kind, line in zip(kinds, installation.lines, strict=True))
    ground = add_ground_coordinate(mbs)
    for wire, items in zip(kinds[: mesh.first_stitch], wires, strict=False):
        anchor_and_tension(mbs, items, ground, wire)
    overlay = add_overlay(mbs, wires, _overlay(catenary, mesh, installation, wires))
    _clamp_stitch_wires(mbs, mesh, wires)
    droppers = _add_droppers(mbs, catenary, mesh, wires, installation.dropper_lengths)
    contacts, messenger = wires[: mesh.contact_wires], wires[mesh.contact_wires]
    add_arms(mbs, catenary, mesh, contacts, ground, installation.arm_forces)
    add_supports(mbs, catenary, mesh, messenger, ground, installation.support_forces)
    return Model(mbs, catenary, mesh, wires, overlay, droppers, installation, ground)


def _overlay(
    catenary: Catenary, mesh: Mesh, installation: Installation, wires: Sequence[WireItems]
) -> Overlay:
    masses, hanging = point_masses(catenary, mesh, installation.dropper_lengths)
    pull = None
    if wires[0].line.axes == 3 and any(span.curve_radius for span in catenary.spans):
        pull = np.concatenate(curve_pulls(catenary, mesh))
    return Overlay(masses, hanging, catenary.damping, pull, installation.balance)


def _clamp_stitch_wires(mbs: exu.MainSystem, mesh: Mesh, wires: Sequence[WireItems]) -> None:
    """Both ends move with the messenger wire."""
    messenger = wires[mesh.contact_wires]
    for stitch, ends in zip(wires[mesh.first_stitch :], mesh.stitch_ends, strict=True):
        for node, clamp in zip((0, len(stitch.nodes) - 1), ends.tolist(), strict=True):
            for axis in range(stitch.line.axes):
                markers = [
                    messenger.coordinate_marker(mbs, clamp, axis),
                    stitch.coordinate_marker(mbs, node, axis),
                ]
                mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=markers))


def _add_droppers(
    mbs: exu.MainSystem, catenary: Catenary, mesh: Mesh, wires: Sequence[WireItems], lengths: Floats
) -> list[int]:
    if not catenary.droppers:
        return []
    function = dropper_function(mbs)
    damping = dropper_damping(catenary)
    return [
        int(
            mbs.AddObject(
                eii.ObjectConnectorSpringDamper(
                    markerNumbers=[
                        wires[clamps.wire[i]].position_marker(mbs, int(clamps.node[i]))
                        for clamps in (mesh.lower, mesh.upper)
                    ],
                    referenceLength=float(lengths[i]),
                    stiffness=dropper.stiffness,
                    damping=float(damping[i]),
                    springForceUserFunction=function,
                )
            )
        )
        for i, dropper in enumerate(catenary.droppers)
    ]
