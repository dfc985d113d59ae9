"""What a compiled run integrates: equations of motion for large motions, and static contact at the start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.contact import MovingContact
from catenary_fe.engines.exudyn.model import Model, build_model
from catenary_fe.engines.exudyn.pantograph import PantographItems, add_pantographs
from catenary_fe.engines.exudyn.run import raise_heads
from catenary_fe.engines.exudyn.solver import release, solve_static
from catenary_fe.fe.installation import Installation
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.reduction import ContactLine, contact_lines
from catenary_fe.fe.system import System, assemble
from catenary_fe.layout import AnyPantograph, Catenary

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class NonlinearModel:
    """A system's equations of motion over its free coordinates.

    mass, damping : sparse; droppers' damping is not in it
    tangent_damping : sparse, damping at static equilibrium, all droppers taut
    ground_stiffness : [N/m], shape (free,), of vertical and lateral springs to the ground
    force : [N], shape (free,), weight, tensions, preloads, balance
    contacts : the contact wires, their ``static`` and ``lateral`` those of the reference
    """

    system: System
    mass: Any
    damping: Any
    tangent_damping: Any
    ground_stiffness: Floats
    force: Floats
    contacts: tuple[ContactLine, ...]

    @property
    def size(self) -> int:
        """Number of free coordinates."""
        return self.system.size

    @property
    def in_space(self) -> bool:
        """Whether it has coordinates to the side."""
        return self.system.in_space


@dataclass(frozen=True)
class ContactStart:
    """Static contact at the start of a run.

    wires : shape (all coordinates,), displacements
    heads : for each pantograph shape (coordinates,): heights of its masses, then rolls of its strips
    forces : [N], for each pantograph shape (contacts,)
    """

    wires: Floats
    heads: list[Floats]
    forces: list[Floats]


def nonlinear_model(catenary: Catenary, mesh: Mesh, installation: Installation) -> NonlinearModel:
    """Equations of motion of a catenary."""
    system = assemble(catenary, mesh, installation)
    damping = system.damping()
    return NonlinearModel(
        system=system,
        mass=system.free(system.mass),
        damping=system.free(damping),
        tangent_damping=system.free(damping + system.taut_damping()),
        ground_stiffness=system.gather(system.ground_stiffness),
        force=system.gather(system.force),
        contacts=contact_lines(system, mesh, installation, system.place),
    )


def contact_start(
    catenary: Catenary,
    mesh: Mesh,
    installation: Installation,
    pantographs: Sequence[tuple[AnyPantograph, float]],
    positions: Floats,
) -> ContactStart:
    """Static contact of pantographs, each with its uplift [N], at positions [m] along the track.

    Raises SolverError if there is no equilibrium.
    """
    model = build_model(catenary, mesh, installation)
    items = add_pantographs(model, pantographs)
    contact = MovingContact(model, items)
    mbs = model.mbs
    mbs.Assemble()
    contact.move_to(positions, 0.0)
    raise_heads(model, items)
    solve_static(mbs, what="static contact at the start")
    contact.settle_laws(lambda: solve_static(mbs, what="static contact at the start"))
    q = mbs.systemData.GetODE2Coordinates()
    size = model.node_width * int(mesh.first_nodes[-1])
    found = ContactStart(
        wires=q[:size],
        heads=[_head_coordinates(model, item, q) for item in items],
        forces=[contact.forces(item) for item in items],
    )
    release(mbs)
    return found


def _head_coordinates(model: Model, item: PantographItems, q: Floats) -> Floats:
    number = [model.mbs.systemData.GetNodeLTGODE2(node)[k] for node, k in (*item.heights, *item.rolls)]
    return q[np.array(number, dtype=np.int64)]
