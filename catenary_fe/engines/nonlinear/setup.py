"""From the model's equations to the arrays of a compiled run."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.factor import factorise, packed_rows
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.nonlinear.arrays import Ends, Factor, Stations, System
from catenary_fe.engines.nonlinear.cables import Elements
from catenary_fe.statics import Shape

if TYPE_CHECKING:
    from catenary_fe.fe.nonlinear_model import NonlinearModel
    from catenary_fe.fe.spring import Springs

Floats = NDArray[np.float64]


def make_system(model: NonlinearModel) -> System:
    """The equations of motion, filled up to a multiple of four coordinates."""
    more = -model.size % 4
    line = model.system
    cables = line.cables
    idle = np.zeros(more)
    return System(
        reference=line.reference,
        place=line.place,
        elements=Elements(
            line.first,
            cables.length,
            cables.axial_stiffness,
            cables.bending_stiffness,
            1 + cables.rest_strain,
        ),
        droppers=_ends(line.droppers),
        links=_ends(line.arms),
        ground=np.concatenate([model.ground_stiffness, idle]),
        force=np.concatenate([model.force, idle]),
        mass=packed_rows(_padded(model.mass, more, 1.0)),
        damping=packed_rows(_padded(model.damping, more, 0.0)),
    )


def _ends(springs: Springs) -> Ends:
    return Ends(
        springs.first, springs.last, springs.pivot, springs.length, springs.stiffness, springs.damping
    )


def _padded(matrix: Any, more: int, diagonal: float) -> Any:
    from scipy.sparse import block_diag, identity

    return block_diag([matrix, diagonal * identity(more)]).tocsr() if more else matrix


def make_stations(model: NonlinearModel, shape: Shape) -> Stations:
    """Contact wires and heights."""
    contacts, mesh, axes = model.contacts, shape.mesh, model.system.axes
    up, width = axes - 1, 2 * axes
    supports = [
        width * (first + wire.supports) + up
        for first, wire in zip(mesh.first_nodes, mesh.wires[: mesh.contact_wires], strict=False)
    ]
    return Stations(
        first=np.cumsum([0, *(wire.x.size for wire in contacts)]),
        x=np.concatenate([wire.x for wire in contacts]),
        lengths=np.concatenate([[*wire.lengths, 1.0] for wire in contacts]),
        static=np.concatenate([wire.static for wire in contacts]),
        lateral=np.concatenate([wire.lateral for wire in contacts]),
        at=np.concatenate([wire.index for wire in contacts]),
        supports=np.concatenate(supports),
        heights=width * np.arange(mesh.first_nodes[-1]) + up,
        rest=np.concatenate([wire.z for wire in shape.wires]),
        rest_supports=np.concatenate(
            [wire.z[m.supports] for wire, m in zip(shape.contact_wires, mesh.wires, strict=False)]
        ),
    )


def make_factor(model: NonlinearModel, scheme: Scheme, moved: Floats) -> Factor:
    """Factorise the step's matrix where all coordinates are displaced like this."""
    matrix = model.mass + scheme.g * model.tangent_damping + scheme.b * model.system.tangent(moved)
    factor = factorise(_padded(matrix, -model.size % 4, 1.0))
    return Factor(
        packed_rows(factor.L, "lower"),
        packed_rows(factor.L.T, "upper"),
        1 / factor.U.diagonal(),
        np.zeros(factor.shape[0]),
    )
