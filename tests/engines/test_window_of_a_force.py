"""What a place of the wires gives to in a compiled nonlinear run; solutions corrected for slack droppers."""

import numpy as np
import pytest
from kernels import entry

from catenary_fe.engines.generalized_alpha import make_scheme
from catenary_fe.engines.nonlinear.forces import REACH, ROOM, local_compliance, solve, woodbury_update
from catenary_fe.engines.nonlinear.setup import Parameters
from catenary_fe.engines.nonlinear.state import _slack
from catenary_fe.engines.settings import TimeSettings


@pytest.fixture(scope="module")
def parts(short_shape):
    """Model, arrays, and the step's matrix at rest with its factor."""
    system, scheme = short_shape.system, make_scheme(TimeSettings())
    parameters, rest = Parameters(system), np.zeros_like(system.reference)
    damping = system.free(system.damping() + system.taut_damping())
    matrix = system.free(system.mass) + scheme.g * damping + scheme.b * system.tangent(rest)
    return system, parameters.equations, matrix.tocsc(), parameters.factor(scheme, rest)


def solved(matrix, right):
    from scipy.sparse.linalg import spsolve

    return spsolve(matrix, right)


@pytest.mark.parametrize("where", ["first", "middle", "last"])
def test_what_a_place_gives(parts, where):
    model, _, matrix, factor = parts
    size = model.size
    first = {"first": 0, "middle": size // 2, "last": size - 4}[where]
    at, weights = np.array([first, -1, first + 1, first + 3]), np.array([0.7, 5.0, -0.2, 0.4])
    column = np.full(ROOM, np.nan)
    begin, width = entry(local_compliance)(factor, at, weights, column)
    right = np.zeros(size)
    right[at[at >= 0]] = weights[at >= 0]
    exact = solved(matrix, right)
    inside = np.zeros(size)
    width = min(width, size - begin)
    inside[begin : begin + width] = column[:width]
    assert inside == pytest.approx(exact, abs=1e-7 * np.abs(exact).max())
    assert begin == max(0, 4 * (first // 4 - REACH))
    assert not factor.window.any()


def test_what_is_held_gives_nothing(parts):
    _, _, _, factor = parts
    assert entry(local_compliance)(factor, np.array([-1, -1]), np.ones(2), np.zeros(ROOM)) == (0, 0)


def test_a_solution_is_that_of_the_matrix(parts):
    model, _, matrix, factor = parts
    right = np.random.default_rng(1).normal(size=model.size)
    x = np.concatenate([right, np.zeros(-model.size % 4)])
    entry(solve)(factor, x)
    expected = solved(matrix, right)
    assert x[: model.size] == pytest.approx(expected, abs=1e-7 * np.abs(expected).max())  # single precision


@pytest.mark.parametrize("lack", [1.0, -0.5])
def test_a_dropper_that_lacks_stiffness_softens_the_solution(parts, lack):
    from scipy.sparse import csc_matrix

    model, system, matrix, factor = parts
    slack, i = _slack(system), 14
    scheme = make_scheme(TimeSettings())
    slack.row[i] = [0.1, -1.0, -0.1, 1.0]
    slack.lack[i] = lack * scheme.b * model.droppers.stiffness[i]
    row = np.zeros((1, model.size))
    row[0, slack.at[i]] = slack.row[i]
    right = 0.3 * row[0]
    right[slack.at[i, 1]] = 0.8
    x = np.concatenate([solved(matrix, right), np.zeros(-model.size % 4)])
    before = x.copy()
    for _ in range(2):  # the second time with the column that was found
        x[:] = before
        entry(woodbury_update)(factor, slack, x)
        expected = solved((matrix - slack.lack[i] * csc_matrix(row.T @ row)).tocsc(), right)
        assert x[: model.size] == pytest.approx(expected, abs=1e-7 * np.abs(expected).max())
    assert np.abs(expected - before[: model.size]).max() > 0.01 * np.abs(expected).max()
