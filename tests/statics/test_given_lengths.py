"""A line whose droppers have lengths is hung with them, wherever it is hung."""

import json
from pathlib import Path

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli.main import main
from catenary_fe.studies.rerun import shape_of

TABLE = (Path(__file__).parents[1] / "cases" / "length_given.toml").read_text()
SLIPPED, RIGHT = "position = 27.5, length = 0.771", "position = 27.5, length = 0.741"
PANTOGRAPH = "EN 50318:2002"


def call(capsys, *arguments):
    code = main([str(a) for a in arguments])
    return code, *capsys.readouterr()


@pytest.fixture(scope="module")
def files(tmp_path_factory) -> dict[str, Path]:
    """Three spans of a site's table, the middle dropper 30 mm too long, right, or without a length."""
    folder, short = tmp_path_factory.mktemp("lines"), TABLE.replace("count = 10", "count = 3")
    assert SLIPPED in short
    positions = [4.5, 10.25, 16.0, 21.75, 27.5, 33.25, 39.0, 44.75, 50.5]
    texts = {
        "slipped": short,
        "right": short.replace(SLIPPED, RIGHT),
        "mixed": short.replace(SLIPPED, "position = 27.5"),
        "design": short[: short.index("droppers = [")] + f"droppers = {positions}\n",
    }
    for name, text in texts.items():
        (folder / f"{name}.toml").write_text(text)
    return {name: folder / f"{name}.toml" for name in texts}


@pytest.fixture(scope="module")
def shapes(files) -> dict[str, cf.Shape]:
    return {name: cf.find_form(cf.load_catenary(files[name])) for name in ("slipped", "right", "design")}


def test_lengths_that_are_given_are_used(shapes):
    lengths = {name: shape.dropper_lengths for name, shape in shapes.items()}
    assert lengths["slipped"].tolist() == [d.length for d in shapes["slipped"].catenary.droppers]
    assert lengths["slipped"] - lengths["right"] == pytest.approx(np.tile([0, 0, 0, 0, 0.03, 0, 0, 0, 0], 3))
    assert np.abs(lengths["design"] - lengths["right"]).max() > 5e-3
    assert np.abs(shapes["design"].height_errors).max() < 1e-4


def test_a_slip_of_30_mm_is_seen(shapes):
    """The dropper that is too long is slack, and the wire hangs lower there."""
    middle = [4, 13, 22]
    assert shapes["right"].dropper_forces[middle].min() > 10
    assert shapes["slipped"].dropper_forces[middle].max() == 0
    assert (shapes["right"].height_errors - shapes["slipped"].height_errors)[middle].min() > 5e-3


def test_design_lengths_of_a_line_that_gives_others(shapes):
    line = shapes["slipped"].catenary
    assert line.gives_dropper_lengths
    design = cf.find_form(line.without_dropper_lengths())
    assert not design.catenary.gives_dropper_lengths
    assert design.dropper_lengths == pytest.approx(shapes["design"].dropper_lengths, abs=1e-9)
    again = cf.find_form(line.with_dropper_lengths(design.dropper_lengths))
    assert np.abs(again.height_errors).max() < 1e-4


def test_a_shape_records_the_lengths_it_was_given(shapes):
    """So that a run on it can be repeated."""
    line = shapes["design"].catenary
    longer = shapes["design"].dropper_lengths + 0.002
    shape = cf.find_heights(line, longer)
    assert shape.catenary == line.with_dropper_lengths(longer)
    assert (cf.find_form(shape.catenary).contact_wire_z == shape.contact_wire_z).all()


def test_some_lengths_are_refused(files, capsys):
    mixed = cf.load_catenary(files["mixed"])
    for code, out, err in [call(capsys, command, files["mixed"]) for command in ("info", "form", "static")]:
        assert (code, out) == (3, "")
        assert err == (
            "error: span 1: dropper 5 at 27.5 m has no length: 3 of 27 droppers have none, the others have"
            " one; give all lengths, or none to have them found\n"
        )
    assert np.abs(cf.find_form(mixed.without_dropper_lengths()).height_errors).max() < 1e-4


def test_a_line_without_droppers_has_no_lengths(reference):
    bare = reference.replace(spans=[s.replace(droppers=()) for s in reference.spans])
    assert not bare.gives_dropper_lengths
    assert bare.without_dropper_lengths() == bare.with_dropper_lengths([]) == bare


@pytest.mark.parametrize(
    ("lengths", "said"),
    [
        ([1.0] * 26, r"lengths has the shape \(26,\): must have \(27,\); give one each"),
        (["a"] * 27, "must be numbers"),
        ([float("nan")] * 27, "nan is among them"),
        ([-1.0] * 27, "length = -1.0: must be greater than 0"),
        (None, "lengths = None: must be numbers"),
    ],
)
def test_what_are_no_lengths(shapes, lengths, said):
    with pytest.raises(cf.InputError, match=said):
        shapes["slipped"].catenary.with_dropper_lengths(lengths)


@pytest.mark.parametrize(
    "command",
    [
        ("info",),
        ("form",),
        ("static", "--spans", "2"),
        (
            "run",
            "--pantograph",
            PANTOGRAPH,
            "--speed-kmh",
            250,
            "--time-step-ms",
            2,
            "--method",
            "linearised",
        ),
    ],
)
def test_commands_hang_the_line_with_them(files, capsys, command):
    name, *options = command
    found = {}
    for which in ("slipped", "design"):
        code, out, err = call(capsys, name, files[which], *options, "--json")
        assert code == 0
        found[which] = json.loads(out)
        assert found[which].pop("dropper_lengths_given") == (which != "design")
        note = (
            "note: hung with the 27 dropper lengths that the layout gives: at the droppers the contact wire"
        )
        assert (note in err) == (which != "design" and name != "info")
        for unlike in ("wall_s", "real_time_factor"):
            found[which].pop(unlike, None)
    assert name == "info" or found["slipped"] != found["design"]


def test_form_with_the_lengths_of_the_design(files, capsys):
    _, out, err = call(capsys, "form", files["slipped"], "--design-lengths", "--json")
    assert err == ""
    assert max(abs(r["contact_wire_height_error_mm"]) for r in json.loads(out)["droppers"]) < 0.1


def test_modes_take_them(files, capsys):
    code, _, err = call(capsys, "modes", files["slipped"], "--count", 3)
    assert code == 3
    assert "error: span 1: the dropper at 27.5 m is slack at rest (3 of 27 are)" in err
    code, out, _ = call(capsys, "modes", files["right"], "--count", 3, "--json")
    assert (code, json.loads(out)["dropper_lengths_given"]) == (0, True)


def test_sweeps_take_them(files, capsys, tmp_path):
    uplift = {}
    for which in ("slipped", "design"):
        code, out, err = call(
            capsys, "sweep", files[which], "--speed-kmh", 250, "--pantograph", PANTOGRAPH,
            "--time-step-ms", 2, "--jobs", 1, "-o", tmp_path / which, "--json",
        )  # fmt: skip
        assert code == 0
        uplift[which] = json.loads(out)[0]["max_support_uplift_mm"]
        assert ("note: 1 of 1 cases are hung with dropper lengths" in err) == (which == "slipped")
    assert uplift["slipped"] != pytest.approx(uplift["design"], rel=1e-3)


def test_a_run_on_a_line_with_a_slack_dropper(shapes):
    """It is slack in the middle of each span at rest: both methods know, and a repeated run does."""
    line = shapes["slipped"].catenary
    shape = cf.find_form(line)
    pantograph = cf.library.pantograph(PANTOGRAPH)
    settings = cf.TimeSettings(step=2e-3)
    runs = [
        cf.simulate(shape, [pantograph], speed=250 / 3.6, time=settings, method=method)
        for method in ("nonlinear", "linearised")
    ]
    first, second = (run.contact_force_statistics()[0] for run in runs)
    assert (second.mean, second.std) == pytest.approx((first.mean, first.std), rel=0.01)
    far = runs[0].data["dropper_force"].values[22], runs[1].data["dropper_force"].values[22]
    assert far[0][0] == far[1][0] == 0
    assert far[1].max() == pytest.approx(far[0].max(), rel=0.05)
    assert (shape_of(runs[1]).contact_wire_z == shape.contact_wire_z).all()
