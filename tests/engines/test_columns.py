"""Columns of an inverse: where they are not negligible, they are those of the whole matrix."""

import numpy as np
import pytest
from scipy.sparse import block_diag, csc_matrix, diags

from catenary_fe.engines.factor import factorise
from catenary_fe.engines.linearised.columns import NEGLIGIBLE, compliance_columns


def chain(size, coupling):
    """A matrix L D Lᵀ whose columns of the inverse die away by this factor from row to row."""
    lower = diags([1.0, -coupling], [0, -1], shape=(size, size))
    return lower @ diags(np.where(np.arange(size) % 5, 2.0, -3.0)) @ lower.T


@pytest.mark.parametrize(("coupling", "widest"), [(0.5, 60), (0.9, 400), (0.97, 1200)])
def test_columns_are_those_of_the_dense_inverse(coupling, widest):
    size, starts = 3000, np.array([0, 1300, 3000])
    matrix = block_diag([chain(n, coupling) for n in np.diff(starts)]).tocsc()
    rows = (np.arange(37) * 701) % (size - 1)  # as many as do not fill the slots, in no order
    rows[rows == starts[1] - 1] += 1
    values = np.tile([1.0, -0.8], (rows.size, 1))
    index = np.stack([rows, rows + 1], axis=1)
    right = csc_matrix((values.ravel(), index.ravel(), 2 * np.arange(rows.size + 1)), shape=(size, rows.size))
    found = compliance_columns(factorise(matrix), right, starts)
    width = found.value.shape[1]
    assert widest / 3 < width <= widest
    whole = np.linalg.solve(matrix.toarray(), right.toarray())
    for k in range(rows.size):
        column = np.zeros(size)
        column[found.first[k] : found.first[k] + width] = found.value[k]
        most = 2 * NEGLIGIBLE * np.abs(whole[:, k]).max()
        np.testing.assert_allclose(column, whole[:, k], rtol=0, atol=most)
    last = found.first + width
    assert (np.searchsorted(starts, found.first, side="right") == np.searchsorted(starts, last)).all()


def test_no_columns_take_no_room():
    none = compliance_columns(factorise(chain(40, 0.5).tocsc()), csc_matrix((40, 0)), np.array([0, 40]))
    assert none.first.size == 0 and none.value.shape[0] == 0
