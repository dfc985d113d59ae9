"""Contacts, droppers and links of compiled runs over some steps, against Exudyn's and against their laws.

Short enough to run without a compiler (NUMBA_DISABLE_JIT=1), as mutation testing does.
"""

import re
from typing import NamedTuple

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from kernels import drive as drive_engine
from kernels import entry, feel

import catenary_fe as cf
from catenary_fe.engines.base import RunCase
from catenary_fe.engines.compiled import plain
from catenary_fe.engines.contact_solver import one_way, solve_one_way, solve_points
from catenary_fe.engines.exudyn.run import ExudynEngine
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.linearised import doubts
from catenary_fe.engines.linearised.arrays import SteadyArmBars
from catenary_fe.engines.linearised.batch import Batch
from catenary_fe.engines.linearised.forces import dropper_parts, link_force, update_arm, update_dropper
from catenary_fe.engines.nonlinear.forces import _lack
from catenary_fe.engines.nonlinear.run import NonlinearEngine
from catenary_fe.engines.recorder import Sizes
from catenary_fe.studies.linearised import LinearisedLine

SPEED = 80.0  # [m/s]
TIGHT = cf.TimeSettings(tolerance=1e-6)


class Ride(NamedTuple):
    """A pantograph with contact damping, somewhere on a short line, for some steps of 1 ms."""

    shape: cf.Shape
    pantograph: cf.Pantograph
    start: float
    steps: int

    @property
    def pairs(self):
        return [(self.pantograph, self.pantograph.uplift_force)]

    def exudyn(self):
        run = ExudynEngine(self.shape, TIGHT, 0.01, energy=True)
        return drive_engine(run, self.pairs, SPEED, np.array([self.start]), self.steps)

    def nonlinear(self):
        run = NonlinearEngine(self.shape.system, TIGHT, 0.01)
        history = drive_engine(run, self.pairs, SPEED, np.array([self.start]), self.steps)
        return history, run.iterations

    def linearised(self):
        case = RunCase([self.pantograph], SPEED, np.array([self.start]), (self.steps + 0.5) * SPEED * 1e-3)
        (run,) = LinearisedLine(self.shape, store_wire=0.01).run([case])
        assert isinstance(run, cf.Run)
        return run


@pytest.fixture(scope="module")
def slack(plane_shape, pantograph):
    """In the plane, short of a dropper, which goes slack."""
    return Ride(plane_shape, pantograph.replace(uplift_force=250.0), 60.5, 100)


@pytest.fixture(scope="module")
def damped(slack, pantograph):
    """Contact damping, and a wire that never goes slack."""
    return slack._replace(
        pantograph=pantograph.replace(uplift_force=80.0, contact_damping=40.0), start=57.0, steps=80
    )


@pytest.fixture(scope="module")
def space(twin_shape, pantograph, rolling_head):
    """Two wires, links, two strips that roll."""
    return Ride(twin_shape, pantograph.replace(uplift_force=60.0, head=rolling_head), 52.0, 40)


def test_nonlinear_steps_in_the_plane(slack):
    ours, iterations = slack.nonlinear()
    theirs = slack.exudyn()
    assert (theirs.dropper_force <= 0).sum() > 100
    assert_same(ours, theirs, force=0.1)
    assert iterations < 4.1 * slack.steps  # with the matrix at rest uncorrected they do not converge


def test_nonlinear_steps_in_space(space):
    ours, iterations = space.nonlinear()
    assert_same(ours, space.exudyn(), force=0.05)
    assert iterations < 2.3 * space.steps


def assert_same(ours, theirs, force):
    assert ours.contact_force == pytest.approx(theirs.contact_force, abs=force)
    assert ours.dropper_force == pytest.approx(theirs.dropper_force, abs=force)
    assert ours.wire_height == pytest.approx(theirs.wire_height, abs=2e-6)
    assert ours.support_height == pytest.approx(theirs.support_height, abs=2e-6)
    for mine, other in zip(ours.mass_heights, theirs.mass_heights, strict=True):
        assert mine == pytest.approx(other, abs=2e-6)
    for mine, other in zip(ours.wire_z, theirs.wire_z, strict=True):
        assert mine == pytest.approx(other, abs=5e-6)
    for mine, other in ((ours.driven_work, theirs.driven_work), (ours.lost_work, theirs.lost_work)):
        assert np.abs(other).max() > 5e-3  # [J]
        assert mine == pytest.approx(other, abs=3e-3 * np.abs(other).max())


def test_contact_damping_follows_the_wire(damped):
    """The damper sees how fast the gap closes along the wire; Exudyn's takes the inclination a step late."""
    history, _ = damped.nonlinear()
    data = damped.linearised().data
    for force, height, mass in (
        (history.contact_force[0], history.wire_height[0], history.mass_heights[0][0]),
        (data["contact_force"][0], data["wire_height"][0], data["mass_height"][0, 0]),
    ):
        gap = np.asarray(mass) - np.asarray(height)
        spring = damped.pantograph.contact_stiffness * gap
        damper = damped.pantograph.contact_damping * np.gradient(gap, 1e-3)
        assert np.abs(damper).max() > 5
        # the rate is a difference over two steps
        assert np.asarray(force)[2:-2] == pytest.approx((spring + damper)[2:-2], abs=1.0)


@pytest.mark.parametrize(("name", "force", "dropper"), [("slack", 3.0, 4.0), ("space", 3.0, 0.5)])
def test_linearised_steps(request, name, force, dropper):
    ride = request.getfixturevalue(name)
    run, theirs = ride.linearised(), ride.exudyn()
    data, nominal = run.data, run.catenary.contact_wire_height
    assert data["contact_force"].values == pytest.approx(theirs.contact_force, abs=force)
    assert data["dropper_force"].values == pytest.approx(theirs.dropper_force, abs=dropper)
    assert data["wire_height"].values - nominal == pytest.approx(theirs.wire_height, abs=5e-5)
    assert data["mass_height"].values[0] - nominal == pytest.approx(theirs.mass_heights[0], abs=5e-5)
    wires = len(ride.shape.contact_wires)
    uplift = theirs.support_height.reshape(wires, -1, run.time.size).max(axis=0) - nominal
    assert data["support_uplift"].values == pytest.approx(uplift, abs=5e-5)
    assert data["contact_wire_height"].values == pytest.approx(theirs.wire_z[0], abs=1e-4)
    assert data["messenger_wire_height"].values == pytest.approx(theirs.wire_z[-1], abs=1e-4)


def test_contact_that_is_lost_and_found(damped):
    ride = damped._replace(pantograph=damped.pantograph.replace(contact_damping=0.0, uplift_force=8.0))
    history, _ = ride.nonlinear()
    data = ride.linearised().data
    for force, height, mass in (
        (history.contact_force[0], history.wire_height[0], history.mass_heights[0][0]),
        (data["contact_force"][0], data["wire_height"][0], data["mass_height"][0, 0]),
    ):
        lost = np.asarray(force) == 0
        assert 3 < lost.sum() < 70
        gap = np.asarray(mass) - np.asarray(height)
        assert np.asarray(force) == pytest.approx(np.maximum(0, 50e3 * gap), abs=1e-6)
    assert data["contact_force"].values == pytest.approx(history.contact_force, abs=0.5)


def test_it_says_how_far_motions_went(slack, monkeypatch):
    monkeypatch.setattr(doubts, "SLACKENING", 1e-6)
    monkeypatch.setattr(doubts, "TENSION_CHANGE", 1e-6)
    run = slack.linearised()
    said = " ".join(run.warnings)
    shape, data = slack.shape, run.data
    upper = data["messenger_wire_height"].values[:, shape.mesh.upper.node]
    lower = data["contact_wire_height"].values[:, shape.mesh.lower.node]
    length = (shape.dropper_lengths - (upper - lower)).max(axis=0)
    number, place = length.argmax(), shape.catenary.dropper_positions[length.argmax()]
    span = shape.catenary.dropper_spans[number]
    assert f"of span {span}, at {place:.4g} m, is slack" in said
    assert f"shortens by {1e3 * length.max():.0f} mm" in said
    (change,) = re.findall(r"changes by (\d+) N", said)
    # of any gap, as the nonlinear run's, 0.10 %; a start without terms of second order would shake it by 1 %
    assert 0.05 < 100 * float(change) / shape.catenary.contact_wire.tension < 0.2


@settings(deadline=None)
@example(spring=-5e-324, damper=-5e-324, cs=2.0, cd=0.0)  # smaller than what a third of it can be
@given(spring=st.floats(-500, 500), damper=st.floats(-500, 500), cs=st.floats(0, 3), cd=st.floats(0, 3))
def test_the_law_is_solved_exactly(spring, damper, cs, cd):
    force = plain(solve_one_way)(spring, damper, cs, cd)
    assert force >= 0
    assert force == pytest.approx(plain(one_way)(spring - cs * force, damper - cd * force), abs=1e-9)


LAW = np.array([[-0.02, 180.0], [0.01, 120.0], [0.015, 120.0], [0.05, 0.0]])


@given(free=st.floats(-0.1, 0.1), compliance=st.floats(0, 1e-3))
def test_a_law_of_points_is_solved_exactly(free, compliance):
    force = plain(solve_points)(LAW, len(LAW), free, compliance)
    assert force == pytest.approx(np.interp(free + compliance * force, *LAW.T), abs=1e-9)


@given(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))
def test_a_link_pulls_along_itself(y, z):
    """And its derivatives are those of its force."""
    links = SteadyArmBars(
        np.zeros((1, 2), int), np.array([[-1.1, 0.2]]), np.array([1.1]), np.array([3e5]), None
    )
    force = plain(link_force)
    fy, fz, yy, yz, zz = force(links, 0, y, z)
    towards = np.array([-1.1 - y, 0.2 - z])
    pull = 3e5 * (np.linalg.norm(towards) - 1.1)
    assert (fy, fz) == pytest.approx(tuple(pull * towards / np.linalg.norm(towards)), abs=1e-6)
    h = 1e-6
    in_y = np.subtract(force(links, 0, y + h, z)[:2], force(links, 0, y - h, z)[:2]) / (2 * h)
    in_z = np.subtract(force(links, 0, y, z + h)[:2], force(links, 0, y, z - h)[:2]) / (2 * h)
    assert in_y == pytest.approx((yy, yz), abs=1.0)
    assert in_z == pytest.approx((yz, zz), abs=1.0)


@pytest.mark.parametrize(
    ("spring", "damper"), [(50.0, 20.0), (50.0, -20.0), (50.0, 80.0), (50.0, -80.0), (-50.0, 20.0)]
)
def test_a_dropper_that_is_not_taut_lacks_stiffness(spring, damper):
    scheme = Scheme(1e-3, 0.3, 500.0, *[0.0] * 7)
    k, d, e = 1e5, 20.0, 1e-6
    rise = plain(one_way)(spring + k * scheme.b * e, damper + d * scheme.g * e) - plain(one_way)(
        spring, damper
    )
    lack = scheme.b * k + scheme.g * d - rise / e
    assert plain(_lack)(scheme, k, d, spring, damper) == pytest.approx(lack, abs=1e-3)


@pytest.fixture
def at_rest(space):
    """A slot of a linearised run at rest, and what its forces work on."""
    setup = LinearisedLine(space.shape).engine.setup
    return setup, Batch(setup, Sizes(pantographs=1, contacts=1, coordinates=1, steps=1, shapes=0), 1)


@pytest.mark.parametrize(("y", "z"), [(0.004, 0.06), (-0.02, -0.05), (0.0, 0.1)])
def test_a_link_that_swings_is_on_its_circle(at_rest, y, z):
    setup, slots = at_rest
    links, wires, work, b = setup.line.links, slots.wires, slots.work, setup.scheme.b
    wires.q[links.at[0], 0] = y, z
    change = entry(update_arm)(setup.scheme, setup.line, wires, work, 0, 0)
    feel(wires, links.compliance, change)
    y, z = wires.q[links.at[0], 0] + b * wires.x[links.at[0], 0]
    law = plain(link_force)
    (fy, fz, *_), (ry, rz, yy, yz, zz) = law(links, 0, y, z), law(links, 0, 0.0, 0.0)
    beyond = np.array([fy - ry - yy * y - yz * z, fz - rz - yz * y - zz * z])
    assert np.abs(beyond).max() > 5.0  # [N]
    assert work.arm_force[0, 0] == pytest.approx(beyond, abs=2e-3)
    assert change == pytest.approx(work.arm_force[0, 0])
    assert entry(update_arm)(setup.scheme, setup.line, wires, work, 0, 0) == (0.0, 0.0)


@pytest.mark.parametrize(
    ("spring", "damper"), [(50.0, 20.0), (50.0, -30.0), (50.0, 80.0), (50.0, -80.0), (-50.0, 20.0)]
)
def test_a_dropper_is_brought_to_its_law(at_rest, spring, damper):
    setup, slots = at_rest
    line, wires, work, i = setup.line, slots.wires, slots.work, 3
    part = slice(*line.rows.start[i : i + 2])
    at, row = line.rows.column[part].astype(int), line.rows.value[part]
    wires.q[at, 0] = row * (spring - line.tension[i]) / line.k[i] / (row @ row)
    wires.v[at, 0] = row * damper / line.d[i] / (row @ row)
    for _ in range(2):  # the second time from there
        change = entry(update_dropper)(setup.scheme, line, wires, work, 0, i)
        feel(wires, line.dropper_compliance, [change], i)
        now = plain(dropper_parts)(setup.scheme, line, wires, 0, i)
        assert sum(now) - work.slack[0, i] == pytest.approx(plain(one_way)(*now), abs=1e-9)
    assert change == pytest.approx(0.0, abs=1e-9)
    assert (work.slack[0, i] == 0) == (abs(damper) <= spring)
