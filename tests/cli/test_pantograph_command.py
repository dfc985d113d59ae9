"""The command ``pantograph``: figures, files, faults; and runs that keep a table of receptances."""

import json

import numpy as np
import pytest

from catenary_fe.cli.main import main
from tests.conftest import LAYOUTS

KEYS = {
    "name",
    "kind",
    "frequencies_Hz",
    "damping_ratios",
    "masses_kg",
    "receptance",
    "static_uplift_N",
    "warnings",
}


def asked(capsys, *arguments):
    assert main(["pantograph", *map(str, arguments), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.fixture
def by_receptance(tmp_path, capsys):
    """A file whose table the command made."""
    asked(capsys, "EN 50318:2002", "-o", tmp_path / "made")
    (tmp_path / "head.csv").write_bytes((tmp_path / "made" / "receptance.csv").read_bytes())
    path = tmp_path / "head.toml"
    path.write_text('name = "head"\nreceptance = "head.csv" # measured\nuplift_force = 120.0\n')
    return path


def test_what_is_said_of_masses(tmp_path, capsys):
    found = asked(capsys, "EN 50318:2002", "-o", tmp_path / "out")
    assert set(found) >= KEYS and found["kind"] == "masses" and found["fit"] is None
    assert found["masses_kg"] == [7.2, 15.0] and found["static_uplift_N"] == 120.0
    assert set(found["receptance"]) == {"frequency_Hz", "magnitude_m_per_N", "phase_deg"}
    assert found == json.loads((tmp_path / "out" / "pantograph.json").read_text())
    table = np.loadtxt(tmp_path / "out" / "receptance.csv", delimiter=",", skiprows=1)
    np.testing.assert_allclose(table.T, list(found["receptance"].values()), rtol=1e-11)
    assert (tmp_path / "out" / "pantograph.png").stat().st_size > 20_000


def test_the_table_describes_the_same_pantograph(by_receptance, capsys):
    masses, table = (
        asked(capsys, "EN 50318:2002"),
        asked(capsys, by_receptance, "-o", by_receptance.parent / "out"),
    )
    assert table["kind"] == "receptance" and table["fit"]["rms_error_percent"] < 1e-6
    assert table["frequencies_Hz"] == pytest.approx(masses["frequencies_Hz"], rel=1e-7)
    assert table["fit"]["masses"] == 2 and not table["warnings"]
    assert main(["pantograph", str(by_receptance)]) == 0
    out = capsys.readouterr().out
    assert "off by" in out and "own frequency 2" in out and "receptance at 5 Hz" in out


def test_elastic_pantographs_and_faults(tmp_path, capsys):
    path = tmp_path / "elastic.toml"
    path.write_text("force = 100.0\n")
    found = asked(capsys, path, "-o", tmp_path / "out")
    assert found["receptance"] is None and found["masses_kg"] == []
    assert not (tmp_path / "out" / "receptance.csv").exists()
    assert main(["pantograph", "nobody"]) == 3
    assert "nobody" in capsys.readouterr().err
    path.write_text('receptance = "none.csv"\nuplift_force = 90.0')
    assert main(["pantograph", str(path)]) == 3
    assert "none.csv" in capsys.readouterr().err


def test_a_run_keeps_the_table_beside_the_file(by_receptance, tmp_path, capsys, monkeypatch):
    out = tmp_path / "run"
    words = [
        "run",
        str(LAYOUTS / "en50318_2002.toml"),
        "--pantograph",
        str(by_receptance),
        "--speed-kmh",
        "250",
    ]
    more = ["--method", "linearised", "--time-step-ms", "2", "--quiet"]
    assert main([*words, "-o", str(out), *more]) == 0
    kept = (out / "pantograph_1.toml").read_text()
    assert 'receptance = "pantograph_1_receptance.csv" # measured' in kept
    assert (out / "pantograph_1_receptance.csv").read_bytes() == (tmp_path / "head.csv").read_bytes()
    (tmp_path / "head.csv").unlink()
    assert asked(capsys, out / "pantograph_1.toml")["masses_kg"] == pytest.approx([7.2, 15.0], rel=1e-6)
    assert main(["rerun", str(out), "-o", str(tmp_path / "again")]) == 0
    assert "the same to the last bit" in capsys.readouterr().out
    assert (tmp_path / "again" / "pantograph_1_receptance.csv").exists()
