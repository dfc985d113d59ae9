"""Reflection and transmission at obstacles and droppers; the catenary's key numbers."""

import numpy as np
import pytest
from theory_checks import STRING, C, T

from catenary_fe.theory import (
    String,
    amplification_coefficient,
    doppler_factor,
    influence_interval,
    lumped_impedance,
    reflection_coefficient,
    scatter_at_dropper,
    scatter_at_obstacle,
)

OMEGA = np.linspace(1.0, 400.0, 50)
Z0 = STRING.impedance
OTHER = String(tension=16e3, mass_per_length=1.07)


@pytest.mark.parametrize("obstacle", [{"mass": 0.3}, {"stiffness": 2e4}, {"mass": 0.5, "stiffness": 3e4}])
def test_lossless_obstacles_keep_the_energy(obstacle):
    z = lumped_impedance(OMEGA, **obstacle)
    met = scatter_at_obstacle(STRING, z)
    assert met.energy == pytest.approx(np.ones(50), abs=1e-14)
    assert 1.0 + met.reflection == pytest.approx(met.transmission, abs=1e-14)
    control = np.abs(-1.01 * z / (z + 2.0 * Z0)) ** 2 + np.abs(met.transmission) ** 2  # r off by 1 %
    assert np.max(np.abs(control - 1.0)) > 1e-4


def test_a_damper_takes_energy():
    assert np.all(scatter_at_obstacle(STRING, lumped_impedance(OMEGA, damping=50.0)).energy < 1.0)


@pytest.mark.parametrize("omega", [3.0, 40.0, 300.0])
def test_obstacle_meets_continuity_and_balance(omega):
    m, k = 0.4, 1.5e4
    met = scatter_at_obstacle(STRING, lumped_impedance(omega, mass=m, stiffness=k))
    wavenumber = omega / C
    # u = exp(i(ωt − kx)) + r exp(i(ωt + kx)) left, t exp(i(ωt − kx)) right; slope jump carries the obstacle
    slope_left = -1j * wavenumber * (1.0 - met.reflection)
    slope_right = -1j * wavenumber * met.transmission
    inertia_and_spring = (k - m * omega**2) * met.transmission
    assert T * (slope_right - slope_left) == pytest.approx(complex(inertia_and_spring), rel=1e-12)
    wrong = (k - 1.01 * m * omega**2) * met.transmission
    assert T * (slope_right - slope_left) != pytest.approx(complex(wrong), rel=1e-6)  # negative control


def test_limits_of_obstacles():
    heavy = scatter_at_obstacle(STRING, lumped_impedance(10.0, mass=1e9))
    assert complex(heavy.reflection) == pytest.approx(-1.0, abs=1e-6)
    resonance = np.sqrt(3e4 / 0.5)
    tuned = scatter_at_obstacle(STRING, lumped_impedance(resonance, mass=0.5, stiffness=3e4))
    assert abs(complex(tuned.reflection)) < 1e-12


@pytest.mark.parametrize("stiffness", [0.0, 1e4, 1e5, np.inf])
def test_dropper_keeps_the_energy_of_both_wires(stiffness):
    met = scatter_at_dropper(
        STRING, OTHER, OMEGA, stiffness=stiffness, clamp_mass=0.165, other_clamp_mass=0.195
    )
    assert met.energy == pytest.approx(np.ones(50), abs=1e-13)
    if stiffness > 0.0:
        stays = np.abs(met.reflection) ** 2 + np.abs(met.transmission) ** 2
        assert np.max(np.abs(stays - 1.0)) > 1e-3  # negative control: the messenger's share forgotten


def test_dropper_equals_a_linear_system():
    omega, k, m1, m2 = 120.0, 8e4, 0.165, 0.195
    met = scatter_at_dropper(STRING, OTHER, omega, stiffness=k, clamp_mass=m1, other_clamp_mass=m2)
    z2 = np.sqrt(16e3 * 1.07)
    iw = 1j * omega
    # unknown deflections of the two points; a wire answers with 2Z₀ iω u, the incoming wave pushes with 2Z₀
    # iω
    matrix = [[2 * Z0 * iw + k + m1 * iw**2, -k], [-k, 2 * z2 * iw + k + m2 * iw**2]]
    here, there = np.linalg.solve(np.array(matrix), np.array([2 * Z0 * iw, 0.0]))
    assert complex(met.transmission) == pytest.approx(here, rel=1e-12)
    assert complex(met.crossing) == pytest.approx(there, rel=1e-12)
    assert complex(met.reflection) == pytest.approx(here - 1.0, rel=1e-12)
    softer = scatter_at_dropper(STRING, OTHER, omega, stiffness=0.9 * k, clamp_mass=m1, other_clamp_mass=m2)
    assert complex(softer.crossing) != pytest.approx(there, rel=1e-3)  # negative control


def test_rigid_dropper_gives_the_fields_reflection_coefficient():
    field = reflection_coefficient(STRING, OTHER)
    rigid = scatter_at_dropper(STRING, OTHER, OMEGA)
    assert rigid.reflection == pytest.approx(np.full(50, -field), abs=1e-14)
    assert rigid.reflection != pytest.approx(np.full(50, -1.01 * field), abs=1e-3)  # negative control
    stiff = scatter_at_dropper(STRING, OTHER, OMEGA, stiffness=1e12)
    assert stiff.reflection == pytest.approx(rigid.reflection, abs=1e-6)
    assert np.all(scatter_at_dropper(STRING, OTHER, OMEGA, stiffness=0.0).reflection == 0.0)


def test_doppler_factor_is_the_frequency_of_the_echo():
    v, wall = 0.6 * C, 100.0
    t = np.array([1.2, 1.21])  # the echo of a wave sent ahead, met by the force that runs into it
    _, sent = influence_interval(STRING, 2.0 * wall - v * t, t, speed=v)
    squeezed = (sent[1] - sent[0]) / (t[1] - t[0])
    alpha = doppler_factor(STRING, speed=v)
    assert 1.0 / squeezed == pytest.approx(alpha, rel=1e-9)
    assert 1.0 / squeezed != pytest.approx(
        doppler_factor(STRING, speed=1.01 * v), rel=1e-3
    )  # negative control


def test_amplification():
    reflection = reflection_coefficient(STRING, OTHER)
    amplified = amplification_coefficient(STRING, OTHER, speed=0.725 * C)
    assert amplified == pytest.approx(reflection * 1.725 / 0.275)
    assert amplified != pytest.approx(reflection * 1.735 / 0.265, rel=1e-2)  # negative control: 0.735 c
    with pytest.raises(ValueError, match="below the wave speed"):
        amplification_coefficient(STRING, OTHER, speed=C)
