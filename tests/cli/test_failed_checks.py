"""A result that fails a check says so wherever it is shown."""

import csv
import html
import json

import pytest

import catenary_fe as cf
from catenary_fe import views
from catenary_fe.cli import main
from catenary_fe.cli.verdicts import Verdict, in_words
from catenary_fe.views.comparison import plot_force_comparison, plot_uplift_comparison

FAILED = "end reflection"  # a slow train on three spans


@pytest.fixture(scope="module")
def layout(reference_layout, tmp_path_factory):
    text = reference_layout.read_text().replace("count = 10", "count = 3")
    path = tmp_path_factory.mktemp("failed") / "line.toml"
    path.write_text(text.replace("evaluated_spans = [5, 6]", "evaluated_spans = [2]"))
    return path


def call(capsys, *arguments):
    code = main([str(a) for a in arguments])
    return code, *capsys.readouterr()


@pytest.fixture(scope="module")
def folders(layout):
    base = layout.parent
    for speed in (60, 80):
        arguments = ["run", layout, "--pantograph", "EN 50318:2002", "--speed-kmh", speed, "--method",
                     "linearised", "--time-step-ms", "2", "--quiet", "-o", base / str(speed)]  # fmt: skip
        assert main([str(a) for a in arguments]) == 0
    return base / "60", base / "80"


def test_summary_and_terminal(capsys, layout, folders):
    summary = json.loads((folders[0] / "summary.json").read_text())
    assert summary["checks_failed"] == [FAILED]
    assert [c["name"] for c in summary["checks"] if not c["passed"]] == [FAILED]
    arguments = ["run", layout, "--pantograph", "EN 50318:2002", "--speed-kmh", "60", "--method",
                 "linearised", "--time-step-ms", "2"]  # fmt: skip
    code, out, err = call(capsys, *arguments)
    assert code == 0
    assert f"1 of {len(summary['checks'])} checks failed: {FAILED}" in out
    (row,) = [line for line in out.splitlines() if f"│ {FAILED} " in line]
    assert "at most 10 %" in row and "failed" in row
    assert f"warning: check failed: {FAILED} = " in err
    code, out, _ = call(capsys, *arguments, "--json")
    assert json.loads(out)["checks_failed"] == [FAILED]


def test_report_shows_all_checks(capsys, folders):
    assert call(capsys, "report", folders[0], "--quiet")[0] == 0
    page = html.unescape((folders[0] / "report.html").read_text())
    run = cf.load_run(folders[0] / "run.nc")
    for check in run.checks:
        kind = "met" if check.passed else "missed"
        cells = [check.name, check.value_text, check.bound_text]
        row = "".join(f"<td>{cell}</td>" for cell in cells) + f'<td class="{kind}">{check.verdict}</td>'
        assert row in page, check.name


def test_comparison(capsys, folders, tmp_path):
    code, out, err = call(capsys, "compare", *folders, "-o", tmp_path / "both")
    assert code == 0
    assert f"warning: 60: check failed: {FAILED} = " in err
    (row,) = [line for line in out.splitlines() if " checks failed " in line]
    assert [cell.strip() for cell in row.split("│")][2:4] == ["1", "1"]
    result = json.loads((tmp_path / "both" / "comparison.json").read_text())
    assert [r["checks_failed"] for r in result["runs"]] == [1, 1]
    assert any(text.startswith(f"80: check failed: {FAILED}") for text in result["warnings"])
    page = html.unescape((tmp_path / "both" / "comparison.html").read_text())
    assert f'<p class="warning">60: check failed: {FAILED} = ' in page


def test_sweep_table(capsys, layout, tmp_path):
    """115 N are too much for AC at 60 km/h, not at 250 km/h; cases are run once, whatever judges them."""
    arguments = ["sweep", layout, "--speed-kmh", "60", "250", "--pantograph", "EN 50318:2002",
                 "--time-step-ms", "2", "-o", tmp_path / "sweep"]  # fmt: skip
    code, out, err = call(capsys, *arguments, "--criteria", "ac")
    assert code == 1
    words = " ".join(out.split())
    assert f"checks failed in 1 of 2 cases: {FAILED} in 1" in words
    assert "criteria of AC missed in 1 of 2 cases: mean force in 1" in words
    assert "warnings in 2 of 2 cases" in words
    assert "missed: criteria of AC in 1 of 2 cases: mean force in 1" in err
    assert "warning: 2 of 2 cases: the start at 10 m is only" in err
    with (tmp_path / "sweep" / "sweep.csv").open() as file:
        slow, fast = csv.DictReader(file)
    assert (slow["checks_failed"], slow["criteria_missed"]) == (FAILED, "mean force")
    assert slow["warnings"] == "1"
    assert FAILED not in fast["checks_failed"]
    assert fast["criteria_missed"] == ""
    with (tmp_path / "sweep" / "remarks.csv").open() as file:
        remarks = [(row["speed_kmh"], row["kind"], row["text"]) for row in csv.DictReader(file)]
    assert [kind for speed, kind, _ in remarks if speed == "60"] == [
        "check failed", "criterion missed", "warning"
    ]  # fmt: skip
    assert "must be at most 91.7 N" in remarks[1][2]
    begin = sorted((tmp_path / "sweep" / "cases").iterdir())
    code, out, err = call(capsys, *arguments, "--criteria", "DC 3 kV")
    assert (code, "missed: criteria of DC 3 kV in 2 of 2 cases: mean force in 2" in err) == (1, True)
    with (tmp_path / "sweep" / "sweep.csv").open() as file:
        assert [row["criteria_missed"] for row in csv.DictReader(file)] == ["mean force"] * 2
    code, out, _ = call(capsys, *arguments)
    assert (code, "criteria" in out) == (0, False)
    assert sorted((tmp_path / "sweep" / "cases").iterdir()) == begin


def test_a_sweep_in_words():
    def row(name, passed):
        return cf.Criterion(name=name, value=1.0, limit=2.0 if passed else 0.5, unit="N", source="")

    good = Verdict({}, [row("σ", True)])
    bad = Verdict({}, [row("σ", False), row("speed", False)], {"start transient": "start transient = 30 %"})
    warned = Verdict({}, [row("σ", False)], {}, ["short line", "short line"])
    broken = Verdict({}, error="no line")
    assert in_words([good, good], "AC") == [
        "all checks passed", "all criteria of AC with a known limit met", "no warning"
    ]  # fmt: skip
    assert in_words([good, bad, warned, broken], "AC") == [
        "1 of 4 cases did not run",
        "checks failed in 1 of 3 cases: start transient in 1",
        "criteria of AC missed in 2 of 3 cases: σ in 2, speed in 1",
        "warnings in 1 of 3 cases",
    ]
    assert in_words([broken], "AC") == ["1 of 1 cases did not run"]
    assert len(in_words([good], None)) == 2


def test_pictures(folders):
    runs = [cf.load_run(folder / "run.nc") for folder in folders]
    said = f"checks failed: {FAILED}"
    drawings = [
        runs[0].plot_contact_force(),
        runs[0].plot_support_uplift(),
        runs[0].plot_dropper_forces(),
        runs[0].plot_waves(),
        views.plot_force_spectrum(runs[0]),
    ]
    for ax in drawings:
        assert ax.get_title(loc="left").splitlines()[1] == said
    for ax in (plot_force_comparison(runs, "ab"), plot_uplift_comparison(runs, "ab")):
        assert f"checks failed by a: {FAILED}\nchecks failed by b: {FAILED}" in ax.get_title(loc="left")
    rows = [
        {"speed_kmh": v, "mean_N": 1.0, "std_N": 1.0, "max_support_uplift_mm": 1.0, "checks_failed": said}
        for v, said in ((60.0, FAILED), (80.0, ""))
    ]
    for ax in (
        views.plot_sweep_deviation(rows, "speed_kmh"),
        views.plot_sweep_uplift(rows, "speed_kmh"),
    ):
        assert ax.get_title(loc="left").endswith(f"checks failed in 1 of 2 rows: {FAILED}")


def test_a_good_run_is_not_accused(short_run):
    assert short_run.failed_checks == ()
    assert "\n" not in short_run.plot_contact_force().get_title(loc="left")
