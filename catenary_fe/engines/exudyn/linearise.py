"""Mass and stiffness matrices of an Exudyn system's wires at the current state, sparse, in closed form."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.wire import WireItems
from catenary_fe.fe import cable
from catenary_fe.fe.cable import scattered

Floats = NDArray[np.float64]


def mass_matrix(mbs: exu.MainSystem, wires: Sequence[WireItems], factors: Floats | None = None) -> Any:
    """Sparse (scipy CSR) mass matrix [kg] over all second-order coordinates of the system.

    factors : shape (elements,), by which each element's matrix is multiplied; unset: 1
    """
    blocks = [mass_blocks(wire) for wire in wires]
    if factors is not None:
        parts = np.split(factors, np.cumsum([len(b) for b in blocks])[:-1])
        blocks = [block * part[:, None, None] for block, part in zip(blocks, parts, strict=True)]
    return _assemble(mbs, wires, blocks)


def stiffness_matrix(mbs: exu.MainSystem, wires: Sequence[WireItems]) -> Any:
    """Sparse (scipy CSR) tangent stiffness [N/m], with what the tension adds."""
    return _assemble(mbs, wires, [stiffness_blocks(mbs, wire) for wire in wires])


def mass_blocks(wire: WireItems) -> Floats:
    """[kg], shape (elements, 4 * axes, 4 * axes)."""
    return cable.mass_blocks(wire.line.lengths, wire.kind.mass_per_length, wire.line.axes)


def stiffness_blocks(mbs: exu.MainSystem, wire: WireItems) -> Floats:
    """[N/m], shape (elements, 4 * axes, 4 * axes), at the current state."""
    axes, kind = wire.line.axes, wire.kind
    first, each = first_coordinate(mbs, wire), np.ones_like(wire.line.lengths)
    moved = mbs.systemData.GetODE2Coordinates()[first : first + wire.coordinates * (each.size + 1)]
    nodes = (wire.line.coordinates().ravel() + moved).reshape(-1, 2, axes)
    elements = cable.Cables(
        length=wire.line.lengths,
        axial_stiffness=kind.axial_stiffness * each,
        bending_stiffness=kind.bending_stiffness * each,
        rest_strain=-kind.tension / kind.axial_stiffness * each,
    )
    return cable.tangent_blocks(elements, np.concatenate([nodes[:-1], nodes[1:]], axis=1))


def first_coordinate(mbs: exu.MainSystem, wire: WireItems) -> int:
    """Number of a wire's first coordinate; those of its nodes follow one another."""
    return int(mbs.systemData.GetNodeLTGODE2(wire.nodes[0])[0])


def _assemble(mbs: exu.MainSystem, wires: Sequence[WireItems], blocks: Sequence[Floats]) -> Any:
    parts = []
    for wire, values in zip(wires, blocks, strict=True):
        count, m = values.shape[:2]
        first = first_coordinate(mbs, wire) + wire.coordinates * np.arange(count)[:, None]
        parts.append((first + np.arange(m), values))
    return scattered(parts, mbs.systemData.ODE2Size())
