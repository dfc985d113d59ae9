"""Tables of masts and droppers: read as they stand, round trip, and each fault with its row and column."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.layout.from_tables import read_line
from catenary_fe.layout.tables import Column, read_table

MASTS = """support,chainage_m,Stagger [mm],contact_wire_height (m),curve_radius_after_m,uplift_room_mm
1,1200.0,200,5.30,,
2,1265.0,-200,5.30,,120
3,1325.0,250,5.28,1500,120
4,1375.0,150,5.26,,
5,1435.0,-200,5.26,,
"""
DROPPERS = "span,dropper,position_m,length_mm,height_offset_mm\n" + "".join(
    f"{span},{n},{5.0 + 10 * n:g},{1400 - 20 * n},{-n}\n" for span in (1, 2, 3, 4) for n in (1, 2, 3)
)


@pytest.fixture
def files(tmp_path):
    """Writes tables with something replaced; returns their paths."""

    def write(masts=(), droppers=(), encoding="utf-8"):
        found = []
        for name, text, changes in (("masts.csv", MASTS, masts), ("droppers.csv", DROPPERS, droppers)):
            for old, new in changes:
                assert old in text
                text = text.replace(old, new)
            (tmp_path / name).write_text(text, encoding=encoding)
            found.append(tmp_path / name)
        return found

    return write


def test_a_line_of_two_tables(files):
    line = cf.catenary_from_tables(*files(), base="Re 250")
    assert line.name == "masts" and line.source.endswith("masts and droppers of tables")
    assert line.support_positions.tolist() == [0, 65, 125, 175, 235]
    assert line.staggers.tolist() == [0.2, -0.2, 0.25, 0.15, -0.2]
    assert line.contact_wire_heights.tolist() == [5.3, 5.3, 5.28, 5.26, 5.26]
    assert [span.curve_radius for span in line.spans] == [None, None, 1500, None]
    assert [s.steady_arm.uplift_room for s in line.supports[1:-1]] == [0.12, 0.12, None]
    assert line.stitch_wire_lengths.tolist() == [0, 18, 14, 14, 0]  # the rule's, by the shorter span
    assert [d.length for d in line.droppers[:3]] == [1.38, 1.36, 1.34]
    assert [d.height_offset for d in line.droppers[:3]] == [-0.001, -0.002, -0.003]
    assert {d.contact_wire_clamp_mass for d in line.droppers} == {0.14}
    assert line.contact_wire == cf.library.line("Re 250").contact_wire
    assert cf.layout_warnings(line) == []


def test_without_a_table_the_rule_places_the_droppers(files):
    masts, _ = files()
    by_rule = cf.catenary_from_tables(masts, base="Re 250")
    assert by_rule.dropper_positions == pytest.approx(
        cf.build_line("Re 250", [65, 60, 50, 60]).dropper_positions
    )
    of_base = cf.catenary_from_tables(masts, base=cf.build_line("Re 250", [50, 60, 65]))
    assert np.array_equal(of_base.dropper_positions, by_rule.dropper_positions)
    with pytest.raises(cf.InputError, match=r"span of 65 m: .* nor a span of this length; give a table"):
        cf.catenary_from_tables(masts, base=cf.build_line("Re 250", [50, 60, 60]))
    with pytest.raises(cf.InputError, match=r"span of 65 m: .* has no rule for its droppers; give a table"):
        cf.catenary_from_tables(masts, base="CA-220 25 kV")


@pytest.mark.parametrize("separator", [";", "\t"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_separators_and_a_byte_order_mark(files, separator, encoding):
    plain = cf.catenary_from_tables(*files(), base="Re 250")
    changes = [(",", separator)]
    assert cf.catenary_from_tables(*files(changes, changes, encoding), base="Re 250") == plain


def faults(base, *paths):
    with pytest.raises(cf.InputError) as caught:
        cf.catenary_from_tables(*paths, base=base)
    folder = f"{paths[0].parent}/"
    assert all(line.startswith(folder) for line in caught.value.problems)
    return [line.removeprefix(folder) for line in caught.value.problems]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("1265.0", '"1265,0"', "row 3, column chainage_m: 1265,0 is a number with a comma: write a point be"),
        ("1265.0", "1265,0", "row 3: 7 cells for 6 columns; look for a decimal comma or a separator too man"),
        ("1265.0", "1 265.0", "row 3, column chainage_m: 1 265.0 is a number with gaps"),
        ("1265.0", "", "row 3, column chainage_m: is empty; give a number"),
        ("1265.0", "1190.0", "row 3, column chainage_m: 1190 m does not come after the mast before it, at 1"),
        ("-200,5.30", "−200,5.30", "row 3, column Stagger [mm]: −200 begins with a dash (U+2212)"),
        ("-200,5.30", "left,5.30", "row 3, column Stagger [mm]: 'left' is not a number"),
        ("-200,5.30", "-20000,5.30", "row 3: stagger = -20.0: must be at least -10"),
        ("\n2,", "\n7,", "row 3, column support: 7: must be 2, one row a mast in order"),
        ("[mm]", "[kg]", "row 1, column 3 ('Stagger [kg]'): unit 'kg' does not fit a length: must be one of"),
        ("Stagger [mm]", "Stagger", "row 1, column 3 ('Stagger'): the unit is missing: m, cm, mm, km; write"),
        ("Stagger [mm]", "sweep_mm", "row 1, column 3 ('sweep_mm'): no column that is known; known are sect"),
        ("chainage_m", "chanage_m", "row 1, column 2 ('chanage_m'): no column that is known; did you mean c"),
        ("uplift_room_mm", "stagger_m", "row 1, column 6 ('stagger_m'): stagger is there twice"),
        ("support", "support_m", "row 1, column 1 ('support_m'): support has no unit; write support"),
        ("-200,5.26,,", "-200,5.26,900,", "row 6, column curve_radius_after_m: no span begins at the last m"),
        ("250,5.28,1500", "250,5.28,15", "row 4: curve_radius = 15 m: no track with a catenary"),
    ],
)  # fmt: skip
def test_faults_of_masts(files, old, new, said):
    masts, droppers = files([(old, new)])
    found = [line.removeprefix("masts.csv: ") for line in faults("Re 250", masts, droppers)]
    assert any(said in line or line.startswith(said) for line in found), found


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("1,1,15,1380", "1,2,15,1380", "row 2, column dropper: 2: must be 1, as the rows of span 1 stand"),
        ("1,2,25,1360", "1,2,12,1360", "span 1: dropper 2 at 12 m does not come after the one before it at"),
        ("1,2,25,1360", "1,2,,1360", "row 3, column position_m: is empty; give a number"),
        ("4,3,35", "9,3,35", "row 13, column span: 9: the line has spans 1 to 4"),
        ("4,3,35", ",3,35", "row 13, column span: is empty: the line has spans 1 to 4"),
        ("4,3,35", "2,3,35", "row 13, column span: 2 does not come after span 4"),
        ("4,1,15,1380,-1\n4,2,25,1360,-2\n4,3,35,1340,-3\n", "", "span 4 has no droppers; give its rows"),
        ("1,1,15,1380", "1,1,15,1380000", "row 2: span 1: dropper 1 with a length of 1380 m is longer than"),
        ("1,1,15,1380", "1,1,15,0", "row 2, column length_mm: 0: a dropper has a length"),
        ("1,1,15,1380", "1,1,-15,1380", "row 2, column position_m: -15: must be at least 0"),
        ("position_m", "x_m", "row 1, column 3 ('x_m'): no column that is known"),
        ("length_mm", "length_N", "row 1, column 4 ('length_N'): unit 'N' does not fit a length"),
        ("span,dropper", "dropper,span_1", "row 1: span_1: this table has no columns of one contact wire"),
    ],
)  # fmt: skip
def test_faults_of_droppers(files, old, new, said):
    masts, droppers = files((), [(old, new)])
    found = [line.removeprefix("droppers.csv: ") for line in faults("Re 250", masts, droppers)]
    assert any(line.startswith(said) for line in found), found


def test_what_two_columns_say_must_agree(files, tmp_path):
    masts, droppers = files([("uplift_room_mm", "span_before_m"), ("-200,5.30,,120", "-200,5.30,,60")])
    assert faults("Re 250", masts, droppers)[0] == (
        "masts.csv: row 3, column span_before_m: 60 m: it is 65 m by the chainages"
    )
    masts, droppers = files((), [("height_offset_mm", "chainage_m"), (",-1\n", ",1000\n")])
    found = faults("Re 250", masts, droppers)
    assert found[0].startswith(
        "droppers.csv: row 2, column chainage_m: 1000 m: the position of 15 m in span 1"
    )
    masts, droppers = files(
        (), [("height_offset_mm", "cut_length_mm"), (",-1\n", ",1379\n"), (",-2\n", ",\n"), (",-3\n", ",\n")]
    )
    assert "column cut_length_mm: 1379 mm: the length is 1380 mm" in faults("Re 250", masts, droppers)[0]


def test_faults_come_together(files):
    masts, droppers = files([("1265.0", '"1265,0"'), ("-200,5.26,,", "x,5.26,,")])
    assert len(faults("Re 250", masts, droppers)) == 2


def test_files_that_are_no_tables(files, tmp_path):
    masts, droppers = files()
    masts.write_text("", "utf-8")
    assert faults("Re 250", masts, droppers) == ["masts.csv: is empty; its first row must name the columns"]
    masts.write_text("chainage_m,stagger_m\n", "utf-8")
    assert faults("Re 250", masts, droppers) == ["masts.csv: there is no row below the header"]
    masts.write_text("chainage_m,stagger_m\n0,0\n", "utf-8")
    assert faults("Re 250", masts, droppers) == ["masts.csv: 1 mast: a line has at least two"]
    masts.write_text("chainage_m\n0\n", "utf-8")
    assert faults("Re 250", masts, droppers) == ["masts.csv: row 1: column stagger_m is missing; add it"]
    masts.write_bytes("chainage_m,stagger_m\n0,0\n".encode("utf-16"))
    assert "a text in UTF-16" in faults("Re 250", masts, droppers)[0]
    masts.write_text('chainage_m,stagger_m\n"0"x,0\n', "utf-8")
    assert "row 2: not a CSV table" in faults("Re 250", masts, droppers)[0]
    masts.unlink()
    assert "no such table file" in faults("Re 250", masts, droppers)[0]


def test_a_base_of_several_kinds_is_refused(files):
    line = cf.build_line("Re 250", [60, 60, 60])
    supports = list(line.supports)
    supports[2] = supports[2].replace(messenger_stiffness=1e6)
    with pytest.raises(cf.InputError, match="as a base of tables: its supports are of several kinds"):
        cf.catenary_from_tables(*files(), base=line.replace(supports=supports))
    with pytest.raises(cf.InputError, match="must be a Catenary or the name of a line"):
        cf.catenary_from_tables(*files(), base=3)


def test_results_in_a_table_are_named(files):
    changes = [("height_offset_mm", "force_N")]
    found = read_line(*files((), changes), base="Re 250").not_read
    assert list(found.values()) == [("force_N",)]


def test_units_are_taken_from_the_heading(tmp_path):
    path = tmp_path / "t.csv"
    path.write_text("Length [cm],force_kN,stiffness_N_per_mm\n12.5,0.3,1.5\n", "utf-8")
    columns = {"length": Column("length"), "force": Column("force"), "stiffness": Column("stiffness")}
    assert read_table(path, columns, ()).rows == [{"length": 0.125, "force": 300.0, "stiffness": 1500.0}]


def test_several_sections_share_the_masts_of_their_overlap(tmp_path):
    head = "section,chainage_m,stagger_m,contact_wire_height_m\n"
    first = [f"1,{60 * i},{0.2 * (-1) ** i:g},{5.3 if i < 5 else 5.8}\n" for i in range(6)]
    second = [f"2,{60 * i},{-0.2 * (-1) ** i:g},{5.3 if i > 2 else 5.8}\n" for i in range(2, 9)]
    masts = tmp_path / "masts.csv"
    masts.write_text(head + "".join(first + second), "utf-8")
    line = cf.catenary_from_tables(masts, base="Re 250")
    assert [len(section.spans) for section in line.sections] == [5, 6]
    assert line.overlaps == (cf.layout.Overlap(spans=3, as_written=True),)
    assert line.length == 480 and line.sections[1].contact_wire_heights[0] == 5.8
    masts.write_text(head + "".join(first + second[3:]), "utf-8")
    with pytest.raises(cf.InputError, match="row 8, column chainage_m: 300 m: the sections share no span"):
        cf.catenary_from_tables(masts, base="Re 250")
    masts.write_text(head + "".join(second + first), "utf-8")
    with pytest.raises(cf.InputError, match="row 2, column section: section 2 after section 0: number them"):
        cf.catenary_from_tables(masts, base="Re 250")
    masts.write_text(head + "".join(first + second), "utf-8")
    droppers = tmp_path / "droppers.csv"
    droppers.write_text("section,span,position_m\n1,1,20\n", "utf-8")
    with pytest.raises(cf.InputError, match="droppers of sections 1, masts of 1, 2: give both"):
        cf.catenary_from_tables(masts, droppers, base="Re 250")


def test_transition_curves_cant_and_a_messenger_wire_that_follows(tmp_path):
    masts = tmp_path / "masts.csv"
    masts.write_text(
        "chainage_m,stagger_mm,curve_radius_before_m,curve_radius_after_m,cant_mm\n"
        "0,-200,,,0\n60,-200,1500,1500,100\n120,-200,1500,1500,100\n180,-200,0,,0\n",
        "utf-8",
    )
    base = cf.build_line("Re 250", [60.0] * 3)
    base = base.replace(supports=[s.replace(messenger_stagger="follows") for s in base.supports])
    line = cf.catenary_from_tables(masts, base=base)
    radii = [(span.curve_radius, span.curve_radius_end) for span in line.spans]
    assert radii == [(None, 1500), (1500, None), (1500, 0)]
    assert [s.cant for s in line.supports] == [0, 0.1, 0.1, 0]
    assert {s.messenger_stagger for s in line.supports} == {"follows"}
    assert cf.load_catenary(cf.save_catenary(line, tmp_path / "line.toml")) == line
