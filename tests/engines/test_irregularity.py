"""An uneven contact wire: a term of the gap, in all engines."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.engines.contact_solver import surface_at
from catenary_fe.engines.recorder import surfaces_of
from catenary_fe.layout.conditions import ContactWireIrregularity
from tests.conftest import LAYOUTS
from tests.engines.kernels import entry

SPEED = 50.0


def waves(length: float, height: float) -> tuple[tuple[float, float], ...]:
    """A sine over the place, ten points in half a metre."""
    x = np.arange(0.0, 601.0, 0.05)
    return tuple(zip(x.tolist(), (height * np.sin(2 * np.pi * x / length)).tolist(), strict=True))


@pytest.fixture(scope="module")
def shape() -> cf.Shape:
    line = cf.load_catenary(LAYOUTS / "en50318_2002.toml")
    return cf.find_form(
        line.replace(spans=line.spans[:6], supports=line.supports[:7], evaluated_spans=(3, 4))
    )


def stiff_rail() -> cf.Shape:
    """A bar so stiff that it neither bends nor waves, on supports that hold it."""
    bar = cf.Wire(mass_per_length=100.0, tension=1e5, axial_stiffness=1e8, bending_stiffness=5e8)
    arm = cf.SteadyArm(stiffness=3e8)
    line = cf.Catenary(
        contact_wire=bar,
        spans=[cf.Span(length=10.0, droppers=())] * 30,
        supports=[cf.Support(steady_arm=arm)] * 31,
        evaluated_spans=tuple(range(11, 29)),
        end=cf.SectionEnd(kind="fixed"),
    )
    return cf.find_form(line)


@pytest.mark.parametrize("length", [5.0, 12.5, 25.0])
def test_a_sine_on_a_stiff_bar_against_the_pantographs_receptance(length: float) -> None:
    """F̂ = r̂ / (1/k + α(ω)), α the head's receptance, of which the wire has none."""
    head = cf.Pantograph(
        name="two masses",
        stages=[
            cf.Stage(mass=7.0, stiffness=7000.0, damping=80.0),
            cf.Stage(mass=15.0, stiffness=200.0, damping=90.0),
        ],
        uplift_force=200.0,
    )
    omega, height = 2 * np.pi * SPEED / length, 0.5e-3
    body = head.assemble(spatial=False)
    dynamic = body.stiffness + 1j * omega * body.damping - omega**2 * body.mass
    row = body.row(body.strips[0], 0.0)
    receptance = row @ np.linalg.solve(dynamic, row)
    by_hand = height / abs(1 / head.contact_stiffness + receptance)
    weather = cf.Conditions(irregularity=ContactWireIrregularity(height=waves(length, height)))
    bar = stiff_rail()
    for method in ("nonlinear", "linearised"):
        force = [
            cf.simulate(bar, [head], speed=SPEED, method=method, conditions=conditions)
            for conditions in (weather, cf.Conditions())
        ]
        inside, time = force[0].window(0), force[0].time
        more = (force[0].data["contact_force"].values - force[1].data["contact_force"].values)[0]
        phases = np.exp(-1j * omega * time[inside])
        whole = int(np.floor((time[inside][-1] - time[inside][0]) * omega / (2 * np.pi)))
        count = round(whole * 2 * np.pi / omega / 1e-3)
        amplitude = 2 * abs((more[inside] * phases)[:count].mean())
        assert amplitude == pytest.approx(by_hand, rel=0.01), method
        assert amplitude != pytest.approx(1.03 * by_hand, rel=0.01), method


def test_engines_agree_on_an_uneven_wire(shape: cf.Shape, pantograph: cf.Pantograph) -> None:
    rough = cf.Conditions(
        name="rough", irregularity=ContactWireIrregularity(deviation=1e-3, shortest_wave=1.0)
    )
    run = cf.simulate(shape, [pantograph], speed=SPEED, conditions=rough)
    even = cf.simulate(shape, [pantograph], speed=SPEED)
    sigma, inside = run.contact_force_statistics()[0].std, run.window(0)
    assert sigma > 1.05 * even.contact_force_statistics()[0].std
    for method in ("linearised", "exudyn"):
        other = cf.simulate(shape, [pantograph], speed=SPEED, method=method, conditions=rough)
        gap = other.filtered_contact_force()[0] - run.filtered_contact_force()[0]
        assert np.sqrt((gap[inside] ** 2).mean()) < 0.03 * sigma, method


def test_surfaces_of_both_sides_are_one(shape: cf.Shape) -> None:
    """What compiled runs take and what Exudyn's take; the sum of two effects; deviation as asked for."""
    given = ContactWireIrregularity(deviation=2e-3, shortest_wave=1.0, longest_wave=20.0, seed=4)
    effects = cf.Conditions(irregularity=given).effects(15.0)
    (path,) = cf.settle(shape, effects).system.contact_paths
    (double,) = cf.settle(shape, effects * 2).system.contact_paths
    surfaces = surfaces_of([path])
    for x in (0.3, 100.02, 359.0):
        height, slope = path.surface(x)
        assert entry(surface_at)(surfaces, 0, x) == pytest.approx((height, slope), abs=1e-12)
        assert height == pytest.approx(float(given.at(np.array([x]))[0]), abs=2e-6)
        assert slope == pytest.approx(
            float(given.at(np.array([x + 1e-4]))[0] - given.at(np.array([x - 1e-4]))[0]) / 2e-4, abs=2e-5
        )
        assert double.surface(x) == pytest.approx((2 * height, 2 * slope), abs=1e-12)
    assert np.std(given.at(np.arange(0, 3000.0, 0.1))) == pytest.approx(2e-3, rel=0.03)


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({}, "give either height"),
        ({"height": 0.001, "deviation": 0.001}, "give either height"),
        ({"height": 0.001, "seed": 3}, "seed has no effect beside height"),
        ({"deviation": 0.001, "shortest_wave": 40.0}, "is not shorter than longest_wave"),
        ({"height": 1.0}, "must be a number from -0.1 to 0.1"),
    ],
)
def test_faults(given: dict, said: str) -> None:
    with pytest.raises(cf.InputError, match=said):
        ContactWireIrregularity(**given)
