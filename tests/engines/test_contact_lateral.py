"""Where the wire lies on the head: recorded by every engine in space, judged against the head's width."""

import json
from dataclasses import replace

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.fe.system import TimeLoad
from catenary_fe.results.export import history_tables

DROPPERS = tuple(cf.Dropper(position=x) for x in (5.0, 15.0, 25.0, 35.0, 45.0))
ENGINES = ("nonlinear", "linearised", "exudyn")
HEAD = cf.Panhead(width=1.2, spring_distance=0.6)


def line(radius=900.0, stagger=-0.17, **others):
    arm = cf.SteadyArm(length=1.2, mass_per_length=0.73, clamp_mass=0.2)
    support = cf.Support(messenger_stiffness=5e5, steady_arm=arm, stagger=stagger, messenger_stagger=stagger)
    return cf.Catenary.regular(
        spans=5, span_length=50.0, droppers=DROPPERS, curve_radius=radius, system_height=1.4, support=support,
        contact_wire=cf.library.wire("AC-120 CuMg", tension=15e3), evaluated_spans=(3,),
        messenger_wire=cf.library.wire("BzII 70", tension=15e3), damping=cf.RayleighDamping(beta=1e-4),
        **others,
    )  # fmt: skip


@pytest.fixture(scope="module")
def shape():
    return cf.find_form(line())


@pytest.fixture(scope="module")
def runs(shape, pantograph):
    head = pantograph.replace(head=HEAD)
    return {m: cf.simulate(shape, [head], speed=40.0, positions=[60.0], method=m) for m in ENGINES}


@pytest.mark.parametrize("method", ENGINES)
def test_the_place_is_stagger_and_versine(runs, shape, method):
    """-0.17 m at the supports, L²/(8 R) = 0.347 m further in at mid-span, plus what the wire swings."""
    run = runs[method]
    x, (y,) = run.data["position"].values[0], run.data["contact_lateral"].values[0]
    assert y == pytest.approx(shape.wires[0].lateral(x), abs=0.012)
    assert np.interp([100.0, 125.0, 150.0], x, y) == pytest.approx([-0.17, 0.177, -0.17], abs=0.012)
    assert run.largest_contact_lateral() == pytest.approx(0.178, abs=0.01)
    assert run.summary()["largest_contact_lateral_mm"] == pytest.approx(1e3 * run.largest_contact_lateral())


def test_engines_agree_on_the_swing(runs, shape):
    """What the wire moves sideways as the head lifts it: arms swing it in by their inclination."""
    x = runs["nonlinear"].data["position"].values[0]
    rest = shape.wires[0].lateral(x)
    swing = {m: run.data["contact_lateral"].values[0, 0] - rest for m, run in runs.items()}
    assert np.abs(swing["nonlinear"]).max() > 1e-3
    for method in ("linearised", "exudyn"):
        assert swing[method] == pytest.approx(swing["nonlinear"], abs=4e-4), method


def test_a_side_load_on_the_wire_shows_on_the_head(shape, pantograph):
    """A gust of 0.5 N/m to the left over contact wire alone blows it to the left, in every engine alike."""

    def blown(system):
        per_length = np.zeros(system.mass_per_length.size)
        per_length[: system.wires[0].x.size - 1] = 0.5
        load = TimeLoad(system.distributed(per_length, axis=1), lambda t: np.sin(2 * np.pi * t) * (t < 0.5))
        return replace(system, time_loads=(load,))

    windy, found = shape.with_effect(blown), {}
    for method in ENGINES:
        runs = [
            cf.simulate(s, [pantograph], speed=40.0, positions=[60.0], method=method) for s in (windy, shape)
        ]
        still, moved = (run.data["contact_lateral"].values[0, 0] for run in reversed(runs))
        found[method] = moved - still
    assert found["nonlinear"].max() > 0.01
    assert found["exudyn"] == pytest.approx(found["nonlinear"], abs=2e-4)
    # linearised about the wire at rest: the head lifts it by 50 mm, which turns arms of 1.2 m by 4 %
    assert found["linearised"] == pytest.approx(found["nonlinear"], abs=0.05 * found["nonlinear"].max())


def test_each_strip_has_its_place(shape, pantograph):
    head = cf.Panhead(width=1.2, strips=2, strip_distance=0.5)
    run = cf.simulate(shape, [pantograph.replace(head=head)], speed=40.0, positions=[60.0])
    ahead, behind = run.data["contact_lateral"].values[0]
    shift = round(0.5 / 40.0 / run.step)
    assert run.data["contact"].values.tolist() == ["strip 1, contact wire 1", "strip 2, contact wire 1"]
    both = np.isfinite(ahead[:-shift]) & np.isfinite(behind[shift:])
    assert both.mean() > 0.9
    assert ahead[:-shift][both] == pytest.approx(behind[shift:][both], abs=2e-3)
    tables = history_tables(run)["pantograph_1"]
    assert {"contact_1_lateral_m", "contact_2_lateral_m"} <= set(tables)


def test_a_narrow_head_misses_the_criterion_and_a_wide_one_meets_it(runs):
    run = runs["nonlinear"]
    row = next(
        r for r in cf.criteria_rows(run, "AC") if r.name == "farthest contact from the middle of a head"
    )
    assert row.passed and row.limit == 600.0 and row.value == pytest.approx(178.0, abs=10.0)
    narrow = HEAD.replace(width=0.34)
    records = json.dumps([p.replace(head=narrow).model_dump(mode="json") for p in run.pantographs])
    judged = cf.criteria_rows(cf.Run(run.data.assign_attrs(pantographs=records)), "AC")
    assert next(r for r in judged if r.name == row.name).passed is False


def test_a_run_in_the_plane_has_no_such_place(pantograph):
    shape = cf.find_form(line().planar())
    run = cf.simulate(
        shape, [pantograph.replace(head=HEAD)], speed=40.0, positions=[60.0], method="linearised"
    )
    assert "contact_lateral" not in run.data and run.largest_contact_lateral() is None
    assert run.summary()["largest_contact_lateral_mm"] is None
    with pytest.raises(cf.InputError, match="in the vertical plane"):
        run.plot_contact_lateral()
    assert "farthest contact" not in str(cf.criteria_rows(run, "AC"))
