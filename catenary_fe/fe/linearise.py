"""Mass and stiffness matrices of bodies at the current state, sparse."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray


def mass_matrix(
    mbs: exu.MainSystem, bodies: Sequence[int], factors: NDArray[np.float64] | None = None
) -> Any:
    """Sparse (scipy CSR) mass matrix [kg] over all second-order coordinates of the system.

    factors : shape (bodies,), by which each body's matrix is multiplied; unset: 1
    """
    return _assemble(mbs, bodies, exu.ComputeItemType.MassMatrix, factors)


def stiffness_matrix(mbs: exu.MainSystem, objects: Sequence[int]) -> Any:
    """Sparse (scipy CSR) tangent stiffness [N/m] of bodies or connectors, with what the tension adds."""
    return _assemble(mbs, objects, exu.ComputeItemType.JacobianODE2)


def _assemble(
    mbs: exu.MainSystem,
    items: Sequence[int],
    what: exu.ComputeItemType,
    factors: NDArray[np.float64] | None = None,
) -> Any:
    from scipy.sparse import coo_matrix

    rows: list[NDArray[np.int64]] = []
    columns: list[NDArray[np.int64]] = []
    values: list[NDArray[np.float64]] = []
    for number, item in enumerate(items):
        block = np.asarray(mbs.ComputeItem(exu.ObjectIndex(int(item)), what))
        if factors is not None:
            block = block * factors[number]
        index = np.asarray(mbs.systemData.GetObjectLTGODE2(item), dtype=np.int64)
        rows.append(np.repeat(index, index.size))
        columns.append(np.tile(index, index.size))
        values.append(block.ravel())
    size = mbs.systemData.ODE2Size()
    if not rows:
        return coo_matrix((size, size)).tocsr()
    triplets = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
    return coo_matrix(triplets, shape=(size, size)).tocsr()
