"""The command ``cases``: figures, files, verdicts, faults; and runs under conditions."""

import json

import pandas as pd
import pytest

import catenary_fe as cf
from catenary_fe.cli.main import main
from tests.conftest import LAYOUTS

STORM = """
name = "calm"
temperature = 15.0
allowed_offset = 0.4
[[case]]
name = "hot"
temperature = 45.0
[[case]]
name = "storm"
wind = { speed = 20.0 }
"""


@pytest.fixture(scope="module")
def line(tmp_path_factory):
    """Six spans of a stitched line in a curve."""
    path = tmp_path_factory.mktemp("line") / "line.toml"
    assert (
        main(["layout", "build", "Re 330", "--spans", "6x60", "--curve-radius", "3000", "-o", str(path)]) == 0
    )
    return path


def storm(folder, text=STORM):
    path = folder / "storm.toml"
    path.write_text(text, encoding="utf-8")
    return str(path)


def test_cases_are_written_and_judged(line, tmp_path, capsys):
    out = tmp_path / "out"
    arguments = ["cases", str(line), "--conditions", storm(tmp_path), "-o", str(out), "--xlsx", "--json"]
    assert main(arguments) == 0
    found = json.loads(capsys.readouterr().out)
    assert found == json.loads((out / "cases.json").read_text(encoding="utf-8"))
    calm, hot, blown = found["cases"]
    assert [case["name"] for case in found["cases"]] == ["calm", "hot", "storm"]
    assert {"name", "tension_N", "largest_sag_m"} <= set(calm["wires"][0])
    assert {"support", "cantilever_shift_mm", "forces_N"} <= set(calm["supports"][1])
    assert hot["supports"][-1]["device_travel_mm"]["contact_wire"] == pytest.approx(
        1.7e-2 * 30 * 360, rel=0.01
    )
    assert calm["largest_lateral_offset_m"] < blown["largest_lateral_offset_m"] <= blown["allowed_offset_m"]
    assert "diameter of stitch_wire" in " ".join(found["warnings"]) or "diameter" not in " ".join(
        found["warnings"]
    )
    table = pd.read_csv(out / "supports.csv")
    assert len(table) == 3 * 7
    assert list(pd.read_excel(out / "cases.xlsx", sheet_name="cases")["case"]) == ["calm", "hot", "storm"]
    assert (out / "cases.png").stat().st_size > 20_000


def test_an_offset_that_is_too_large_exits_with_1(line, tmp_path, capsys):
    text = STORM.replace("allowed_offset = 0.4", "allowed_offset = 0.25")
    assert main(["cases", str(line), "--conditions", storm(tmp_path, text)]) == 1
    assert "NO" in capsys.readouterr().out


def test_a_run_takes_one_case(line, tmp_path, capsys):
    run = ["run", str(line), "--pantograph", "DSA380", "--speed-kmh", "200", "--method", "linearised"]
    assert main([*run, "--conditions", storm(tmp_path)]) == 3
    assert "has 2 cases beside its own circumstances" in capsys.readouterr().err
    one = storm(tmp_path, 'name = "cold"\ntemperature = -20.0\n')
    out = tmp_path / "run"
    assert main([*run, "--conditions", one, "-o", str(out), "--quiet"]) == 0
    assert json.loads((out / "summary.json").read_text(encoding="utf-8"))["conditions"] == "cold"
    inputs = json.loads((out / "inputs.json").read_text(encoding="utf-8"))
    assert "--conditions conditions.toml" in inputs["command"]
    assert inputs["conditions"] == {"name": "cold", "temperature": -20.0}
    assert main(["rerun", str(out)]) == 0


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('temperature = "5"', "temperature: '5': must be a number from -100 to 150, or a list of [x, value]"),
        ("temperature = 278.0", "temperature: 278.0: must be a number from -100 to 150"),
        ("temperature = [[0, 5.0], [0, 6.0]]", "entry 2: x = 0 m does not come after 0 m"),
        ("temperature = [[0, 5.0, 1.0]]", "entry 1: [0, 5.0, 1.0]: must be a pair [x, value]"),
        ("[wind]\nspeed = 120.0", "wind.speed: 120.0: must be a number from 0 to 100"),
        ("[wind]\nspede = 12.0", "unknown key wind.spede; did you mean 'speed'?"),
        ("[ice]\nload = [[0, -1.0]]", "ice.load: entry 1: value -1.0: must be a number from 0"),
        ("[[case]]\ntemperature = 3.0", "case 1: name is missing"),
        ('[[case]]\nname = "a"\nwind = { direction = 3.0 }', "case 1: wind.speed is missing"),
        ('[[case]]\nname = "conditions"', "the name 'conditions' stands for two cases"),
        ("temperature = 5,5", "decimal"),
    ],
)
def test_faults_of_a_conditions_file(line, tmp_path, capsys, text, said):
    assert main(["cases", str(line), "--conditions", storm(tmp_path, text)]) == 3
    error = capsys.readouterr().err
    assert said in error
    assert "Traceback" not in error


def test_wind_on_a_line_in_the_plane(tmp_path, capsys):
    layout = str(LAYOUTS / "en50318_2002.toml")
    assert main(["cases", layout, "--conditions", storm(tmp_path)]) == 3
    assert "set spatial = true in the layout" in capsys.readouterr().err


def test_a_run_keeps_conditions_that_need_no_other_file(line, tmp_path):
    """The track comes from a table; the kept file, and the record, have its numbers."""
    (tmp_path / "track.csv").write_text("x_m,height_mm\n0,0\n100,6\n200,-4\n", encoding="utf-8")
    text = '[base]\nheight = "track.csv"\nsuspension = { frequency = 1.5 }\n'
    run = ["run", str(line), "--pantograph", "DSA380", "--speed-kmh", "250", "--method", "linearised"]
    out = tmp_path / "run"
    assert main([*run, "--conditions", storm(tmp_path, text), "-o", str(out), "--quiet"]) in (0, 1)
    (tmp_path / "track.csv").unlink()
    kept = cf.load_conditions(out / "conditions.toml")
    assert kept.base.height == ((0.0, 0.0), (100.0, 0.006), (200.0, -0.004))
    read = cf.load_run(out / "run.nc")
    assert read.conditions == kept
    assert abs(read.data["base_height"].values).max() > 0.001
    assert main(["rerun", str(out)]) == 0
