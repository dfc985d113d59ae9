"""The compiled nonlinear run: its elements, and steps that do not converge."""

import numpy as np
import pytest

import catenary_fe as cf


@pytest.mark.parametrize("axes", [2, 3])
def test_element_forces_in_compiled_code(axes):
    """At a state that is bent and stretched far more than a wire ever is."""
    numba = pytest.importorskip("numba")

    from catenary_fe.engines.nonlinear.cables import Elements, take_cables
    from catenary_fe.fe.cable import Cables, inner_forces

    @numba.njit
    def inner(axes, elements, total, forces):
        take_cables(axes, elements, total, forces)

    one, lengths = np.ones(3), np.array([0.5, 0.8, 1.3])
    nodes = np.zeros((4, 2, axes))
    nodes[1:, 0, 0], nodes[:, 1, 0] = np.cumsum(lengths), 1.0
    nodes += 0.05 * np.random.default_rng(1).normal(size=nodes.shape)
    cables = Cables(lengths, 17e6 * one, 195.0 * one, -20e3 / 17e6 * one)
    expected = np.zeros_like(nodes)
    for i, force in enumerate(inner_forces(cables, np.concatenate([nodes[:-1], nodes[1:]], axis=1))):
        expected[i : i + 2] -= force.reshape(2, 2, axes)
    forces, strain = np.zeros(nodes.size), cables.rest_strain
    elements = Elements(
        2 * axes * np.arange(3), lengths, cables.axial_stiffness, cables.bending_stiffness, 1 + strain
    )
    inner(axes, elements, nodes.ravel(), forces)
    assert forces == pytest.approx(expected.ravel(), abs=1e-9 * abs(expected).max())


def test_parts_of_steps_help_where_whole_ones_do_not_converge(short_shape, pantograph):
    strong = pantograph.replace(uplift_force=2000.0)  # pushes the wire up by metres
    runs = [
        cf.simulate(short_shape, [strong], speed=300 / 3.6, positions=[10.0], time=cf.TimeSettings(step=step))
        for step in (1e-3, 5e-4)
    ]
    assert runs[0].data["wire_height"].values.max() > 7.0
    assert any("computed in steps of 1/" in w and "pantograph 1 at" in w for w in runs[0].warnings)
    first, second = (run.data["contact_force"].values[0] for run in runs)
    n = 200
    assert first[:n] == pytest.approx(second[: 2 * n : 2], abs=0.05 * np.std(second[: 2 * n]))
    for name in ("energy", "driven_work", "lost_work"):
        first, second = (run.data[name].values[:5] for run in runs)
        assert first == pytest.approx(second, abs=0.02 * np.abs(second).max()), name


def test_a_step_that_does_not_converge_is_an_error(short_shape, pantograph):
    wild, time = pantograph.replace(uplift_force=5000.0), cf.TimeSettings(step=0.02)
    with pytest.raises(
        cf.SolverError, match=r"run at 300 km/h: no convergence at t = .* m, in span 1.* try a"
    ):
        cf.simulate(short_shape, [wild], speed=300 / 3.6, positions=[10.0], time=time)
