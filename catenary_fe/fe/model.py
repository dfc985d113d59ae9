"""A catenary, as it was installed, as an Exudyn system."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.solver import new_system
from catenary_fe.fe.wire import (
    COORDINATES,
    UP,
    WireItems,
    WireLine,
    add_ground_coordinate,
    add_overlay,
    add_wire,
    anchor_and_tension,
    hold,
)
from catenary_fe.system import Catenary

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Installation:
    """What the crew sets: how the wires hang, and the droppers, arms and supports that make them do so.

    contact, messenger : the wires' static lines
    dropper_lengths : [m], shape (droppers,), stress-free
    arm_forces : [N], shape (spans + 1,), upward on the contact wire where it hangs, 0 without an arm
    support_forces : [N], shape (spans + 1,), upward on the messenger wire where it hangs
    """

    contact: WireLine
    messenger: WireLine
    dropper_lengths: Floats
    arm_forces: Floats
    support_forces: Floats


@dataclass(frozen=True)
class Model:
    """An Exudyn system of a catenary, and where its parts are.

    mbs : the system, not yet assembled
    droppers : numbers of the dropper connectors
    dropper_lengths : [m], stress-free
    ground : number of a coordinate marker that never moves
    held_arms, held_supports : constraints by support number, in a model of the installation
    """

    mbs: Any
    catenary: Catenary
    mesh: Mesh
    contact: WireItems
    messenger: WireItems
    droppers: list[int]
    dropper_lengths: Floats
    ground: int
    held_arms: dict[int, int]
    held_supports: dict[int, int]

    @property
    def contact_wire_height(self) -> float:
        """[m], nominal."""
        return self.catenary.contact_wire_height

    def wire_shapes(self, coordinates: Floats) -> tuple[Floats, Floats]:
        """Total coordinates of the nodes of contact and messenger wire, each of shape (nodes, 4)."""
        n = COORDINATES * len(self.contact.nodes)
        m = n + COORDINATES * len(self.messenger.nodes)
        contact = self.contact.line.coordinates() + coordinates[:n].reshape(-1, COORDINATES)
        messenger = self.messenger.line.coordinates() + coordinates[n:m].reshape(-1, COORDINATES)
        return contact, messenger

    def held_force(self, constraint: int) -> float:
        """[N] upward, with which a constraint holds its wire at the current state."""
        return float(self.mbs.GetObjectOutput(constraint, exu.OutputVariableType.Force))

    def dropper_forces(self) -> Floats:
        """[N], shape (droppers,), tension at the current state."""
        force = exu.OutputVariableType.Force
        axial = [np.linalg.norm(self.mbs.GetObjectOutput(d, force)) for d in self.droppers]
        return np.array(axial)


def dropper_damping(catenary: Catenary) -> Floats:
    """[N s/m], shape (droppers,): a taut dropper's own damping and its share of the β K damping."""
    return np.array([d.damping + catenary.damping.beta * d.stiffness for d in catenary.droppers])


def build_model(catenary: Catenary, mesh: Mesh, installation: Installation, *, held: bool = False) -> Model:
    """Build wires, droppers, supports and steady arms.

    held : instead of springs, constraints hold the messenger wire at its supports and the contact wire at
        the arms that shall give it its design height: their forces are what an installation sets.
    """
    mbs = new_system()
    contact = add_wire(mbs, catenary.contact_wire, installation.contact)
    messenger = add_wire(mbs, catenary.messenger_wire, installation.messenger)
    ground = add_ground_coordinate(mbs)
    for wire, items in ((catenary.contact_wire, contact), (catenary.messenger_wire, messenger)):
        anchor_and_tension(mbs, items, ground, wire)
    masses = point_masses(catenary, mesh, installation.dropper_lengths)
    add_overlay(mbs, (contact, messenger), masses, catenary.damping)
    droppers = _add_droppers(mbs, catenary, mesh, contact, messenger, installation.dropper_lengths)
    held_arms = _add_arms(mbs, catenary, mesh, contact, ground, installation, held)
    held_supports = _add_supports(mbs, catenary, mesh, messenger, ground, installation, held)
    lengths = installation.dropper_lengths
    return Model(mbs, catenary, mesh, contact, messenger, droppers, lengths, ground, held_arms, held_supports)


def point_masses(catenary: Catenary, mesh: Mesh, lengths: Floats) -> Floats:
    """[kg], shape (nodes,), of clamps, droppers and arms by node, contact wire first."""
    on_contact, on_messenger = np.zeros(mesh.contact.x.size), np.zeros(mesh.messenger.x.size)
    for i, dropper in enumerate(catenary.droppers):
        half = dropper.mass_per_length * lengths[i] / 2
        on_contact[mesh.contact.droppers[i]] += dropper.contact_wire_clamp_mass + half
        on_messenger[mesh.messenger.droppers[i]] += dropper.messenger_clamp_mass + half
    for i, support in list(enumerate(catenary.supports))[1:-1]:
        if support.steady_arm:
            on_contact[mesh.contact.supports[i]] += support.steady_arm.mass
    return np.concatenate([on_contact, on_messenger])


def _tension_only(mbs, t, itemNumber, deltaL, deltaL_t, stiffness, damping, force):  # type: ignore[no-untyped-def]
    return one_sided(deltaL, deltaL_t, stiffness, damping)


def one_sided(stretch: Any, rate: Any, stiffness: Any, damping: Any) -> Any:
    """Symbolic force of a spring and damper that act one way only.

    The damper's part is at most the spring's: the force is continuous where the spring goes slack, which
    Newton's method needs, and never turns round.
    """
    symbolic = exu.symbolic
    spring = symbolic.max(symbolic.Real(0.0), stiffness * stretch)
    return spring + symbolic.max(-spring, symbolic.min(spring, damping * rate))


def dropper_function(mbs: exu.MainSystem) -> object:
    """The force law of droppers, in C++; one object serves all droppers of a system, which keeps it alive."""
    from exudyn.advancedUtilities import CreateSymbolicUserFunction

    function = CreateSymbolicUserFunction(
        mbs, _tension_only, "springForceUserFunction", itemTypeName="ObjectConnectorSpringDamper"
    )
    mbs.variables["tension only"] = function
    return function


def _add_droppers(
    mbs: exu.MainSystem,
    catenary: Catenary,
    mesh: Mesh,
    contact: WireItems,
    messenger: WireItems,
    lengths: Floats,
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
                        contact.position_marker(mbs, int(mesh.contact.droppers[i])),
                        messenger.position_marker(mbs, int(mesh.messenger.droppers[i])),
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


def _add_arms(
    mbs: exu.MainSystem,
    catenary: Catenary,
    mesh: Mesh,
    contact: WireItems,
    ground: int,
    installation: Installation,
    held: bool,
) -> dict[int, int]:
    """Steady arms; the contact wire's ends are held where they are."""
    last = len(catenary.supports) - 1
    constraints = {}
    for i, support in enumerate(catenary.supports):
        node, arm = int(mesh.contact.supports[i]), support.steady_arm
        if i in (0, last):
            hold(mbs, contact, node, UP, ground)
        elif arm and held and arm.holds_design_height:
            constraints[i] = hold(mbs, contact, node, UP, ground)
        elif arm:
            marker = contact.coordinate_marker(mbs, node, UP)
            _add_spring(mbs, [ground, marker], arm.stiffness, arm.damping, installation.arm_forces[i])
    return constraints


def _add_supports(
    mbs: exu.MainSystem,
    catenary: Catenary,
    mesh: Mesh,
    messenger: WireItems,
    ground: int,
    installation: Installation,
    held: bool,
) -> dict[int, int]:
    last = len(catenary.supports) - 1
    constraints = {}
    for i, support in enumerate(catenary.supports):
        node, stiffness = int(mesh.messenger.supports[i]), support.messenger_stiffness
        if held or i in (0, last) or stiffness is None:
            constraints[i] = hold(mbs, messenger, node, UP, ground)
        else:
            marker = messenger.coordinate_marker(mbs, node, UP)
            force = installation.support_forces[i]
            _add_spring(mbs, [ground, marker], stiffness, support.messenger_damping, force)
    return constraints


def _add_spring(
    mbs: exu.MainSystem, markers: list[int], stiffness: float, damping: float, preload: float
) -> None:
    """A vertical spring to the ground that pushes up by ``preload`` where the wire hangs."""
    mbs.AddObject(
        eii.ObjectConnectorCoordinateSpringDamper(markerNumbers=markers, stiffness=stiffness, damping=damping)
    )
    mbs.AddLoad(eii.LoadCoordinate(markerNumber=markers[1], load=float(preload)))
