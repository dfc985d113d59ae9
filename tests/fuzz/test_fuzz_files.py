"""Hostile layout and pantograph files end in a result or in clear errors, each one line."""

import json
import warnings

import pytest
from hostile import INPUTS, call, hostile_files, layouts, try_all

import catenary_fe as cf

# every key that a pantograph may have, as numbers to edit
HEAD = {"width": 1.2, "spring_distance": 0.7, "roll_inertia": 1.0, "strips": 2, "strip_distance": 0.5}
UPPER = {"mass": 7.2, "stiffness": 4200.0, "damping": 10.0}
LOWER = {"mass": 15.0, "stiffness": 50.0, "damping": 90.0}
CONTACT = {"contact_stiffness": 5e4, "contact_damping": 1.0}
AIR = {"quadratic": 0.01, "linear": 0.1}
PANTOGRAPHS = [
    {"name": "air", "uplift_force": 120.0, "stages": [UPPER, LOWER], "aerodynamic_force": AIR, **CONTACT},
    {"name": "head", "mean_force": "EN 50367 AC", "stages": [UPPER], "head": HEAD},
]


def refused(path, error):
    assert error.problems
    for line in error.problems:
        assert line.startswith(str(path))
        assert len(line.splitlines()) == 1
        assert len(line) < 1500
    return "refused"


def test_layout_files(reference_layout, tmp_path, capsys):
    path = tmp_path / "hostile.toml"

    def outcome(content):
        path.write_bytes(content)
        code, out, err = call("info", path, "--json")
        if code:
            assert (code, out) == (3, "")
            assert all(line.startswith("error: ") for line in err.splitlines())
            try:
                cf.load_catenary(path)
            except cf.InputError as error:
                return refused(path, error)
            raise AssertionError("refused by the command alone")
        json.loads(out)
        mirrored = cf.load_catenary(path).mirrored()
        try:
            mirrored.planar()
        except cf.InputError as error:
            assert all(line.startswith("support ") and "\n" not in line for line in error.problems)
        return "taken"

    seen = try_all(hostile_files(layouts(reference_layout.parent)), outcome, INPUTS)
    with capsys.disabled():
        print(f"\nlayout files tried: {seen.total()}, {dict(seen)}")
    assert seen.total() >= INPUTS
    assert min(seen["refused"], seen["taken"]) > INPUTS / 50


def test_pantograph_files(tmp_path, capsys):
    path = tmp_path / "hostile.toml"

    def outcome(content):
        path.write_bytes(content)
        try:
            pantograph = cf.load_pantograph(path)
        except cf.InputError as error:
            return refused(path, error)
        json.dumps(pantograph.model_dump(mode="json"), allow_nan=False)
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for speed in (5 / 3.6, 600 / 3.6):
                pantograph.static_uplift(speed)
        return "taken"

    seen = try_all(hostile_files(PANTOGRAPHS), outcome, INPUTS)
    with capsys.disabled():
        print(f"\npantograph files tried: {seen.total()}, {dict(seen)}")
    assert seen.total() >= INPUTS
    assert min(seen["refused"], seen["taken"]) > INPUTS / 50


@pytest.mark.parametrize("load", [cf.load_catenary, cf.load_pantograph])
@pytest.mark.parametrize(
    "content",
    [
        "name = 0x" + "f" * 5000,  # more digits than Python writes
        "name = " + "9" * 5000,
        "name" + ".a" * 3000 + " = 1",  # a deep table without recursion in its reader
        "contact_wire" + ".a" * 3000 + " = 1\nstages" + ".a" * 3000 + " = 1",
        "name = " + "[" * 900 + "]" * 900,
        "\ufeffname = 'x'",
        "name = 1979-05-27T07:32:00Z",
        "name = 'x'\n" * 2,
        "span = [" + "{}," * 50_000 + "]\nstages = [" + "{}," * 50_000 + "]",
        "name = 1\nname.a = 2",
    ],
)
def test_found_files(tmp_path, load, content):
    path = tmp_path / "found.toml"
    path.write_text(content)
    with pytest.raises(cf.InputError) as caught:
        load(path)
    refused(path, caught.value)
