"""The one-wire model that the suite and the paper's figures run on."""

import numpy as np
import pytest

from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.wire_problem import SlidingPantograph, WireProblem, even_nodes, graded_nodes
from catenary_fe.layout import InputError, Pantograph, SolverError, Stage, Wire
from catenary_fe.studies.single_wire import run_wire, wire_at_rest
from catenary_fe.theory import ElasticPantograph, MovingForce, linear_law

WIRE = Wire(mass_per_length=1.33, tension=20e3, axial_stiffness=1.7e7)
X = even_nodes([0, 20], 1.0)
STEP = TimeSettings(step=1e-3)


def test_even_nodes_meet_every_fixed_point():
    assert even_nodes([0, 1, 3], 1.0).tolist() == [0, 1, 2, 3]
    assert even_nodes([0, 1], 0.4).tolist() == pytest.approx([0, 1 / 3, 2 / 3, 1])


def test_graded_nodes_start_fine_at_kinks_and_grow():
    sizes = np.diff(graded_nodes([0, 10], 1.0, kinks=[4.0], finest=0.1))
    assert sizes.min() == pytest.approx(0.1)
    assert sizes.max() <= 1.0
    crowded = graded_nodes([0, 1], 1.0, kinks=[0.5, 0.56], finest=0.05)
    assert np.diff(crowded).min() > 0.02


def test_position_off_the_nodes_is_refused():
    with pytest.raises(InputError, match=r"2\.5 m is not on a node, the nearest is at"):
        WireProblem(wire=WIRE, x=X, masses={2.5: 1.0})
    with pytest.raises(InputError, match="must rise"):
        WireProblem(wire=WIRE, x=X[::-1])


def test_stored_interval_and_shapes():
    load = MovingForce(force=100.0, speed=50.0, start=5.0)
    motion = run_wire(WireProblem(wire=WIRE, x=X, loads=[load]), duration=0.1, time=STEP, interval=0.02)
    assert motion.t == pytest.approx(np.arange(6) * 0.02)
    assert motion.deflection.shape == motion.velocity.shape == (6, X.size)
    assert motion.forces[:, 0].tolist() == [100.0] * 6
    assert motion.energy.size == 0


def test_two_light_forces_add_up():
    first = MovingForce(force=1.0, speed=30.0, start=4.0)
    second = MovingForce(force=2.0, speed=10.0, start=10.0)
    shapes = [
        run_wire(WireProblem(wire=WIRE, x=X, loads=loads), duration=0.1, time=STEP).deflection[-1]
        for loads in ([first], [second], [first, second])
    ]
    assert shapes[2] == pytest.approx(shapes[0] + shapes[1], abs=1e-3 * np.abs(shapes[2]).max())


def test_force_that_leaves_the_wire_is_gone():
    load = MovingForce(force=100.0, speed=100.0, start=15.0)
    motion = run_wire(WireProblem(wire=WIRE, x=X, loads=[load]), duration=0.1, time=STEP)
    gone = motion.t > 0.0505
    assert (motion.forces[gone, 0] == 0).all() and np.isnan(motion.under_loads[gone, 0]).all()
    assert np.isfinite(motion.deflection).all()


def test_pantograph_that_leaves_the_wire_lets_go():
    pantograph = Pantograph(stages=(Stage(mass=5.0, stiffness=1000.0),), uplift_force=50.0)
    load = SlidingPantograph(pantograph=pantograph, uplift=50.0, speed=100.0, start=15.0)
    motion = run_wire(WireProblem(wire=WIRE, x=X, loads=[load]), duration=0.1, time=STEP)
    assert motion.forces[30, 0] > 0
    assert (motion.forces[motion.t > 0.0505, 0] == 0).all()


def test_elastic_pantograph_never_pulls():
    law = linear_law(force=50.0, stiffness=1e5)
    load = ElasticPantograph(law=law, speed=20.0, start=5.0)
    motion = run_wire(WireProblem(wire=WIRE, x=X, loads=[load]), duration=0.2, time=STEP)
    assert motion.forces.min() >= 0


def test_fixed_ends_raise_the_tension_so_the_wire_rises_less():
    load = MovingForce(force=200.0, speed=0.0, start=10.0)
    tensioned, fixed = (
        run_wire(WireProblem(wire=WIRE, x=X, tensioned=t, loads=[load]), duration=0.1, time=STEP)
        for t in (True, False)
    )
    assert fixed.under_loads[-1, 0] < 0.999 * tensioned.under_loads[-1, 0]


def test_supports_and_weight():
    problem = WireProblem(wire=WIRE, x=X, supports=[10.0], weight=True)
    motion = run_wire(problem, duration=0.05, time=STEP)
    assert motion.at(0.05)[10] == pytest.approx(0, abs=1e-9)
    assert motion.at(0.05)[5] < 0


def test_hopeless_step_is_a_solver_error():
    load = MovingForce(force=1e6, speed=100.0, start=5.0)
    with pytest.raises(SolverError, match="no convergence at t ="):
        run_wire(WireProblem(wire=WIRE, x=X, loads=[load]), duration=0.1, time=TimeSettings(step=0.02))


def test_what_cannot_be_done_is_refused():
    problem = WireProblem(wire=WIRE, x=X)
    with pytest.raises(
        InputError, match=r"duration = 0\.0105 s: must be a whole number of steps of 0\.001 s"
    ):
        run_wire(problem, duration=0.0105, time=STEP)
    pantograph = Pantograph(stages=(Stage(mass=5.0, stiffness=1000.0),), uplift_force=50.0)
    sliding = SlidingPantograph(pantograph=pantograph, uplift=50.0, speed=10.0)
    with pytest.raises(InputError, match="energy"):
        run_wire(WireProblem(wire=WIRE, x=X, loads=[sliding]), duration=0.01, time=STEP, energy=True)
    with pytest.raises(InputError, match="at rest"):
        wire_at_rest(WireProblem(wire=WIRE, x=X, loads=[sliding]))
