"""A nonlinear run that a script steers step by step."""

import numpy as np
import pytest

import catenary_fe as cf
from tests.engines.test_base_motion import HEAD, ROUGH
from tests.engines.test_irregularity import stiff_rail

SPEED = 50.0


def same(one: cf.Run, other: cf.Run) -> bool:
    """All variables to the last bit, and what the record says of its input."""
    variables = one.data.variables.keys() == other.data.variables.keys() and all(
        np.asarray(one.data[name].values).tobytes() == np.asarray(other.data[name].values).tobytes()
        for name in one.data.data_vars
    )
    return variables and all(
        one.data.attrs[key] == other.data.attrs[key] for key in ("input_sha256", "settings", "warnings")
    )


@pytest.mark.parametrize("conditions", [None, ROUGH], ids=["still", "over a moving base"])
def test_nothing_asked_is_the_run_of_simulate(
    short_shape: cf.Shape, pantograph: cf.Pantograph, conditions: cf.Conditions | None
) -> None:
    """Two pantographs, in chunks of different lengths; one that is pushed by 1 % more is another run."""
    heads, asked = (
        [pantograph] * 2,
        {"speed": SPEED, "positions": [95.0, 60.0], "conditions": conditions},
    )
    run = cf.simulate(short_shape, heads, **asked)
    with cf.stepping(short_shape, heads, **asked) as session:
        chunks = [1, 49, 7, 50, 13]
        while not session.finished:
            left = run.time.size - 1 - round(session.time / run.step)
            force = session.step(min(chunks[0], left))
            chunks = [*chunks[1:], chunks[0]]
        assert same(session.run(), run)
    assert force.tolist() == run.data["contact_force"].values[:, -1].tolist()
    assert session.position == pytest.approx(run.data["position"].values[:, -1])
    assert session.wire_height == pytest.approx(run.data["wire_height"].values[:, -1])
    last = run.data["mass_height"].values[:, :, -1] - run.catenary.contact_wire_height
    assert np.array(session.heights) == pytest.approx(last)
    other = cf.stepping(short_shape, heads, **asked)
    other.step(other._steps, uplift_force=[121.2, 120.0])
    assert not same(other.run(), run)


def test_of_a_mean_force_the_uplift_is_found(short_shape: cf.Shape) -> None:
    head = cf.library.pantograph("EN 50318:2018 AC")
    assert head.mean_force
    asked = {"speed": SPEED, "positions": [80.0]}
    session = cf.stepping(short_shape, [head], **asked)
    linearised = cf.simulate(short_shape, [head], method="linearised", **asked)
    assert session.uplift_force[0] == pytest.approx(linearised.data["uplift_force"].values[0], rel=2e-3)
    assert session.uplift_force[0] != pytest.approx(head.target_mean_force(SPEED), rel=0.01)


def test_a_lower_push_takes_the_head_off_and_a_higher_one_brings_it_back(short_shape, pantograph) -> None:
    session = cf.stepping(short_shape, [pantograph], speed=SPEED, positions=[20.0])
    assert session.contact_force[0] == pytest.approx(116.3, abs=0.1)  # of 120 N, its spring takes some
    session.step(400, uplift_force=-100.0)
    assert session.contact_force[0] == 0.0 and session.heights[0][0] < -0.1
    assert session.velocities[0][0] < 0
    session.step(700, uplift_force=200.0)
    assert session.heights[0][0] > -0.05
    run = session.run()
    assert "model" in run.data.attrs and "computed step by step" in str(run.data.attrs["warnings"])
    assert not {check.name for check in run.checks} & {"force balance", "pantograph energy", "energy balance"}


def test_a_lifted_base_is_that_of_conditions() -> None:
    """A sine from its crest on: what is left is half a step's lag of the rate, which is a difference."""
    bar, length, height = stiff_rail(), 12.5, 2e-3
    x = np.arange(0.0, 301.0, 0.05)
    lifted = height * (1 - np.cos(2 * np.pi * (x - 10.0) / length))
    moved = cf.Conditions(base=cf.BaseMotion(height=list(zip(x.tolist(), lifted.tolist(), strict=True))))
    asked = {"speed": SPEED, "positions": [10.0]}
    run = cf.simulate(bar, [HEAD], conditions=moved, **asked)
    own, late = (cf.stepping(bar, [HEAD], duration=2.0, **asked) for _ in range(2))
    for session, shift in ((own, 0), (late, 10)):
        while not session.finished:
            place = session.position[0] + SPEED * 1e-3 * (1 - shift)
            session.step(base_height=height * (1 - np.cos(2 * np.pi * (max(place, 10.0) - 10.0) / length)))
    force = run.data["contact_force"].values[0, :2001]
    more = np.abs(force - force[0]).max()
    assert np.abs(own.run().data["contact_force"].values[0] - force).max() < 0.03 * more
    assert np.abs(late.run().data["contact_force"].values[0] - force).max() > 0.1 * more


def test_another_speed_halfway(short_shape: cf.Shape) -> None:
    """Places follow; standing still the force comes to rest at that of static contact."""
    session = cf.stepping(short_shape, [HEAD], speed=SPEED, positions=[20.0], duration=3.6)
    session.step(400)
    assert session.position[0] == pytest.approx(40.0)
    session.step(400, speed=30.0)
    assert session.position[0] == pytest.approx(52.0)
    session.step(2800, speed=0.0)
    assert session.position[0] == pytest.approx(52.0) and session.finished
    force = session.run().data["contact_force"].values[0]
    still = cf.stepping(short_shape, [HEAD], speed=SPEED, positions=[52.0], duration=0.1)
    assert force[-500:].mean() == pytest.approx(still.contact_force[0], rel=0.01)
    assert np.ptp(force[-500:]) < 0.2 * np.ptp(force[400:1400])
    assert session.wire_height[0] == pytest.approx(float(still.wire_height[0]), abs=2e-3)


def test_a_part_of_a_run(short_shape: cf.Shape, pantograph: cf.Pantograph) -> None:
    asked = {"speed": SPEED, "positions": [80.0]}
    whole = cf.simulate(short_shape, [pantograph], **asked)
    session = cf.stepping(short_shape, [pantograph], **asked)
    session.step(10)
    with pytest.raises(cf.InputError, match="10 steps are too few to be judged; take at least 50"):
        session.run()
    session.step(490)
    part = session.run()
    assert part.time.size == 501 and not part.reached
    assert (part.data["contact_force"].values == whole.data["contact_force"].values[:, :501]).all()
    session.step(100)
    assert session.run().time.size == 601


def test_what_is_refused(short_shape: cf.Shape, pantograph: cf.Pantograph) -> None:
    session = cf.stepping(short_shape, [pantograph], speed=SPEED, positions=[80.0], duration=4.0)
    for asked, said in (
        ({"steps": 5000}, "the session lasts 4 s; give stepping a longer duration"),
        ({"steps": 0}, "steps"),
        ({"uplift_force": 12e3}, r"within ±5000 N"),
        ({"uplift_force": [100.0, 100.0]}, r"shape \(2,\) for 1 pantographs; give one for all or one each"),
        ({"base_height": 30.0}, r"within ±3 m"),
        ({"speed": -1.0}, "speed"),
        ({"speed": 300.0}, "speed"),
    ):
        with pytest.raises(cf.InputError, match=said):
            session.step(**asked)
    assert session.time == 0.0
    with pytest.raises(cf.InputError, match="beyond the line's end at 240 m; stop before, or slow down"):
        session.step(3500)
    moving = cf.stepping(short_shape, [pantograph], speed=SPEED, positions=[80.0], conditions=ROUGH)
    for asked in ({"base_height": 0.1}, {"speed": 40.0}):
        with pytest.raises(cf.InputError, match="the conditions move the bases already"):
            moving.step(**asked)
