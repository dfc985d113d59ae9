"""Pantographs as bodies and springs, and their moving contact with the wire."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.model import one_sided
from catenary_fe.fe.wire import UP, WireItems
from catenary_fe.system import AnyPantograph, ElasticPantograph, Pantograph

Floats = NDArray[np.float64]
_PIECES, _HALVINGS = 6, 40  # straight pieces of a law to try for the start, then halvings of its force
_ALONG_TO_UP = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]  # Mass1D moves along its own first axis


class Track(Protocol):
    """A system with a wire that pantographs run along, such as a :class:`~catenary_fe.fe.model.Model`."""

    @property
    def mbs(self) -> Any: ...

    @property
    def contact(self) -> WireItems: ...

    @property
    def ground(self) -> int: ...

    @property
    def contact_wire_height(self) -> float: ...


@dataclass(frozen=True)
class PantographItems:
    """Numbers of a pantograph's items in an Exudyn system.

    nodes : one for each mass, head first; coordinate 0 is the height above the nominal contact wire height
    uplift_load : the constant force on the lowest mass, None without masses
    wire_marker, connector : the contact's point on the wire, and its spring
    """

    pantograph: AnyPantograph
    nodes: list[int]
    uplift_load: int | None
    wire_marker: int
    connector: int


def add_pantograph(model: Track, pantograph: Pantograph, uplift: float, function: object) -> PantographItems:
    """Add a pantograph's masses and springs, and its contact at the wire's first element.

    uplift : [N] upward force on the lowest mass; its weight is balanced by its frame
    function : what :func:`contact_function` made for this system
    """
    mbs = model.mbs
    nodes = [int(mbs.AddNode(eii.Node1D(referenceCoordinates=[0.0]))) for _ in pantograph.stages]
    bodies = [
        mbs.AddObject(
            eii.ObjectMass1D(
                mass=stage.mass,
                nodeNumber=node,
                referencePosition=[0, model.contact_wire_height, 0],
                referenceRotation=_ALONG_TO_UP,
            )
        )
        for stage, node in zip(pantograph.stages, nodes, strict=True)
    ]
    markers = [mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=n, coordinate=0)) for n in nodes]
    for stage, pair in zip(
        pantograph.stages, zip(markers, [*markers[1:], model.ground], strict=True), strict=True
    ):
        mbs.AddObject(
            eii.ObjectConnectorCoordinateSpringDamper(
                markerNumbers=list(pair), stiffness=stage.stiffness, damping=stage.damping
            )
        )
    load = mbs.AddLoad(eii.LoadCoordinate(markerNumber=markers[-1], load=uplift))
    on_wire = mbs.AddMarker(
        eii.MarkerBodyPosition(bodyNumber=model.contact.elements[0], localPosition=[0, 0, 0])
    )
    on_head = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=bodies[0], localPosition=[0, 0, 0]))
    connector = mbs.AddObject(
        eii.ObjectConnectorCartesianSpringDamper(
            markerNumbers=[on_wire, on_head],
            stiffness=[0, pantograph.contact_stiffness, 0],
            damping=[0, pantograph.contact_damping, 0],
            springForceUserFunction=function,
        )
    )
    return PantographItems(pantograph, nodes, int(load), int(on_wire), int(connector))


def add_elastic_pantograph(model: Track, pantograph: ElasticPantograph, function: object) -> PantographItems:
    """Add a force that falls as the wire rises, at the wire's first element.

    function : what :func:`elastic_function` made for this system

    A connector with the law in it, not a load: the force belongs to the height at the step's end.
    """
    mbs = model.mbs
    on_wire = mbs.AddMarker(
        eii.MarkerBodyPosition(bodyNumber=model.contact.elements[0], localPosition=[0, 0, 0])
    )
    rail = mbs.AddNode(eii.NodePointGround(referenceCoordinates=[0, model.contact_wire_height, 0]))
    nominal = mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=rail))
    force, stiffness = pantograph.tangent(0.0)
    connector = mbs.AddObject(
        eii.ObjectConnectorCartesianSpringDamper(
            markerNumbers=[on_wire, nominal],
            stiffness=[0, stiffness, 0],
            damping=[force, 0, 0],
            springForceUserFunction=function,
        )
    )
    return PantographItems(pantograph, [], None, int(on_wire), int(connector))


def _push_only(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):  # type: ignore[no-untyped-def]
    # the head's velocity is seen from the wire's material point; damping[0], of no use in the plane, holds
    # what the wire's inclination adds (the offset, which would be the place, is taken off the displacement)
    push = one_sided(displacement[1], velocity[1] - damping[0], stiffness[1], damping[1])
    return [0.0, push, 0.0]


def _slacken(mbs, t, itemNumber, displacement, velocity, stiffness, damping, offset):  # type: ignore[no-untyped-def]
    # displacement is that of the nominal height from the wire; damping[0] holds the force there
    symbolic = exu.symbolic
    push = symbolic.max(symbolic.Real(0.0), damping[0] + stiffness[1] * displacement[1])
    return [0.0, push, 0.0]


def contact_function(model: Track) -> object:
    """The unilateral contact law, in C++; it must outlive the connectors that use it."""
    return _in_cpp(model, _push_only, "push only")


def elastic_function(model: Track) -> object:
    """The law of elastic pantographs, likewise."""
    return _in_cpp(model, _slacken, "slacken")


def _in_cpp(model: Track, law: Callable[..., Any], name: str) -> object:
    from exudyn.advancedUtilities import CreateSymbolicUserFunction

    function = CreateSymbolicUserFunction(
        model.mbs, law, "springForceUserFunction", itemTypeName="ObjectConnectorCartesianSpringDamper"
    )
    model.mbs.variables[name] = function
    return function


def add_pantographs(
    model: Track, pantographs: Sequence[tuple[AnyPantograph, float]]
) -> list[PantographItems]:
    """Add pantographs of any kind, each with its uplift [N]."""
    chains = any(isinstance(p, Pantograph) for p, _ in pantographs)
    push = contact_function(model) if chains else None
    slacken = elastic_function(model) if not all(isinstance(p, Pantograph) for p, _ in pantographs) else None
    return [
        add_elastic_pantograph(model, pantograph, slacken)
        if isinstance(pantograph, ElasticPantograph)
        else add_pantograph(model, pantograph, uplift, push)
        for pantograph, uplift in pantographs
    ]


class MovingContact:
    """Moves each pantograph's contact point along the wire, from step to step."""

    def __init__(self, model: Track, pantographs: Sequence[PantographItems]) -> None:
        self._mbs = model.mbs
        self._wire = model.contact
        self._pantographs = pantographs
        self._at = [(-1, 0.0)] * len(pantographs)
        self._elevation = [0.0] * len(pantographs)
        self._tangent = [
            p.pantograph.tangent(0.0) if isinstance(p.pantograph, ElasticPantograph) else None
            for p in pantographs
        ]

    def move_to(self, positions: Floats, speed: float) -> None:
        """Put the contact points at these positions [m] along the track, shape (pantographs,)."""
        changed = False
        for i, items in enumerate(self._pantographs):
            before = self._at[i][0]
            self._at[i] = element, local = locate(self._wire, float(positions[i]))
            if element != before:
                self._mbs.SetMarkerParameter(items.wire_marker, "bodyNumber", self._wire.elements[element])
                changed = True
            self._mbs.SetMarkerParameter(items.wire_marker, "localPosition", [local, 0, 0])
            if isinstance(items.pantograph, ElasticPantograph):
                self._follow_law(i, items.pantograph)
            elif items.pantograph.contact_damping:
                climb = speed * self.inclination(i)
                damping = [climb, items.pantograph.contact_damping, 0]
                self._mbs.SetObjectParameter(items.connector, "damping", damping)
        if changed:
            self._mbs.AssembleLTGLists()

    def settle_laws(self, solve: Callable[[], None]) -> None:
        """Bring static wire and the laws of elastic pantographs together.

        solve : finds static equilibrium with the forces as they are set
        """
        laws = {
            i: items.pantograph
            for i, items in enumerate(self._pantographs)
            if isinstance(items.pantograph, ElasticPantograph) and items.pantograph.law
        }
        for _ in range(_PIECES if laws else 0):
            if not self._take_tangents(laws):
                return
            solve()
        if laws:
            # the straight pieces alternate; but the wire rises with the force, and the law falls
            low, high = dict.fromkeys(laws, 0.0), {i: law.law[0][1] for i, law in laws.items()}
            for _ in range(_HALVINGS):
                middle = {i: (low[i] + high[i]) / 2 for i in laws}
                for i, force in middle.items():
                    self._set_law(i, (force, 0.0))
                solve()
                for i, law in laws.items():
                    rising = law.contact_force(self._elevation_now(i)) > middle[i]
                    (low if rising else high)[i] = middle[i]
            self._take_tangents(laws)
            solve()

    def _take_tangents(self, laws: dict[int, ElasticPantograph]) -> bool:
        """Take the straight piece of each law where the wire is now; true if one of them changed."""
        changed = False
        for i, law in laws.items():
            self._elevation[i] = self._elevation_now(i)
            changed |= self._set_law(i, law.tangent(self._elevation[i]))
        return changed

    def _follow_law(self, i: int, pantograph: ElasticPantograph) -> None:
        """Take the straight piece of the law where the wire is expected at the step's end."""
        before, now = self._elevation[i], self._elevation_now(i)
        self._elevation[i] = now
        self._set_law(i, pantograph.tangent(2 * now - before))

    def _elevation_now(self, i: int) -> float:
        displacement = exu.OutputVariableType.Displacement
        return -float(self._mbs.GetObjectOutput(self._pantographs[i].connector, displacement)[UP])

    def _set_law(self, i: int, tangent: tuple[float, float]) -> bool:
        """Let a connector push with F₀ − k · elevation; true if it did not before."""
        if tangent == self._tangent[i]:
            return False
        self._tangent[i] = tangent
        connector = self._pantographs[i].connector
        self._mbs.SetObjectParameter(connector, "stiffness", [0, tangent[1], 0])
        self._mbs.SetObjectParameter(connector, "damping", [tangent[0], 0, 0])
        return True

    def inclination(self, pantograph: int) -> float:
        """dz/dx of the wire over a pantograph's head, at the current state."""
        element, local = self._at[pantograph]
        slope = self._mbs.GetObjectOutputBody(
            self._wire.elements[element], exu.OutputVariableType.Director1, [local, 0, 0]
        )
        return float(slope[UP] / slope[0])


def locate(wire: WireItems, position: float) -> tuple[int, float]:
    """Number of the wire's element at a position [m] along the track, and the arc length [m] inside it."""
    x = wire.line.x
    element = min(max(int(np.searchsorted(x, position, side="right")) - 1, 0), x.size - 2)
    fraction = (position - x[element]) / (x[element + 1] - x[element])
    return element, float(fraction * wire.line.lengths[element])
