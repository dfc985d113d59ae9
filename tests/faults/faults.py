"""What tests of faults share: a short run's options, waiting, looking at a folder."""

import os
import time
from pathlib import Path

PANTOGRAPH = "EN 50318:2002"
OPTIONS = ["--pantograph", PANTOGRAPH, "--speed-kmh", "200", "--time-step-ms", "4"]
LINEAR = [*OPTIONS, "--method", "linearised"]


def wait_until(true, process=None, seconds=60.0):
    """Wait for something that another process does."""
    deadline = time.monotonic() + seconds
    while not true():
        assert time.monotonic() < deadline, "it did not happen in time"
        assert process is None or process.poll() is None, process.communicate()
        time.sleep(0.02)


def content(folder: Path) -> dict[str, bytes]:
    """All files below a folder."""
    return {
        str(file.relative_to(folder)): file.read_bytes() for file in folder.rglob("*") if os.path.isfile(file)
    }
