"""Criteria: each limit from both sides, and what has no verdict."""

import json
from dataclasses import replace

import numpy as np
import pytest
from made_runs import made_line, made_run

import catenary_fe as cf
from catenary_fe.results import Elasticity, criteria_in_words, excess, labels, missed
from catenary_fe.results.criteria import criteria_rows

CURVE = Elasticity(np.array([130.0, 150.0, 170.0]), np.array([0.03, 0.05, 0.04]), 100.0, np.array([]))
CALM = 115.0  # [N] a force that keeps all limits of AC at 250 km/h


def altered(run, force=None, *, kmh=250.0, uplift=None, catenary=None, pantographs=None):
    """The run with another contact force [N], speed, support uplift [m], catenary or pantographs."""
    data = run.data.copy()
    if force is not None:
        data["contact_force"] = data["contact_force"].copy(data=np.broadcast_to(force, (1, run.time.size)))
    if uplift is not None:
        rows = np.broadcast_to(np.asarray(uplift)[:, None], data["support_uplift"].shape)
        data["support_uplift"] = data["support_uplift"].copy(data=rows)
    data.attrs["speed"] = kmh / 3.6
    if catenary is not None:
        data.attrs["catenary"] = catenary.model_dump_json()
    if pantographs is not None:
        data.attrs["pantographs"] = json.dumps([p.model_dump(mode="json") for p in pantographs])
    return cf.Run(data)


def verdicts(run, name, system="AC", **others):
    return [row.passed for row in criteria_rows(run, system, **others) if row.name == name]


def swinging(run, mean, deviation):
    """[N] a force with that mean and standard deviation over the evaluated spans, as filtered."""
    wave = np.sin(2 * np.pi * 3.0 * run.time)
    figures = altered(run, 500 + wave).contact_force_statistics()[0]
    return mean + deviation * (wave - (figures.mean - 500)) / figures.std


def test_a_calm_force_keeps_all_limits(short_run):
    rows = criteria_rows(altered(short_run, CALM), "AC")
    assert missed(rows) == []
    assert [row.name for row in rows if row.passed is None] == ["twice the uplift at steady arms"]
    assert len(rows) == 9


@pytest.mark.parametrize(
    ("system", "kmh", "smallest", "largest"),
    [
        ("AC", 200, 0.00047 * 200**2 + 60, 0.00047 * 200**2 + 90),
        ("AC", 200.01, 0.00047 * 200.01**2 + 60, 0.00097 * 200.01**2 + 70),
        ("AC", 300, 102.3, 157.3),
        ("DC 3 kV", 160, 0.00096 * 160**2 + 60, 0.00097 * 160**2 + 110),
        ("DC 1.5 kV", 220, 0.00112 * 220**2 + 70, 0.00228 * 220**2 + 90),
    ],
)
def test_mean_force_lies_between_its_limits(short_run, system, kmh, smallest, largest):
    for force, expected in (
        (smallest - 0.01, [False, True]),
        (smallest + 0.01, [True, True]),
        (largest - 0.01, [True, True]),
        (largest + 0.01, [True, False]),
    ):
        assert verdicts(altered(short_run, force, kmh=kmh), "mean force", system) == expected


def test_a_speed_without_a_known_formula_is_not_judged(short_run):
    run = altered(short_run, CALM, kmh=200)
    assert verdicts(run, "mean force", "DC 1.5 kV") == [None, None]
    row = criteria_rows(run, "DC 1.5 kV")[0]
    assert (row.limit, row.limit_text, row.verdict) == (None, "–", "not judged")
    assert "up to 200 km/h: not known here" in row.source


def test_a_run_set_for_the_largest_mean_force_keeps_it(short_run, pantograph):
    limit = cf.target_mean_force("EN 50367 AC", 250 / 3.6)
    is_set = [pantograph.replace(uplift_force=None, mean_force="EN 50367 AC")]
    for more, expected in ((0.09, True), (0.11, False)):
        assert verdicts(altered(short_run, limit + more, pantographs=is_set), "mean force")[1] is expected
    assert verdicts(altered(short_run, limit + 0.09), "mean force")[1] is False  # uplift given: no tolerance
    row = criteria_rows(altered(short_run, limit + 0.04, pantographs=is_set), "AC")[1]
    assert (row.value_text, row.limit_text, row.verdict) == ("130.7 N", "at most 130.6 N (± 0.1)", "passed")


@pytest.mark.parametrize(("share", "expected"), [(0.2999, True), (0.3001, False)])
def test_standard_deviation(short_run, share, expected):
    force = swinging(short_run, CALM, share * CALM)
    assert verdicts(altered(short_run, force), "standard deviation") == [expected]


@pytest.mark.parametrize(("share", "expected"), [(0.3332, True), (0.3335, False)])
def test_statistical_minimum(short_run, share, expected):
    force = swinging(short_run, CALM, share * CALM)
    assert verdicts(altered(short_run, force), "statistical minimum") == [expected]


@pytest.mark.parametrize(("kmh", "largest"), [(200, 300), (200.01, 350), (320, 350)])
def test_largest_force_of_ac(short_run, kmh, largest):
    for force, expected in ((largest - 0.01, True), (largest + 0.01, False)):
        run = altered(short_run, force, kmh=kmh)
        assert verdicts(run, "actual maximum") == [expected]
        assert verdicts(run, "statistical maximum") == [expected]
        assert verdicts(run, "actual maximum", "DC 3 kV") == [None]
        assert verdicts(run, "statistical maximum", "DC 1.5 kV") == [None]


def test_actual_and_statistical_maximum_are_two_figures(short_run):
    """Mean 150 N, σ 72 N: the sine's peak stays below 350 N, three deviations do not."""
    run = altered(short_run, swinging(short_run, 150.0, 72.0))
    assert verdicts(run, "actual maximum") == [True]
    assert verdicts(run, "statistical maximum") == [False]


LONG_LINE = made_line((60.0,) * 8, evaluated_spans=(2, 3, 4, 5, 6))


@pytest.mark.parametrize(("kmh", "percent"), [(249.99, 0.1), (250, 0.2), (320, 0.2)])
def test_loss_of_contact_is_the_time_in_losses_longer_than_5_ms(kmh, percent):
    """300 m at 1 ms a sample: a loss that lasts may take 0.1 or 0.2 % of the time; shorter ones are none."""
    clean = made_run(LONG_LINE, speed=kmh / 3.6, step=1e-3, times=5500, contact_force=CALM)
    window = np.flatnonzero(clean.window(0))
    most = int(percent / 100 * window.size)

    def found(*losses):
        force = np.full(clean.time.size, CALM)
        for first, samples in losses:
            force[window[0] + first : window[0] + first + samples] = 0.0
        run = made_run(LONG_LINE, speed=kmh / 3.6, step=1e-3, times=5500, contact_force=force)
        return next(r for r in criteria_rows(run, "AC") if r.name == "contact loss over 5 ms")

    assert 3 < most < 9
    assert found(*((40 * n, 5) for n in range(40))).value == 0.0  # 4 % of the time in losses that make no arc
    assert found((100, max(6, most))).passed is (most >= 6)
    assert found((100, max(6, most + 1))).passed is False
    assert found((-20, 20), (window.size + 1, 9)).value == 0.0  # outside of the spans
    row = found((100, 8))
    assert row.value == pytest.approx(100 * 8 / window.size)
    assert row.limit_text == f"at most {percent:.2f} %"
    assert row.recalled and "losses longer than 5 ms" in row.source and "(recalled)" in row.source


def test_six_samples_of_1_ms_are_no_loss():
    """0.05 % of the time, each sample by itself: unfiltered force, no arc."""
    force = np.full(12001, CALM)
    force[[3000, 3100, 3200, 3300, 3305, 3307]] = 0.0
    run = made_run(made_line((60.0,) * 12, evaluated_spans=(2, 3, 4, 5)), speed=20.0, step=1e-3, times=18001,
                   contact_force=np.append(force, np.full(6000, CALM)))  # fmt: skip
    assert run.contact_force_statistics()[0].contact_loss == pytest.approx(0.0005, rel=0.01)
    row = next(r for r in criteria_rows(run, "AC") if r.name.startswith("contact loss"))
    assert (row.value, row.verdict) == (0.0, "passed")


def test_the_filter_is_the_one_asked_for(short_run):
    for kind in ("causal", "zero-phase"):
        rows = criteria_rows(short_run, "AC", filter=kind)
        deviation = next(r.value for r in rows if r.name == "standard deviation")
        assert deviation == short_run.contact_force_statistics(filter=kind)[0].std


def with_rooms(catenary, rooms):
    supports = tuple(
        s.replace(steady_arm=s.steady_arm.replace(uplift_room=room))
        for s, room in zip(catenary.supports, rooms, strict=True)
    )
    return catenary.replace(supports=supports)


def test_room_for_twice_the_uplift(short_run, short):
    """Span 3 is evaluated: supports 3 and 4 count, 60 mm and 50 mm of uplift."""
    lift = [0.0, 0.9, 0.060, 0.050, 0.0]
    name = "twice the uplift at steady arms"
    for room, expected in ((0.1201, True), (0.1199, False)):
        run = altered(short_run, CALM, uplift=lift, catenary=with_rooms(short, [room] * 5))
        assert verdicts(run, name) == [expected]
    tight_at_4 = altered(short_run, CALM, uplift=lift, catenary=with_rooms(short, [0.2, 0.2, 0.2, 0.09, 0.2]))
    row = next(r for r in criteria_rows(tight_at_4, "AC") if r.name == name)
    assert (row.passed, row.limit_text) == (False, "at most 90.0 mm")
    assert row.value == pytest.approx(100)
    assert "support 4" in row.source


def test_supports_without_a_known_room_are_not_judged(short_run, short):
    lift = [0.0, 0.9, 0.060, 0.050, 0.0]
    run = altered(short_run, CALM, uplift=lift, catenary=with_rooms(short, [None, None, None, 0.11, None]))
    known, unknown = (r for r in criteria_rows(run, "AC") if r.name == "twice the uplift at steady arms")
    assert (known.passed, unknown.passed) == (True, None)
    assert (known.recalled, unknown.recalled) == (True, False)
    assert unknown.value == pytest.approx(120)
    assert "no uplift_room given, support 3" in unknown.source
    bare = short.replace(supports=tuple(s.replace(steady_arm=None) for s in short.supports))
    assert verdicts(altered(short_run, CALM, catenary=bare), known.name) == [None]


def test_speed_against_the_wave_speed(short_run, short):
    fastest = 0.7 * 3.6 * np.sqrt(20e3 / 1.35)
    for kmh, expected in ((fastest - 0.01, True), (fastest + 0.01, False)):
        assert verdicts(altered(short_run, CALM, kmh=kmh), "speed") == [expected]


def test_elasticity_is_reported_where_the_run_holds_it(short_run):
    name = "non-uniformity of the elasticity"
    assert verdicts(short_run, name) == []
    row = criteria_rows(short_run.with_elasticity(CURVE), "AC")[-1]
    assert (row.name, row.passed, row.value_text) == (name, None, "25.00 %")


def test_each_pantograph_has_its_rows(short_run, pantograph):
    data = altered(short_run, CALM).data.isel(pantograph=[0, 0])
    forces = np.stack([np.full(short_run.time.size, f) for f in (CALM, 60.0)])
    data["contact_force"] = data["contact_force"].copy(data=forces)
    data = data.assign_coords(pantograph=["first", "second"])
    data.attrs["pantographs"] = json.dumps([pantograph.model_dump(mode="json")] * 2)
    rows = criteria_rows(cf.Run(data), "AC")
    assert [(r.name, r.pantograph) for r in missed(rows)] == [("mean force", "second")]
    assert len([r for r in rows if r.pantograph == "first"]) == 7
    assert len([r for r in rows if r.pantograph is None]) == 2
    assert labels(rows)[0] == "mean force, first"
    assert labels(criteria_rows(short_run, "AC"))[0] == "mean force"


def test_recalled_limits_are_marked(short_run):
    def recalled(kmh):
        return [r.recalled for r in criteria_rows(altered(short_run, CALM, kmh=kmh), "AC")][:7]

    # minimum, maximum, σ, statistical minimum, two maxima, contact loss
    assert recalled(250) == [True, False, False, False, True, True, True]
    assert recalled(200) == [True, True, False, False, True, True, True]
    for row in criteria_rows(short_run, "DC 3 kV"):
        assert row.recalled == ("recalled" in row.source)


@pytest.mark.parametrize(
    ("relation", "on_the_limit"), [("at most", True), ("at least", True), ("above", False)]
)
def test_on_the_limit(relation, on_the_limit):
    row = cf.Criterion(name="x", value=1.0, relation=relation, limit=1.0, unit="N", source="")
    assert row.passed is on_the_limit
    beside = -0.02 if relation == "at most" else 0.02
    assert replace(row, limit=1.0 + beside, tolerance=0.021).passed is True
    assert replace(row, limit=1.0 + beside, tolerance=0.019).passed is False
    assert replace(row, limit=None).passed is None


def test_rows_are_ready_for_json(short_run):
    records = [row.as_dict() for row in criteria_rows(short_run.with_elasticity(CURVE), "AC")]
    again = json.loads(json.dumps(records, allow_nan=False))
    assert again == records
    assert set(again[0]) == {
        "name", "pantograph", "value", "relation", "limit", "unit", "source", "recalled", "tolerance",
        "start", "passed",
    }  # fmt: skip


def test_value_and_limit_never_look_the_same_unless_they_are():
    row = cf.Criterion(name="x", value=350.003, limit=350.0, unit="N", source="")
    assert (row.value_text, row.limit_text, row.verdict) == ("350.003 N", "at most 350.000 N", "missed")


def test_criteria_in_words():
    def row(value, limit, name="σ", pantograph=None):
        return cf.Criterion(name=name, value=value, limit=limit, unit="N", source="", pantograph=pantograph)

    good, bad, unknown = row(1.0, 2.0), row(3.0, 2.0), row(9.0, None)
    assert criteria_in_words([good, unknown, good]) == "all 2 criteria with a known limit met"
    assert (
        criteria_in_words([good, bad, unknown, row(3.0, 2.0, "uplift")])
        == "2 of 3 criteria missed: σ, uplift"
    )
    several = [row(1.0, 2.0, pantograph="lead"), row(3.0, 2.0, pantograph="trail"), bad]
    assert criteria_in_words(several) == "2 of 3 criteria missed: σ, trail, σ"


def test_how_far_a_limit_is_missed():
    def row(value, relation, limit, pantograph="a", start=None):
        figure = {"name": "x", "unit": "N", "source": "", "pantograph": pantograph, "start": start}
        return cf.Criterion(value=value, relation=relation, limit=limit, **figure)

    assert row(3.0, "at most", 2.0).used == 1.5
    assert row(4.0, "at least", 5.0).used == 1.25
    assert row(-4.0, "above", 0.0).used == float("inf")
    assert row(-4.0, "above", 0.0, start=80.0).used == pytest.approx(84 / 80)
    assert row(1.0, "at most", None).used is None
    rows = [
        row(3.0, "at most", 2.0), row(4.0, "at least", 5.0), row(9.0, "at most", 10.0, "b"),
        row(-1.0, "above", 0.0, "c"), row(9.0, "at most", 1.0, None),
    ]  # fmt: skip
    assert excess(rows) == {"a": 1.5, "c": np.inf}
