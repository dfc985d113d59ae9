"""Bad input is refused in one line that says what, value, rule and remedy; importing the theory is light."""

import subprocess
import sys

import numpy as np
import pytest
from theory_checks import WIRE, C

from catenary_fe import theory as th

SPAN = {**WIRE, "length": 60.0, "speed": 80.0, "force": 200.0}
LINES = {**WIRE, "ends": (0.0, 60.0), "intervals": 60}
GOOD = {"tension": 20e3, "mass_per_length": 1.33}

CASES = [
    (lambda: th.wave_speed(tension=-1.0, mass_per_length=1.0), "tension = -1 N: must be positive"),
    (lambda: th.wave_speed(tension=1.0, mass_per_length=np.nan), "mass_per_length = nan kg/m"),
    (lambda: th.moving_force(0.0, -0.1, **WIRE, speed=1.0, force=1.0), "t = -0.1 s: must not be negative"),
    (lambda: th.moving_force([0.0, np.nan], 0.1, **WIRE, speed=1.0, force=1.0), "x = nan or inf"),
    (lambda: th.moving_force(0.0, 0.1, **WIRE, speed=-1.0, force=1.0), "speed = -1 m/s"),
    (lambda: th.moving_force(0.0, 0.1, **WIRE, speed=1.0, force=np.inf), "force = inf N"),
    (lambda: th.HarmonicForce(mean=1.0, angular_frequency=-1.0), "angular_frequency = -1 rad/s"),
    (lambda: th.running_waves(0.0, 0.0, wave_speed=0.0), "wave_speed = 0 m/s"),
    (lambda: th.moving_force_by_images(61.0, 0.1, **SPAN), "x = 61 m: must lie on the wire"),
    (lambda: th.moving_force_by_images(1.0, 0.1, **SPAN, start=70.0), "start = 70 m"),
    (lambda: th.moving_force_series(1.0, 0.1, **{**SPAN, "force": np.sin}), "constant or harmonic"),
    (lambda: th.moving_force_series(1.0, 0.1, **SPAN, modes=0), "modes = 0"),
    (lambda: th.standing_wave(1.0, 0.1, wave_speed=C, length=60.0, mode=0, amplitude=1.0), "mode = 0"),
    (
        lambda: th.moving_force_on_supports(1.0, 0.1, **GOOD, supports=[0.0, 6.0, 5.0], speed=1.0, force=1.0),
        "supports = .*rising",
    ),
    (
        lambda: th.moving_force_on_supports(1.0, 0.1, **GOOD, supports=[0.0, 6.0], speed=0.0, force=1.0),
        "speed = 0 m/s",
    ),
    (
        lambda: th.moving_force_on_supports(
            1.0, 0.1, **GOOD, supports=[0.0, 6.0], speed=9.0, force=1.0, method="magic"
        ),
        "method = 'magic'",
    ),
    (
        lambda: th.beam_point_force(
            1.0, tension=1.0, bending_stiffness=-1.0, length=2.0, position=1.0, force=1.0
        ),
        "bending_stiffness = -1 N m²",
    ),
    (lambda: th.phase_velocity(0.0, **WIRE, foundation_stiffness=1.0), "wavenumber = 0 rad/m"),
    (lambda: th.group_velocity(-1.0, **WIRE), "wavenumber = -1 rad/m"),
    (lambda: th.lumped_impedance(0.0, mass=1.0), "angular_frequency = 0 rad/s"),
    (
        lambda: th.scatter_at_dropper(
            1.0, **WIRE, other_tension=1.0, other_mass_per_length=1.0, stiffness=-1.0
        ),
        "stiffness = -1 N/m",
    ),
    (lambda: th.amplification_coefficient(reflection=1.2, doppler=0.5), "reflection = 1.2"),
    (lambda: th.solve_by_lines([0.1], **LINES, supports=[10.25]), "supports = 10.25 m: must be at a node"),
    (lambda: th.solve_by_lines([0.2, 0.1], **LINES), "t = .*rising"),
    (lambda: th.solve_by_lines([0.1], **{**LINES, "ends": (5.0, 0.0)}), "ends = "),
    (lambda: th.solve_by_lines([0.1], **{**LINES, "intervals": 2}), "intervals = 2"),
    (lambda: th.solve_by_lines([0.1], **LINES, integrator="magic"), "integrator = 'magic'"),
    (lambda: th.solve_by_lines([0.1], **LINES, initial_deflection=np.cos), "initial_deflection = .*ends"),
    (
        lambda: th.beam_free_waves(
            0.0, 1e6, **WIRE, bending_stiffness=1.0, initial_deflection=np.cos, half_width=1.0
        ),
        "t = too late",
    ),
]


@pytest.mark.parametrize(("call", "message"), CASES)
def test_bad_input_is_refused_in_one_line(call, message):
    with pytest.raises(ValueError, match=message) as caught:
        call()
    text = str(caught.value)
    assert "\n" not in text
    assert " = " in text and ": " in text and "; " in text  # what = value: rule; remedy


def test_every_public_name_exists_and_is_documented():
    for name in th.__all__:
        assert getattr(th, name).__doc__, name


def test_import_is_light_and_stands_alone():
    code = (
        "import sys; import catenary_fe.theory; "
        "print([m for m in ('scipy.integrate', 'scipy.sparse', 'matplotlib', 'exudyn', 'pydantic', "
        "'catenary_fe.layout', 'catenary_fe.fe') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
