"""Wind as it was measured: a string's answer in closed form, and runs in it."""

import numpy as np
import pytest
from scipy.linalg import lu_factor, lu_solve

import catenary_fe as cf
from tests.conftest import LAYOUTS

ALPHA, STEP, SPAN = 0.6, 0.005, 60.0
MEAN, SWING, RATE = 12.0, 4.0, 1.1  # [m/s], [m/s], [Hz]: the string's own frequency is 1.0 Hz


def sine(*places: float, rate: float = RATE) -> cf.Wind:
    times = np.arange(0.0, 40.001, 0.02)
    speeds = MEAN + SWING * np.sin(2 * np.pi * rate * times)
    rows = [(t, x, v) for x in places for t, v in zip(times.tolist(), speeds.tolist(), strict=True)]
    return cf.Wind(speed=rows)


@pytest.fixture(scope="module")
def span() -> cf.Shape:
    """A contact wire that hangs by itself, without bending stiffness."""
    line = cf.load_catenary(LAYOUTS / "en50318_2002.toml")
    wire = line.contact_wire.replace(diameter=0.0144, bending_stiffness=0.0)
    return cf.find_form(
        line.replace(
            spans=(cf.Span(length=SPAN, droppers=()),),
            supports=line.supports[:2],
            spatial=True,
            evaluated_spans=None,
            contact_wire=wire,
            damping=cf.RayleighDamping(alpha=ALPHA),
        )
    )


def amplitude_of(system) -> float:
    """[m] of the wire's middle to the side in the record's frequency, after 20 s: Newmark's method."""
    wire = system.wires[0]
    aside = system.dof[6 * (wire.first + np.arange(wire.x.size)[:, None]) + [1, 4]]
    own = np.unique(aside[aside >= 0])
    rest = np.zeros(system.dof.size)
    whole = system.free(system.mass), system.free(system.damping()), system.tangent(rest)
    M, D, K = (matrix[own][:, own].toarray() for matrix in whole)
    row, patterns = system.gather(system.row(0, SPAN / 2, 1))[own], system.patterns[own].toarray()
    times = STEP * np.arange(7901)
    loads = patterns @ system.signals(times)
    factor = lu_factor(M + STEP / 2 * D + STEP**2 / 4 * K)
    q, found = np.linalg.solve(K, loads[:, 0]), []
    v, a = np.zeros_like(q), np.zeros_like(q)
    for now in loads.T[1:]:
        q, v = q + STEP * v + STEP**2 / 4 * a, v + STEP / 2 * a
        a = lu_solve(factor, now - D @ v - K @ q)
        q, v = q + STEP**2 / 4 * a, v + STEP / 2 * a
        found.append(row @ q)
    late = slice(3899, 7899)  # 20 s, whole periods
    phases = np.exp(-2j * np.pi * RATE * times[1:][late])
    return float(2 * abs((np.array(found)[late] * phases).mean()))


def by_hand(shape: cf.Shape, mean: float = MEAN) -> float:
    """Of a string under 2 k U a sin ωt, the part of the square in that frequency; drag 2 k U damps it."""
    wire, omega = shape.catenary.contact_wire, 2 * np.pi * RATE
    k = 0.5 * 1.25 * 0.0144
    m, c, T = wire.mass_per_length, ALPHA * wire.mass_per_length + 2 * k * MEAN, wire.tension
    n = np.arange(1, 60, 2)
    lam = n * np.pi / SPAN
    load = 2 * k * mean * SWING * 4 / (n * np.pi)
    return float(abs(sum(load * np.sin(n * np.pi / 2) / (T * lam**2 - omega**2 * m + 1j * omega * c))))


@pytest.mark.parametrize("places", [(0.0,), (0.0, 20.0, 33.0, 60.0)])
def test_a_sine_in_time_on_a_string_in_closed_form(span: cf.Shape, places: tuple[float, ...]) -> None:
    """Within 1 %, however many stations say the same; another mean is found out."""
    ours = amplitude_of(cf.settle(span, cf.Conditions(wind=sine(*places))).system)
    assert ours == pytest.approx(by_hand(span), rel=0.01)
    assert ours != pytest.approx(by_hand(span, mean=1.02 * MEAN), rel=0.01)


def test_the_square_between_stations_is_that_of_the_speed_there(span: cf.Shape) -> None:
    """Loads of all signals at a time against k v² - k v̄² of the interpolated speed."""
    rows = [(0.0, 0.0, 5.0), (2.0, 0.0, 15.0), (0.0, 40.0, 20.0), (2.0, 40.0, 8.0), (3.0, 40.0, 1.0)]
    wind = cf.Wind(speed=rows, direction=-60.0)
    (effect,) = cf.Conditions(wind=wind).effects(15.0)[1:]
    part = cf.WirePart("contact_wire", span.catenary.contact_wire, np.array([0.0, 7.0, 35.0, 55.0]))
    total = sum(load[1] * signal(np.array([0.5]))[0] for load, signal in effect.in_time(part))
    share = np.interp(part.x, [0.0, 40.0], [0.0, 1.0])
    speed = (1 - share) * 7.5 + share * 17.0
    mean = (1 - share) * 10.0 + share * 14.0
    across = np.sin(np.radians(-60.0))
    drag = wind.resistance(part, None) * across * abs(across)
    assert total == pytest.approx(drag * (speed**2 - mean**2), rel=1e-12)
    assert wind.across(part.x) == pytest.approx(mean * across)


def test_a_speed_that_does_not_change_is_steady_wind() -> None:
    line = cf.load_catenary(LAYOUTS / "re330.toml")
    shape = cf.find_form(line.replace(spans=line.spans[:3], supports=line.supports[:4], evaluated_spans=None))
    head = cf.library.pantograph("DSA380")
    rows = [(t, x, 15.0) for x in (0.0, 80.0) for t in (5.0, 7.0, 12.0)]
    forces = [
        cf.simulate(shape, [head], speed=70.0, method="linearised", conditions=cf.Conditions(wind=wind))
        .data["contact_force"]
        .values
        for wind in (cf.Wind(speed=rows), cf.Wind(speed=15.0), cf.Wind(speed=15.1))
    ]
    assert forces[0] == pytest.approx(forces[1], abs=1e-6)
    assert np.abs(forces[2] - forces[1]).max() > 1e-3


def test_engines_agree_in_measured_wind() -> None:
    line = cf.load_catenary(LAYOUTS / "re330.toml")
    shape = cf.find_form(line.replace(spans=line.spans[:3], supports=line.supports[:4], evaluated_spans=None))
    head, windy = cf.library.pantograph("DSA380"), cf.Conditions(wind=sine(0.0, 100.0, rate=0.4))
    run = cf.simulate(shape, [head], speed=70.0, conditions=windy)
    inside, sigma = run.window(0), run.contact_force_statistics()[0].std
    assert np.abs(run.missing_energy).max() < 2e-3 * np.abs(run.data["lost_work"].values).max()
    steady = cf.simulate(shape, [head], speed=70.0, conditions=cf.Conditions(wind=cf.Wind(speed=MEAN)))
    gap = steady.filtered_contact_force()[0] - run.filtered_contact_force()[0]
    assert np.sqrt((gap[inside] ** 2).mean()) > 0.03 * sigma  # the record does something
    for method in ("linearised", "exudyn"):
        other = cf.simulate(shape, [head], speed=70.0, method=method, conditions=windy)
        gap = other.filtered_contact_force()[0] - run.filtered_contact_force()[0]
        assert np.sqrt((gap[inside] ** 2).mean()) < 0.02 * sigma, method


def test_a_run_longer_than_the_record_is_refused(span: cf.Shape) -> None:
    wind = cf.Wind(speed=[(3.0, 0.0, 10.0), (5.0, 0.0, 11.0)])
    system = cf.settle(span, cf.Conditions(wind=wind)).system
    assert system.signals(np.array([0.0, 2.0])).shape == (1, 2)
    with pytest.raises(cf.InputError, match="the record has 2 s, and the run lasts longer"):
        system.signals(np.array([2.1]))


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"speed": [(0.0, 0.0, 5.0)]}, "at x = 0 m: must have at least two times"),
        ({"speed": [(0.0, 0.0, 5.0), (0.0, 0.0, 6.0)]}, "at least two times, in order"),
        ({"speed": [(0, 0, 5.0), (1, 0, 6.0), (2, 9, 5.0), (3, 9, 6.0)]}, "must have a time in common"),
        ({"speed": [(0, 0, 5.0), (1, 0, 101.0)]}, "entry 2: speed 101.0: must be a number from 0 to 100"),
        ({"speed": [(0, 0, 5.0), (1, 0)]}, r"must be a row \[time, x, speed\]"),
        (
            {"speed": [(0, 0, 5.0), (1, 0, 6.0)], "gusts": {"intensity": 0.1, "length_scale": 80.0}},
            "both vary the wind",
        ),
    ],
)
def test_faults(fields: dict, said: str) -> None:
    with pytest.raises(cf.InputError, match=said):
        cf.Wind(**fields)
