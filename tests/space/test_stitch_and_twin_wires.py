"""Stitch wires even the elasticity out; two contact wires share what the head gives."""

import numpy as np
import pytest

import catenary_fe as cf


def line(layout, name, spans=4):
    full = cf.load_catenary(layout.parent / name)
    return full.replace(
        spans=full.spans[:spans], supports=full.supports[: spans + 1], evaluated_spans=(spans - 1,)
    )


@pytest.fixture(scope="module")
def stitched(reference_layout):
    return line(reference_layout, "re330.toml")


@pytest.fixture(scope="module")
def stitched_shape(stitched):
    return cf.find_form(stitched)


@pytest.fixture(scope="module")
def twin(reference_layout):
    return line(reference_layout, "dc_3kv_twin.toml", spans=3).replace(evaluated_spans=(2,))


@pytest.fixture(scope="module")
def twin_shape(twin):
    return cf.find_form(twin)


def test_the_stitch_wire_has_its_tension_and_its_droppers(stitched, stitched_shape):
    shape = stitched_shape
    assert len(shape.stitch_wires) == 3
    rows = [r.hangs_on for r in shape.dropper_schedule()]
    assert rows[:7] == ["messenger wire"] * 6 + ["stitch wire"]
    # static equilibrium of the middle stitch wire's lowest stretch: T z'' = weight, droppers at ±5 m
    wire = shape.stitch_wires[1]
    pull = shape.dropper_forces[13] + shape.catenary.droppers[13].messenger_clamp_mass * 9.81
    kink = np.interp(125.0 - 1.5, wire.x, wire.dz_dx) - np.interp(125.0 + 1.5, wire.x, wire.dz_dx)
    assert stitched.stitch_wire.tension * -kink == pytest.approx(pull + 0.31 * 9.81 * 3.0, rel=0.02)


def test_stitch_wires_even_the_elasticity_out(stitched, stitched_shape):
    plain = cf.find_form(stitched.replace(stitch_wire=None))
    spans = (2, 3)
    with_stitch = cf.elasticity(stitched_shape, spans=spans, points_per_span=12).non_uniformity
    without = cf.elasticity(plain, spans=spans, points_per_span=12).non_uniformity
    assert with_stitch < 0.20 < 0.35 < without


def test_the_messenger_wire_gives_its_tension_to_the_stitch_wire(stitched_shape):
    """Between its clamps the messenger wire is slacker: under the same droppers its slope falls faster."""
    wire = stitched_shape.messenger_wire
    inside = np.interp([122.0, 128.0], wire.x, wire.dz_dx)
    free = (inside[1] - inside[0]) / 6.0  # at the support at 130 m the slope jumps; here no dropper hangs
    assert free == pytest.approx(1.06 * 9.81 / (21e3 - 3.5e3), rel=0.03)


def test_stitch_wires_that_meet_are_refused(stitched):
    with pytest.raises(cf.InputError, match=r"span 2: stitch wires of 66 m meet in a span of 65 m"):
        stitched.replace(stitch_wire=stitched.stitch_wire.replace(length=66.0))
    with pytest.raises(cf.InputError, match="leaves the messenger wire none"):
        stitched.replace(stitch_wire=stitched.stitch_wire.replace(tension=22e3))


def test_twins_share_the_droppers(twin, twin_shape):
    rows = twin_shape.dropper_schedule()
    assert [r.contact_wire for r in rows[:4]] == [1, 2, 1, 2]
    assert "hangs_on" not in rows[0].as_dict()
    right, left = twin_shape.contact_wires
    apart = left.lateral(np.array([54.0, 81.0])) - right.lateral(np.array([54.0, 81.0]))
    # each dropper leans by 20 mm and draws its wire in: 1 N every 7 m bends it by 6 mm
    assert apart == pytest.approx([0.04, 0.028], abs=2e-3)
    assert np.abs(twin_shape.height_errors).max() < 1e-4
    # both wires' pull, and the leaning droppers'
    assert twin.lateral_pulls[1] == pytest.approx(325.9, rel=1e-3)
    assert -twin_shape.steady_arm_lateral_forces[1] > twin.lateral_pulls[1]


def test_a_head_touches_both(twin_shape):
    pantograph = cf.library.pantograph("DSA250").replace(mean_force=None, uplift_force=110.0)
    run = cf.simulate(twin_shape, [pantograph], speed=120 / 3.6)
    assert run.contact_force_statistics()[0].mean == pytest.approx(110, rel=0.1)
    one = cf.ElasticPantograph(force=100.0, stiffness=500.0)
    with pytest.raises(cf.InputError, match="one force for one contact wire"):
        cf.simulate(twin_shape, [one], speed=120 / 3.6)


def test_numbers_of_twins_need_a_twin(short):
    spans = (short.spans[0].replace(droppers=(cf.Dropper(position=5.0, contact_wire=2),)), *short.spans[1:])
    with pytest.raises(cf.InputError, match=r"dropper 1: contact_wire = 2, but there is one contact wire"):
        short.replace(spans=spans)
