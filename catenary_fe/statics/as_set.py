"""Steady arms and supports as they were set: springs that give when the line changes after that."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import Catenary
from catenary_fe.statics.shape import Shape
from catenary_fe.statics.taut_wires import TautWires

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class MastSprings:
    """Vertical springs between masts and wires.

    at : shape (springs,), numbers of the wires' displacements
    force, height : [N], [m], shape (springs,), upward on the wire, and where the wire was then
    stiffness : [N/m], shape (springs,)
    """

    at: Integers
    force: Floats
    height: Floats
    stiffness: Floats

    def forces(self, heights: Floats) -> Floats:
        """[N], shape (springs,), upward, on wires at heights [m], shape (displacements,)."""
        forces: Floats = self.force - self.stiffness * (heights[self.at] - self.height)
        return forces


def mast_springs(catenary: Catenary, wires: TautWires, as_set: Shape) -> MastSprings:
    """Those of a line whose arms and supports were set before it changed.

    A spring keeps its preload. A link keeps its pivot: under the lateral force H its reach c makes of it a
    spring of H/c. (Sideways the wire is taken to stay where the arm held it: it moves by millimetres.)
    Messenger supports with a stiffness give too.

    as_set : the line then, in equilibrium
    """
    found: list[tuple[int, float, float, float]] = []
    mesh, then = wires.mesh, as_set.installation
    for i, support in list(enumerate(catenary.supports))[1:-1]:
        arm = support.steady_arm
        for wire in range(mesh.contact_wires if arm else 0):
            assert arm is not None
            force = then.arm_forces[wire, i]
            if arm.length is None:
                stiffness = arm.stiffness or 0.0
            else:
                stiffness = float(np.linalg.norm(force)) / arm.length
            height = as_set.wires[wire].z[as_set.mesh.wires[wire].supports[i]]
            node = mesh.first_nodes[wire] + mesh.wires[wire].supports[i]
            found.append((int(wires.dof[node]), float(force[-1]), float(height), stiffness))
        if mesh.messenger and as_set.mesh.messenger and support.messenger_stiffness is not None:
            height = as_set.messenger_wire.z[as_set.mesh.messenger.supports[i]]
            node = mesh.first_nodes[mesh.contact_wires] + mesh.messenger.supports[i]
            force = then.support_forces[i]
            found.append((int(wires.dof[node]), float(force[-1]), float(height), support.messenger_stiffness))
    columns = np.array(found).reshape(-1, 4).T
    return MastSprings(columns[0].astype(np.int64), *columns[1:])
