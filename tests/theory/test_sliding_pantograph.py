"""Pantographs that answer the infinite string: elastic force and mass on a spring."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from theory_checks import STRING, C, T, apart

from catenary_fe.theory import elastic_pantograph_force, moving_force, sliding_oscillator

TIMES = np.linspace(0.0, 1.0, 201)


@pytest.mark.parametrize("ratio", [0.0, 0.4, 0.75])
def test_elastic_force_is_consistent_with_the_wire(ratio):
    pantograph = {"speed": ratio * C, "force": 200.0, "stiffness": 800.0}

    def force(t):
        return elastic_pantograph_force(STRING, t, **pantograph)

    under = moving_force(STRING, ratio * C * TIMES, TIMES, speed=ratio * C, force=force)
    assert apart(200.0 - 800.0 * under, force(TIMES)) < 1e-12
    assert apart(200.0 - 808.0 * under, force(TIMES)) > 1e-3  # negative control: stiffness off by 1 %


OSCILLATOR = {
    "mass": 10.0,
    "contact_stiffness": 5e3,
    "uplift_force": 150.0,
    "base_stiffness": 40.0,
    "base_damping": 20.0,
}


def test_oscillator_equals_numerical_integration():
    exact = sliding_oscillator(STRING, TIMES, speed=80.0, **OSCILLATOR)

    def rates(t, y):
        contact = 5e3 * (y[0] - y[2])
        return [
            y[1],
            (150.0 - contact - 40.0 * y[0] - 20.0 * y[1]) / 10.0,
            contact / (2.0 * np.sqrt(T * 1.33)),
        ]

    y = solve_ivp(rates, (0.0, 1.0), [0.0, 0.0, 0.0], t_eval=TIMES, rtol=1e-10, atol=1e-12).y
    assert apart(exact.mass_height, y[0]) < 1e-8
    assert apart(exact.deflection, y[2]) < 1e-8
    heavier = sliding_oscillator(STRING, TIMES, speed=80.0, **{**OSCILLATOR, "mass": 10.1})
    assert apart(heavier.mass_height, y[0]) > 1e-4  # negative control


def test_oscillators_wire_follows_from_its_force():
    exact = sliding_oscillator(STRING, TIMES, speed=80.0, **OSCILLATOR)
    under = moving_force(
        STRING,
        80.0 * TIMES,
        TIMES,
        speed=80.0,
        force=lambda t: sliding_oscillator(STRING, t, speed=80.0, **OSCILLATOR).force,
    )
    assert apart(under, exact.deflection) < 1e-9


def test_the_wave_speed_is_refused():
    with pytest.raises(ValueError, match="below the wave speed"):
        elastic_pantograph_force(STRING, TIMES, speed=C, force=200.0, stiffness=800.0)
