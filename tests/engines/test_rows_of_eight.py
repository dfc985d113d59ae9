"""Loops over rows of one slot and of eight, each against scipy's matrices."""

import numpy as np
import pytest
from kernels import entry

from catenary_fe.engines.kernels import begin, lower, upper
from catenary_fe.engines.lanes import aligned
from catenary_fe.engines.linearised.stretch import take_elements
from catenary_fe.studies.linearised import LinearisedLine


@pytest.fixture(scope="module")
def setup(plane_shape):
    return LinearisedLine(plane_shape).engine.setup


def rows(setup, slots, seed):
    """Any numbers of shape (size,) or (size, slots)."""
    found = aligned((setup.size, slots)[: 1 + (slots > 1)])
    found[:] = np.random.default_rng(seed).normal(size=found.shape)
    return found


@pytest.mark.parametrize("slots", [1, 8])
def test_a_factor_solves(setup, slots):
    x = rows(setup, slots, 1)
    expected = setup.factor.solve(x.copy())
    for half in (lower, upper):
        entry(half)(setup.operator.factor, x, 0, setup.size // 4)
    assert x == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(expected).max())


@pytest.mark.parametrize("slots", [1, 8])
def test_elements_and_the_rest_are_the_stiffness(setup, slots):
    line, operator, model = setup.line, setup.operator, setup.model
    w, v, x = (rows(setup, slots, seed) for seed in range(3))
    still, load = np.zeros_like(w), np.arange(setup.size, dtype=float)
    entry(begin)(load, operator.stiffness, w, operator.rest, v, x)
    entry(take_elements)(line, still, still[: line.tensions.size].copy(), w, x)
    rest = model.damping - operator.beta * model.stiffness
    expected = (load - (model.stiffness @ w + rest @ v).T).T
    assert x == pytest.approx(expected, abs=1e-12 * np.abs(expected).max())


def test_eight_neighbours_begin_where_a_line_of_the_cache_does():
    for shape in ((3, 8), (24,), (5, 1)):
        assert aligned(shape).ctypes.data % 64 == 0 and aligned(shape).shape == shape
