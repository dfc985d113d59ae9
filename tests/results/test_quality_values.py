"""What the quality checks find on runs with given histories: values, bounds, and when they are silent."""

import json

import numpy as np
import pytest
from made_runs import HEIGHT, made_line, made_pantograph, made_run

import catenary_fe as cf
from catenary_fe.results.check import Check, checks_in_words

TWO = (made_pantograph(name="first"), made_pantograph(name="second"))
ELASTIC = cf.ElasticPantograph(force=100.0)
MESH = {"contact_wire_element": 1.3, "at_clamps": 0.5}


def check(run, name):
    return {check.name: check for check in run.checks}.get(name)


def depth(value, rule="at most", bound=10.0, unit="mm"):
    return Check("depth", value, unit, rule, bound, "why")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (12.34567, "12.35 mm"), (-12.34567, "-12.35 mm"), (1e-3, "0.001 mm"), (1.26e-3, "0.00126 mm"),
        (5.26e-4, "0.0005 mm"), (-5.26e-4, "-0.0005 mm"), (0.0, "0 mm"),
    ],
)  # fmt: skip
def test_texts_of_values(value, text):
    assert depth(value).value_text == text


def test_a_check_in_words():
    check = depth(3.0, "at least", 2.0, "")
    assert str(check) == "depth = 3, must be at least 2: why"
    assert str(depth(3.0)) == "depth = 3 mm, must be at most 10 mm: why"


def test_checks_in_words():
    assert checks_in_words([depth(3.0), depth(4.0)]) == "all 2 checks passed"
    assert checks_in_words([depth(3.0), depth(40.0), depth(11.0)]) == "2 of 3 checks failed: depth, depth"


@pytest.mark.parametrize(
    ("value", "rule", "passed"),
    [
        (9.0, "at most", True), (10.0, "at most", True), (10.001, "at most", False),
        (np.nan, "at most", False), (11.0, "at least", True), (10.0, "at least", True),
        (9.999, "at least", False), (np.nan, "at least", False),
    ],
)  # fmt: skip
def test_a_bound_itself_is_good_and_no_number_is_not(value, rule, passed):
    check = depth(value, rule)
    assert check.passed == passed
    assert check.verdict == ("passed" if passed else "failed")
    assert check.as_dict() == {
        "name": "depth", "value": None if np.isnan(value) else value, "unit": "mm", "rule": rule,
        "bound": 10.0, "passed": passed,
    }  # fmt: skip


def test_a_run_at_rest():
    """Bounds and units; nothing is said of energies and tensions that were not recorded."""
    found = {c.name: (c.value, c.bound_text) for c in made_run().checks}
    assert found == {
        "penetration": (0.0, "at most 10 mm"),
        "force balance": (pytest.approx(0, abs=1e-9), "at most 0.5 %"),
        "pantograph energy": (0.0, "at most 0.3 %"),
        "steps in an element": (pytest.approx(0.5 / (50 * 2e-3)), "at least 2"),
        "time steps in a period": (pytest.approx(1 / (20 * 2e-3)), "at least 20"),
        "element-passing frequency": (pytest.approx(50 / 1.3), "at least 20 Hz"),
        "end reflection": (0.0, "at most 10 %"),
        "start transient": (pytest.approx(0, abs=1e-9), "at most 20 %"),
        "slack droppers": (0.0, "at most 10 %"),
    }


def test_a_run_that_ended_before_its_spans_says_nothing_of_them():
    why = json.dumps({"reason": "interrupted", "reached_s": 1.0, "planned_s": 4.0})
    early = made_run(times=501, partial=why, extra=energies([0], [0], [0]) | tensions({"contact_wire": [0]}))
    assert [check.name for check in early.checks] == [
        "penetration", "force balance", "pantograph energy", "energy balance", "tension drift",
        "steps in an element", "time steps in a period",
    ]  # fmt: skip


def test_penetration_is_of_the_deepest_head():
    depths = np.zeros((2, 1, 2001))
    depths[0, 0, 700], depths[1, 0, 900] = 0.004, 0.0125
    for pantographs in (TWO, TWO[::-1], (ELASTIC, TWO[0])):
        run = made_run(None, *pantographs, start=(5.0, 5.0), mass_height=HEIGHT + depths)
        found = check(run, "penetration")
        assert found.value == pytest.approx(12.5)
        assert not found.passed
        deepest = run.data["pantograph"].values[-1 if pantographs[0] is ELASTIC else depths.argmax() // 2001]
        assert found.text.startswith(
            f"so deep the head of {deepest} goes into the wire at 95.0 m (span 2), under 100 N; raise"
        )


def energies(energy, driven, lost):
    values = {"energy": energy, "driven_work": driven, "lost_work": lost}
    return {name: ("energy_time", np.array(v, dtype=float)) for name, v in values.items()}


def test_energy_balance():
    """Driven 0.4 J, lost 0.3 J, stored 0.09 J: 0.01 J are missing of what contacts and uplift did."""
    recorded = energies([7.0, 7.02, 7.09], [0, -0.1, 0.4], [0, -0.12, 0.3])
    for run in (made_run(extra=recorded), made_run(None, ELASTIC, extra=recorded)):
        assert check(run, "energy balance").value == pytest.approx(100 * 0.01 / 0.4)
        assert check(run, "energy balance").bound_text == "at most 2 %"


def test_uplift_forces_are_among_the_work_of_the_energy_balance():
    """The lowest masses of two pantographs leave their places by 20 and 10 mm: 100 and 200 N work 4 J."""
    heights = np.full((2, 2, 2001), HEIGHT)
    heights[0, 1, 0], heights[1, 1, 7], heights[1, 0, 9] = HEIGHT - 0.02, HEIGHT + 0.01, HEIGHT + 1
    two = [(8.0, 4000.0, 100.0), (15.0, 50.0, 90.0)]
    run = made_run(
        None, made_pantograph(*two), made_pantograph(*two), start=(5.0, 5.0), mass_height=heights,
        uplift_force=[100.0, 200.0], extra=energies([0, 0.4], [0, 4.0], [0, 3.0]),
    )  # fmt: skip
    assert check(run, "energy balance").value == pytest.approx(100 * 0.6 / (4 + 2 + 2))


def test_no_work_at_all_is_balanced():
    assert check(made_run(extra=energies([1, 1], [0, 0], [0, 0])), "energy balance").value == 0


def tensions(by_wire):
    changes = np.array(list(by_wire.values()), dtype=float)
    spans = np.broadcast_to(2 + np.arange(len(changes))[:, None], changes.shape)
    return {
        "tension_change": (("wire", "tension_time"), changes),
        "tension_span": (("wire", "tension_time"), spans),
        "tension_time": ("tension_time", 0.05 * np.arange(changes.shape[1])),
        "wire": ("wire", list(by_wire)),
    }


def test_tension_drift_is_of_the_wires_that_weights_hold():
    wires = {"contact_wire": [0, 0.004], "messenger_wire": [0.012, 0], "stitch_wire_2": [0, 0.06]}
    drift = check(made_run(extra=tensions(wires)), "tension drift")
    assert drift.value == pytest.approx(1.2)
    assert drift.text.startswith(
        "change of the messenger wire's tension in span 3 since the start, at 0.00 s;"
    )
    worse = wires | {"contact_wire": [0, 0.031]}
    assert str(check(made_run(extra=tensions(worse)), "tension drift")).startswith(
        "tension drift = 3.1 %, must be at most 3 %: change of the contact wire's tension in span 2 since the"
        " start, at 0.05 s; "
    )


def test_steps_in_an_element_are_of_the_shortest_one():
    assert check(made_run(mesh=MESH, speed=40), "steps in an element").value == pytest.approx(0.5 / 0.08)
    finer = MESH | {"contact_wire_element": 0.4}
    assert check(made_run(mesh=finer, speed=40), "steps in an element").value == pytest.approx(0.4 / 0.08)


def test_a_run_without_a_mesh_says_nothing_of_elements():
    names = {check.name for check in made_run(mesh={}).checks}
    assert not {name for name in names if "element" in name}


def test_steps_in_a_period_are_of_the_highest_resonance():
    """50 kN/m on 2 kg: 25.16 Hz; on 1 kg: 35.59 Hz; without masses, 20 Hz of the filter."""
    heads = [made_pantograph((mass, 100.0, 0.0), (1e-3, 100.0, 0.0)) for mass in (2.0, 1.0)]
    for pantographs, frequency in ((heads[:1], 25.16), (heads, 35.59), ([ELASTIC], 20.0)):
        run = made_run(None, *pantographs, start=[5.0] * len(pantographs))
        assert check(run, "time steps in a period").value == pytest.approx(500 / frequency, rel=1e-3)


def test_elements_that_are_passed_in_the_band_of_the_filter():
    """Of droppers 10 m apart: four elements of 2.5 m between them are fine ones, and judged by their tone."""
    for element, speed, hertz in ((1.3, 26.0, 20.0), (2.6, 40.0, 15.3846), (1.3, 40.0, 30.769)):
        run = made_run(mesh=MESH | {"contact_wire_element": element}, speed=speed, times=4001)
        found = check(run, "element-passing frequency")
        assert found.value == pytest.approx(hertz, rel=1e-4)
        assert found.passed == (hertz > 19)
        assert check(run, "element-passing tone") is None
    for element, speed in ((2.5, 40.0), (1.3, 25.9)):
        run = made_run(mesh=MESH | {"contact_wire_element": element}, speed=speed, times=4001)
        assert check(run, "element-passing frequency") is None
        assert check(run, "element-passing tone").value == pytest.approx(0, abs=1e-9)


SLOW = 2e-3 * np.arange(9001)  # [s] until the evaluated spans are passed at 13 m/s


def sounding(newtons, of_frequency=1.0, mean=100.0):
    """Elements of 1.3 m are passed at 10 Hz; the force has a tone near that."""
    force = mean + newtons * np.sin(2 * np.pi * 10.0 * of_frequency * SLOW)
    return made_run(times=9001, speed=13.0, contact_force=force, mesh=MESH)


def test_the_tone_of_elements_is_its_mean_square_over_the_mean_force():
    tone = check(sounding(6.0, mean=120.0), "element-passing tone")
    assert tone.value == pytest.approx(100 * 6 / np.sqrt(2) / 120, rel=1e-3)
    assert tone.bound_text == "at most 3 %"
    assert "passed at 10.0 Hz" in tone.text
    both = made_run(
        None, *TWO, times=9001, speed=13.0, start=(5.0, 15.0), mesh=MESH,
        contact_force=[[100.0], [50.0]] + np.array([[6.0], [4.0]]) * np.sin(2 * np.pi * 10.0 * SLOW),
    )  # fmt: skip
    assert check(both, "element-passing tone").value == pytest.approx(100 * 4 / np.sqrt(2) / 50, rel=2e-3)


@pytest.mark.parametrize(("of_frequency", "heard"), [(0.88, 0), (0.92, 1), (1.13, 1), (1.17, 0)])
def test_the_tone_lies_near_the_frequency_of_passing(of_frequency, heard):
    tone = check(sounding(6.0, of_frequency), "element-passing tone")
    assert tone.value == pytest.approx(heard * 6 / np.sqrt(2), rel=0.02, abs=0.15)


ENDING = made_line((50.0,) * 5 + (60.0,))  # spans 3 and 4 are evaluated, until 200 m


def lifted(line=ENDING, *, last_but_one, at, inside=0.05, start=(5.0,), run=False, **others):
    """The last support but one moves at one time; those of the evaluated spans once, by ``inside``."""
    uplift = np.zeros((len(line.supports), 2001))
    uplift[3, 10], uplift[-2, round(at / 2e-3)], uplift[-1] = inside, last_but_one, 9.9
    pantographs = TWO[: len(start)]
    made = made_run(line, *pantographs, start=start, support_uplift=uplift, **others)
    return made if run else check(made, "end reflection")


@pytest.mark.parametrize(
    ("start", "latest"),
    [((5.0,), 3.9 - 170 / 120), ((25.0,), 3.5 - 170 / 120), ((25.0, 5.0), 3.9 - 170 / 120)],
)
def test_a_motion_near_the_end_counts_if_it_can_come_back(start, latest):
    """From the last support but one to the end and back to 200 m are 170 m, by the faster wire at 120 m/s."""
    for line in (
        ENDING,
        ENDING.replace(contact_wire=ENDING.messenger_wire, messenger_wire=ENDING.contact_wire),
    ):
        early = lifted(line, last_but_one=-0.02, at=latest - 0.006, start=start)
        assert early.value == pytest.approx(40)
        assert early.bound_text == "at most 10 %"
        assert "end at 200 m" in early.text
        assert lifted(line, last_but_one=-0.02, at=latest + 0.006, start=start).value == 0


def test_an_end_that_is_too_far_to_be_heard():
    line = made_line((50.0,) * 30, evaluated_spans=(1,))
    assert lifted(line, last_but_one=0.02, at=0.0).value == 0
    assert lifted(last_but_one=2e-8, at=0.5, inside=0.0).value == pytest.approx(2)  # of 1 µm at least


def swelling(*amplitudes, line=None, start=(5.0,), **others):
    """Forces of 4 Hz with another amplitude in each span, of each pantograph; a span takes a second."""
    time = 2e-3 * np.arange(3001)
    spans = np.minimum((np.asarray(start)[:, None] + 50 * time) // 50, 5).astype(int)
    newtons = np.array([own[inside] for own, inside in zip(np.array(amplitudes), spans, strict=True)])
    force = 100 + newtons * np.sin(2 * np.pi * 4 * time)
    line = (line or made_line()).replace(**others)
    return made_run(line, *TWO[: len(start)], times=3001, start=start, contact_force=force)


def apart(run, *spans):
    """[%] the difference of two spans' standard deviations, as a share of the mean one; the worst."""
    before, after = (np.array([s.std for s in run.contact_force_statistics([n])]) for n in spans)
    return pytest.approx(100 * np.max(np.abs(before - after) / ((before + after) / 2)))


def transient(run):
    found = check(run, "start transient")
    return found and found.value


def test_deviations_of_neighbouring_spans_tell_of_the_start():
    run = swelling([50, 40, 10, 12, 30, 50])
    assert transient(run) == apart(run, 3, 4)
    assert 12 < transient(run) < 20
    assert check(run, "start transient").passed
    run = swelling([50, 10, 13, 8, 30, 50], evaluated_spans=(2, 3, 4))
    assert transient(run) == apart(run, 3, 4)
    assert not check(run, "start transient").passed
    for two in ([[10, 10, 10, 10, 10, 10], [50, 40, 10, 8, 30, 50]], [[50, 40, 10, 8, 30, 50], [10] * 6]):
        run = swelling(*two, start=(5.0, 5.0))
        assert transient(run) == apart(run, 3, 4)
        assert transient(run) > 10


def test_forces_that_do_not_change_are_equal():
    assert transient(made_run(contact_force=0.0)) == 0


@pytest.mark.parametrize(
    ("evaluated", "start", "compared"),
    [
        ((3,), (5.0,), True), ((3,), (50.0,), True), ((3,), (50.2,), False), ((3,), (5.0, 60.0), False),
        ((2,), (0.0,), True), ((2,), (5.0,), False), ((1,), (0.0,), False),
    ],
)  # fmt: skip
def test_a_single_span_is_compared_with_the_one_before_it_if_all_of_that_is_passed(
    evaluated, start, compared
):
    run = swelling(*[[10, 12, 15, 12, 30, 50]] * len(start), evaluated_spans=evaluated, start=start)
    assert transient(run) == (apart(run, evaluated[0] - 1, evaluated[0]) if compared else None)


def test_only_equal_neighbours_are_compared():
    uneven = made_line((50.0, 50.0, 50.0, 50.5, 50.0, 50.0), dropper_every=15.0)
    amplitudes = [50, 12, 10, 30, 90, 50]
    assert transient(swelling(amplitudes, evaluated_spans=(2, 4))) is None
    assert transient(swelling(amplitudes, line=uneven)) is None
    run = swelling(amplitudes, line=uneven, evaluated_spans=(2, 3, 4, 5))
    assert transient(run) == apart(run, 2, 3)


def test_droppers_are_slack_for_a_share_of_the_evaluated_time():
    """Droppers 9 to 16 hang in spans 3 and 4: one of them is slack for half of the time, 1/16 of all."""
    forces = np.full((24, 2001), 0.5)
    forces[8, :1001], forces[7], forces[16] = 0.0, 0.0, 0.0
    slack = check(made_run(dropper_force=forces), "slack droppers")
    assert slack.value == pytest.approx(100 / 16, rel=1e-3)
    assert slack.passed
    forces[15, :1001] = -1e-9
    assert not check(made_run(dropper_force=forces), "slack droppers").passed


def test_spans_without_droppers_have_none_that_is_slack():
    assert check(made_run(made_line(dropper_every=60.0)), "slack droppers") is None


def remedy(run, name):
    found = check(run, name)
    assert not found.passed
    return found.text


def test_checks_name_what_it_is_and_what_to_take_instead():
    """And a bound in a remedy is rounded to the side that keeps it."""
    tone = made_run(mesh=MESH | {"contact_wire_element": 2.6}, speed=26.0, times=4001)
    assert "take elements of at most 1.3 m" in remedy(tone, "element-passing frequency")
    fast = made_run(mesh=MESH, speed=83.0, step=4e-3, times=1001)
    assert "moves 0.33 m a step, over elements of 0.5 m; take a time step of at most 3 ms" in remedy(
        fast, "steps in an element"
    )
    heads = [made_pantograph((mass, 100.0, 0.0), name=name) for name, mass in (("a", 2.0), ("b", 1.0))]
    coarse = made_run(None, *heads, start=(5.0, 6.0))
    said = remedy(coarse, "time steps in a period")
    assert "of 35.6 Hz, the resonance of the head of b on its contact spring; take a time step of" in said
    assert said.endswith("at most 1.4 ms")
    spans = remedy(swelling([50, 10, 13, 8, 30, 50], evaluated_spans=(2, 3, 4)), "start transient")
    assert spans.startswith("so far σ of first in the equal spans 3 and 4 differs, ")
    forces = np.full((24, 2001), 0.5)
    forces[9:13], forces[14, :501] = 0.0, 0.0
    assert "longest dropper 2 of span 3 with 100 %" in remedy(
        made_run(dropper_force=forces), "slack droppers"
    )
    end = check(lifted(last_but_one=0.02, at=0.5, run=True), "end reflection")
    assert "add spans behind span 4" in end.text


def test_the_pantograph_that_is_out_of_balance_is_named():
    force = np.full((2, 2001), 100.0)
    force[1] = 103.0
    run = made_run(None, *TWO, start=(5.0, 6.0), contact_force=force)
    assert remedy(run, "force balance").startswith("share of the uplift force of second by which")


def test_what_is_no_number_is_the_worst_of_all():
    force = np.full((2, 2001), 100.0)
    force[1, 7] = np.nan
    run = made_run(None, *TWO, start=(5.0, 6.0), contact_force=force)
    assert "of second by which" in remedy(run, "force balance")
