"""A new connector and a new load, each one function here: statics, modes and every engine see them."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import csr_matrix

import catenary_fe as cf
from catenary_fe.fe.system import System, TimeLoad

METHODS = ("nonlinear", "linearised", "exudyn")
SPEED = 60.0  # [m/s]


def spring(x: float, stiffness: float):
    """A spring from the contact wire to the messenger wire at any place, force-free as installed."""

    def effect(system: System) -> System:
        row = csr_matrix(system.row(1, x) - system.row(0, x))
        return replace(system, linear_stiffness=system.linear_stiffness + stiffness * (row.T @ row))

    return effect


def push(per_length: float, begin: float, end: float, signal=None):
    """A force along the contact wire [N/m] between two places, constant or in time."""

    def effect(system: System) -> System:
        x = system.wires[0].x
        middle = np.zeros(system.first.size)
        middle[: x.size - 1] = (x[1:] + x[:-1]) / 2
        force = system.distributed(np.where((middle > begin) & (middle < end), per_length, 0.0))
        if signal is None:
            return replace(system, force=system.force + force)
        return replace(system, time_loads=(*system.time_loads, TimeLoad(force, signal)))

    return effect


@pytest.fixture(scope="module")
def line(short):
    return short.replace(spans=short.spans[:3], supports=short.supports[:4], evaluated_spans=(2,))


@pytest.fixture(scope="module")
def shape(line):
    return cf.find_form(line)


def run(shape, pantograph, method):
    energy = method == "exudyn"
    return cf.simulate(shape, [pantograph], speed=SPEED, positions=[40.0], method=method, energy=energy)


def force(run):
    return run.data["contact_force"].values[0]


def test_a_spring_beside_a_dropper_is_a_stiffer_dropper(line, shape):
    """Of the same line: modes about the static state see stiffnesses alone."""
    number = 14
    x, k = line.dropper_positions[number], line.droppers[number].stiffness
    beside = cf.solve_modes(shape.with_effect(spring(x, k)), count=40).frequencies
    droppers = list(line.spans[1].droppers)
    inside = number - len(line.spans[0].droppers)
    droppers[inside] = droppers[inside].replace(stiffness=2 * k)
    spans = (line.spans[0], line.spans[1].replace(droppers=tuple(droppers)), line.spans[2])
    stiffer = cf.solve_modes(cf.find_form(line.replace(spans=spans)), count=40).frequencies
    assert beside == pytest.approx(stiffer, rel=1e-6)
    assert cf.solve_modes(shape, count=40).frequencies != pytest.approx(stiffer, rel=1e-6)


def test_a_spring_holds_the_wire_down(shape):
    """In the middle of a field between droppers: its force is its stiffness times what it is stretched."""
    x, k = 80.25, 5e3
    alone, held = (
        cf.elasticity(s, force=100.0, positions=[x]).uplift[0]
        for s in (shape, shape.with_effect(spring(x, k)))
    )
    assert held < 0.99 * alone


def test_a_load_along_the_wire_is_many_forces(shape):
    per_length, begin, end = 2.0, 85.0, 95.0
    places = np.arange(begin + 0.125, end, 0.25)
    many = cf.solve_statics(shape, [(x, 0.25 * per_length) for x in places]).contact_wire_uplift
    one = cf.solve_statics(shape.with_effect(push(per_length, begin, end))).contact_wire_uplift
    assert one == pytest.approx(many, abs=0.01 * many.max())
    assert many.max() > 3e-3


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("effect", [spring(80.25, 2e4), push(3.0, 70.0, 110.0)], ids=["spring", "load"])
def test_a_run_feels_it(shape, pantograph, method, effect):
    before, after = (run(s, pantograph, method) for s in (shape, shape.with_effect(effect)))
    assert np.std(force(after) - force(before)) > 0.02 * np.std(force(before))
    other = run(shape.with_effect(effect), pantograph, METHODS[0])
    assert np.std(force(after) - force(other)) <= 0.05 * np.std(force(other))


@pytest.mark.parametrize("method", METHODS)
def test_a_load_in_time_that_is_always_the_same_is_a_constant_one(shape, pantograph, method):
    constant = run(shape.with_effect(push(3.0, 70.0, 110.0)), pantograph, method)
    signal = run(shape.with_effect(push(3.0, 70.0, 110.0, np.ones_like)), pantograph, method)
    assert force(signal) == pytest.approx(force(constant), abs=1e-3)


def test_a_load_in_time_is_the_same_on_all_engines(shape, pantograph):
    """A gust that lasts half a second; the energy balances of nonlinear and Exudyn's runs count its work."""
    gust = push(2.0, 60.0, 120.0, lambda t: np.where(t < 0.5, np.sin(2 * np.pi * t) ** 2, 0.0))
    runs = [run(shape.with_effect(gust), pantograph, method) for method in METHODS]
    still = force(run(shape, pantograph, METHODS[0]))
    assert np.std(force(runs[0]) - still) > 0.1 * np.std(still)
    for other in runs[1:]:
        assert np.std(force(other) - force(runs[0])) < 0.05 * np.std(force(runs[0]))
    for whole in (runs[0], runs[2]):
        balance = [check for check in whole.checks if "energy" in check.name]
        assert len(balance) >= 2 and all(check.passed for check in balance)
    assert runs[2].data["driven_work"].values == pytest.approx(runs[0].data["driven_work"].values, abs=0.05)


def test_forces_are_what_the_system_says(shape):
    """Rates count through dampers alone; a load in time through its signal."""
    system = shape.with_effect(push(1.0, 70.0, 110.0, lambda t: 2 * t)).system
    still = np.zeros(system.dof.size)
    at_rest, later = (system.forces(still, still, t) for t in (0.0, 1.5))
    assert later - at_rest == pytest.approx(3.0 * system.patterns.toarray()[:, 0])
    rates = np.random.default_rng(2).normal(0, 1e-3, still.size) * (system.dof >= 0)
    drag = at_rest - system.forces(still, rates, 0.0)
    damping = system.free(system.damping() + system.taut_damping())
    expected = damping @ np.array([rates[np.flatnonzero(system.dof == i)[0]] for i in range(system.size)])
    assert drag == pytest.approx(expected, abs=1e-9 * np.abs(expected).max())
