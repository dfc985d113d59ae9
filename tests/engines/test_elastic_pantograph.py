"""The elastic pantograph on the two-wire system: its law holds at every step, and it never pulls."""

import numpy as np
import pytest

import catenary_fe as cf

SPEED = 250 / 3.6


def force_and_elevation(run):
    elevation = run.data["wire_height"].values[0] - run.catenary.contact_wire_height
    return run.data["contact_force"].values[0], elevation


def test_the_force_follows_the_linear_law(short_shape):
    pantograph = cf.ElasticPantograph(force=200.0, stiffness=1000.0)
    run = cf.simulate(short_shape, [pantograph], speed=SPEED)
    force, elevation = force_and_elevation(run)
    # the law is inside the step's equations, so only rounding is left
    assert force == pytest.approx(200.0 - 1000.0 * elevation, abs=1e-6)
    assert run.pantographs == (pantograph,)


def test_the_start_is_in_static_balance(short_shape):
    run = cf.simulate(short_shape, [cf.ElasticPantograph(force=50.0, stiffness=1000.0)], speed=SPEED)
    x = float(run.data["position"].values[0, 0])
    compliance = cf.elasticity(short_shape, force=1.0, positions=[x]).values[0]
    at_rest = short_shape.contact_wire_height(x) - 5.3
    expected = (50.0 - 1000.0 * at_rest) / (1 + 1000.0 * compliance)
    # 0.3 %: a few droppers give way under tens of newtons a little differently than under one
    assert run.data["contact_force"].values[0, 0] == pytest.approx(expected, rel=3e-3)


def test_a_law_of_points_is_the_linear_law_where_they_agree(short_shape):
    linear = cf.ElasticPantograph(force=200.0, stiffness=1000.0)
    points = cf.ElasticPantograph(law=((-1.0, 1200.0), (0.2, 0.0)))
    forces = [
        cf.simulate(short_shape, [p], speed=SPEED).data["contact_force"].values for p in (linear, points)
    ]
    assert forces[0] == pytest.approx(forces[1], abs=1e-6)


def test_it_never_pulls(short_shape):
    """The law ends at 20 mm, below what the wire swings to."""
    pantograph = cf.ElasticPantograph(law=((0.0, 200.0), (0.02, 0.0)))
    run = cf.simulate(short_shape, [pantograph], speed=SPEED, time=cf.TimeSettings(step=5e-4))
    force, elevation = force_and_elevation(run)
    assert force.min() == 0.0
    assert elevation.max() > 0.02
    assert (force[elevation > 0.0201] < 1e-9).all()


def test_a_softer_law_gives_a_larger_force(short_shape):
    means = [
        cf.simulate(short_shape, [cf.ElasticPantograph(force=200.0, stiffness=k)], speed=SPEED)
        .contact_force_statistics()[0]
        .mean
        for k in (0.0, 2000.0)
    ]
    assert means[0] == pytest.approx(200.0)
    assert means[0] > means[1] + 50.0


def test_beside_a_pantograph_of_masses_and_in_a_file(short_shape, pantograph, tmp_path):
    elastic = cf.ElasticPantograph(force=100.0, stiffness=500.0)
    run = cf.simulate(short_shape, [elastic, pantograph], speed=SPEED, positions=[55.0, 15.0])
    again = cf.load_run(run.save(tmp_path / "run.nc"))
    assert again.pantographs == (elastic, pantograph)
    assert np.isnan(again.data["mass_height"].values[0]).all()
    assert not np.isnan(again.data["mass_height"].values[1]).any()


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({}, "give exactly one"),
        ({"force": 100.0, "law": ((0.0, 100.0),)}, "give exactly one"),
        ({"law": ((0.0, 100.0), (0.1, 50.0)), "stiffness": 10.0}, "no effect beside a law"),
        ({"law": ((0.1, 100.0), (0.0, 50.0))}, "elevations must rise"),
        ({"law": ((0.0, 50.0), (0.1, 100.0))}, "forces must not"),
        ({"force": -1.0}, "greater than 0"),
    ],
)
def test_laws_that_are_none(fields, said):
    with pytest.raises(cf.InputError, match=said):
        cf.ElasticPantograph(**fields)


def test_the_law_by_points():
    law = cf.ElasticPantograph(law=((0.0, 200.0), (0.1, 50.0), (0.2, 0.0)))
    assert [law.contact_force(u) for u in (-1.0, 0.0, 0.05, 0.1, 0.15, 0.3)] == pytest.approx(
        [200.0, 200.0, 125.0, 50.0, 25.0, 0.0]
    )
