"""Line tests: a run is found in what was made of it, with noise, another rate and another origin."""

from dataclasses import replace

import numpy as np
import pytest
from made_runs import made_line, made_pantograph, made_run

import catenary_fe as cf
from catenary_fe.results import low_pass, spectrum
from catenary_fe.results.line_test.verdict import DEVIATION_LIMIT, MEAN_LIMIT, UPLIFT_LIMIT

SHIFT = -12_345.67  # [m] from the measurement's chainage to the run's


@pytest.fixture(scope="module")
def run(reference, pantograph):
    """Ten spans, four of them evaluated, linearised."""
    shape = cf.find_form(reference.replace(evaluated_spans=(4, 5, 6, 7)))
    return cf.simulate(shape, [pantograph], speed=250 / 3.6, method="linearised")


def random_run(**others):
    """Six spans whose force is no more periodic than a road: a place along it is found once."""
    noise = np.random.default_rng(7).normal(size=2801)
    force = 100 + 20 * low_pass(noise, 2e-3, 12.0) / low_pass(noise, 2e-3, 12.0).std()
    values = {"times": 2801, "contact_force": force, "evaluated_spans": "[3, 4, 5]", "start": (5.03,)}
    return made_run(made_line(evaluated_spans=(3, 4, 5)), **(values | others))


def at(run, x):
    """The force as a measuring chain has it: without what a coarse sampling would fold down."""
    force = low_pass(run.data["contact_force"].values[0], run.step, 60.0, "zero-phase")
    return np.interp(x, run.data["position"].values[0], force)


def measured(run, *, apart=0.3, factor=1.0, offset=0.0, noise=3.0, seed=1, begin=None, end=None):
    """The run's force every so many metres, its scatter about the mean multiplied, shifted, with noise."""
    x = run.data["position"].values[0]
    places = np.arange(x[0] if begin is None else begin, x[-1] if end is None else end, apart)
    force = at(run, places)
    force = force.mean() + factor * (force - force.mean()) + offset
    return places, force + np.random.default_rng(seed).normal(0, noise, places.size)


def over_position(run, **others):
    x, force = measured(run, **others)
    return cf.LineTest([cf.MeasuredPass(position=x - SHIFT, force=force)])


def over_time(run, **others):
    x, force = measured(run, **others)
    return cf.LineTest([cf.MeasuredPass(time=1000 + x / run.speed, force=force)])


def verdicts(compared):
    return {row.name.removeprefix("deviation of the "): row.passed for row in compared.criteria}


@pytest.mark.parametrize("filter", ["causal", "zero-phase"])
@pytest.mark.parametrize("apart", [0.1, 0.3, 0.5])
def test_a_run_passes_against_what_was_measured_of_it(run, apart, filter):
    compared = cf.compare_with_line_test(run, over_position(run, apart=apart), filter=filter)
    (one,) = compared.passes
    assert one.place.shift == pytest.approx(SHIFT, abs=apart)
    assert one.place.correlation > 0.98
    assert verdicts(compared) == {"mean force": True, "standard deviation": True}
    assert all(row.recalled and "recalled" in row.source for row in compared.criteria)
    own = run.contact_force_statistics(filter=filter)[0]
    assert compared.statistics == replace(own, contact_point_range=compared.statistics.contact_point_range)
    assert one.statistics.mean == pytest.approx(own.mean, abs=0.5)
    assert one.statistics.std == pytest.approx(own.std, rel=0.02)
    assert one.rate == pytest.approx(run.speed / apart, rel=1e-3)


def test_over_time_its_place_is_found_too(run):
    compared = cf.compare_with_line_test(run, over_time(run, apart=0.25))
    (one,) = compared.passes
    begin = run.data["position"].values[0, 0]
    assert one.place.shift == pytest.approx(begin, abs=0.25)  # places count from the first row
    assert one.x[0] == pytest.approx(begin, abs=0.25)
    assert all(verdicts(compared).values())
    assert "taken is the run's, 250 km/h" in " ".join(compared.notes)


@pytest.mark.parametrize(
    ("changes", "figure"),
    [({"factor": 1.3}, "standard deviation"), ({"factor": 0.7}, "standard deviation"),
     ({"offset": 5.0}, "mean force"), ({"offset": -5.0}, "mean force")],
)  # fmt: skip
def test_what_is_off_is_missed(run, changes, figure):
    compared = cf.compare_with_line_test(run, over_position(run, **changes))
    assert [name for name, passed in verdicts(compared).items() if not passed] == [figure]
    assert compared.passes[0].place.shift == pytest.approx(SHIFT, abs=0.3)


def test_limits_are_those_of_the_standard():
    assert (MEAN_LIMIT, DEVIATION_LIMIT, UPLIFT_LIMIT) == (2.5, 0.20, 0.20)


@pytest.mark.parametrize(("off", "passed"), [(2.4, True), (2.6, False)])
def test_the_mean_is_judged_at_its_limit(off, passed):
    own = random_run()
    compared = cf.compare_with_line_test(
        own, over_position(own, offset=off, noise=0.0, apart=0.1), shift=SHIFT
    )
    assert verdicts(compared)["mean force"] is passed
    deviation = compared.criteria[0].value
    assert deviation == pytest.approx(off, abs=0.02)


@pytest.mark.parametrize(
    ("factor", "passed"), [(1 / 1.19, True), (1 / 1.21, False), (1.24, True), (1.27, False)]
)
def test_sigma_is_judged_by_its_share_of_what_was_measured(factor, passed):
    own = random_run()
    test = over_position(own, factor=factor, noise=0.0, apart=0.1)
    compared = cf.compare_with_line_test(own, test, shift=SHIFT)
    assert verdicts(compared)["standard deviation"] is passed
    assert compared.criteria[1].value == pytest.approx(100 * abs(1 / factor - 1), abs=0.3)


def test_a_given_shift_is_taken_as_it_is(run):
    found = cf.compare_with_line_test(run, over_position(run), shift=SHIFT + 1.5)
    assert found.passes[0].place.shift == SHIFT + 1.5
    assert found.passes[0].place.correlation < 0.9
    assert not any("not the only one" in text for text in found.warnings)


def test_spans_that_are_alike_are_told(run):
    compared = cf.compare_with_line_test(run, over_position(run))
    (text,) = [w for w in compared.warnings if "not the only one" in w]
    other = compared.passes[0].place.other
    assert abs(other[0] - SHIFT) == pytest.approx(60, abs=1)  # one span further
    assert "give the shift if you know it" in text
    compared = cf.compare_with_line_test(random_run(), over_position(random_run()))
    assert compared.passes[0].place.other is None
    assert compared.passes[0].place.shift == pytest.approx(SHIFT, abs=0.3)


def test_no_place_in_noise():
    own = random_run()
    x, force = measured(own)
    noise = np.random.default_rng(5).normal(100, 20, x.size)
    for values in (noise, 0 * force + 100):
        test = cf.LineTest([cf.MeasuredPass(position=x, force=values)])
        with pytest.raises(cf.InputError, match=r"no clear place .* must be at least 0.5; give the shift"):
            cf.compare_with_line_test(own, test)
        assert cf.compare_with_line_test(own, test, shift=0.0).passes


def test_only_what_both_have_is_compared():
    own = random_run()  # evaluated from 100 to 250 m
    test = over_position(own, begin=130.0, end=280.0, apart=0.25)
    compared = cf.compare_with_line_test(own, test)
    assert compared.begin == pytest.approx(130, abs=0.25)
    assert compared.end == 250
    assert list(compared.by_span) == [4, 5]
    assert "compared: 120.0 m of the 150 m that the run evaluates" in " ".join(compared.notes)
    inside = (own.data["position"].values[0] >= compared.begin) & (own.data["position"].values[0] <= 250)
    assert compared.statistics.mean == pytest.approx(own.filtered_contact_force()[0, inside].mean())
    assert compared.statistics.mean != pytest.approx(own.contact_force_statistics()[0].mean, abs=0.01)
    assert any("22 spans or more than 1000 m (recalled)" in w for w in compared.warnings)


@pytest.mark.parametrize("shift", [SHIFT + 5000, SHIFT - 200])
def test_no_overlap(shift):
    own = random_run()
    with pytest.raises(
        cf.InputError, match="less than a span to compare: the run is evaluated from 100 to 250"
    ):
        cf.compare_with_line_test(own, over_position(own), shift=shift)


def test_span_by_span():
    own = random_run()
    compared = cf.compare_with_line_test(own, over_position(own, noise=0.0, apart=0.1))
    assert list(compared.by_span) == list(compared.measured_by_span) == [3, 4, 5]
    for n, s in compared.by_span.items():
        assert s.mean == own.contact_force_statistics([n])[0].mean
        assert compared.measured_by_span[n].mean == pytest.approx(s.mean, abs=0.1)
        assert compared.measured_by_span[n].std == pytest.approx(s.std, abs=0.2)


def test_several_passes_make_one_verdict():
    own = random_run()
    each = [over_position(own, offset=d, seed=i, noise=0.0).passes[0] for i, d in enumerate((-4.0, 3.0))]
    test = cf.LineTest([replace(p, name=f"pass {i}") for i, p in enumerate(each)])
    compared = cf.compare_with_line_test(own, test)
    one, two = (p.statistics for p in compared.passes)
    assert compared.measured.mean == pytest.approx((one.mean + two.mean) / 2)
    assert compared.measured.std == pytest.approx(np.sqrt((one.std**2 + two.std**2) / 2))
    assert compared.measured.max == max(one.max, two.max) and compared.measured.min == min(one.min, two.min)
    assert compared.measured.statistical_max == pytest.approx(
        compared.measured.mean + 3 * compared.measured.std
    )
    assert verdicts(compared)["mean force"] is True  # 0.5 N in the mean of both


def test_falling_chainage_is_the_same_line():
    own = random_run()
    x, force = measured(own)
    test = cf.LineTest([cf.MeasuredPass(position=2000 - x, force=force)])
    compared = cf.compare_with_line_test(own, test)
    assert compared.passes[0].place.shift == pytest.approx(2000, abs=0.3)
    assert compared.passes[0].x[0] == pytest.approx(x[0], abs=0.3)
    assert "positions fall along the way" in " ".join(compared.notes)


def test_speed_that_varies_is_followed():
    """Rows at even distances, speed in a column: frequencies are those of the time, not of the way."""
    own = random_run()
    x = np.arange(5.0, 280.0, 0.1)
    speed = 50 + 10 * np.sin(2 * np.pi * x / 100)
    time = np.concatenate([[0], np.cumsum(np.diff(x) * (1 / speed[1:] + 1 / speed[:-1]) / 2)])
    force = 100 + 10 * np.sin(2 * np.pi * 7.0 * time)
    test = cf.LineTest([cf.MeasuredPass(position=x, speed=speed, force=force)])
    (one,) = cf.compare_with_line_test(own, test, shift=0.0).passes
    frequency, amplitude = one.spectrum
    assert frequency[amplitude.argmax()] == pytest.approx(7.0, abs=0.4)
    assert amplitude.max() == pytest.approx(10, rel=0.2)
    assert "rows at uneven times" in " ".join(cf.compare_with_line_test(own, test, shift=0.0).notes)
    inside = (x >= 100) & (x <= 250)
    wrong = spectrum(force[inside], 0.1 / 50)  # had the speed been taken as constant
    assert wrong[1].max() < 0.8 * amplitude.max()


def test_the_speed_is_said_once_and_told_where_it_is_another():
    own = random_run()
    x, force = measured(own)
    slow = cf.LineTest([cf.MeasuredPass(position=x, time=x / 45.0, force=force)])
    compared = cf.compare_with_line_test(own, slow, shift=0.0)
    assert compared.passes[0].speed == pytest.approx(45)
    assert any("measured at 162.0 km/h, the run is at 180.0 km/h" in w for w in compared.warnings)
    with pytest.raises(cf.InputError, match="says its speed itself; leave it out"):
        cf.compare_with_line_test(own, slow, shift=0.0, speed=50.0)
    bare = cf.LineTest([cf.MeasuredPass(position=x, force=force)])
    assert cf.compare_with_line_test(own, bare, shift=0.0, speed=45.0).passes[0].speed == pytest.approx(45)
    assert not any("km/h" in w for w in cf.compare_with_line_test(own, bare, shift=0.0).warnings)


@pytest.mark.parametrize(("apart", "passes"), [(0.99, True), (1.01, False)])
def test_too_coarse_for_the_filter(apart, passes):
    """At 50 m/s, 1 m is 50 samples a second."""
    own = random_run()
    test = over_position(own, apart=apart)
    if passes:
        compared = cf.compare_with_line_test(own, test, shift=SHIFT)
        said = "EN 50317 asks for 200, or one every 0.40 m (recalled)"
        assert said in " ".join(compared.notes)
        finer = cf.compare_with_line_test(own, over_position(own, apart=0.39), shift=SHIFT)
        assert finer.passes[0].rate < 200 and said not in " ".join(finer.notes)
        return
    with pytest.raises(
        cf.InputError, match=r"49.5 samples a second \(1.01 m apart\).*needs at least 50"
    ) as error:
        cf.compare_with_line_test(own, test, shift=SHIFT)
    assert len(error.value.problems) == 1


@pytest.mark.parametrize(("begin", "refused"), [(150.0, True), (40.0, False)])
def test_rows_too_far_apart(begin, refused):
    own = random_run()
    x, force = measured(own, apart=0.2)
    kept = (x < begin) | (x > begin + 5)
    test = cf.LineTest([cf.MeasuredPass(position=x[kept], force=force[kept])])
    if refused:
        with pytest.raises(cf.InputError, match=r"0.104 s without a row at 1(49|50)\.\d m of the line"):
            cf.compare_with_line_test(own, test)
    else:
        assert cf.compare_with_line_test(own, test).passes[0].place.shift == pytest.approx(0, abs=0.2)


def test_a_force_that_was_filtered_is_not_filtered_again():
    own = random_run()
    x = own.data["position"].values[0]
    test = cf.LineTest([cf.MeasuredPass(position=x, force=own.filtered_contact_force()[0])])
    compared = cf.compare_with_line_test(own, test, shift=0.0, is_filtered=True)
    one, s = compared.passes[0].statistics, compared.statistics
    for name in ("mean", "std", "max", "min", "statistical_max", "statistical_min"):
        assert getattr(one, name) == pytest.approx(getattr(s, name), rel=1e-9)
    assert one.std_5_20 == pytest.approx(s.std_5_20, rel=0.02)
    again = cf.compare_with_line_test(own, test, shift=0.0).passes[0].statistics
    assert again.std < 0.999 * one.std


def uplifted(**largest):
    values = np.zeros((7, 2801))
    for name, lift in largest.items():
        values[int(name.removeprefix("s")) - 1, 1000] = lift
    return random_run(support_uplift=values)


@pytest.mark.parametrize(("lift", "passed"), [(0.051, True), (0.049, False), (0.074, True), (0.077, False)])
def test_largest_uplift(lift, passed):
    own = uplifted(s4=0.0608, s5=0.04, s1=0.2)
    test = cf.LineTest([cf.MeasuredPass(uplift={4: [0.0, lift, 0.01], 5: [0.04], 1: [0.1]})])
    compared = cf.compare_with_line_test(own, test)
    assert compared.uplift == {4: (0.0608, lift), 5: (0.04, 0.04)}
    assert verdicts(compared) == {"largest uplift at a support": passed}
    assert "uplift of support 1: left out, not of the run's evaluated spans" in compared.notes
    assert compared.passes == [] and compared.statistics is None
    with pytest.raises(cf.InputError, match="no uplift was measured at a support of the run's evaluated"):
        cf.compare_with_line_test(own, cf.LineTest([cf.MeasuredPass(uplift={1: [0.1]})]))


def test_height_of_the_wire_at_the_head():
    noise = low_pass(np.random.default_rng(3).normal(size=2801), 2e-3, 5.0)
    own = random_run(wire_height=5.3 + 0.02 * noise / np.ptp(noise))
    x = own.data["position"].values[0][::2]
    test = cf.LineTest([cf.MeasuredPass(position=x + 70, height=own.data["wire_height"].values[0][::2] - 5)])
    compared = cf.compare_with_line_test(own, test)
    assert compared.passes[0].place.shift == pytest.approx(-70, abs=0.2)
    assert compared.passes[0].height_range == pytest.approx(compared.height_range, rel=0.01)
    (row,) = compared.criteria
    assert (row.passed, row.limit, row.unit) == (None, None, "mm")


def test_one_of_several_pantographs():
    two = made_pantograph(name="first"), made_pantograph(name="second")
    force = np.stack([np.full(2801, 90.0), np.full(2801, 120.0)])
    own = made_run(
        made_line(evaluated_spans=(3, 4, 5)), *two, start=(20.0, 5.0), times=2801, contact_force=force
    )
    x = np.arange(90, 260, 0.2)
    test = cf.LineTest([cf.MeasuredPass(position=x, force=np.full(x.size, 120.0))])
    for number, off in ((0, 30.0), (1, 0.0)):
        compared = cf.compare_with_line_test(own, test, shift=0.0, pantograph=number)
        assert compared.criteria[0].value == pytest.approx(off, abs=1e-6)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"force": [1.0, 2.0]}, "force has neither position nor time"),
        ({"position": [0.0, 1.0, 2.0], "force": [1.0, 2.0]}, "as many as of the others"),
        (
            {"position": [0.0, 2.0, 1.0, 3.0], "force": [1.0] * 4},
            "position 3 = 1 m after 2 m: must go one way",
        ),
        ({"position": [3.0, 3.0, 3.0], "time": [0.0, 1.0, 2.0], "force": [1.0] * 3}, "is 3 m all along"),
        ({"time": [0.0, 0.0, 1.0], "force": [1.0] * 3}, "time 2 = 0 s after 0 s"),
        ({"position": [0.0, 1.0], "speed": [1.0, 0.0], "force": [1.0] * 2}, "speed = 0 m/s: must be above 0"),
        ({"position": [0.0, 1.0], "force": [1.0, np.nan]}, "force: nan is among them"),
        ({"uplift": {0: [1.0]}}, "support = 0: must be a whole number"),
        ({"uplift": {3: []}}, "uplift of support 3 is empty"),
        ({"uplift": 3}, "must be values by support"),
    ],
)
def test_passes_that_are_none(values, said):
    with pytest.raises(cf.InputError, match=said) as error:
        cf.MeasuredPass(**values)
    assert len(error.value.problems) == 1


def test_tests_that_are_none():
    one = cf.MeasuredPass(uplift={3: [0.1]})
    for passes, said in (
        ([], "is empty"), ([one, one], "a name of its own"), ([3], "must be a list of MeasuredPass"),
        ([cf.MeasuredPass()], "there is no force, height or uplift"),
        ([cf.MeasuredPass(name="a", time=[0.0, 1.0], force=[1.0, 1.0]),
          cf.MeasuredPass(name="b", time=[0.0, 1.0], height=[1.0, 1.0])], "b: force is missing"),
    ):  # fmt: skip
        with pytest.raises(cf.InputError, match=said):
            cf.LineTest(passes)
