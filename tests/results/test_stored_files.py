"""Files that are whole or not there, folders with one writer, and checksums of what is stored."""

import errno
import os
import socket
import stat
import subprocess
import sys

import numpy as np
import pytest
import xarray as xr
from made_runs import made_run

import catenary_fe as cf
from catenary_fe.results import files
from catenary_fe.results.check import Partial
from catenary_fe.results.files import ATTRIBUTE, checksum


def test_a_file_is_not_there_before_it_is_whole(tmp_path):
    path = tmp_path / "a.txt"
    with files.atomic_write(str(path)) as aside:
        aside.write_text("whole")
        assert aside.parent == tmp_path
        assert aside.name.startswith(files.ASIDE)
        assert not path.exists()
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]
    assert path.read_text() == "whole"


def test_a_text_is_utf_8_anywhere(tmp_path):
    code = f"from catenary_fe.results.files import write_text; write_text({str(tmp_path / 'a')!r}, '\\u03b2')"
    environment = os.environ | {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)
    assert (tmp_path / "a").read_bytes() == "β".encode()


@pytest.mark.parametrize("number", [errno.ENOSPC, errno.EDQUOT, errno.EFBIG])
def test_a_full_disk_is_to_be_cleared(number):
    line = files.cannot_be_written("x", OSError(number, os.strerror(number)))
    assert (
        line
        == f"x: cannot be written: {os.strerror(number)}; free some space there, or choose another folder"
    )


def test_other_faults_of_writing():
    assert files.cannot_be_written("x", OSError(errno.EACCES, "Denied")) == (
        "x: cannot be written: Denied; choose another folder"
    )
    assert files.cannot_be_written("x", OSError("odd")) == "x: cannot be written: odd; choose another folder"


def test_all_files_of_a_folder_move_together(tmp_path):
    source, target = tmp_path / "a", tmp_path / "b"
    for folder in (source, target):
        folder.mkdir()
        (folder / "one").write_text(folder.name)
    (source / "two").write_text("a")
    (source / f"{files.ASIDE}7-three").write_text("half")
    (target / "other").write_text("b")
    files.replace_all(source, target)
    assert {p.name: p.read_text() for p in target.iterdir()} == {"one": "a", "two": "a", "other": "b"}
    assert [p.name for p in source.iterdir()] == [f"{files.ASIDE}7-three"]


def test_no_file_moves_where_one_cannot(tmp_path):
    source, target = tmp_path / "a", tmp_path / "b"
    source.mkdir()
    (target / "two").mkdir(parents=True)
    for name in ("one", "two"):
        (source / name).write_text(name)
    with pytest.raises(OSError, match="two there is a folder"):
        files.replace_all(source, target)
    assert {p.name for p in source.iterdir()} == {"one", "two"}
    assert not (target / "one").exists()


def test_a_folder_has_one_writer(tmp_path):
    """Of two takers in one process, too: the lock belongs to the open file."""
    with files.locked(tmp_path):
        lock = tmp_path / files.LOCK
        assert lock.read_text() == f"{os.getpid()} {socket.gethostname()}\n"
        assert stat.S_IMODE(lock.stat().st_mode) & 0o133 == 0  # nobody runs it, others do not write it
        with pytest.raises(cf.InputError) as caught, files.locked(tmp_path):
            pass
        assert str(caught.value) == (
            f"{tmp_path}: process {os.getpid()} is writing there; wait until it has ended,"
            " or choose another folder"
        )
        lock.write_text("no number and machine")
        with pytest.raises(cf.InputError, match=": another process is writing there"), files.locked(tmp_path):
            pass
        lock.write_text("12 elsewhere")
        with pytest.raises(cf.InputError, match=": process 12 on elsewhere is"), files.locked(tmp_path):
            pass
    assert not lock.exists()
    with files.locked(tmp_path):
        pass


def test_a_lock_that_was_left_behind_is_taken_over(tmp_path):
    """Longer than what replaces it, of a process that is no more."""
    (tmp_path / files.LOCK).write_text("123456789 some-other-machine-with-a-long-name-that-is-gone\n" * 3)
    with files.locked(tmp_path):
        assert (tmp_path / files.LOCK).read_text() == f"{os.getpid()} {socket.gethostname()}\n"


def test_a_lock_that_its_owner_removes_meanwhile_is_taken_once_more(tmp_path, monkeypatch):
    path, tried = tmp_path / files.LOCK, []

    def lock(descriptor, lock=files._lock):
        tried.append(descriptor)
        if len(tried) == 1:
            path.unlink()
        lock(descriptor)

    monkeypatch.setattr(files, "_lock", lock)
    with files.locked(tmp_path):
        assert path.exists()
    assert len(tried) == 2


def test_file_systems_without_locks_have_none(tmp_path, monkeypatch):
    def lock(descriptor):
        raise OSError(errno.ENOLCK, "no locks")

    monkeypatch.setattr(files, "_lock", lock)
    with files.locked(tmp_path), files.locked(tmp_path):
        pass


def test_a_lock_in_a_folder_that_is_not_there(tmp_path):
    with pytest.raises(cf.InputError, match="cannot be written: No such file"), files.locked(tmp_path / "no"):
        pass


def changes():
    """One after the other, each a dataset that differs from the first in one thing."""
    first = xr.Dataset(
        {"a": (("x", "y"), [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], {"units": "m"}), "n": ("x", [1, 2])},
        {"name": ("x", ["p", "q"])},
        {"title": "t", "count": 3},
    )
    yield first
    yield first.assign(a=first["a"] + 1e-15)
    yield first.assign(a=first["a"].astype(np.float32))
    yield first.assign(n=("x", [1, 3]))
    yield first.assign_coords(name=("x", ["p", "r"]))
    yield first.rename(a="b")
    yield first.rename(x="z")
    yield first.assign(a=(("x", "y"), np.reshape(first["a"].values, (2, 3)), {"units": "km"}))
    yield first.assign(a=(("x", "y"), first["a"].values.T.copy().reshape(2, 3), {"units": "m"}))
    yield first.assign_attrs(title="u")
    yield first.assign_attrs(count=4)
    yield first.assign_attrs(more="")
    yield first.drop_vars("n")


def test_a_checksum_is_of_all_there_is():
    sums = [checksum(data) for data in changes()]
    assert len(set(sums)) == len(sums)
    assert all(len(s) == 64 for s in sums)


def test_a_checksum_leaves_out_itself_and_how_values_are_stored():
    data = next(changes())
    same = data.assign_attrs({ATTRIBUTE: "0"})
    same["n"] = same["n"].astype(np.int32)
    same["a"] = (("x", "y"), np.asfortranarray(data["a"].values.astype(">f8")), {"units": "m"})
    assert checksum(same) == checksum(data)
    assert checksum(data.assign_attrs(count=np.int32(3))) == checksum(data)
    turned = data.copy()
    turned.attrs = dict(reversed(data.attrs.items()))
    assert checksum(turned) == checksum(data)


def test_a_checksum_is_the_same_after_reading(tmp_path):
    run = made_run()
    loaded = cf.load_run(run.save(tmp_path / "run.nc"))
    assert checksum(loaded.data) == checksum(run.data)


def test_what_a_partial_run_says():
    partial = Partial("the disk is full", 1.234, 5.0)
    assert partial.as_dict() == {"reason": "the disk is full", "reached_s": 1.234, "planned_s": 5.0}
    assert str(partial) == (
        "PARTIAL run: it ended after 1.23 of 5.00 s; spans that were not passed have no figures"
        " (the disk is full)"
    )
