"""The same input gives the same bytes: in any process, whatever its hash seed, with any number of workers."""

import hashlib
import os
import subprocess
import sys

import pytest

from catenary_fe.cli import main

RUN = """
import sys
from catenary_fe.cli import main
sys.exit(main(sys.argv[1:]))
"""


@pytest.fixture(scope="module")
def layout(reference_layout, tmp_path_factory):
    text = reference_layout.read_text().replace("count = 10", "count = 3")
    path = tmp_path_factory.mktemp("same") / "line.toml"
    path.write_text(text.replace("evaluated_spans = [5, 6]", "evaluated_spans = [2]"))
    return path


def elsewhere(seed, *arguments):
    """Run the command in another process with this seed of Python's hashes."""
    environment = os.environ | {"PYTHONHASHSEED": seed}
    subprocess.run(
        [sys.executable, "-c", RUN, *map(str, arguments)], env=environment, check=True, capture_output=True
    )


def digests(folder, names):
    return {name: hashlib.sha256((folder / name).read_bytes()).hexdigest() for name in names}


@pytest.mark.parametrize("method", ["nonlinear", "linearised"])
def test_a_run_in_another_process(layout, tmp_path, method):
    arguments = ["run", layout, "--pantograph", "EN 50318:2002", "--pantograph", "DSA380",
                 "--pantograph-at", "30", "12", "--speed-kmh", "200", "--time-step-ms", "2",
                 "--method", method, "--quiet", "-o"]  # fmt: skip
    here, there = tmp_path / "here", tmp_path / "there"
    assert main([str(a) for a in [*arguments, here]]) == 0
    elsewhere("4294967295", *arguments, there)
    names = sorted(p.name for p in here.iterdir() if p.name not in ("summary.json", "inputs.json"))
    assert {"run.nc", "dropper_schedule.csv", "contact_force.png", "layout.toml"} <= set(names)
    assert digests(there, names) == digests(here, names)


@pytest.mark.parametrize("method", [pytest.param("nonlinear", marks=pytest.mark.slow), "linearised"])
def test_a_sweep_with_any_number_of_workers(layout, tmp_path, method):
    """Two catenaries at two speeds: the cases of a catenary share slots, and are split over the workers."""
    arguments = ["sweep", layout, "--speed-kmh", "190", "210", "--pantograph", "EN 50318:2002",
                 "--vary", "contact_wire.tension=19e3,21e3", "--time-step-ms", "2", "--method", method,
                 "--quiet"]  # fmt: skip
    names = ["sweep.csv", "contact_force.png", "standard_deviation.png", "support_uplift.png"]
    one, two = tmp_path / "one", tmp_path / "two"
    assert main([str(a) for a in [*arguments, "--jobs", "1", "-o", one]]) == 0
    elsewhere("7", *arguments, "--jobs", 2, "-o", two)
    assert digests(two, names) == digests(one, names)
