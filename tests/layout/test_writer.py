"""A catenary that is written is the one that is read again."""

from pathlib import Path

import pytest

import catenary_fe as cf
from catenary_fe.layout import layout_text
from catenary_fe.layout.writer import layout_record

ROOT = Path(__file__).parents[2]
FILES = sorted(
    [*(ROOT / "models/layouts").glob("*.toml"), *(ROOT / "docs/reference/examples").glob("layout*.toml")]
)


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_layout_survives(path, tmp_path):
    line = cf.load_catenary(path)
    for each in (line, line.mirrored()):
        written = cf.save_catenary(each, tmp_path / "line.toml")
        again = cf.load_catenary(written)
        if isinstance(each, cf.Line):  # overlaps are written span by span
            again, each = again.sections, each.sections
        assert again == each


def test_what_is_equal_is_written_once():
    """A line that was written by hand is as short when it is written again."""
    line = cf.load_catenary(ROOT / "models/layouts/re250.toml")
    record = layout_record(line)
    assert record["span"] == [
        {"count": 20, "length": 65.0, "droppers": [5.0, 14.17, 23.33, 32.5, 41.67, 50.83, 60.0]}
    ]
    assert record["stagger"] == 0.2 and "supports" not in record
    assert record["contact_wire"] == {"library": "AC-120", "tension": 15e3}
    assert record["dropper"]["contact_wire_clamp_mass"] == 0.14


def mixed():
    line = cf.load_catenary(ROOT / "models/layouts/re250.toml")
    supports, spans = list(line.supports), list(line.spans)
    supports[3] = supports[3].replace(stagger=0.0, contact_wire_height=5.25, stitch_wire=False)
    supports[4] = supports[4].replace(steady_arm=cf.SteadyArm(stiffness=300.0, uplift_room=0.1))
    droppers = list(spans[2].droppers)
    droppers[3] = droppers[3].replace(height_offset=-0.01, stiffness=2e5)
    spans[2] = spans[2].replace(droppers=droppers, curve_radius=-1500.0)
    return line.replace(name='a "name"\\ \x7f – Łódź', spans=spans, supports=supports)


def test_what_differs_is_written_beside(tmp_path):
    line = mixed()
    record = layout_record(line)
    assert record["supports"] == [
        {"at": 4, "contact_wire_height": 5.25, "stagger": 0.0, "stitch_wire": False},
        {"at": 5, "steady_arm": {"stiffness": 300.0, "uplift_room": 0.1}},
    ]
    assert [entry.get("count", 1) for entry in record["span"]] == [2, 1, 17]
    assert cf.load_catenary(cf.save_catenary(line, tmp_path / "line.toml", comment="one\ntwo")) == line
    assert (tmp_path / "line.toml").read_text(encoding="utf-8").startswith("# one\n# two\n\nname = ")


def test_supports_without_an_arm():
    """A file cannot take an arm back that all supports have: each then has its own."""
    line = mixed()
    supports = list(line.supports)
    supports[6] = supports[6].replace(steady_arm=None, stagger=0.0)
    record = layout_record(line.replace(supports=supports))
    assert "steady_arm" not in record["support"]
    assert len(record["supports"]) == 21
    layout_text(line.replace(supports=supports))


@pytest.mark.parametrize("stagger", [0.2, 0.0])
def test_a_line_of_several_sections(stagger, tmp_path):
    """Overlaps come back span by span."""
    line = cf.build_line("Re 250", [60.0] * 8, staggers=stagger, steady_arm=cf.SteadyArm(stiffness=200.0))
    other = line.replace(spans=line.spans + line.spans[:2], supports=line.supports + line.supports[:2])
    other = other.replace(messenger_wire=line.messenger_wire.replace(tension=14e3))
    joined = cf.layout.join_sections([line, other], [cf.layout.Overlap(lift=0.3)], evaluated_spans=(4, 5))
    again = cf.load_catenary(cf.save_catenary(joined, tmp_path / "line.toml"))
    assert again.sections == joined.sections and again.evaluated_spans == (4, 5)
    assert again.overlaps == (cf.layout.Overlap(as_written=True),)
    assert cf.load_catenary(cf.save_catenary(again, tmp_path / "again.toml")) == again
    assert (tmp_path / "line.toml").read_bytes() == (tmp_path / "again.toml").read_bytes()


def test_files_that_cannot_be_written(tmp_path):
    with pytest.raises(cf.InputError, match="cannot be written"):
        cf.save_catenary(mixed(), tmp_path / "absent" / "line.toml")
