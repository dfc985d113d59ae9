"""Commands that work on a run's folder: it holds what they need, and says so where it does not."""

import csv
import html
import json
import shutil

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli import main
from catenary_fe.cli.stored import common_filter
from catenary_fe.cli.verdicts import kept_evaluation

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
        row = next(r for r in csv.DictReader(file) if r["span"] == "2" and r["position_m"] == "30.000")
    gap = messenger.static[dropper] - contact.static[np.searchsorted(contact.x, 90.0)]
    assert gap == pytest.approx(float(row["installed_length_m"]), abs=6e-5)


def test_rerun_gives_the_same(capsys, folder, tmp_path):
    code, out, err = call(capsys, "rerun", folder, "-o", tmp_path / "again", "--json")
    result = json.loads(out)
    assert (code, err, result["warnings"]) == (0, "", [])
    assert result["identical"] is True
    assert (tmp_path / "again" / "run.nc").read_bytes() == (folder / "run.nc").read_bytes()
    before, after = (json.loads((f / "summary.json").read_text()) for f in (folder, tmp_path / "again"))
    assert {k for k in before if before[k] != after[k]} <= {"wall_s", "real_time_factor"}
    assert {p.name for p in (tmp_path / "again").iterdir()} == {p.name for p in folder.iterdir()}


def test_rerun_says_what_changed(capsys, folder, layout_text, tmp_path):
    run = cf.load_run(folder / "run.nc")
    run.data["contact_force"] += 1.0
    (tmp_path / "layout.toml").write_text(layout_text.replace("tension = 20e3", "tension = 21e3"))
    (tmp_path / "inputs.json").write_bytes((folder / "inputs.json").read_bytes())
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
    assert force == pytest.approx(run.data["contact_force"].values[1, ::10], abs=5.1e-3)
    assert "mass_2_height_m" in rows[0]
    with (tmp_path / "csv" / "pantograph_1.csv").open() as file:
        assert "mass_2_height_m" not in file.readline()
    with (tmp_path / "csv" / "dropper_force.csv").open() as file:
        assert "span_3_dropper_9_at_175_m_force_N" in file.readline()


def test_another_run_into_a_folder_takes_away_what_was_made_of_the_one_before(capsys, folder, tmp_path):
    place, line = tmp_path / "run", folder.parent / "line.toml"
    shutil.copytree(folder, place)
    for name in ("notes.txt", "pantograph_mine.toml"):
        (place / name).write_text("mine")
    assert call(capsys, "export", place)[0] == 0
    assert call(capsys, "report", place)[0] == 0
    for name in ("criteria", "heights", "plan", "handover", "contact_lateral"):
        (place / f"{name}.png").write_bytes(b"of the run before")
    arguments = ["--speed-kmh", "150", "--time-step-ms", "4", "--method", "linearised", "--quiet"]
    assert call(capsys, "run", line, "--pantograph", "EN 50318:2002", *arguments, "-o", place)[0] == 0
    left = {str(file.relative_to(place)) for file in place.rglob("*") if file.is_file()}
    assert left == {
        "run.nc", "summary.json", "layout.toml", "inputs.json", "dropper_schedule.csv",
        "support_schedule.csv", "layout.png",
        "static_shape.png", "contact_force.png", "support_uplift.png", "dropper_forces.png", "notes.txt",
        "pantograph_mine.toml", "pantograph_1.toml",  # an input, which inputs.json names no more
    }  # fmt: skip


def test_a_folder_that_held_no_run_keeps_all_it_has(capsys, folder, tmp_path):
    (tmp_path / "report.html").write_text("mine")
    arguments = ["--speed-kmh", "150", "--time-step-ms", "4", "--method", "linearised", "--quiet"]
    line = folder.parent / "line.toml"
    assert call(capsys, "run", line, "--pantograph", "EN 50318:2002", *arguments, "-o", tmp_path)[0] == 0
    assert (tmp_path / "report.html").read_text() == "mine"


@pytest.mark.parametrize("command", [["rerun"], ["export"], ["report"]])
def test_folders_that_hold_no_run(capsys, tmp_path, command):
    code, out, err = call(capsys, *command, tmp_path)
    assert (code, out) == (3, "")
    assert "holds no run.nc; give a folder that 'catenary-fe run ... -o DIR' wrote" in err
    assert len(err.splitlines()) == 1
    (tmp_path / "partial").mkdir()
    (tmp_path / "partial" / "run.nc").touch()
    _, _, err = call(capsys, *command, tmp_path)
    assert f"one that was stopped is in {tmp_path / 'partial'}: give that folder" in err


def test_film(capsys, folder, tmp_path):
    from PIL import Image

    for name in ("run.gif", "run.mp4"):
        path = tmp_path / name
        code, out, _ = call(capsys, "film", folder, "--slowed", 2, "--fps", 10, "-o", path)
        assert code == 0
        assert out.startswith(f"{path}: ")
        assert path.stat().st_size > 20_000
    with Image.open(tmp_path / "run.gif") as picture:
        # 60 m and the 18 m between the pantographs at 55.6 m/s, and 9 m before and behind
        assert picture.n_frames == pytest.approx(20 * (60 + 18 + 18) / 55.6, abs=2)
        picture.seek(picture.n_frames // 2)
        colours = {c for _, c in picture.convert("RGB").getcolors(100_000)}
    assert any(r > 180 and 50 < g < 110 and b < 60 for r, g, b in colours)  # the contact wire is there


def test_waves(capsys, folder, tmp_path):
    for quantity in ("velocity", "deflection"):
        path = tmp_path / f"{quantity}.png"
        code, out, _ = call(capsys, "waves", folder, "--quantity", quantity, "-o", path)
        assert (code, out.strip()) == (0, str(path))
        assert path.stat().st_size > 20_000


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["film", "-o", "run.avi"], "ends with .gif or .mp4"),
        (["film", "-o", "no/run.gif"], "cannot be written: No such file"),
        (["film", "--slowed", "0", "-o", "run.gif"], "slowed = 0: must be above 0"),
        (["film", "--fps", "100", "-o", "run.gif"], "must be a whole number from 1 to 50"),
        (["film", "--spans", "8", "-o", "run.gif"], "the line has spans 1 to 3"),
        (["waves", "--spans", "8", "-o", "run.png"], "the line has spans 1 to 3"),
        (["waves", "--wire", "stitch wire", "-o", "run.png"], "stored 'contact wire', 'messenger wire'"),
        (["waves", "-o", "run.xyz"], "run.xyz: Format 'xyz' is not supported"),
    ],
)
def test_bad_questions(capsys, folder, tmp_path, monkeypatch, arguments, said):
    monkeypatch.chdir(tmp_path)
    code, out, err = call(capsys, arguments[0], folder, *arguments[1:])
    assert (code, out) == (3, "")
    assert said in err
    assert len(err.splitlines()) == 1
    assert not list(tmp_path.iterdir())


def test_runs_without_wire_shapes(capsys, folder, tmp_path):
    run = cf.load_run(folder / "run.nc")
    cf.Run(run.data.drop_dims("wire_time")).save(tmp_path / "run.nc")
    for command in ("film", "waves"):
        code, _, err = call(capsys, command, tmp_path, "-o", tmp_path / "x.gif")
        assert code == 3
        assert "the run holds no wire shapes; run again with --store-wire-ms 10" in err


def test_report(capsys, folder):
    code, out, _ = call(capsys, "report", folder)
    page = html.unescape((folder / "report.html").read_text(encoding="utf-8"))
    (folder / "report.html").unlink()
    assert code == 0
    assert "report.html: " in out
    for text in ("Checks and warnings", "Limits of AC", ">0.3 of the mean force (secondary source)<",
                 "mine", "EN 50318:2002 reference model", "Dropper schedule",
                 "secondary source", "causal low-pass", "Permission is hereby granted"):  # fmt: skip
        assert text in page
    summary = json.loads((folder / "summary.json").read_text())
    for pantograph in summary["pantographs"]:
        assert f">{pantograph['std_N']:.1f}<" in page
    for warning in summary["warnings"]:
        assert warning in page
    assert len(page) < 15e6


def test_report_without_wire_shapes_and_masses(capsys, folder, tmp_path):
    """What a run does not hold is left out; the rest is there."""
    run = cf.load_run(folder / "run.nc")
    data = run.data.drop_dims("wire_time")
    elastic = cf.ElasticPantograph(name="push", force=100.0, stiffness=20.0).model_dump(mode="json")
    data.attrs["pantographs"] = json.dumps([elastic, elastic])
    cf.Run(data).save(tmp_path / "run.nc")
    code, _, _ = call(
        capsys, "report", tmp_path / "run.nc", "-o", tmp_path / "r.html", "--filter", "zero-phase"
    )
    page = (tmp_path / "r.html").read_text(encoding="utf-8")
    assert code == 0
    assert "zero-phase low-pass" in page
    assert "100 N, falling by 20 N/m" in page
    assert 'id="stage"' not in page
    assert 'id="waves"' not in page


def test_a_report_judges_by_the_system_that_the_run_was_judged_by(capsys, folder, tmp_path):
    from catenary_fe.results import criteria_rows, missed

    run = cf.load_run(folder / "run.nc")
    run.data["contact_force"] += 200.0
    run.save(tmp_path / "run.nc")
    (tmp_path / "summary.json").write_text('{"criteria_system": "DC 3 kV", "filter": "nonsense"}')
    assert call(capsys, "report", tmp_path)[0] == 0
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    misses = missed(criteria_rows(run, "DC 3 kV"))
    assert misses
    assert "Limits of DC 3 kV" in page
    assert page.count('<td class="missed">missed</td>') == len(misses)
    assert f"{len(misses)} of" in page
    assert call(capsys, "report", tmp_path, "--criteria", "ac")[0] == 0
    assert "Limits of AC" in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_a_report_that_cannot_be_written(capsys, folder, tmp_path):
    code, _, err = call(capsys, "report", folder, "-o", tmp_path / "no" / "r.html")
    assert code == 3
    assert "cannot be written: No such file or directory" in err


def changed(folder, target, **attributes):
    """A copy of a run with other inputs on record and a contact force that is 2 N larger."""
    data = cf.load_run(folder / "run.nc").data
    data["contact_force"] += 2.0
    data.attrs |= attributes
    target.mkdir()
    cf.Run(data).save(target / "run.nc")
    return target


def test_compare(capsys, folder, tmp_path):
    catenary = cf.load_run(folder / "run.nc").catenary
    tighter = catenary.replace(contact_wire=catenary.contact_wire.replace(tension=22e3))
    other = changed(folder, tmp_path / "other", speed=60.0, catenary=tighter.model_dump_json())
    code, out, err = call(capsys, "compare", folder, other, "--json", "-o", tmp_path / "comparison")
    result = json.loads(out)
    assert (code, err) == (0, "")
    assert result["inputs_that_differ"] == [
        {"name": "speed (km/h)", "run": "200", "other": "216"},
        {"name": "catenary: contact wire: tension", "run": "20000", "other": "22000"},
    ]
    assert [r["label"] for r in result["runs"]] == [
        "run: mine", "run: EN 50318:2002", "other: mine", "other: EN 50318:2002",
    ]  # fmt: skip
    for before, after in zip(result["runs"][:2], result["runs"][2:], strict=True):
        assert after["mean_N"] - before["mean_N"] == pytest.approx(2)
        assert after["std_N"] == pytest.approx(before["std_N"])
    page = (tmp_path / "comparison" / "comparison.html").read_text()
    assert "catenary: contact wire: tension" in page
    assert page.count("data:image/svg+xml;base64,") == 2
    assert {p.name for p in (tmp_path / "comparison").iterdir()} == {
        "comparison.json", "comparison.csv", "comparison.html", "contact_force.png", "support_uplift.png",
    }  # fmt: skip


def test_compare_prints_differences(capsys, folder, tmp_path):
    data = cf.load_run(folder / "run.nc").data.isel(pantograph=[0])
    data.attrs["pantographs"] = json.dumps(json.loads(data.attrs["pantographs"])[:1])
    single = tmp_path / "single"
    single.mkdir()
    cf.Run(data).save(single / "run.nc")
    other = changed(single, tmp_path / "other")
    code, out, _ = call(capsys, "compare", single, other)
    assert code == 0
    assert "the inputs are the same" in out
    mean = next(line for line in out.splitlines() if "mean force" in line)
    assert "+2.0" in mean


def test_compare_needs_two(capsys, folder):
    code, _, err = call(capsys, "compare", folder)
    assert code == 3
    assert "1 run to compare: give at least two" in err


def test_many_values_are_told_by_their_reach(folder, tmp_path):
    from catenary_fe.results.comparison import input_differences

    run = cf.load_run(folder / "run.nc")
    spans = tuple(
        span.replace(droppers=tuple(d.replace(position=d.position + 0.1 * i) for d in span.droppers))
        for i, span in enumerate(run.catenary.spans)
    )
    shifted = run.catenary.replace(spans=spans).model_dump_json()
    other = cf.load_run(changed(folder, tmp_path / "other", catenary=shifted) / "run.nc")
    (difference,) = input_differences([run, other])
    assert difference.name == "catenary: spans: droppers: position"
    assert difference.values == (
        "5, 10.5, 17, 23.5, 30, 36.5, 43, 49.5, 55", "27 different values, 5 to 55.2",
    )  # fmt: skip


def test_what_is_told_of_other_numbers_and_other_places(folder, tmp_path):
    from catenary_fe.results.comparison import input_differences

    run = cf.load_run(folder / "run.nc")
    first, second, third = run.catenary.spans
    fewer = run.catenary.replace(spans=(first, second.replace(droppers=second.droppers[:-1]), third))
    other = cf.load_run(changed(folder, tmp_path / "fewer", catenary=fewer.model_dump_json()) / "run.nc")
    assert [(d.name, d.values) for d in input_differences([run, other])] == [
        ("number of droppers", ("27", "26"))
    ]
    soft = [span.replace(pre_sag=0.02) for span in (first, second, third)]
    lines = [
        run.catenary.replace(spans=(soft[0], second, third)),
        run.catenary.replace(spans=(soft[0], second, soft[2])),
    ]
    runs = [
        cf.load_run(changed(folder, tmp_path / f"{i}", catenary=line.model_dump_json()) / "run.nc")
        for i, line in enumerate(lines)
    ]
    assert [(d.name, d.values) for d in input_differences(runs)] == [
        ("catenary: spans: pre sag", ("0.02, 0", "0.02, 0, in other places"))
    ]


def test_a_run_is_shown_as_it_was_evaluated(tmp_path):
    """Its summary says how; a summary that is not there, or says something else, means the defaults."""
    assert kept_evaluation(tmp_path) == ("causal", None)
    (tmp_path / "summary.json").write_text('{"filter": "zero-phase", "criteria_system": "DC 3 kV"}')
    assert kept_evaluation(tmp_path) == kept_evaluation(tmp_path / "run.nc") == ("zero-phase", "DC 3 kV")
    (tmp_path / "summary.json").write_text('{"filter": "none", "criteria_system": ["AC"]}')
    assert kept_evaluation(tmp_path) == ("causal", None)


def test_runs_are_compared_with_one_filter(tmp_path):
    for name, kind in (("a", "zero-phase"), ("b", "zero-phase"), ("c", "causal")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "summary.json").write_text(f'{{"filter": "{kind}"}}')
    a, b, c = (str(tmp_path / name) for name in "abc")
    assert common_filter((a, b), ["a", "b"], None) == ("zero-phase", [])
    kind, (said,) = common_filter((a, c), ["a", "c"], None)
    assert (kind, said) == (
        "causal", "a: its own summary has figures of the zero-phase filter, here they are of the causal one"
    )  # fmt: skip
    assert [text[0] for text in common_filter((a, b), ["a", "b"], "causal")[1]] == ["a", "b"]
