"""Method of lines against closed forms, with fitted rates (eq. 8)."""

import numpy as np
import pytest
from theory_checks import RHO, STRING, C, T, apart, apart_l2, beam_with, fitted_rate

from catenary_fe.theory import (
    ElasticPantograph,
    HarmonicForce,
    MovingForce,
    angular_frequency,
    elastic_pantograph_force,
    initial_value_series,
    linear_law,
    moving_force_by_images,
    moving_force_on_supports,
    moving_force_series,
    reflected_waves,
    solve_by_lines,
)

L, EI = 60.0, 2e5
SPAN = {"ends": (0.0, L)}
TIMES = np.linspace(0.0, 0.6, 13)
COLUMN = TIMES[:, None]


def bell(x):
    return 0.1 * np.exp(-(((x - 25.0) / 4.0) ** 2))


def test_smooth_waves_converge_at_second_order():
    def error(intervals, tension=T):
        run = solve_by_lines(
            beam_with(tension=tension),
            TIMES,
            **SPAN,
            intervals=intervals,
            initial_deflection=bell,
            tolerance=1e-8,
        )
        exact = reflected_waves(STRING, run.x, COLUMN, length=L, initial_deflection=bell)
        return apart_l2(run.deflection, exact)

    intervals = np.array([100, 200, 400])
    errors = [error(n) for n in intervals]
    assert fitted_rate(L / intervals, errors) == pytest.approx(2.0, abs=0.2)  # order of eq. 8
    assert errors[-1] < 3e-3  # (k h)²/24 of the phase, over 73 m of a bell 4 m wide
    assert error(400, tension=1.01 * T) > 1e-2  # negative control
    step = L / 400
    assert (
        error(400, tension=T * step) > 0.5
    )  # negative control: division by h as printed is T h in place of T


def test_smooth_beam_converges_at_second_order():
    times = np.array([0.02, 0.05])

    def run(intervals, stiffness=EI):
        return solve_by_lines(
            beam_with(stiffness),
            times,
            ends=(-75.0, 125.0),
            intervals=intervals,
            initial_deflection=bell,
            tolerance=1e-8,
        )

    def error(result):
        exact = initial_value_series(
            beam_with(EI),
            result.x + 75.0,
            times[:, None],
            length=200.0,
            initial_deflection=lambda x: bell(x - 75.0),
        )
        return apart_l2(result.deflection, exact)

    intervals = np.array([400, 800])
    errors = [error(run(n)) for n in intervals]
    assert fitted_rate(200.0 / intervals, errors) == pytest.approx(2.0, abs=0.2)
    assert errors[-1] < 4e-3
    assert error(run(800, 1.05 * EI)) > 8e-3  # negative control


@pytest.mark.parametrize("ratio", [0.0, 0.725, 1.5])
def test_moving_force_on_a_string(ratio):
    load = {"speed": ratio * C, "start": 20.0}
    force = HarmonicForce(mean=200.0, amplitude=60.0, angular_frequency=30.0)

    def error(intervals, factor=1.0):
        run = solve_by_lines(
            STRING,
            TIMES,
            **SPAN,
            intervals=intervals,
            loads=[MovingForce(force=force, **{**load, "speed": factor * ratio * C})],
        )
        return apart_l2(
            run.deflection, moving_force_by_images(STRING, run.x, COLUMN, length=L, force=force, **load)
        )

    intervals = np.array([120, 240, 480])
    errors = [error(n) for n in intervals]
    # a kink is seen to first order; a force at rest, always at a node, better: (3/2)·(2/3) … 3/2
    assert 0.8 < fitted_rate(L / intervals, errors) < 1.6
    assert errors[-1] < 0.01
    if ratio == 0.725:
        assert error(480, factor=1.03) > 0.015  # negative control: the force 3 % faster


def test_moving_force_on_a_beam():
    load = {"force": 200.0, "speed": 88.9, "start": 15.0}

    def run(stiffness):
        return solve_by_lines(beam_with(stiffness), TIMES, **SPAN, intervals=240, loads=[MovingForce(**load)])

    result = run(EI)
    series = moving_force_series(beam_with(EI), result.x, COLUMN, length=L, **load)
    assert apart_l2(result.deflection, series) < 2e-3  # second order, 0.25 m against a layer of 3.2 m
    assert apart_l2(run(1.05 * EI).deflection, series) > 4e-3  # negative control
    assert apart_l2(run(0.0).deflection, series) > 0.05  # negative control: no bending


def test_supports_decouple_a_string_also_when_mistuned():
    supports = [12.0, 25.0, 30.0, 48.0]
    run = solve_by_lines(
        STRING, TIMES, **SPAN, intervals=480, supports=supports, loads=[MovingForce(force=200.0, speed=88.9)]
    )
    exact = moving_force_on_supports(
        STRING, run.x, COLUMN, supports=[0.0, *supports, 60.0], speed=88.9, force=200.0
    )
    assert apart_l2(run.deflection, exact) < 0.03  # first order: 0.125 m on bays of 5 m to 18 m, many echoes
    assert np.all(run.deflection[:, np.isin(run.x, supports)] == 0.0)
    shifted = moving_force_on_supports(
        STRING, run.x, COLUMN, supports=[0.0, 12.0, 25.5, 30.0, 48.0, 60.0], speed=88.9, force=200.0
    )
    assert apart_l2(run.deflection, shifted) > 0.1  # negative control: one support 0.5 m off


def test_beam_runs_through_its_supports():
    run = solve_by_lines(
        beam_with(EI),
        [0.1],
        **SPAN,
        intervals=120,
        supports=[30.0],
        loads=[MovingForce(force=200.0, speed=0.0, start=20.0)],
    )
    beyond = run.deflection[0, run.x > 30.0]
    assert (
        np.max(np.abs(beyond)) > 0.01 * run.deflection.max()
    )  # eq. 1: waves pass a point support by bending
    assert run.deflection[0, 60] == 0.0


def test_both_integrators_agree():
    case = {
        **SPAN,
        "intervals": 60,
        "loads": [ElasticPantograph(law=linear_law(force=200.0, stiffness=3e3), speed=88.9, start=10.0)],
    }
    explicit = solve_by_lines(beam_with(EI), TIMES[:5], **case, integrator="explicit", tolerance=1e-7)
    stiff = solve_by_lines(beam_with(EI), TIMES[:5], **case, integrator="stiff", tolerance=1e-7)
    assert (explicit.integrator, stiff.integrator) == ("DOP853", "Radau")
    assert apart(stiff.deflection, explicit.deflection) < 1e-5  # their tolerances, accumulated
    loose = solve_by_lines(beam_with(EI, tension=1.01 * T), TIMES[:5], **case, integrator="stiff")
    assert apart(loose.deflection, explicit.deflection) > 1e-4  # negative control


def test_stiffness_chooses_and_says_why():
    string = solve_by_lines(STRING, [0.01], **SPAN, intervals=200)
    assert string.integrator == "DOP853"
    assert string.why.startswith("not stiff")
    fine = solve_by_lines(
        beam_with(EI), [2e-4], ends=(0.0, 2.0), intervals=100, initial_deflection=lambda x: np.sin(np.pi * x)
    )
    assert fine.integrator == "Radau"
    assert fine.why.startswith("stiff")
    assert "above" in fine.why and "rad/s" in fine.why


def test_elastic_pantograph_equals_the_closed_form():
    times = np.linspace(0.0, 0.2, 9)  # before an echo returns

    def run(stiffness):
        return solve_by_lines(
            STRING,
            times,
            **SPAN,
            intervals=960,
            loads=[
                ElasticPantograph(law=linear_law(force=200.0, stiffness=stiffness), speed=0.5 * C, start=20.0)
            ],
        )

    exact = elastic_pantograph_force(STRING, times, speed=0.5 * C, force=200.0, stiffness=1000.0)
    result = run(1000.0)
    assert apart(result.force, exact) < 5e-3  # first order in h = 1/16 m
    assert apart(run(1050.0).force, exact) > 5e-3  # negative control


def test_a_pantograph_never_pulls():
    run = solve_by_lines(
        STRING,
        np.linspace(0.0, 0.3, 31),
        **SPAN,
        intervals=120,
        initial_deflection=lambda x: 0.2 * np.sin(np.pi * x / L),
        loads=[ElasticPantograph(law=lambda u: 200.0 - 3000.0 * u - 1e4 * u**3, speed=50.0, start=5.0)],
    )
    assert run.force.min() == 0.0
    assert run.force.max() > 100.0


def test_energy_of_free_motion_is_kept():
    run = solve_by_lines(beam_with(EI), TIMES, **SPAN, intervals=120, initial_deflection=bell, tolerance=1e-9)
    h = L / 120
    second = np.diff(run.deflection, 2, axis=1) / h**2
    energy = (
        0.5
        * h
        * (
            RHO * np.sum(run.velocity**2, axis=1)
            + T * np.sum((np.diff(run.deflection, axis=1) / h) ** 2, axis=1)
            + EI * np.sum(second**2, axis=1)
        )
    )
    assert energy == pytest.approx(np.full(13, energy[0]), rel=1e-6)  # tolerance of the integration
    assert energy - 0.01 * 0.5 * h * T * np.sum(
        (np.diff(run.deflection, axis=1) / h) ** 2, axis=1
    ) != pytest.approx(np.full(13, energy[0]), rel=1e-6)  # negative control: the tension 1 % less


def test_loads_add_up_and_leave():
    first = MovingForce(force=200.0, speed=120.0, start=30.0)
    second = MovingForce(force=100.0, speed=120.0, start=-7.0)
    both, one, other = (
        solve_by_lines(STRING, TIMES, **SPAN, intervals=60, loads=loads, tolerance=1e-7)
        for loads in ([first, second], [first], [second])
    )
    assert apart(both.deflection, one.deflection + other.deflection) < 1e-5
    assert both.forces.shape == (13, 2)
    assert both.forces[0].tolist() == [200.0, 0.0]  # the trailing one has not yet entered
    assert both.forces[-1].tolist() == [0.0, 0.0]  # both have left
    assert apart(both.force, both.forces.sum(axis=1)) == 0.0


def test_a_foundation_raises_the_frequency():
    k, height, bed = np.pi / L, 0.01, beam_with(EI, foundation_stiffness=2e3)

    def error(wire):
        run = solve_by_lines(
            wire, TIMES, **SPAN, intervals=120, initial_deflection=lambda x: height * np.sin(k * x)
        )
        exact = np.cos(float(angular_frequency(bed, k)) * COLUMN) * height * np.sin(k * run.x)
        return apart(run.deflection, exact)

    assert error(bed) < 1e-3  # (k h)²/24 of the phase and the tolerance of the integration
    assert error(beam_with(EI, foundation_stiffness=2.1e3)) > 0.01  # negative control
    assert error(beam_with(EI)) > 0.1  # negative control: no foundation


def test_start_only():
    run = solve_by_lines(STRING, [0.0], **SPAN, intervals=60, initial_deflection=bell)
    inside = run.x[1:-1]
    assert apart(run.deflection[0, 1:-1], bell(inside)) == 0.0
