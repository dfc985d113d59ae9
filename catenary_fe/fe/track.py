"""What curves and cant do to the wires, as seen from the track: forces to its inside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.installation import wire_field, wire_kinds
from catenary_fe.fe.mesh import Mesh
from catenary_fe.layout import GRAVITY, Catenary
from catenary_fe.layout.terminations import shares_at_supports
from catenary_fe.layout.track import cant_bends, lean

Floats = NDArray[np.float64]


def node_lean(catenary: Catenary, mesh: Mesh) -> Floats:
    """[rad], shape (nodes of all wires,): by which the track leans to the left there."""
    return lean(catenary, np.concatenate([wire.x for wire in mesh.wires]))


def cant_forces(catenary: Catenary, mesh: Mesh) -> Floats:
    """[N], shape (nodes of all wires,): to the left, where the cant begins or ends to rise.

    Seen from the track a straight wire at the height z has a kink there, T times the change of z φ'. It acts
    at supports, where the cant is given; stitch wires' share is the messenger wire's.
    """
    forces = np.zeros(int(mesh.first_nodes[-1]))
    if not any(support.cant for support in catenary.supports):
        return forces
    for number, (wire, kind) in enumerate(zip(mesh.wires, wire_kinds(catenary, mesh), strict=True)):
        if number == mesh.first_stitch:
            break
        name = wire_field(mesh, number)
        of_wire = name == "contact_wire"
        heights = catenary.contact_wire_heights if of_wire else catenary.messenger_support_heights
        tension = kind.tension * shares_at_supports(catenary, name)
        forces[mesh.first_nodes[number] + wire.supports] += tension * cant_bends(catenary, heights)
    return forces


def leaning_weights(catenary: Catenary, mesh: Mesh, masses: Floats) -> Floats:
    """[N], shape (nodes of all wires,): to the left, what of the weight of masses [kg] a canted track leaves.

    Across a plane that leans by φ weight has the part g sin φ; that it is g cos φ across that, 0.5 % less at
    0.1 rad, is left out.
    """
    weights: Floats = GRAVITY * np.sin(node_lean(catenary, mesh)) * masses
    return weights
