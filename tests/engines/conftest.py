"""What tests of compiled runs share: two short lines."""

import pytest

import catenary_fe as cf


def two_spans(path):
    line = cf.load_catenary(path)
    return line.replace(spans=line.spans[:2], supports=line.supports[:3], evaluated_spans=(2,))


@pytest.fixture(scope="session")
def plane_shape(reference_layout):
    return cf.find_form(two_spans(reference_layout))


@pytest.fixture(scope="session")
def twin_shape(reference_layout):
    """Two contact wires, links of 1.25 m."""
    line = two_spans(reference_layout.parent / "dc_3kv_twin.toml")
    longer = [s.replace(steady_arm=s.steady_arm.replace(length=1.25)) for s in line.supports]
    return cf.find_form(line.replace(supports=tuple(longer)))


@pytest.fixture(scope="session")
def rolling_head():
    """Two strips that roll."""
    return cf.Panhead(width=1.6, strips=2, strip_distance=0.4, spring_distance=0.9, roll_inertia=1.0)
