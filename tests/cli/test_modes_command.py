"""The modes command: table, JSON, pictures, bad input."""

import json

from catenary_fe.cli import main


def call(capsys, *arguments):
    code = main([str(a) for a in arguments])
    return code, *capsys.readouterr()


def test_modes(capsys, reference_layout, tmp_path):
    code, out, err = call(capsys, "modes", reference_layout, "--count", 3, "--json", "-o", tmp_path / "out")
    modes = json.loads(out)["modes"]
    assert (code, err) == (0, "")
    assert [m["mode"] for m in modes] == [1, 2, 3]
    assert set(modes[0]) == {"mode", "frequency_Hz", "damping_ratio", "kind", "half_waves", "symmetry"}
    assert 0.8 < modes[0]["frequency_Hz"] < 1.2
    written = {p.name for p in (tmp_path / "out").iterdir()}
    assert written == {"modes.json", "modes.csv", "spectrum.png", "mode_01.png", "mode_02.png", "mode_03.png"}


def test_modes_below_a_frequency(capsys, reference_layout):
    code, out, _ = call(capsys, "modes", reference_layout, "--below", 1.1)
    assert code == 0
    assert "whole line" in out
    code, _, err = call(capsys, "modes", reference_layout, "--below", -1)
    assert code == 3
    assert "must be above 0" in err


def test_modes_beyond_the_mesh(capsys, reference_layout, tmp_path):
    """They are warned of where they can be found, and refused where that would take for ever."""
    code, _, err = call(capsys, "modes", reference_layout, "--count", 10_000)
    assert code == 3
    assert "at most a third of them can be found" in err
    small = tmp_path / "small.toml"
    text = reference_layout.read_text().replace("count = 10", "count = 1")
    small.write_text(text.replace("evaluated_spans = [5, 6]", ""))
    code, out, _ = call(capsys, "modes", small, "--count", 300, "--json")
    (warning,) = json.loads(out)["warnings"]
    assert code == 0
    assert "Hz waves are shorter than two elements: " in warning
