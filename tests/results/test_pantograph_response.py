"""Own frequencies, receptance and static force of a pantograph, against closed forms."""

import numpy as np
import pytest

import catenary_fe as cf

TWO_MASSES = cf.library.pantograph("EN 50318:2002")
M1, K1, C1, M2, K2, C2 = 7.2, 4200.0, 10.0, 15.0, 50.0, 90.0
FREQUENCIES = np.geomspace(0.1, 50.0, 40)


def closed_form(frequency: np.ndarray) -> np.ndarray:
    """[m/N] of two masses: the upper one on the lower one's dynamic stiffness, in series with its spring."""
    s = 2j * np.pi * frequency
    between, lower = K1 + C1 * s, K2 + C2 * s + M2 * s**2
    return 1 / (M1 * s**2 + 1 / (1 / between + 1 / lower))


def heavier(pantograph: cf.Pantograph) -> cf.Pantograph:
    head, lower = pantograph.stages
    return pantograph.replace(stages=(head.replace(mass=1.01 * head.mass), lower))


def test_receptance_of_two_masses():
    found = cf.pantograph_response(TWO_MASSES, FREQUENCIES.tolist())
    np.testing.assert_allclose(found.receptance, closed_form(FREQUENCIES), rtol=1e-9)
    np.testing.assert_allclose(found.dynamic_stiffness * closed_form(FREQUENCIES), 1.0, rtol=1e-9)
    assert found.apparent_mass[-1].real == pytest.approx(M1 - K1 / (2 * np.pi * 50) ** 2, rel=1e-4)
    other = cf.pantograph_response(heavier(TWO_MASSES), FREQUENCIES.tolist())
    assert abs(other.receptance / closed_form(FREQUENCIES) - 1).max() > 5e-3


def test_own_frequencies_of_two_masses():
    """Roots of (m₁s² + c₁s + k₁)(m₂s² + (c₁ + c₂)s + k₁ + k₂) = (c₁s + k₁)²."""
    product = np.polymul([M1, C1, K1], [M2, C1 + C2, K1 + K2])
    roots = np.roots(np.polysub(product, np.polymul([C1, K1], [C1, K1])))
    slow, fast = np.sort(roots[roots.imag == 0].real), roots[roots.imag > 0][0]
    found = cf.pantograph_response(TWO_MASSES)
    expected = np.array([np.sqrt(slow.prod()), abs(fast)]) / (2 * np.pi)
    np.testing.assert_allclose(found.own_frequencies, expected, rtol=1e-9)
    ratios = [-slow.sum() / 2 / np.sqrt(slow.prod()), -fast.real / abs(fast)]
    np.testing.assert_allclose(found.damping_ratios, ratios, rtol=1e-9)
    other = cf.pantograph_response(heavier(TWO_MASSES)).own_frequencies
    assert other[1] / expected[1] == pytest.approx(1 - 0.005 * M2 / (M1 + M2), abs=1e-4)


def test_static_force_falls_by_the_springs_in_series():
    found = cf.pantograph_response(TWO_MASSES, speed=50.0)
    stiffness = 1 / (1 / K1 + 1 / K2)
    np.testing.assert_allclose(np.diff(found.force) / np.diff(found.height), -stiffness, rtol=1e-9)
    assert found.uplift == 120.0 and found.force_varies
    constant = cf.pantograph_response(cf.library.pantograph("SSS400+").with_uplift(90.0))
    np.testing.assert_allclose(constant.force, 90.0, rtol=1e-9)
    assert not constant.force_varies
    assert constant.own_frequencies[0] == 0 and np.isnan(constant.damping_ratios[0])
    assert constant.as_dict()["damping_ratios"][0] is None


def test_two_strips_yield_as_one_head():
    split = TWO_MASSES.replace(head=cf.Panhead(strips=2, strip_distance=0.5))
    found = cf.pantograph_response(split, FREQUENCIES.tolist())
    np.testing.assert_allclose(found.receptance, closed_form(FREQUENCIES), rtol=1e-9)
    assert found.own_frequencies.size == 3


def test_elastic_pantographs():
    soft = cf.pantograph_response(cf.ElasticPantograph(force=100.0, stiffness=200.0), [1.0, 2.0])
    assert soft.receptance.tolist() == [1 / 200.0] * 2 and soft.own_frequencies.size == 0
    np.testing.assert_allclose(soft.force, 100.0 - 200.0 * soft.height, rtol=1e-12, atol=1e-9)
    constant = cf.ElasticPantograph(force=100.0)
    assert cf.pantograph_response(constant).as_dict()["receptance"] is None
    with pytest.raises(cf.InputError, match="no receptance"):
        cf.receptance_table(constant, "nowhere.csv")


def test_a_written_table_is_read_as_the_same_head(tmp_path):
    cf.receptance_table(TWO_MASSES, tmp_path / "head.csv")
    (tmp_path / "head.toml").write_text('receptance = "head.csv"\nuplift_force = 120.0')
    again = cf.load_pantograph(tmp_path / "head.toml")
    found = cf.pantograph_response(again, FREQUENCIES.tolist())
    np.testing.assert_allclose(found.receptance, closed_form(FREQUENCIES), rtol=1e-7)
    np.testing.assert_allclose(
        found.own_frequencies, cf.pantograph_response(TWO_MASSES).own_frequencies, rtol=1e-7
    )


def test_what_is_refused():
    for wrong in ([], [0.0], [-1.0], [[1.0]], ["a"]):
        with pytest.raises(cf.InputError):
            cf.pantograph_response(TWO_MASSES, wrong)
    with pytest.raises(cf.InputError):
        cf.pantograph_response(TWO_MASSES, speed=-1.0)
