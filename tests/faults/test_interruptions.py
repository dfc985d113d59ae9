"""Signals, and worker processes that die: a clean end, nothing finished lost, and on from there."""

import csv
import os
import signal
import subprocess

import pytest
from faults import PANTOGRAPH, content, wait_until

from catenary_fe.studies import sweep as sweeping
from catenary_fe.studies.sweep import SweepCase, SweepSettings, run_sweep

SWEEP = [
    "--pantograph",
    PANTOGRAPH,
    "--time-step-ms",
    "5",
    "--element-m",
    "4",
    "--method",
    "nonlinear",
    "--jobs",
    "2",
    "--quiet",
]


@pytest.mark.parametrize(
    ("number", "code"),
    [(signal.SIGINT, 130), pytest.param(signal.SIGTERM, 143, marks=pytest.mark.slow)],
)
def test_a_sweep_that_is_stopped_goes_on(call, start, layout, tmp_path, number, code):
    words = ["sweep", layout, *SWEEP, "-o", tmp_path, "--speed-kmh"]
    process = start(*words, "150:300:1")  # long enough to be hit on a busy machine, too
    wait_until(lambda: list(tmp_path.glob("cases/[!.]*.json")), process)
    if number == signal.SIGINT:
        os.killpg(process.pid, number)  # as Ctrl-C does
    else:
        process.send_signal(number)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (code, "")
    assert err.split("\n") == [
        f"stopped: finished cases are kept in {tmp_path}; start again to go on", "", "interrupted", "",
    ]  # fmt: skip
    kept = content(tmp_path)
    assert 1 <= len(kept) < 151
    assert all(name.endswith(".json") for name in kept)
    assert call(*words, 150, 160, 300)[0] == 0
    with (tmp_path / "sweep.csv").open() as file:
        assert [row["error"] for row in csv.DictReader(file)] == [""] * 3
    assert {name: raw for name, raw in content(tmp_path).items() if name in kept} == kept


def workers(process) -> list[int]:
    """Numbers of the processes that a process started to run cases."""
    found = subprocess.run(
        ["ps", "-o", "pid=,args=", "--ppid", str(process.pid)], capture_output=True, text=True, check=True
    )
    lines = [line.split(None, 1) for line in found.stdout.splitlines()]
    return [int(pid) for pid, arguments in lines if "popen_loky" in arguments]


@pytest.mark.slow
def test_a_killed_worker_costs_no_case(start, layout, tmp_path):
    process = start("sweep", layout, *SWEEP, "--speed-kmh", "200:300:4", "-o", tmp_path)
    wait_until(lambda: list(tmp_path.glob("cases/[!.]*.json")), process)
    os.kill(workers(process)[0], signal.SIGKILL)
    _, err = process.communicate(timeout=120)
    assert (process.returncode, err) == (0, "")
    with (tmp_path / "sweep.csv").open() as file:
        assert [row["error"] for row in csv.DictReader(file)] == [""] * 26


def deadly(numbers, cases, settings):
    """A task that ends its process at 240 km/h, as want of memory does."""
    if any(case.values["speed_kmh"] == 240 for case in cases):
        os.kill(os.getpid(), signal.SIGKILL)
    return numbers, [{"summary": {"speed": case.speed}} for case in cases]


@pytest.mark.parametrize("method", ["nonlinear", "linearised"])
def test_a_case_that_kills_its_worker_is_named(short, pantograph, tmp_path, monkeypatch, method):
    """Linearised cases run several to a task: the deadly one is told from its neighbours."""
    monkeypatch.setattr(sweeping, "_run_task", deadly)
    settings = SweepSettings(method=method)
    cases = [
        SweepCase(values={"speed_kmh": v}, catenary=short, pantographs=(pantograph,), speed=v / 3.6)
        for v in (200, 220, 240, 260, 280)
    ]
    records = run_sweep(cases, settings, tmp_path, jobs=2)
    assert ["error" in record for record in records] == [False, False, True, False, False]
    lost = records[2]
    assert (lost["lost"], lost["exit_code"]) == (True, 4)
    assert "the process that ran this case was killed, also when it ran alone" in lost["error"]
    assert len(list(tmp_path.glob("cases/*.json"))) == 4  # it is tried again at the next start
    monkeypatch.setattr(sweeping, "_run_task", lambda n, c, s: (n, [{"summary": {"again": len(c)}}]))
    again = run_sweep(cases, settings, tmp_path, jobs=1)
    assert [record["summary"] for record in again] == [
        *(record.get("summary", {"again": 1}) for record in records)
    ]


def test_a_lost_case_ends_a_sweep_with_4(call, layout, tmp_path, monkeypatch):
    monkeypatch.setattr(sweeping, "_spread", _loses_one)
    code, _, err = call("sweep", layout, *SWEEP, "--speed-kmh", "200", "220", "-o", tmp_path)
    assert code == 4
    assert "failed: speed_kmh = 220.0" in err
    assert f"lost with their processes: 1 of 2 cases; the others are kept in {tmp_path}: start again" in err
    assert len(list(tmp_path.glob("cases/*.json"))) == 1


def _loses_one(tasks, cases, settings, *_):
    yield sweeping._run_task(tasks[0], [cases[i] for i in tasks[0]], settings)
    yield tasks[1], [sweeping._lost()]
