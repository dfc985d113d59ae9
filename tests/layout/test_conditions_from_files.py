"""Conditions that name CSV tables: they hold what the tables say, and no names."""

from pathlib import Path

import jsonschema
import pytest

import catenary_fe as cf
from catenary_fe.layout.conditions import conditions_schema, conditions_text
from catenary_fe.layout.toml import read_toml

TOML = """
temperature = "tables/t.csv"
wind = { speed = "wind.csv" }
ice = { load = "ice.csv" }
irregularity = { height = "surface.csv" }
base = { height = "track.csv", suspension = { frequency = 1.2 } }
[[case]]
name = "mast alone"
wind = { speed = "mast.csv", direction = -90.0 }
ice = { load = 0.0 }
"""
TABLES = {
    "tables/t.csv": "x_m;temperature [°C]\n0;5\n800;12.5\n",
    "wind.csv": "time_s,x_m,speed_kmh\n0,0,36\n0,100,72\n10,0,36\n10,100,36\n",
    "ice.csv": "x_km,load_N_per_m\n0,3.5\n0.4,7\n",
    "surface.csv": "x_m,height_mm\n0,0\n1,1\n",
    "track.csv": "x_m,height_mm\n0,0\n5,8\n",
    "mast.csv": "time [s],speed [m/s]\n0,10\n5,12\n",
}


@pytest.fixture()
def file(tmp_path: Path) -> Path:
    (tmp_path / "tables").mkdir()
    for name, text in TABLES.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    path = tmp_path / "day.toml"
    path.write_text(TOML, encoding="utf-8")
    return path


def test_tables_take_the_place_of_names(file: Path) -> None:
    found = cf.load_conditions(file)
    assert found.temperature == ((0.0, 5.0), (800.0, 12.5))
    assert found.wind.speed == ((0, 0, 10.0), (0, 100, 20.0), (10, 0, 10.0), (10, 100, 10.0))
    assert found.wind.steady == ((0.0, 10.0), (100.0, 15.0))
    assert found.ice.load == ((0.0, 3.5), (400.0, 7.0))
    assert found.irregularity.height == ((0.0, 0.0), (1.0, 0.001))
    assert found.base.height == ((0.0, 0.0), (5.0, 0.008)) and found.base.suspension.frequency == 1.2
    (_, mast) = found.cases
    assert mast.wind.speed == ((0, 0, 10.0), (5, 0, 12.0)) and mast.wind.direction == -90.0
    assert cf.Conditions.model_validate_json(found.model_dump_json(exclude_unset=True)) == found
    jsonschema.validate(read_toml(file, "conditions"), conditions_schema())


def test_a_text_that_needs_no_tables(file: Path, tmp_path: Path) -> None:
    """What an output folder keeps; a file that names none is kept as it is."""
    alone = tmp_path / "alone" / "day.toml"
    alone.parent.mkdir()
    alone.write_bytes(conditions_text(file))
    assert cf.load_conditions(alone) == cf.load_conditions(file)
    assert conditions_text(alone) == alone.read_bytes()


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        (
            "tables/t.csv",
            "x_m;temperature_C\n0;5,5\n",
            r"row 2, column temperature_C: 5,5 is a number",
        ),
        ("tables/t.csv", "x_m,temperature_C\n0,\n", "row 2, column temperature_C: is empty"),
        ("tables/t.csv", "x_m,temperature_F\n0,5\n", "unit 'F' does not fit a temperature"),
        ("wind.csv", "speed_kmh\n36\n", "column x_m or time_s is missing"),
        (
            "wind.csv",
            "time_s,x_m,speed_kmh\n0,0,9\n1,5,9\n0,0,9\n",
            "row 4, column time_s: 0 s does",
        ),
        (
            "wind.csv",
            "x_m,speed_kmh\n0,720\n",
            "wind.speed: entry 1: value 200.0: must be",
        ),
        ("ice.csv", "x_m,load\n0,3\n", "the unit is missing: N/m, kN/m; write load_N_per_m"),
        ("surface.csv", "x_m,height_mm\n1,0\n1,1\n", "row 3, column x_m: 1 m does not come after 1 m"),
        ("mast.csv", "time_s,height_m\n1,0\n", "case 1: wind.speed: .*mast.csv: row 1, column 2"),
    ],
)
def test_faults_by_row_and_column(file: Path, name: str, text: str, said: str) -> None:
    (file.parent / name).write_text(text, encoding="utf-8")
    with pytest.raises(cf.InputError, match=said):
        cf.load_conditions(file)


def test_all_faults_at_once(file: Path) -> None:
    for name in ("tables/t.csv", "mast.csv"):
        (file.parent / name).unlink()
    with pytest.raises(cf.InputError) as caught:
        cf.load_conditions(file)
    assert [line.split(": ")[0] for line in caught.value.problems] == ["temperature", "case 1"]
    assert all("no such table file" in line for line in caught.value.problems)


def test_python_takes_tables() -> None:
    with pytest.raises(cf.InputError, match="or a list of"):
        cf.Conditions(temperature="t.csv")
