"""Samples and Sobol' indices against closed forms; studies that are stopped, split, or partly broken."""

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli.main import main
from catenary_fe.studies import sweep as sweeping
from catenary_fe.studies.sampling import exchanged, group_indices, two_cubes, unit_cube

LINE = """
name = "three spans"
contact_wire = { library = "AC-120 CuMg", tension = 20e3 }
messenger_wire = { library = "BzII 120", tension = 16e3 }
support = { messenger_stiffness = 500e3, steady_arm = { stiffness = 200.0, mass = 0.8 } }
damping = { beta = 1e-4 }
span = [{ length = 40.0, droppers = [10.0, 30.0], count = 3 }]
"""
HEAD = """
layout = "line.toml"
pantographs = ["EN 50318:2002"]
speed_kmh = [200]
"""
UPLIFT = '"pantograph.uplift_force" = { uniform = [100.0, 140.0] }\n'
COARSE = "--time-step-ms", "4", "--element-m", "4"
TABLES = "scatter.csv", "bands.csv", "force_band.csv", "scatter.json"


@pytest.fixture
def study(tmp_path):
    """Writes a study of three spans, and returns its path."""
    (tmp_path / "line.toml").write_text(LINE)

    def written(scatter, head=HEAD):
        path = tmp_path / "study.toml"
        path.write_text(f"{head}[scatter]\n{scatter}")
        return path

    return written


def ishigami(cube):
    x, y, z = np.pi * (2 * cube.T - 1)
    return np.sin(x) + 7 * np.sin(y) ** 2 + 0.1 * z**4 * np.sin(x)


def of_ishigami(groups, samples=2**12):
    a, b = two_cubes(samples, 3, 1)
    f_ab = np.array([[ishigami(mixed)] for mixed in exchanged(a, b, groups)])
    return group_indices(ishigami(a)[None], ishigami(b)[None], f_ab, 1)


def test_indices_of_the_ishigami_function():
    """Closed form: Ishigami and Homma 1990, a = 7, b = 0.1; of columns together, from their variances."""
    single = of_ishigami([slice(0, 1), slice(1, 2), slice(2, 3)])
    assert single.first[0] == pytest.approx([0.3139, 0.4424, 0.0], abs=0.02)
    assert single.total[0] == pytest.approx([0.5576, 0.4424, 0.2437], abs=0.02)
    pairs = of_ishigami([slice(0, 1), slice(1, 3)])
    assert pairs.first[0] == pytest.approx([0.3139, 0.4424], abs=0.02)
    assert pairs.total[0] == pytest.approx([0.5576, 0.6861], abs=0.02)
    low, high = single.total_range[:, 0]
    assert (low < single.total[0]).all() and (single.total[0] < high).all() and (high - low < 0.12).all()
    wrong = of_ishigami([slice(1, 2), slice(0, 1), slice(2, 3)])  # columns that are mistaken for others
    assert abs(wrong.first[0, 0] - 0.3139) > 0.1


def test_samples_that_failed_are_left_out_of_indices():
    a, b = two_cubes(64, 3, 1)
    f_ab = np.array([[ishigami(mixed)] for mixed in exchanged(a, b, [slice(0, 2), slice(2, 3)])])
    f_ab[1, 0, 5] = np.nan
    found = group_indices(ishigami(a)[None], ishigami(b)[None], f_ab, 1)
    assert found.samples == 32 and np.isfinite(found.total_range).all()


@pytest.mark.parametrize("sampling", ["latin-hypercube", "sobol"])
def test_each_column_is_evenly_filled(sampling):
    cube = unit_cube(sampling, 64, 5, 2)
    assert (np.sort((64 * cube).astype(int), axis=0) == np.arange(64)[:, None]).all()
    assert (cube == unit_cube(sampling, 64, 5, 2)).all() and (cube != unit_cube(sampling, 64, 5, 3)).any()


def test_a_figure_that_is_linear_has_the_moments_of_its_input(study, tmp_path):
    """The mean contact force follows the uplift force as a straight line: F = F₀ + s (U - U₀)."""
    found = cf.run_scatter(cf.load_study(study(UPLIFT)), samples=16, folder=tmp_path / "out", jobs=1)
    rows = [row for row in found.rows if row["sample"]]
    uplift, force = (np.array([r[k] for r in rows]) for k in ("pantograph.uplift_force", "mean_N"))
    slope, at_zero = np.polyfit(uplift, force, 1)
    assert force == pytest.approx(at_zero + slope * uplift, abs=0.05)
    band = next(b for b in found.bands if b["figure"] == "mean_N")
    assert band["mean"] == pytest.approx(at_zero + slope * 120.0, abs=0.3)
    exact = slope * 40 / np.sqrt(12)
    assert band["deviation"] == pytest.approx(exact, rel=0.05)
    assert band["deviation"] != pytest.approx(1.1 * exact, rel=0.05)
    assert band["low_5"] < band["median"] < band["high_95_at_least"] <= band["high_95"]
    assert band["nominal"] == pytest.approx(at_zero + slope * 120.0, abs=0.05)  # the uplift of the library


def test_the_force_band_is_that_of_single_runs(study, tmp_path):
    found = cf.run_scatter(cf.load_study(study(UPLIFT)), samples=3, folder=tmp_path / "out", jobs=1)
    (band,) = found.force
    shape = cf.find_form(cf.load_catenary(tmp_path / "line.toml"))
    head = cf.library.pantograph("EN 50318:2002")
    run = cf.simulate(shape, [head], speed=200 / 3.6, method="linearised")
    x, force = run.data["position"].values[0], run.filtered_contact_force()[0]
    assert band["x"][0] == 40.0 and band["x"][-1] == 80.0 and np.diff(band["x"]) == pytest.approx(0.5)
    assert band["nominal"] == pytest.approx(np.interp(band["x"], x, force), abs=0.005)
    assert (band["low_5"] <= band["high_95"]).all()


def test_shares_of_variance_of_a_linear_figure(study, tmp_path):
    """Two heads' values that act on the mean: the uplift all but alone, an arm's mass not at all."""
    scatter = UPLIFT + '"support.steady_arm.mass" = { uniform = [0.7, 0.9] }\n'
    found = cf.run_scatter(
        cf.load_study(study(scatter)), samples=8, folder=tmp_path / "out", sensitivity=True, jobs=1
    )
    assert found.cases == 1 + 8 * 4 and len(found.rows) == 9
    of_mean = {r["input"]: r for r in found.sensitivity if r["figure"] == "mean_N"}
    assert of_mean["pantograph.uplift_force"]["total_at_most"] > 0.9
    assert of_mean["support.steady_arm.mass"]["total_at_most"] < 0.01
    assert {r["figure"] for r in found.sensitivity} == {"std_N", "mean_N", "max_N", "max_support_uplift_mm"}


def command(path, out, *options):
    return main(["scatter", str(path), "--samples", "4", "-o", str(out), "--quiet", *COARSE, *options])


def contents(folder):
    return {name: (folder / name).read_bytes() for name in TABLES}


def test_the_same_bytes_with_one_and_two_processes_and_in_parts(study, tmp_path, monkeypatch):
    path = study(UPLIFT + '"as_built.dropper_length" = { normal = 0.002 }\n')
    assert command(path, tmp_path / "one", "--jobs", "1") == 0
    assert command(path, tmp_path / "two", "--jobs", "2") == 0
    # one case is lost as if the study had been killed before it: the others are kept
    assert command(path, tmp_path / "parts", "--jobs", "1") == 0
    lost = sorted((tmp_path / "parts" / "cases").glob("*.json"))[:2]
    for record in lost:
        record.unlink()
    ran = []
    task = sweeping._run_task
    monkeypatch.setattr(sweeping, "_run_task", lambda n, c, s: ran.append(len(c)) or task(n, c, s))
    assert command(path, tmp_path / "parts", "--jobs", "1") == 0
    assert sum(ran) == 2
    one = contents(tmp_path / "one")
    assert one == contents(tmp_path / "two") == contents(tmp_path / "parts")
    again = study(UPLIFT + '"as_built.dropper_length" = { normal = 0.002 }\n', HEAD + "seed = 2\n")
    assert command(again, tmp_path / "other", "--jobs", "1") == 0
    assert contents(tmp_path / "other") != one


def test_a_line_whose_runs_go_side_by_side_gives_the_same_bytes_in_parts(study, tmp_path, monkeypatch):
    """Five runs of one line share slots; what is left of them after a kill must, too."""
    path = study(UPLIFT)
    assert command(path, tmp_path / "whole", "--jobs", "1") == 0
    assert command(path, tmp_path / "parts", "--jobs", "2") == 0
    sorted((tmp_path / "parts" / "cases").glob("*.json"))[0].unlink()
    assert command(path, tmp_path / "parts", "--jobs", "1") == 0
    assert contents(tmp_path / "whole") == contents(tmp_path / "parts")


def test_a_killed_study_goes_on_to_the_same_table(study, tmp_path):
    path = study('"contact_wire.tension" = { relative_uniform = 0.05 }\n')
    arguments = [sys.executable, "-m", "catenary_fe", "scatter", str(path), "--samples", "5", "--jobs", "1",
                 "--quiet", *COARSE, "-o"]  # fmt: skip
    out = tmp_path / "killed"
    process = subprocess.Popen([*arguments, str(out)], stderr=subprocess.DEVNULL)
    for _ in range(600):
        if len(list((out / "cases").glob("*.json"))) >= 2 or process.poll() is not None:
            break
        time.sleep(0.1)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert not (out / "scatter.csv").exists() or os.name == "nt"
    assert main([*arguments[3:], str(out)]) == 0
    assert main([*arguments[3:], str(tmp_path / "whole")]) == 0
    assert contents(out) == contents(tmp_path / "whole")


def test_broken_samples_are_counted_and_said(study, tmp_path, capsys):
    """A dropper that may lie beyond its span."""
    path = study('"span.*.droppers.2" = { uniform = [30.0, 50.0] }\n')
    assert command(path, tmp_path / "out", "--jobs", "1") == 0
    summary = json.loads((tmp_path / "out" / "scatter.json").read_text())
    assert len(summary["failed"]) == 2 and "outside the 40" in summary["failed"][0]["error"]
    assert summary["bands"][0]["samples"] == 2
    assert "2 of 5 cases did not run and are left out" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("scatter", "options", "code", "said"),
    [
        ("", [], 3, "nothing scatters"),
        (UPLIFT, ["--samples", "6", "--sensitivity"], 3, "take 4 or 8 samples"),
        (UPLIFT, ["--samples", "6", "--sampling", "sobol"], 3, "take 4 or 8 samples"),
        (UPLIFT, ["--sensitivity", "--sampling", "latin-hypercube"], 3, "leave latin-hypercube out"),
        ('"span.*.pre_sag" = { relative_normal = 0.1 }', [], 3, "a share is nothing"),
        ('"contact_wire.tension" = { uniform = [-2.0, -1.0] }', [], 3, "none of 4 cases can be built"),
        ('"pantograph.uplift" = { uniform = [1.0, 2.0] }', [], 3, "no key 'uplift'"),
    ],
)  # fmt: skip
def test_bad_studies(study, tmp_path, capsys, scatter, options, code, said):
    assert command(study(scatter), tmp_path / "out", *options) == code
    assert said in capsys.readouterr().err


def test_conditions_scatter_and_are_those_of_single_runs(study, tmp_path):
    """Gusts by their seed, on a line in space; the same seed, the same run."""
    text = LINE + "spatial = true\nstagger = 0.2\n"
    (tmp_path / "line.toml").write_text(text)
    (tmp_path / "wind.toml").write_text(
        "wind = { speed = 15.0, gusts = { intensity = 0.2, length_scale = 80.0, duration = 30.0 } }"
    )
    path = study(
        '"conditions.wind.gusts.seed" = { integers = [1, 99] }\n', HEAD + 'conditions = "wind.toml"\n'
    )
    found = cf.run_scatter(cf.load_study(path), samples=2, folder=tmp_path / "out", jobs=1)
    assert not found.failed
    row = found.rows[1]
    windy = cf.load_conditions(tmp_path / "wind.toml")
    gusts = windy.wind.gusts.replace(seed=row["conditions.wind.gusts.seed"])
    shape = cf.find_form(cf.load_catenary(tmp_path / "line.toml"))
    for conditions, same in ((windy.replace(wind=windy.wind.replace(gusts=gusts)), True), (windy, False)):
        run = cf.simulate(shape, [cf.library.pantograph("EN 50318:2002")], speed=200 / 3.6,
                          method="linearised", conditions=conditions)  # fmt: skip
        assert (row["std_N"] == pytest.approx(run.contact_force_statistics()[0].std, rel=1e-6)) is same
