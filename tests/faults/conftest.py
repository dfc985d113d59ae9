"""What faults need: a short line, a finished run, commands as processes of their own, a disk that is full."""

import os
import shutil
import signal
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import pytest
from faults import OPTIONS

from catenary_fe.cli import main


@pytest.fixture(scope="session")
def layout(reference_layout, tmp_path_factory) -> Path:
    """Three spans of the reference line."""
    text = reference_layout.read_text().replace("count = 10", "count = 3")
    path = tmp_path_factory.mktemp("layout") / "line.toml"
    path.write_text(text.replace("evaluated_spans = [5, 6]", "evaluated_spans = [2]"))
    return path


@pytest.fixture(scope="session")
def finished(layout, tmp_path_factory) -> Path:
    """The folder of a finished run; not to be written to."""
    folder = tmp_path_factory.mktemp("finished") / "run"
    assert main(["run", str(layout), *OPTIONS, "--method", "linearised", "--quiet", "-o", str(folder)]) == 0
    return folder


@pytest.fixture
def folder(finished, tmp_path) -> Path:
    """A copy of a finished run's folder, to be damaged."""
    return Path(shutil.copytree(finished, tmp_path / "run"))


@pytest.fixture
def call(capsys):
    """Call the command line in this process: exit code, what was printed, the one line of the error."""

    def called(*arguments):
        code = main([str(a) for a in arguments])
        out, err = capsys.readouterr()
        return code, out, err

    return called


@pytest.fixture
def start():
    """Start the command line as a process that leads a group of its own."""
    started = []

    def begun(*arguments):
        command = [sys.executable, "-m", "catenary_fe", *map(str, arguments)]
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        started.append(subprocess.Popen(command, start_new_session=True, **pipes))
        return started[-1]

    yield begun
    for process in started:  # and its workers, which would hold the pipes for minutes
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.communicate()


@pytest.fixture
def small_disk(tmp_path):
    """Mount a file system of a few kilobytes; skip where that is not allowed."""
    mounted = []

    def made(kilobytes: int, options: str = "") -> Path:
        place = tmp_path / f"disk{len(mounted)}"
        place.mkdir()
        command = ["mount", "-t", "tmpfs", "-o", f"size={kilobytes}k{options}", "tmpfs", str(place)]
        if not shutil.which("mount") or subprocess.run(command, capture_output=True).returncode:
            pytest.skip("a small file system cannot be mounted here: that takes an administrator")
        mounted.append(place)
        return place

    yield made
    for place in mounted:
        subprocess.run(["umount", "--lazy", str(place)], check=True)
