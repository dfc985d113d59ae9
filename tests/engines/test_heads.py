"""Heads that pitch and bend, air on each mass: against closed forms, other descriptions, other engines."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.linalg import eigh

import catenary_fe as cf
from catenary_fe.layout.panhead import AerodynamicForce
from catenary_fe.theory import free_beam_shapes

SPEED = 60.0  # [m/s]
HEAD, FRAME = {"mass": 7.2, "stiffness": 4200.0, "damping": 10.0}, {"mass": 15.0, "stiffness": 50.0}


def three_spans(path: Path) -> cf.Shape:
    line = cf.load_catenary(path)
    return cf.find_form(line.replace(spans=line.spans[:3], supports=line.supports[:4], evaluated_spans=(2,)))


@pytest.fixture(scope="module")
def plane(reference_layout: Path) -> cf.Shape:
    return three_spans(reference_layout)


@pytest.fixture(scope="module")
def twin(reference_layout: Path) -> cf.Shape:
    return three_spans(reference_layout.parent / "dc_3kv_twin.toml")


def pantograph(head: dict[str, Any] | None = None, **more: Any) -> cf.Pantograph:
    stages = [cf.Stage(**HEAD), cf.Stage(**FRAME, damping=90.0)]
    given: dict[str, Any] = {"name": "head", "uplift_force": 120.0, "stages": stages} | more
    return cf.Pantograph(**given, head=cf.Panhead(**head) if head else None)


def force(shape: cf.Shape, one: cf.Pantograph, method: Any = "linearised") -> np.ndarray:
    run = cf.simulate(shape, [one], speed=SPEED, method=method)
    return np.asarray(run.data["contact_force"].values[0])


def apart(a: np.ndarray, b: np.ndarray) -> float:
    """Root mean square of the difference, as a share of the deviation."""
    return float(np.std(a - b) / np.std(b))


def test_shapes_of_the_free_beam():
    """No motion as a rigid body, the mean square 1; ends and middle of the exact shapes."""
    length = 1.6
    shapes = free_beam_shapes(2, length)
    y = np.linspace(-length / 2, length / 2, 2001)
    first, second = (np.polynomial.polynomial.polyval(y, s) for s in shapes)
    for shape in (first, second):
        assert np.trapezoid(shape**2, y) / length == pytest.approx(1.0, abs=1e-5)
        assert np.trapezoid(shape, y) == pytest.approx(0.0, abs=1e-6)
        assert np.trapezoid(y * shape, y) == pytest.approx(0.0, abs=1e-5)
    assert [first[0], first[1000], first[-1]] == pytest.approx([2.0, -1.2157, 2.0], rel=2e-3)
    assert [second[0], second[1000], second[-1]] == pytest.approx([-2.0, 0.0, 2.0], rel=5e-3, abs=1e-9)


def test_a_strip_on_its_ends_is_a_beam_on_pinned_ends():
    """Its first frequency is (π²/22.373) times that of the free strip, its middle yields by F L³/(48 EI)."""
    length, mass, free = 1.6, 8.0, 60.0
    stage = cf.Stage(mass=mass, stiffness=1e9)
    head = cf.Panhead(width=length, spring_distance=length, bending_frequencies=(free,), bending_damping=0.0)
    body = cf.Pantograph(stages=[stage], uplift_force=1.0, head=head).assemble(spatial=False)
    own = np.sqrt(eigh(body.stiffness, body.mass, eigvals_only=True)[0]) / (2 * np.pi)
    assert own == pytest.approx(np.pi**2 / 22.3733 * free, rel=0.02)
    row = body.row(body.strips[0])
    yields = row @ np.linalg.solve(body.stiffness, row)
    bending = mass * length**3 * (2 * np.pi * free) ** 2 / 500.564  # EI = m ω² L³/500.6
    assert yields == pytest.approx(length**3 / (48 * bending), rel=0.02)
    assert yields != pytest.approx(1.05 * length**3 / (48 * bending), rel=0.02)


def test_modes_are_felt_where_the_wire_is():
    """A strip's height across the track; the antisymmetric mode turns on springs that the head has apart."""
    head = cf.Panhead(width=1.6, spring_distance=0.9, bending_frequencies=(60.0, 160.0))
    body = pantograph().replace(head=head).assemble(spatial=True)
    assert body.size == 2 + 1 + 2
    shapes = free_beam_shapes(2, 1.6)
    row = body.row(body.strips[0], 0.3)
    assert row[:3] == pytest.approx([1.0, 0.0, 0.3])
    assert row[3:] == pytest.approx([np.polynomial.polynomial.polyval(0.3, s) for s in shapes])
    assert body.stiffness[2, 4] != 0.0 and body.stiffness[0, 4] == pytest.approx(0.0, abs=1e-9)
    assert body.stiffness[0, 3] != 0.0


def test_a_head_that_pitches_freely_enough_is_two_strips(plane):
    """Two half masses on half springs d apart: inertia m d²/4, springs d apart. Same force to rounding."""
    two = {"strips": 2, "strip_distance": 0.5}
    pitching = two | {"pitch_inertia": 7.2 * 0.5**2 / 4, "pitch_spring_distance": 0.5}
    apart_, rigid = pantograph(two), pantograph(pitching)
    for method in ("linearised", "nonlinear"):
        a, b = force(plane, apart_, method), force(plane, rigid, method)
        assert a == pytest.approx(b, abs=1e-5 * b.max())
    slow = pantograph(two | {"pitch_inertia": 5.0, "pitch_spring_distance": 0.1})
    assert apart(force(plane, slow), force(plane, rigid)) > 0.02


def test_a_head_that_pitches_and_rolls_in_every_engine(twin):
    head = {"width": 1.6, "strips": 2, "strip_distance": 0.4, "spring_distance": 0.9, "roll_inertia": 1.0}
    one = pantograph(head | {"pitch_inertia": 0.8, "pitch_spring_distance": 0.3})
    nonlinear, linearised, exudyn = (
        force(twin, one, method) for method in ("nonlinear", "linearised", "exudyn")
    )
    assert apart(exudyn, nonlinear) < 0.01  # 0.5 %, as without pitch: four contacts open and close
    assert apart(linearised, nonlinear) < 0.06
    stiff = force(twin, one.replace(head=one.panhead.replace(pitch_inertia=8.0)), "nonlinear")
    assert apart(stiff, nonlinear) > 0.01


def test_a_strip_that_bends(twin):
    """A stiff one is a rigid one; one that bends at 30 Hz is felt, the same way by both engines."""
    head = {"width": 1.6, "spring_distance": 0.9, "roll_inertia": 1.0}
    rigid = force(twin, pantograph(head))
    stiff = force(twin, pantograph(head | {"bending_frequencies": (4e3, 9e3)}))
    assert apart(stiff, rigid) < 0.005
    soft = pantograph(head | {"bending_frequencies": (30.0, 80.0)})
    linearised, nonlinear = (force(twin, soft, m) for m in ("linearised", "nonlinear"))
    assert apart(linearised, rigid) > 0.02
    assert apart(linearised, nonlinear) < 0.06
    with pytest.raises(cf.InputError, match="strips that bend do not run with Exudyn"):
        force(twin, soft, "exudyn")


def test_air_on_the_lowest_mass_is_the_pantographs_own(plane):
    air = AerodynamicForce(quadratic=0.01)
    stages = [cf.Stage(**HEAD), cf.Stage(**FRAME, damping=90.0, aerodynamic_force=air)]
    of_stage, own = pantograph(stages=stages), pantograph(aerodynamic_force=air)
    assert of_stage.static_uplift(SPEED) == own.static_uplift(SPEED) == 120.0 + 36.0
    assert (force(plane, of_stage) == force(plane, own)).all()


@pytest.mark.parametrize("method", ["linearised", "nonlinear", "exudyn"])
def test_air_on_the_head(plane, method):
    """Static: the frame's spring is shorter than with the same force below; the mean force hardly differs."""
    air = AerodynamicForce(quadratic=0.01)
    stages = [cf.Stage(**HEAD, aerodynamic_force=air), cf.Stage(**FRAME, damping=90.0)]
    on_head, below = pantograph(stages=stages), pantograph(aerodynamic_force=air)
    body = on_head.assemble(spatial=False, speed=SPEED)
    assert 156.0 * body.load == pytest.approx([36.0, 120.0])
    runs = [cf.simulate(plane, [one], speed=SPEED, method=method) for one in (on_head, below)]
    heads, frames = (np.array([run.data["mass_height"].values[0, n].mean() for run in runs]) for n in (0, 1))
    assert np.diff(heads - frames)[0] == pytest.approx(-36.0 / 4200.0, rel=0.02)
    means = [run.data["contact_force"].values[0].mean() for run in runs]
    assert means[0] == pytest.approx(means[1], rel=0.01)
    assert all(check.passed for run in runs for check in run.checks if "balance" in check.name)


def test_the_knuckle_trails(plane):
    air = AerodynamicForce(quadratic=0.01, trailing=(0.002, 0.1))
    leading, trailing = (pantograph(aerodynamic_force=air, knuckle=k) for k in ("leading", "trailing"))
    assert leading.static_uplift(SPEED) == pytest.approx(156.0)
    assert trailing.static_uplift(SPEED) == pytest.approx(120.0 + 0.002 * SPEED**2 + 0.1 * SPEED)
    assert "knuckle trailing" in str(trailing.in_words())
    assert force(plane, leading).mean() - force(plane, trailing).mean() > 15.0


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"head": {"pitch_inertia": 1.0}}, "pitch_inertia and pitch_spring_distance belong together"),
        ({"head": {"pitch_inertia": 1.0, "pitch_spring_distance": 0.3}}, "no effect with one strip"),
        ({"head": {"bending_damping": 0.02}}, "bending_damping has no effect"),
        ({"head": {"strips": 2, "strip_distance": 0.4, "pitch_inertia": 1.0, "pitch_spring_distance": 0.3,
                   "bending_frequencies": [50.0]}}, "a head that pitches is rigid"),
        ({"knuckle": "trailing"}, "no aerodynamic_force has `trailing`"),
        ({"uplift_force": None, "mean_force": 120.0,
          "stages": [cf.Stage(**HEAD, aerodynamic_force={"linear": 0.1})]}, "no effect beside mean_force"),
    ],
)  # fmt: skip
def test_what_has_no_effect_is_refused(given, said):
    with pytest.raises(cf.InputError, match=said):
        pantograph(**given)
