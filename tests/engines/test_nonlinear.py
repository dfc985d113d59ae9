"""The compiled nonlinear run against Exudyn's own solver: elements, histories, in the plane and in space."""

import numpy as np
import pytest
from kernels import drive as drive_engine

import catenary_fe as cf
from catenary_fe.engines.exudyn.run import Trip, drive
from catenary_fe.engines.nonlinear.run import NonlinearEngine

TIGHT = cf.TimeSettings(tolerance=1e-6)


def both(shape, pantograph, speed, start, steps, uplift=140.0):
    """The same run by Exudyn's solver and by ours."""
    pairs, at = [(pantograph, uplift)], np.array([start])
    trip = Trip(speed, at, steps, TIGHT, wire_interval=0.02)
    theirs = drive(shape.catenary, shape.mesh, shape.installation, pairs, trip)
    return theirs, drive_engine(NonlinearEngine(shape.system, TIGHT, 0.02), pairs, speed, at, steps)


def assert_same(ours, theirs, force=0.1):
    """Within what Exudyn's iteration leaves: it stops at 1e-6 of a step's first residual."""
    for mine, other in zip(ours.mass_heights, theirs.mass_heights, strict=True):
        assert mine == pytest.approx(other, abs=2e-6)
    assert ours.contact_force == pytest.approx(theirs.contact_force, abs=force)
    assert ours.dropper_force == pytest.approx(theirs.dropper_force, abs=4 * force)
    assert ours.wire_height == pytest.approx(theirs.wire_height, abs=2e-6)
    assert ours.support_height == pytest.approx(theirs.support_height, abs=2e-6)
    for mine, other in zip(ours.wire_z, theirs.wire_z, strict=True):
        assert mine == pytest.approx(other, abs=5e-6)


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


def test_histories_in_the_plane(short_shape, pantograph):
    theirs, ours = both(short_shape, pantograph, 300 / 3.6, 10.0, 1500, 170.0)
    assert (theirs.dropper_force.min(axis=1) <= 0).any()  # some went slack
    assert_same(ours, theirs)


def test_another_tension_is_another_history(short, short_shape, pantograph):
    """The twin of the test above: it sees 1 %."""
    wire = short.contact_wire
    tight = cf.find_form(short.replace(contact_wire=wire.replace(tension=1.01 * wire.tension)))
    theirs, _ = both(short_shape, pantograph, 300 / 3.6, 10.0, 300)
    _, ours = both(tight, pantograph, 300 / 3.6, 10.0, 300)
    with pytest.raises(AssertionError):
        assert_same(ours, theirs)


def test_contact_that_is_lost(short_shape, pantograph):
    theirs, ours = both(short_shape, pantograph, 330 / 3.6, 10.0, 900, 40.0)
    assert (theirs.contact_force <= 0).any()
    assert_same(ours, theirs)


def test_contact_damping(short_shape, pantograph):
    """Exudyn's run takes the wire's inclination from a step before: an error of the order of the step."""
    damped = pantograph.replace(contact_damping=15.0)
    off = []
    for step in (1e-3, 5e-4):
        time = cf.TimeSettings(step=step, tolerance=1e-6)
        pairs, at, steps = [(damped, 140.0)], np.array([10.0]), round(0.4 / step)
        trip = Trip(300 / 3.6, at, steps, time)
        theirs = drive(short_shape.catenary, short_shape.mesh, short_shape.installation, pairs, trip)
        ours = drive_engine(NonlinearEngine(short_shape.system, time), pairs, 300 / 3.6, at, steps, step)
        off.append(np.std(ours.contact_force - theirs.contact_force))
    assert off[0] < 0.05 * np.std(theirs.contact_force)
    assert off[1] < 0.6 * off[0]


@pytest.mark.parametrize("layout", ["en50318_2018_ac_simple", "en50318_2018_ac_stitched", "dc_3kv_twin"])
def test_histories_in_space(reference_layout, layout):
    """Stagger, arms that are links, stitch wires, two contact wires, two strips that roll."""
    line = cf.load_catenary(reference_layout.parent / f"{layout}.toml")
    line = line.replace(spans=line.spans[:3], supports=line.supports[:4], evaluated_spans=(2,))
    head = cf.Panhead(width=1.6, strips=2, strip_distance=0.4, spring_distance=0.9)
    pantograph = cf.library.pantograph("EN 50318:2018 AC").replace(
        mean_force=None, uplift_force=140.0, head=head
    )
    shape = cf.find_form(line)
    theirs, ours = both(shape, pantograph, 275 / 3.6, line.support_positions[1] - 12.0, 250)
    assert_same(ours, theirs, force=0.3)


def test_an_elastic_pantograph(short_shape):
    elastic = cf.ElasticPantograph(name="elastic", force=150.0, stiffness=300.0)
    theirs, ours = both(short_shape, elastic, 250 / 3.6, 10.0, 300)
    assert ours.contact_force == pytest.approx(theirs.contact_force, abs=0.01)


def test_both_are_methods_of_a_run(short, pantograph):
    line = short.replace(spans=short.spans[:3], supports=short.supports[:4], evaluated_spans=(2,))
    shape = cf.find_form(line)
    runs = [
        cf.simulate(
            shape, [pantograph], speed=80.0, method=method, time=cf.TimeSettings(step=2e-3, tolerance=1e-6)
        )
        for method in ("nonlinear", "exudyn")
    ]
    assert [run.method for run in runs] == ["nonlinear", "exudyn"]
    ours, theirs = (run.contact_force_statistics()[0] for run in runs)
    assert ours.std == pytest.approx(theirs.std, rel=1e-3)
    assert ours.max == pytest.approx(theirs.max, rel=1e-3)


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
