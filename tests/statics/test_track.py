"""Transition curves, cant, a messenger wire that follows: lateral forces against the polygon's formula."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.layout import layout_warnings

T, L = 15e3, 50.0
# without bending stiffness, which rounds the kinks at the supports by millimetres
CONTACT = cf.Wire(mass_per_length=1.07, tension=T, axial_stiffness=1.4e7)
DROPPERS = tuple(cf.Dropper(position=x) for x in (5.0, 15.0, 25.0, 35.0, 45.0))
RADII = ((0, 0), (0, 1500.0), (1500.0, 900.0), (900.0, 900.0), (900.0, 0), (0, 0))
CANTS = (0.0, 0.0, 0.06, 0.1, 0.1, 0.0, 0.0)


def line(radii=((0, 0),) * 6, staggers=(0.0,) * 7, cants=(0.0,) * 7, heights=(5.3,) * 7, **support):
    """Contact wire held by stiff springs, sideways rigid, so that any pull can be had."""
    arm = cf.SteadyArm(stiffness=200.0, mass=0.5)
    spans = tuple(cf.Span(length=L, droppers=DROPPERS, curve_radius=a, curve_radius_end=b) for a, b in radii)
    supports = tuple(
        cf.Support(
            messenger_stiffness=5e5, steady_arm=arm, stagger=s, cant=d, contact_wire_height=h, **support
        )
        for s, d, h in zip(staggers, cants, heights, strict=True)
    )
    return cf.Catenary(
        contact_wire=CONTACT, spans=spans, supports=supports, spatial=True,
        messenger_wire=cf.library.wire("BzII 70", tension=15e3), system_height=1.4,
        damping=cf.RayleighDamping(beta=1e-4), evaluated_spans=(4,),
    )  # fmt: skip


def kappa(radius):
    return 1 / radius if radius else 0.0


def test_a_transition_curve_pulls_at_the_arms_as_a_load_that_grows_linearly():
    """T times the change of direction: of a load T κ from κ₁ to κ₂, T L (κ₁ + 2 κ₂)/6 at a span's end."""
    catenary = line(RADII, messenger_stagger="follows")
    k = np.array([[kappa(a), kappa(b)] for a, b in RADII])
    by_hand = T * L * ((k[:-1, 0] + 2 * k[:-1, 1]) + (2 * k[1:, 0] + k[1:, 1])) / 6
    assert catenary.lateral_pulls[1:-1] == pytest.approx(by_hand, rel=1e-12)
    shape = cf.find_form(catenary)
    assert -shape.steady_arm_lateral_forces[1:-1] == pytest.approx(by_hand, rel=5e-3, abs=0.5)
    assert by_hand.max() > 700.0


def test_the_wire_lies_inwards_by_the_integral_of_the_curvature():
    """κ = κ₂ x/L: y'' = -κ, y(0) = y(L) = 0: y = κ₂ (L² x - x³)/(6 L)."""
    wire = cf.find_form(line(((0, 0), (0, 1000.0), (1000.0, 1000.0), *((1000.0, 1000.0),) * 3),
                             messenger_stagger="follows")).wires[0]  # fmt: skip
    x = np.array([10.0, 25.0, 40.0])
    assert wire.lateral(L + x) == pytest.approx((L**2 * x - x**3) / (6 * L * 1000.0), rel=5e-3)


def test_a_transition_that_does_not_bend_is_a_circle():
    circle = line(((900.0, None),) * 6, (0.1,) * 7)
    same = line(((900.0, 900.0),) * 6, (0.1,) * 7)
    a, b = cf.find_form(circle), cf.find_form(same)
    assert a.steady_arm_lateral_forces.tolist() == b.steady_arm_lateral_forces.tolist()


def test_the_mirror_image_of_transition_and_cant():
    catenary = line(RADII, (0.0, 0.1, -0.1, -0.2, -0.2, 0.0, 0.1), CANTS)
    there, back = cf.find_form(catenary), cf.find_form(catenary.mirrored())
    assert catenary.mirrored().mirrored() == catenary
    assert back.steady_arm_lateral_forces[::-1] == pytest.approx(there.steady_arm_lateral_forces, abs=1e-6)
    assert back.dropper_lengths[::-1] == pytest.approx(there.dropper_lengths, abs=1e-9)


def test_cant_that_rises_bends_the_way_of_the_pantograph():
    """The head's centre swings by h·cant/1.5 m; arms take T times the change of its direction.

    The droppers are plumb, below a messenger wire that follows: of the weight that the lean of the track
    makes a lateral one, an arm has the part that it carries anyway.
    """
    catenary = line(cants=CANTS, messenger_stagger="follows")
    way = 5.3 * np.array(CANTS) / 1.5
    by_hand = T * np.diff(np.diff(way) / L)
    assert catenary.lateral_pulls[1:-1] == pytest.approx(by_hand, rel=1e-12)
    shape = cf.find_form(catenary)
    found = -shape.steady_arm_lateral_forces[1:-1]
    weight = np.array(CANTS[1:-1]) / 1.5 * shape.steady_arm_forces[1:-1]
    assert found == pytest.approx(by_hand + weight, abs=0.5)
    assert np.abs(by_hand).max() > 100.0 and weight.max() > 3.0


def test_a_canted_line_seen_from_the_level_is_the_same_line():
    """Constant cant: a frame that leans. Staggers and heights, turned into it, hang the line alike."""
    phi, h, system = 0.1 / 1.5, 5.3, 1.4
    level = line(staggers=(0.2, -0.2) * 3 + (0.2,), messenger_stagger="follows")
    y = level.staggers
    turned = y * np.cos(phi) - h * np.sin(phi), y * np.sin(phi) + h * np.cos(phi)
    above = y * np.cos(phi) - (h + system) * np.sin(phi)
    canted = line(staggers=turned[0], heights=turned[1], cants=(0.1,) * 7)
    supports = [s.replace(messenger_stagger=m, system_height=system * np.cos(phi))
                for s, m in zip(canted.supports, above, strict=True)]  # fmt: skip
    a, b = cf.find_form(level), cf.find_form(canted.replace(supports=tuple(supports)))
    x = np.linspace(0.0, 300.0, 61)
    back = b.wires[0].lateral(x) * np.cos(phi) + b.contact_wire_height(x) * np.sin(phi)
    assert back == pytest.approx(a.wires[0].lateral(x), abs=2e-3)
    assert b.dropper_lengths == pytest.approx(a.dropper_lengths, abs=6e-3)


def test_a_messenger_wire_that_follows_hangs_above_the_contact_wire():
    staggers = (0.2, 0.1, -0.2, -0.2, -0.2, 0.2, -0.2)
    follows = line(RADII, staggers, messenger_stagger="follows")
    assert follows.messenger_staggers == pytest.approx(staggers)
    curves = line(RADII, staggers, messenger_stagger="in curves")
    assert curves.messenger_staggers == pytest.approx((0.0, 0.1, -0.2, -0.2, -0.2, 0.2, 0.0))
    shape = cf.find_form(curves)
    rows = shape.support_schedule()
    assert [row.messenger_stagger_m for row in rows] == pytest.approx(curves.messenger_staggers, abs=1e-12)
    assert (rows[1].curve_radius_before_m, rows[1].curve_radius_after_m) == (None, None)
    assert (rows[2].curve_radius_before_m, rows[3].curve_radius_after_m) == pytest.approx((1500.0, 900.0))
    # in a canted track plumb is to the outside of the track's own axis
    canted = line(cants=(0.15,) * 7, messenger_stagger="follows")
    assert canted.messenger_staggers == pytest.approx(-1.4 * 0.1)
    plane = line(messenger_stagger="in curves").replace(spatial=None)
    assert not plane.is_spatial and not follows.replace(spatial=None).planar().is_spatial


@pytest.fixture(scope="module")
def curve():
    staggers = (0.0, 0.0, -0.1, -0.2, -0.2, 0.0, 0.1)
    return cf.find_form(line(RADII, staggers, CANTS, messenger_stagger="in curves"))


def test_engines_agree_in_a_transition_with_cant(curve, pantograph):
    runs = {
        method: cf.simulate(curve, [pantograph], speed=45.0, positions=[60.0], method=method)
        for method in ("nonlinear", "linearised", "exudyn")
    }
    forces = {method: run.contact_force_statistics()[0] for method, run in runs.items()}
    for method in ("linearised", "exudyn"):
        assert forces[method].std == pytest.approx(forces["nonlinear"].std, rel=0.03), method
        assert forces[method].mean == pytest.approx(forces["nonlinear"].mean, abs=0.5), method
    check = next(check for check in runs["nonlinear"].checks if check.name == "energy balance")
    assert check.passed


def test_what_is_no_track_is_refused_or_warned_of():
    with pytest.raises(cf.InputError, match="curve_radius_end = 20 m: no track"):
        cf.Span(length=L, droppers=DROPPERS, curve_radius_end=20.0)
    with pytest.raises(cf.InputError, match=r"cant = 100.0: must be at most 0\.3; it is \[m\] by which"):
        cf.Support(cant=100.0)
    for value, rule in (
        ("follow", "a number, 'follows' or 'in curves'"), (-200.0, "at least -10"), (True, "a number"),
        (float("nan"), "a finite number"), (None, "a number"),
    ):  # fmt: skip
        with pytest.raises(cf.InputError, match=rf"^messenger_stagger = .*: must be {rule}; it is \[m\]"):
            cf.Support(messenger_stagger=value)
    (warning,) = layout_warnings(line(RADII).replace(cant_base=1.07))
    assert "cant_base = 1.07 m has no effect" in warning
