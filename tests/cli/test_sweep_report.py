"""The page of a sweep: what it says of the cases, the runs that were kept, and what it refuses."""

import csv
import json
import re

import pytest

import catenary_fe as cf
from catenary_fe.cli.main import main
from catenary_fe.cli.verdicts import Verdict

COARSE = ["--time-step-ms", "2", "--element-m", "4", "--jobs", "1"]


@pytest.fixture(scope="module")
def layout(short, tmp_path_factory):
    path = tmp_path_factory.mktemp("line") / "line.toml"
    cf.save_catenary(short, path)
    return path


@pytest.fixture(scope="module")
def folder(layout, tmp_path_factory):
    out = tmp_path_factory.mktemp("sweep") / "out"
    code = main(
        ["sweep", str(layout), "--pantograph", "EN 50318:2002", "--speed-kmh", "180", "330", "--quiet",
         "--vary", "contact_wire.tension=20e3,-1", "--keep-runs", "--keep-force", "--criteria", "AC",
         *COARSE, "-o", str(out)]
    )  # fmt: skip
    assert code == 1
    return out


def test_the_page_says_of_each_case_what_its_row_and_its_record_say(folder):
    assert main(["report", str(folder), "--quiet"]) == 0
    page = (folder / "report.html").read_text(encoding="utf-8")
    made = json.loads((folder / "sweep.json").read_text(encoding="utf-8"))
    slow, broken, fast, _ = made["cases"]
    assert "contact_wire.tension" in broken["error"] and "Did not run: " in page
    missed = [row["name"] for row in fast["criteria"] if row["passed"] is False]
    assert "standard deviation" in missed
    assert [row["name"] for row in slow["criteria"] if row["passed"] is False] == ["mean force"]
    assert f'class="missed">{len(missed)} missed' in page
    with (folder / "sweep.csv").open(encoding="utf-8") as file:
        sigma = float(next(csv.DictReader(file))["std_N"])
    assert f'<td class="number">{sigma:.1f}</td>' in page
    assert all(words in page for words in made["said"])
    headings = ["Verdicts", "Contact force", "Standard deviation", "Uplift at the supports"]
    found = re.findall(r"<h2>(.*?)</h2>", page)
    assert found == [*headings, "Contact force along the line", "Cases"]


def test_a_kept_run_is_the_run_and_has_its_own_page(folder):
    main(["report", str(folder), "--quiet"])
    made = json.loads((folder / "sweep.json").read_text(encoding="utf-8"))
    slow = made["cases"][0]
    assert [case["run"] for case in made["cases"]] == ["runs/0001", None, "runs/0003", None]
    assert 'href="runs/0001/report.html"' in (folder / "report.html").read_text(encoding="utf-8")
    run = cf.load_run(folder / slow["run"])
    assert run.contact_force_statistics()[0].std == pytest.approx(slow["rows"][0]["std_N"], rel=1e-9)
    page = (folder / slow["run"] / "report.html").read_text(encoding="utf-8")
    assert "180 km/h" in page


def test_a_run_that_is_gone_is_run_again(folder, layout):
    kept = {file: file.stat().st_mtime_ns for file in (folder / "cases").glob("*.nc")}
    gone = min(kept)
    gone.unlink()
    code = main(
        ["sweep", str(layout), "--pantograph", "EN 50318:2002", "--speed-kmh", "180", "330", "--quiet",
         "--vary", "contact_wire.tension=20e3", "--keep-runs", "--keep-force", *COARSE, "-o", str(folder)]
    )  # fmt: skip
    assert code == 0 and gone.is_file()
    assert all(file.stat().st_mtime_ns == before for file, before in kept.items() if file != gone)


def test_a_damaged_record_and_options_of_single_runs_are_refused(folder, tmp_path, capsys):
    assert main(["report", str(folder), "--criteria", "AC"]) == 2
    assert "a sweep has its own" in capsys.readouterr().err
    (tmp_path / "sweep.json").write_text('{"title": "x"}')
    assert main(["report", str(tmp_path)]) == 3
    assert "sweep.json: damaged, or of another version" in capsys.readouterr().err


def test_a_limit_without_any_margin_can_be_written():
    """No share of it is a number: JSON would refuse it, and the sweep end in a traceback."""
    row = cf.Criterion(name="mean force", unit="N", source="", value=-1.0, relation="at least", limit=60.0)
    assert row.used == float("inf")
    made = Verdict({"speed_kmh": 200.0}, criteria=[row]).as_dict()
    json.dumps(made, allow_nan=False)
    assert made["criteria"][0]["used"] > 1
