"""Gusts in runs: their loads against a string's answer in closed form, and what a run makes of them."""

import numpy as np
import pytest
from scipy.linalg import lu_factor, lu_solve

import catenary_fe as cf
from catenary_fe import theory
from catenary_fe.fe.system import System
from tests.conftest import LAYOUTS

U, INTENSITY, SCALE, ALPHA, STEP = 20.0, 0.16, 80.0, 0.6, 0.02


def wind(seed: int = 1, **others: float) -> cf.Wind:
    values = {"intensity": INTENSITY, "length_scale": SCALE, "seed": seed, "duration": 80.0}
    return cf.Wind(speed=U, gusts=cf.Gusts(**(values | others)))


@pytest.fixture(scope="module")
def span() -> cf.Shape:
    """A contact wire that hangs by itself."""
    line = cf.load_catenary(LAYOUTS / "en50318_2002.toml")
    return cf.find_form(
        line.replace(
            spans=(cf.Span(length=60.0, droppers=()),),
            supports=line.supports[:2],
            spatial=True,
            evaluated_spans=None,
            contact_wire=line.contact_wire.replace(diameter=0.0144, bending_stiffness=0.0),
            damping=cf.RayleighDamping(alpha=ALPHA),
        )
    )


def variance(system: System, signals: np.ndarray) -> float:
    """[m²] of the contact wire's middle to the side, of many histories at once: Newmark's method.

    signals : shape (loads, times, histories)
    """
    wire = system.wires[0]
    aside = system.dof[6 * (wire.first + np.arange(wire.x.size)[:, None]) + [1, 4]]
    own = np.unique(aside[aside >= 0])
    rest = np.zeros(system.dof.size)
    whole = system.free(system.mass), system.free(system.damping()), system.tangent(rest)
    M, D, K = (matrix[own][:, own].toarray() for matrix in whole)
    patterns, row = system.patterns[own].toarray(), system.gather(system.row(0, 30.0, 1))[own]
    factor = lu_factor(M + STEP / 2 * D + STEP**2 / 4 * K)
    q = np.linalg.solve(K, patterns @ signals[:, 0])
    v, a, found = np.zeros_like(q), np.zeros_like(q), []
    for now in signals.swapaxes(0, 1)[1:]:
        q, v = q + STEP * v + STEP**2 / 4 * a, v + STEP / 2 * a
        a = lu_solve(factor, patterns @ now - D @ v - K @ q)
        q, v = q + STEP**2 / 4 * a, v + STEP / 2 * a
        found.append(row @ q)
    return float((np.array(found[1500:]) ** 2).mean())


def test_a_string_in_gusts_against_its_variance_in_closed_form(span: cf.Shape) -> None:
    """Fields, tents and system, 200 seeds of 50 s: within 5 %; another intensity or load is found out."""
    times = STEP * np.arange(4001)
    systems = [cf.settle(span, cf.Conditions(wind=wind(seed))).system for seed in range(200)]
    signals = np.stack([system.signals(times) for system in systems], axis=-1)
    ours = variance(systems[0], signals)
    wire = span.catenary.contact_wire
    drag = 2 * 0.5 * 1.25 * 0.0144 * U

    def by_hand(**others: float) -> float:
        gusts = theory.Gusts(**({"mean_speed": U, "intensity": INTENSITY, "length_scale": SCALE} | others))
        damping = ALPHA * wire.mass_per_length + drag
        found = theory.variance_of_string_response(
            wire.beam, 30.0, gusts, length=60.0, damping=damping, load_per_speed=drag
        )
        return float(found)

    assert ours == pytest.approx(by_hand(), rel=0.05)
    for others in ({"intensity": 1.06 * INTENSITY}, {"decay": 5.0}, {"decay": 20.0}):
        assert ours != pytest.approx(by_hand(**others), rel=0.05), others


def test_gusts_share_the_line(span: cf.Shape) -> None:
    """Where the wind is stronger its gusts are, too; what blows along the line does nothing."""
    over_x = wind().replace(speed=((0.0, 10.0), (60.0, 30.0)))
    system = cf.settle(span, cf.Conditions(wind=over_x)).system
    aside = np.arange(system.dof.size) % 6 == 1
    totals = np.asarray(system.time_patterns[aside].sum(axis=0)).ravel()
    local = 10.0 + 20.0 * np.array([5.0, 55.0]) / 60.0
    assert totals[-2] / totals[1] == pytest.approx((local[1] / local[0]) ** 2, rel=0.03)
    along = cf.settle(span, cf.Conditions(wind=wind().replace(direction=180.0)))
    assert along.system.time_loads == ()


def test_the_same_seed_the_same_gusts(span: cf.Shape) -> None:
    times = np.linspace(0.0, 70.0, 300)
    first, same, other = (
        cf.settle(span, cf.Conditions(wind=wind(seed))).system.signals(times) for seed in (1, 1, 2)
    )
    assert np.array_equal(first, same)
    assert not np.allclose(first, other)
    with pytest.raises(cf.InputError, match="duration = 80 s, and the run lasts longer"):
        cf.settle(span, cf.Conditions(wind=wind())).system.signals(np.array([80.5]))


def test_engines_agree_in_gusts() -> None:
    line = cf.load_catenary(LAYOUTS / "re330.toml")
    shape = cf.find_form(line.replace(spans=line.spans[:3], supports=line.supports[:4], evaluated_spans=None))
    head, gusty = cf.library.pantograph("DSA380"), cf.Conditions(name="gusty", wind=wind())
    run = cf.simulate(shape, [head], speed=70.0, conditions=gusty)
    inside, sigma = run.window(0), run.contact_force_statistics()[0].std
    steady = cf.simulate(shape, [head], speed=70.0, conditions=cf.Conditions(wind=cf.Wind(speed=U)))
    gap = steady.filtered_contact_force()[0] - run.filtered_contact_force()[0]
    assert np.sqrt((gap[inside] ** 2).mean()) > 0.04 * sigma  # gusts do something
    assert np.abs(run.missing_energy).max() < 2e-3 * np.abs(run.data["lost_work"].values).max()
    for method in ("linearised", "exudyn"):
        other = cf.simulate(shape, [head], speed=70.0, method=method, conditions=gusty)
        gap = other.filtered_contact_force()[0] - run.filtered_contact_force()[0]
        assert np.sqrt((gap[inside] ** 2).mean()) < 0.02 * sigma, method
