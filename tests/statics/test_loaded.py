"""Static loads: lifts by corrected influence against Newton's method on the whole line, and reciprocity."""

from pathlib import Path

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.statics import loaded, newton
from catenary_fe.statics.loaded import LoadedLine

LAYOUTS = Path(__file__).parents[2] / "models" / "layouts"


def first_spans(name: str, count: int) -> cf.Catenary:
    whole = cf.load_catenary(LAYOUTS / f"{name}.toml")
    middle = (count // 2,)
    return whole.replace(
        spans=whole.spans[:count], supports=whole.supports[: count + 1], evaluated_spans=middle
    )


# bars that turn and stitch wires; droppers that go slack, two contact wires
@pytest.mark.parametrize("name", ["re330", "dc_3kv_twin"])
def test_lifts_are_those_of_the_whole_line(name, monkeypatch):
    line = LoadedLine(cf.find_form(first_spans(name, 9)))
    supports = line.shape.catenary.support_positions
    x = np.linspace(supports[4], supports[5], 5)
    monkeypatch.setattr(LoadedLine, "_lift", lambda *_: pytest.fail("corrections did not settle"))
    lifts = line.lifts(x, 200.0)
    whole = [line.load([at], [1.0]) @ line.solve([at], [200.0]) for at in x]
    assert lifts == pytest.approx(whole, rel=4e-4)
    at_rest = line.system.tangent(0 * line.system.reference).tocsc()
    from scipy.sparse.linalg import spsolve

    load = line.system.gather(line.load([x[0]], [1.0]))
    linear = 200 * load @ spsolve(at_rest, load)
    assert abs(linear / whole[0] - 1) > 5e-3  # negative control: the tangent at rest alone will not do


@pytest.mark.parametrize("name", ["en50318_2002", "re330"])
def test_what_is_left_over_moves_the_points_by_their_influence(name):
    """Maxwell and Betti spare a solution of the whole line for each point: its influence is known."""
    from scipy.sparse.linalg import splu

    line = LoadedLine(cf.find_form(first_spans(name, 9)))
    supports = line.shape.catenary.support_positions
    x = np.linspace(supports[4], supports[5], 6)[:-1]
    stiffness = line.system.tangent(0 * line.system.reference)
    solve = splu(stiffness.tocsc(), **loaded._NARROW).solve
    loads = np.stack([line.system.gather(line.load([at], [150.0])) for at in x])
    around = loaded._Surroundings(line, stiffness, supports[[3, 6]], supports[[2, 7]])
    moved = around.corrected(solve(loads.T).T, loads)
    residual = loads - (stiffness @ moved.T).T
    residual[:, around.part] += around.extra(moved)
    found = line.lifts(x, 150.0)
    assert found == pytest.approx((loads * (moved + solve(residual.T).T)).sum(axis=1) / 150.0, rel=1e-6)
    without = (loads * moved).sum(axis=1) / 150.0
    assert np.abs(found / without - 1).max() > 4e-6  # negative control


def test_lifts_that_do_not_settle_are_solved_for_one_by_one(monkeypatch, short_shape):
    line = LoadedLine(short_shape)
    x = np.array([60.0, 90.0])
    expected = line.lifts(x, 150.0)
    monkeypatch.setattr(loaded, "_CORRECTIONS", 1)
    assert line.lifts(x, 150.0) == pytest.approx(expected, rel=2e-4)


def test_a_force_for_which_no_equilibrium_is_found_is_an_error_with_its_place(monkeypatch, short_shape):
    monkeypatch.setattr(newton, "_ITERATIONS", 3)  # with more, it is chance whether 1e9 N are too much
    with pytest.raises(cf.SolverError, match=r"static load .* wire at \d+\.\d m, .*; try a smaller"):
        cf.solve_statics(short_shape, [(100.0, 1e9)])


def test_what_one_force_does_to_another_place_is_mutual(short_shape):
    """Maxwell and Betti, on the line at rest and in small motions."""
    line = LoadedLine(short_shape)
    near, far = line.load([70.0], [1.0]), line.load([100.0], [1.0])
    assert near @ line.solve([100.0], [0.1]) == pytest.approx(far @ line.solve([70.0], [0.1]), rel=1e-4)
