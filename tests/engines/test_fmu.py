"""The line for a co-simulation: cut below the head, in steps, with its state; and as an FMU elsewhere."""

import json
import subprocess
import sys
import zipfile

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.studies.fmu import CoupledCatenary, record_of, write_fmu

SPEED = 250 / 3.6
ONE = "pantograph[1]."


@pytest.fixture(scope="module")
def record(short, pantograph):
    return record_of(short, [pantograph], cut="head", speed=SPEED)


@pytest.fixture(scope="module")
def coupled(record, short_shape):
    """Makes one that has begun."""

    def make(of=record, begun=True):
        made = CoupledCatenary(of)
        made.__dict__["_shape"] = short_shape  # found once
        if begun:
            made.begin()
        return made

    return make


def frame_of(stage, uplift, step):
    """Steps of the mass below the head under a force that stays the same in each: exact."""
    from scipy.linalg import expm

    k, d, m = stage.stiffness, stage.damping, stage.mass
    exact = expm(step * np.array([[0, 1, 0], [-k / m, -d / m, 1 / m], [0, 0, 0]]))
    return lambda y, v, force: (exact @ [y, v, force + uplift])[:2]


def coupled_run(made, pantograph, step, steps, *, velocity):
    """Contact forces [N] where both parts go on at once, each with the other's values from before."""
    lower = pantograph.stages[1]
    go, time = frame_of(lower, pantograph.uplift_force, step), 0.0
    y, v, forces = made.values[ONE + "frame_height"], 0.0, []
    for n in range(steps):
        force = made.read()[ONE + "frame_force"]
        made.values |= {ONE + "frame_height": y, ONE + "frame_velocity": v if velocity else 0.0}
        y, v = go(y, v, force)
        made.step(time, step)
        time = step * (n + 1)
        forces.append(made.read()[ONE + "contact_force"])
    return np.array(forces)


def test_a_head_on_its_frame_stands_as_in_the_whole_pantograph(coupled, short_shape, pantograph):
    whole, made = cf.stepping(short_shape, [pantograph], speed=SPEED), coupled()
    found = made.read()
    assert found[ONE + "contact_force"] == pytest.approx(whole.contact_force[0], abs=1e-3)
    assert found[ONE + "frame_force"] == -found[ONE + "contact_force"]
    assert found[ONE + "head_height"] == pytest.approx(whole.heights[0][0], abs=1e-7)
    made.values[ONE + "frame_height"] += 0.01
    made.begin()
    assert made.read()[ONE + "contact_force"] > found[ONE + "contact_force"] + 10


def test_the_force_on_the_frame_is_that_of_the_spring_and_damper(coupled, pantograph):
    made, head = coupled(), pantograph.stages[0]
    start = made.values[ONE + "frame_height"]
    made.values[ONE + "frame_height"] = start + 0.004
    made.step(0.0, 0.004)
    found, session = made.read(), made._session
    stretch = found[ONE + "head_height"] - start - 0.004
    spring, rate = head.stiffness * stretch, session.velocities[0][0] - 0.004 / 0.004
    assert found[ONE + "frame_force"] == pytest.approx(spring + head.damping * rate, abs=1e-6)
    assert abs(head.damping * rate) > 1.0


@pytest.fixture(scope="module")
def misses(coupled, short_shape, pantograph):
    """[N] root mean squares of what couplings differ by from the whole pantograph, by step [ms] and way."""
    whole = cf.stepping(short_shape, [pantograph], speed=SPEED)
    forces = np.array([whole.step()[0] for _ in range(400)])

    def miss(k, velocity):
        found = coupled_run(coupled(), pantograph, 1e-3 * k, 400 // k, velocity=velocity)
        return float(np.sqrt(np.mean((found - forces[k - 1 :: k]) ** 2)))

    return {(k, velocity): miss(k, velocity) for k in (1, 2, 4) for velocity in (True, False)}


def test_a_co_simulation_comes_close_to_one_program(misses):
    """The error is of first order in the step, and a third where the frame's velocity is given.

    A force that stays for a step acts as a damper of −k dt/2 in the frame, a place that is a step old of
    another −k dt in the head.
    """
    assert misses[1, True] < 0.2
    for velocity in (True, False):
        assert misses[2, velocity] / misses[1, velocity] == pytest.approx(2, abs=0.2)
        assert misses[4, velocity] / misses[2, velocity] == pytest.approx(2, abs=0.4)
    for k in (1, 2, 4):
        assert misses[k, False] / misses[k, True] == pytest.approx(3, abs=0.4)


def test_a_state_is_gone_back_to(coupled):
    made = coupled()
    unmoved = made.state()
    for n in range(5):
        made.step(0.01 * n, 0.01)
    kept, before = made.state(), made.read()

    def go_on(of):
        of.values |= {ONE + "frame_height": 0.07, "speed": 60.0}
        of.step(0.05, 0.02)
        return of.state()

    after = go_on(made)
    assert after != kept
    made.restore(kept)
    assert made.state() == kept and made.read() == before
    assert go_on(made) == after
    other = coupled()
    other.restore(kept)
    assert go_on(other) == after
    made.restore(unmoved)
    assert made.state() == unmoved and made.read()[ONE + "position"] == pytest.approx(10)


def test_states_of_something_else_are_refused(short_shape, pantograph):
    session = cf.stepping(short_shape, [pantograph], speed=SPEED)
    with pytest.raises(cf.InputError, match="not a state of a session"):
        session.restore(b"nothing")
    other = cf.stepping(short_shape, [pantograph], speed=SPEED, positions=[12.0])
    with pytest.raises(cf.InputError, match="another line, start, time step"):
        session.restore(other.state())


def test_the_whole_pantograph_inside(short, short_shape, coupled, pantograph):
    record = record_of(short, [pantograph], cut="none", speed=SPEED)
    made, session = coupled(record), cf.stepping(short_shape, [pantograph], speed=SPEED)
    made.values[ONE + "uplift_force"] = 140.0
    session.step(10, uplift_force=140.0)
    made.step(0.0, 0.01)
    found = made.read()
    assert found[ONE + "contact_force"] == session.contact_force[0]
    assert found[ONE + "frame_height"] == session.heights[0][1]
    made.values[ONE + "base_height"] = 0.01
    made.step(0.01, 0.002)
    session.step(base_height=0.005), session.step(base_height=0.01)
    assert made.read()[ONE + "contact_force"] == session.contact_force[0]


def test_two_pantographs_have_names_of_their_own(short, pantograph):
    line = short.replace(evaluated_spans=(3,))
    made = CoupledCatenary(record_of(line, [pantograph] * 2, cut="head", speed=SPEED, positions=[60.0, 10.0]))
    assert list(made.inputs)[-1] == "pantograph[2].frame_velocity"
    made.begin()
    assert made.read()["pantograph[2].position"] == 10.0


@pytest.mark.parametrize(
    ("size", "time", "said"),
    [
        (0.0015, 0.0, "communication step of 0.0015 s: must be a whole number of time steps, 0.001 s each"),
        (0.0, 0.0, "must be a whole number"),
        (0.001, 0.5, "step from 0.5 s: it is 0 s here"),
    ],
)
def test_steps_that_cannot_be_are_refused(coupled, size, time, said):
    with pytest.raises(cf.InputError, match=said):
        coupled().step(time, size)


def test_what_cannot_be_cut_is_refused(short, pantograph, coupled):
    one = pantograph.replace(stages=pantograph.stages[:1])
    for given, cut, said in (
        (one, "head", "two stages or more"),
        (cf.ElasticPantograph(force=100.0), "none", "masses"),
        (pantograph, "wire", "must be one of head, none"),
    ):
        with pytest.raises(cf.InputError, match=said):
            record_of(short, [given], cut=cut, speed=SPEED)
    rocking = cf.Conditions(base={"height": [[0, 0.0], [10, 0.004]]})
    with pytest.raises(cf.InputError, match="base has no effect in an FMU"):
        record_of(short, [pantograph], cut="none", speed=SPEED, conditions=rocking)
    with pytest.raises(cf.InputError, match="has not begun"):
        coupled(begun=False).step(0.0, 0.001)


OTHER_PROGRAM = """
import ctypes, json, sys
import fmpy
from fmpy.fmi2 import FMU2Slave

path, folder = sys.argv[1:]
fmpy.extract(path, folder)
about = fmpy.read_model_description(path)
number = {v.name: v.valueReference for v in about.modelVariables}
outputs = [v.name for v in about.modelVariables if v.causality == "output"]
fmu = FMU2Slave(guid=about.guid, unzipDirectory=folder, instanceName="line",
                modelIdentifier=about.coSimulation.modelIdentifier)
fmu.instantiate()
fmu.setupExperiment(startTime=0.0, stopTime=1.0)
fmu.enterInitializationMode()
read = lambda: fmu.getReal([number[name] for name in outputs])
early = read()
fmu.exitInitializationMode()
found = {"outputs": outputs, "early": early, "start": read()}
for n in range(20):
    fmu.setReal([number["pantograph[1].frame_height"]], [0.058 + 1e-4 * n])
    fmu.doStep(2e-3 * n, 2e-3)
found["end"], kept = read(), fmu.getFMUState()
stored = fmu.serializeFMUState(kept)
fmu.doStep(0.04, 2e-3)
found["further"] = read()
for state in (kept, fmu.deSerializeFMUstate(stored)):
    fmu.setFMUState(state)
    assert read() == found["end"]
    fmu.doStep(0.04, 2e-3)
    assert read() == found["further"]
try:
    fmu.doStep(0.042, 1.5e-3)
except Exception as error:
    found["refused"] = str(error)
print(json.dumps(found))
"""


def test_the_fmu_in_another_program(record, coupled, tmp_path):
    """As fmpy runs it: the same numbers, states that are gone back to, a bad step refused."""
    pytest.importorskip("pythonfmu")
    pytest.importorskip("fmpy")
    path = tmp_path / "catenary.fmu"
    write_fmu(path, record)
    first = path.read_bytes()
    write_fmu(path, record)
    assert path.read_bytes() == first
    with zipfile.ZipFile(path) as file:
        described = file.read("modelDescription.xml").decode()
        everything = b"".join(file.read(name) for name in file.namelist() if name.startswith("resources/cat"))
    assert 'canSerializeFMUstate="true"' in described and 'stepSize="0.001"' in described
    assert str(tmp_path).encode() not in everything
    done = subprocess.run(
        [sys.executable, "-c", OTHER_PROGRAM, path, tmp_path / "unzipped"], capture_output=True, text=True
    )
    if "undefined symbol" in done.stderr or "cannot open shared object" in done.stderr:
        pytest.skip("the FMU's binary does not find a shared libpython here")
    assert done.returncode == 0, done.stdout + done.stderr
    found = json.loads(done.stdout.splitlines()[-1])
    made = coupled()
    assert found["early"] == found["start"] == [made.read()[name] for name in found["outputs"]]
    for n in range(20):
        made.values[ONE + "frame_height"] = 0.058 + 1e-4 * n
        made.step(2e-3 * n, 2e-3)
    assert found["end"] == pytest.approx([made.read()[name] for name in found["outputs"]], rel=1e-9)
    assert "discard" in found["refused"]


def test_another_time_step(short, pantograph, coupled):
    half = record_of(short, [pantograph], cut="head", speed=SPEED, time=TimeSettings(step=5e-4))
    made, usual = coupled(half), coupled()
    for each in (made, usual):
        each.step(0.0, 0.005)
    made.step(0.005, 0.0005)
    forces = [each.read()[ONE + "contact_force"] for each in (made, usual)]
    assert forces[0] == pytest.approx(forces[1], rel=0.05)
