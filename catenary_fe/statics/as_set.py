"""Steady arms and supports as they were set: they give when the line changes after that."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import Catenary
from catenary_fe.statics.shape import Shape
from catenary_fe.statics.taut_wires import TautWires

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class MastSprings:
    """Vertical springs between masts and wires; links on their pivots are springs that change as they turn.

    at : shape (springs,), numbers of the wires' displacements
    force, height : [N], [m], shape (springs,), upward on the wire, where the wire has this height
    stiffness : [N/m], shape (springs,)
    links : shape (springs,), which of them are links
    pivot : [m], shape (springs, 2), of links: to the left, above the rail
    length : [m], shape (springs,), of links
    """

    at: Integers
    force: Floats
    height: Floats
    stiffness: Floats
    links: NDArray[np.bool_]
    pivot: Floats
    length: Floats

    def forces(self, heights: Floats) -> Floats:
        """[N], shape (springs,), upward, on wires at heights [m], shape (displacements,)."""
        forces: Floats = self.force - self.stiffness * (heights[self.at] - self.height)
        return forces

    def turned(self, found: Floats, reactions: Floats) -> MastSprings:
        """With each link where its wire now is; moves the wires sideways with the links' ends, in ``found``.

        found, reactions : [m], [N], shape (axes - 1, displacements), of the wires
        """
        if not self.links.any():
            return self
        at, pivot, length = self.at[self.links], self.pivot[self.links], self.length[self.links]
        lateral, rise = reactions[0, at], pivot[:, 1] - found[-1, at]
        reach = np.sqrt(np.maximum(length**2 - rise**2, 1e-4 * length**2))
        found[0, at] = pivot[:, 0] - np.sign(lateral) * reach
        force, height, stiffness = self.force.copy(), self.height.copy(), self.stiffness.copy()
        force[self.links], height[self.links] = np.abs(lateral) * rise / reach, found[-1, at]
        stiffness[self.links] = np.abs(lateral) * length**2 / reach**3
        return replace(self, force=force, height=height, stiffness=stiffness)


def mast_springs(catenary: Catenary, wires: TautWires, as_set: Shape) -> MastSprings:
    """Those of a line whose arms and supports were set before it changed.

    A spring keeps its preload, a link its pivot, and messenger supports with a stiffness give, too. As built,
    they may stand elsewhere.

    as_set : the line then, in equilibrium
    """
    at, force, height, stiffness, links, pivot, length = [], [], [], [], [], [], []
    raised = catenary.messenger_support_heights - as_set.catenary.messenger_support_heights
    for i, support in list(enumerate(catenary.supports))[1:-1]:
        for number in range(wires.mesh.first_stitch):
            of_contact, arm = number < wires.mesh.contact_wires, support.steady_arm
            if (arm if of_contact else support.messenger_stiffness) is None:
                continue
            spring = (arm and arm.stiffness) if of_contact else support.messenger_stiffness
            hung, node = as_set.wires[number], as_set.mesh.wires[number].supports[i]
            then = as_set.installation
            on_wire = then.arm_forces[number, i] if of_contact else then.support_forces[i]
            place = np.array([hung.y[node], hung.z[node]]) + (
                [catenary.staggers[i] - as_set.catenary.staggers[i], 0.0] if of_contact else [0.0, raised[i]]
            )
            reach = (arm.length or 0.0) if of_contact and arm else 0.0
            own = wires.mesh.first_nodes[number] + wires.mesh.wires[number].supports[i]
            at.append(int(wires.dof[own]))
            force.append(float(on_wire[-1]))
            height.append(place[1])
            stiffness.append(spring or 0.0)
            links.append(bool(reach))
            pivot.append(place + reach * on_wire[-2:] / np.linalg.norm(on_wire) if reach else place)
            length.append(reach)
    return MastSprings(
        np.array(at, dtype=np.int64),
        np.array(force),
        np.array(height),
        np.array(stiffness),
        np.array(links, dtype=bool),
        np.array(pivot).reshape(-1, 2),
        np.array(length),
    )
