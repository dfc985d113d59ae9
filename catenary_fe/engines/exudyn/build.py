"""The multibody model in Exudyn: a line as its system has it, pantographs as they assemble, named parts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from numbers import Integral
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.contact import (
    Contacts,
    PantographParts,
    WireParts,
    add_own_pantograph,
    add_pantograph,
)
from catenary_fe.engines.exudyn.laws import tension_only
from catenary_fe.engines.exudyn.solver import new_system, release
from catenary_fe.fe.spring import FIXED, Springs
from catenary_fe.fe.system import System
from catenary_fe.layout import AnyPantograph, AttachedPantograph, InputError
from catenary_fe.layout.arguments import checked, number
from catenary_fe.layout.pantograph import check_pantographs
from catenary_fe.layout.parameters import shorten
from catenary_fe.statics import Shape

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class ExudynModel:
    """A line and its pantographs as Exudyn's multibody system ``mbs``. Numbers are those of Exudyn's items.

    shape : the static shape that it was built from
    wires : contact wires (the right one first), messenger wire, stitch wires: nodes, elements, stations
    droppers : objects, in the order of the layout
    arms : objects, the steady arms that are bars
    supports : objects, springs from the wires to the ground, by the names of their coordinates
    holds : objects, constraints of what cannot move, likewise
    clamps : objects, constraints of the ends of stitch wires to the messenger wire
    loads : object with all constant forces on the wires, point masses, Rayleigh damping, what else is linear
    ground : coordinate marker that never moves
    pantographs : bodies, strips and contacts of each pantograph, the attached ones last
    """

    mbs: Any
    shape: Shape
    wires: tuple[WireParts, ...]
    droppers: list[int]
    arms: list[int]
    supports: dict[str, int]
    holds: dict[str, int]
    clamps: dict[str, int]
    loads: int
    ground: int
    pantographs: list[PantographParts] = field(default_factory=list)

    @property
    def system(self) -> System:
        """The same line as arrays; the coordinates of ``mbs`` begin with its coordinates."""
        return self.shape.system

    @property
    def contact_wires(self) -> tuple[WireParts, ...]:
        """One contact wire, or the right and the left one."""
        return self.wires[: len(self.system.contact_paths)]

    @property
    def messenger_wire(self) -> WireParts | None:
        """The messenger wire; None without one."""
        return self.wires[len(self.system.contact_paths)] if self.shape.mesh.messenger else None

    @property
    def stitch_wires(self) -> tuple[WireParts, ...]:
        """The stitch wires, none without them."""
        return self.wires[self.shape.mesh.first_stitch :]

    def name(self, coordinate: int) -> str:
        """A coordinate of the assembled ``mbs`` in words."""
        known = coordinate < self.system.dof.size
        return self.system.name(coordinate) if known else "pantographs"

    @property
    def records(self) -> list[AnyPantograph]:
        """What results record of the pantographs."""
        return [parts.record for parts in self.pantographs]

    @checked
    def attach(
        self,
        name: str,
        strips: Sequence[int],
        *,
        contact_stiffness: float,
        contact_damping: float = 0.0,
        ahead: Sequence[float] = (),
        masses: Sequence[int] = (),
    ) -> PantographParts:
        """Attach bodies of one's own, as one pantograph, to contacts that runs move along the contact wires.

        Contact acts upwards alone, so the bodies may stay where they are along the track. At the start of a
        run the strips should be a little above the wire, for the static solve to find them in contact.

        name : what tables and pictures call it
        strips : position markers on the collector strips
        contact_stiffness : [N/m] between each strip and each contact wire, no tension
        contact_damping : [N s/m] beside it, never pulling
        ahead : [m] along the track of each strip before the pantograph's position; unset: 0
        masses : position markers whose heights results record; unset: the strips

        Raises InputError for values out of bounds, for what are no position markers of ``mbs``, and for
        distances that are not as many as the strips.
        """
        number("contact_stiffness", contact_stiffness, "N/m", above=0.0)
        number("contact_damping", contact_damping, "N s/m", least=0.0)
        strips = _position_markers(self.mbs, f"{name}: strips", strips)
        masses = _position_markers(self.mbs, f"{name}: masses", masses) or strips
        ahead = list(ahead) or [0.0] * len(strips)
        if not strips or len(ahead) != len(strips):
            raise InputError(
                f"{name}: {len(strips)} strips and {len(ahead)} distances ahead; name at least one strip, and"
                " a distance for each"
            )
        record = AttachedPantograph(
            name=name, contact_stiffness=contact_stiffness, contact_damping=contact_damping
        )
        places = list(zip(strips, ahead, strict=True))
        parts = add_own_pantograph(self.mbs, self.contact_wires, record, places, masses)
        self.pantographs.append(parts)
        self.mbs.Assemble()
        return parts

    @property
    def contacts(self) -> Contacts:
        """What moves the contacts and reads them."""
        return Contacts(self.mbs, self.system, self.contact_wires, self.pantographs)

    def place(self, positions: Sequence[float] | Floats, speed: float = 0.0) -> None:
        """Move the contacts to where the pantographs are.

        positions : [m] along the track, one a pantograph
        speed : [m/s], with which a contact damper sees the wire's inclination
        """
        self.contacts.move_to(positions, speed)

    def lift(
        self,
        uplifts: Sequence[float] | Floats,
        positions: Sequence[float] | Floats | None = None,
        bases: Sequence[tuple[float, float]] | None = None,
    ) -> None:
        """Set uplift forces [N], one a pantograph, and heights of the bases.

        positions : [m] along the track, one a pantograph, where the bases follow the contact wire's design
            height; unset: they stand at the nominal one
        bases : heights [m] and rates [m/s] of bases that move up beside that, one a pantograph; unset: 0

        Attached ones have loads of their own.
        """
        at = [None] * len(self.pantographs) if positions is None else positions
        moved = bases or [(0.0, 0.0)] * len(self.pantographs)
        for parts, uplift, x, (height, rate) in zip(self.pantographs, uplifts, at, moved, strict=True):
            body = parts.substructure
            if body is None:
                continue
            risen = 0.0 if x is None else self.system.base_line.under(body, float(x))
            force = float(uplift) * body.load + risen * body.base_load
            force += height * body.base_stiffness + rate * body.base_damping
            if body.mechanism:  # the bars' own loads lift the head, and carry it
                force[body.guide] -= body.mechanism.lifted + body.mechanism.carried
            for load, coordinate in parts.loads:
                self.mbs.SetLoadParameter(load, "load", float(force[coordinate]))
            for law in parts.grounded:
                self.mbs.SetObjectParameter(law, "stiffness", risen + height)
                self.mbs.SetObjectParameter(law, "damping", rate)
            for contact in parts.contacts:
                if contact.strip is not None and contact.strip.body is None:
                    above = self.system.contact_wire_height + risen + height
                    node = self.mbs.GetMarker(contact.strip_marker)["nodeNumber"]
                    place = list(above * np.eye(3)[self.system.axes - 1])
                    self.mbs.SetNodeParameter(node, "referenceCoordinates", place)

    def load_at(self, time: float) -> None:
        """Give the loads of the line that vary in time their values at a time [s]."""
        if self.system.time_loads:
            force = self.system.force + self.system.varying(time)
            self.mbs.SetObjectParameter(self.loads, "forceVector", force)

    def release(self) -> None:
        """Free the memory of ``mbs``; nothing of the model may be used afterwards."""
        release(self.mbs)


@checked
def exudyn_model(shape: Shape, pantographs: Sequence[AnyPantograph] = ()) -> ExudynModel:
    """Build the multibody system: wires as ANCF cables, droppers, arms, supports, pantographs, contacts.

    It may be looked at, changed, given bodies of one's own (:meth:`ExudynModel.attach`), and run:
    ``simulate(shape, pantographs, speed=..., method="exudyn", model=model)``.

    shape : the catenary in static equilibrium
    pantographs : with contacts that stand at the line's begin, and no uplift, until they are moved and lifted

    Raises InputError for what is no shape or no pantograph.
    """
    check_pantographs(pantographs, least=0)
    system, mbs = shape.system, new_system()
    model = ExudynModel(mbs=mbs, shape=shape, **add_line(mbs, system))
    for pantograph in pantographs:
        model.pantographs.append(add_pantograph(mbs, system, model.contact_wires, model.ground, pantograph))
    mbs.Assemble()
    return model


def add_line(mbs: exu.MainSystem, system: System) -> dict[str, Any]:
    """Add all parts of the line; returns them by their names in :class:`ExudynModel`."""
    wires = _add_wires(mbs, system)
    node = mbs.AddNode(eii.NodePointGround())
    ground = int(mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=0)))
    nodes = [node for wire in wires for node in wire.nodes]
    return {
        "wires": wires,
        "droppers": _add_springs(mbs, nodes, system.droppers),
        "arms": _add_springs(mbs, nodes, system.arms),
        "supports": _add_ground_springs(mbs, nodes, system, ground),
        "holds": _add_holds(mbs, nodes, system, ground),
        "clamps": _add_clamps(mbs, nodes, system),
        "loads": _add_loads(mbs, nodes, system),
        "ground": ground,
    }


def _position_markers(mbs: exu.MainSystem, what: str, markers: Sequence[int]) -> list[int]:
    """Their numbers. Raises InputError for what are none."""
    found = []
    for marker in markers:
        number = int(marker) if isinstance(marker, Integral | exu.MarkerIndex) else -1
        known = 0 <= number < mbs.systemData.NumberOfMarkers()
        if not (known and mbs.GetMarker(number)["markerType"].endswith(("Position", "Rigid"))):
            raise InputError(
                f"{what}: {shorten(marker)}: must be the number of a position marker, as the model's"
                " mbs.AddMarker returns it"
            )
        found.append(number)
    return found


def _add_wires(mbs: exu.MainSystem, system: System) -> tuple[WireParts, ...]:
    """Nodes of all wires in the order of the system's coordinates, and elements that carry the tension."""
    spatial, width = system.spatial, 2 * system.axes
    new_node = eii.NodePointSlope1 if spatial else eii.NodePoint2DSlope1
    new_element = eii.ObjectANCFCable if spatial else eii.ObjectANCFCable2D
    rows = system.reference.reshape(-1, width)
    nodes = [int(mbs.AddNode(new_node(referenceCoordinates=list(row)))) for row in rows]
    begins, cables = (system.first // width).tolist(), system.cables
    elements = [
        int(
            mbs.AddObject(
                new_element(
                    length=float(cables.length[i]),
                    massPerLength=float(system.mass_per_length[i]),
                    bendingStiffness=float(cables.bending_stiffness[i]),
                    axialStiffness=float(cables.axial_stiffness[i]),
                    referenceAxialStrain=float(cables.rest_strain[i]),
                    nodeNumbers=nodes[begin : begin + 2],
                    useReducedOrderIntegration=1,
                )
            )
        )
        for i, begin in enumerate(begins)
    ]
    parts = []
    for wire in system.wires:
        own = range(wire.first, wire.first + wire.x.size)
        mine = [element for element, begin in zip(elements, begins, strict=True) if begin in own]
        parts.append(WireParts(wire.name, [nodes[i] for i in own], mine, wire.x))
    return tuple(parts)


def _coordinate_marker(mbs: exu.MainSystem, nodes: list[int], system: System, coordinate: int) -> int:
    node, which = divmod(int(coordinate), 2 * system.axes)
    return int(mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=nodes[node], coordinate=which)))


def _add_springs(mbs: exu.MainSystem, nodes: list[int], springs: Springs) -> list[int]:
    """Springs between points of wires, or from a point to a fixed pivot."""
    law = {"springForceUserFunction": tension_only(mbs)} if springs.pulls_only and springs.length.size else {}
    width = 2 * springs.pivot.shape[1]
    found = []
    for i in range(springs.length.size):
        ends = [nodes[springs.first[i] // width]]
        if springs.last[i] == FIXED:
            ends.append(mbs.AddNode(eii.NodePointGround(referenceCoordinates=_in_space(springs.pivot[i]))))
        else:
            ends.append(nodes[springs.last[i] // width])
        spring = eii.ObjectConnectorSpringDamper(
            markerNumbers=[mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=end)) for end in ends],
            referenceLength=float(springs.length[i]),
            stiffness=float(springs.stiffness[i]),
            damping=float(springs.damping[i]),
            **law,
        )
        found.append(int(mbs.AddObject(spring)))
    return found


def _in_space(point: Floats) -> list[float]:
    """Three coordinates; of a point in the plane, whose second axis is up, the third is 0."""
    return [*point.tolist(), *[0.0] * (3 - point.size)]


def _add_ground_springs(mbs: exu.MainSystem, nodes: list[int], system: System, ground: int) -> dict[str, int]:
    """Springs and dampers of single coordinates against the ground; their preloads are among the loads."""
    found = {}
    for coordinate in np.flatnonzero((system.ground_stiffness != 0) | (system.ground_damping != 0)).tolist():
        spring = eii.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[ground, _coordinate_marker(mbs, nodes, system, coordinate)],
            stiffness=float(system.ground_stiffness[coordinate]),
            damping=float(system.ground_damping[coordinate]),
        )
        found[system.name(coordinate)] = int(mbs.AddObject(spring))
    return found


def _add_holds(mbs: exu.MainSystem, nodes: list[int], system: System, ground: int) -> dict[str, int]:
    found = {}
    for coordinate in np.flatnonzero(system.dof == FIXED).tolist():
        markers = [ground, _coordinate_marker(mbs, nodes, system, coordinate)]
        hold = eii.ObjectConnectorCoordinate(markerNumbers=markers)
        found[system.name(coordinate)] = int(mbs.AddObject(hold))
    return found


def _add_clamps(mbs: exu.MainSystem, nodes: list[int], system: System) -> dict[str, int]:
    """Coordinates that move with another one: the first of those that share a number leads."""
    moves = np.flatnonzero(system.dof != FIXED)
    _, first, group = np.unique(system.dof[moves], return_index=True, return_inverse=True)
    leaders = moves[first][group]
    found = {}
    for leader, follower in zip(leaders.tolist(), moves.tolist(), strict=True):
        if leader != follower:
            markers = [_coordinate_marker(mbs, nodes, system, c) for c in (leader, follower)]
            clamp = eii.ObjectConnectorCoordinate(markerNumbers=markers)
            found[system.name(follower)] = int(mbs.AddObject(clamp))
    return found


def _add_loads(mbs: exu.MainSystem, nodes: list[int], system: System) -> int:
    """Constant forces, point masses, Rayleigh damping of the wires and what else is linear as one object.

    The damping includes the tension's stiffness, on which a wire's waves live; a cable element's own damping
    knows only of EA and EI. One vector of forces costs a third of a load on each element.
    """
    from scipy.sparse import csr_matrix, diags

    matrices: dict[str, Any] = {}
    for name, matrix in (
        ("massMatrix", system.mass - system.wire_mass),
        ("stiffnessMatrix", system.linear_stiffness),
        ("dampingMatrix", system.damping() - diags(system.ground_damping)),
    ):
        sparse = csr_matrix(matrix)
        sparse.eliminate_zeros()
        if sparse.nnz:
            matrices[name] = exu.MatrixContainer(sparse)
    nothing = exu.MatrixContainer(csr_matrix(([0.0], ([0], [0])), shape=system.mass.shape))
    loads = eii.ObjectGenericODE2(
        nodeNumbers=nodes,
        forceVector=system.force,
        # with a function of its own the object adds its matrices to the Jacobian as they are; without one
        # Exudyn differentiates it numerically, coordinate by coordinate
        jacobianUserFunction=lambda *_: nothing,
        **matrices,
    )
    return int(mbs.AddObject(loads))
