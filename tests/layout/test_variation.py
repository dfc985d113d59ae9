"""Single values changed by their place, their units; a place that is not there is answered by one that is."""

import pytest

import catenary_fe as cf
from catenary_fe.layout.variation import replace_at, unit_of


@pytest.fixture
def record():
    return {
        "name": "line",
        "support": {"steady_arm": {"mass": 0.8}},
        "span": [{"droppers": [5.0, 15.0, {"position": 25.0}]}, {"droppers": [5.0, 15.0]}],
    }


def test_all_members_and_new_keys(record):
    replace_at(record, "span.*.droppers.2", 16.0)
    replace_at(record, "span.*.pre_sag", 0.01)
    replace_at(record, "support.steady_arm.mass", 1.0)
    assert record["span"][0] == {"droppers": [5.0, 16.0, {"position": 25.0}], "pre_sag": 0.01}
    assert record["span"][1] == {"droppers": [5.0, 16.0], "pre_sag": 0.01}
    assert record["support"] == {"steady_arm": {"mass": 1.0}}


@pytest.mark.parametrize(
    ("place", "said"),
    [
        ("span.*.droppers.2.position", r"\.2 is a single value, 15\.0; vary span\.\*\.droppers\.2 itself"),
        ("span.1.droppers.3", r"there is a table of position; .* such as span\.1\.droppers\.3\.position"),
        ("span.droppers.2", r"'droppers' is not a number from 1 to 2.* such as span\.\*\.droppers\.2"),
        ("span.2.droppers.3", r"'3' is not a number from 1 to 2.* such as span\.2\.droppers\.1"),
        ("suport.steady_arm.mass", r"no 'suport' to vary a value of; did you mean 'support'\?"),
    ],
)
def test_places_that_are_not_there(record, place, said):
    with pytest.raises(cf.InputError, match=said):
        replace_at(record, place, 1.0)


@pytest.mark.parametrize(
    ("place", "unit"),
    [
        ("contact_wire.tension", "N"), ("span.*.pre_sag", "m"), ("span.1.droppers.2.position", "m"),
        ("pantograph.stages.1.stiffness", "N/m"), ("pantograph.head.width", "m"), ("pantograph.force", "N"),
        ("system_height", "m"), ("span.1.count", ""), ("mean_N", ""),
    ],
)  # fmt: skip
def test_units_of_places(place, unit):
    assert unit_of(place) == unit
