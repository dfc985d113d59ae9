"""Dispersion of the tensioned beam: inverse, velocities, natural frequencies (eq. 1)."""

from dataclasses import replace

import numpy as np
import pytest
from theory_checks import RHO, STRING, C, T, apart, beam_with

from catenary_fe.theory import (
    angular_frequency,
    group_velocity,
    natural_frequencies,
    phase_velocity,
    wavenumber,
)

EI = 2e5
K = np.linspace(0.05, 6.0, 60)


@pytest.mark.parametrize("foundation", [0.0, 5e3])
@pytest.mark.parametrize("stiffness", [0.0, 195.0, EI])
def test_group_velocity_is_the_slope_of_omega(stiffness, foundation):
    beam = beam_with(stiffness, foundation_stiffness=foundation)
    h = 1e-5
    slope = (angular_frequency(beam, K + h) - angular_frequency(beam, K - h)) / (2 * h)
    assert apart(group_velocity(beam, K), slope) < 1e-8
    assert apart(phase_velocity(beam, K), angular_frequency(beam, K) / K) < 1e-14
    heavier = replace(beam, mass_per_length=1.01 * RHO)
    assert apart(group_velocity(heavier, K), slope) > 1e-3  # negative control


def test_wavenumber_inverts_omega():
    beam = beam_with(EI)
    assert apart(wavenumber(beam, angular_frequency(beam, K)), K) < 1e-13
    compressed = np.sqrt(
        (-T * K**2 + EI * K**4)[K > 0.4] / RHO
    )  # negative control: P of the print taken as tension
    assert apart(wavenumber(beam, compressed), K[K > 0.4]) > 1e-3


def test_a_plane_wave_solves_the_equation_of_motion():
    k, h = 0.7, 1e-3
    omega = angular_frequency(beam_with(EI, foundation_stiffness=5e3), k)
    x = h * np.arange(-2, 3) / k
    u = np.exp(1j * k * x)
    step = h / k
    second = (u[1] - 2 * u[2] + u[3]) / step**2
    fourth = -(k**2) * second
    residual = abs(-RHO * omega**2 * u[2] + EI * fourth - T * second + 5e3 * u[2])
    assert residual < 1e-6 * RHO * omega**2


def test_string_has_no_dispersion_and_a_beam_no_slow_waves():
    assert phase_velocity(STRING, K) == pytest.approx(np.full(60, C), rel=1e-14)
    assert group_velocity(beam_with(EI), 0.0) == pytest.approx(C)
    assert np.all(group_velocity(beam_with(EI), K) > C)


def test_natural_frequencies_fit_half_waves():
    beam = beam_with(EI)
    omega = natural_frequencies(beam, 4, length=60.0)
    assert wavenumber(beam, omega) * 60.0 / np.pi == pytest.approx([1, 2, 3, 4], rel=1e-12)
    assert natural_frequencies(STRING, 1, length=60.0)[0] == pytest.approx(np.pi * C / 60.0, rel=1e-14)
    assert natural_frequencies(beam, 4, length=60.6) != pytest.approx(omega, rel=1e-3)  # negative control


def test_no_wave_runs_below_the_cut_on_of_a_foundation():
    bed = beam_with(EI, foundation_stiffness=5e3)
    cut_on = np.sqrt(5e3 / RHO)
    assert apart(wavenumber(bed, angular_frequency(bed, K)), K) < 1e-12
    assert wavenumber(bed, cut_on) == pytest.approx(0.0, abs=1e-6)
    with pytest.raises(ValueError, match=r"angular_frequency = .* at least 61\.3139 rad/s"):
        wavenumber(bed, 0.99 * cut_on)
