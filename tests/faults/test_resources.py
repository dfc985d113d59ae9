"""Memory and disk are known before a run; what the machine has no room for is refused."""

import importlib
import subprocess
import sys

import pytest
from faults import LINEAR, OPTIONS

import catenary_fe as cf
from catenary_fe.studies import resources

SCRIPT = """
import pathlib, sys
from catenary_fe.cli.main import main
code = main(sys.argv[1:])
# not of getrusage, which counts what the process was forked from
peak = pathlib.Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]
print(code, 1024 * int(peak))
"""


def predicted(layout, options):
    """What a run of the command line takes, from the interface's own prediction."""
    found = []
    module = importlib.import_module("catenary_fe.studies.simulate")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "check_memory", lambda demand, _: found.append(demand) or stop())
        with pytest.raises(KeyboardInterrupt):
            simulate(layout, options)
    return found[0]


def stop():
    raise KeyboardInterrupt


def simulate(layout, options):
    given = dict(zip(options[::2], options[1::2], strict=True))
    cf.simulate(
        cf.find_form(cf.load_catenary(layout)),
        [cf.library.pantograph(given["--pantograph"])],
        speed=float(given["--speed-kmh"]) / 3.6,
        time=cf.TimeSettings(step=float(given["--time-step-ms"]) / 1e3),
        store_wire=float(given["--store-wire-ms"]) / 1e3 or None,
        method=given.get("--method", "nonlinear"),
    )


@pytest.mark.parametrize(
    "options",
    [
        [*OPTIONS, "--store-wire-ms", "4"],
        [*OPTIONS, "--method", "exudyn", "--store-wire-ms", "8"],
        [*LINEAR, "--store-wire-ms", "8"],
        pytest.param([*LINEAR[:-3], "0.05", *LINEAR[-2:], "--store-wire-ms", "0.05"], marks=pytest.mark.slow),
    ],
    ids=["nonlinear", "exudyn", "linearised", "large"],
)
def test_the_prediction_is_near_what_is_taken(layout, tmp_path, options):
    words = ["run", str(layout), *options, "--quiet", "-o", str(tmp_path / "run")]
    done = subprocess.run([sys.executable, "-c", SCRIPT, *words], capture_output=True, text=True, check=True)
    code, peak = map(float, done.stdout.split())
    assert code == 0
    demand = predicted(layout, options)
    assert (tmp_path / "run" / "run.nc").stat().st_size == pytest.approx(
        demand.output + 20e3, abs=15e3, rel=0.01
    )
    assert 0.8 * peak < demand.memory < 1.5 * peak


def test_what_has_no_room_is_refused_before_the_work(call, layout, tmp_path):
    """A microsecond's steps with all wires at each of them: some 250 GB."""
    options = [*LINEAR[:-3], "0.001", *LINEAR[-2:], "--store-wire-ms", "0.001"]
    text = layout.read_text().replace("count = 3", "count = 10")
    long = tmp_path / "long.toml"
    long.write_text(text.replace("evaluated_spans = [2]", "evaluated_spans = [6]"))
    code, out, err = call("run", long, *options, "-o", tmp_path / "run")
    assert (code, out) == (3, "")
    last = err.splitlines()[-1]
    assert last.startswith("error: run at 200 km/h: would take ")
    assert " of memory, and " in last
    assert last.endswith(
        " memory are free: store wires less often or not at all, take a larger time step or fewer spans"
    )
    assert not (tmp_path / "run").exists()


def test_a_sweep_takes_as_many_processes_as_fit(call, layout, tmp_path, monkeypatch):
    words = ["sweep", layout, "--speed-kmh", "200", "--pantograph", "EN 50318:2002", "--time-step-ms", "4",
             "-o", tmp_path]  # fmt: skip
    monkeypatch.setattr(resources, "free_memory", lambda: 0.9e9)
    need = resources.Demand(memory=0.39e9, output=1e6)
    assert [resources.workers_that_fit(need, most) for most in (1, 2, 8)] == [1, 2, 2]
    code, _, err = call(*words, "--jobs", "3")
    assert code == 3
    assert "sweep: would take 3 processes of 0.3" in err
    assert "0.9 GB of memory are free" in err
    assert "fewer processes (--jobs)" in err
    monkeypatch.setattr(resources, "free_memory", lambda: None)  # a system that does not say
    assert call(*words, "--jobs", "1")[0] == 0


def test_free_memory_is_that_of_machine_and_container(tmp_path):
    assert resources.free_memory() > 50e6
    assert resources._of_group(tmp_path) is None
    (tmp_path / "memory.current").write_text("300\n")
    (tmp_path / "memory.max").write_text("max\n")
    assert resources._of_group(tmp_path) is None
    (tmp_path / "memory.max").write_text("1000\n")
    assert resources._of_group(tmp_path) == 700
