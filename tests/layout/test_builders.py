"""Lines by rules: droppers and stitch wires where the sources put them."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.layout import dropper_positions


@pytest.mark.parametrize(
    ("length", "first", "count"), [(65, 5, 7), (58.5, 5, 7), (58, 5, 6), (50, 4, 6), (44, 4, 5), (40, 4, 5)]
)
def test_german_spans(length, first, count):
    """3, 4 or 5 droppers above 36, 44 and 58 m between those on the stitch wires, at 5 or 4 m."""
    x = dropper_positions("Re", float(length))
    assert x.size == count and x[0] == first and x[-1] == length - first
    assert np.diff(x) == pytest.approx((length - 2 * first) / (count - 1))


def test_the_rule_is_that_of_the_published_span():
    """EN 50318:2018 AC stitched, digitised."""
    assert dropper_positions("Re", 65.0) == pytest.approx([5, 14.17, 23.33, 32.5, 41.67, 50.83, 60], abs=0.01)


@pytest.mark.parametrize("length", np.arange(13.5, 67.6, 4.5))
def test_french_spans(length):
    x = dropper_positions("France", float(length))
    gaps = np.diff(x)
    odd = gaps[np.abs(gaps - 6.75) > 1e-9]
    assert x[0] == 4.5 and x[-1] == length - 4.5
    assert odd.size <= 1 and np.isin(odd, [4.5, 9.0]).all()
    if odd.size:  # the remainder is in the middle
        middle = (x[np.argmax(gaps == odd[0])] + x[np.argmax(gaps == odd[0]) + 1]) / 2
        assert abs(middle - length / 2) <= 6.75 / 2


@pytest.mark.parametrize(
    ("rule", "length", "first", "count"),
    [("CA-220", 60, 5.25, 16), ("CA-220", 55, 5.2, 16), ("CA-220", 50, 5.25, 14),
     ("CA-160", 60, 4.75, 18), ("CA-160", 50, 4.8, 16)],
)  # fmt: skip
def test_spanish_pairs_fill_their_span(rule, length, first, count):
    """The tables' gaps are clear ones between pairs: only so is a span its own mirror image."""
    x = dropper_positions(rule, float(length))
    assert x.size == count and x[0] == first
    assert x + x[::-1] == pytest.approx(length)
    assert np.diff(x)[::2] == pytest.approx(0.5)


@pytest.mark.parametrize(
    ("rule", "length", "said"),
    [
        ("Re", 70.0, "span of 70 m: the rule of Re 330 and Re 250 is for spans above 36 up to 65 m"),
        ("Re", 36.0, "above 36"),
        ("France", 60.0, "leaves 3.75 or 10.5 m in the middle: must be 4.5 to 9 m"),
        ("CA-160", 55.0, "the table of CA-160 has spans of 50, 60 m"),
        ("EN", 60.0, "rule = 'EN': must be one of 'Re', 'France'"),
    ],
)
def test_spans_that_a_rule_does_not_know(rule, length, said):
    with pytest.raises(cf.InputError, match=said):
        dropper_positions(rule, length)


def test_a_line_of_spans_that_differ():
    line = cf.build_line("Re 250", [65, 60, 54, 50, 43, 65], curve_radii=[0, 0, 0, 0, 0, -3000])
    assert line.stitch_wire_lengths.tolist() == [0, 18, 14, 14, 0, 0, 0]
    assert [span.curve_radius for span in line.spans] == [None] * 5 + [-3000]
    assert line.staggers.tolist() == [0.2, -0.2, 0.2, -0.2, 0.2, -0.2, 0.2]
    assert cf.layout_warnings(line) == []
    shape = cf.find_form(line)
    on_them = [row.hangs_on for row in shape.dropper_schedule()]
    assert on_them.count("stitch wire") == 6
    ends = [wire.x[-1] - wire.x[0] for wire in shape.stitch_wires]
    assert ends == pytest.approx([18, 14, 14])
    assert np.abs(shape.height_errors).max() < 1e-4


@pytest.mark.parametrize("length", [40, 50, 60])
def test_nothing_that_is_built_is_without_effect(length):
    line = cf.build_line("Re 250", [length] * 4)
    assert line.stitch_wire_lengths.tolist() == [0, *[{40: 0, 50: 14, 60: 18}[length]] * 3, 0]
    assert cf.layout_warnings(line) == []


def test_twin_wires_hang_in_turns_and_sag_with_the_span():
    line = cf.build_line("CA-220 3 kV", [60, 50], staggers=[0.2, -0.1, 0.2])
    assert line.dropper_contact_wires.tolist() == [0, 1] * 15
    assert [span.pre_sag for span in line.spans] == pytest.approx([0.030, 0.025])
    shape = cf.find_form(line)
    assert len(shape.contact_wires) == 2 and shape.dropper_forces.min() > 0


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"line": "CA-220 25 kV", "span_lengths": [60]}, "no dropper rule is known; take one of 'Re 330'"),
        ({"line": "Re 250", "span_lengths": []}, "must be a list of at least one length"),
        ({"line": "Re 250", "span_lengths": [65, 65], "staggers": [0.2, 0.1]}, "2 values for 3 supports"),
        ({"line": "Re 250", "span_lengths": [65, 65], "curve_radii": [1500]}, "1 value for 2 spans"),
        ({"line": "Re 250", "span_lengths": [65], "sag": 1}, "unknown key sag"),
    ],
)
def test_lines_that_cannot_be_built(arguments, said):
    with pytest.raises(cf.InputError, match=said):
        cf.build_line(**arguments)
