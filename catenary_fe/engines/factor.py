"""Sparse factors, and matrices packed for the compiled loops."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import CsrRows, PackedFactor, PackedRows

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


def csr_rows(matrix: Any) -> CsrRows:
    rows = matrix.tocsc().tocsr()  # so the columns of each are in order
    return CsrRows(rows.indptr.astype(np.uint32), rows.indices.astype(np.uint32), rows.data.astype(float))


def packed_rows(matrix: Any, *, backward: bool = False, even: bool = False) -> PackedRows:
    """Rows by fours.

    backward : columns from the last one to the first, in which an upward solve comes to them
    even : an even number of entries for each four rows; what is missing are zeros, before the others
    """
    size = matrix.shape[0]
    assert size % 4 == 0
    rows, sign = matrix.tocsc().tocsr(), -1 if backward else 1  # so the columns of each are in order
    row = np.repeat(np.arange(size), np.diff(rows.indptr))
    key = row // 4 * size + sign * rows.indices.astype(np.int64) % size
    order = np.argsort(key, kind="stable")  # four rows in order: quicker than np.unique
    first = np.diff(key[order], prepend=-1) > 0
    entry = np.empty_like(order)
    entry[order], key = np.cumsum(first) - 1, key[order][first]
    values = np.zeros((key.size, 4))
    values[entry, row % 4] = rows.data
    index = sign * (key % size) % size
    counts = np.bincount(key // size, minlength=size // 4)
    if even:
        odd = (np.cumsum(counts) - counts)[counts % 2 == 1]
        index, values = np.insert(index, odd, index[odd]), np.insert(values, odd, 0.0, axis=0)
        counts += counts % 2
    start = np.concatenate([[0], np.cumsum(counts)])
    return PackedRows(start.astype(np.uint32), index.astype(np.uint32), values)


def packed_factor(factor: Any, *, single: bool = False) -> PackedFactor:
    """A symmetric matrix as (I + V)ᵀ S⁻¹ (I + V), see :class:`PackedFactor`.

    single : in single precision, for solutions that are iterated: half as much to read
    """
    from scipy.sparse import bsr_matrix

    upper = factor.L.T.tocoo()
    row, column, size = upper.row.astype(np.int64), upper.col.astype(np.int64), upper.shape[0]
    same = row // 4 == column // 4
    blocks = np.zeros((size // 4, 4, 4))  # of Lᵀ on its diagonal
    blocks[row[same] // 4, row[same] % 4, column[same] % 4] = upper.data[same]
    upper.data[same] = 0.0
    upper.eliminate_zeros()
    inverse = np.linalg.inv(blocks).astype(float)
    groups = np.arange(size // 4 + 1)
    V = bsr_matrix((inverse, groups[:-1], groups), shape=upper.shape).tocsr() @ upper.tocsr()
    scaled = inverse / factor.U.diagonal().reshape(-1, 1, 4)
    S = np.einsum("nij,nkj->nik", scaled, inverse)
    lower, upper = packed_rows(V.T, even=True), packed_rows(V, backward=True, even=True)
    inner = S[:, *np.triu_indices(4)]
    if single:
        lower, upper = (rows._replace(value=rows.value.astype(np.float32)) for rows in (lower, upper))
        inner = inner.astype(np.float32)
    return PackedFactor(lower, upper, inner)
