"""Sweeps: every combination once, resumable, failures recorded, the same on a cluster."""

import csv
import logging
import os
import signal
import subprocess
import sys
import time
from dataclasses import replace

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.cli.main import main
from catenary_fe.studies import sweep as sweeping
from catenary_fe.studies.sweep import BrokenCase, SweepCase, SweepSettings, run_sweep

SHORT = ("count = 10", "count = 4"), ("evaluated_spans = [5, 6]", "evaluated_spans = [3]")


@pytest.fixture
def layout(reference_layout, tmp_path):
    text = reference_layout.read_text(encoding="utf-8")
    for long, short in SHORT:
        assert long in text
        text = text.replace(long, short)
    path = tmp_path / "short.toml"
    path.write_text(text, encoding="utf-8")
    return path


def table(folder):
    with (folder / "sweep.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def cases_of(short, pantograph, speeds=(200, 240, 280)):
    return [
        SweepCase(values={"speed_kmh": v}, catenary=short, pantographs=(pantograph,), speed=v / 3.6)
        for v in speeds
    ]


def test_cases_agree_with_single_runs(short, short_shape, pantograph, tmp_path):
    records = run_sweep(cases_of(short, pantograph), SweepSettings(), tmp_path, jobs=1)
    assert [r["values"]["speed_kmh"] for r in records] == [200, 240, 280]
    run = cf.simulate(short_shape, [pantograph], speed=240 / 3.6, method="linearised")
    ours = records[1]["summary"]["pantographs"][0]
    assert ours["std_N"] == pytest.approx(run.contact_force_statistics()[0].std, rel=1e-6)


def test_finished_cases_are_not_run_again(short, pantograph, tmp_path, monkeypatch):
    settings = SweepSettings()
    first = run_sweep(cases_of(short, pantograph, (200, 240)), settings, tmp_path, jobs=1)
    (tmp_path / "cases" / "0000.part").write_text("torn")  # a killed writer's remains
    ran = []
    task = sweeping._run_task
    monkeypatch.setattr(
        sweeping, "_run_task", lambda numbers, cases, s: ran.append(len(cases)) or task(numbers, cases, s)
    )
    second = run_sweep(cases_of(short, pantograph, (200, 240, 280)), settings, tmp_path, jobs=1)
    assert ran == [1]
    assert second[:2] == first
    run_sweep(cases_of(short, pantograph, (200,)), SweepSettings(filter="zero-phase"), tmp_path, jobs=1)
    assert ran == [1, 1]  # another filter is another case


def test_failures_are_recorded_case_by_case(short, pantograph, tmp_path):
    good = cases_of(short, pantograph, (200,))
    fast = SweepCase(values={"v": 900}, catenary=short, pantographs=(pantograph,), speed=250.0)
    sagging = short.replace(spans=(short.spans[0].replace(pre_sag=5.0), *short.spans[1:]))
    pushed = SweepCase(values={"sag": 5}, catenary=sagging, pantographs=(pantograph,), speed=60.0)
    broken = BrokenCase(values={"x": 1}, error=cf.InputError("x is no value"))
    records = run_sweep([*good, fast, pushed, broken], SweepSettings(), tmp_path, jobs=1)
    assert "summary" in records[0]
    assert "wrong unit" in records[1]["error"]
    assert "would have to push" in records[2]["error"]
    assert records[3]["error"] == "x is no value"


def test_a_sweep_leaves_the_log_as_it_was(short, pantograph, tmp_path):
    """Its warnings are in the records; a run after it says its own again."""
    logger = logging.getLogger("catenary_fe")
    before = logger.level
    fault = cf.InputError("broken")
    case = SweepCase(values={}, catenary=short, pantographs=(pantograph,), speed=-1.0)
    run_sweep([case, BrokenCase(values={}, error=fault)], SweepSettings(), tmp_path, jobs=1)
    assert logger.level == before


def test_the_command_runs_all_combinations(layout, tmp_path, capsys):
    out = tmp_path / "out"
    arguments = ["sweep", str(layout), "--speed-kmh", "200:240:20", "260", "--pantograph", "EN 50318:2002"]
    vary = [
        "--vary",
        "contact_wire.tension=20e3:24e3:2",
        "dropper.stiffness=100e3",
        "-o",
        str(out),
        "--jobs",
        "1",
    ]
    assert main([*arguments, *vary]) == 0
    rows = table(out)
    assert len(rows) == 8
    assert {(r["speed_kmh"], r["contact_wire.tension [N]"]) for r in rows} == {
        (v, t) for v in ("200", "220", "240", "260") for t in ("20000", "24000")
    }
    assert all(not r["error"] and float(r["std_N"]) > 0 for r in rows)
    for name in ("contact_force", "standard_deviation", "support_uplift"):
        assert (out / f"{name}.png").stat().st_size > 10_000
    assert "σ N" in capsys.readouterr().out


def test_impossible_values_are_rows_with_an_error(layout, tmp_path, capsys):
    out = tmp_path / "out"
    code = main(
        ["sweep", str(layout), "--speed-kmh", "200", "--pantograph", "EN 50318:2002", "--vary",
         "span.1.length=54,60", "-o", str(out), "--jobs", "1"]
    )  # fmt: skip
    assert code == 0
    bad, good = table(out)
    assert "lies outside the 54.0 m span" in bad["error"].replace("54 m", "54.0 m")
    assert not good["error"]
    assert "failed: " in capsys.readouterr().err


@pytest.mark.parametrize(
    ("options", "code", "said"),
    [
        (["--speed-kmh", "300:200:10"], 2, "rising"),
        (["--speed-kmh", "fast"], 2, "not a number"),
        (["--vary", "contact_wire.tension"], 2, "must be PLACE=first:last:count"),
        (["--vary", "contact_wires.tension=1:2:2"], 3, "did you mean 'contact_wire'"),
        (["--vary", "span.9.length=60"], 3, "not a number from 1 to 1"),
        (["--vary", "contact_wire.tensoin=1:2:2"], 3, "tensoin"),
        (["--vary", "pantograph.uplift_force=-1:-2:2"], 3, "uplift_force"),
        (["--scheduler", "tcp://127.0.0.1:9"], 3, "no Dask cluster answers"),
    ],
)
def test_bad_questions(layout, tmp_path, capsys, options, code, said, monkeypatch):
    given = ["sweep", str(layout), "--pantograph", "EN 50318:2002", "-o", str(tmp_path / "out"), "--quiet"]
    speed = [] if "--speed-kmh" in options else ["--speed-kmh", "200"]
    assert main([*given, *speed, *options]) == code
    assert said in capsys.readouterr().err


@pytest.mark.slow
def test_a_killed_sweep_goes_on_to_the_same_table(layout, tmp_path):
    command = [
        sys.executable, "-m", "catenary_fe", "sweep", str(layout), "--speed-kmh", "180:300:20",
        "--pantograph", "EN 50318:2002", "DSA380", "--vary", "contact_wire.tension=20e3:22e3:3",
        "--jobs", "2", "--quiet", "-o",
    ]  # fmt: skip
    killed, whole = tmp_path / "killed", tmp_path / "whole"
    process = subprocess.Popen([*command, str(killed)], start_new_session=True)
    deadline = time.monotonic() + 300
    while len(list((killed / "cases").glob("*.json"))) < 8 and time.monotonic() < deadline:
        time.sleep(0.05)
    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    kept = {path: path.stat().st_mtime_ns for path in (killed / "cases").glob("*.json")}
    assert 8 <= len(kept) < 42
    assert not (killed / "sweep.csv").exists()
    for folder in (killed, whole):
        subprocess.run([*command, str(folder)], check=True, timeout=600)
    assert (killed / "sweep.csv").read_bytes() == (whole / "sweep.csv").read_bytes()
    assert all(path.stat().st_mtime_ns == when for path, when in kept.items())


@pytest.mark.slow
def test_a_cluster_gives_the_same_records(short, pantograph, tmp_path):
    distributed = pytest.importorskip("distributed")
    cases = cases_of(short, pantograph, (180, 200, 220, 240))
    here = run_sweep(cases, SweepSettings(), tmp_path / "here", jobs=1)
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    ) as cluster:
        there = run_sweep(cases, SweepSettings(), tmp_path / "there", scheduler=cluster.scheduler_address)
    assert there == here


def test_conditions_of_a_sweep_are_those_of_single_runs(short, short_shape, pantograph, tmp_path):
    ice = cf.Conditions(ice=cf.Ice(load=5.0))
    (case,) = cases_of(short, pantograph, (240,))
    cases = [case, replace(case, conditions=ice)]
    assert cases[0].key(SweepSettings()) != cases[1].key(SweepSettings())
    records = run_sweep(cases, SweepSettings(keep_force=True), tmp_path, jobs=1)
    run = cf.simulate(short_shape, [pantograph], speed=240 / 3.6, method="linearised", conditions=ice)
    still, iced = (r["summary"]["pantographs"][0]["std_N"] for r in records)
    assert iced == pytest.approx(run.contact_force_statistics()[0].std, rel=1e-6)
    assert still != pytest.approx(iced, rel=1e-3)
    force = records[1]["force"]
    x, filtered = run.data["position"].values[0], run.filtered_contact_force()[0]
    assert force["values"][0] == pytest.approx(np.interp(force["x"], x, filtered), abs=0.006)
    assert (force["x"][0], force["x"][-1]) == (120.0, 180.0)


def test_the_command_varies_conditions_and_writes_forces(layout, tmp_path):
    out = tmp_path / "out"
    code = main(
        ["sweep", str(layout), "--speed-kmh", "200", "--pantograph", "EN 50318:2002", "--vary",
         "conditions.temperature=-20,40", "--keep-force", "-o", str(out), "--jobs", "1"]
    )  # fmt: skip
    assert code == 0
    assert [row["conditions.temperature [°C]"] for row in table(out)] == ["-20", "40"]
    with (out / "force.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 2 * 121 and rows[1]["position_m"] == "120.500"


def test_distances_and_directions_are_axes(layout, tmp_path, capsys):
    """The rear pantograph starts where one alone does; from the other end a line is its mirror image."""
    text = layout.read_text().replace("droppers = [5.0, 10.5,", "droppers = [6.0, 10.5,")
    layout.write_text(text)
    command = ["sweep", str(layout), "--pantograph", "EN 50318:2002", "--speed-kmh", "200",
               "--distance-m", "30", "50", "--direction", "forward", "backward", "--time-step-ms", "2",
               "--element-m", "4", "--quiet", "-o", str(tmp_path / "out")]  # fmt: skip
    assert main(command) == 0
    rows = table(tmp_path / "out")
    assert [(r["distance_m"], r["direction"], r["number"]) for r in rows] == [
        (d, way, n) for d in ("30.000", "50.000") for way in ("forward", "backward") for n in ("1", "2")
    ]
    line, settings = cf.load_catenary(layout).mirrored(), cf.MeshSettings(contact_wire_element=4.0)
    head = cf.library.pantograph("EN 50318:2002")
    run = cf.simulate(
        cf.find_form(line, settings), [head] * 2, speed=200 / 3.6, positions=[60.0, 10.0],
        method="linearised", time=cf.TimeSettings(step=2e-3),
    )  # fmt: skip
    sigma = [s.std for s in run.contact_force_statistics()]
    assert [float(r["std_N"]) for r in rows[6:]] == pytest.approx(sigma, abs=0.051)
    assert float(rows[4]["std_N"]) != pytest.approx(sigma[0], abs=0.051)
    assert main([*command, "--pantograph-at", "40", "10"]) == 2
    assert "give one position at most" in capsys.readouterr().err
