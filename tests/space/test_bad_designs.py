"""Designs in space that no crew could install: one clear line each."""

import pytest

import catenary_fe as cf


def with_arm(line, **changes):
    supports = tuple(s.replace(steady_arm=s.steady_arm.replace(**changes)) for s in line.supports)
    return line.replace(supports=supports)


def test_an_arm_on_the_wrong_side_would_push(staggered):
    with pytest.raises(cf.InputError, match=r"support 2: the arm on the left would have to push with 37\d N"):
        cf.find_form(with_arm(staggered, side="left"))
    lengths = cf.find_form(staggered).dropper_lengths
    with pytest.raises(cf.InputError, match="support 2: the arm on the left would have to push"):
        cf.find_heights(with_arm(staggered, side="left"), lengths)


def test_nothing_pulls_an_arm_without_stagger(staggered):
    supports = tuple(s.replace(stagger=0.0) for s in staggered.supports)
    with pytest.raises(cf.InputError, match="support 2: no lateral force on the steady arm"):
        cf.find_form(staggered.replace(supports=supports))


def test_too_little_stagger_lets_the_arm_stand_up(staggered):
    supports = tuple(s.replace(stagger=0.01 if s.stagger > 0 else -0.01) for s in staggered.supports)
    with pytest.raises(cf.InputError, match=r"the steady arm would stand up by \d+° to hold"):
        cf.find_form(staggered.replace(supports=supports))


def test_stagger_needs_an_arm(staggered):
    bare = staggered.supports[1].replace(steady_arm=None)
    with pytest.raises(cf.InputError, match=r"support 2: stagger = -0\.2 m without a steady_arm"):
        staggered.replace(supports=(staggered.supports[0], bare, *staggered.supports[2:]))


@pytest.mark.parametrize(
    ("arm", "said"),
    [
        ({}, "stiffness and length: give exactly one"),
        ({"stiffness": 1.0, "length": 1.0}, "stiffness and length: give exactly one"),
        ({"stiffness": 1.0, "clamp_mass": 1.0}, "clamp_mass has no effect on an arm that is a spring"),
        ({"length": 1.0, "preload": 1.0}, "preload has no effect on an arm that is a link"),
        ({"length": 1.0, "holds_design_height": False}, "needs an inclination"),
        ({"length": 1.0, "side": "up"}, "side = 'up'"),
        ({"length": 1.0, "inclination": 2.0}, "inclination = 2.0: must be less than"),
    ],
)
def test_arms_that_cannot_be(arm, said):
    with pytest.raises(cf.InputError, match=said):
        cf.SteadyArm(**arm)


def test_sharp_curves_and_planes_that_are_none(staggered):
    with pytest.raises(cf.InputError, match="curve_radius = 10 m"):
        staggered.spans[0].replace(curve_radius=10.0)
    with pytest.raises(cf.InputError, match="spatial = false, but stagger"):
        staggered.replace(spatial=False)
    assert not staggered.planar().is_spatial


def test_millimetres_of_stagger_stand_out(reference):
    for name in ("stagger", "messenger_stagger"):
        with pytest.raises(cf.InputError, match=rf"{name} = 200\.0: must be at most 10; it is \[m\]"):
            reference.supports[1].replace(**{name: 200.0})


def test_a_link_that_no_spring_stands_for_is_named(reference):
    arm = cf.SteadyArm(length=1e-13, mass_per_length=1.0)
    support = cf.Support(messenger_stiffness=5e5, steady_arm=arm)
    sides = tuple(support.replace(stagger=0.2 * (-1) ** i) for i in range(11))
    with pytest.raises(cf.InputError, match="support 2: the steady arm as a vertical spring of pull over"):
        reference.replace(supports=sides).planar()


def test_a_file_with_stagger_and_a_support_that_differs(tmp_path, reference_layout):
    text = (reference_layout.parent / "en50318_2018_ac_simple.toml").read_text()
    path = tmp_path / "line.toml"
    changes = "[[supports]]\nat = 3\nstagger = 0.1\n\n[[span]]\ncurve_radius = 900.0"
    path.write_text(text.replace("[[span]]", changes, 1))
    line = cf.load_catenary(path)
    assert line.staggers[:5].tolist() == [0.2, -0.2, 0.1, -0.2, 0.2]
    assert line.spans[4].curvatures == pytest.approx((1 / 900, 1 / 900))
