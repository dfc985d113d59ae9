"""Commands that work on a run's folder: it holds what they need, and says so where it does not."""

import csv
import json

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli import main

PANTOGRAPH = (
    'name = "mine"\nuplift_force = 110.0\nstages = [{ mass = 9.0, stiffness = 60.0, damping = 80.0 }]\n'
)


def call(capsys, *arguments):
    code = main([str(a) for a in arguments])
    return code, *capsys.readouterr()


@pytest.fixture(scope="module")
def layout_text(reference_layout):
    text = reference_layout.read_text().replace("count = 10", "count = 3")
    return text.replace("evaluated_spans = [5, 6]", "evaluated_spans = [2]")


@pytest.fixture(scope="module")
def folder(layout_text, tmp_path_factory):
    """A run of two pantographs, one of which is a file."""
    base = tmp_path_factory.mktemp("runs")
    (base / "line.toml").write_text(layout_text)
    (base / "mine.toml").write_text(PANTOGRAPH)
    arguments = ["run", base / "line.toml", "--pantograph", base / "mine.toml", "--pantograph",
                 "EN 50318:2002", "--pantograph-at", "30", "12", "--speed-kmh", "200",
                 "--time-step-ms", "2", "--quiet", "-o", base / "run"]  # fmt: skip
    assert main([str(a) for a in arguments]) == 0
    return base / "run"


def test_all_inputs_lie_in_the_folder(folder, layout_text):
    assert (folder / "layout.toml").read_text() == layout_text
    assert (folder / "pantograph_1.toml").read_text() == PANTOGRAPH
    assert not (folder / "pantograph_2.toml").exists()
    inputs = json.loads((folder / "inputs.json").read_text())
    assert inputs["command"] == (
        "catenary-fe run layout.toml --pantograph pantograph_1.toml --pantograph 'EN 50318:2002'"
        " --pantograph-at 30 --pantograph-at 12 --speed-kmh 200 --time-step-ms 2"
    )
    assert inputs["positions_m"] == [30, 12]
    assert inputs["catenary"]["contact_wire"]["tension"] == 20e3


def test_whole_wires_are_stored_every_10_ms(folder):
    run = cf.load_run(folder / "run.nc")
    contact, messenger = run.wires()
    assert (contact.name, messenger.name) == ("contact wire", "messenger wire")
    for wire in (contact, messenger):
        assert np.diff(wire.time) == pytest.approx(0.01)
        assert wire.height.shape == (wire.time.size, wire.x.size)
    support = np.searchsorted(contact.x, 60.0)
    uplift = run.data["support_uplift"].values[1, ::5]
    assert contact.uplift[:, support] == pytest.approx(uplift, abs=1e-6)
    dropper = np.searchsorted(messenger.x, 90.0)
    assert np.ptp(messenger.height[:, dropper]) > 0.01
    with (folder / "dropper_schedule.csv").open() as file:
        row = next(r for r in csv.DictReader(file) if r["span"] == "2" and r["position_m"] == "30.0")
    gap = messenger.static[dropper] - contact.static[np.searchsorted(contact.x, 90.0)]
    assert gap == pytest.approx(float(row["installed_length_m"]), abs=1e-6)


def test_rerun_gives_the_same(capsys, folder, tmp_path):
    code, out, err = call(capsys, "rerun", folder, "-o", tmp_path / "again", "--json")
    result = json.loads(out)
    assert (code, err, result["warnings"]) == (0, "", [])
    assert result["identical"] is True
    assert (tmp_path / "again" / "run.nc").read_bytes() == (folder / "run.nc").read_bytes()
    assert {p.name for p in (tmp_path / "again").iterdir()} == {p.name for p in folder.iterdir()}


def test_rerun_says_what_changed(capsys, folder, layout_text, tmp_path):
    run = cf.load_run(folder / "run.nc")
    run.data["contact_force"] += 1.0
    (tmp_path / "layout.toml").write_text(layout_text.replace("tension = 20e3", "tension = 21e3"))
    run.data.attrs["versions"] = run.data.attrs["versions"].replace('"exudyn": "1', '"exudyn": "0')
    run.save(tmp_path / "run.nc")
    code, out, err = call(capsys, "rerun", tmp_path)
    assert code == 1
    assert "layout.toml was changed since the run" in err
    assert "the run was computed with 0." in err
    assert "mean and standard deviation within 1 N, the contact force within 1 N" in out


def test_export(capsys, folder, tmp_path):
    code, out, _ = call(capsys, "export", folder, "-o", tmp_path / "csv", "--every-ms", "20")
    run = cf.load_run(folder / "run.nc")
    assert code == 0
    assert len(out.splitlines()) == 4
    with (tmp_path / "csv" / "pantograph_2.csv").open() as file:
        rows = list(csv.DictReader(file))
    force = [float(row["contact_force_N"]) for row in rows]
    assert force == pytest.approx(run.data["contact_force"].values[1, ::10], rel=1e-8)
    assert "mass_2_height_m" in rows[0]
    with (tmp_path / "csv" / "pantograph_1.csv").open() as file:
        assert "mass_2_height_m" not in file.readline()
    with (tmp_path / "csv" / "dropper_force.csv").open() as file:
        assert "dropper_27_at_175_m_force_N" in file.readline()


@pytest.mark.parametrize("command", [["rerun"], ["export"]])
def test_folders_that_hold_no_run(capsys, tmp_path, command):
    code, out, err = call(capsys, *command, tmp_path)
    assert (code, out) == (3, "")
    assert "holds no run.nc; give a folder that 'catenary-fe run ... -o DIR' wrote" in err
    assert len(err.splitlines()) == 1
