"""String and beam on an elastic foundation under a steadily moving force; critical speeds."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar
from theory_checks import RHO, C, T, apart, beam_with

from catenary_fe.theory import group_velocity, phase_velocity, steady_moving_force

K, EI, F = 4e3, 2e5, 200.0
XI = np.linspace(-40.0, 40.0, 401)


def by_fourier(xi, speed, stiffness, drag=0.5):
    """The problem with a little drag, which selects the radiated waves, by Fourier's integral."""
    kappa = np.linspace(-60.0, 60.0, 240_001)
    symbol = stiffness * kappa**4 + (T - RHO * speed**2) * kappa**2 + K - 1j * kappa * speed * drag
    inside = (np.exp(1j * kappa * xi[:, None]) / symbol).sum(axis=1)
    # tails of the string's 1/κ² integrand beyond ±60 rad/m are within the tolerance
    return F / (2.0 * np.pi) * inside.real * (kappa[1] - kappa[0])


def test_critical_speed_is_the_least_phase_velocity():
    bed = beam_with(EI, foundation_stiffness=K)
    least = minimize_scalar(lambda k: float(phase_velocity(bed, k)), bounds=(0.01, 5.0), method="bounded").fun
    assert bed.critical_speed == pytest.approx(least, rel=1e-9)
    assert np.sqrt((T + np.sqrt(K * EI)) / RHO) != pytest.approx(
        least, rel=1e-3
    )  # negative control: the 2 forgotten
    assert beam_with(foundation_stiffness=K).critical_speed == pytest.approx(C, rel=1e-14)
    at = (K / EI) ** 0.25
    assert group_velocity(bed, at) == pytest.approx(float(phase_velocity(bed, at)), rel=1e-12)


@pytest.mark.parametrize("stiffness", [0.0, EI])
@pytest.mark.parametrize("ratio", [0.0, 0.5, 0.9, 1.3])
def test_closed_form_equals_the_slightly_damped_integral(ratio, stiffness):
    bed = beam_with(stiffness, foundation_stiffness=K)
    speed = ratio * bed.critical_speed
    xi = XI[::20]
    reference = by_fourier(xi, speed, stiffness)
    closed = steady_moving_force(bed, xi, speed=speed, force=F)
    # by drag and cut-off tails; the drag lets radiated waves decay over 40 m (a quarter of it: a quarter of
    # this)
    assert apart(closed, reference) < (0.015 if ratio < 1.0 else 0.12)
    assert (
        apart(-closed if ratio < 1.0 else closed[::-1], reference) > 0.5
    )  # negative control: sign, waves on the wrong side


@pytest.mark.parametrize("ratio", [0.0, 0.6, 0.9, 1.4])
@pytest.mark.parametrize("stiffness", [195.0, EI])
def test_beam_solves_its_equation_and_carries_the_force(ratio, stiffness):
    bed = beam_with(stiffness, foundation_stiffness=K)
    speed = ratio * bed.critical_speed
    effective, layer = T - RHO * speed**2, (stiffness / T) ** 0.5
    h = 0.01 * layer

    def derivatives(at):
        w = [steady_moving_force(bed, at + j * h, speed=speed, force=F) for j in range(-2, 3)]
        slope, second = (w[3] - w[1]) / (2 * h), (w[1] - 2 * w[2] + w[3]) / h**2
        third = (w[4] - 2 * w[3] + 2 * w[1] - w[0]) / (2 * h**3)
        fourth = (w[0] - 4 * w[1] + 6 * w[2] - 4 * w[3] + w[4]) / h**4
        return w[2], slope, second, third, fourth

    def residual(stiffness):
        w, _, second, _, fourth = derivatives(np.array([-2.0, -0.3, 0.3, 2.0]) * layer)
        terms = [stiffness * fourth, -effective * second, K * w]
        return np.max(np.abs(sum(terms))) / max(np.max(np.abs(term)) for term in terms)

    assert residual(stiffness) < 3e-4  # (h/ℓ)² = 1e-4 of the differences, and their rounding
    assert residual(1.01 * stiffness) > 5e-4  # negative control
    _, slope, second, third, _ = derivatives(np.array([-3.0, 3.0]) * h)
    assert stiffness * (third[1] - third[0]) == pytest.approx(F, rel=0.08)  # 3 h beside the force
    assert abs(slope[1] - slope[0] - 3.0 * h * (second[0] + second[1])) < 1e-3 * F / T  # no kink in a beam


@pytest.mark.parametrize("ratio", [0.0, 0.7, 1.6])
def test_string_is_the_limit_of_small_stiffness(ratio):
    speed = ratio * C
    steady = {"speed": speed, "force": F}
    string = steady_moving_force(beam_with(foundation_stiffness=K), XI, **steady)
    thin = steady_moving_force(beam_with(1e-3, foundation_stiffness=K), XI, **steady)
    assert apart(thin, string) < 1e-2  # √(EI k)/T' and the like
    effective = abs(T - RHO * speed**2)
    if ratio < 1.0:
        expected = F / (2 * np.sqrt(K * effective)) * np.exp(-np.abs(XI) * np.sqrt(K / effective))
        assert apart(string, expected) < 1e-14
        static = F / (2 * np.sqrt(K * T)) * np.exp(-np.abs(XI) * np.sqrt(K / T))
        assert (apart(string, static) > 0.1) == (ratio > 0.0)  # negative control: T for T'
    else:
        assert np.all(string[XI > 0.0] == 0.0)


def test_foundation_carries_the_force_below_the_critical_speed():
    xi = np.linspace(-150.0, 150.0, 300_001)
    for stiffness, speed in ((0.0, 0.8 * C), (EI, 0.8 * C), (EI, 1.05 * C)):
        w = steady_moving_force(beam_with(stiffness, foundation_stiffness=K), xi, speed=speed, force=F)
        assert K * np.sum(w) * (xi[1] - xi[0]) == pytest.approx(F, rel=1e-6)
        assert K * np.sum(w) * (xi[1] - xi[0]) != pytest.approx(1.01 * F, rel=1e-6)  # negative control


def test_double_root_is_no_gap():
    # T'² = 4 k EI at V² = (T − 2√(k EI))/ρ
    speed = np.sqrt((T - 2.0 * np.sqrt(1e2 * EI)) / RHO)
    bed = beam_with(EI, foundation_stiffness=1e2)
    at, near = (steady_moving_force(bed, XI, speed=v, force=F) for v in (speed, speed * 1.0001))
    assert apart(near, at) < 1e-3
    assert np.all(np.isfinite(at))


def test_waves_lead_and_trail_by_their_group_velocity():
    bed = beam_with(EI, foundation_stiffness=K)
    speed = 1.3 * bed.critical_speed
    x = np.linspace(0.0, 200.0, 200_001)
    for side, faster in ((1.0, True), (-1.0, False)):
        w = steady_moving_force(bed, side * x, speed=speed, force=F)
        crossings = x[1:][np.diff(np.sign(w)) != 0]
        k = np.pi / np.mean(np.diff(crossings[1:]))
        assert phase_velocity(bed, k) == pytest.approx(speed, rel=1e-3)  # zeros found to 1 mm
        assert (group_velocity(bed, k) > speed) == faster


def test_no_steady_state_at_the_critical_speed():
    with pytest.raises(ValueError, match="critical speed"):
        steady_moving_force(beam_with(foundation_stiffness=K), 0.0, speed=C, force=F)
