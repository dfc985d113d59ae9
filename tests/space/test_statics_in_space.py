"""Lines in space at rest: against the plane, against polygons by hand, against equilibrium."""

import numpy as np
import pytest

import catenary_fe as cf

G = 9.81


def test_a_flat_line_in_space_is_the_planar_one(flat):
    plane, space = cf.find_form(flat), cf.find_form(flat.replace(spatial=True))
    assert space.catenary.is_spatial and not plane.catenary.is_spatial
    assert space.dropper_forces == pytest.approx(plane.dropper_forces, rel=1e-4)
    assert space.dropper_lengths == pytest.approx(plane.dropper_lengths, rel=1e-4)
    x = [120.0, 125.0, 150.0]
    curves = [cf.elasticity(shape, positions=x).values for shape in (plane, space)]
    assert curves[1] == pytest.approx(curves[0], rel=1e-4)


def test_arm_forces_are_tension_times_angle(following):
    shape = cf.find_form(following)
    by_hand = 22e3 * 2 * 0.4 / 55 * np.array([0, 1, -1, 1, 0])
    assert following.lateral_pulls == pytest.approx(by_hand)
    assert -shape.steady_arm_lateral_forces == pytest.approx(by_hand, rel=5e-3)


def test_between_supports_the_wire_runs_straight(following):
    wire = cf.find_form(following).contact_wires[0]
    x = np.linspace(55, 110, 23)
    straight = -0.2 + 0.4 * (x - 55) / 55
    # EI rounds the corner at an arm off over √(EI/T) = 0.1 m: by 0.7 mm
    assert wire.lateral(x) == pytest.approx(straight, abs=1e-3)


@pytest.mark.parametrize("radius", [600.0, -600.0])
def test_a_curve(following, radius):
    """A polygon on a circle: pull T L/R, versine L²/8R inside the curve, messenger wire likewise."""
    supports = tuple(s.replace(stagger=0.0, messenger_stagger=0.0) for s in following.supports)
    spans = tuple(s.replace(curve_radius=radius) for s in following.spans)
    line = following.replace(supports=supports, spans=spans)
    shape = cf.find_form(line)
    pull = 22e3 * 55 / radius
    assert line.lateral_pulls[1:-1] == pytest.approx([pull] * 3)
    # droppers lean by what the two wires' ways round the curve differ, 1.8 kN of tension in all is 0.1 %
    assert -shape.steady_arm_lateral_forces[2] == pytest.approx(pull, rel=5e-3)
    for wire, hanging in (
        (line.contact_wire, shape.contact_wires[0]),
        (line.messenger_wire, shape.messenger_wire),
    ):
        rounding = np.sqrt(wire.bending_stiffness / wire.tension)  # of the corner L/R at the supports
        versine = 55**2 / (8 * radius) - rounding * 55 / radius / 2
        assert hanging.lateral(82.5) == pytest.approx(versine, rel=5e-3)


def test_leaning_droppers_pull_on_the_arms(staggered, staggered_shape):
    """Moments of half a span about the track: what droppers take sideways the arm must hold too."""
    shape = staggered_shape
    lower, upper = (shape.mesh.nodes(c) for c in (shape.mesh.lower, shape.mesh.upper))
    y, z = (np.concatenate([getattr(w, a) for w in shape.wires]) for a in "yz")
    sideways = shape.dropper_forces * (y[upper] - y[lower]) / shape.installed_lengths
    at, supports = staggered.dropper_positions, staggered.support_positions
    share = np.interp(at, supports[1:4], [0, 1, 0])
    by_hand = -staggered.lateral_pulls[2] - share @ sideways
    assert shape.steady_arm_lateral_forces[2] == pytest.approx(by_hand, rel=5e-3)
    assert abs(share @ sideways) > 40  # N: they do pull
    assert (z[upper] > z[lower]).all()


def test_a_link_acts_like_pull_over_length(following):
    """Lifted at the support, a line with level arms gives like its planar equivalent.

    Inclined by the usual 11° they take the wire sideways too, and are 1.2 % stiffer.
    """
    x = [110.0]
    level = [s.replace(steady_arm=s.steady_arm.replace(inclination=0.0)) for s in following.supports]
    following = following.replace(supports=tuple(level))
    space = cf.elasticity(cf.find_form(following), positions=x, force=50.0)
    plane = cf.elasticity(cf.find_form(following.planar()), positions=x, force=50.0)
    without = following.planar()
    without = without.replace(
        supports=tuple(s.replace(steady_arm=s.steady_arm.replace(stiffness=1.0)) for s in without.supports)
    )
    soft = cf.elasticity(cf.find_form(without), positions=x, force=50.0)
    assert following.planar().supports[2].steady_arm.stiffness == pytest.approx(22e3 * 0.8 / 55 / 1.2)
    assert space.values == pytest.approx(plane.values, rel=5e-3)
    assert soft.values > 1.03 * plane.values  # the arm's share is seen


def test_a_given_inclination_decides_the_height(following):
    tilt = 0.1
    supports = tuple(s.replace(steady_arm=s.steady_arm.replace(inclination=tilt)) for s in following.supports)
    shape = cf.find_form(following.replace(supports=supports))
    up, left = shape.steady_arm_forces[2], shape.steady_arm_lateral_forces[2]
    assert up == pytest.approx(abs(left) * np.tan(tilt), rel=1e-6)
    node = shape.mesh.contact.supports[2]
    assert shape.contact_wire_z[node] < following.contact_wire_height - 1e-3  # 32 N where 62 N would do


def test_heights_for_given_lengths_in_space(staggered, staggered_shape):
    again = cf.find_heights(staggered, staggered_shape.dropper_lengths)
    assert again.dropper_forces == pytest.approx(staggered_shape.dropper_forces, rel=2e-3)
    assert np.abs(again.height_errors).max() < 1e-4
    assert again.steady_arm_lateral_forces == pytest.approx(
        staggered_shape.steady_arm_lateral_forces, rel=2e-3, abs=0.1
    )


def test_all_weight_is_carried(staggered, staggered_shape):
    """Arms and supports together carry wires, clamps, droppers and half of the arms."""
    line, shape = staggered, staggered_shape
    droppers = sum(
        d.mass_per_length * length + d.contact_wire_clamp_mass + d.messenger_clamp_mass
        for d, length in zip(line.droppers, shape.dropper_lengths, strict=True)
    )
    inner = slice(1, -1)  # the contact wire's ends carry half of the outer bays, 4.5 m long
    weight = G * (1.35 * (line.length - 4.5) + 1.08 * line.length + droppers + 3 * (0.73 * 1.2 / 2 + 0.2))
    carried = shape.steady_arm_forces[inner].sum() + shape.support_forces.sum()
    assert carried == pytest.approx(weight, rel=1e-3)
