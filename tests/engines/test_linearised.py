"""Linearised runs: against nonlinear ones, slots against each other, compiled against plain."""

import re
from pathlib import Path

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.engines.base import RunCase
from catenary_fe.studies.linearised import LinearisedLine

CASES = Path(__file__).parents[1] / "cases"


@pytest.fixture(scope="module")
def linearised(short_shape, pantograph):
    return cf.simulate(short_shape, [pantograph], speed=250 / 3.6, store_wire=0.02, method="linearised")


def filtered_difference(a, b):
    inside = a.window(0)
    return np.std((a.filtered_contact_force() - b.filtered_contact_force())[0, inside])


def test_statistics_agree_with_the_nonlinear_run(linearised, short_run):
    ours, theirs = (run.contact_force_statistics()[0] for run in (linearised, short_run))
    for name in ("mean", "std", "max", "min"):
        assert getattr(ours, name) == pytest.approx(getattr(theirs, name), rel=0.01), name
    assert linearised.largest_support_uplift() == pytest.approx(short_run.largest_support_uplift(), rel=0.01)
    assert filtered_difference(linearised, short_run) < 0.03 * theirs.std
    assert linearised.method == "linearised"
    # the line is short for both; the linearised run has no doubts of its own
    assert not linearised.warnings


def test_histories_agree_with_the_nonlinear_run(linearised, short_run):
    others = {"tension_time", "tension_change", "tension_span", "wire"}
    others |= {"energy_time", "energy", "driven_work", "lost_work"}
    assert set(linearised.data.variables) == set(short_run.data.variables) - others
    for name, close in (
        ("contact_force", 5.0), ("mass_height", 5e-4), ("wire_height", 5e-4), ("support_uplift", 5e-4),
        ("contact_wire_height", 1e-3),
    ):  # fmt: skip
        ours, theirs = linearised.data[name].values, short_run.data[name].values
        assert ours.shape == theirs.shape
        assert np.sqrt(np.mean((ours - theirs) ** 2)) < close, name
        assert ours[..., 0] == pytest.approx(theirs[..., 0], abs=2e-3 if name == "contact_force" else 1e-5)


def test_droppers_go_slack_when_they_do_in_the_nonlinear_run(linearised, short_run):
    ours, theirs = (run.data["dropper_force"].values for run in (linearised, short_run))
    slack = (theirs <= 0).sum()
    assert slack > 100
    assert (ours >= 0).all()
    assert (ours <= 0).sum() == pytest.approx(slack, rel=0.05)


def test_without_slack_droppers_it_would_be_another_result(linearised, short, pantograph):
    """The twin: droppers that push as well as pull change the force by far more than the agreement above."""
    line = LinearisedLine(cf.find_form(short))
    line.engine.setup.line.tension[:] += 1e6  # so they are never slack
    plan = linearised.data["position"].values[0]
    (stiff,) = line.run([RunCase([pantograph], 250 / 3.6, plan[:1], plan[-1] - plan[0])])
    assert filtered_difference(stiff, linearised) > 0.2 * linearised.contact_force_statistics()[0].std


def test_lanes_do_not_know_of_each_other(short_shape, pantograph):
    other = cf.library.pantograph("DSA380")
    soft = pantograph.replace(contact_damping=50.0)
    start = np.array([10.0])
    cases = [
        RunCase([pantograph], 200 / 3.6, start, 200.0), RunCase([other], 250 / 3.6, start, 210.0),
        RunCase([soft, pantograph], 250 / 3.6, np.array([45.0, 10.0]), 180.0),
        RunCase([pantograph], 300 / 3.6, start, 120.0), RunCase([other], 180 / 3.6, start, 170.0),
    ]  # fmt: skip
    line = LinearisedLine(short_shape)
    together = line.run(cases * 2)
    for case, one, again in zip(cases, together[:5], together[5:], strict=True):
        (alone,) = line.run([case])
        for name in ("contact_force", "dropper_force", "mass_height"):
            assert one.data[name].values == pytest.approx(alone.data[name].values, abs=1e-6), name
            assert np.array_equal(one.data[name].values, again.data[name].values, equal_nan=True)


def test_a_lane_forgets_the_run_before(short_shape, pantograph):
    """Runs end with slack droppers near the pantograph; the next one in that slot begins with none."""
    strong = pantograph.replace(uplift_force=250.0)
    line, start = LinearisedLine(short_shape), np.array([10.0])
    before, case = RunCase([strong], 60.0, start, 215.0), RunCase([strong], 60.0, start, 212.0)
    (alone,) = line.run([case])
    (first, *_), after = line.run([before] * 8), line.run([before] * 8 + [case] * 8)[8:]
    assert (first.data["dropper_force"].values[:, -1] <= 0).any()
    for run in after:
        for name in ("contact_force", "dropper_force"):
            assert run.data[name].values == pytest.approx(alone.data[name].values, abs=1e-6), name


def test_a_run_that_is_repeated_is_the_one_with_the_uplift_that_was_found(short_shape, pantograph):
    wanted = pantograph.replace(uplift_force=None, mean_force=200.0)
    found = cf.simulate(short_shape, [wanted], speed=70.0, method="linearised")
    uplift = float(found.data["uplift_force"].values[0])
    same = cf.simulate(
        short_shape, [pantograph.replace(uplift_force=uplift)], speed=70.0, method="linearised"
    )
    for name in ("contact_force", "dropper_force", "mass_height"):
        assert np.array_equal(found.data[name].values, same.data[name].values), name


def test_contact_is_lost_and_found(short_shape, pantograph):
    light = pantograph.replace(uplift_force=45.0)
    run = cf.simulate(short_shape, [light], speed=300 / 3.6, method="linearised")
    force, gap = (
        run.data["contact_force"].values[0],
        run.data["mass_height"].values[0, 0] - run.data["wire_height"].values[0],
    )
    assert 0.01 < (force <= 0).mean() < 0.5
    assert force == pytest.approx(np.maximum(0.0, 50e3 * gap), abs=1e-3)


def test_a_mean_force_is_reached(short_shape):
    wanted = cf.library.pantograph("EN 50318:2018 AC")
    run = cf.simulate(short_shape, [wanted], speed=250 / 3.6, method="linearised")
    assert run.contact_force_statistics()[0].mean == pytest.approx(0.00097 * 250**2 + 70, abs=0.1)


def test_a_line_without_any_damping():
    """There is no damping matrix then."""
    shape = cf.find_form(cf.load_catenary(CASES / "undamped.toml"))
    pantographs, settings = [cf.library.pantograph("DSA250")], cf.TimeSettings(step=2e-3)
    first, second = (
        cf.simulate(shape, pantographs, speed=200 / 3.6, time=settings, method=method)
        for method in ("nonlinear", "linearised")
    )
    (a,), (b,) = first.contact_force_statistics(), second.contact_force_statistics()
    assert (b.mean, b.std, b.max, b.min) == pytest.approx((a.mean, a.std, a.max, a.min), rel=0.01)
    assert second.largest_support_uplift() == pytest.approx(first.largest_support_uplift(), rel=0.01)


def test_halving_the_step_halves_the_error_twice(short_shape, pantograph):
    """Second order where nothing goes slack or off: a light, steady push."""
    smooth = cf.ElasticPantograph(force=20.0)
    runs = [
        cf.simulate(
            short_shape, [smooth], speed=30.0, method="linearised", time=cf.TimeSettings(step=h)
        ).data["wire_height"].values[0]
        for h in (4e-3, 2e-3, 1e-3)
    ]  # fmt: skip
    n = min(len(runs[0]), len(runs[1][::2]), len(runs[2][::4]))
    coarse, middle, fine = runs[0][:n], runs[1][::2][:n], runs[2][::4][:n]
    assert np.std(coarse - middle) > 2.5 * np.std(middle - fine)


def test_it_says_when_motions_are_not_small(short_shape, pantograph):
    run = cf.simulate(
        short_shape, [pantograph.replace(uplift_force=350.0)], speed=300 / 3.6, method="linearised"
    )
    (slack,) = [w for w in run.warnings if "slack" in w and not w.startswith("check failed")]
    said = (
        r"linearised run: dropper \d of span \d, at \d+ m, is slack at \d\.\d\d s and shortens by \d{3} mm;"
    )
    assert re.match(said + ".* up to 100 mm; .* run again with the method nonlinear", slack)


def test_bad_questions(short_shape, pantograph):
    with pytest.raises(cf.InputError, match="method = 'linear': must be one of 'nonlinear', 'l"):
        cf.simulate(short_shape, [pantograph], speed=70.0, method="linear")


def test_a_run_that_blows_up_is_no_result(short_shape, pantograph):
    """A contact as stiff as steel in steps of 20 ms: forces grow until they do not settle."""
    stiff = pantograph.replace(contact_stiffness=1e8)
    with pytest.raises(cf.SolverError, match="did not settle in a step; look for stiffnesses"):
        cf.simulate(short_shape, [stiff], speed=30.0, method="linearised", time=cf.TimeSettings(step=0.02))
