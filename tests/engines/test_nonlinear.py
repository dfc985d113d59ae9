"""The compiled nonlinear run: its elements, and steps that do not converge."""

import numpy as np
import pytest
from kernels import entry

import catenary_fe as cf


@pytest.mark.parametrize("spatial", [False, True])
def test_cables_in_compiled_code(spatial, plane_shape, curved_shape):
    """Inner forces, inertia and damping of all elements, at a state far from rest, against matrices."""
    from catenary_fe.engines.nonlinear.cables import Room
    from catenary_fe.engines.nonlinear.forces import damp_cables, take_cables
    from catenary_fe.engines.nonlinear.setup import Parameters
    from catenary_fe.engines.nonlinear.state import Motion
    from catenary_fe.fe.cable import inner_forces

    system = (curved_shape if spatial else plane_shape).system
    rows, size = Parameters(system).rows, system.size
    q, v, x = np.random.default_rng(1).normal(size=(3, size)) * np.array([[0.01], [1.0], [10.0]])
    total = system.reference + system.spread(q)
    inner = inner_forces(system.cables, system.of_elements(total))
    forces = np.bincount(system.elements().ravel(), inner.ravel(), minlength=total.size)
    lost = system.free(system.damping() - system.other_damping) @ v
    expected = -system.gather(forces) - system.free(system.wire_mass) @ x - lost
    motion = Motion(*(rows.spread(a) for a in (q, v, 0 * q, 0 * q)), Room.of(system.axes))
    found, damped = np.zeros((2, rows.size))
    entry(take_cables)(Parameters(system).equations, motion, rows.spread(x), found)
    entry(damp_cables)(Parameters(system).equations, motion, damped)
    assert found[rows.place] == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())
    assert damped[rows.place] == pytest.approx(-lost, abs=1e-7 * np.abs(lost).max())  # single precision


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
