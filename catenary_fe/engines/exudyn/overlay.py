"""What acts on the wires along their length, as one object of the system: weight, masses, damping, curves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.linearise import mass_matrix, stiffness_matrix
from catenary_fe.engines.exudyn.wire import WireItems
from catenary_fe.layout import GRAVITY, RayleighDamping

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Overlay:
    """What the wires carry besides themselves.

    point_masses : [kg], shape (nodes of all wires,), that move with the nodes; unset: none
    hanging_masses : [kg], likewise, whose weight the nodes carry; unset: the same
    damping : of the wires
    side_pull : [N/kg], shape (elements of all wires,), force to the left on each element by its mass: what
        a curve makes of the tension; unset: a straight track
    balance : [N], shape (coordinates of all nodes,), further constant forces; unset: none
    """

    point_masses: Floats | None = None
    hanging_masses: Floats | None = None
    damping: RayleighDamping | None = None
    side_pull: Floats | None = None
    balance: Floats | None = None


def add_overlay(mbs: exu.MainSystem, wires: Sequence[WireItems], overlay: Overlay | None = None) -> int:
    """Add weight, point masses, Rayleigh damping and the pull of curves, as one object; returns its number.

    wires : all wires of the system so far, in the order they were added, before anything else with nodes

    The damping matrix includes the tension's stiffness, on which a wire's waves live; the cable's own damping
    knows only of EA and EI. The weight as one constant vector costs a third of a load on each element.
    """
    from scipy.sparse import csr_matrix, diags

    overlay = overlay or Overlay()
    mbs.Assemble()
    nodes = [node for wire in wires for node in wire.nodes]
    axes, width = wires[0].line.axes, wires[0].coordinates
    M = mass_matrix(mbs, wires)
    directions = [np.tile(np.eye(width)[axis], len(nodes)) for axis in range(axes)]
    up = directions[-1]
    forces = -GRAVITY * M @ up
    matrices: dict[str, Any] = {}
    if overlay.point_masses is not None and overlay.point_masses.any():
        added = diags(np.repeat(overlay.point_masses, width) * sum(directions))
        matrices["massMatrix"] = exu.MatrixContainer(csr_matrix(added))
        hanging = overlay.point_masses if overlay.hanging_masses is None else overlay.hanging_masses
        forces = forces - GRAVITY * np.repeat(hanging, width) * up
    damping = overlay.damping
    if damping and (damping.alpha or damping.beta):
        D = csr_matrix(damping.alpha * M + damping.beta * stiffness_matrix(mbs, wires))
        matrices["dampingMatrix"] = exu.MatrixContainer(D)
    if overlay.side_pull is not None and overlay.side_pull.any():
        forces = forces + mass_matrix(mbs, wires, factors=overlay.side_pull) @ directions[1]
    if overlay.balance is not None:
        forces = forces + overlay.balance
    nothing = exu.MatrixContainer(csr_matrix(([0.0], ([0], [0])), shape=M.shape))
    number = mbs.AddObject(
        eii.ObjectGenericODE2(
            nodeNumbers=nodes,
            forceVector=forces,
            # with a function of its own the object adds its matrices to the Jacobian as they are; without
            # one Exudyn differentiates it numerically, coordinate by coordinate
            jacobianUserFunction=lambda *_: nothing,
            **matrices,
        )
    )
    return int(number)
