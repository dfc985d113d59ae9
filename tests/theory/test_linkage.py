"""A frame as a mechanism: closed forms of a parallelogram, and differences of positions of any."""

import numpy as np
import pytest

from catenary_fe.theory.linkage import Bar, Linkage

FRAME = Linkage(
    lower=Bar(1.6, 32.0, 0.8, 8.0),
    upper=Bar(2.19, 18.0, 0.9, 7.0),
    rod=Bar(1.67, 5.0, 0.83, 1.2),
    lever=0.2,
    lever_angle=3.376,
    rod_pivot=(-0.2, -0.32),
    apex_mass=8.0,
)


def centres(frame: Linkage, angle: float) -> np.ndarray:
    """[m], shape (4, 2): of lower arm, upper arm, rod and apex."""
    pose = frame.pose(angle)

    def along(turn):
        return np.array([np.cos(turn), np.sin(turn)])

    return np.array(
        [
            frame.lower.centre * along(pose.lower),
            pose.knee + frame.upper.centre * along(pose.upper),
            np.array(frame.rod_pivot) + frame.rod.centre * along(pose.rod),
            pose.apex,
        ]
    )


def test_it_closes():
    """The rod reaches from its pivot to the lever's end, and the lever has its angle on the upper arm."""
    angles = np.linspace(*FRAME.working, 60)
    pose = FRAME.pose(angles)
    held = pose.tip - np.reshape(FRAME.rod_pivot, (2, 1))
    assert np.hypot(*held) == pytest.approx(np.full(60, 1.67), abs=1e-12)
    assert np.hypot(*(pose.tip - pose.knee)) == pytest.approx(np.full(60, 0.2), abs=1e-12)
    arm, lever = pose.apex - pose.knee, pose.tip - pose.knee
    turn = np.arctan2(arm[0] * lever[1] - arm[1] * lever[0], (arm * lever).sum(axis=0))
    assert np.mod(turn, 2 * np.pi) == pytest.approx(np.full(60, 3.376), abs=1e-9)


def test_the_apex_goes_up_nearly_straight():
    low, high = FRAME.heights
    heights = np.linspace(low + 0.1, 3.0, 30)
    drift = [FRAME.pose(FRAME.angle_at(z)).apex[0] for z in heights]
    assert high - low > 3.0 and np.ptp(drift) < 0.06
    assert [float(FRAME.pose(FRAME.angle_at(z)).apex[1]) for z in heights] == pytest.approx(
        heights, abs=1e-12
    )


@pytest.mark.parametrize("height", [0.8, 1.6, 2.4])
def test_mass_and_weight_by_differences_of_positions(height):
    """½ M ż² is the kinetic energy, W the derivative of the potential one: positions are differenced."""
    angle, h = FRAME.angle_at(height), 1e-5
    masses = np.array([32.0, 18.0, 5.0, 8.0])
    poses = [FRAME.pose(angle + s * h) for s in (-1, 1)]
    speeds = (centres(FRAME, angle + h) - centres(FRAME, angle - h)) / (2 * h)
    turns = [
        (getattr(poses[1], name) - getattr(poses[0], name)) / (2 * h) for name in ("lower", "upper", "rod")
    ]
    energy = masses @ (speeds**2).sum(axis=1) + np.array([8.0, 7.0, 1.2]) @ np.square(turns)
    assert float(FRAME.mass(angle)) == pytest.approx(energy / speeds[3, 1] ** 2, rel=1e-8)
    assert float(FRAME.mass(angle)) != pytest.approx(1.0001 * energy / speeds[3, 1] ** 2, rel=1e-8)
    assert float(FRAME.weight(angle)) == pytest.approx(9.81 * masses @ speeds[:, 1] / speeds[3, 1], rel=1e-8)
    assert float(FRAME.rise(angle)) == pytest.approx(speeds[3, 1], rel=1e-8)
    turned = [turns[0], turns[1] - turns[0], turns[1] - turns[2], turns[2]]
    assert FRAME.joint_rates(angle) == pytest.approx(np.array(turned) / speeds[3, 1], rel=1e-7)


@pytest.mark.parametrize("angle", [0.3, 0.8, 1.1])
def test_a_parallelogram_in_closed_form(angle):
    """The rod as long as the lower arm and the lever as the pivots' distance: the upper arm does not turn."""
    frame = Linkage(
        lower=Bar(1.5, 30.0, 0.7, 6.0),
        upper=Bar(1.2, 15.0, 0.5, 3.0),
        rod=Bar(1.5, 4.0, 0.75, 0.5),
        lever=0.3,
        lever_angle=np.radians(110.0),
        rod_pivot=(0.3 * np.cos(np.radians(-70.0)), 0.3 * np.sin(np.radians(-70.0))),
        apex_mass=9.0,
    )
    sides = [side for side in (1, -1) if abs(float(frame.pose(angle, side).upper_rate)) < 1e-9]
    assert len(sides) == 1
    pose = frame.pose(angle, sides[0])
    assert np.cos(pose.upper) == pytest.approx(-1.0) and pose.rod == pytest.approx(angle)
    moved = Linkage(**{**vars_of(frame)})
    moved.__dict__["_reach"] = (sides[0], (0.0, 1.4))
    inertia = 30.0 * 0.7**2 + 6.0 + 15.0 * 1.5**2 + 4.0 * 0.75**2 + 0.5 + 9.0 * 1.5**2
    assert float(moved.mass(angle)) == pytest.approx(inertia / (1.5 * np.cos(angle)) ** 2, rel=1e-12)
    weight = 9.81 * (30.0 * 0.7 + 15.0 * 1.5 + 4.0 * 0.75 + 9.0 * 1.5) / 1.5
    assert float(moved.weight(angle)) == pytest.approx(weight, rel=1e-12)


def vars_of(frame: Linkage) -> dict:
    names = ("lower", "upper", "rod", "lever", "lever_angle", "rod_pivot", "apex_mass")
    return {name: getattr(frame, name) for name in names}


def test_what_does_not_close():
    frame = Linkage(**{**vars_of(FRAME), "rod": Bar(0.2)})
    with pytest.raises(ValueError, match="do not close"):
        _ = frame.heights
    with pytest.raises(ValueError, match=r"the apex reaches 0\.371 to 3\.6.* m above the base pivot"):
        FRAME.angle_at(4.5)
