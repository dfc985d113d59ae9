"""Commands as they are typed: what they print, write and return, and what bad input leads to."""

import json
import stat
from pathlib import Path

import pytest

from catenary_fe.cli import main
from catenary_fe.cli.terminal import progress_lines


@pytest.fixture
def layout(reference_layout, tmp_path):
    """The reference layout with four spans."""
    text = reference_layout.read_text().replace("count = 10", "count = 4")
    path = tmp_path / "layout.toml"
    path.write_text(text.replace("evaluated_spans = [5, 6]", "evaluated_spans = [3]"))
    return str(path)


def call(capsys, *arguments):
    code = main([str(a) for a in arguments])
    return code, *capsys.readouterr()


def test_info(capsys, layout, tmp_path):
    code, out, err = call(capsys, "info", layout, "--json", "-o", tmp_path / "out")
    facts = json.loads(out)
    assert (code, err) == (0, "")
    assert facts["contact_wire"]["wave_speed_kmh"] == pytest.approx(438.18, abs=0.01)
    assert facts["droppers"] == 36
    assert {p.name for p in (tmp_path / "out").iterdir()} == {"info.json", "layout.png"}
    code, out, _ = call(capsys, "info", layout)
    assert code == 0
    assert "messenger wire: tension kN" in out


def test_form(capsys, layout, tmp_path):
    code, out, err = call(capsys, "form", layout, "--json", "-o", tmp_path / "out")
    rows = json.loads(out)["droppers"]
    assert (code, err, len(rows)) == (0, "", 36)
    assert set(rows[0]) == {
        "span", "from_support", "to_support", "dropper", "chainage_m", "position_m", "cut_length_mm",
        "length_m", "installed_length_m", "force_N", "contact_wire_height_m", "contact_wire_height_error_mm",
    }  # fmt: skip
    assert [row["support"] for row in json.loads(out)["supports"]] == [1, 2, 3, 4, 5]
    assert max(abs(row["contact_wire_height_error_mm"]) for row in rows) < 0.1
    table = (tmp_path / "out" / "dropper_schedule.csv").read_text().splitlines()
    assert len(table) == 37
    cut = f"{rows[9]['cut_length_mm']},{rows[9]['length_m']:.4f},{rows[9]['installed_length_m']:.4f}"
    assert table[10].startswith(f"1,2,2,3,1,65.000,5.000,{cut},{rows[9]['force_N']:.1f},5.300,")
    assert table[10].endswith(",messenger wire,1")
    code, out, _ = call(capsys, "form", layout)
    assert "dropper schedule" in out
    assert "supports" in out


def test_the_spans_that_are_drawn(capsys, layout, tmp_path):
    place = tmp_path / "out"
    assert call(capsys, "info", layout, "--quiet", "-o", place)[0] == 0
    whole = (place / "layout.png").read_bytes()
    assert call(capsys, "info", layout, "--quiet", "--spans", "2,3", "-o", place)[0] == 0
    assert (place / "layout.png").read_bytes() != whole


def test_static(capsys, layout, tmp_path):
    code, out, err = call(
        capsys, "static", layout, "--json", "--quiet", "--force", 150, "-o", tmp_path / "out"
    )
    result = json.loads(out)
    assert (code, err, result["force_N"]) == (0, "", 150)
    values = [row["mm_per_N"] for row in result["elasticity"]]
    assert result["non_uniformity"] == pytest.approx(
        (max(values) - min(values)) / (max(values) + min(values))
    )
    assert (tmp_path / "out" / "elasticity.png").stat().st_size > 10_000


def test_run(capsys, layout, tmp_path):
    out_dir = tmp_path / "out"
    code, out, err = call(
        capsys, "run", layout, "--pantograph", "EN 50318:2002", "--speed-kmh", 250, "--json", "--quiet",
        "-o", out_dir,
    )  # fmt: skip
    summary = json.loads(out)
    assert (code, err) == (0, "")
    assert summary["speed_kmh"] == 250
    assert "criteria" not in summary
    assert summary["pantographs"][0]["name"] == "EN 50318:2002"
    assert {p.name for p in out_dir.iterdir()} == {
        "run.nc", "summary.json", "dropper_schedule.csv", "support_schedule.csv", "layout.png",
        "static_shape.png",
        "contact_force.png", "support_uplift.png", "dropper_forces.png", "energy.png", "layout.toml",
        "inputs.json",
    }  # fmt: skip
    written = json.loads((out_dir / "summary.json").read_text())
    assert written == summary


def test_run_prints_a_table(capsys, layout):
    code, out, _ = call(
        capsys, "run", layout, "--pantograph", "EN 50318:2002", "--pantograph-at", "30", "10",
        "--speed-kmh", 200, "--time-step-ms", 2, "--filter", "zero-phase", "--spans", "2,3",
    )  # fmt: skip
    assert code == 0
    assert "EN 50318:2002 (2)" in out
    assert "spans 2, 3, zero-phase 20 Hz filter" in " ".join(out.split())
    assert "standard deviation σ (N)" in out


PANTOGRAPH = ["--pantograph", "EN 50318:2002"]
SLOW = [*PANTOGRAPH, "--speed-kmh", 200, "--time-step-ms", 2]


def test_criteria_that_are_kept(capsys, layout, tmp_path, monkeypatch):
    """At 200 km/h 120 N suit DC 3 kV (98 to 149 N), not AC (79 to 109 N)."""
    out_dir = tmp_path / "out"
    options = ["--criteria", "dc 3 kv", "--elasticity", "--json", "--quiet", "-o", out_dir]
    code, out, err = call(capsys, "run", layout, *SLOW, *options)
    summary = json.loads(out)
    assert (code, err) == (0, "")
    assert {row["passed"] for row in summary["criteria"]} == {True, None}
    assert json.loads((out_dir / "summary.json").read_text()) == summary
    assert (out_dir / "criteria.png").stat().st_size > 10_000
    static = json.loads(call(capsys, "static", layout, "--json", "--quiet")[1])
    found = summary["elasticity_non_uniformity_percent"]
    assert summary["criteria"][-1]["value"] == found == pytest.approx(100 * static["non_uniformity"])
    monkeypatch.setattr("catenary_fe.studies.elasticity", None)  # what was computed is not computed again
    shown = "catenary_fe.views.report.report_page"
    monkeypatch.setattr(shown, lambda run, *_, **__: repr(100 * run.elasticity.non_uniformity))
    assert call(capsys, "report", out_dir)[0] == 0
    assert (out_dir / "report.html").read_text(encoding="utf-8") == repr(found)


def test_a_missed_criterion_is_exit_code_1(capsys, layout, tmp_path, monkeypatch):
    monkeypatch.setattr("catenary_fe.studies.elasticity", None)  # no limit judges it
    text = Path(layout).read_text().replace("stiffness = 300.0", "stiffness = 300.0\nuplift_room = 0.3")
    Path(layout).write_text(text)
    out_dir = tmp_path / "out"
    code, out, err = call(capsys, "run", layout, *SLOW, "--criteria", "AC", "-o", out_dir)
    assert code == 1
    assert "missed: mean force: 11" in err
    assert "must be at most 108.8 N" in err
    text = " ".join(out.split())
    for said in (
        "AC: 1 of 9 criteria missed: mean force",
        "missed",
        "passed",
        "(recalled)",
        "at most 300.0 mm",
    ):
        assert said in text
    written = json.loads((out_dir / "summary.json").read_text())
    assert [r["name"] for r in written["criteria"] if r["passed"] is False] == ["mean force"]
    assert (out_dir / "run.nc").exists()


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["info", "nowhere.toml"], 3, "nowhere.toml: no such layout file"),
        (["run", "LAYOUT", "--pantograph", "DSA381", "--speed-kmh", "300"], 3, "near names: 'DSA380'"),
        (["run", "LAYOUT", *PANTOGRAPH, "--speed-kmh", "83333"], 3, "looks like the wrong unit"),
        (["run", "LAYOUT", *PANTOGRAPH, "--speed-kmh", "-10"], 3, "must be above 0"),
        (["run", "LAYOUT", *PANTOGRAPH, "--speed-kmh", "nan"], 3, "must be above 0"),
        (["run", "LAYOUT", *PANTOGRAPH, "--speed-kmh", "fast"], 2, "not a valid float"),
        (
            ["run", "LAYOUT", *PANTOGRAPH, "--speed-kmh", "200", "--criteria", "AD"],
            2,
            "'--criteria': 'AD' is not one of",
        ),
        (["run", "LAYOUT", *PANTOGRAPH], 2, "Missing option '--speed-kmh'"),
        (["run", "LAYOUT", *PANTOGRAPH, "--speed-kmh", "200", "--time-step-ms", "0"], 3, "time step = 0 s: "),
        (["run", "LAYOUT", *PANTOGRAPH, "--speed-kmh", "200", "--element-m", "-1"], 3, "mesh: contact_wire"),
        (
            ["run", "LAYOUT", *PANTOGRAPH, "--pantograph-at", "110", "10", "--speed-kmh", "200"],
            3,
            "would end beyond the line",
        ),
        (["run", "LAYOUT", *PANTOGRAPH, "--speed-kmh", "200", "--element-m", "1e-6"], 3, "more than 200,000"),
        (["static", "LAYOUT", "--force", "0"], 3, "force = 0 N: must be above 0"),
        (["static", "LAYOUT", "--spans", "five"], 2, "not a list of spans or rising ranges"),
        (["static", "LAYOUT", "--spans", "9"], 3, "span 9: the line has spans 1 to 4"),
        (["form", "LAYOUT", "--spans", "2"], 2, "--spans chooses the spans that are drawn: give -o DIR"),
        (["info", "LAYOUT", "--spans", "4,5", "-o", "out"], 3, "the line has spans 1 to 4"),
        (["frobnicate"], 2, "No such command"),
        (["info"], 2, "Missing argument 'LAYOUT'"),
    ],
)
def test_bad_input(capsys, layout, tmp_path, arguments, code, said):
    target = tmp_path / "new" / "out"
    words = [layout if a == "LAYOUT" else a for a in arguments]
    if words[0] in ("run", "static"):
        words += ["-o", target]
    found, out, err = call(capsys, *words)
    assert (found, out) == (code, "")
    assert said in err
    assert "Traceback" not in err
    assert not target.parent.exists()


RUN = ("run", "LAYOUT", *PANTOGRAPH, "--speed-kmh", "200")
SWEEP = ("sweep", "LAYOUT", *PANTOGRAPH, "--speed-kmh", "200", "-o", "unused")
AT_ODDS = {  # options that would do nothing beside others, and what is said
    "shapes that nothing keeps": ((*RUN, "--store-wire-ms", "5"), 2, "has no effect without -o"),
    "a checkpoint of another method": (
        (*RUN, "--method", "linearised", "--checkpoint", "state"), 3, "only runs with the method"
    ),
    "an energy that is not there": ((*RUN, "--method", "linearised", "--energy"), 3, "do not record it"),
    "more positions than pantographs": (
        (*RUN, *PANTOGRAPH, "--pantograph-at", "15", "20", "30"), 3, "3 positions for 2 pantographs"
    ),
    "pantographs without positions": ((*RUN, *PANTOGRAPH), 3, "need their positions at the start"),
    "processes beside a cluster": ((*SWEEP, "--jobs", "2", "--scheduler", "x"), 2, "give one of them"),
    "no process": ((*SWEEP, "--jobs", "0"), 2, "0 is not in the range"),
    "rows at no interval": (("export", "FOLDER", "--every-ms", "nan"), 3, "--every-ms = nan ms: must be"),
    "rows between the steps": (("export", "FOLDER", "--every-ms", "0.4"), 3, "must be at least 1"),
}  # fmt: skip


@pytest.mark.parametrize("case", AT_ODDS)
def test_options_that_would_do_nothing_are_refused(capsys, layout, short_run, tmp_path, monkeypatch, case):
    monkeypatch.chdir(tmp_path)
    arguments, code, said = AT_ODDS[case]
    (tmp_path / "made").mkdir()
    short_run.save(tmp_path / "made" / "run.nc")
    places = {"LAYOUT": layout, "FOLDER": "made"}
    found, out, err = call(capsys, *(places.get(a, a) for a in arguments), "--quiet")
    assert (found, out) == (code, "")
    assert said in err
    assert [p.name for p in tmp_path.rglob("*") if p.name not in ("made", "run.nc", "layout.toml")] == []


def test_an_output_folder_that_cannot_be_made(capsys, layout, tmp_path):
    blocker = tmp_path / "file"
    blocker.write_text("here already")
    code, out, err = call(capsys, "form", layout, "-o", blocker / "out")
    assert (code, out) == (3, "")
    assert "output folder" in err
    assert "choose another folder" in err
    assert blocker.read_text() == "here already"


def test_other_files_in_the_output_folder_stay(capsys, layout, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "mine.txt").write_text("keep me")
    assert call(capsys, "form", layout, "--quiet", "-o", tmp_path / "out")[0] == 0
    assert (tmp_path / "out" / "mine.txt").read_text() == "keep me"
    assert (tmp_path / "out" / "form.json").exists()
    assert not [p for p in (tmp_path / "out").iterdir() if p.name.startswith(".part")]
    assert stat.S_ISREG((tmp_path / "out" / "form.json").stat().st_mode)


def test_an_output_folder_without_a_name(capsys, layout, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    before = sorted(tmp_path.iterdir())
    for arguments in (("form", layout), ("paper", "1")):
        code, out, err = call(capsys, *arguments, "-o", "")
        assert (code, out) == (3, "")
        assert "has no name" in err
    assert sorted(tmp_path.iterdir()) == before


def test_the_air_pushes_a_pantograph_down(capsys, layout, tmp_path):
    path = tmp_path / "down.toml"
    path.write_text(
        'name = "wing"\nuplift_force = 60.0\naerodynamic_force = { quadratic = -0.01 }\n'
        "stages = [{ mass = 7.0, stiffness = 50.0 }]"
    )
    code, out, err = call(capsys, "run", layout, "--pantograph", path, "--speed-kmh", 360)
    assert (code, out) == (3, "")
    assert "wing: uplift and aerodynamic force add up to -40 N at 360 km/h: must be above 0" in err


def test_many_equal_faults_are_cut_short(capsys, layout):
    path = Path(layout)
    path.write_text(path.read_text().replace("system_height = 1.2", "system_height = 0.3"))
    code, _, err = call(capsys, "form", layout)
    lines = err.splitlines()
    assert code == 3
    assert len(lines) == 21
    assert "span 1: dropper 2 at 10.5 m has no room" in lines[0]
    assert lines[-1] == "error: and 8 more faults like these"


def test_progress_without_a_terminal_is_a_line_now_and_then(capsys):
    say = progress_lines("run", every=0.0)
    for share in (0.25, 0.5, 1.0):
        say(share)
    lines = capsys.readouterr().err.splitlines()
    assert [line.split(" %")[0] for line in lines] == ["run: 25", "run: 50"]
    progress_lines("run")(0.5)
    assert capsys.readouterr().err == ""


def test_several_faults_are_several_lines(capsys, tmp_path, reference_layout):
    path = tmp_path / "bad.toml"
    text = reference_layout.read_text()
    path.write_text(text.replace("tension = 20e3", "tension = 0").replace("beta = 1e-4", "betta = 1e-4"))
    code, _, err = call(capsys, "info", path)
    lines = err.splitlines()
    assert code == 3
    assert len(lines) == 2
    assert all(line.startswith(f"error: {path}: ") for line in lines)


def test_schema(capsys):
    code, out, _ = call(capsys, "schema", "layout")
    assert code == 0
    assert json.loads(out)["title"] == "catenary_fe layout"


def test_help_names_all_commands(capsys):
    code, out, _ = call(capsys, "--help")
    assert code == 0
    for name in ("info", "form", "static", "run", "validate", "schema", "Exit codes"):
        assert name in out


def test_the_cause_is_said_before_the_error(capsys, layout):
    """A messenger wire that hardly anything pulls."""
    with open(layout) as file:
        text = file.read()
    with open(layout, "w") as file:
        file.write(text.replace("tension = 16e3", "tension = 1"))
    code, out, err = call(capsys, "form", layout)
    assert (code, out) == (3, "")
    warning, error, *_ = err.splitlines()
    assert "messenger_wire.tension = 1 N is below 1000 N: looks like kN" in warning
    assert error.startswith("error: span 1: dropper 1 at 5 m has no room")
    assert error.endswith("the messenger wire's tension of 1 N")


def test_kilonewtons_are_warned_of(capsys, layout):
    with open(layout) as file:
        text = file.read()
    with open(layout, "w") as file:
        file.write(text.replace("tension = 20e3", "tension = 20"))
    for command in ("info", "form"):
        _, _, err = call(capsys, command, layout)
        assert "warning: contact_wire.tension = 20 N is below 1000 N: looks like kN" in err


def test_a_dynamic_solver_failure_is_exit_code_4(capsys, layout, tmp_path):
    """A contact damper a thousand times too strong."""
    path = tmp_path / "stiff.toml"
    path.write_text(
        "uplift_force = 100.0\ncontact_damping = 1e5\nstages = [{ mass = 7.0, stiffness = 50.0 }]"
    )
    out_dir = tmp_path / "out"
    options = ["--pantograph", path, "--speed-kmh", 250, "--method", "exudyn"]
    code, out, err = call(capsys, "run", layout, *options, "-o", out_dir)
    assert (code, out) == (4, "")
    assert "no convergence after t = 0.00" in err
    assert "try a smaller time step" in err
    assert len(err.splitlines()) == 1
    assert not out_dir.exists()
