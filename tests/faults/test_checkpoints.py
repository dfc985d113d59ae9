"""A run that is killed goes on from its checkpoint, with the same bytes."""

import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.engines import checkpoint

pytest.importorskip("numba")

RUN = """
import sys, time, catenary_fe as cf
from catenary_fe.engines import checkpoint
checkpoint.INTERVAL = 0.0
line = cf.load_catenary({layout!r})
line = line.replace(spans=line.spans[:3], supports=line.supports[:4], evaluated_spans=(2,))
head = cf.library.pantograph("EN 50318:2018 AC")
slowly = lambda share: time.sleep({pause})
cf.simulate(cf.find_form(line), [head], speed=80.0, store_wire=0.02, progress=slowly, checkpoint={file!r})
"""


@pytest.fixture(scope="module")
def line(reference):
    return reference.replace(spans=reference.spans[:3], supports=reference.supports[:4], evaluated_spans=(2,))


@pytest.fixture(scope="module")
def shape(line):
    return cf.find_form(line)


@pytest.fixture
def always(monkeypatch):
    monkeypatch.setattr(checkpoint, "INTERVAL", 0.0)


HEAD = "EN 50318:2018 AC"  # asks for a mean force: its uplift is found by runs before, and kept


def test_a_killed_run_goes_on_with_the_same_bytes(reference_layout, shape, tmp_path, always):
    file = tmp_path / "state.npz"
    code = RUN.format(layout=str(reference_layout), file=str(file), pause=0.05)
    process = subprocess.Popen([sys.executable, "-c", code])
    give_up = time.monotonic() + 120
    while not file.exists():  # in the run after those that found its uplift
        assert process.poll() is None and time.monotonic() < give_up
        time.sleep(0.02)
    process.send_signal(signal.SIGKILL)
    process.wait()
    assert 0 < read(file)["state_11"][0] < 1500  # steps
    run = {"speed": 80.0, "store_wire": 0.02}
    head = cf.library.pantograph(HEAD)
    seen = []
    on = cf.simulate(shape, [head], checkpoint=file, progress=seen.append, **run)
    whole = cf.simulate(shape, [head], **run)
    assert seen[0] > 0.04  # it did not begin anew
    for name, values in whole.data.variables.items():
        assert np.array_equal(values, on.data[name], equal_nan=values.dtype.kind == "f"), name
    assert not file.exists()


def read(file):
    with np.load(file) as arrays:
        return dict(arrays)


def test_checkpoints_of_other_runs_and_damaged_ones_are_refused(shape, line, pantograph, tmp_path, always):
    file = tmp_path / "state.npz"

    def stop(share):
        if share > 0.2:
            raise KeyboardInterrupt

    with pytest.raises(cf.RunInterrupted):
        cf.simulate(shape, [pantograph], speed=80.0, checkpoint=file, progress=stop)
    with pytest.raises(cf.InputError, match=r"checkpoint of another run \(other speed\): remove it"):
        cf.simulate(shape, [pantograph], speed=70.0, checkpoint=file)
    wire = line.contact_wire
    other = cf.find_form(line.replace(contact_wire=wire.replace(tension=1.01 * wire.tension)))
    with pytest.raises(cf.InputError, match=r"checkpoint of another run \(other layout\)"):
        cf.simulate(other, [pantograph], speed=80.0, checkpoint=file)
    whole = file.read_bytes()
    for damaged in (whole[: len(whole) // 2], b"", b"no archive"):
        file.write_bytes(damaged)
        with pytest.raises(cf.InputError, match="not a whole checkpoint: remove it"):
            cf.simulate(shape, [pantograph], speed=80.0, checkpoint=file)


def test_a_place_that_cannot_be_written_is_refused_before_the_run(shape, pantograph, tmp_path):
    with pytest.raises(cf.InputError, match=r"checkpoint .*nowhere.*: cannot be written: .*; choose another"):
        cf.simulate(shape, [pantograph], speed=80.0, checkpoint=tmp_path / "nowhere" / "state.npz")


@pytest.mark.parametrize("method", ["linearised", "exudyn"])
def test_other_methods_keep_none(shape, pantograph, tmp_path, method):
    with pytest.raises(cf.InputError, match="only runs with the method nonlinear keep one"):
        cf.simulate(shape, [pantograph], speed=80.0, method=method, checkpoint=tmp_path / "state.npz")
