"""Disks that are full or read-only, names that are taken, and two processes in one folder."""

import os
import shutil
import signal
import subprocess
import sys

import pytest
from faults import LINEAR, OPTIONS, content, wait_until

import catenary_fe as cf
from catenary_fe.results import files


@pytest.mark.parametrize("room", ["nothing", "half of the run", "the run"])
def test_a_full_disk_keeps_what_is_there(call, small_disk, layout, finished, room):
    whole = (finished / "run.nc").stat().st_size // 1024
    disk = small_disk({"nothing": 16, "half of the run": whole // 2, "the run": whole + 100}[room])
    (disk / "notes.txt").write_text("mine")
    code, out, err = call("run", layout, *LINEAR, "-o", disk / "run")
    assert (code, out) == (3, "")
    assert err.splitlines()[-1].endswith(
        "No space left on device; free some space there, or choose another folder"
    )
    assert (disk / "notes.txt").read_text() == "mine"
    left = content(disk)
    assert not [name for name in left if ".part-" in name or ".lock" in name]
    if room == "the run":  # which is safe, while its pictures are not
        assert cf.load_run(disk / "run" / "run.nc").data.identical(cf.load_run(finished / "run.nc").data)
        assert not [
            name for name in left if name.endswith(".png") and not left[name].endswith(b"IEND\xaeB`\x82")
        ]
    else:
        assert list(left) == ["notes.txt"]


def test_a_full_disk_leaves_the_run_before(call, small_disk, layout, finished):
    before = content(finished)
    disk = small_disk(sum(len(raw) // 4096 * 4 + 8 for raw in before.values()))
    for name, raw in before.items():
        (disk / name).write_bytes(raw)
    code, _, err = call("run", layout, *LINEAR, "-o", disk)
    assert code == 3
    assert "No space left on device" in err
    assert content(disk) == before


@pytest.mark.parametrize(
    "words",
    [["report", "FOLDER", "-o", "DISK/a.html"], ["film", "FOLDER", "-o", "DISK/a.gif"],
     ["film", "FOLDER", "-o", "DISK/a.mp4"], ["waves", "FOLDER", "-o", "DISK/a.png"],
     ["export", "FOLDER", "-o", "DISK/csv"], ["compare", "FOLDER", "FOLDER", "-o", "DISK/new"],
     ["form", "LAYOUT", "-o", "DISK/new"]],
    ids=lambda words: words[-1].rpartition("/")[2] + "_of_" + words[0],
)  # fmt: skip
def test_no_half_file_on_a_full_disk(call, small_disk, finished, layout, words):
    disk = small_disk(16)
    given = {"FOLDER": finished, "LAYOUT": layout}
    code, _, err = call(*(given.get(w, w.replace("DISK", str(disk))) for w in words))
    assert code == 3
    assert "cannot be written" in err
    assert len(err.splitlines()) == 1
    assert not content(disk)


def test_a_sweep_on_a_full_disk_goes_on_when_there_is_room(call, small_disk, layout, tmp_path):
    disk = small_disk(16)
    words = ["sweep", layout, "--speed-kmh", "200:250:10", "--pantograph", "EN 50318:2002", "--jobs", "1",
             "--time-step-ms", "4", "--quiet"]  # fmt: skip
    code, _, err = call(*words, "-o", disk)
    assert code == 3
    assert "No space left on device" in err
    kept = content(disk)
    assert 0 < len(kept) < 6
    assert all(name.endswith(".json") for name in kept)
    roomy = tmp_path / "roomy"
    shutil.copytree(disk, roomy)
    assert call(*words, "-o", roomy)[0] == 0
    assert len(list((roomy / "cases").glob("*.json"))) == 6
    assert {name: raw for name, raw in content(roomy).items() if name in kept} == kept


def test_a_full_disk_behind_standard_output(layout):
    if not os.path.exists("/dev/full"):
        pytest.skip("/dev/full is not there")
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-m", "catenary_fe", "info", str(layout), "--json"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 3
    assert done.stderr == "error: output: No space left on device\n"


def test_a_read_only_folder(call, small_disk, layout, finished):
    disk = small_disk(2000)
    subprocess.run(["mount", "-o", "remount,ro", str(disk)], check=True)
    for words in (
        ["run", layout, *LINEAR, "-o", disk],
        ["run", layout, *LINEAR, "-o", disk / "new"],
        ["sweep", layout, "--speed-kmh", "200", "--pantograph", "EN 50318:2002", "-o", disk],
        ["report", finished, "-o", disk / "r.html"],
        ["export", finished, "-o", disk],
    ):
        code, _, err = call(*words)
        assert code == 3
        assert "cannot be written: Read-only file system; choose another folder" in err
        assert len(err.splitlines()) == 1


def test_names_that_are_taken(call, folder, layout, tmp_path):
    before = content(folder)
    for name in ("run.nc", "summary.json"):
        other = tmp_path / f"taken_{name}"
        (other / name).mkdir(parents=True)
        code, _, err = call("run", layout, *LINEAR, "-o", other)
        assert code == 3
        assert f"cannot be written: {name} there is a folder" in err
        assert not content(other)
    code, _, err = call("run", layout, *LINEAR, "-o", folder / "run.nc")
    assert code == 3
    assert "File exists" in err or "Not a directory" in err
    assert content(folder) == before


def test_two_runs_into_one_folder(call, start, layout, tmp_path):
    first = start(
        "run", layout, *OPTIONS, "--time-step-ms", "0.5", "--method", "exudyn", "-o", tmp_path / "run"
    )
    wait_until(lambda: (tmp_path / "run" / ".lock").exists(), first)
    os.kill(first.pid, signal.SIGSTOP)
    code, _, err = call("run", layout, *LINEAR, "-o", tmp_path / "run")
    assert code == 3
    assert f"run: process {first.pid} is writing there; wait until it has ended, or choose another" in err
    os.kill(first.pid, signal.SIGKILL)  # which keeps nobody out
    first.wait()
    assert list((tmp_path / "run").glob(".part-*"))
    assert call("run", layout, *LINEAR, "-o", tmp_path / "run")[0] == 0
    assert {".lock", "run.nc"} & set(content(tmp_path / "run")) == {"run.nc"}
    assert not list((tmp_path / "run").glob(".part-*"))


def test_two_sweeps_into_one_folder(call, layout, tmp_path):
    (tmp_path / "cases").mkdir()
    words = ["sweep", layout, "--speed-kmh", "200", "--pantograph", "EN 50318:2002", "-o", tmp_path]
    with files.locked(tmp_path / "cases"):
        code, _, err = call(*words)
    assert code == 3
    assert f"cases: process {os.getpid()} is writing there" in err
