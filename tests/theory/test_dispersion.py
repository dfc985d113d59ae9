"""Dispersion of the tensioned beam: inverse, velocities, natural frequencies (eq. 1)."""

import numpy as np
import pytest
from theory_checks import RHO, WIRE, C, T, apart

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
    beam = {**WIRE, "bending_stiffness": stiffness, "foundation_stiffness": foundation}
    h = 1e-5
    slope = (angular_frequency(K + h, **beam) - angular_frequency(K - h, **beam)) / (2 * h)
    assert apart(group_velocity(K, **beam), slope) < 1e-8
    assert apart(phase_velocity(K, **beam), angular_frequency(K, **beam) / K) < 1e-14
    heavier = {**beam, "mass_per_length": 1.01 * RHO}
    assert apart(group_velocity(K, **heavier), slope) > 1e-3  # twin


def test_wavenumber_inverts_omega():
    beam = {**WIRE, "bending_stiffness": EI}
    assert apart(wavenumber(angular_frequency(K, **beam), **beam), K) < 1e-13
    compressed = np.sqrt((-T * K**2 + EI * K**4)[K > 0.4] / RHO)  # twin: P of the print taken as tension
    assert apart(wavenumber(compressed, **beam), K[K > 0.4]) > 1e-3


def test_a_plane_wave_solves_the_equation_of_motion():
    k, h = 0.7, 1e-3
    omega = angular_frequency(k, **WIRE, bending_stiffness=EI, foundation_stiffness=5e3)
    x = h * np.arange(-2, 3) / k
    u = np.exp(1j * k * x)
    step = h / k
    second = (u[1] - 2 * u[2] + u[3]) / step**2
    fourth = -(k**2) * second
    residual = abs(-RHO * omega**2 * u[2] + EI * fourth - T * second + 5e3 * u[2])
    assert residual < 1e-6 * RHO * omega**2


def test_string_has_no_dispersion_and_a_beam_no_slow_waves():
    assert phase_velocity(K, **WIRE) == pytest.approx(np.full(60, C), rel=1e-14)
    assert group_velocity(0.0, **WIRE, bending_stiffness=EI) == pytest.approx(C)
    assert np.all(group_velocity(K, **WIRE, bending_stiffness=EI) > C)


def test_natural_frequencies_fit_half_waves():
    beam = {**WIRE, "bending_stiffness": EI}
    omega = natural_frequencies(4, **beam, length=60.0)
    assert wavenumber(omega, **beam) * 60.0 / np.pi == pytest.approx([1, 2, 3, 4], rel=1e-12)
    assert natural_frequencies(1, **WIRE, length=60.0)[0] == pytest.approx(np.pi * C / 60.0, rel=1e-14)
    assert natural_frequencies(4, **beam, length=60.6) != pytest.approx(omega, rel=1e-3)  # twin
