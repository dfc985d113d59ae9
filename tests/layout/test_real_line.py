"""The line of 1,200 m of two tables: it is what they say, is found, and its gradient is judged by speed."""

from pathlib import Path

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.layout.current_collection import gradient_limit

LAYOUTS = Path(__file__).parents[2] / "models" / "layouts"


@pytest.fixture(scope="module")
def line():
    return cf.load_catenary(LAYOUTS / "re250_1200m.toml")


def test_it_is_what_its_tables_say(line):
    tables = LAYOUTS / "re250_1200m_masts.csv", LAYOUTS / "re250_1200m_droppers.csv"
    made = cf.catenary_from_tables(*tables, base="Re 250", name=line.name)
    assert made.replace(evaluated_spans=line.evaluated_spans, source=line.source) == line
    assert cf.layout_warnings(line) == []


def test_it_is_a_line_as_it_stands(line):
    lengths = [span.length for span in line.spans]
    assert line.length == 1200 and min(lengths) == 50 and max(lengths) == 65
    assert set(line.stitch_wire_lengths) == {0, 14, 18}
    curved = [span.length for span in line.spans if span.curve_radius == 1500]
    assert sum(curved) == 320
    assert np.abs(line.staggers) == pytest.approx(0.25)
    assert np.ptp(line.contact_wire_heights) == pytest.approx(0.3)
    assert np.count_nonzero(line.gradients) == 4


def test_its_gradient_is_allowed_up_to_200_kmh(line):
    largest, changes = np.abs(line.gradients).max(), np.abs(np.diff(line.gradients)).max()
    for kmh, allowed in ((200, True), (230, False), (250, False)):
        limit = gradient_limit(kmh / 3.6).value
        assert (largest <= limit and changes <= limit / 2) == allowed


def test_it_hangs_with_whole_millimetres_and_its_arms_are_pulled(line):
    shape = cf.find_form(line)
    assert np.abs(shape.height_errors).max() < 0.5e-3
    assert shape.dropper_forces.min() > 50
    assert np.abs(shape.steady_arm_lateral_forces[1:-1]).min() > 80  # so that an arm stays taut
