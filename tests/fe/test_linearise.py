"""Mass and stiffness matrices against masses, equilibrium and Exudyn's own dense linearisation."""

import numpy as np
import pytest

from catenary_fe.engines.exudyn.linearise import mass_matrix, stiffness_matrix
from catenary_fe.engines.exudyn.model import build_model

UP, COORDINATES = 1, 4  # of a node in the plane


@pytest.fixture(scope="module")
def model(short, short_shape):
    model = build_model(short, short_shape.mesh, short_shape.installation)
    model.mbs.Assemble()
    return model


def test_the_mass_matrix_holds_the_wires_mass(model, short):
    M = mass_matrix(model.mbs, [model.contact])
    up = np.zeros(M.shape[0])
    up[UP : COORDINATES * len(model.contact.nodes) : COORDINATES] = 1
    assert up @ M @ up == pytest.approx(short.contact_wire.mass_per_length * short.length, rel=1e-4)


def test_stiffness_is_symmetric_and_agrees_with_dense_linearisation(model):
    K = stiffness_matrix(model.mbs, model.wires).toarray()
    # rounding of EA ε: the largest entries are of the order EA / length
    assert abs(K - K.T).max() < 1e-9 * abs(K).max()
    _, dense, _ = model.mbs.ComputeLinearizedSystem()
    free = slice(20 * COORDINATES + UP, 21 * COORDINATES + UP)  # a node away from springs
    assert K[free, free] == pytest.approx(dense[free, free], rel=1e-6, abs=1e-3)


def test_the_tension_is_in_the_stiffness(model, short):
    """A straight wire under tension resists a sine of wavelength λ with T k² per length."""
    wire = short.contact_wire
    K = stiffness_matrix(model.mbs, [model.contact])
    x = model.contact.line.x
    k = 2 * np.pi / 20
    shape = np.zeros(K.shape[0])
    n = COORDINATES * x.size
    shape[UP:n:COORDINATES] = np.sin(k * x)
    shape[UP + 2 : n : COORDINATES] = k * np.cos(k * x)
    expected = (wire.tension * k**2 + wire.bending_stiffness * k**4) * short.length / 2
    # 0.2 %: the wire sags by 3 mm between droppers, which couples EA in
    assert shape @ K @ shape == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("axes", [2, 3])
def test_element_matrices_are_those_of_exudyn(axes):
    """At a state that is bent and stretched far more than a wire ever is."""
    import exudyn as exu

    from catenary_fe.engines.exudyn.linearise import mass_blocks, stiffness_blocks
    from catenary_fe.engines.exudyn.solver import new_system, release
    from catenary_fe.engines.exudyn.wire import WireLine, add_wire
    from catenary_fe.layout import Wire

    wire = Wire(mass_per_length=1.35, tension=20e3, axial_stiffness=17e6, bending_stiffness=195.0)
    points = np.zeros((4, axes))
    points[:, 0] = [0.0, 0.5, 1.3, 2.6]
    mbs = new_system()
    items = add_wire(mbs, wire, WireLine.through(wire, points, np.zeros((4, axes - 1))))
    mbs.Assemble()
    moved = 0.05 * np.random.default_rng(1).normal(size=mbs.systemData.ODE2Size())
    mbs.systemData.SetODE2Coordinates(moved)
    for what, ours in (
        (exu.ComputeItemType.MassMatrix, mass_blocks(items)),
        (exu.ComputeItemType.JacobianODE2, stiffness_blocks(mbs, items)),
    ):
        for element, block in zip(items.elements, ours, strict=True):
            theirs = np.array(mbs.ComputeItem(exu.ObjectIndex(element), what))
            assert abs(block - theirs).max() < 1e-9 * abs(theirs).max()
    release(mbs)
