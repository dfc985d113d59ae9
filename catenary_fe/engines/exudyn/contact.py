"""Pantographs in the multibody model, and their contacts, which move along the wires from step to step."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.frame import FrameParts, add_frame
from catenary_fe.engines.exudyn.laws import joint_law, push_only
from catenary_fe.fe.system import System
from catenary_fe.layout import AerodynamicForce, AnyPantograph, AttachedPantograph, InputError
from catenary_fe.layout.bodies import BASE, Body, ContactLaw, Strip
from catenary_fe.layout.substructure import Substructure

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

_TO_UP = {  # rotations that turn the first axis, along which Mass1D moves, up
    1: [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
    2: [[0, 0, -1], [0, 1, 0], [1, 0, 0]],
}
_ROLL, _PITCH = 3, {1: 5, 2: 4}  # coordinates of a rigid body's node; pitch by the axis that is up
_ANY = 1.0  # [kg m²] about an axis that a body is held in


@dataclass(frozen=True)
class WireParts:
    """A wire: its name, numbers of its nodes and elements, and the nodes' stations x [m], shape (nodes,)."""

    name: str
    nodes: list[int]
    elements: list[int]
    x: Floats


@dataclass(frozen=True)
class ContactParts:
    """A collector strip on a contact wire.

    wire : number of the contact wire
    ahead : [m] along the track of the strip before the pantograph's position
    strip : the strip in its substructure; of an attached pantograph, none
    wire_marker, strip_marker : of the two points in contact
    rolls : whether the strip's point follows the wire sideways
    connector : object, the contact's spring and damper
    arm : [m] of the strip's point along its body, which pitches
    """

    wire: int
    ahead: float
    strip: Strip | None
    wire_marker: int
    strip_marker: int
    rolls: bool
    connector: int
    arm: float = 0.0


@dataclass(frozen=True)
class PantographParts:
    """A pantograph.

    record : what was described, or of attached bodies what results record
    substructure : what was assembled; of attached bodies, none
    bodies : objects; those that carry strips first
    joints : objects, springs and dampers between bodies, or a body and the base
    grounded : objects, what is not linear between a body and the base, whose height and rate they hold
    coordinates : node, and which of its coordinates, of each of the substructure's coordinates
    loads : and which of the substructure's coordinates each acts on: of the uplift, and of a base that rises
    strips : position markers on the middles of the collector strips
    contacts : each strip on each contact wire
    masses : position markers whose heights results record
    frame : bars on joints, of a mechanism
    """

    record: AnyPantograph
    substructure: Substructure | None
    bodies: list[int]
    joints: list[int]
    grounded: list[int]
    coordinates: list[tuple[int, int]]
    loads: list[tuple[int, int]]
    strips: list[int]
    contacts: list[ContactParts]
    masses: list[int]
    frame: FrameParts | None = None

    def index(self, mbs: exu.MainSystem) -> Integers:
        """Shape (coordinates,): numbers of its coordinates among those of the assembled system."""
        numbers = [mbs.systemData.GetNodeLTGODE2(node)[which] for node, which in self.coordinates]
        return np.array(numbers, dtype=np.int64)


def add_pantograph(
    mbs: exu.MainSystem,
    system: System,
    wires: Sequence[WireParts],
    ground: int,
    pantograph: Any,
) -> PantographParts:
    """Add whatever assembles as a pantograph. Its weight is balanced by its frame."""
    assembled = pantograph.assemble(spatial=system.spatial, height=system.contact_wire_height)
    if assembled.bending:
        raise InputError(
            f"{pantograph.name}: bending_frequencies: strips that bend do not run with Exudyn; take the"
            " method 'nonlinear' or 'linearised', or leave them out"
        )
    axes, mechanism = system.axes, assembled.mechanism
    made = assembled.beside_bars() if mechanism else assembled
    nominal = system.contact_wire_height * np.eye(3)[axes - 1]
    bodies, coordinates = _add_bodies(mbs, made, nominal, axes - 1, ground)
    frame = add_frame(mbs, mechanism, coordinates[made.guide][0]) if mechanism else None
    on = [_coordinate_marker(mbs, place) for place in coordinates]
    loads = [
        (int(mbs.AddLoad(eii.LoadCoordinate(markerNumber=on[at], load=0.0))), int(at))
        for at in np.flatnonzero(_loaded(pantograph, assembled))
    ]
    joints, grounded = _add_joints(mbs, made, on, ground)
    middles = [mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body)) for body in bodies]
    strips = [_strip_marker(mbs, bodies, assembled, strip, nominal) for strip in assembled.strips]
    law = _Law(mbs, axes - 1, assembled.contact)
    contacts = []
    for strip, middle in zip(assembled.strips, strips, strict=True):
        rolls = strip.body in assembled.rolling  # then it meets each wire at another place
        for wire in range(len(wires)):
            marker = _strip_marker(mbs, bodies, assembled, strip, nominal) if rolls else middle
            made_of = law.connect(wires, wire, strip.ahead, marker, strip, rolls=rolls)
            contacts.append(replace(made_of, arm=_arm(assembled, strip, nominal)))
    return PantographParts(
        record=pantograph,
        substructure=assembled,
        bodies=bodies,
        joints=joints,
        grounded=grounded,
        coordinates=coordinates,
        loads=loads,
        strips=strips,
        contacts=contacts,
        masses=[int(marker) for marker in middles],
        frame=frame,
    )


def _loaded(pantograph: Any, assembled: Substructure) -> NDArray[np.bool_]:
    """Which coordinates a load may act on: of the uplift, of the air on each mass, of a base that rises."""
    found: NDArray[np.bool_] = (
        (assembled.load != 0) | (assembled.base_stiffness != 0) | (assembled.base_damping != 0)
    )
    if any(air != AerodynamicForce() for air in getattr(pantograph, "airs", ())[:-1]):
        found[: len(assembled.bodies)] = True
    return found


def add_own_pantograph(
    mbs: exu.MainSystem,
    wires: Sequence[WireParts],
    record: AttachedPantograph,
    strips: Sequence[tuple[int, float]],
    masses: Sequence[int],
) -> PantographParts:
    """Add the contacts of bodies that are there already.

    strips : position markers on the collector strips, and distances [m] ahead
    masses : position markers whose heights results record
    """
    up = 1 if "2D" in mbs.GetObject(wires[0].elements[0])["objectType"] else 2
    law = _Law(mbs, up, ContactLaw(record.contact_stiffness, record.contact_damping))
    contacts = [
        law.connect(wires, wire, float(ahead), int(marker), None, rolls=False)
        for marker, ahead in strips
        for wire in range(len(wires))
    ]
    markers = [int(marker) for marker, _ in strips]
    return PantographParts(record, None, [], [], [], [], [], markers, contacts, [int(m) for m in masses])


def _add_bodies(
    mbs: exu.MainSystem, made: Substructure, nominal: Floats, up: int, ground: int
) -> tuple[list[int], list[tuple[int, int]]]:
    """Numbers of the bodies, and for each coordinate its node, and which of that node's it is."""
    bodies, heights, rolls, pitches = [], [], [], []
    for body in made.bodies:
        number, node = _add_body(mbs, body, nominal, up, ground)
        bodies.append(number)
        heights.append((node, up if _turns(body) else 0))
        rolls += [(node, _ROLL)] if body.inertia is not None else []
        pitches += [(node, _PITCH[up])] if body.pitch_inertia is not None else []
    return bodies, [*heights, *rolls, *pitches]


def _turns(body: Body) -> bool:
    return body.inertia is not None or body.pitch_inertia is not None


def _add_body(mbs: exu.MainSystem, body: Body, nominal: Floats, up: int, ground: int) -> tuple[int, int]:
    """Numbers of a point mass that heaves, or of a rigid body that rolls or pitches, too, and of its node."""
    if not _turns(body):
        node = mbs.AddNode(eii.Node1D(referenceCoordinates=[0.0]))
        point = eii.ObjectMass1D(
            mass=body.mass, nodeNumber=node, referencePosition=list(nominal), referenceRotation=_TO_UP[up]
        )
        return int(mbs.AddObject(point)), int(node)
    node = mbs.AddNode(eii.NodeRigidBodyRxyz(referenceCoordinates=[*nominal, 0, 0, 0]))
    about_track, about_axle = body.inertia or _ANY, body.pitch_inertia or _ANY
    inertia = [about_track, about_axle, about_axle, 0.0, 0.0, 0.0]
    rigid = mbs.AddObject(eii.ObjectRigidBody(nodeNumber=node, mass=body.mass, inertia=inertia))
    free = {up} | ({_ROLL} if body.inertia else set()) | ({_PITCH[up]} if body.pitch_inertia else set())
    for which in sorted({*range(6)} - free):
        markers = [ground, _coordinate_marker(mbs, (int(node), which))]
        mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=markers))
    return int(rigid), int(node)


def _coordinate_marker(mbs: exu.MainSystem, place: tuple[int, int]) -> int:
    node, which = place
    return int(mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=which)))


def _strip_marker(
    mbs: exu.MainSystem, bodies: list[int], made: Substructure, strip: Strip, nominal: Floats
) -> int:
    """On the strip's body, or where there is none at the nominal contact wire height."""
    if strip.body is not None:
        place = [_arm(made, strip, nominal), 0.0, 0.0]
        marker = eii.MarkerBodyPosition(bodyNumber=bodies[strip.body], localPosition=place)
        return int(mbs.AddMarker(marker))
    node = mbs.AddNode(eii.NodePointGround(referenceCoordinates=list(nominal)))
    return int(mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=node)))


def _arm(made: Substructure, strip: Strip, nominal: Floats) -> float:
    """[m] of a strip along its body; in space that turns the other way than pitch counts."""
    if strip.body not in made.pitching:
        return 0.0
    return strip.ahead if nominal[1] else -strip.ahead


def _add_joints(
    mbs: exu.MainSystem, assembled: Substructure, on: list[int], ground: int
) -> tuple[list[int], list[int]]:
    """Springs and dampers between heights, and of bodies that roll against the level, on their lever.

    Beside them what is not linear in a joint; returns both, of the latter those to the base.
    """
    found, grounded = [], []
    for joint in assembled.joints:
        lower = ground if joint.lower == BASE else on[joint.lower]
        springs = [(on[joint.upper], lower, 1.0)]
        if joint.upper in assembled.rolling:
            springs.append((on[assembled.roll_of(joint.upper)], ground, joint.lever**2))
        if joint.upper in assembled.pitching:
            springs.append((on[assembled.pitch_of(joint.upper)], ground, joint.reach**2))
        for upper, end, factor in springs:
            spring = eii.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=[upper, end],
                stiffness=joint.stiffness * factor,
                damping=joint.damping * factor,
            )
            found.append(int(mbs.AddObject(spring)))
        if joint.laws:
            beside = eii.ObjectConnectorCoordinateSpringDamper(markerNumbers=[on[joint.upper], lower])
            beside.springForceUserFunction = joint_law(mbs, joint)
            number = int(mbs.AddObject(beside))
            grounded += [number] if joint.lower == BASE else []
    return found, grounded


class _Law:
    """The law of a pantograph's contacts, one function for all of them."""

    def __init__(self, mbs: exu.MainSystem, up: int, law: ContactLaw) -> None:
        self._mbs, self._law, self._function = mbs, law, push_only(mbs, up, law)
        self._upright = np.eye(3)[up]

    def connect(
        self,
        wires: Sequence[WireParts],
        wire: int,
        ahead: float,
        strip_marker: int,
        strip: Strip | None,
        *,
        rolls: bool,
    ) -> ContactParts:
        """Add the contact of a strip with a wire, which stands at the wire's begin until it is moved."""
        first = wires[wire].elements[0]
        on_wire = self._mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=first))
        connector = eii.ObjectConnectorCartesianSpringDamper(
            markerNumbers=[on_wire, strip_marker],
            stiffness=list(self._law.stiffness * self._upright),
            damping=list(self._law.damping * self._upright),
            springForceUserFunction=self._function,
        )
        number = int(self._mbs.AddObject(connector))
        return ContactParts(wire, ahead, strip, int(on_wire), strip_marker, rolls, number)


class Contacts:
    """Moves each pantograph's contacts along the wires, and reads them."""

    def __init__(
        self,
        mbs: exu.MainSystem,
        system: System,
        wires: Sequence[WireParts],
        pantographs: Sequence[PantographParts],
    ) -> None:
        self._mbs, self._wires, self._pantographs = mbs, wires, pantographs
        self._paths, self._up = system.contact_paths, system.axes - 1
        self._element: dict[int, int] = {}  # of each connector, where it is known

    def move_to(self, positions: Sequence[float] | Floats, speed: float) -> None:
        """Put the pantographs at these positions [m] along the track, shape (pantographs,), at a speed [m/s].

        What depends on the wire's line at the contact, its inclination and where it lies across the track,
        is taken from the current state: that is a time step late.
        """
        changed = False
        for parts, position in zip(self._pantographs, positions, strict=True):
            for contact in parts.contacts:
                changed |= self._move(contact, float(position) + contact.ahead, speed)
        if changed:
            self._mbs.AssembleLTGLists()

    def _move(self, contact: ContactParts, position: float, speed: float) -> bool:
        """True if the contact is on another element than before."""
        mbs, path = self._mbs, self._paths[contact.wire]
        self._set_on(contact, path.meets(position))
        e, share = path.locate(float(np.clip(position, path.x[0], path.x[-1])))
        element, place = self._wires[contact.wire].elements[e], [share * float(path.lengths[e]), 0, 0]
        changed = self._element.get(contact.connector) != element
        if changed:
            self._element[contact.connector] = element
            mbs.SetMarkerParameter(contact.wire_marker, "bodyNumber", element)
        mbs.SetMarkerParameter(contact.wire_marker, "localPosition", place)
        if contact.rolls:
            lateral = mbs.GetObjectOutputBody(element, exu.OutputVariableType.Position, place)[1]
            mbs.SetMarkerParameter(contact.strip_marker, "localPosition", [contact.arm, float(lateral), 0])
        height, climb = path.surface(position)
        if path.irregularity:
            mbs.SetObjectParameter(contact.connector, "offset", list(height * np.eye(3)[self._up]))
        damping = list(mbs.GetObjectParameter(contact.connector, "damping"))
        if damping[self._up]:
            slope = mbs.GetObjectOutputBody(element, exu.OutputVariableType.Director1, place)
            damping[0] = speed * (float(slope[self._up] / slope[0]) + climb)
            mbs.SetObjectParameter(contact.connector, "damping", damping)
        return changed

    def _set_on(self, contact: ContactParts, on: bool) -> None:
        """Beyond its wire's ends a contact does not act."""
        if on != self.meets(contact):
            self._mbs.SetObjectParameter(contact.connector, "activeConnector", on)

    def meets(self, contact: ContactParts) -> bool:
        """Whether the strip is between the ends of the wire."""
        return bool(self._mbs.GetObjectParameter(contact.connector, "activeConnector"))

    def force(self, contact: ContactParts) -> float:
        """[N] upward on the wire at the current state."""
        if not self.meets(contact):
            return 0.0
        return float(self._mbs.GetObjectOutput(contact.connector, exu.OutputVariableType.Force)[self._up])

    def height(self, marker: int) -> float:
        """[m] of a position marker at the current state."""
        return float(self._mbs.GetMarkerOutput(marker, exu.OutputVariableType.Position)[self._up])

    def to_the_left(self, marker: int) -> float:
        """[m] of a position marker from the track's centre at the current state, in space."""
        return float(self._mbs.GetMarkerOutput(marker, exu.OutputVariableType.Position)[1])

    def lateral(self, contact: ContactParts) -> float:
        """[m] to the left of the middle of a strip that rolls, where the contact is on it."""
        if not contact.rolls:
            return 0.0
        return float(self._mbs.GetMarkerParameter(contact.strip_marker, "localPosition")[1])
