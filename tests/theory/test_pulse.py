"""A pulse at a mass, spring or damper in time, against the coefficients in frequency."""

import numpy as np
import pytest
from scipy.integrate import trapezoid
from theory_checks import RHO, STRING, C, T, apart, string_residual

from catenary_fe.theory import lumped_impedance, pulse_at_obstacle, running_waves, scatter_at_obstacle

OBSTACLES = [{"mass": 2.0}, {"stiffness": 2e4}, {"mass": 1.0, "stiffness": 3e4}, {"damping": 150.0}]


def pulse(t):
    return 0.05 * np.exp(-(((t - 0.1) / 0.015) ** 2))


CASE = {"incident": pulse, "begin": 0.0}  # pulse(0) = 2e-21 m


@pytest.mark.parametrize("obstacle", OBSTACLES)
def test_spectra_are_the_scattering_coefficients(obstacle):
    t = np.linspace(0.0, 8.0, 16_385)[:-1]
    omega = 2.0 * np.pi * np.fft.rfftfreq(t.size, t[1])[1:200]  # below, the pulse has energy: ωτ < 2.4
    sent = np.fft.rfft(pulse(t))[1:200]
    gone = np.fft.rfft(pulse_at_obstacle(STRING, 0.0, t, **CASE, **obstacle))[1:200]
    back = np.fft.rfft(pulse_at_obstacle(STRING, -1e-9, t, **CASE, **obstacle) - pulse(t))[1:200]
    met = scatter_at_obstacle(STRING, lumped_impedance(omega, **obstacle))
    assert apart(gone / sent, met.transmission) < 1e-6  # by what still rings after 8 s and the integrator
    assert apart(back / sent, met.reflection) < 1e-6
    off = {name: 1.01 * value for name, value in obstacle.items()}
    control = scatter_at_obstacle(STRING, lumped_impedance(omega, **off))
    assert apart(gone / sent, control.transmission) > 1e-4


def energy(u_dot, slope, x):
    return 0.5 * trapezoid(RHO * u_dot**2 + T * slope**2, x)


def test_mass_and_spring_give_all_energy_back():
    x = np.linspace(-150.0, 150.0, 6001)
    h, tau = 1e-4, 1e-6

    def wire_energy(t, obstacle):
        def u(x, t):
            return pulse_at_obstacle(STRING, x, t, **CASE, **obstacle)

        sides = x[np.abs(x) > 1e-3]
        velocity = (u(sides, t + tau) - u(sides, t - tau)) / (2 * tau)
        return energy(velocity, (u(sides + h, t) - u(sides - h, t)) / (2 * h), sides)

    came = energy(
        (pulse(0.0 - x / C + tau) - pulse(0.0 - x / C - tau)) / (2 * tau),
        (pulse(-(x + h) / C) - pulse(-(x - h) / C)) / (2 * h),
        x,
    )
    assert wire_energy(1.0, {"mass": 2.0, "stiffness": 2e4}) == pytest.approx(came, rel=1e-4)
    assert wire_energy(1.0, {"damping": 150.0}) < 0.9 * came  # negative control: a damper keeps some


def test_no_obstacle_is_a_running_wave_and_a_wall_turns_it_over():
    x, t = np.linspace(-40.0, 40.0, 161), np.array([0.05, 0.1, 0.2])[:, None]
    free = pulse_at_obstacle(STRING, x, t, **CASE)
    assert np.max(np.abs(free - pulse(t - x / C))) < 1e-12
    half = running_waves(STRING, x, t, initial_deflection=lambda y: 2.0 * pulse(-y / C))
    assert np.max(np.abs(half - pulse(t - x / C) - pulse(-t - x / C))) < 1e-12
    wall = pulse_at_obstacle(STRING, x, t, **CASE, damping=1e9)
    left = x < 0.0
    assert np.max(np.abs(wall[:, left] - (pulse(t - x / C) - pulse(t + x / C))[:, left])) < 1e-6


def test_solves_the_wave_equation_and_is_continuous():
    def u(x, t):
        return pulse_at_obstacle(STRING, x, t, **CASE, mass=2.0, stiffness=1e4)

    x, t = np.array([-15.0, -8.0, -3.0, 3.0, 8.0, 15.0]), np.array([0.1, 0.15])[:, None]
    assert string_residual(u, x, t) < 1e-2  # 0.05 m against a pulse of 1.8 m and the mass's quick answer
    assert string_residual(u, x, t, c=1.03 * C) > 3e-2  # negative control
    assert u(-1e-9, 0.12) == pytest.approx(float(u(1e-9, 0.12)), abs=1e-9)
