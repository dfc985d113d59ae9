"""The quality checks of a pantograph find the force or energy left out of motions of second order in time."""

import json

import numpy as np
import pytest
from made_runs import HEIGHT, made_pantograph, made_run

import catenary_fe as cf

STEP, TIMES = 1e-3, 501
TIME = STEP * np.arange(TIMES)
ELASTIC = cf.ElasticPantograph(force=100.0)
STRIPS = cf.Panhead(strips=2, strip_distance=0.5)
CHAINS = {  # (mass, stiffness, damping), head first
    1: [(10.0, 200.0, 30.0)],
    2: [(8.0, 4000.0, 100.0), (15.0, 50.0, 90.0)],
    3: [(6.0, 7000.0, 20.0), (9.0, 10e3, 40.0), (14.0, 70.0, 60.0)],
}
MOTION = [(0.01, 0.4, 0.05), (0.02, 0.3, -0.04), (0.015, 0.25, 0.03)]  # start, velocity, acceleration


def check(run, name):
    return {check.name: check for check in run.checks}.get(name)


def moving(*pantographs, force=100.0, motions=None):
    """A run whose masses move so; forces [N] of shape (pantographs, times) or less."""
    motions = motions or [MOTION[: len(p.stages)] for p in pantographs]
    heights = np.full((len(motions), max(map(len, motions)), TIMES), np.nan)
    for i, motion in enumerate(motions):
        for mass, (a, b, c) in enumerate(motion):
            heights[i, mass] = HEIGHT + a + b * TIME + c * TIME**2 / 2
    return made_run(
        None, *pantographs, step=STEP, times=TIMES, speed=590.0, start=[5.0] * len(pantographs),
        contact_force=force, mass_height=heights,
    )  # fmt: skip


def not_passed(times):
    """A run that ended long before its spans."""
    return made_run(times=times, partial=json.dumps({"reason": "", "reached_s": 0.0, "planned_s": 1.0}))


def momentum_missing(stages, motion, force, masses=None):
    """[%] by hand: the impulse of all forces on the chain, less its momentum at the end, of the uplift's.

    Runs begin at rest; a velocity at their start is not told apart from one that a force gave.
    """
    T, (_, stiffness, damping), (a, b, c) = TIME[-1], stages[-1], motion[-1]
    impulse = (100 - force) * T - stiffness * (a * T + b * T**2 / 2 + c * T**3 / 6)
    impulse -= damping * (b * T + c * T**2 / 2)
    masses = masses or [mass for mass, _, _ in stages]
    momentum = sum(m * (b + c * T) for m, (_, b, c) in zip(masses, motion, strict=True))
    return 100 * abs(impulse - momentum) / (100 * T)


@pytest.mark.parametrize("stages", CHAINS.values(), ids=CHAINS)
@pytest.mark.parametrize("force", [40.0, 150.0])
def test_forces_on_a_chain(stages, force):
    balance = check(moving(made_pantograph(*stages), force=force), "force balance")
    assert balance.value == pytest.approx(momentum_missing(stages, MOTION[: len(stages)], force), rel=1e-5)


def test_two_strips_share_the_mass_of_a_head():
    motion = [MOTION[0], (0.01, 0.5, 0.04), MOTION[1]]
    run = moving(made_pantograph(*CHAINS[2], head=STRIPS), force=90.0, motions=[motion])
    expected = momentum_missing(CHAINS[2], motion, 90.0, masses=[4.0, 4.0, 15.0])
    assert check(run, "force balance").value == pytest.approx(expected, rel=1e-5)


def test_two_strips_on_the_only_spring_press_it_with_their_mean():
    motion = [(0.01, 0.2, 0.04), (0.03, 0.4, 0.08)]
    run = moving(made_pantograph(*CHAINS[1], head=STRIPS), force=90.0, motions=[motion])
    expected = momentum_missing(CHAINS[1], [(0.02, 0.3, 0.06)], 90.0)
    assert check(run, "force balance").value == pytest.approx(expected, rel=1e-5)


def test_the_worst_force_balance_counts():
    """Whatever other pantographs there are, before or behind it."""
    pantographs = [made_pantograph(*CHAINS[3]), ELASTIC, made_pantograph(*CHAINS[1])]
    still = [(0.0, 0.0, 0.0)] * 3
    run = moving(*pantographs, force=[[101.0], [55.0], [80.0]], motions=[still, [], MOTION[:1]])
    expected = momentum_missing(CHAINS[1], MOTION[:1], 80.0)
    assert check(run, "force balance").value == pytest.approx(expected, rel=1e-5)


def test_a_velocity_needs_three_times_and_an_energy_five():
    assert check(not_passed(2), "force balance") is None
    assert check(not_passed(3), "force balance").passed
    assert check(not_passed(4), "pantograph energy") is None
    assert check(not_passed(5), "pantograph energy").passed


def test_elastic_pantographs_have_nothing_to_balance():
    names = {c.name for c in made_run(None, ELASTIC).checks}
    assert not names & {"penetration", "force balance", "pantograph energy"}


def balanced_force(stages):
    """[N] of shape (times,), with which the power of all forces is the rise of the chain's energy."""
    z = [a + b * TIME + c * TIME**2 / 2 for a, b, c in MOTION[: len(stages)]] + [0 * TIME]
    v = [b + c * TIME for _, b, c in MOTION[: len(stages)]] + [0 * TIME]
    power = 100 * v[len(stages) - 1]
    for i, (mass, stiffness, damping) in enumerate(stages):
        stretch, rate = z[i] - z[i + 1], v[i] - v[i + 1]
        power = power - mass * v[i] * MOTION[i][2] - stiffness * stretch * rate - damping * rate**2
    return power / v[0]


def energy_missing(stages, more):
    """[%] by hand: ``more`` newtons work unseen, from the second step to the last but one."""
    height, force = MOTION[0][1] * TIME + MOTION[0][2] * TIME**2 / 2, balanced_force(stages) + more
    work = np.abs((force[1:] + force[:-1]) / 2 * np.diff(height)).sum()
    return 100 * abs(more) * (height[-2] - height[1]) / work


@pytest.mark.parametrize("stages", CHAINS.values(), ids=CHAINS)
def test_energy_of_a_chain(stages):
    run = moving(made_pantograph(*stages), force=balanced_force(stages))
    assert check(run, "pantograph energy").value < 1e-3
    for more in (-0.6, 0.3):
        run = moving(made_pantograph(*stages), force=balanced_force(stages) + more)
        expected = pytest.approx(energy_missing(stages, more), rel=2e-3)
        assert check(run, "pantograph energy").value == expected


def test_heads_that_roll_or_have_two_strips_are_passed_over():
    chains, roll = [CHAINS[1], CHAINS[2], CHAINS[2], CHAINS[3]], cf.Panhead(spring_distance=0.8)
    pantographs = [
        made_pantograph(*chain, head=head)
        for chain, head in zip(chains, (STRIPS, None, roll, None), strict=True)
    ]
    forces = np.array(
        [balanced_force(c) + more for c, more in zip(chains, (9.0, 0.1, 0.8, 0.2), strict=True)]
    )
    run = moving(*pantographs, force=forces, motions=[MOTION[:2], MOTION[:2], MOTION[:2], MOTION])
    energy = check(run, "pantograph energy")  # in the plane a head stays level
    assert energy.value == pytest.approx(energy_missing(CHAINS[2], 0.8), rel=2e-3)
    run.data.attrs["catenary"] = run.catenary.replace(spatial=True).model_dump_json()
    expected = max(energy_missing(CHAINS[2], 0.1), energy_missing(CHAINS[3], 0.2))
    assert check(cf.Run(run.data), "pantograph energy").value == pytest.approx(expected, rel=2e-3)
