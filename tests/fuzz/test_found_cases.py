"""What hostile input once did: each case ended in a traceback, a hang or a filled memory."""

import os

import numpy as np
import pytest
from hostile import call, document, layouts

import catenary_fe as cf
from catenary_fe.engines.settings import SHORTEST_STEP
from catenary_fe.fe import MeshSettings
from catenary_fe.fe.mesh import make_mesh


def fault(load, path):
    with pytest.raises(cf.InputError) as caught:
        load(path)
    (line,) = caught.value.problems
    return line


def test_counts_that_would_fill_the_memory(reference_layout, tmp_path):
    path = tmp_path / "many.toml"
    record = layouts(reference_layout.parent)[0]
    record["span"] = [record["span"][0] | {"count": 10_000}] * 500
    path.write_text(document(record))
    assert "span: 5,000,000 spans in all: must be at most 10,000" in fault(cf.load_catenary, path)
    record["span"] = [{"length": 60.0, "count": 10_000, "droppers": [0.02 * i for i in range(1, 2900)]}]
    path.write_text(document(record))
    assert "droppers in all: must be at most 200,000" in fault(cf.load_catenary, path)


@pytest.mark.parametrize("load", [cf.load_catenary, cf.load_pantograph])
def test_files_without_an_end(tmp_path, load):
    assert "larger than" in fault(load, "/dev/zero")
    sparse = tmp_path / "gigabyte.toml"
    with sparse.open("wb") as file:
        file.truncate(2**30)
    assert "larger than" in fault(load, sparse)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="needs named pipes")
def test_a_pipe_is_read(reference_layout, tmp_path):
    """As from a shell's <(command)."""
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    if os.fork() == 0:
        pipe.write_bytes(reference_layout.read_bytes())
        os._exit(0)
    assert cf.load_catenary(pipe) == cf.load_catenary(reference_layout)
    os.wait()


@pytest.mark.parametrize("name", ["x" * 5000, "a\0b", "a\0b.toml", "", "\ud800"])
def test_names_that_no_file_can_have(name):
    assert len(fault(cf.load_pantograph, name)) > 10


def test_numbers_whose_products_leave_the_range(reference_layout, tmp_path):
    path = tmp_path / "huge.toml"
    record = layouts(reference_layout.parent)[0]
    record["contact_wire"] |= {"tension": 1e308, "mass_per_length": 1e-308}
    path.write_text(document(record))
    code, out, err = call("info", path, "--json")
    assert (code, out) == (3, "")
    assert "contact_wire.tension = 1e+308: must be at most 1e+15" in err
    assert "contact_wire.mass_per_length: 1e-308 is below 1e-15" in err


def test_elements_of_a_millimetre(reference):
    """The growth's power left the range of floats after a thousand elements."""
    settings = MeshSettings(contact_wire_element=1e-3)
    short = reference.replace(
        spans=reference.spans[:2], supports=reference.supports[:3], evaluated_spans=None
    )
    x = make_mesh(short, settings).contact.x
    assert np.diff(x).max() <= 1e-3 + 1e-12


def test_steps_that_would_fill_the_memory():
    with pytest.raises(cf.InputError, match=r"must be at least 1e-06 and at most 0\.02"):
        cf.TimeSettings(step=SHORTEST_STEP / 2)


def test_line_breaks_in_a_name_stay_in_one_line(reference_layout, tmp_path):
    path = tmp_path / "broken.toml"
    record = layouts(reference_layout.parent)[0]
    record["contact_wire"]["library"] = "name\nsecond line"
    path.write_text(document(record))
    assert "no wire 'name\\nsecond line' in the library" in fault(cf.load_catenary, path)


def test_a_messenger_wire_that_hardly_anything_pulls(reference_layout, tmp_path):
    """It folded back on itself, and the spline through it raised."""
    path = tmp_path / "slack.toml"
    record = layouts(reference_layout.parent)[0]
    record["messenger_wire"]["tension"] = 0.011
    record["support"]["messenger_stiffness"] = 500.0
    record["span"] = [
        {"count": 2, "length": 60.0, "pre_sag": 0.02, "droppers": [5.0, 17.0, 30.0, 43.0, 55.0]}
    ]
    path.write_text(document(record))
    code, out, err = call("form", path, "--json")
    assert (code, out) == (3, "")
    assert "has no room: the wire it hangs on lies" in err
    assert "raise system_height or the messenger wire's tension of 0.011 N" in err
