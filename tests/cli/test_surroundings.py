"""Where the program stands must not end it: streams of other encodings, no home, read-only folders."""

import io
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import catenary_fe
from catenary_fe.cli import surroundings
from catenary_fe.cli.folder import InputFiles, output_folder, save_picture
from catenary_fe.cli.terminal import print_json
from catenary_fe.layout import InputError
from catenary_fe.views import plot_layout

CASES = Path(__file__).parents[1] / "cases"
POLISH = CASES / "polish_name.toml"


def command(*arguments, **environment):
    """A command as a process of its own: exit code and the bytes that it wrote."""
    done = subprocess.run(
        [sys.executable, "-m", "catenary_fe", *map(str, arguments)],
        env=os.environ | environment, cwd=CASES, capture_output=True, check=False,
    )  # fmt: skip
    assert b"Traceback" not in done.stderr, done.stderr.decode()
    return done.returncode, done.stdout, done.stderr


@pytest.fixture
def prepared(monkeypatch):
    """A stream of an encoding, as a command finds it after its start."""

    def made(encoding):
        stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
        monkeypatch.setattr(sys, "stdout", stream)
        surroundings.prepare()
        return stream

    for name in ("MPLBACKEND", "MPLCONFIGDIR", "MATPLOTLIBRC"):
        monkeypatch.setenv(name, "x")  # to be put back
    return made


def test_a_name_outside_the_code_page_is_spelt():
    code, out, _ = command("info", POLISH, PYTHONIOENCODING="cp1252")
    assert (code, out.decode("cp1252").split("  ")[0]) == (0, "Lódz – Kraków")


def test_json_is_exact_on_every_code_page():
    code, out, _ = command("info", POLISH, "--json", PYTHONIOENCODING="cp1252")
    assert (code, json.loads(out)["name"]) == (0, "Łódź – Kraków")


@pytest.mark.parametrize(
    ("encoding", "written"),
    [
        ("utf-8", "σ ≤ 0.3 · 5 N, µ = ½, Łódź, Жд"),
        ("cp1252", "sigma <= 0.3 · 5 N, µ = ½, Lódz, ??"),
        ("cp437", "σ ≤ 0.3 · 5 N, µ = ½, Lódz, ??"),
        ("latin-1", "sigma <= 0.3 · 5 N, µ = ½, Lódz, ??"),
        ("ascii", "sigma <= 0.3 . 5 N, mu = 1/2, Lodz, ??"),
    ],
)
def test_every_encoding_can_be_written(prepared, encoding, written):
    stream = prepared(encoding)
    stream.write("σ ≤ 0.3 · 5 N, µ = ½, Łódź, Жд")
    stream.flush()
    assert stream.buffer.getvalue().decode(encoding) == written


BYTES = os.fsdecode(b"l\xf3d\xc5\xba")  # of a file's name, of which some are no UTF-8


def test_names_of_files_that_are_no_text(prepared, tmp_path):
    assert surroundings.readable(BYTES) == "l\ufffddź"
    stream = prepared("utf-8")
    print_json({"name": BYTES})
    stream.write(BYTES)
    stream.flush()
    *said, last = stream.buffer.getvalue().decode().splitlines()
    assert json.loads("".join(said))["name"] == BYTES
    assert last == "l?dź"
    with output_folder(str(tmp_path)) as folder:
        folder.json("a.json", {"name": BYTES})
        folder.table("a.csv", [{"name": BYTES}])
    assert json.loads((tmp_path / "a.json").read_text("utf-8"))["name"] == BYTES
    assert "l\\udcf3dź" in (tmp_path / "a.csv").read_text("utf-8")


def test_a_layout_from_a_pipe_cannot_be_kept(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    with pytest.raises(InputError, match="a run with -o keeps its layout, which a pipe has only once"):
        InputFiles.read(str(tmp_path / "pipe"), [])


def test_a_picture_that_cannot_be_written_says_so_once(short, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(InputError) as caught:
        save_picture(tmp_path / "file" / "a.png", plot_layout(short))
    assert str(caught.value).count("a.png") == 1


def test_what_cannot_be_said_does_not_change_the_exit_code():
    for device, code in (("2>/dev/full", 3), (">/dev/full 2>&1", 3)):
        line = f'"{sys.executable}" -m catenary_fe info nowhere.toml {device}'
        assert subprocess.run(["sh", "-c", line], check=False).returncode == code


def test_closed_streams_do_not_end_a_command():
    assert subprocess.run(
        ["sh", "-c", f'"{sys.executable}" -m catenary_fe info "{POLISH}" >&- 2>&-'], check=False
    ).returncode == 0  # fmt: skip


def test_a_backend_that_is_not_there_and_no_home(monkeypatch, prepared, tmp_path):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.delenv("MPLCONFIGDIR")
    monkeypatch.setenv("XDG_CACHE_HOME", os.devnull + "/nowhere")
    prepared("utf-8")
    assert "MPLBACKEND" not in os.environ
    assert Path(os.environ["MPLCONFIGDIR"]).parent.parent == tmp_path


@pytest.fixture(scope="module")
def read_only_copy(tmp_path_factory):
    """A copy of the package beside which nothing can be kept, not even by root: files stand in the way."""
    copy = tmp_path_factory.mktemp("installed")
    source = Path(catenary_fe.__file__).parent
    shutil.copytree(source, copy / "catenary_fe", ignore=shutil.ignore_patterns("__pycache__"))
    for folder in [f for f in (copy / "catenary_fe").rglob("*") if f.is_dir()]:
        (folder / "__pycache__").touch()
    return copy


def test_nowhere_to_keep_compiled_code(read_only_copy, tmp_path):
    nowhere = {name: os.devnull + "/home" for name in ("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME")}
    code, _, err = command(
        "static", CASES / "plain_line.toml", "--spans", "3", "--quiet",
        PYTHONPATH=str(read_only_copy), TMPDIR=str(tmp_path), **nowhere,
    )  # fmt: skip
    assert (code, err) == (0, b"")
    surroundings = os.environ | nowhere | {"PYTHONPATH": str(read_only_copy), "TMPDIR": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", "import catenary_fe; catenary_fe.simulate"],
        env=surroundings, cwd=CASES, capture_output=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stderr) == (0, b"")
    assert list(tmp_path.glob("catenary_fe-*/*"))  # where the compiled steps would go
