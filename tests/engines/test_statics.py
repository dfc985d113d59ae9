"""Statics under load: independent elasticity, slack droppers, superposition where it holds."""

import numpy as np
import pytest

import catenary_fe as cf


def test_elasticity_agrees_with_an_independent_model(reference_shape):
    # elasticity at 100 N of an independent planar finite-element model of EN 50318:2002
    x = np.array([0, 2.5, 5, 10.5, 17, 23.5, 30])
    expected = [0.234, 0.226, 0.191, 0.293, 0.383, 0.436, 0.454]
    curve = cf.elasticity(reference_shape, force=100.0, positions=240 + x)
    assert 1e3 * curve.values == pytest.approx(expected, rel=0.01)  # asked for: 2 %


def test_an_elasticity_with_one_percent_more_tension_would_be_seen(reference, reference_shape):
    stiffer = reference.replace(
        contact_wire=reference.contact_wire.replace(tension=1.01 * reference.contact_wire.tension),
        messenger_wire=reference.messenger_wire.replace(tension=1.01 * reference.messenger_wire.tension),
    )
    soft, hard = (
        cf.elasticity(shape, positions=[270.0]).values for shape in (reference_shape, cf.find_form(stiffer))
    )
    assert hard / soft == pytest.approx(1 / 1.01, rel=2e-3)


def test_the_curve_of_a_span_is_symmetric(reference_shape):
    curve = cf.elasticity(reference_shape, spans=[5], points_per_span=12)
    assert curve.values == pytest.approx(curve.values[::-1], rel=2e-3)
    assert curve.non_uniformity == pytest.approx(
        (curve.values.max() - curve.values.min()) / (curve.values.max() + curve.values.min())
    )


def test_droppers_go_slack_under_a_large_force(reference_shape):
    state = cf.solve_statics(reference_shape, [(270.0, 300.0)])
    assert state.dropper_forces.min() == 0
    assert state.dropper_forces[40] == 0  # the one at 270 m
    lift = np.interp(270.0, state.contact_wire_x, state.contact_wire_uplift)
    small = cf.solve_statics(reference_shape, [(270.0, 30.0)])
    assert lift > 10.5 * np.interp(270.0, small.contact_wire_x, small.contact_wire_uplift)


def test_small_forces_superpose(reference_shape):
    places = [(150.0, 20.0), (171.0, 15.0)]
    both = cf.solve_statics(reference_shape, places).contact_wire_uplift
    parts = sum(cf.solve_statics(reference_shape, [place]).contact_wire_uplift for place in places)
    assert both == pytest.approx(parts, abs=2e-5)


def test_no_force_no_lift(reference_shape):
    state = cf.solve_statics(reference_shape)
    assert np.abs(state.contact_wire_uplift).max() < 1e-6


@pytest.mark.parametrize("bad", [{"force": 0.0}, {"force": -5.0}, {"spans": [11]}, {"positions": [601.0]}])
def test_bad_questions(reference_shape, bad):
    with pytest.raises(cf.InputError):
        cf.elasticity(reference_shape, **bad)
