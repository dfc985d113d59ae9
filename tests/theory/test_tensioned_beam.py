"""Statics, moving force and free waves of the tensioned beam (eq. 1)."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp, trapezoid
from theory_checks import HEAVIER, RHO, STRING, C, T, apart, apart_l2, beam_with

from catenary_fe.theory import (
    HarmonicForce,
    group_velocity,
    initial_value_series,
    moving_force_by_images,
    moving_force_series,
    running_waves,
    static_deflection,
    static_deflection_unbounded,
    static_uniform_load,
)

L, EI = 60.0, 2e5
X = np.linspace(0.0, L, 241)
BEAM = beam_with(EI)


def test_mid_span_load():
    u = 0.5 * L * np.sqrt(T / EI)
    reference = 200.0 * L / (4.0 * T) * (1.0 - np.tanh(u) / u)
    assert static_deflection(BEAM, 30.0, length=L, position=30.0, force=200.0) == pytest.approx(
        reference, rel=1e-12
    )
    control = static_deflection(beam_with(1.05 * EI), 30.0, length=L, position=30.0, force=200.0)
    assert control != pytest.approx(reference, rel=1e-4)


def numeric_beam(load, stiffness=EI):
    """Pinned tensioned beam by collocation, knowing nothing of the closed forms."""

    def rates(x, y):
        return np.vstack([y[1], y[2], y[3], (load(x) + T * y[2]) / stiffness])

    solution = solve_bvp(
        rates, lambda a, b: [a[0], a[2], b[0], b[2]], X, np.zeros((4, X.size)), tol=1e-8, max_nodes=20_000
    )
    assert solution.success
    return solution.sol(X)[0]


def test_uniform_load_equals_collocation():
    closed = static_uniform_load(BEAM, X, length=L, load=-13.0)
    assert apart(closed, numeric_beam(lambda x: -13.0 + 0.0 * x)) < 1e-6  # tolerance of the collocation
    assert (
        apart(closed, numeric_beam(lambda x: -13.0 + 0.0 * x, stiffness=1.05 * EI)) > 1e-4
    )  # negative control


@pytest.mark.parametrize("position", [3.0, 17.0, 30.0])
def test_point_force_anywhere_is_the_greens_function(position):
    # symmetric (Maxwell), and summed over all positions the uniform load
    other = 41.0
    there = static_deflection(BEAM, other, length=L, position=position, force=1.0)
    assert there == pytest.approx(
        float(static_deflection(BEAM, position, length=L, position=other, force=1.0)), rel=1e-12
    )
    positions = np.linspace(0.0, L, 2001)
    line = [float(static_deflection(BEAM, position, length=L, position=a, force=1.0)) for a in positions]
    uniform = float(static_uniform_load(BEAM, position, length=L, load=1.0))
    assert trapezoid(line, positions) == pytest.approx(uniform, rel=1e-6)  # (0.03 m)² of the trapezoidal rule
    assert trapezoid(line, positions) != pytest.approx(1.01 * uniform, rel=1e-3)  # negative control


def test_boundary_layer():
    layer = BEAM.boundary_layer_length
    assert layer == pytest.approx(np.sqrt(10.0))
    x = 2000.0 + np.linspace(0.0, 30.0, 61)
    below = static_deflection(BEAM, x, length=4000.0, position=2000.0, force=200.0)
    free = static_deflection_unbounded(BEAM, x, force=200.0, position=2000.0)
    assert np.max(np.abs(below - below[0] - free)) < 1e-12
    control = static_deflection_unbounded(beam_with(1.01 * EI), x, force=200.0, position=2000.0)
    assert np.max(np.abs(below - below[0] - control)) > 1e-5


def test_string_is_the_limit_of_small_stiffness():
    string = static_deflection(STRING, X, length=L, position=20.0, force=200.0)
    thin = static_deflection(beam_with(1e-6), X, length=L, position=20.0, force=200.0)
    none = static_deflection(beam_with(0.0), X, length=L, position=20.0, force=200.0)
    assert apart(thin, string) < 1e-5  # F/2T √(EI/T) of F L/T
    assert apart(none, string) < 1e-15
    sag = static_uniform_load(STRING, 30.0, length=L, load=-13.0)
    assert sag == pytest.approx(-13.0 * L**2 / (8.0 * T), rel=1e-12)


TIMES = np.linspace(0.0, 1.0, 21)[:, None]
HARMONIC = HarmonicForce(mean=200.0, amplitude=100.0, angular_frequency=40.0)


def test_moving_force_without_stiffness_equals_the_string():
    case = {"length": L, "speed": 88.9, "force": HARMONIC, "start": 4.0}
    string = moving_force_by_images(STRING, X, TIMES, **case)
    plain = moving_force_series(STRING, X, TIMES, **case, modes=1500, accelerate=False)
    assert apart(plain, string) < 1e-3  # kinks: terms 1/n², rest 1/N
    nearly = moving_force_series(beam_with(1e-3), X, TIMES, **case, modes=1500)
    assert apart_l2(nearly, string) < 1e-3
    assert apart_l2(moving_force_series(BEAM, X, TIMES, **case), string) > 0.01  # negative control


def test_slow_travel_over_a_beam_is_static():
    speed = 1e-3 * C
    crawl = moving_force_series(BEAM, X, 0.5 * L / speed, length=L, speed=speed, force=200.0)
    static = static_deflection(BEAM, X, length=L, position=30.0, force=200.0)
    assert apart(crawl, static) < 2e-3  # the start rings with V/c
    assert apart(1.01 * crawl, static) > 5e-3  # negative control


def bell(x):
    return 0.1 * np.exp(-(((x - 5.0) / 2.0) ** 2))


WIDE = np.linspace(-120.0, 130.0, 251)


def let_go(wire, x, t):
    """The bell on a wire whose pinned ends, 400 m away, send nothing back in time."""
    free = {"length": 800.0, "initial_deflection": lambda s: bell(s - 400.0), "modes": 1200}
    return initial_value_series(wire, x + 400.0, t, **free)


def test_free_waves_without_stiffness_are_dalemberts():
    t = np.linspace(0.0, 0.4, 5)[:, None]
    spectral = let_go(STRING, WIDE, t)
    assert apart(spectral, running_waves(STRING, WIDE, t, initial_deflection=bell)) < 1e-10
    off = running_waves(HEAVIER, WIDE, t, initial_deflection=bell)
    assert apart(spectral, off) > 0.01  # negative control


def test_free_waves_run_ahead_and_solve_the_equation():
    t, h = 0.2, 0.05
    x = WIDE[None, :] + h * np.arange(-2, 3)[:, None]
    u = let_go(BEAM, x, t)
    fourth = (u[0] - 4 * u[1] + 6 * u[2] - 4 * u[3] + u[4]) / h**4
    second = (u[1] - 2 * u[2] + u[3]) / h**2
    tau = 2e-5
    before, after = (let_go(BEAM, WIDE, t + s) for s in (-tau, tau))
    acceleration = (before - 2 * u[2] + after) / tau**2
    residual = RHO * acceleration + EI * fourth - T * second
    scale = np.max(np.abs(RHO * acceleration))
    assert np.max(np.abs(residual)) < 2e-3 * scale  # h² k²/6 at k ≈ 2 rad/m
    assert np.max(np.abs(residual + 0.01 * EI * fourth)) > 4e-3 * scale  # negative control: EI off by 1 %
    ahead = np.abs(WIDE - 5.0) > C * t + 8.0
    assert np.max(np.abs(u[2][ahead])) > 0.005
    assert group_velocity(BEAM, 1.0) > 3.0 * C


def test_free_waves_keep_their_area():
    x = np.linspace(-390.0, 390.0, 1561)
    for t in (0.0, 0.05, 0.1):
        u = let_go(BEAM, x, t)
        assert trapezoid(u, x) == pytest.approx(0.1 * 2.0 * np.sqrt(np.pi), rel=1e-6)
