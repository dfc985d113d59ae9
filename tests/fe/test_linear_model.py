"""The reduced linear model against the whole one: the same answers with half the coordinates."""

import numpy as np
import pytest

from catenary_fe.fe.cable import hermite
from catenary_fe.fe.linear_model import linear_model
from catenary_fe.fe.modal import linear_system


@pytest.fixture(scope="module")
def reduced(short_shape):
    return linear_model(short_shape.catenary, short_shape.mesh, short_shape.installation)


@pytest.fixture(scope="module")
def whole(short_shape):
    return linear_system(short_shape.catenary, short_shape.mesh, short_shape.installation)


def receptance(mass, damping, stiffness, row, frequency):
    from scipy.sparse.linalg import spsolve

    omega = 2 * np.pi * frequency
    matrix = (stiffness + 1j * omega * damping - omega**2 * mass).tocsc()
    return row @ spsolve(matrix, row.astype(complex))


@pytest.mark.parametrize("frequency", [0.0, 0.5, 1.5, 3.0])
@pytest.mark.parametrize("position", [10.0, 90.0, 120.0, 152.0])
def test_receptance_of_the_contact_wire(reduced, whole, short_shape, frequency, position):
    line = reduced.contacts[0]
    e = int(np.searchsorted(line.x, position, side="right")) - 1
    weights = hermite((position - line.x[e]) / (line.x[e + 1] - line.x[e]), line.lengths[e])
    row = np.zeros(reduced.size)
    row[line.index[e : e + 2].ravel()] = weights
    ours = receptance(reduced.mass, reduced.damping, reduced.stiffness, row, frequency)
    filled = np.zeros(whole.transformation.shape[0])
    width = whole.node_width
    vertical = width * np.array([[e], [e + 1]]) + [width // 2 - 1, width - 1]
    filled[vertical.ravel()] = weights
    free = whole.transformation.T @ filled
    theirs = receptance(whole.mass, whole.damping, whole.stiffness, free, frequency)
    # statics agree to rounding; near a resonance the mass that moves along between clamps shows
    assert ours == pytest.approx(theirs, rel=1e-4 if frequency == 0 else 0.02)
    assert reduced.size < 0.6 * whole.size


def test_matrices_are_symmetric_and_narrow(reduced):
    for matrix in (reduced.mass, reduced.damping, reduced.stiffness):
        assert abs(matrix - matrix.T).max() <= 1e-12 * abs(matrix).max()
    rows, columns = reduced.stiffness.nonzero()
    assert np.abs(rows - columns).max() < 40
    assert reduced.tensions.min() >= 0


def test_tension_coordinates_have_no_mass(reduced):
    assert abs(reduced.mass[reduced.tensions]).max() == 0
    assert (reduced.stiffness.diagonal()[reduced.tensions] < 0).all()
