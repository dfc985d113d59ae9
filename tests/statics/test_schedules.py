"""The tables for a crew: every dropper and support is named, and their forces are in equilibrium."""

import numpy as np
import pytest

G = 9.81


def test_each_dropper_has_its_number_and_place(curved_shape):
    line, rows = curved_shape.catenary, curved_shape.dropper_schedule()
    assert [row.dropper for row in rows] == [*range(1, 8)] * 6
    assert [row.chainage_m for row in rows] == pytest.approx(line.dropper_positions)
    for row in rows:
        assert (row.from_support, row.to_support) == (row.span, row.span + 1)
        start = line.support_positions[row.from_support - 1]
        assert row.chainage_m == pytest.approx(start + row.position_m)
        assert row.cut_length_mm == round(1e3 * row.length_m)
        assert row.contact_wire_height_m == pytest.approx(
            line.contact_wire_height + row.contact_wire_height_error_mm / 1e3
        )
    assert [row.hangs_on for row in rows[6:9]] == ["stitch wire", "stitch wire", "messenger wire"]


def test_a_record_has_all_columns_on_every_line(reference_shape, twin_wires_shape):
    plain, twin = (s.dropper_schedule()[1].as_record() for s in (reference_shape, twin_wires_shape))
    assert list(plain) == list(twin)
    assert (plain["hangs_on"], plain["contact_wire"]) == ("messenger wire", 1)
    assert twin["contact_wire"] == 2


def test_supports_in_a_curve(curved_shape):
    """Arms hold what stagger and curve pull, the messenger wire's support what hangs on it."""
    line, rows = curved_shape.catenary, curved_shape.support_schedule()
    assert [row.support for row in rows] == [1, 2, 3, 4, 5, 6, 7]
    assert [row.curve_radius_after_m for row in rows] == [None, None, 1500, 1500, 1500, None, None]
    assert rows[0].span_before_m is rows[-1].span_after_m is None
    assert rows[0].arms[0].kind == rows[-1].arms[0].kind == "none"
    for i, row in list(enumerate(rows))[1:-1]:
        (arm,) = row.arms
        assert (arm.kind, arm.length_m, row.stitch_wire_tension_kN) == ("link", 1.15, 3.5)
        assert arm.stagger_m == pytest.approx(line.staggers[i], abs=1e-4)
        assert arm.lateral_N == pytest.approx(-line.lateral_pulls[i], rel=0.1)  # droppers lean
        assert arm.side == ("left" if line.lateral_pulls[i] < 0 else "right")
        assert arm.radial_N == pytest.approx(np.hypot(arm.lateral_N, arm.vertical_N))
        assert np.tan(np.radians(arm.inclination_deg)) == pytest.approx(arm.vertical_N / abs(arm.lateral_N))
        wire, x = curved_shape.messenger_wire, row.chainage_m
        kink = np.interp(x - 3.0, wire.x, wire.dz_dx) - np.interp(x + 3.0, wire.x, wire.dz_dx)
        carried = 1e3 * row.messenger_wire_tension_kN * kink + 6.0 * G * line.messenger_wire.mass_per_length
        assert row.messenger_vertical_N == pytest.approx(carried, rel=0.02)


def test_supports_of_two_contact_wires(twin_wires_shape):
    row = twin_wires_shape.support_schedule()[1]
    flat = row.as_dict()
    assert [flat["stagger_1_m"], flat["stagger_2_m"]] == pytest.approx([-0.22, -0.18], abs=1e-4)
    assert flat["arm_1_lateral_N"] + flat["arm_2_lateral_N"] == pytest.approx(
        twin_wires_shape.steady_arm_lateral_forces[1]
    )
    assert "arm_lateral_N" not in flat


def test_a_spring_has_no_side(reference_shape):
    (arm,) = reference_shape.support_schedule()[1].arms
    assert (arm.kind, arm.stiffness_N_per_m, arm.side, arm.inclination_deg) == ("spring", 300.0, None, None)
    assert arm.vertical_N == pytest.approx(reference_shape.steady_arm_forces[1])
