"""What a report says of its inputs."""

import pytest

import catenary_fe as cf
from catenary_fe.views.report.tables import (
    Table,
    _line_table,
    input_tables,
    line_spans_table,
    schedule_table,
    slack_table,
    span_table,
    support_table,
)


def rows(table):
    return {row[0]: row[1:] for row in table.rows}


@pytest.mark.parametrize(
    ("layout", "expected"),
    [
        ("en50318_2002", {"modelled": "in the vertical plane", "steady arms": "springs of 300 N/m, 0.3 kg"}),
        ("en50318_2018_ac_simple", {"modelled": "in space", "stagger": "-0.2 to 0.2 m"}),
        ("en50318_2018_ac_stitched", {"stitch wires": "18 m long"}),
        ("dc_3kv_twin", {"contact wires": "two, 0.04 m apart"}),
    ],
)
def test_lines_of_all_kinds(reference_layout, layout, expected):
    catenary = cf.load_catenary(reference_layout.with_name(f"{layout}.toml"))
    said = rows(_line_table(catenary))
    assert {name: said[name][0] for name in expected} == expected
    assert ("stagger" in said) == catenary.staggers.any()


def test_all_inputs_and_sources(short_run):
    text = "\n".join(str(cell) for t in input_tables(short_run) for row in t.rows for cell in row)
    for source in (
        short_run.catenary.source,
        short_run.catenary.contact_wire.source,
        short_run.catenary.messenger_wire.source,
        short_run.pantographs[0].source,
        short_run.data.attrs["input_sha256"],
    ):
        assert source in text


def test_the_force_span_by_span(short_run):
    table = span_table(short_run, "causal")
    assert table.columns == ("span", "mean (N)", "σ (N)", "max (N)", "min (N)")
    assert [row[0] for row in table.rows] == ["2", "3"]
    assert table.spans == [(2, 2), (3, 3)]
    statistics = short_run.contact_force_statistics([3])[0]
    assert table.rows[1][1:3] == (f"{statistics.mean:.1f}", f"{statistics.std:.1f}")


def test_slack_droppers(short_run):
    forces = short_run.data["dropper_force"].values
    table = slack_table(short_run)
    assert len(table.rows) == (forces.min(axis=1) <= 0).sum()
    assert table.caption.startswith(f"{len(table.rows)} of 36")
    total = sum(float(row[2]) for row in table.rows)
    assert total == pytest.approx((forces <= 0).sum(), abs=len(table.rows))  # [ms], steps of 1 ms


def test_schedule(short_shape):
    table = schedule_table(short_shape)
    assert len(table.rows) == len(table.spans) == 36
    third = [row for row, spans in zip(table.rows, table.spans, strict=True) if spans == (3, 3)]
    lengths = [row.length_m for row in short_shape.dropper_schedule() if row.span == 3]
    assert [float(row[4]) for row in third] == pytest.approx(lengths, abs=5e-5)
    assert [row[1] for row in third] == list("123456789")
    assert third[0][2:4] == ["125.000", "5.000"]
    assert len(table.columns) == 8  # all hang on the one messenger wire and hold the one contact wire


def test_schedule_of_a_stitched_twin(reference_layout):
    twin = cf.load_catenary(reference_layout.with_name("en50318_2018_ac_stitched.toml"))
    five = twin.replace(spans=twin.spans[:5], supports=twin.supports[:6], evaluated_spans=(3,))
    table = schedule_table(cf.find_form(five))
    assert table.columns[-1] == "hangs on"
    hung = [row[-1] for row, spans in zip(table.rows, table.spans, strict=True) if spans == (3, 3)]
    assert hung[0] == hung[-1] == "stitch wire"
    assert set(hung[1:-1]) == {"messenger wire"}


def test_supports(short_shape, twin_wires_shape):
    table = support_table(short_shape)
    assert [row[0] for row in table.rows] == ["1", "2", "3", "4", "5"]
    assert table.rows[0][5] == "–"  # the wires' anchor has no arm
    assert float(table.rows[1][5]) == pytest.approx(short_shape.steady_arm_forces[1], abs=0.05)
    assert table.spans == [(1, 1), (1, 2), (2, 3), (3, 4), (4, 4)]
    both = support_table(twin_wires_shape).rows[1]
    assert both[2] == "-0.220, -0.180"
    pulls = [float(text) for text in both[6].split(", ")]
    assert sum(pulls) == pytest.approx(twin_wires_shape.steady_arm_lateral_forces[1], abs=0.1)


def test_each_span_of_a_line_with_curves_and_ramps(reference_layout):
    """Down by 0.1 m in the 65 m of span 6, into a curve of 1500 m to the left at support 9."""
    table = line_spans_table(cf.load_catenary(reference_layout.with_name("re250_1200m.toml")))
    assert len(table.rows) == 20
    assert table.rows[5][1:5] == ("315 to 380", "65", "5.250 to 5.150", f"{-100 / 65:.2f}")
    assert table.rows[5][5:] == ("0.25 to -0.25", "straight", "7")
    assert table.rows[8][6] == "1500 left"
    assert table.rows[0][4] == "0.00"


def test_numbers_stand_right():
    assert Table("", ("a", "b"), [("x", "1.5"), ("y", "-2")]).numeric == [False, True]
