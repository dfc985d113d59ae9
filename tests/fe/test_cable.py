"""The cable element by itself, bent and stretched far more than a wire ever is."""

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
import pytest

from catenary_fe.fe.cable import Cables, inner_forces, mass_blocks, strain_energy, tangent_blocks

STEP = 1e-6


@pytest.fixture(params=[2, 3])
def bent(request) -> tuple[Cables, np.ndarray]:
    """Five elements of which each has its own numbers; position and slope at both ends."""
    rng, count = np.random.default_rng(5), 5
    cables = Cables(
        length=rng.uniform(0.5, 2.0, count),
        axial_stiffness=rng.uniform(1e3, 2e3, count),
        bending_stiffness=rng.uniform(1e3, 2e3, count),  # as large as EA: neither hides behind the other
        rest_strain=rng.uniform(-0.01, 0.01, count),
    )
    values = 0.3 * rng.normal(size=(count, 4, request.param))
    values[:, 1, 0] += 1.0
    values[:, 3, 0] += 1.0
    values[:, 2, 0] += cables.length
    return cables, values


def directions(values: np.ndarray) -> np.ndarray:
    return np.random.default_rng(6).normal(size=(6, *values.shape))


def test_forces_are_the_slope_of_the_energy(bent):
    cables, values = bent
    for way in directions(values):
        ends = [strain_energy(cables, values + sign * STEP * way) for sign in (-1, 1)]
        expected = (ends[1] - ends[0]) / (2 * STEP)
        found = (inner_forces(cables, values) * way).sum(axis=(1, 2))
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-3)


def test_the_tangent_is_the_slope_of_the_forces(bent):
    cables, values = bent
    for way in directions(values):
        ends = [inner_forces(cables, values + sign * STEP * way) for sign in (-1, 1)]
        expected = (ends[1] - ends[0]).reshape(len(values), -1) / (2 * STEP)
        found = np.einsum("eij,ej->ei", tangent_blocks(cables, values), way.reshape(len(values), -1))
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-3)


def test_an_element_is_that_of_exudyn(bent):
    cables, values = bent
    axes = values.shape[2]
    new_node, new_element = (
        (eii.NodePoint2DSlope1, eii.ObjectANCFCable2D)
        if axes == 2
        else (eii.NodePointSlope1, eii.ObjectANCFCable)
    )
    masses = mass_blocks(cables.length, 1.35, axes)
    for i, state in enumerate(values):
        container = exu.SystemContainer()
        mbs = container.AddSystem()
        nodes = [mbs.AddNode(new_node(referenceCoordinates=list(state[2 * n :][:2].ravel()))) for n in (0, 1)]
        element = mbs.AddObject(
            new_element(
                length=cables.length[i],
                massPerLength=1.35,
                axialStiffness=cables.axial_stiffness[i],
                bendingStiffness=cables.bending_stiffness[i],
                referenceAxialStrain=cables.rest_strain[i],
                nodeNumbers=nodes,
                useReducedOrderIntegration=1,
            )
        )
        mbs.Assemble()
        for what, ours in (
            (exu.ComputeItemType.MassMatrix, masses[i]),
            (exu.ComputeItemType.ODE2LHS, inner_forces(cables, values)[i].ravel()),
            (exu.ComputeItemType.JacobianODE2, tangent_blocks(cables, values)[i]),
        ):
            theirs = np.array(mbs.ComputeItem(exu.ObjectIndex(int(element)), what))
            assert ours == pytest.approx(theirs, abs=1e-9 * np.abs(theirs).max())
        container.Reset()
