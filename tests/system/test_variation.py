"""Units of the values that a sweep varies, by their places."""

import pytest

from catenary_fe.system.variation import unit_of


@pytest.mark.parametrize(
    ("place", "unit"),
    [
        ("contact_wire.tension", "N"), ("span.*.pre_sag", "m"), ("span.1.droppers.2.position", "m"),
        ("pantograph.stages.1.stiffness", "N/m"), ("pantograph.head.width", "m"), ("system_height", "m"),
        ("span.1.count", ""), ("mean_N", ""),
    ],
)  # fmt: skip
def test_units_of_places(place, unit):
    assert unit_of(place) == unit
