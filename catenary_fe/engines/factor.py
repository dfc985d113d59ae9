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
    rows = matrix.tocsc().tocsr()  # so the columns of each are in order
    row = np.repeat(np.arange(rows.shape[0]), np.diff(rows.indptr))
    column, value = rows.indices.astype(np.int64), rows.data
    if triangle == "upper":
        turned = (rows.indptr[:-1] + rows.indptr[1:])[row] - 1 - np.arange(row.size)
        column, value = column[turned], value[turned]
    kept = (row != column) | (not triangle)
    return row[kept], column[kept], value[kept]


def csr_rows(matrix: Any, triangle: str = "") -> CsrRows:
    row, column, value = _entries(matrix, triangle)
    start = np.concatenate([[0], np.cumsum(np.bincount(row, minlength=matrix.shape[0]))])
    return CsrRows(start.astype(np.uint32), column.astype(np.uint32), np.ascontiguousarray(value))


def packed_rows(matrix: Any, triangle: str = "") -> PackedRows:
    size = matrix.shape[0]
    assert size % 4 == 0
    row, column, value = _entries(matrix, triangle)
    inner = np.zeros((size // 4, 6))
    if triangle:
        place = {(1, 0): 0, (2, 0): 1, (2, 1): 2, (3, 0): 3, (3, 1): 4, (3, 2): 5}
        if triangle == "upper":
            place = {(0, 1): 0, (0, 2): 1, (0, 3): 2, (1, 2): 3, (1, 3): 4, (2, 3): 5}
        table = np.full((4, 4), -1)
        for (r, c), k in place.items():
            table[r, c] = k
        same = row // 4 == column // 4
        inner[row[same] // 4, table[row[same] % 4, column[same] % 4]] = value[same]
        row, column, value = row[~same], column[~same], value[~same]
    sign = -1 if triangle == "upper" else 1
    key = row // 4 * size + sign * column % size
    order = np.argsort(key, kind="stable")  # four rows in order: quicker than np.unique
    first = np.diff(key[order], prepend=-1) > 0
    entry = np.empty_like(order)
    entry[order], key = np.cumsum(first) - 1, key[order][first]
    values = np.zeros((key.size, 4))
    values[entry, row % 4] = value
    start = np.concatenate([[0], np.cumsum(np.bincount(key // size, minlength=size // 4))])
    index = sign * (key % size) % size
    return PackedRows(start.astype(np.uint32), index.astype(np.uint32), values, inner)
