"""Bad input is refused in one line that says what, value, rule and remedy; importing the theory is light."""

import subprocess
import sys

import numpy as np
import pytest
from theory_checks import STRING, C, beam_with

from catenary_fe import theory as th
from tests.conftest import refused_in_one_line

S = STRING
SPAN = {"length": 60.0, "speed": 80.0, "force": 200.0}
LINES = {"ends": (0.0, 60.0), "intervals": 60}
FORCE = {"speed": 9.0, "force": 1.0}
BAYS = [0.0, 6.0]

CASES = [
    (lambda: th.String(tension=-1.0, mass_per_length=1.0), "tension = -1 N: must be positive"),
    (lambda: th.String(tension=1.0, mass_per_length=np.nan), "mass_per_length = nan kg/m"),
    (lambda: th.angular_frequency(3.0, 0.1), "wire = 3.0: must be a theory.String"),
    (lambda: beam_with(-1.0), "bending_stiffness = -1 N m²"),
    (lambda: beam_with(foundation_stiffness=np.inf), "foundation_stiffness = inf N/m²"),
    (lambda: th.moving_force(0.0, S, 0.1, **FORCE), "x = String.*: must be numbers; pass the wire first"),
    (lambda: th.moving_force(beam_with(5.0), 0.0, 0.1, **FORCE), "bending_stiffness = 5 N m²: must be 0"),
    (
        lambda: th.static_uniform_load(beam_with(5.0, foundation_stiffness=3.0), 0.0, length=1.0, load=1.0),
        "foundation_stiffness = 3 N/m²: must be 0",
    ),
    (lambda: th.steady_moving_force(beam_with(5.0), 0.0, **FORCE), "foundation_stiffness = 0 N/m²"),
    (lambda: th.steady_moving_force(S, 0.0, **FORCE), "foundation_stiffness = 0 N/m²"),
    (lambda: th.moving_force(S, 0.0, -0.1, **FORCE), "t = -0.1 s: must not be negative"),
    (lambda: th.moving_force(S, [0.0, np.nan], 0.1, **FORCE), "x = nan or inf"),
    (lambda: th.moving_force(S, 0.0, 0.1, speed=-1.0, force=1.0), "speed = -1 m/s"),
    (lambda: th.moving_force(S, 0.0, 0.1, speed=1.0, force=np.inf), "force = inf N"),
    (lambda: th.HarmonicForce(mean=1.0, angular_frequency=-1.0), "angular_frequency = -1 rad/s"),
    (lambda: th.moving_force_by_images(S, 61.0, 0.1, **SPAN), "x = 61 m: must lie on the wire"),
    (lambda: th.moving_force_by_images(S, 1.0, 0.1, **SPAN, start=70.0), "start = 70 m"),
    (lambda: th.moving_force_series(S, 1.0, 0.1, **{**SPAN, "force": np.sin}), "constant or harmonic"),
    (lambda: th.moving_force_series(S, 1.0, 0.1, **SPAN, modes=0), "modes = 0"),
    (lambda: th.initial_value_series(S, 1.0, 0.1, length=60.0, modes=0), "modes = 0"),
    (
        lambda: th.moving_force_on_supports(S, 1.0, 0.1, supports=[0.0, 6.0, 5.0], **FORCE),
        "supports = .*rising",
    ),
    (lambda: th.moving_force_on_supports(S, 1.0, 0.1, supports=BAYS, speed=0.0, force=1.0), "speed = 0 m/s"),
    (
        lambda: th.moving_force_on_supports(S, 1.0, 0.1, supports=BAYS, **FORCE, method="magic"),
        "method = 'magic'",
    ),
    (lambda: th.phase_velocity(beam_with(foundation_stiffness=1.0), 0.0), "wavenumber = 0 rad/m"),
    (lambda: th.group_velocity(S, -1.0), "wavenumber = -1 rad/m"),
    (lambda: th.lumped_impedance(0.0, mass=1.0), "angular_frequency = 0 rad/s"),
    (lambda: th.scatter_at_dropper(S, S, 1.0, stiffness=-1.0), "stiffness = -1 N/m"),
    (lambda: th.amplification_coefficient(S, S, speed=C), "doppler_factor = 0"),
    (lambda: th.solve_by_lines(S, [0.1], **LINES, supports=[10.25]), "supports = 10.25 m: must be at a node"),
    (lambda: th.solve_by_lines(S, [0.2, 0.1], **LINES), "t = .*rising"),
    (lambda: th.solve_by_lines(S, [0.1], **{**LINES, "ends": (5.0, 0.0)}), "ends = "),
    (lambda: th.solve_by_lines(S, [0.1], **{**LINES, "intervals": 2}), "intervals = 2"),
    (lambda: th.solve_by_lines(S, [0.1], **LINES, integrator="magic"), "integrator = 'magic'"),
    (lambda: th.solve_by_lines(S, [0.1], **LINES, initial_deflection=np.cos), "initial_deflection = .*ends"),
]


@pytest.mark.parametrize(("call", "message"), CASES)
def test_bad_input_is_refused_in_one_line(call, message):
    refused_in_one_line(call, message)


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
