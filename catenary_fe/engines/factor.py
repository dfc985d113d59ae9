"""Sparse factors, and matrices packed for the compiled loops."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import CsrRows, PackedRows

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def factorise(matrix: Any) -> Any:
    """Without pivoting: symmetric and quasi-definite, and in the order of the stations L is narrow."""
    from scipy.sparse.linalg import splu

    factor = splu(
        matrix.tocsc(), permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
    )
    assert np.array_equal(factor.perm_r, np.arange(matrix.shape[0]))
    return factor


def _entries(matrix: Any, triangle: str) -> tuple[Integers, Integers, Floats]:
    """Rows, columns, values by rows, the columns in the order in which a solve comes to them."""
    coo = matrix.tocoo()
    row, column, value = coo.row.astype(np.int64), coo.col.astype(np.int64), coo.data
    if triangle:
        keep = row != column
        row, column, value = row[keep], column[keep], value[keep]
    order = np.lexsort((-column if triangle == "upper" else column, row))
    return row[order], column[order], value[order]


def csr_rows(matrix: Any, triangle: str = "") -> CsrRows:
    row, column, value = _entries(matrix, triangle)
    start = np.concatenate([[0], np.cumsum(np.bincount(row, minlength=matrix.shape[0]))])
    return CsrRows(start.astype(np.uint32), column.astype(np.uint32), np.ascontiguousarray(value))


def packed_rows(matrix: Any, triangle: str = "") -> PackedRows:
    """Rows by fours, see :class:`PackedRows`.

    triangle : of a triangular matrix with a diagonal of ones: "lower" or "upper"
    """
    size = matrix.shape[0]
    assert size % 4 == 0
    row, column, value = _entries(matrix, triangle)
    inner = np.tile(np.eye(4), (size // 4, 1, 1))
    if triangle:
        same = row // 4 == column // 4
        inner[row[same] // 4, row[same] % 4, column[same] % 4] = value[same]
        row, column, value = row[~same], column[~same], value[~same]
    sign = -1 if triangle == "upper" else 1
    key, entry = np.unique(row // 4 * size + sign * column % size, return_inverse=True)
    values = np.zeros((key.size, 4))
    values[entry, row % 4] = value
    group, index = key // size, sign * (key % size) % size
    counts = np.bincount(group, minlength=size // 4)
    if triangle:
        inner = np.linalg.inv(inner).astype(float)
        values = np.einsum("nij,nj->ni", inner[group], values)
        begin = np.cumsum(counts) - counts
        odd = begin[counts % 2 == 1]  # one more of zeros, before the others
        index, values = np.insert(index, odd, index[odd]), np.insert(values, odd, 0.0, axis=0)
        counts += counts % 2
    start = np.concatenate([[0], np.cumsum(counts)])
    within = np.triu_indices(4, 1) if triangle == "upper" else np.tril_indices(4, -1)
    return PackedRows(start.astype(np.uint32), index.astype(np.uint32), values, inner[:, *within])
