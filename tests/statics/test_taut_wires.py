"""Exact elements of strings and tensioned beams, against closed forms that are written down here."""

import numpy as np
import pytest

from catenary_fe.statics.taut_wires import exact_load, exact_stiffness

TENSION = 16e3


def chain(elements: int, length: float, tension: float, bending: float) -> tuple[np.ndarray, np.ndarray]:
    """Stiffness of equal elements in a row, and the nodal forces of 1 N/m on them."""
    one = np.ones(elements)
    arguments = tension * one, bending * one, length / elements * one
    K, f = np.zeros((2 * elements + 2,) * 2), np.zeros(2 * elements + 2)
    for e, (block, load) in enumerate(zip(exact_stiffness(*arguments), exact_load(*arguments), strict=True)):
        K[2 * e : 2 * e + 4, 2 * e : 2 * e + 4] += block
        f[2 * e : 2 * e + 4] += load
    return K, f


def pinned(K: np.ndarray, f: np.ndarray) -> np.ndarray:
    """Deflections and slopes between held ends."""
    free = np.flatnonzero(np.diag(K))
    free = free[(free != 0) & (free != K.shape[0] - 2)]
    found = np.zeros(f.size)
    found[free] = np.linalg.solve(K[np.ix_(free, free)], f[free])
    return found


@pytest.mark.parametrize("bending", [1e-3, 1.0, 131.7, 2e4, 2.7e5, 1e9])
@pytest.mark.parametrize("elements", [2, 6])
def test_a_tensioned_beam_under_a_force_at_mid_span(bending, elements):
    length = 8.0
    K, f = chain(elements, length, TENSION, bending)
    force = np.zeros_like(f)
    force[elements] = 100.0
    u = length / 2 * np.sqrt(TENSION / bending)
    closed = 100 * length / (4 * TENSION) * (1 - np.tanh(u) / u)
    assert pinned(K, force)[elements] == pytest.approx(closed, rel=1e-6)
    assert pinned(K, force)[elements] != pytest.approx(closed * 1.01, rel=1e-3)  # tension up by 1 %


@pytest.mark.parametrize("bending", [0.0, 1e-3, 131.7, 2e4, 2.7e5])
@pytest.mark.parametrize("elements", [2, 8])
def test_a_tensioned_beam_under_its_weight(bending, elements):
    length, load = 8.0, 10.0
    K, f = chain(elements, length, TENSION, bending)
    closed = load * length**2 / (8 * TENSION)
    if bending:
        u = length / 2 * np.sqrt(TENSION / bending)
        closed -= load * bending / TENSION**2 * (1 - 1 / np.cosh(min(u, 700.0)))
    assert pinned(K, load * f)[elements] == pytest.approx(closed, rel=1e-7)


def test_elements_are_the_same_to_both_sides_of_where_the_cubic_one_serves():
    one = np.array([1.0])
    for function in (exact_stiffness, exact_load):
        below, above = (function(one, one, 0.05 * one * (1 + side * 1e-9)) for side in (-1, 1))
        assert above == pytest.approx(below, rel=1e-6)


def test_a_rigid_motion_and_the_whole_load():
    tension, bending, length = np.full(3, TENSION), np.array([0.0, 131.7, 1e9]), np.full(3, 2.0)
    stiffness, load = exact_stiffness(tension, bending, length), exact_load(tension, bending, length)
    assert stiffness @ [1.0, 0, 1.0, 0] == pytest.approx(np.zeros((3, 4)), abs=1e-4)
    assert load[:, 0] + load[:, 2] == pytest.approx(length)
    assert (np.linalg.eigvalsh(stiffness) > -1e-3).all()
