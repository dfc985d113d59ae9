"""Pantographs that are not linear inside: dampers that differ up and down, dry friction, stops."""

from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import catenary_fe as cf
from catenary_fe.engines import checkpoint
from catenary_fe.engines.base import RunCase
from catenary_fe.results.pantograph import pantograph_response
from catenary_fe.studies.linearised import LinearisedLine
from catenary_fe.studies.rerun import rerun
from tests.engines.test_base_motion import ROUGH
from tests.engines.test_irregularity import stiff_rail, waves

SPEED, DOWN, STEP = 50.0, -300.0, 5e-4
HEAD = {"mass": 7.2, "stiffness": 4200.0, "damping": 10.0}
FRAME = {"mass": 15.0, "stiffness": 50.0}
LAWS: dict[str, dict[str, Any]] = {
    "damper": {"damping_up": 30.0, "damping_down": 150.0},
    "friction": {"damping": 60.0, "friction": 8.0},
    "stops": {"damping": 90.0, "travel": (0.03, 0.03), "stop_stiffness": 5e3},
}


def head_with(law: str) -> cf.Pantograph:
    stages = [cf.Stage(**HEAD), cf.Stage(**FRAME, **LAWS[law])]
    return cf.Pantograph(name=law, stages=stages, uplift_force=120.0)


def one_mass(**stage: Any) -> cf.Pantograph:
    return cf.Pantograph(
        name="one mass", stages=[cf.Stage(**({"mass": 20.0, "stiffness": 0.0} | stage))], uplift_force=100.0
    )


@pytest.fixture(scope="module")
def bar() -> cf.Shape:
    return stiff_rail()


def released(shape: cf.Shape, head: cf.Pantograph, duration: float) -> cf.Session:
    """Standing under the wire, so that nothing moves but the head."""
    session = cf.stepping(shape, [head], speed=SPEED, positions=[15.0], duration=duration)
    session.step(speed=0.0)
    return session


def moved_by(session: cf.Session, steps: int, force: float) -> tuple[np.ndarray, np.ndarray]:
    """Heights and velocities of the head in so many steps under a force, the first one's end included."""
    found = []
    for _ in range(steps):
        session.step(uplift_force=force)
        found.append((session.heights[0][0], session.velocities[0][0]))
    return np.transpose(found)


def test_each_way_has_its_own_damper(short_shape: cf.Shape) -> None:
    """m w' + c w = F, falling and rising: w = F/c + (w₀ - F/c) exp(-c t/m), within 1e-3 of F/c."""
    m, up, down = 20.0, 60.0, 200.0
    session = released(short_shape, one_mass(mass=m, damping_up=up, damping_down=down), 2.0)
    moved_by(session, 100, DOWN)  # off the wire
    first = session.velocities[0][0]
    times = 1e-3 * np.arange(1, 301)

    def closed(c: float, force: float, at: float) -> np.ndarray:
        return force / c + (at - force / c) * np.exp(-c * times / m)

    z, falling = moved_by(session, 300, DOWN)
    assert falling == pytest.approx(closed(down, DOWN, first), abs=1e-3 * abs(DOWN) / down)
    assert falling[-1] != pytest.approx(closed(up, DOWN, first)[-1], rel=0.1)
    assert z[-1] - z[0] == pytest.approx(np.trapezoid(closed(down, DOWN, first), times), rel=1e-3)
    while session.velocities[0][0] < 0:
        session.step(uplift_force=150.0)
    session.step()
    start = session.velocities[0][0]
    _, rising = moved_by(session, 300, 150.0)
    assert session.contact_force[0] == 0.0
    assert rising == pytest.approx(closed(up, 150.0, start), abs=1e-3 * 150.0 / up)
    assert rising[-1] != pytest.approx(closed(down, 150.0, start)[-1], rel=0.1)


def test_friction_holds_what_is_weaker_and_lets_go_what_is_not(short_shape: cf.Shape) -> None:
    """At rest off the wire: a push of less than the friction moves nothing, a stronger one as F - R says."""
    session = released(short_shape, one_mass(friction=30.0), 3.0)
    moved_by(session, 100, DOWN)
    while session.velocities[0][0] < -1e-9:
        session.step(uplift_force=20.0)
    moved_by(session, 200, 0.0)  # what the time integration remembers of the stop dies away
    for force in (-29.0, 29.0):
        z, w = moved_by(session, 100, force)
        assert np.ptp(z) < 1e-9 and np.abs(w).max() < 1e-9
    _, w = moved_by(session, 300, 50.0)
    assert w[-1] - w[99] == pytest.approx(0.2 * (50.0 - 30.0) / 20.0, rel=1e-3)
    assert session.contact_force[0] == 0.0


def test_friction_takes_the_same_length_from_each_half_cycle(short_shape: cf.Shape) -> None:
    """A mass on a spring: turning points lie 2 R/k nearer to where it is force-free, each half a period."""
    m, k, friction = 20.0, 2000.0, 20.0
    session = released(short_shape, one_mass(mass=m, stiffness=k, friction=friction), 5.0)
    middle = -1000.0 / k  # so far from the wire that it stays off
    moved_by(session, 3, -700.0)
    while session.velocities[0][0] < 0:
        session.step()
    z, w = moved_by(session, 3500, -1000.0)
    assert session.contact_force[0] == 0.0 and z.max() < -0.1
    turns = np.flatnonzero(np.sign(w[:-1]) * np.sign(w[1:]) < 0) + 1
    far = np.abs(z[turns] - middle)
    moving = far[far > 3 * friction / k]
    assert moving.size > 4
    assert -np.diff(moving) == pytest.approx(np.full(moving.size - 1, 2 * friction / k), rel=0.01)
    assert np.diff(turns[: moving.size]).mean() == pytest.approx(1e3 * np.pi * np.sqrt(m / k), rel=0.01)
    held = np.abs(z[-200:] - middle)
    assert np.ptp(held) < 1e-9 and held[0] < friction / k  # it stops where the spring cannot pull it on


def test_a_stop_throws_back_what_meets_it(short_shape: cf.Shape) -> None:
    """An undamped mass on a stop k, pressed by F: half a sine of F/k ± √((F/k)² + m w²/k), then -w."""
    m, k, travel = 20.0, 1e5, 0.2
    head = one_mass(mass=m, travel=(travel, 5.0), stop_stiffness=k)
    session = cf.stepping(
        short_shape,
        [head],
        speed=SPEED,
        positions=[15.0],
        duration=1.2,
        time=cf.TimeSettings(step=2e-4, spectral_radius=1.0),
    )
    session.step(speed=0.0)
    z, w = moved_by(session, 5000, -20.0)
    after = np.flatnonzero(z < -travel)
    met, left = after[0] - 1, after[0] + np.flatnonzero(z[after[0] :] > -travel)[0]
    deep = 20.0 / k + np.sqrt((20.0 / k) ** 2 + m * w[met] ** 2 / k)
    assert -travel - z.min() == pytest.approx(deep, rel=0.01)
    assert -travel - z.min() != pytest.approx(deep * np.sqrt(1.05), rel=0.01)  # a softer stop
    assert w[left] == pytest.approx(-w[met], rel=0.01)
    energy = m * w**2 / 2 + 20.0 * z + k * np.maximum(-travel - z, 0.0) ** 2 / 2
    falls = z < z[0] - 0.02  # off the wire
    assert np.ptp(energy[falls]) < 0.01 * m * w[met] ** 2 / 2


@pytest.mark.parametrize(("law", "method"), [*((law, "linearised") for law in LAWS), ("stops", "nonlinear")])
def test_under_a_sine_against_an_independent_integration(bar: cf.Shape, law: str, method: Any) -> None:
    """Two masses pressed to a bar with a sine of 2 mm, from a state of the run on by scipy's integration.

    Friction is there one of tanh.
    """
    head, height, length, first = head_with(law), 2e-3, 12.5, 400
    uneven = cf.Conditions(irregularity=cf.ContactWireIrregularity(height=waves(length, height)))
    asked = {"speed": SPEED, "method": method, "conditions": uneven, "time": cf.TimeSettings(step=STEP)}
    run = cf.simulate(bar, [head], **asked)
    masses = run.data["mass_height"].values[0] - run.catenary.contact_wire_height
    start = [*masses[:, first], *np.gradient(masses, STEP, axis=1)[:, first]]
    profile = run.data["wire_height"].values[0] - run.catenary.contact_wire_height
    stage, times = head.stages[1], run.time

    def slope(t: float, y: np.ndarray) -> list[float]:
        z, frame, w, v = y
        contact = max(0.0, head.contact_stiffness * (z - np.interp(t, times, profile)))
        joint = HEAD["stiffness"] * (z - frame) + HEAD["damping"] * (w - v)
        below = stage.stiffness * frame + stage.friction * np.tanh(v / 1e-5)
        up, down = stage.damping_up, stage.damping_down
        below += v * (stage.damping if up is None else up if v > 0 else down)
        if stage.travel:
            below += stage.stop_stiffness * (
                max(frame - stage.travel[1], 0) + min(frame + stage.travel[0], 0)
            )
        return [w, v, (-joint - contact) / HEAD["mass"], (120.0 + joint - below) / FRAME["mass"]]

    window = times[first : first + 2000]
    options = {"t_eval": window, "rtol": 1e-7, "atol": 1e-9, "max_step": 1e-3}
    found = solve_ivp(slope, (window[0], window[-1]), start, "LSODA", **options)
    contact = head.contact_stiffness * np.maximum(found.y[0] - np.interp(found.t, times, profile), 0.0)
    spread = contact.std()

    def off(other: cf.Run) -> float:
        gap = other.data["contact_force"].values[0, first : first + 2000] - contact
        return float(np.sqrt((gap**2).mean()) / spread)

    assert off(run) < 0.02
    plain = cf.Stage(**FRAME, damping=stage.damping or 90.0)
    linear = cf.simulate(bar, [head.replace(stages=[head.stages[0], plain])], **asked)
    assert off(linear) > 0.1


@pytest.mark.parametrize(
    ("law", "conditions"), [("friction", None), ("stops", ROUGH)], ids=["still", "over a moving base"]
)
def test_engines_agree(short_shape: cf.Shape, law: str, conditions: Any) -> None:
    """Friction in Exudyn's runs is viscous below 1 mm/s, which costs 0.6 N where the head comes to rest."""
    head = head_with(law)
    asked = {"speed": SPEED, "positions": [80.0], "conditions": conditions}
    run = cf.simulate(short_shape, [head], **asked)
    others = {
        "linearised": cf.simulate(short_shape, [head], method="linearised", **asked),
        "exudyn": cf.simulate(short_shape, [head], method="exudyn", energy=True, **asked),
    }
    inside, force = run.window(0), run.filtered_contact_force()[0]
    for name, other in others.items():
        gap = (other.filtered_contact_force()[0] - force)[inside]
        most = 0.8 if (name, law) == ("exudyn", "friction") else 0.3
        assert np.sqrt((gap**2).mean()) < most, name
    for balanced in (run, others["exudyn"]):
        lost = np.abs(balanced.data["lost_work"].values).max()
        assert np.abs(balanced.missing_energy).max() < 1e-2 * lost
    own = {check.name: check for each in (run, *others.values()) for check in each.checks}
    judged = {"energy balance"} | ({"force balance", "pantograph energy"} if law != "friction" else set())
    assert judged <= own.keys() and all(own[name].passed for name in judged)
    linear = cf.Pantograph(
        name=law, stages=[cf.Stage(**HEAD), cf.Stage(**FRAME, damping=90.0)], uplift_force=120.0
    )
    without = cf.simulate(short_shape, [linear], method="linearised", **asked)
    gap = (without.filtered_contact_force()[0] - force)[inside]
    assert np.sqrt((gap**2).mean()) > 1.0


def test_side_by_side_is_one_by_one(short_shape: cf.Shape) -> None:
    """Eight linearised runs of other laws and speeds beside each other, to the last bit."""
    line, laws = LinearisedLine(short_shape), [*LAWS, *LAWS, "damper", "stops"]
    cases = [RunCase([head_with(law)], 40.0 + 3 * n, np.array([10.0]), 150.0) for n, law in enumerate(laws)]
    together = line.run(cases)
    for case, run in zip(cases[:4], together, strict=False):
        (alone,) = line.run([case])
        force, own = run.data["contact_force"].values, alone.data["contact_force"].values
        assert np.abs(force - own).max() < 1e-9 * np.abs(own).max()


@pytest.mark.parametrize("law", ["friction", "stops"])
def test_a_record_repeats_and_a_checkpoint_goes_on(
    short_shape: cf.Shape, law: str, tmp_path, monkeypatch
) -> None:
    monkeypatch.setattr(checkpoint, "INTERVAL", 0.0)
    head, asked = head_with(law), {"speed": SPEED, "positions": [100.0], "conditions": ROUGH}
    run = cf.simulate(short_shape, [head], **asked)

    def interrupt(done: float) -> None:
        if done > 0.5:
            raise KeyboardInterrupt

    kept = tmp_path / "kept"
    with pytest.raises(cf.RunInterrupted):
        cf.simulate(short_shape, [head], checkpoint=kept, progress=interrupt, **asked)
    again = cf.simulate(short_shape, [head], checkpoint=kept, **asked)
    for name in ("contact_force", "mass_height", "lost_work", "driven_work", "energy"):
        assert again.data[name].values.tobytes() == run.data[name].values.tobytes(), name
    loaded = cf.load_run(run.save(tmp_path / "run.nc"))
    assert loaded.pantographs == (head,)
    assert rerun(loaded).identical


def test_a_base_that_lifts_a_stop_does_work(short_shape: cf.Shape) -> None:
    """A frame that lies on its upper stop all the time: the base pulls it down and up again by the stop."""
    stop = cf.Stage(**FRAME, damping=20.0, travel=(0.05, 0.01), stop_stiffness=2e4)
    head = cf.Pantograph(name="held", stages=[cf.Stage(**HEAD), stop], uplift_force=400.0)
    x = np.arange(0.0, 301.0, 0.25)
    lifted = 4e-3 * (1 - np.cos(2 * np.pi * x / 20.0))
    moved = cf.Conditions(base=cf.BaseMotion(height=list(zip(x.tolist(), lifted.tolist(), strict=True))))
    run = cf.simulate(short_shape, [head], speed=SPEED, conditions=moved)
    frame = run.data["mass_height"].values[0, 1] - run.catenary.contact_wire_height
    assert (frame - run.data["base_height"].values[0] > 0.01).mean() > 0.9
    lost = np.abs(run.data["lost_work"].values).max()
    assert np.abs(run.missing_energy).max() < 4e-3 * lost


def test_static_force_over_the_height_knows_stops() -> None:
    """Below the lower stop the head is held by it: its force rises by that one's stiffness, too."""
    stage = cf.Stage(**FRAME, travel=(0.1, 0.2), stop_stiffness=5e3)
    head = cf.Pantograph(name="stops", stages=[cf.Stage(**HEAD), stage], uplift_force=120.0)
    found = pantograph_response(head)
    z, F, k = found.height, found.force, HEAD["stiffness"]

    def by_hand(below: float, shift: float) -> np.ndarray:
        """The frame's spring and stop, in series with the head's, from F = 0 of a head that is not held."""
        return np.maximum(0.0, k / (k + below) * (120.0 + shift - below * z))

    low = z < -0.25
    assert F[low] == pytest.approx(by_hand(50.0 + 5e3, -5e3 * 0.1)[low])
    assert F[np.abs(z) < 0.04] == pytest.approx(by_hand(50.0, 0.0)[np.abs(z) < 0.04])
    assert not F[z > 0.3].any()


def test_modal_runs_refuse_them(short_shape: cf.Shape) -> None:
    modes = cf.solve_modes(short_shape, count=3)
    for law in LAWS:
        with pytest.raises(cf.InputError, match=f"{law}: stops, dry friction"):
            cf.modal_run(short_shape, modes, head_with(law), speed=SPEED)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"damping_up": 5.0}, "belong together"),
        ({"damping_up": 5.0, "damping_down": 9.0, "damping": 1.0}, "damping has no effect beside"),
        ({"stop_stiffness": 1e5}, "stop_stiffness has no effect without travel"),
        ({"travel": (0.0, 0.1)}, "travel"),
        ({"friction": -1.0}, "friction"),
    ],
)
def test_faults(given: dict[str, Any], said: str) -> None:
    with pytest.raises(cf.InputError, match=said):
        cf.Stage(mass=1.0, stiffness=1.0, **given)
