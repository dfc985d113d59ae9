"""The compiled nonlinear run: its elements beside Exudyn's, and steps that do not converge."""

import numpy as np
import pytest

import catenary_fe as cf


@pytest.mark.parametrize("axes", [2, 3])
def test_element_forces_are_those_of_exudyn(axes):
    """At a state that is bent and stretched far more than a wire ever is."""
    exu, numba = pytest.importorskip("exudyn"), pytest.importorskip("numba")

    from catenary_fe.engines.exudyn.solver import new_system, release
    from catenary_fe.engines.exudyn.wire import WireLine, add_wire
    from catenary_fe.engines.nonlinear.cables import Elements, take_cables

    @numba.njit
    def inner(axes, elements, total, forces):
        take_cables(axes, elements, total, forces)

    wire = cf.Wire(mass_per_length=1.35, tension=20e3, axial_stiffness=17e6, bending_stiffness=195.0)
    points = np.zeros((4, axes))
    points[:, 0] = [0.0, 0.5, 1.3, 2.6]
    line = WireLine.through(wire, points, np.zeros((4, axes - 1)))
    mbs = new_system()
    items = add_wire(mbs, wire, line)
    mbs.Assemble()
    moved = 0.05 * np.random.default_rng(1).normal(size=mbs.systemData.ODE2Size())
    mbs.systemData.SetODE2Coordinates(moved)
    expected = np.zeros(moved.size)
    for i, element in enumerate(items.elements):
        force = mbs.ComputeItem(exu.ObjectIndex(element), exu.ComputeItemType.ODE2LHS)
        expected[2 * axes * i : 2 * axes * (i + 2)] -= np.array(force)
    each = np.ones(3)
    elements = Elements(
        2 * axes * np.arange(3), line.lengths, 17e6 * each, 195.0 * each, (1 - 20e3 / 17e6) * each
    )
    forces = np.zeros(moved.size)
    inner(axes, elements, line.coordinates().ravel() + moved, forces)
    assert forces == pytest.approx(expected, abs=1e-9 * abs(expected).max())
    release(mbs)


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
