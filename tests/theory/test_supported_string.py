"""Bays between rigid supports: independent, entered and left by the force (fig. 5)."""

from itertools import pairwise

import numpy as np
import pytest
from theory_checks import STRING, C, apart

from catenary_fe.theory import HarmonicForce, moving_force_by_images, moving_force_on_supports

SUPPORTS = [0.0, 6.0, 12.0, 18.5, 24.0, 30.0, 37.0, 42.0]
X = np.linspace(0.0, 42.0, 169)
TIMES = np.linspace(0.0, 0.7, 29)[:, None]
HARMONIC = HarmonicForce(mean=200.0, amplitude=100.0, angular_frequency=40.0)
LINE = {"supports": SUPPORTS, "speed": 88.9}


def test_each_bay_is_a_string_of_its_own():
    line = moving_force_on_supports(STRING, X, TIMES, **LINE, force=200.0)
    for left, right in pairwise(SUPPORTS):
        inside = (left <= X) & (right >= X)
        since = TIMES - left / 88.9
        alone = moving_force_by_images(
            STRING, X[inside] - left, np.maximum(since, 0.0), length=right - left, speed=88.9, force=200.0
        )
        assert np.max(np.abs(line[:, inside] - alone)) < 1e-12


def test_supports_hold_still_and_later_bays_wait():
    line = moving_force_on_supports(STRING, SUPPORTS, TIMES, **LINE, force=200.0)
    assert np.all(line == 0.0)
    t = 20.0 / 88.9
    u = moving_force_on_supports(STRING, X, t, **LINE, force=200.0)
    assert np.all(u[X > 24.0] == 0.0)
    assert np.abs(u[X < 6.0]).max() > 1e-3  # the wake rings


def test_moving_a_support_changes_its_two_bays_only():
    line = moving_force_on_supports(STRING, X, TIMES, **LINE, force=HARMONIC)
    moved = [18.0 if s == 18.5 else s for s in SUPPORTS]
    other = moving_force_on_supports(STRING, X, TIMES, **{**LINE, "supports": moved}, force=HARMONIC)
    touched = (X > 12.0) & (X < 24.0)
    assert np.max(np.abs(line - other)[:, ~touched]) < 1e-14
    assert np.max(np.abs(line - other)[:, touched]) > 1e-3  # negative control: the check can fail


@pytest.mark.parametrize("ratio", [0.4, 0.725, 1.3])
def test_series_equals_images(ratio):
    case = {**LINE, "speed": ratio * C, "force": HARMONIC, "start": 3.0}
    images = moving_force_on_supports(STRING, X, TIMES, **case)
    assert apart(moving_force_on_supports(STRING, X, TIMES, **case, method="series", modes=60), images) < 1e-4
    control = moving_force_on_supports(
        STRING, X, TIMES, **{**case, "speed": 1.01 * ratio * C}, method="series", modes=60
    )
    assert apart(control, images) > 1e-2


def test_any_force_and_scalars():
    harmonic = moving_force_on_supports(STRING, X, TIMES, **LINE, force=HARMONIC)
    assert (
        apart(moving_force_on_supports(STRING, X, TIMES, **LINE, force=lambda t: HARMONIC(t)), harmonic)
        < 1e-12
    )
    assert moving_force_on_supports(STRING, 3.0, 0.1, **LINE, force=200.0).shape == ()


def test_deflection_drops_to_centimetres():
    x, t = np.linspace(0.0, 60.0, 601), np.linspace(0.0, 0.5, 101)[:, None]
    u = moving_force_on_supports(STRING, x, t, supports=np.arange(0.0, 61.0, 6.0), speed=88.9, force=200.0)
    assert 0.02 < np.max(np.abs(u)) < 0.05  # the paper's text to fig. 5: several centimetres
