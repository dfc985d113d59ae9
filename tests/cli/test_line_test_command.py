"""``compare`` with a table of measurements in place of a second run."""

import csv
import json

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli import main


@pytest.fixture(scope="module")
def folder(tmp_path_factory, reference, pantograph):
    """A run of ten spans, four of them evaluated."""
    shape = cf.find_form(reference.replace(evaluated_spans=(4, 5, 6, 7)))
    place = tmp_path_factory.mktemp("runs") / "run"
    place.mkdir()
    cf.simulate(shape, [pantograph], speed=250 / 3.6, method="linearised").save(place / "run.nc")
    return place


def table(folder, path, header="chainage [km];force [N]", factor=1.0, offset=0.0):
    """The run's force every 0.3 m, with noise, 12 km further on."""
    run = cf.load_run(folder)
    x = np.arange(20.0, 580.0, 0.3)
    force = np.interp(x, run.data["position"].values[0], run.data["contact_force"].values[0])
    force = force.mean() + factor * (force - force.mean()) + offset
    force += np.random.default_rng(1).normal(0, 3, x.size)
    np.savetxt(path, np.column_stack([x / 1e3 + 12, force]), "%.5f", ";", header=header, comments="")
    return path


def call(capsys, *arguments):
    code = main(["compare", *map(str, arguments)])
    return code, *capsys.readouterr()


def test_a_run_beside_what_was_measured(capsys, folder, tmp_path):
    measured = table(folder, tmp_path / "m.csv")
    code, out, err = call(capsys, folder, measured, "--json", "-o", tmp_path / "out")
    result = json.loads(out)
    assert code == 0
    assert err == ""
    (one,) = result["passes"]
    assert one["shift_m"] == pytest.approx(-12_000, abs=0.3)
    assert one["correlation"] > 0.98
    assert (result["compared_from_m"], result["compared_to_m"]) == (180, 420)
    assert [row["passed"] for row in result["criteria"]] == [True, True]
    assert [row["span"] for row in result["spans"]] == [4, 5, 6, 7]
    own = cf.load_run(folder).contact_force_statistics()[0]
    assert result["run"]["std_N"] == pytest.approx(own.std)
    assert result["all_passes"]["std_N"] == pytest.approx(own.std, rel=0.03)
    assert {p.name for p in (tmp_path / "out").iterdir()} == {
        "line_test.json", "line_test.csv", "line_test.png", "line_test.html",
    }  # fmt: skip
    assert json.loads((tmp_path / "out" / "line_test.json").read_text()) == result
    rows = list(csv.DictReader((tmp_path / "out" / "line_test.csv").open()))
    assert [(row["of"], row["span"]) for row in rows[:4]] == [
        ("run", ""), ("measured", ""), ("run", "4"), ("all passes", "4"),
    ]  # fmt: skip
    page = (tmp_path / "out" / "line_test.html").read_text()
    assert "Deviations: all 2 criteria with a known limit met." in page
    assert page.count("data:image/svg+xml;base64,") == 1
    assert "recalled" in page and "shift -1" in page


@pytest.mark.parametrize(
    ("changes", "missed"),
    [({"factor": 1.3}, ["standard deviation"]), ({"offset": 5.0}, ["mean force"]),
     ({"factor": 1.3, "offset": -5.0}, ["mean force", "standard deviation"])],
)  # fmt: skip
def test_a_miss_is_exit_code_1(capsys, folder, tmp_path, changes, missed):
    code, out, err = call(
        capsys, folder, table(folder, tmp_path / "m.csv", **changes), "-o", tmp_path / "out"
    )
    assert code == 1
    lines = [line for line in err.splitlines() if line.startswith("missed: ")]
    assert [line.split("deviation of the ")[1].split(":")[0] for line in lines] == missed
    assert "EN 50318:2018, line tests" in out and "recalled" in out
    page = (tmp_path / "out" / "line_test.html").read_text()
    assert f"{len(missed)} of 2 criteria missed" in page


def test_what_was_assumed_is_said(capsys, folder, tmp_path):
    code, out, err = call(capsys, folder, table(folder, tmp_path / "m.csv"))
    assert code == 0
    for text in (
        "taken is the run's, 250 km/h", "compared: 240.0 m of the 240 m that the run evaluates",
        "measured: shift -1", "22 spans or more than 1000 m (recalled)",
    ):  # fmt: skip
        assert text in err
    assert "span by span" in out and "correlation" in out
    assert call(capsys, folder, tmp_path / "m.csv", "--quiet")[1] == ""


def test_options(capsys, folder, tmp_path):
    measured = table(folder, tmp_path / "m.csv", header="way;CH7")
    arguments = ("--map", "position[km]=way", "--map", "force[N]=CH7", "--json")
    code, out, _ = call(capsys, folder, measured, *arguments, "--shift-m", "-12000")
    assert code == 0 and json.loads(out)["passes"][0]["shift_m"] == -12_000
    code, out, _ = call(capsys, folder, measured, *arguments, "--measured-speed-kmh", "200")
    result = json.loads(out)
    assert result["passes"][0]["speed_kmh"] == pytest.approx(200, rel=1e-4)
    assert any("measured at 200.0 km/h, the run is at 250.0 km/h" in w for w in result["warnings"])
    assert json.loads(call(capsys, folder, measured, *arguments, "--filter", "zero-phase")[1])["filter"] == (
        "zero-phase"
    )
    plain = json.loads(call(capsys, folder, measured, *arguments)[1])["passes"][0]
    unfiltered = json.loads(call(capsys, folder, measured, *arguments, "--measured-filtered")[1])["passes"][0]
    assert unfiltered["std_N"] > 1.05 * plain["std_N"]
    (tmp_path / "u.csv").write_text("uplift [mm]\n1\n2\n")
    code, out, _ = call(capsys, folder, tmp_path / "u.csv", "--support", "5", "--json")
    assert code == 1 and json.loads(out)["supports"][0]["measured_uplift_mm"] == 2


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["RUN", "RUN", "--shift-m", "3"], "--shift-m: is of a line test, and no table"),
        (["RUN", "RUN", "--map", "force=a"], "--map: is of a line test, and no table"),
        (["RUN", "RUN", "--support", "3"], "--support: is of a line test, and no table"),
        (["RUN", "RUN", "--pantograph", "1"], "--pantograph: is of a line test, and no table"),
        (["RUN", "RUN", "--measured-filtered"], "--measured-filtered: is of a line test, and no table"),
        (
            ["RUN", "RUN", "--measured-speed-kmh", "3"],
            "--measured-speed-kmh: is of a line test, and no table",
        ),
        (["RUN", "RUN", "TABLE"], "2 runs and 1 table of measurements: give one run, and tables of it"),
        (["TABLE"], "0 runs and 1 table of measurements: give one run"),
        (["RUN", "TABLE", "--pantograph", "2"], "--pantograph = 2: must be a whole number from 1 to 1"),
        (["RUN", "TABLE", "--support", "2"], "support = 2: no file has an uplift without a support"),
        (["RUN", "TABLE", "--map", "force"], "--map force: must be QUANTITY=HEADING, such as"),
        (["RUN", "TABLE", "--map", "force[N]=CH7"], "--map force[N]=CH7: no such column"),
        (["RUN", "TABLE", "--measured-speed-kmh", "-1"], "--measured-speed-kmh = -1 km/h: must be above 0"),
        (["RUN", "TABLE", "--measured-speed-kmh", "30"], "27.8 samples a second (0.3 m apart)"),
        (
            ["RUN", "TABLE", "--shift-m", "0"],
            "less than a span to compare: the run is evaluated from 180 to 420",
        ),
        (["RUN", "TABLE", "--shift-m", "nan"], "shift = nan m: must be a finite number"),
        (["RUN", "missing.csv"], "missing.csv: no such table file; check the name and the folder"),
    ],
)
def test_bad_questions_are_one_line(capsys, folder, tmp_path, arguments, said):
    measured = table(folder, tmp_path / "m.csv")
    places = {"RUN": str(folder), "TABLE": str(measured)}
    code, out, err = call(capsys, *(places.get(word, word) for word in arguments), "-o", tmp_path / "out")
    assert (code, out) == (3, "")
    assert said in err
    assert len(err.splitlines()) == 1
    assert not (tmp_path / "out").exists()


def test_failed_checks_of_the_run_are_warned_of(capsys, folder, tmp_path):
    run = cf.load_run(folder)
    data = run.data.copy(deep=True)
    data["dropper_force"][:] = 0.0
    (tmp_path / "bad").mkdir()
    cf.Run(data).save(tmp_path / "bad" / "run.nc")
    _, _, err = call(capsys, tmp_path / "bad", table(folder, tmp_path / "m.csv"), "-o", tmp_path / "out")
    assert "run: check failed: slack droppers" in err
    assert "check failed: slack droppers" in (tmp_path / "out" / "line_test.html").read_text()
