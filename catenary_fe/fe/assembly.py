"""From element matrices to one sparse matrix."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def scattered(parts: Sequence[tuple[Integers, Floats]], size: int, place: Integers | None = None) -> Any:
    """Sparse (scipy CSR), shape (size, size): blocks added up at their coordinates.

    parts : pairs of coordinates, shape (blocks, m), and blocks, shape (blocks, m, m)
    place : shape (all coordinates,), number that each coordinate has in the matrix; below 0: left out. Unset:
        its own
    """
    from scipy.sparse import coo_matrix

    rows = np.concatenate([np.repeat(index, index.shape[1], axis=1).ravel() for index, _ in parts])
    columns = np.concatenate([np.tile(index, (1, index.shape[1])).ravel() for index, _ in parts])
    values = np.concatenate([blocks.ravel() for _, blocks in parts])
    if place is not None:
        rows, columns = place[rows], place[columns]
        kept = (rows >= 0) & (columns >= 0)
        rows, columns, values = rows[kept], columns[kept], values[kept]
    return coo_matrix((values, (rows, columns)), shape=(size, size)).tocsr()
