"""What curves and cant do to the wires, as seen from the track: forces to its inside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.mesh import Mesh
from catenary_fe.layout import GRAVITY, Catenary
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
    lines = [(catenary.contact_wire, catenary.contact_wire_heights)] * mesh.contact_wires
    if catenary.messenger_wire:
        lines.append((catenary.messenger_wire, catenary.messenger_support_heights))
    for number, (wire, heights) in enumerate(lines):
        at = mesh.first_nodes[number] + mesh.wires[number].supports
        forces[at] += wire.tension * cant_bends(catenary, heights)
    return forces


def leaning_weights(catenary: Catenary, mesh: Mesh, masses: Floats) -> Floats:
    """[N], shape (nodes of all wires,): to the left, what of the weight of masses [kg] a canted track leaves.

    Across a plane that leans by φ weight has the part g sin φ; that it is g cos φ across that, 0.5 % less at
    0.1 rad, is left out.
    """
    weights: Floats = GRAVITY * np.sin(node_lean(catenary, mesh)) * masses
    return weights
