"""Pantographs as bodies and springs, and their contacts with the wires."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np

from catenary_fe.engines.exudyn.laws import contact_function, elastic_function
from catenary_fe.engines.exudyn.wire import WireItems
from catenary_fe.layout import DescribedPantograph, ElasticPantograph, Pantograph, Stage

_TO_UP = {  # rotations that turn the first axis, along which Mass1D moves, up
    1: [[0, -1, 0], [1, 0, 0], [0, 0, 1]],
    2: [[0, 0, -1], [0, 1, 0], [1, 0, 0]],
}
_HEAVE, _ROLL = 2, 3  # coordinates of a rigid body's node


class Track(Protocol):
    """A system with wires that pantographs run along."""

    @property
    def mbs(self) -> Any: ...

    @property
    def contacts(self) -> Sequence[WireItems]: ...

    @property
    def ground(self) -> int: ...

    @property
    def contact_wire_height(self) -> float: ...


@dataclass(frozen=True)
class ContactItems:
    """One collector strip on one contact wire.

    wire : the contact wire
    ahead : [m] of the strip before the pantograph's position
    wire_marker, head_marker : the contact's points on the wire and on the strip
    rolls : whether the strip's point follows the wire sideways
    connector : the contact's spring
    """

    wire: WireItems
    ahead: float
    wire_marker: int
    head_marker: int
    rolls: bool
    connector: int


@dataclass(frozen=True)
class PantographItems:
    """Numbers of a pantograph's items in an Exudyn system.

    heights : node and coordinate of the height of each mass above the nominal contact wire height; the
        head's strips first
    strips : how many of them are collector strips, 0 without masses
    contacts : each strip on each contact wire
    """

    pantograph: DescribedPantograph
    heights: list[tuple[int, int]]
    strips: int
    contacts: list[ContactItems]

    @property
    def rolls(self) -> list[tuple[int, int]]:
        """Node and coordinate of the roll of each strip that rolls."""
        return [(node, _ROLL) for node, coordinate in self.heights if coordinate == _HEAVE]


@dataclass(frozen=True)
class _Mass:
    """A body that heaves, and perhaps rolls: its number, and its height's node and coordinate."""

    body: int
    node: int
    coordinate: int

    @property
    def rolls(self) -> bool:
        return self.coordinate == _HEAVE

    def marker(self, mbs: exu.MainSystem) -> int:
        marker = eii.MarkerNodeCoordinate(nodeNumber=self.node, coordinate=self.coordinate)
        return int(mbs.AddMarker(marker))


def add_pantographs(
    track: Track, pantographs: Sequence[tuple[DescribedPantograph, float]]
) -> list[PantographItems]:
    """Add pantographs of any kind, each with its uplift [N]: upward, on the lowest mass or on the wire.

    The weight of the masses is balanced by the frame. Their contacts start at the wires' first elements.
    """
    mbs, axes = track.mbs, track.contacts[0].line.axes
    kinds = {isinstance(p, ElasticPantograph) for p, _ in pantographs}
    push = contact_function(mbs, axes) if False in kinds else None
    update_dropper = elastic_function(mbs, axes) if True in kinds else None
    return [
        _add_elastic(track, pantograph, update_dropper)
        if isinstance(pantograph, ElasticPantograph)
        else _add_chain(track, pantograph, uplift, push)
        for pantograph, uplift in pantographs
    ]


def _add_chain(track: Track, pantograph: Pantograph, uplift: float, law: object) -> PantographItems:
    """Masses and springs, and the contact of each strip with each wire."""
    mbs, head = track.mbs, pantograph.head
    first, *others = pantograph.stages
    count = head.strips if head else 1
    masses = [_add_mass(track, stage.mass) for stage in others]
    strips = [_add_strip(track, pantograph, first, count) for _ in range(count)]
    below = [*(m.marker(mbs) for m in masses), track.ground]
    share = first.replace(
        mass=first.mass / count, stiffness=first.stiffness / count, damping=first.damping / count
    )
    for strip in strips:
        _add_spring(mbs, share, strip.marker(mbs), below[0])
    for i, stage in enumerate(others):
        _add_spring(mbs, stage, below[i], below[i + 1])
    lowest = [masses[-1].marker(mbs)] if masses else [s.marker(mbs) for s in strips]
    for marker in lowest:
        mbs.AddLoad(eii.LoadCoordinate(markerNumber=marker, load=uplift / len(lowest)))
    apart = head.strip_distance if head and head.strip_distance else 0.0
    contacts = [
        _add_contact(track, pantograph, wire, strip, apart * (0.5 - i) if count > 1 else 0.0, law)
        for i, strip in enumerate(strips)
        for wire in track.contacts
    ]
    heights = [(m.node, m.coordinate) for m in (*strips, *masses)]
    return PantographItems(pantograph, heights, count, contacts)


def _add_strip(track: Track, pantograph: Pantograph, stage: Stage, count: int) -> _Mass:
    head = pantograph.head
    in_space = track.contacts[0].line.axes == 3
    if head and head.spring_distance and in_space:
        roll = head.rolling_inertia(stage.mass) / count
        lever = head.spring_distance**2 / 4 / count
        return _add_rolling_mass(track, stage, count, roll, lever)
    return _add_mass(track, stage.mass / count)


def _add_mass(track: Track, mass: float) -> _Mass:
    mbs, up = track.mbs, track.contacts[0].up
    place = [0.0, 0.0, 0.0]
    place[up] = track.contact_wire_height
    node = int(mbs.AddNode(eii.Node1D(referenceCoordinates=[0.0])))
    body = mbs.AddObject(
        eii.ObjectMass1D(mass=mass, nodeNumber=node, referencePosition=place, referenceRotation=_TO_UP[up])
    )
    return _Mass(int(body), node, 0)


def _add_rolling_mass(track: Track, stage: Stage, count: int, inertia: float, lever: float) -> _Mass:
    """A rigid head on two springs: in heave it is the point mass; in roll the springs work on their lever."""
    mbs = track.mbs
    node = int(
        mbs.AddNode(eii.NodeRigidBodyRxyz(referenceCoordinates=[0, 0, track.contact_wire_height, 0, 0, 0]))
    )
    body = mbs.AddObject(
        eii.ObjectRigidBody(nodeNumber=node, mass=stage.mass / count, inertia=[inertia] * 3 + [0.0] * 3)
    )
    for coordinate in range(6):
        marker = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
        if coordinate == _ROLL:
            roll = Stage(mass=1.0, stiffness=stage.stiffness * lever, damping=stage.damping * lever)
            _add_spring(mbs, roll, marker, track.ground)
        elif coordinate != _HEAVE:
            mbs.AddObject(eii.ObjectConnectorCoordinate(markerNumbers=[track.ground, marker]))
    return _Mass(int(body), node, _HEAVE)


def _add_spring(mbs: exu.MainSystem, stage: Stage, upper: int, lower: int) -> None:
    mbs.AddObject(
        eii.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[upper, lower], stiffness=stage.stiffness, damping=stage.damping
        )
    )


def _add_contact(
    track: Track, pantograph: Pantograph, wire: WireItems, strip: _Mass, ahead: float, law: object
) -> ContactItems:
    mbs = track.mbs
    on_head = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=strip.body, localPosition=[0, 0, 0]))
    upright = np.eye(3)[wire.up]
    return _connect(
        track,
        wire,
        (ahead, int(on_head), strip.rolls),
        stiffness=pantograph.contact_stiffness * upright,
        damping=pantograph.contact_damping * upright,
        law=law,
    )


def _add_elastic(track: Track, pantograph: ElasticPantograph, law: object) -> PantographItems:
    """A connector with the law in it, not a load: the force belongs to the height at the step's end."""
    mbs, wire = track.mbs, track.contacts[0]
    place = track.contact_wire_height * np.eye(3)[wire.up]
    rail = mbs.AddNode(eii.NodePointGround(referenceCoordinates=list(place)))
    nominal = int(mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=rail)))
    force, stiffness = pantograph.tangent(0.0)
    contact = _connect(
        track,
        wire,
        (0.0, nominal, False),
        stiffness=stiffness * np.eye(3)[wire.up],
        damping=np.array([force, 0.0, 0.0]),
        law=law,
    )
    return PantographItems(pantograph, [], 0, [contact])


def _connect(
    track: Track,
    wire: WireItems,
    head: tuple[float, int, bool],
    *,
    stiffness: np.ndarray,
    damping: np.ndarray,
    law: object,
) -> ContactItems:
    mbs, (ahead, head_marker, rolls) = track.mbs, head
    on_wire = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=wire.elements[0], localPosition=[0, 0, 0]))
    connector = mbs.AddObject(
        eii.ObjectConnectorCartesianSpringDamper(
            markerNumbers=[on_wire, head_marker],
            stiffness=list(stiffness),
            damping=list(damping),
            springForceUserFunction=law,
        )
    )
    return ContactItems(wire, ahead, int(on_wire), head_marker, rolls, int(connector))
