"""Point forces on the infinite string, at rest and moving, for every speed (eq. 4 to 6)."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import trapezoid
from theory_checks import RHO, SPEEDS, STRING, C, T, apart, string_residual

from catenary_fe.theory import (
    HarmonicForce,
    deflection_under_moving_force,
    force_at_rest,
    influence_interval,
    moving_force,
    moving_force_derivatives,
)

HARMONIC = HarmonicForce(mean=200.0, amplitude=80.0, angular_frequency=30.0, phase=0.4)
X = np.linspace(-75.0, 150.0, 451)
TIMES = np.array([0.1, 0.3, 0.5])[:, None]


def by_counting(x, t, speed, force, steps=40_000):
    """Eq. 4 with eq. 5, the interval found by asking every instant whether it is felt."""
    tau = (np.arange(steps) + 0.5) * t / steps
    felt = np.abs(x[:, None] - speed * tau) <= C * (t - tau)
    return (felt * force(tau)).sum(axis=1) * t / steps / (2.0 * RHO * C)


@pytest.mark.parametrize("speed", SPEEDS)
def test_closed_form_equals_counted_instants(speed):
    x = np.linspace(-70.0, 130.0, 60)  # avoids x = ct at V = c, where the deflection jumps
    reference = by_counting(x, 0.5, speed, HARMONIC)
    assert (
        apart(moving_force(STRING, x, 0.5, speed=speed, force=HARMONIC), reference) < 1e-4
    )  # one instant in 40 000
    control = moving_force(STRING, x, 0.5, speed=speed + 0.01 * C, force=HARMONIC)
    assert apart(control, reference) > 1e-3


@pytest.mark.parametrize("speed", SPEEDS)
def test_quadrature_and_antiderivative_equal_the_closed_form(speed):
    closed = moving_force(STRING, X, TIMES, speed=speed, force=HARMONIC)
    by_quadrature = moving_force(STRING, X, TIMES, speed=speed, force=lambda t: HARMONIC(t))
    by_impulse = moving_force(
        STRING,
        X,
        TIMES,
        speed=speed,
        force=lambda t: HARMONIC(t),
        impulse=lambda t: HARMONIC.impulse(t) + 7.0,
    )
    assert closed.shape == (3, 451)
    assert apart(by_quadrature, closed) < 1e-12
    assert apart(by_impulse, closed) < 1e-12  # the constant 7 drops out


def test_constant_is_harmonic_without_amplitude():
    constant = moving_force(STRING, X, TIMES, speed=50.0, force=200.0)
    still = HarmonicForce(mean=200.0, amplitude=50.0, angular_frequency=0.0)
    assert np.array_equal(constant, moving_force(STRING, X, TIMES, speed=50.0, force=still))


@pytest.mark.parametrize("ratio", [0.0, 0.5, 0.9, 1.2, 2.0])
def test_solves_the_wave_equation_away_from_the_force(ratio):
    speed, t = ratio * C, 0.5

    def u(x, t):
        return moving_force(STRING, x, t, speed=speed, force=HARMONIC)

    kinks = np.array([-C * t, C * t, speed * t])
    x = X[np.min(np.abs(X[:, None] - kinks), axis=1) > 1.0]
    assert string_residual(u, x, t) < 2e-3  # shortest wave: 2π (c − V)/Ω ≈ 2.6 m at 0.9 c
    assert string_residual(u, x, t, c=1.01 * C) > 1e-2  # negative control


@pytest.mark.parametrize("speed", [s for s in SPEEDS if s != C])
def test_slope_jumps_by_the_force(speed):
    t, eps = 0.37, 1e-6
    ends = np.array([speed * t - eps, speed * t + eps])
    slope, _ = moving_force_derivatives(STRING, ends, t, speed=speed, force=HARMONIC)
    jump = -(T - RHO * speed**2) * (slope[1] - slope[0])
    assert jump == pytest.approx(float(HARMONIC(t)), rel=1e-5)
    assert jump != pytest.approx(1.01 * float(HARMONIC(t)), rel=1e-5)  # negative control


@pytest.mark.parametrize("speed", SPEEDS)
def test_derivatives_equal_differences(speed):
    t, h = 0.5, 1e-5
    kinks = np.array([-C * t, C * t, speed * t])
    x = X[np.min(np.abs(X[:, None] - kinks), axis=1) > 0.1]

    def u(x, t):
        return moving_force(STRING, x, t, speed=speed, force=HARMONIC)

    slope, velocity = moving_force_derivatives(STRING, x, t, speed=speed, force=HARMONIC)
    assert apart(slope, (u(x + h, t) - u(x - h, t)) / (2 * h)) < 1e-6
    tau = h / C
    assert apart(velocity, (u(x, t + tau) - u(x, t - tau)) / (2 * tau)) < 1e-6


@pytest.mark.parametrize("speed", SPEEDS)
def test_momentum_of_the_wire_is_the_impulse(speed):
    t = 0.5
    x = np.linspace(-C * t - 1.0, max(C, speed) * t + 1.0, 400_001)
    _, velocity = moving_force_derivatives(STRING, x, t, speed=speed, force=HARMONIC)
    momentum = RHO * trapezoid(velocity, x)
    if speed == C:  # the jump at the front carries the half that the slope elsewhere does not
        momentum += RHO * C * float(moving_force(STRING, C * t, t, speed=C, force=HARMONIC))
    impulse = float(HARMONIC.impulse(t))
    assert momentum == pytest.approx(impulse, rel=1e-4)  # jumps of the velocity cost half a step of 0.5 mm
    assert RHO * C * momentum != pytest.approx(impulse, rel=0.5)  # negative control: ½ ∬ f as printed


@given(
    ratio=st.floats(0.0, 3.0),
    t=st.floats(0.01, 2.0),
    force=st.floats(1.0, 500.0),
)
def test_area_below_the_wire_is_the_free_fall_of_its_mass(ratio, t, force):
    speed = ratio * C
    x = np.array([-C * t, min(C, speed) * t, max(C, speed) * t])  # between its kinks the wire is straight
    u = moving_force(STRING, x, t, speed=speed, force=force)
    area = trapezoid(u, x) if ratio != 1.0 else 0.5 * u[1] * 2.0 * C * t
    assert area == pytest.approx(force * t**2 / (2.0 * RHO), rel=1e-6)


def test_rest_is_the_limit_of_slow_travel():
    rest = force_at_rest(STRING, X, TIMES, force=HARMONIC)
    assert apart(moving_force(STRING, X, TIMES, speed=0.0, force=HARMONIC), rest) < 1e-12
    assert apart(moving_force(STRING, X, TIMES, speed=1e-6 * C, force=HARMONIC), rest) < 1e-5  # order V/c
    assert (
        apart(moving_force(STRING, X, TIMES, speed=0.01 * C, force=HARMONIC), rest) > 1e-3
    )  # negative control


def test_rest_may_be_anywhere_and_take_any_force():
    shifted = force_at_rest(STRING, X + 7.0, TIMES, force=HARMONIC, position=7.0)
    assert apart(shifted, force_at_rest(STRING, X, TIMES, force=HARMONIC)) < 1e-12

    def switched(t):
        return np.where(t < 0.123, 100.0, 0.0)

    u = force_at_rest(STRING, 0.0, 0.5, force=switched, breakpoints=(0.123,))
    assert u == pytest.approx(100.0 * 0.123 / (2.0 * np.sqrt(T * RHO)), rel=1e-12)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_wave_speed_is_the_limit_from_both_sides(side):
    away = X[np.abs(X - 0.5 * C) > 0.5]
    at = moving_force(STRING, away, 0.5, speed=C, force=HARMONIC)
    near = moving_force(STRING, away, 0.5, speed=C * (1.0 + side * 1e-5), force=HARMONIC)
    assert apart(near, at) < 1e-4  # order |V − c|/c times cΩt
    assert np.all(at[away > 0.5 * C] == 0.0)


@pytest.mark.parametrize("speed", SPEEDS)
def test_under_the_force(speed):
    t = np.linspace(0.0, 0.7, 15)
    force = HarmonicForce(mean=200.0, amplitude=80.0, angular_frequency=30.0)
    under = deflection_under_moving_force(STRING, t, speed=speed, force=force)
    field = moving_force(STRING, speed * t, t, speed=speed, force=force)
    assert np.max(np.abs(under - field)) < 1e-14
    if speed > C:
        assert np.all(under == 0.0)
        return
    wave = 80.0 / 30.0 * (np.cos(30.0 * t) - 1.0)
    assert apart((200.0 * t - wave) / (2.0 * RHO * C), under) < 1e-14
    assert (
        apart((200.0 * t + wave) / (2.0 * RHO * C), under) > 0.01
    )  # negative control: the sign printed in eq. 6
    assert apart(0.5 * (200.0 * t - wave), under) > 0.01  # negative control: ρc = 1 as printed in eq. 6


def test_deflection_under_a_constant_force_does_not_depend_on_speed():
    speeds = np.array([0.0, 0.4, 0.8, 1.0]) * C
    values = [float(moving_force(STRING, v * 0.5, 0.5, speed=v, force=200.0)) for v in speeds]
    assert values == pytest.approx([200.0 * 0.5 / (2.0 * RHO * C)] * 4, rel=1e-12)


@pytest.mark.parametrize("speed", SPEEDS)
def test_nothing_is_felt_outside_the_reach(speed):
    first, last = influence_interval(STRING, [-60.1, 1.001 * max(0.5 * speed, 0.5 * C)], 0.48, speed=speed)
    assert np.array_equal(first, last)


@given(
    ratio=st.floats(0.0, 3.0),
    x=st.floats(-200.0, 200.0),
    t=st.floats(0.0, 1.0),
    part=st.floats(0.0, 1.0),
)
def test_every_instant_of_the_interval_is_felt(ratio, x, t, part):
    first, last = influence_interval(STRING, x, t, speed=ratio * C)
    assert 0.0 <= first <= last <= t + 1e-12
    tau = first + part * (last - first)
    if last > first:
        assert abs(x - ratio * C * tau) <= C * (t - tau) + 1e-9


def test_scalars_in_scalar_out():
    assert moving_force(STRING, 1.0, 0.1, speed=10.0, force=200.0).shape == ()


def test_harmonic_force_impulse_is_its_integral():
    t = np.linspace(0.0, 0.5, 200_001)
    assert trapezoid(HARMONIC(t), t) == pytest.approx(float(HARMONIC.impulse(0.5)), rel=1e-9)
    assert HARMONIC.later(0.2)(0.1) == pytest.approx(float(HARMONIC(0.3)), rel=1e-12)
