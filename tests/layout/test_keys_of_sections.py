"""Every key of further sections and overlaps acts, or is refused."""

import tomllib
from typing import Any

import pytest

import catenary_fe as cf
from catenary_fe.layout import layout_schema
from tests.layout.test_every_key_acts import SPACE, line_of

SECTION: dict[str, Any] = {
    "contact_wire": {"library": "AC-120 CuMg", "tension": 14e3},
    "messenger_wire": {"library": "BzII 70", "tension": 13e3},
    "stitch_wire": {"library": "BzII 35", "tension": 2.5e3, "length": 12.0},
    "stagger": 0.1,
    "curve_radius": 800.0,
    "supports": [{"at": 6, "stagger": 0.1}],
    "span": [{"length": 30.0, "droppers": [6.0, 24.0], "count": 6}],
    "begin": {"kind": "weights"},
    "end": {"kind": "fixed"},
    "midpoint": 3,
    "midpoint_position": 75.0,
    "equipment": [{"x": 22.0, "mass": 9.0}],
    "as_built": {"dropper_length": 0.003},
    "wear": [{"span": 2, "area_left": 0.9}],
    "overlap": {"spans": 4, "lift": 0.06},
    "count": 2,
}
OVERLAP: dict[str, Any] = {
    "spans": 4, "kind": "insulated", "lift": 0.1, "distance": 0.3, "anchor_stagger": 0.8, "as_written": True,
}  # fmt: skip
SEVERAL = SPACE.replace("count = 2", "count = 6").replace("curve_radius = 900.0", "") + (
    "[overlap]\nlift = 0.06\n[[further_sections]]\n"
)


def test_a_value_is_known_for_every_key_of_sections():
    properties = layout_schema()["$defs"]
    assert sorted(properties["SectionEntry"]["properties"]) == sorted(SECTION)
    assert sorted(properties["Overlap"]["properties"]) == sorted(OVERLAP)


@pytest.mark.parametrize("key", SECTION)
def test_a_key_of_a_further_section_acts_there_or_is_refused(key):
    record = tomllib.loads(SEVERAL)
    before = line_of(record)
    assert isinstance(before, cf.Line)
    record["further_sections"][0][key] = SECTION[key]
    if key in ("begin", "midpoint", "midpoint_position", "curve_radius"):  # each by itself does not fit
        with pytest.raises(cf.InputError, match=r"weights at both ends|midpoint has no|curve_radius differs"):
            line_of(record)
        return
    line = line_of(record)
    if key != "overlap":
        assert line.sections[0] == before.sections[0]
    assert line != before


@pytest.mark.parametrize("key", OVERLAP)
def test_a_key_of_an_overlap_acts_or_is_refused(key):
    record = tomllib.loads(SEVERAL)
    before = line_of(record)
    record["overlap"][key] = OVERLAP[key]
    if key == "as_written":
        with pytest.raises(cf.InputError, match="lift has no effect"):
            line_of(record)
        del record["overlap"]["lift"]
    assert line_of(record).sections != before.sections
