"""The long section as DXF: what is drawn is what hangs."""

import ezdxf
import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli import main
from catenary_fe.views import write_dxf


@pytest.fixture(scope="module")
def shape():
    return cf.find_form(cf.build_line("Re 250", [60.0, 50.0, 60.0]))


@pytest.mark.parametrize("exaggeration", [1.0, 10.0])
def test_wires_droppers_and_masts_in_metres(shape, tmp_path, exaggeration):
    drawing = ezdxf.readfile(write_dxf(shape, tmp_path / "line.dxf", exaggeration=exaggeration))
    lines = {layer: [] for layer in ("CONTACT_WIRE", "MESSENGER_WIRE", "STITCH_WIRE", "DROPPERS", "MASTS")}
    for entity in drawing.modelspace().query("LWPOLYLINE"):
        lines[entity.dxf.layer].append(np.array(entity.get_points("xy")) / [1, exaggeration])
    assert [len(each) for each in lines.values()] == [1, 1, 2, len(shape.catenary.droppers), 4]
    assert np.allclose(lines["CONTACT_WIRE"][0][:, 1], shape.contact_wire_z)
    heights = [line[1, 1] - line[0, 1] for line in lines["DROPPERS"]]
    lateral = np.abs(shape.installed_lengths - heights)
    assert np.all(lateral < 0.05) and np.all(shape.installed_lengths >= np.array(heights) - 1e-6)
    texts = [entity.dxf.text for entity in drawing.modelspace().query("TEXT")]
    assert f"1: {round(1e3 * shape.dropper_lengths[0])} mm" in texts
    assert "2: 60.000 m, wire 5.300 m, stagger -200 mm" in texts
    assert drawing.header["$INSUNITS"] == 6


def test_the_command_and_what_it_refuses(tmp_path, monkeypatch, capsys):
    layout, drawing = str(tmp_path / "line.toml"), str(tmp_path / "line.dxf")
    assert main(["layout", "build", "LN2", "--spans", "54,54", "-o", layout, "--quiet"]) == 0
    assert main(["layout", "dxf", layout, "-o", drawing]) == 0
    assert ezdxf.readfile(drawing).modelspace().query("LWPOLYLINE")
    monkeypatch.setattr("catenary_fe.views.dxf.find_spec", lambda name: None)
    assert main(["layout", "dxf", layout, "-o", drawing]) == 3
    assert 'pip install "catenary_fe[dxf]"' in capsys.readouterr().err
