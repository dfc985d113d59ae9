"""Mass and stiffness matrices against masses, equilibrium and Exudyn's own dense linearisation."""

import numpy as np
import pytest

from catenary_fe.fe.linearise import mass_matrix, stiffness_matrix
from catenary_fe.fe.model import build_model

UP, COORDINATES = 1, 4  # of a node in the plane


@pytest.fixture(scope="module")
def model(short, short_shape):
    model = build_model(short, short_shape.mesh, short_shape.installation)
    model.mbs.Assemble()
    return model


def test_the_mass_matrix_holds_the_wires_mass(model, short):
    M = mass_matrix(model.mbs, model.contact.elements)
    up = np.zeros(M.shape[0])
    up[UP : COORDINATES * len(model.contact.nodes) : COORDINATES] = 1
    assert up @ M @ up == pytest.approx(short.contact_wire.mass_per_length * short.length, rel=1e-4)


def test_stiffness_is_symmetric_and_agrees_with_dense_linearisation(model):
    wires = model.contact.elements + model.messenger.elements
    K = stiffness_matrix(model.mbs, wires).toarray()
    # rounding of EA ε: the largest entries are of the order EA / length
    assert abs(K - K.T).max() < 1e-9 * abs(K).max()
    _, dense, _ = model.mbs.ComputeLinearizedSystem()
    free = slice(20 * COORDINATES + UP, 21 * COORDINATES + UP)  # a node away from springs
    assert K[free, free] == pytest.approx(dense[free, free], rel=1e-6, abs=1e-3)


def test_the_tension_is_in_the_stiffness(model, short):
    """A straight wire under tension resists a sine of wavelength λ with T k² per length."""
    wire = short.contact_wire
    K = stiffness_matrix(model.mbs, model.contact.elements)
    x = model.contact.line.x
    k = 2 * np.pi / 20
    shape = np.zeros(K.shape[0])
    n = COORDINATES * x.size
    shape[UP:n:COORDINATES] = np.sin(k * x)
    shape[UP + 2 : n : COORDINATES] = k * np.cos(k * x)
    expected = (wire.tension * k**2 + wire.bending_stiffness * k**4) * short.length / 2
    # 0.2 %: the wire sags by 3 mm between droppers, which couples EA in
    assert shape @ K @ shape == pytest.approx(expected, rel=2e-3)
