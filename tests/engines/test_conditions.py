"""Runs under conditions: all engines start from the settled line, and what they record says so."""

import json

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.fe.surroundings import surrounded
from catenary_fe.studies.rerun import rerun
from tests.conftest import LAYOUTS

SPEED = 70.0
STORM = cf.Conditions(
    name="storm", temperature=-20.0, wind=cf.Wind(speed=12.0), ice=cf.Ice(load=1.0, wires=("messenger_wire",))
)


@pytest.fixture(scope="module")
def head() -> cf.Pantograph:
    return cf.library.pantograph("DSA380")


@pytest.fixture(scope="module")
def shape() -> cf.Shape:
    line = cf.load_catenary(LAYOUTS / "re330.toml")
    return cf.find_form(line.replace(spans=line.spans[:4], supports=line.supports[:5], evaluated_spans=None))


@pytest.fixture(scope="module")
def run(shape: cf.Shape, head: cf.Pantograph) -> cf.Run:
    return cf.simulate(shape, [head], speed=SPEED, conditions=STORM)


def test_engines_agree_under_conditions(shape: cf.Shape, run: cf.Run, head: cf.Pantograph) -> None:
    inside, sigma = run.window(0), run.contact_force_statistics()[0].std
    still = cf.simulate(shape, [head], speed=SPEED, method="linearised").filtered_contact_force()[0]
    ours = run.filtered_contact_force()[0]
    assert np.sqrt(((still - ours)[inside] ** 2).mean()) > 0.1 * sigma  # the conditions do something
    for method in ("linearised", "exudyn"):
        other = cf.simulate(shape, [head], speed=SPEED, method=method, conditions=STORM)
        gap = other.filtered_contact_force()[0] - ours
        assert np.sqrt((gap[inside] ** 2).mean()) < 0.03 * sigma, method
        uplift = other.data["support_uplift"].values - run.data["support_uplift"].values
        assert np.abs(uplift).max() < 1e-3, method


def test_a_settled_start_is_one_that_a_run_finds(shape: cf.Shape, head: cf.Pantograph) -> None:
    """Where no cantilever swings, a run's own static start finds the same state from the line as hung."""
    ice = cf.Conditions(ice=cf.Ice(load=1.0))
    settled = cf.simulate(shape, [head], speed=SPEED, conditions=ice)
    effects = ice.effects(15.0)
    itself = cf.simulate(shape.with_effect(lambda s: surrounded(s, effects)), [head], speed=SPEED)
    inside = settled.window(0)
    gap = (settled.filtered_contact_force() - itself.filtered_contact_force())[0][inside]
    assert np.sqrt((gap**2).mean()) < 0.01 * settled.contact_force_statistics()[0].std


def test_no_conditions_are_the_line_as_hung(shape: cf.Shape, head: cf.Pantograph) -> None:
    none = cf.simulate(shape, [head], speed=SPEED, method="linearised", conditions=cf.Conditions())
    plain = cf.simulate(shape, [head], speed=SPEED, method="linearised")
    assert none.data["contact_force"].values == pytest.approx(plain.data["contact_force"].values, abs=1e-6)


def test_wind_damps_the_wires(shape: cf.Shape) -> None:
    """By 2 k u to the side and k u up and down, over mass and frequency: quasi-steady."""
    wind = cf.Wind(speed=12.0)
    windy = cf.settle(shape, cf.Conditions(wind=wind)).system
    up, left = ((np.arange(windy.dof.size) % 6 == axis).astype(float) for axis in (2, 1))
    for axis, share in ((up, 1.0), (left, 2.0)):
        by_hand = sum(
            share * float(wind.resistance(cf.WirePart(w.kind, w.wire, w.x[:1]), None)[0]) * 12.0 * np.ptp(w.x)
            for w in shape.system.wires
        )
        assert axis @ windy.linear_damping @ axis == pytest.approx(by_hand, rel=1e-3)


def test_the_record_says_it_and_is_repeated(run: cf.Run, tmp_path) -> None:
    read = cf.load_run(run.save(tmp_path / "run.nc"))
    assert read.conditions == STORM
    assert read.summary()["conditions"] == "storm"
    assert read.data.attrs["title"] == "Re 330, storm"
    assert json.loads(read.data.attrs["conditions"])["temperature"] == -20.0
    assert rerun(read).identical


def test_runs_of_a_scripts_effect_are_not_repeated(shape: cf.Shape, head: cf.Pantograph) -> None:
    class Snow(cf.Effect):
        def mass(self, part: cf.WirePart) -> np.ndarray:
            return part.nothing[0] + 0.1

    run = cf.simulate(shape, [head], speed=SPEED, method="linearised", conditions=[Snow()])
    with pytest.raises(cf.InputError, match="of a script"):
        rerun(run)


def test_a_multibody_model_has_the_conditions_of_its_shape(shape: cf.Shape, head: cf.Pantograph) -> None:
    model = cf.exudyn_model(shape, [head])
    with pytest.raises(cf.InputError, match="give exudyn_model a settled shape"):
        cf.simulate(shape, [head], speed=SPEED, method="exudyn", model=model, conditions=STORM)
