"""Forces and pantographs that move along one wire."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.contact import MovingContact, locate
from catenary_fe.engines.exudyn.pantograph import add_pantographs
from catenary_fe.engines.exudyn.wire import WireItems
from catenary_fe.fe.wire_problem import Load, SlidingPantograph
from catenary_fe.theory import ElasticPantograph, MovingForce

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class WireTrack:
    """What moving loads need to know of a system of one wire."""

    mbs: Any
    contact: WireItems
    ground: int
    contact_wire_height: float

    @property
    def contacts(self) -> tuple[WireItems]:
        """The one wire."""
        return (self.contact,)


class WireLoad(Protocol):
    """A load in a system, as the run sees it."""

    def move_to(self, t: float) -> None:
        """Take the place, and the force known in advance, of time ``t`` [s]."""

    def force(self) -> float:
        """[N] on the wire at the current state, 0 off the wire."""

    def deflection(self) -> float:
        """[m] of the wire at the load, NaN off the wire."""

    def head(self) -> float:
        """[m] height of the head, NaN where there is none."""


def add_load(track: WireTrack, load: Load) -> WireLoad:
    """Add a load to a system that has its wire."""
    return _Pantograph(track, load) if isinstance(load, SlidingPantograph) else _Force(track, load)


class _Place:
    """A point that moves along the wire."""

    def __init__(self, track: WireTrack, start: float, speed: float) -> None:
        self._track, self._start, self._speed = track, start, speed
        self.element, self.local, self.on_wire = 0, 0.0, True

    def move_to(self, t: float) -> float:
        x = self._start + self._speed * t
        nodes = self._track.contact.line.x
        self.on_wire = bool(nodes[0] <= x <= nodes[-1])
        self.element, self.local = locate(self._track.contact, min(max(x, nodes[0]), nodes[-1]))
        return x

    def height(self) -> float:
        if not self.on_wire:
            return float("nan")
        body = self._track.contact.elements[self.element]
        position = exu.OutputVariableType.Position
        return float(
            self._track.mbs.GetObjectOutputBody(body, position, [self.local, 0, 0])[self._track.contact.up]
        )


class _Force:
    """A force known in advance, or one that depends on the wire's deflection."""

    def __init__(self, track: WireTrack, law: MovingForce | ElasticPantograph) -> None:
        self._mbs, self._wire, self._law = track.mbs, track.contact, law
        self._place = _Place(track, law.start, law.speed)
        self._marker = self._mbs.AddMarker(
            eii.MarkerBodyPosition(bodyNumber=track.contact.elements[0], localPosition=[0, 0, 0])
        )
        self._load = self._mbs.AddLoad(eii.LoadForceVector(markerNumber=self._marker, loadVector=[0, 0, 0]))
        self._force = 0.0
        self._before: float | None = None

    def move_to(self, t: float) -> None:
        expected = self._expected_deflection()
        self._place.move_to(t)
        self._force = self._law.contact_force(t, expected) if self._place.on_wire else 0.0
        set_marker = self._mbs.SetMarkerParameter
        set_marker(self._marker, "bodyNumber", self._wire.elements[self._place.element])
        set_marker(self._marker, "localPosition", [self._place.local, 0, 0])
        self._mbs.SetLoadParameter(self._load, "loadVector", [0, self._force, 0])

    def _expected_deflection(self) -> float:
        """At the step's end, from the last two: second order, and no Python inside the Newton iteration."""
        if isinstance(self._law, MovingForce) or not self._place.on_wire:
            return 0.0
        now = self.deflection()
        expected = now if self._before is None else 2 * now - self._before
        self._before = now
        return expected

    def force(self) -> float:
        return self._force

    def deflection(self) -> float:
        return self._place.height()

    def head(self) -> float:
        return float("nan")


class _Pantograph:
    """A pantograph of lumped masses behind the moving contact of the runs on a catenary."""

    def __init__(self, track: WireTrack, sliding: SlidingPantograph) -> None:
        self._mbs, self._sliding = track.mbs, sliding
        (self._items,) = add_pantographs(track, [(sliding.pantograph, sliding.uplift)])
        (self._point,) = self._items.contacts
        self._contact = MovingContact(track, [self._items])
        self._place = _Place(track, sliding.start, sliding.speed)

    def move_to(self, t: float) -> None:
        x = self._place.move_to(t)
        if not self._place.on_wire:
            self._mbs.SetObjectParameter(self._point.connector, "activeConnector", False)
            return
        self._contact.move_to(np.array([x]), self._sliding.speed)

    def force(self) -> float:
        if not self._place.on_wire:
            return 0.0
        force = self._mbs.GetObjectOutput(self._point.connector, exu.OutputVariableType.Force)
        return float(force[self._point.wire.up])

    def deflection(self) -> float:
        return self._place.height()

    def head(self) -> float:
        return float(self._mbs.systemData.GetODE2Coordinates()[self._index()])

    def _index(self) -> int:
        return int(self._mbs.systemData.GetNodeLTGODE2(self._items.heights[0][0])[0])
