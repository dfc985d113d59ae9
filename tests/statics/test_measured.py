"""Measured heights and staggers: read from a table, and met by the dropper lengths that are found."""

import json

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli.main import main

LAYOUT = """
name = "three spans"
system_height = 1.4
contact_wire = { library = "AC-120 CuMg", tension = 15e3 }
messenger_wire = { library = "BzII 70", tension = 15e3 }
damping = { beta = 1e-4 }
stagger = 0.2
[support]
messenger_stiffness = 5e5
steady_arm = { length = 1.0, mass_per_length = 0.7, clamp_mass = 0.2 }
[[span]]
length = 50.0
pre_sag = 0.02
droppers = [5.0, 15.0, 25.0, 35.0, 45.0]
count = 3
"""


@pytest.fixture(scope="module")
def layout(tmp_path_factory):
    path = tmp_path_factory.mktemp("line") / "line.toml"
    path.write_text(LAYOUT)
    return path


@pytest.fixture(scope="module")
def rows(layout) -> tuple[np.ndarray, ...]:
    """Places, heights and staggers of a crew that was 6 mm and 30 mm off."""
    line = cf.load_catenary(layout)
    draw = np.random.default_rng(3)
    x = np.sort(np.concatenate([line.support_positions, line.dropper_positions]))
    shape = cf.find_form(line)
    height = shape.contact_wire_height(x) + draw.uniform(-6e-3, 6e-3, x.size)
    stagger = shape.wires[0].lateral(x) + draw.uniform(-0.03, 0.03, x.size)
    return x, height.round(4), stagger.round(3)


@pytest.fixture(scope="module")
def table(rows, tmp_path_factory):
    path = tmp_path_factory.mktemp("measured") / "heights.csv"
    lines = [f"{x:g};{1e3 * z:.1f};{1e3 * y:.0f}" for x, z, y in zip(*rows, strict=True)]
    path.write_text("\ufeffx [m];height_mm;Stagger (mm)\n" + "\n".join(lines) + "\n")
    return path


def test_a_table_is_read_in_its_units(table, rows):
    measured = cf.read_measured(table)
    for name, values in zip(("x", "height", "stagger"), rows, strict=True):
        assert getattr(measured, name) == pytest.approx(values, abs=1e-9)


def test_the_line_has_the_measured_heights(table, rows, layout):
    """At supports and droppers to the micrometre; staggers at the supports; the messenger wire stays."""
    line, (x, height, stagger) = cf.load_catenary(layout), rows
    shape = cf.fit_measured(line, cf.read_measured(table))
    assert np.abs(shape.contact_wire_height(x) - height).max() < 2e-6
    at = np.isin(x, line.support_positions)
    assert shape.wires[0].lateral(x[at]) == pytest.approx(stagger[at], abs=1e-9)
    tops = shape.messenger_wire.height(line.support_positions)
    assert tops == pytest.approx(line.messenger_support_heights, abs=1e-9)
    design = cf.find_form(line)
    assert np.abs(design.contact_wire_height(x) - height).max() > 4e-3
    assert shape.height_errors == pytest.approx(height[~at] - line.design_heights, abs=2e-6)
    assert shape.catenary.design_heights == pytest.approx(line.design_heights, abs=1e-12)
    again = cf.find_form(shape.catenary)
    assert again.contact_wire_z.tolist() == shape.contact_wire_z.tolist()


def test_what_was_measured_on_the_design_is_the_design(layout):
    line = cf.load_catenary(layout)
    design = cf.find_form(line)
    x = np.sort(np.concatenate([line.support_positions, line.dropper_positions]))
    shape = cf.fit_measured(line, cf.MeasuredWire(x, design.contact_wire_height(x)))
    assert shape.dropper_lengths == pytest.approx(design.dropper_lengths, abs=2e-6)


def test_the_command_writes_the_layout(table, layout, tmp_path, capsys):
    assert main(["form", str(layout), "--measured", str(table), "-o", str(tmp_path / "out"), "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    hung = cf.find_form(cf.load_catenary(tmp_path / "out" / "layout.toml"))
    errors = [row["height_difference_mm"] for row in result["against_design"]]
    assert errors == pytest.approx((1e3 * hung.height_errors).tolist(), abs=0.01)
    design = cf.find_form(cf.load_catenary(layout))
    forces = [row["design_force_N"] for row in result["against_design"]]
    assert forces == pytest.approx(design.dropper_forces.tolist(), abs=1e-6)
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"against_design.csv", "static_shape.png", "plan.png", "dropper_schedule.csv"} <= names


WRONG = {
    "a decimal comma": ("x_m;height_m\n0;5,3\n", "row 2, column height_m: 5,3 is a number with a comma"),
    "a comma as separator, too": ("x_m,height_m\n0,5,3\n", "row 2: 3 cells for 2 columns"),
    "no unit": ("x;height_m\n0;5.3\n", "row 1, column 1 .*: the unit is missing"),
    "another unit": ("x_m;height_kN\n0;5.3\n", "row 1, column 2 .*: unit 'kN' does not fit a length"),
    "no height": ("x_m;stagger_m\n0;0.2\n", "row 1: column height_m is missing"),
    "an empty cell": ("x_m;height_m\n0;5.3\n5;\n", "row 3, column height_m: is empty"),
    "backwards": ("x_m;height_m\n5;5.3\n0;5.3\n", "row 3, column x_m: x = 0 m does not lie behind"),
    "millimetres as metres": (
        "x_m;height_m\n0;5300\n",
        "row 2, column height_m: height = 5300 m: contact wires",
    ),
    "an unknown column": ("x_m;height_m;wear_mm\n0;5.3;1\n", "row 1, column 3 .*: no column that is known"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_table_is_refused_by_row_and_column(case, tmp_path):
    text, said = WRONG[case]
    (tmp_path / "table.csv").write_text(text)
    with pytest.raises(cf.InputError, match=said) as caught:
        cf.read_measured(tmp_path / "table.csv")
    assert len(caught.value.problems) == 1


def test_places_between_rows(layout):
    """Straight between close rows, as it is beside one, and refused where nothing was measured."""
    fine = cf.MeasuredWire(np.array([0.0, 1.0, 2.0, 5.0]), np.array([5.3, 5.31, 5.3, 5.29]))
    assert fine.at("height", 0.25, "there") == pytest.approx(5.3025)
    assert fine.at("height", 5.2, "there") == 5.29
    assert fine.at("height", 2.2, "there") == 5.3
    with pytest.raises(
        cf.InputError, match=r"no height at there, x = 3.50 m: the nearest row is at (2|5).00 m"
    ):
        fine.at("height", 3.5, "there")
    with pytest.raises(cf.InputError, match=r"no height at support 2, x = 50\.00 m"):
        cf.fit_measured(cf.load_catenary(layout), fine)


def test_what_does_not_go_with_it(layout):
    line = cf.load_catenary(layout)
    x = np.sort(np.concatenate([line.support_positions, line.dropper_positions]))
    measured = cf.MeasuredWire(x, np.full(x.size, 5.3))
    with pytest.raises(cf.InputError, match=r"the layout says what has changed \(1 range of worn"):
        cf.fit_measured(line.replace(wear=[cf.Wear(span=1, area_left=0.9)]), measured)
    with pytest.raises(
        cf.InputError, match="support 1: the measured height of 7 m lies above the messenger wire"
    ):
        cf.fit_measured(line, cf.MeasuredWire(x, np.full(x.size, 7.0)))
