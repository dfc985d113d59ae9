"""Chains of masses that meet a table of receptances: known chains come back, noise stays noise."""

import numpy as np
import pytest

from catenary_fe.theory import MassChain, fit_receptance

FREQUENCIES = np.geomspace(0.1, 50.0, 90)
MASSES, SPRINGS = np.array([7.5, 9.0, 6.0]), np.array([7000.0, 15500.0, 160.0])


def dampers(*below: float) -> np.ndarray:
    """Of a chain, below each mass."""
    n = len(below)
    D = np.zeros((n, n))
    for i, value in enumerate(below):
        row = np.zeros(n)
        row[i] = 1.0
        row[i + 1 : i + 2] = -1.0
        D += value * np.outer(row, row)
    return D


CHAIN = MassChain(MASSES, SPRINGS, dampers(45.0, 0.1, 100.0))
UNDAMPED_ABOVE = MassChain(
    np.array([7.12, 6.0, 5.8]), np.array([9430.0, 14100.0, 0.1]), dampers(0.0, 0.0, 70.0)
)


def off(chain: MassChain, receptance: np.ndarray) -> np.ndarray:
    return abs(chain.receptance(FREQUENCIES) / receptance - 1)


def test_receptance_of_one_mass():
    """1 / (k - m ω² + i c ω)."""
    one = MassChain(np.array([12.0]), np.array([300.0]), np.array([[40.0]]))
    omega = 2 * np.pi * FREQUENCIES
    expected = 1 / (300.0 - 12.0 * omega**2 + 40.0j * omega)
    np.testing.assert_allclose(one.receptance(FREQUENCIES), expected, rtol=1e-12)
    assert one.static_stiffness == 300.0


@pytest.mark.parametrize("chain", [CHAIN, UNDAMPED_ABOVE])
def test_a_chain_comes_back_from_its_own_receptance(chain):
    found = fit_receptance(FREQUENCIES, chain.receptance(FREQUENCIES))
    np.testing.assert_allclose(found.masses, chain.masses, rtol=1e-6)
    np.testing.assert_allclose(found.springs, chain.springs, rtol=1e-5)
    np.testing.assert_allclose(found.damping, chain.damping, atol=1e-4)
    heavier = MassChain(1.01 * chain.masses, chain.springs, chain.damping)
    other = fit_receptance(FREQUENCIES, heavier.receptance(FREQUENCIES))
    np.testing.assert_allclose(other.masses, 1.01 * chain.masses, rtol=1e-6)


@pytest.mark.parametrize(("chain", "seed"), [(CHAIN, 1), (UNDAMPED_ABOVE, 2)])
def test_noise_is_not_met_by_more_masses(chain, seed):
    rng = np.random.default_rng(seed)
    noise = rng.standard_normal(FREQUENCIES.size) + 1j * rng.standard_normal(FREQUENCIES.size)
    receptance = chain.receptance(FREQUENCIES) * (1 + 0.02 * noise / np.sqrt(2))
    found = fit_receptance(FREQUENCIES, receptance)
    assert found.masses.size == 3
    assert np.sqrt((off(found, receptance) ** 2).mean()) == pytest.approx(0.02, abs=0.004)
    assert np.sqrt((off(found, chain.receptance(FREQUENCIES)) ** 2).mean()) < 0.01
    for matrix in (found.stiffness, found.damping):  # nothing gives energy
        values = np.linalg.eigvalsh(matrix)
        assert values.min() > -1e-12 * values.max()
    fewer = fit_receptance(FREQUENCIES, receptance, 2)
    assert np.sqrt((off(fewer, receptance) ** 2).mean()) > 0.03


def test_an_antiresonance_counts_as_a_resonance():
    """The lower mass alone on its springs is all that is seen where the head hardly moves."""
    receptance = UNDAMPED_ABOVE.receptance(FREQUENCIES)
    deepest = abs(receptance * FREQUENCIES**2).argmin()
    assert off(fit_receptance(FREQUENCIES, receptance), receptance)[deepest] < 1e-6
    assert off(fit_receptance(FREQUENCIES, receptance, 1), receptance)[deepest] > 0.3


def test_dampers_that_no_chain_has():
    """Between head and lowest mass, and from the head to the base."""
    D = dampers(30.0, 5.0, 80.0) + 25.0 * np.outer([1, 0, -1], [1, 0, -1]) + np.diag([15.0, 0, 0])
    receptance = MassChain(MASSES, SPRINGS, D).receptance(FREQUENCIES)
    assert off(fit_receptance(FREQUENCIES, receptance, 3), receptance).max() < 0.02


@pytest.mark.parametrize("stiffness", [0.0, 25.0])
def test_the_static_stiffness_is_as_given(stiffness):
    above = FREQUENCIES > 1.0  # where the base's spring hardly shows
    receptance = UNDAMPED_ABOVE.receptance(FREQUENCIES[above])
    found = fit_receptance(FREQUENCIES[above], receptance, 3, stiffness)
    assert found.static_stiffness == pytest.approx(stiffness, abs=1e-9)
    assert off(found, UNDAMPED_ABOVE.receptance(FREQUENCIES))[above].max() < 0.034  # 25 of 750 N/m at 1 Hz


@pytest.mark.parametrize(
    ("change", "said"),
    [({"frequency": FREQUENCIES[::-1]}, "rising"), ({"modes": 9}, "at most 6"), ({"modes": 0}, "at least 1"),
     ({"receptance": 0 * FREQUENCIES}, "not 0"),
     ({"frequency": [1.0, 2.0], "receptance": [1, 1]}, "or more")],
)  # fmt: skip
def test_what_is_refused(change, said):
    given = {"frequency": FREQUENCIES, "receptance": CHAIN.receptance(FREQUENCIES)} | change
    with pytest.raises(ValueError, match=said):
        fit_receptance(**given)
