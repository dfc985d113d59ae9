"""Running waves and distributed loads on the infinite string (eq. 2 to 4)."""

import numpy as np
import pytest
from theory_checks import RHO, STRING, TIGHTER, C, T, apart, string_residual

from catenary_fe.theory import distributed_load, moving_force, running_waves


def bell(x):
    return 0.1 * np.exp(-((x / 3.0) ** 2))


def push(x):
    return 2.0 * np.exp(-((x / 3.0) ** 2))


def push_integral(x):
    from scipy.special import erf

    return np.sqrt(np.pi) * 3.0 * erf(x / 3.0)


X = np.linspace(-40.0, 40.0, 161)
TIMES = np.linspace(0.0, 0.3, 7)[:, None]


def test_wave_speed_of_the_papers_wire():
    assert pytest.approx(122.6, abs=0.05) == C  # printed to one decimal


def test_running_waves_solve_the_wave_equation():
    def u(x, t):
        return running_waves(
            STRING,
            x,
            t,
            initial_deflection=bell,
            initial_velocity=push,
            velocity_antiderivative=push_integral,
        )

    at = np.linspace(0.05, 0.25, 5)[:, None]
    assert (
        string_residual(u, X, at) < 1e-3
    )  # second differences of 0.05 m on a bell 3 m wide: (0.05/3)² ≈ 3e-4
    assert string_residual(u, X, at, c=1.01 * C) > 1e-2  # negative control: c off by 1 %


def test_running_waves_start_as_told():
    assert apart(running_waves(STRING, X, 0.0, initial_deflection=bell), bell(X)) < 1e-15
    tau = 1e-7
    rate = running_waves(STRING, X, tau, initial_velocity=push) / tau
    assert apart(rate, push(X)) < 1e-6  # Taylor: c² τ² v₀''/6


def test_velocity_by_quadrature_equals_the_antiderivative():
    quadrature = running_waves(STRING, X, TIMES, initial_velocity=push)
    closed = running_waves(STRING, X, TIMES, velocity_antiderivative=push_integral)
    assert quadrature.shape == (7, 161)
    assert apart(quadrature, closed) < 1e-12  # 8 Gauss points a panel reach rounding


def test_a_jump_in_velocity_needs_its_breakpoints():
    def box(x):
        return np.where(np.abs(x) < 1.23, 1.0, 0.0)

    def integral(x):
        return np.clip(x, -1.23, 1.23)

    closed = running_waves(STRING, X, TIMES, velocity_antiderivative=integral)
    told = running_waves(STRING, X, TIMES, initial_velocity=box, breakpoints=(-1.23, 1.23))
    untold = running_waves(STRING, X, TIMES, initial_velocity=box)
    assert apart(told, closed) < 1e-12
    assert apart(untold, closed) > 1e-6


def test_the_shift_splits_into_two_halves():
    u = running_waves(STRING, [-C * 0.2, 0.0, C * 0.2], 0.2, initial_deflection=bell)
    assert u == pytest.approx([0.05, 0.0, 0.05], abs=1e-12)


def manufactured(x, t):
    return np.sin(0.2 * x) * t**2


def manufactured_load(x, t):
    return np.sin(0.2 * x) * (2.0 * RHO + T * 0.04 * t**2)


def test_distributed_load_reproduces_a_manufactured_solution():
    computed = distributed_load(STRING, X, TIMES, load=manufactured_load)
    assert apart(computed, manufactured(X, TIMES)) < 1e-12
    printed = RHO * C * computed  # negative control: ½ ∬ f as printed in eq. 4
    assert apart(printed, manufactured(X, TIMES)) > 1.0
    tighter = distributed_load(TIGHTER, X, TIMES, load=manufactured_load)
    assert apart(tighter, manufactured(X, TIMES)) > 1e-3  # negative control: T off by 1 %


def test_waves_and_load_together_solve_eq_2():
    def u(x, t):
        waves = running_waves(STRING, x, t, initial_deflection=bell, initial_velocity=push)
        return waves + distributed_load(STRING, x, t, load=manufactured_load)

    at = np.linspace(0.05, 0.25, 3)[:, None]
    load = manufactured_load(X, at) / RHO
    assert string_residual(u, X, at, load=load) < 1e-3  # as above
    assert string_residual(u, X, at, load=1.01 * load) > 2e-3  # negative control


def test_a_narrow_moving_load_tends_to_the_moving_force():
    width, speed = 1.5, 0.5 * C

    def load(x, t):
        return 200.0 * np.exp(-(((x - speed * t) / width) ** 2)) / (width * np.sqrt(np.pi))

    x, t = np.array([-30.0, -10.0, 5.0, 28.0, 40.0]), 0.4  # none within 2 widths of the force or a front
    point = moving_force(STRING, x, t, speed=speed, force=200.0)
    # 200 points over 98 m resolve the load; what is smeared only matters at kinks
    assert apart(distributed_load(STRING, x, t, load=load, points=200), point) < 1e-4
