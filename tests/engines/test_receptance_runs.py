"""A pantograph of masses and the receptance made of it run alike; a noisy table runs nearly so."""

import numpy as np
import pytest

import catenary_fe as cf

SPEED = 70.0
FREQUENCIES = np.geomspace(0.1, 50.0, 90)


def by_receptance(
    pantograph: cf.Pantograph, noise: float = 0.0, heavier: float = 1.0
) -> cf.ReceptancePantograph:
    response = cf.pantograph_response(pantograph, FREQUENCIES.tolist()).receptance / heavier
    rng = np.random.default_rng(3)
    share = (rng.standard_normal(FREQUENCIES.size) + 1j * rng.standard_normal(FREQUENCIES.size)) / np.sqrt(2)
    values = response * (1 + noise * share)
    rows = zip(FREQUENCIES.tolist(), abs(values).tolist(), np.angle(values, deg=True).tolist(), strict=True)
    return cf.ReceptancePantograph(receptance=list(rows), uplift_force=pantograph.uplift_force)


def std(shape: cf.Shape, pantograph: object, method: str) -> float:
    run = cf.simulate(shape, [pantograph], speed=SPEED, method=method)
    assert not [
        check
        for check in run.checks
        if check.name in ("force balance", "pantograph energy") and not check.passed
    ]
    return float(run.data["contact_force"].values[0].std())


@pytest.mark.parametrize("method", ["linearised", "nonlinear"])
@pytest.mark.parametrize("name", ["EN 50318:2018 AC", "DSA380"])
def test_a_run_by_receptance_is_that_of_the_masses(short_shape, name, method):
    masses = cf.library.pantograph(name).with_uplift(120.0)
    expected = std(short_shape, masses, method)
    assert std(short_shape, by_receptance(masses), method) == pytest.approx(expected, rel=1e-4)
    if method == "linearised":
        assert std(short_shape, by_receptance(masses, noise=0.02), method) == pytest.approx(
            expected, rel=0.01
        )
        stiffer = std(short_shape, by_receptance(masses, heavier=1.2), method)
        assert abs(stiffer / expected - 1) > 0.01
