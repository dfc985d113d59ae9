"""Bases of pantographs that move up and down: through spring and damper of the lowest stage."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

import catenary_fe as cf
from catenary_fe.engines import checkpoint
from catenary_fe.studies.rerun import rerun
from tests.conftest import LAYOUTS
from tests.engines.test_irregularity import stiff_rail

SPEED, HEIGHT = 50.0, 2e-3
HEAD = cf.Pantograph(
    name="two masses",
    stages=[
        cf.Stage(mass=7.0, stiffness=7000.0, damping=80.0),
        cf.Stage(mass=15.0, stiffness=400.0, damping=90.0),
    ],
    uplift_force=200.0,
)
ROUGH = cf.Conditions(
    name="rough", base=cf.BaseMotion(track="high disturbance", suspension=cf.VehicleSuspension(frequency=2.0))
)


def sine(length: float) -> cf.Conditions:
    """Over x, forty points in a wave."""
    x = np.arange(0.0, 601.0, length / 40)
    height = HEIGHT * np.sin(2 * np.pi * x / length)
    return cf.Conditions(base=cf.BaseMotion(height=list(zip(x.tolist(), height.tolist(), strict=True))))


def amplitude(run: cf.Run, still: cf.Run, omega: float) -> float:
    """[N] of what the contact force has more, in one frequency."""
    inside, time = run.window(0), run.time
    more = (run.data["contact_force"].values - still.data["contact_force"].values)[0][inside]
    whole = np.floor((time[inside][-1] - time[inside][0]) * omega / (2 * np.pi))
    count = round(whole * 2 * np.pi / omega / 1e-3)
    return float(2 * abs((more * np.exp(-1j * omega * time[inside]))[:count].mean()))


def by_hand(omega: float, *, damper: bool = True) -> float:
    """F̂ = ŷ / (1/k + α): ŷ of the free head over the base, α its receptance."""
    body, below = HEAD.assemble(spatial=False), HEAD.stages[-1]
    dynamic = body.stiffness + 1j * omega * body.damping - omega**2 * body.mass
    base = np.array([0.0, below.stiffness + 1j * omega * below.damping * damper])
    row = body.row(body.strips[0])
    free, receptance = row @ np.linalg.solve(dynamic, base), row @ np.linalg.solve(dynamic, row)
    return float(HEIGHT * abs(free) / abs(1 / HEAD.contact_stiffness + receptance))


@pytest.fixture(scope="module")
def bar() -> cf.Shape:
    return stiff_rail()


@pytest.fixture(scope="module")
def shape() -> cf.Shape:
    line = cf.load_catenary(LAYOUTS / "en50318_2002.toml")
    return cf.find_form(
        line.replace(spans=line.spans[:6], supports=line.supports[:7], evaluated_spans=(3, 4))
    )


@pytest.mark.parametrize("length", [10.0, 25.0])
@pytest.mark.parametrize("method", ["nonlinear", "linearised"])
def test_a_sine_under_a_stiff_bar_against_the_receptance(bar: cf.Shape, length: float, method: Any) -> None:
    """Within 1 %; without the damper's path it would be far from it."""
    omega = 2 * np.pi * SPEED / length
    run, still = (
        cf.simulate(bar, [HEAD], speed=SPEED, method=method, conditions=conditions)
        for conditions in (sine(length), cf.Conditions())
    )
    ours = amplitude(run, still, omega)
    assert ours == pytest.approx(by_hand(omega), rel=0.01)
    assert ours != pytest.approx(by_hand(omega, damper=False), rel=0.1)


def test_engines_agree_over_a_moving_base(shape: cf.Shape, pantograph: cf.Pantograph) -> None:
    """Also on energy, whatever the base's design height follows."""
    run = cf.simulate(shape, [pantograph], speed=SPEED, conditions=ROUGH)
    still = cf.simulate(shape, [pantograph], speed=SPEED)
    inside, sigma = run.window(0), run.contact_force_statistics()[0].std
    moved = run.filtered_contact_force()[0] - still.filtered_contact_force()[0]
    assert np.sqrt((moved[inside] ** 2).mean()) > 0.1 * sigma
    assert np.abs(run.missing_energy).max() < 2e-3 * np.abs(run.data["lost_work"].values).max()
    others = {
        "linearised": cf.simulate(shape, [pantograph], speed=SPEED, method="linearised", conditions=ROUGH),
        "exudyn": cf.simulate(
            shape, [pantograph], speed=SPEED, method="exudyn", energy=True, conditions=ROUGH
        ),
        "rail": cf.simulate(shape, [pantograph.replace(base="rail")], speed=SPEED, conditions=ROUGH),
    }
    for name, other in others.items():
        gap = other.filtered_contact_force()[0] - run.filtered_contact_force()[0]
        assert np.sqrt((gap[inside] ** 2).mean()) < 0.03 * sigma, name


def test_checks_of_a_run_know_the_moving_base(bar: cf.Shape) -> None:
    """Momentum and energy of the stages, in two engines; with a base that is said to rest they fail."""
    for method, energy in (("nonlinear", False), ("exudyn", True)):
        run = cf.simulate(bar, [HEAD], speed=SPEED, method=method, energy=energy, conditions=sine(10.0))
        values = {check.name: check for check in run.checks}
        own = [values[name] for name in ("force balance", "pantograph energy", "energy balance")]
        assert all(check.passed for check in own), [(check.name, check.value) for check in own]
        still = cf.Run(run.data.assign(base_height=0 * run.data["base_height"]), 0.0)
        assert not {check.name: check for check in still.checks}["pantograph energy"].passed


def test_side_by_side_is_one_by_one(shape: cf.Shape) -> None:
    """Batches of linearised runs have a base each: other speeds, another signal."""
    from catenary_fe.engines.base import RunCase
    from catenary_fe.studies.linearised import LinearisedLine

    line = LinearisedLine(cf.settle(shape, ROUGH))
    cases = [RunCase([HEAD], speed, np.array([10.0]), 200.0) for speed in (40.0, 50.0, 60.0)]
    together = line.run(cases)
    for case, run in zip(cases, together, strict=True):
        (alone,) = line.run([case])
        force, own = run.data["contact_force"].values, alone.data["contact_force"].values
        assert np.abs(force - own).max() < 1e-3 * np.abs(own).max()


@pytest.mark.parametrize("method", ["nonlinear", "linearised", "exudyn"])
def test_an_elastic_law_sees_elevations_above_the_moved_base(shape: cf.Shape, method: Any) -> None:
    head, base = cf.ElasticPantograph(force=120.0, stiffness=800.0), ROUGH.base
    short = {"method": method, "conditions": ROUGH, "time": cf.TimeSettings(step=2e-3)}
    run = cf.simulate(shape, [head], speed=SPEED, **short)
    elevation = run.data["wire_height"].values[0] - run.catenary.contact_wire_height
    moved = base.at(float(run.data["position"].values[0, 0]), SPEED, run.time)
    assert np.abs(moved).max() > 2e-3
    law = 120.0 - 800.0 * (elevation - moved)
    assert run.data["contact_force"].values[0][1:] == pytest.approx(law[1:], abs=0.05)


def test_the_record_repeats_it(shape: cf.Shape, pantograph: cf.Pantograph, tmp_path) -> None:
    run = cf.simulate(shape, [pantograph], speed=SPEED, method="linearised", conditions=ROUGH)
    assert cf.load_run(run.save(tmp_path / "run.nc")).conditions == ROUGH
    assert rerun(run).identical


def test_a_checkpoint_goes_on_with_it(
    shape: cf.Shape, pantograph: cf.Pantograph, tmp_path, monkeypatch
) -> None:
    monkeypatch.setattr(checkpoint, "INTERVAL", 0.0)
    asked = {"speed": SPEED, "conditions": ROUGH}
    run = cf.simulate(shape, [pantograph], **asked)

    def interrupt(done: float) -> None:
        if done > 0.5:
            raise KeyboardInterrupt

    kept = tmp_path / "kept"
    with pytest.raises(cf.RunInterrupted):
        cf.simulate(shape, [pantograph], checkpoint=kept, progress=interrupt, **asked)
    again = cf.simulate(shape, [pantograph], checkpoint=kept, **asked)
    assert again.data["contact_force"].values.tobytes() == run.data["contact_force"].values.tobytes()


def test_over_time_is_over_the_place_at_a_speed(shape: cf.Shape) -> None:
    """One pantograph at v: h(t) = h(x₀ + v t); a run longer than the table is refused."""
    x = np.arange(0.0, 400.0, 0.5)
    heights = 3e-3 * np.sin(x / 3)
    over_x = cf.BaseMotion(height=list(zip(x.tolist(), heights.tolist(), strict=True)))
    times = ((x - 10.0) / SPEED + 7.0)[x >= 10.0]
    over_time = cf.BaseMotion(
        height_over_time=list(zip(times.tolist(), heights[x >= 10.0].tolist(), strict=True))
    )
    forces = [
        cf.simulate(
            shape,
            [HEAD],
            speed=SPEED,
            positions=[10.0],
            method="linearised",
            conditions=cf.Conditions(base=base),
        )
        .data["contact_force"]
        .values
        for base in (over_x, over_time)
    ]
    assert forces[0] == pytest.approx(forces[1], abs=1e-5)
    with pytest.raises(cf.InputError, match=r"it has 1 s, and the run lasts longer"):
        cf.simulate(
            shape,
            [HEAD],
            speed=SPEED,
            method="linearised",
            conditions=cf.Conditions(base=cf.BaseMotion(height_over_time=[(1.0, 0.0), (2.0, 0.01)])),
        )


def test_a_drawn_track_has_its_spectrum() -> None:
    """σ² is the spectrum's integral between the waves; the other class is found out."""

    def variance(a_v: float) -> float:
        def spectrum(n: float) -> float:
            return a_v * 0.8246**2 / ((n**2 + 0.0206**2) * (n**2 + 0.8246**2))

        return float(quad(spectrum, 2 * np.pi / 60.0, 2 * np.pi / 3.0)[0])

    track = cf.BaseMotion(track="low disturbance", longest_wave=60.0, seed=5)
    x = np.arange(0.0, 60e3, 0.5)
    ours = float(np.var(track.track_height(x)))
    assert ours == pytest.approx(variance(4.032e-7), rel=0.02)
    assert ours != pytest.approx(variance(1.080e-6), rel=0.5)
    assert not np.allclose(track.track_height(x), track.replace(seed=6).track_height(x))


@pytest.mark.parametrize(("frequency", "ratio"), [(1.0, 0.2), (2.5, 1.3)])
def test_a_suspension_against_its_closed_form(frequency: float, ratio: float) -> None:
    """A sine through mass, spring and damper: amplitude and phase, from the run's first instant on."""
    length, speed = 40.0, 60.0
    x = np.arange(-3000.0, 600.0, 0.25)
    heights = 5e-3 * np.sin(2 * np.pi * x / length)
    base = cf.BaseMotion(
        height=list(zip(x.tolist(), heights.tolist(), strict=True)),
        suspension=cf.VehicleSuspension(frequency=frequency, damping_ratio=ratio),
    )
    times = 1e-3 * np.arange(5001)
    s, own = 2j * np.pi * speed / length, 2 * np.pi * frequency
    passes = (2 * ratio * own * s + own**2) / (s**2 + 2 * ratio * own * s + own**2)
    start = 12.0
    closed = 5e-3 * np.imag(passes * np.exp(2j * np.pi * (start + speed * times) / length))
    assert base.at(start, speed, times) == pytest.approx(closed, abs=2e-5)


def test_a_modal_run_refuses_it(shape: cf.Shape) -> None:
    still = cf.settle(shape, ROUGH)
    with pytest.raises(cf.InputError, match="a base that moves"):
        cf.modal_run(still, cf.solve_modes(still, below=10.0), HEAD, speed=SPEED)


def test_a_scripts_own_motion(shape: cf.Shape) -> None:
    class Step(cf.Effect):
        def base_motion(self):
            return lambda start, speed, times: 0.02 * (start + speed * times > 80.0)

    run = cf.simulate(shape, [HEAD], speed=SPEED, method="linearised", conditions=[Step()])
    still = cf.simulate(shape, [HEAD], speed=SPEED, method="linearised")
    more = (run.data["contact_force"].values - still.data["contact_force"].values)[0]
    before = run.data["position"].values[0] < 79.0
    assert np.abs(more[before]).max() < 1e-6
    assert more[~before][1000:].mean() > 0.5 * 0.02 * 400.0  # the wire takes some of it by giving way


def test_attached_pantographs_stand_on_bases_of_their_own(shape: cf.Shape) -> None:
    import exudyn.itemInterface as eii

    settled = cf.settle(shape, ROUGH)
    model = cf.exudyn_model(settled)
    node = model.mbs.AddNode(eii.NodePointGround(referenceCoordinates=[0.0, 5.0, 0.0]))
    marker = model.mbs.AddMarker(eii.MarkerNodePosition(nodeNumber=node))
    model.attach("own", [marker], contact_stiffness=5e4)
    with pytest.raises(cf.InputError, match="stand on bases of the script's own"):
        cf.simulate(settled, [], speed=SPEED, method="exudyn", model=model)
    model.release()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, "give one of height, height_over_time and track"),
        ({"height": 0.001, "track": "low disturbance"}, "give one of"),
        ({"height": 0.001, "seed": 3}, "seed has no effect beside height"),
        ({"track": "low disturbance", "shortest_wave": 200.0}, "is not shorter than longest_wave"),
        ({"height": 1.0}, "must be a number from -0.5 to 0.5"),
        ({"height_over_time": 1.0}, r"must be a list of \[time, value\] pairs"),
        ({"height_over_time": [(1, 0.0), (1, 0.0)]}, "time = 1 s does not come after 1 s"),
        ({"track": "bad"}, "track"),
        ({"track": "low disturbance", "suspension": {"frequency": 0.0}}, "frequency"),
    ],
)
def test_faults(given: dict, said: str) -> None:
    with pytest.raises(cf.InputError, match=said):
        cf.BaseMotion(**given)
