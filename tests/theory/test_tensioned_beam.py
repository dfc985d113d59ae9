"""Statics, moving force and free waves of the tensioned beam (eq. 1)."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp, trapezoid
from theory_checks import RHO, WIRE, C, T, apart, apart_l2

from catenary_fe.theory import (
    HarmonicForce,
    beam_free_waves,
    beam_moving_force,
    beam_point_force,
    beam_point_force_unbounded,
    beam_uniform_load,
    boundary_layer_length,
    group_velocity,
    moving_force_by_images,
    running_waves,
    static_deflection,
)

L, EI = 60.0, 2e5
X = np.linspace(0.0, L, 241)
BEAM = {"tension": T, "bending_stiffness": EI, "length": L}


def test_mid_span_load():
    u = 0.5 * L * np.sqrt(T / EI)
    reference = 200.0 * L / (4.0 * T) * (1.0 - np.tanh(u) / u)
    assert beam_point_force(30.0, **BEAM, position=30.0, force=200.0) == pytest.approx(reference, rel=1e-12)
    twin = beam_point_force(30.0, **{**BEAM, "bending_stiffness": 1.05 * EI}, position=30.0, force=200.0)
    assert twin != pytest.approx(reference, rel=1e-4)


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
    closed = beam_uniform_load(X, **BEAM, load=-13.0)
    assert apart(closed, numeric_beam(lambda x: -13.0 + 0.0 * x)) < 1e-6  # tolerance of the collocation
    assert apart(closed, numeric_beam(lambda x: -13.0 + 0.0 * x, stiffness=1.05 * EI)) > 1e-4  # twin


@pytest.mark.parametrize("position", [3.0, 17.0, 30.0])
def test_point_force_anywhere_is_the_greens_function(position):
    # symmetric (Maxwell), and summed over all positions the uniform load
    other = 41.0
    there = beam_point_force(other, **BEAM, position=position, force=1.0)
    assert there == pytest.approx(
        float(beam_point_force(position, **BEAM, position=other, force=1.0)), rel=1e-12
    )
    positions = np.linspace(0.0, L, 2001)
    line = [float(beam_point_force(position, **BEAM, position=a, force=1.0)) for a in positions]
    uniform = float(beam_uniform_load(position, **BEAM, load=1.0))
    assert trapezoid(line, positions) == pytest.approx(uniform, rel=1e-6)  # (0.03 m)² of the trapezoidal rule
    assert trapezoid(line, positions) != pytest.approx(1.01 * uniform, rel=1e-3)  # twin


def test_boundary_layer():
    layer = boundary_layer_length(tension=T, bending_stiffness=EI)
    assert layer == pytest.approx(np.sqrt(10.0))
    wide = {"tension": T, "bending_stiffness": EI, "length": 4000.0}
    x = 2000.0 + np.linspace(0.0, 30.0, 61)
    below = beam_point_force(x, **wide, position=2000.0, force=200.0)
    free = beam_point_force_unbounded(x, tension=T, bending_stiffness=EI, force=200.0, position=2000.0)
    assert np.max(np.abs(below - below[0] - free)) < 1e-12
    twin = beam_point_force_unbounded(x, tension=T, bending_stiffness=1.01 * EI, force=200.0, position=2000.0)
    assert np.max(np.abs(below - below[0] - twin)) > 1e-5


def test_string_is_the_limit_of_small_stiffness():
    string = static_deflection(X, tension=T, length=L, position=20.0, force=200.0)
    thin = beam_point_force(X, **{**BEAM, "bending_stiffness": 1e-6}, position=20.0, force=200.0)
    none = beam_point_force(X, **{**BEAM, "bending_stiffness": 0.0}, position=20.0, force=200.0)
    assert apart(thin, string) < 1e-5  # F/2T √(EI/T) of F L/T
    assert apart(none, string) < 1e-15
    sag = beam_uniform_load(30.0, **{**BEAM, "bending_stiffness": 0.0}, load=-13.0)
    assert sag == pytest.approx(-13.0 * L**2 / (8.0 * T), rel=1e-12)


TIMES = np.linspace(0.0, 1.0, 21)[:, None]
HARMONIC = HarmonicForce(mean=200.0, amplitude=100.0, angular_frequency=40.0)


def test_moving_force_without_stiffness_equals_the_string():
    case = {**WIRE, "length": L, "speed": 88.9, "force": HARMONIC, "start": 4.0}
    string = moving_force_by_images(X, TIMES, **case)
    beam = beam_moving_force(X, TIMES, **case, bending_stiffness=0.0, modes=1500)
    assert apart(beam, string) < 1e-3  # kinks: terms 1/n², rest 1/N
    nearly = beam_moving_force(X, TIMES, **case, bending_stiffness=1e-3, modes=1500)
    assert apart_l2(nearly, string) < 1e-3
    assert apart_l2(beam_moving_force(X, TIMES, **case, bending_stiffness=EI), string) > 0.01  # twin


def test_slow_travel_over_a_beam_is_static():
    speed = 1e-3 * C
    crawl = beam_moving_force(X, 0.5 * L / speed, **BEAM, mass_per_length=RHO, speed=speed, force=200.0)
    static = beam_point_force(X, **BEAM, position=30.0, force=200.0)
    assert apart(crawl, static) < 2e-3  # the start rings with V/c
    assert apart(1.01 * crawl, static) > 5e-3  # twin


def bell(x):
    return 0.1 * np.exp(-(((x - 5.0) / 2.0) ** 2))


FREE = {**WIRE, "initial_deflection": bell, "centre": 5.0, "half_width": 14.0}
WIDE = np.linspace(-120.0, 130.0, 251)


def test_free_waves_without_stiffness_are_dalemberts():
    t = np.linspace(0.0, 0.4, 5)[:, None]
    spectral = beam_free_waves(WIDE, t, **FREE, bending_stiffness=0.0)
    assert apart(spectral, running_waves(WIDE, t, wave_speed=C, initial_deflection=bell)) < 1e-10
    off = running_waves(WIDE, t, wave_speed=1.01 * C, initial_deflection=bell)
    assert apart(spectral, off) > 0.01  # twin


def test_free_waves_run_ahead_and_solve_the_equation():
    t, h = 0.2, 0.05
    x = WIDE[None, :] + h * np.arange(-2, 3)[:, None]
    u = beam_free_waves(x, t, **FREE, bending_stiffness=EI)
    fourth = (u[0] - 4 * u[1] + 6 * u[2] - 4 * u[3] + u[4]) / h**4
    second = (u[1] - 2 * u[2] + u[3]) / h**2
    tau = 2e-5
    before, after = (beam_free_waves(WIDE, t + s, **FREE, bending_stiffness=EI) for s in (-tau, tau))
    acceleration = (before - 2 * u[2] + after) / tau**2
    residual = RHO * acceleration + EI * fourth - T * second
    scale = np.max(np.abs(RHO * acceleration))
    assert np.max(np.abs(residual)) < 2e-3 * scale  # h² k²/6 at k ≈ 2 rad/m
    assert np.max(np.abs(residual + 0.01 * EI * fourth)) > 4e-3 * scale  # twin: EI off by 1 %
    ahead = np.abs(WIDE - 5.0) > C * t + 8.0
    assert np.max(np.abs(u[2][ahead])) > 0.005
    assert group_velocity(1.0, **WIRE, bending_stiffness=EI) > 3.0 * C


def test_free_waves_keep_their_area():
    x = np.linspace(-700.0, 700.0, 2801)
    for t in (0.0, 0.1, 0.3):
        u = beam_free_waves(x, t, **FREE, bending_stiffness=EI)
        assert trapezoid(u, x) == pytest.approx(0.1 * 2.0 * np.sqrt(np.pi), rel=1e-6)
