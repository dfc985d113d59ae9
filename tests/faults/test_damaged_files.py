"""Files that are missing, cut off, or have a bit turned: one clear line, never another result."""

import json
import random

import pytest

import catenary_fe as cf
from catenary_fe.results import files

COMMANDS = {
    "report": ["report", "FOLDER", "-o", "NEW.html"],
    "film": ["film", "FOLDER", "-o", "NEW.gif"],
    "waves": ["waves", "FOLDER", "-o", "NEW.png"],
    "export": ["export", "FOLDER", "-o", "NEW"],
    "rerun": ["rerun", "FOLDER", "-o", "NEW"],
    "compare": ["compare", "FOLDER", "FOLDER", "-o", "NEW"],
}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize(
    "damage", ["missing", "empty", "cut off", "a bit turned", "another file", "a folder"]
)
def test_every_command_refuses_a_damaged_run(call, folder, tmp_path, command, damage):
    file = folder / "run.nc"
    raw = file.read_bytes()
    file.unlink()
    if damage == "a folder":
        file.mkdir()
    elif damage != "missing":
        turned = bytearray(raw)
        turned[len(raw) * 2 // 3] ^= 4
        file.write_bytes(
            {
                "empty": b"",
                "cut off": raw[: len(raw) // 2],
                "a bit turned": turned,
                "another file": b"\x89PNG",
            }[damage]
        )
    place = {"FOLDER": str(folder), "NEW": str(tmp_path / "new")}
    words = [w.replace("NEW", place["NEW"]) if "NEW" in w else place.get(w, w) for w in COMMANDS[command]]
    code, out, err = call(*words)
    assert (code, out) == (3, "")
    assert len(err.splitlines()) == 1
    assert err.startswith("error: ")
    assert str(folder) in err
    assert not list(tmp_path.glob("new*"))


def test_no_turned_bit_is_read(finished, tmp_path):
    raw, whole = (finished / "run.nc").read_bytes(), cf.load_run(finished / "run.nc")
    chance = random.Random(8)
    refused = 0
    for trial in range(150):
        turned = bytearray(raw)
        # the head of the file, where one bit changes what the rest means, and then anywhere
        turned[chance.randrange(9000 if trial % 2 else len(raw))] ^= 1 << chance.randrange(8)
        (tmp_path / "run.nc").write_bytes(turned)
        try:
            run = cf.load_run(tmp_path / "run.nc")
        except cf.InputError as error:
            assert str(tmp_path / "run.nc") in str(error)
            refused += 1
        else:
            assert run.data.identical(whole.data)  # a byte that only fills a gap
    assert refused >= 140


@pytest.mark.parametrize("share", [0.0, 0.001, 0.01, 0.3, 0.999])
def test_no_cut_file_is_read(finished, tmp_path, share):
    raw = (finished / "run.nc").read_bytes()
    (tmp_path / "run.nc").write_bytes(raw[: int(share * len(raw))])
    with pytest.raises(cf.InputError, match=r"run\.nc: not a readable netCDF file .* run again"):
        cf.load_run(tmp_path / "run.nc")


@pytest.mark.parametrize("text", ["", '{"filter": "cau', "[1, 2]", "\udcff", "[" * 100_000])
def test_a_damaged_summary(call, folder, text):
    (folder / "summary.json").write_bytes(text.encode(errors="surrogateescape"))
    code, out, err = call("report", folder)
    assert (code, out) == (3, "")
    assert "summary.json: damaged: not" in err
    assert "remove it to go on without" in err
    assert len(err.splitlines()) == 1


def test_no_summary_is_no_fault(call, folder):
    (folder / "summary.json").unlink()
    assert call("report", folder)[0] == 0


@pytest.mark.parametrize("text", ["", "null", '{"files_sha256": [1]}', '{"files_sha'])
def test_damaged_records_of_the_inputs(call, folder, tmp_path, text):
    (folder / "inputs.json").write_text(text)
    code, out, err = call("rerun", folder, "-o", tmp_path / "again")
    assert (code, out) == (3, "")
    assert "inputs.json: damaged" in err
    assert not (tmp_path / "again").exists()


def test_a_turned_bit_in_the_layout_is_said(call, folder):
    raw = bytearray((folder / "layout.toml").read_bytes())
    raw[100] ^= 1
    (folder / "layout.toml").write_bytes(raw)
    code, _, err = call("rerun", folder)
    assert code == 0  # it is repeated from run.nc
    assert "layout.toml was changed since the run" in err


def test_a_file_that_was_changed_on_purpose(folder):
    import xarray as xr

    with xr.open_dataset(folder / "run.nc", engine="scipy") as opened:
        data = opened.load()
    data["contact_force"] += 1.0
    data.to_netcdf(folder / "run.nc", engine="scipy")
    with pytest.raises(cf.InputError, match="is to be written with"):
        cf.load_run(folder / "run.nc")
    cf.Run(data).save(folder / "run.nc")
    assert cf.load_run(folder / "run.nc").data["contact_force"].identical(data["contact_force"])


def test_a_write_that_fails_leaves_what_was_there(tmp_path):
    path = tmp_path / "a.txt"
    files.write_text(path, "whole")
    with pytest.raises(KeyboardInterrupt), files.atomic_write(path) as aside:
        aside.write_text("ha")
        raise KeyboardInterrupt
    with pytest.raises(cf.InputError, match=r"b\.txt: cannot be written: No such file"):
        files.write_text(tmp_path / "no" / "b.txt", "x")
    assert path.read_text() == "whole"
    assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]


def test_records_of_a_sweep_are_read_only_whole(tmp_path):
    from catenary_fe.studies.sweep_store import open_store

    with open_store(tmp_path) as store:
        store.write("k", {"summary": {"mean_N": 117.25, "none": None}})
        assert store.read("k") == {"summary": {"mean_N": 117.25, "none": None}}
        raw = (tmp_path / "k.json").read_bytes()
        for text in (raw[:40], raw.replace(b"117.25", b"117.26"), b"[]", b"3", json.dumps({"a": 1}).encode()):
            (tmp_path / "k.json").write_bytes(text)
            assert store.read("k") is None
        assert store.read("other") is None
