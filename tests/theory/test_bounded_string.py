"""The string between rigid ends: series against images, resonance, after the force has left (eq. 7)."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from theory_checks import HEAVIER, STRING, TIGHTER, C, T, apart, apart_l2, string_residual

from catenary_fe.theory import (
    HarmonicForce,
    initial_value_series,
    moving_force,
    moving_force_by_images,
    moving_force_series,
    natural_frequencies,
    reflected_waves,
    static_deflection,
)
from catenary_fe.theory.pinned_wire import TravellingForce

L = 60.0
X = np.linspace(0.0, L, 121)
TIMES = np.linspace(0.0, 1.4, 29)[:, None]  # three echoes, and past the leaving of every speed but the slow
HARMONIC = HarmonicForce(mean=200.0, amplitude=100.0, angular_frequency=40.0, phase=0.3)
SPAN = {"length": L}


def bump(x):
    return 0.1 * np.exp(-(((x - 20.0) / 2.5) ** 2))


def kick(x):
    return 3.0 * np.exp(-(((x - 35.0) / 2.5) ** 2))


def test_series_of_initial_values_equals_images():
    state = {"length": L, "initial_deflection": bump, "initial_velocity": kick}
    images = reflected_waves(STRING, X, TIMES, **state)
    assert (
        apart(initial_value_series(STRING, X, TIMES, **state, modes=150), images) < 1e-10
    )  # smooth: spectral
    control = initial_value_series(HEAVIER, X, TIMES, **state, modes=150)
    assert apart(control, images) > 0.1


def test_printed_cosines_meet_neither_ends_nor_start():
    n = np.arange(1, 151)[:, None]
    points = np.linspace(0.0, L, 2001)
    shapes = np.cos(n * np.pi * points / L)
    control = (2.0 / L * (shapes @ bump(points)) * (points[1] - points[0])) @ shapes
    series = initial_value_series(STRING, points, 0.0, length=L, initial_deflection=bump)
    assert apart(series, bump(points)) < 1e-10
    assert np.abs(series[[0, -1]]).max() < 1e-14
    assert (
        apart(control, bump(points)) > 0.05
    )  # negative control: shapes cos(nπx/L), which cannot even hold the mean


def test_echo_returns_inverted_and_a_period_restores():
    state = {"length": L, "initial_deflection": bump}
    half, whole = reflected_waves(STRING, X, L / C, **state), reflected_waves(STRING, X, 2.0 * L / C, **state)
    assert apart(half, -bump(L - X)) < 1e-12
    assert apart(whole, bump(X)) < 1e-12


def test_reflected_waves_solve_the_wave_equation():
    def u(x, t):
        return reflected_waves(STRING, x, t, length=L, initial_deflection=bump, initial_velocity=kick)

    at = np.linspace(0.1, 1.2, 5)[:, None]
    assert string_residual(u, X[1:-1], at) < 1e-3  # (0.05/2.5)²
    assert string_residual(u, X[1:-1], at, c=1.01 * C) > 1e-2  # negative control


def test_one_mode_is_a_standing_wave_of_two_running_waves():
    k = 3 * np.pi / L
    wave = {"length": L, "initial_deflection": lambda x: 0.1 * np.sin(k * x)}
    standing = 0.1 * np.sin(k * X) * np.cos(k * C * TIMES)
    assert apart(reflected_waves(STRING, X, TIMES, **wave), standing) < 1e-12
    assert apart(initial_value_series(STRING, X, TIMES, **wave, modes=5), standing) < 1e-12
    period = 2.0 * np.pi / natural_frequencies(STRING, 3, **SPAN)[2]
    start = reflected_waves(STRING, X, 0.0, **wave)
    assert apart(reflected_waves(STRING, X, period, **wave), start) < 1e-12
    assert apart(reflected_waves(STRING, X, 1.01 * period, **wave), start) > 1e-3  # negative control


@pytest.mark.parametrize("ratio", [0.0, 0.5, 0.725, 1.5, 2.0])
@pytest.mark.parametrize("force", [200.0, HARMONIC])
def test_accelerated_series_equals_images(ratio, force):
    case = {**SPAN, "speed": ratio * C, "start": 10.0 if ratio < 0.6 else 0.0}
    images = moving_force_by_images(STRING, X, TIMES, **case, force=force)
    assert apart(moving_force_series(STRING, X, TIMES, **case, force=force, modes=200), images) < 1e-4
    control = moving_force_series(TIGHTER, X, TIMES, **case, force=force)
    assert apart(control, images) > 1e-3


@pytest.mark.parametrize("ratio", [0.5, 1.5])
def test_plain_series_converges_like_its_terms(ratio):
    case = {**SPAN, "speed": ratio * C, "force": 200.0}
    images = moving_force_by_images(STRING, X, TIMES, **case)
    errors = [
        apart_l2(moving_force_series(STRING, X, TIMES, **case, modes=n, accelerate=False), images)
        for n in (50, 100, 200)
    ]
    rate = np.polyfit(np.log([50, 100, 200]), np.log(errors), 1)[0]
    assert rate == pytest.approx(-1.5, abs=0.2)  # terms 1/n², squares summed from N on


def test_every_mode_in_resonance_at_the_wave_speed():
    case = {**SPAN, "speed": C, "force": HARMONIC}
    images = moving_force_by_images(STRING, X, TIMES, **case)
    series = moving_force_series(STRING, X, TIMES, **case, modes=2000)
    assert apart_l2(series, images) < 0.02  # jumps at x = ct: Gibbs, terms 1/n, error N^−½ ≈ 0.022 of a jump
    below, above = (
        moving_force_by_images(STRING, X, TIMES, **{**case, "speed": C * f}) for f in (0.99999, 1.00001)
    )
    assert apart_l2(below, above) < 0.05  # but at nodes that a jump just passes
    control = moving_force_series(HEAVIER, X, TIMES, **case, modes=2000)
    assert apart_l2(control, images) > 0.04


def test_before_any_echo_the_ends_do_not_matter():
    t = np.array([0.05, 0.1, 0.2])[:, None]
    bounded = moving_force_by_images(STRING, X, t, **SPAN, speed=60.0, start=30.0, force=HARMONIC)
    free = moving_force(STRING, X - 30.0, t, speed=60.0, force=HARMONIC)
    assert apart(bounded, free) < 1e-12


def test_images_meet_the_ends_and_the_equation():
    def u(x, t):
        return moving_force_by_images(STRING, x, t, **SPAN, speed=0.6 * C, force=HARMONIC)

    assert np.max(np.abs(u(np.array([0.0, L]), TIMES))) < 1e-14
    t = 1.1 * L / (0.6 * C)  # the force has left; kinks of its coming and leaving are at these places
    x = X[2:-2]
    kinks = [C * t, C * (t - L / (0.6 * C)) + L]
    folded = np.abs(np.mod(np.array(kinks) + L, 2 * L) - L)
    x = x[np.min(np.abs(x[:, None] - folded), axis=1) > 1.0]
    assert string_residual(u, x, t) < 2e-3  # waves of 2π (c − V)/Ω ≈ 7.7 m
    assert string_residual(u, x, t, c=1.01 * C) > 1e-2  # negative control


def test_rings_freely_after_the_force_has_left():
    leave, period = L / 100.0, 2.0 * L / C
    t = leave + np.linspace(0.0, period, 9)[:, None]
    now, later = (
        moving_force_by_images(STRING, X, t + lap * period, **SPAN, speed=100.0, force=HARMONIC)
        for lap in (0, 5)
    )
    assert apart(later, now) < 1e-11
    series = moving_force_series(STRING, X, t + 5 * period, **SPAN, speed=100.0, force=HARMONIC, modes=400)
    assert apart(series, now) < 1e-4  # rest of the accelerated terms, 1/n³
    shifted = moving_force_series(STRING, X, t + 5.01 * period, **SPAN, speed=100.0, force=HARMONIC)
    assert apart(shifted, now) > 0.01  # negative control


def test_slow_travel_is_static():
    speed = 1e-3 * C
    crawl = moving_force_by_images(STRING, X, 0.5 * L / speed, **SPAN, speed=speed, force=200.0)
    static = static_deflection(STRING, X, length=L, position=0.5 * L, force=200.0)
    assert apart(crawl, static) < 2e-3  # the start rings with V/c of the static deflection
    assert apart(1.01 * crawl, static) > 5e-3  # negative control
    assert static.max() == pytest.approx(200.0 * L / (4.0 * T), rel=1e-12)


def test_images_take_any_force():
    by_function = moving_force_by_images(STRING, X, TIMES, **SPAN, speed=70.0, force=lambda t: HARMONIC(t))
    assert (
        apart(by_function, moving_force_by_images(STRING, X, TIMES, **SPAN, speed=70.0, force=HARMONIC))
        < 1e-12
    )


@pytest.mark.parametrize("detune", [0.0, 1e-9, 1e-4, 0.3, -0.5])
def test_modal_amplitude_solves_its_oscillator(detune):
    k = np.pi / L
    omega, speed = k * C, C * (1.0 + detune)
    load = TravellingForce(HARMONIC, speed, 5.0, (L - 5.0) / speed)

    def rates(t, q):
        push = float(HARMONIC(t)) * np.sin(k * (5.0 + speed * t)) if t <= load.leave else 0.0
        return [q[1], push - omega**2 * q[0]]

    t = np.linspace(0.0, 1.5, 31)
    parts = [t[t <= load.leave], t[t > load.leave]]
    acting = solve_ivp(rates, (0, load.leave), [0, 0], t_eval=[*parts[0], load.leave], rtol=1e-11, atol=1e-11)
    ringing = solve_ivp(rates, (load.leave, 1.5), acting.y[:, -1], t_eval=parts[1], rtol=1e-11, atol=1e-11)
    reference = np.concatenate([acting.y[0, :-1], ringing.y[0]])
    assert apart(load.amplitude(t, omega, k), reference) < 1e-7  # the integrator's tolerance, accumulated
    assert apart(load.amplitude(t, 1.01 * omega, k), reference) > 1e-3  # negative control
