"""The command ``fmu``: what it carries, and what it says where it cannot."""

import json
import zipfile

import pytest

from catenary_fe.cli.main import main
from catenary_fe.studies import fmu
from tests.conftest import LAYOUTS

LINE = str(LAYOUTS / "en50318_2002.toml")
WHOLE = ["--pantograph", "EN 50318:2002", "--speed-kmh", "250", "--cut", "none"]


def test_a_file_that_carries_all(tmp_path, capsys):
    pytest.importorskip("pythonfmu")
    path, cold = tmp_path / "whole.fmu", tmp_path / "cold.toml"
    cold.write_text('name = "cold"\ntemperature = -20.0\n', encoding="utf-8")
    arguments = ["fmu", LINE, *WHOLE, "--time-step-ms", "2", "--conditions", str(cold), "-o", str(path)]
    assert main(arguments) == 0
    assert "whole.fmu" in capsys.readouterr().out
    with zipfile.ZipFile(path) as file:
        carried = json.loads(file.read(f"resources/{fmu.RECORD}"))
        described = file.read("modelDescription.xml").decode()
    assert carried["conditions"]["temperature"] == -20.0 and carried["time_step"] == 2e-3
    assert "pantograph[1].uplift_force" in described and "frame_force" not in described
    assert 'start="120' in described


def test_without_its_package_it_says_what_to_install(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(fmu, "find_spec", lambda name: None)
    assert main(["fmu", LINE, *WHOLE, "-o", str(tmp_path / "whole.fmu")]) == 3
    assert 'pip install "catenary_fe[fmu]"' in capsys.readouterr().err
    assert not list(tmp_path.iterdir())
