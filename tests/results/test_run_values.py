"""What a run says of its histories, on runs whose histories are given."""

import json

import numpy as np
import pytest
from made_runs import HEIGHT, made_line, made_pantograph, made_run

import catenary_fe as cf

TWO = (made_pantograph(name="first"), made_pantograph(name="second"))
STOPPED = {"reason": "interrupted", "reached_s": 1.5, "planned_s": 6.0}


def partial(**record):
    return json.dumps(STOPPED | record)


def test_what_a_run_knows_of_itself():
    elastic = cf.ElasticPantograph(force=90.0, stiffness=20.0)
    line = made_line(evaluated_spans=(4, 3))
    run = made_run(line, TWO[0], elastic, start=(5.0, 9.0), wall_s=2.0, warnings='["a bad line"]')
    assert (run.speed, run.method, run.step, run.wall_s) == (50.0, "nonlinear", 2e-3, 2.0)
    assert run.catenary == line
    assert run.pantographs == (TWO[0], elastic)
    assert run.evaluated_spans == (3, 4)
    assert run.time.shape == (2001,)
    assert run.partial is None
    assert run.reached
    assert run.warnings == ("a bad line",)
    assert run.failed_checks == ()


def test_windows_hold_the_supports_they_lie_between():
    run = made_run(start=(0.0, 20.0)[:1], times=3001)
    position = run.data["position"].values[0]
    for spans in ([1], [3], [6], [2, 3], [2, 5], None):
        inside = np.zeros(position.size, dtype=bool)
        for n in spans or [3, 4]:
            inside |= (position >= 50 * (n - 1)) & (position <= 50 * n)
        assert np.array_equal(run.window(0, spans), inside)
    assert run.window(0, [1])[0]
    assert run.window(0, [2])[500]  # at 50 m


@pytest.mark.parametrize("span", [-1, 0, 7])
def test_spans_that_the_line_does_not_have(span):
    for ask in (lambda spans: made_run().window(0, spans), made_run().largest_support_uplift):
        with pytest.raises(cf.InputError, match=f"span {span}: the line has spans 1 to 6"):
            ask([3, span])


def test_spans_that_a_pantograph_does_not_reach():
    run = made_run(None, *TWO, start=(60.0, 5.0))
    assert run.window(1, [1]).any()
    with pytest.raises(cf.InputError, match=r"pantograph 1 was never inside spans \[1\]"):
        run.window(0, [1])
    with pytest.raises(cf.InputError, match=r"pantograph 2 was never inside spans \[6\]"):
        run.contact_force_statistics([6])


def test_a_partial_run_has_figures_of_what_all_of_it_passed():
    """It ends with the pantographs at 200 m, the end of the evaluated spans, and just before it."""
    run = made_run(None, *TWO, start=(5.0, 4.9), times=1951, partial=partial(), warnings='["slow"]')
    assert run.partial == cf.results.check.Partial(**STOPPED)
    assert not run.reached
    first, second = run.figures()
    assert first.mean == pytest.approx(100)
    assert second is None
    assert run.window(1, [2]).any()
    words = (
        r"spans \[3, 4\]: the run is partial and ended at 199\.9 m, where pantograph 2 had not passed them"
    )
    for ask in (lambda: run.window(1), run.contact_force_statistics, run.largest_support_uplift):
        with pytest.raises(cf.InputError, match=words):
            ask()
    with pytest.raises(
        cf.InputError, match=r"spans \[6, 2\]: .* was never inside|spans \[6, 2\]: the run is"
    ):
        run.window(0, [6, 2])
    assert run.largest_support_uplift([1, 2]) == 0
    assert run.warnings[0].startswith(
        "PARTIAL run: it ended after 1.50 of 6.00 s; spans that were not passed"
    )
    assert run.warnings[1] == "slow"


def test_a_whole_run_need_not_leave_its_spans():
    run = made_run(times=1900)
    assert run.data["position"].values[0, -1] < 200
    assert run.reached
    assert run.figures()[0] is not None


def test_uplift_is_of_the_supports_around_the_spans():
    uplift = np.repeat([[0.01], [0.02], [0.03], [0.04], [0.05], [0.06], [0.07]], 2001, axis=1)
    uplift[1, 77] = 0.035
    run = made_run(support_uplift=uplift)
    assert run.largest_support_uplift() == 0.05  # supports 2 to 4 from 0
    assert run.largest_support_uplift([1]) == 0.035
    assert run.largest_support_uplift([2]) == 0.035
    assert run.largest_support_uplift([6]) == 0.07
    assert run.largest_support_uplift([1, 4]) == 0.05
    assert run.uplift_by_support() == {3: 0.03, 4: 0.04, 5: 0.05}
    assert run.uplift_by_support([1, 6]) == {1: 0.01, 2: 0.035, 6: 0.06, 7: 0.07}


def test_figures_are_of_the_filtered_force_in_the_spans():
    """Two tones: that of 3 Hz passes, that of 100 Hz does not; outside the spans all is another force."""
    run = made_run(times=3001)
    x = run.data["position"].values[0]
    tones = 10 * np.sin(2 * np.pi * 3 * run.time) + 40 * np.sin(2 * np.pi * 100 * run.time)
    run = made_run(
        times=3001,
        contact_force=np.where((x > 60) & (x < 290), 110 + tones, -50.0),
        wire_height=HEIGHT + np.where((x >= 100) & (x <= 200), 0.02 * np.sin(x), 1.0),
    )
    for kind in ("causal", "zero-phase"):
        (found,) = run.contact_force_statistics(filter=kind)
        assert found.filter == kind
        assert found.pantograph == "pantograph"
        assert found.mean == pytest.approx(110, abs=0.1)
        assert found.std == pytest.approx(10 / np.sqrt(2), rel=0.01)
        assert found.contact_loss == 0
        assert found.contact_point_range == pytest.approx(0.04, rel=1e-3)
        filtered = run.filtered_contact_force(kind)
        assert filtered.shape == (1, 3001)
        assert filtered[0, run.window(0)].max() == found.max
    assert run.contact_force_statistics([2, 3, 4])[0].contact_loss == pytest.approx(0.2 / 3, rel=0.01)


def test_statistics_span_by_span_are_of_whole_spans():
    """Of 300 m two pantographs run from 50 and 5 m to 300 and 255 m: spans 2 to 5 are passed by both."""
    run = made_run(None, *TWO, start=(50.0, 5.0), times=2501)
    x = run.data["position"].values
    run = made_run(None, *TWO, start=(50.0, 5.0), times=2501, contact_force=100.0 + x // 50)
    found = run.statistics_by_span("zero-phase")
    assert list(found) == [2, 3, 4, 5]
    for span, (first, second) in found.items():
        assert (first.pantograph, second.pantograph) == ("first", "second")
        assert first == run.contact_force_statistics([span], "zero-phase")[0]
        assert second.mean == pytest.approx(99 + span, abs=0.1)
    assert list(made_run(None, start=(50.1,), times=2001).statistics_by_span()) == [3, 4, 5]


def test_a_summary_is_in_display_units():
    uplift = np.zeros((7, 2001))
    uplift[3] = 0.04
    run = made_run(None, *TWO, start=(5.0, 4.0), support_uplift=uplift, wall_s=0.5, speed=200 / 3.6)
    summary = run.summary("zero-phase")
    assert list(summary) == [
        "speed_kmh", "method", "conditions", "evaluated_spans", "dropper_lengths_given", "filter",
        "pantographs", "governing_pantograph", "max_support_uplift_mm", "support_uplift_mm",
        "largest_contact_lateral_mm", "contact_lateral_mm", "slack_droppers",
        "largest_dropper_force_N", "elasticity_non_uniformity_percent", "simulated_s", "wall_s",
        "real_time_factor", "checks", "checks_failed", "warnings",
    ]  # fmt: skip
    assert (summary["speed_kmh"], summary["method"], summary["filter"]) == (200.0, "nonlinear", "zero-phase")
    assert summary["evaluated_spans"] == [3, 4]
    assert [p["name"] for p in summary["pantographs"]] == ["first", "second"]
    assert summary["pantographs"][1] == run.contact_force_statistics(filter="zero-phase")[1].as_dict()
    assert summary["max_support_uplift_mm"] == pytest.approx(40)
    assert summary["support_uplift_mm"] == {"3": 0.0, "4": pytest.approx(40), "5": 0.0}
    assert (summary["slack_droppers"], summary["largest_dropper_force_N"]) == (0, 50.0)
    assert summary["elasticity_non_uniformity_percent"] is None
    assert (summary["simulated_s"], summary["wall_s"]) == (4.0, 0.5)
    assert summary["real_time_factor"] == pytest.approx(8.0)
    assert summary["checks"] == [check.as_dict() for check in run.checks]
    assert run.summary()["filter"] == "causal"


def test_a_summary_without_a_time_of_computing():
    summary = made_run().summary()
    assert (summary["wall_s"], summary["real_time_factor"]) == (None, None)


def test_a_summary_of_a_partial_run_begins_with_why():
    summary = made_run(None, *TWO, start=(5.0, 4.9), times=1951, partial=partial()).summary()
    assert next(iter(summary.items())) == ("partial", STOPPED)
    assert (summary["max_support_uplift_mm"], summary["support_uplift_mm"]) == (None, {})
    assert summary["governing_pantograph"] == TWO[0].name
    first, second = summary["pantographs"]
    assert first["mean_N"] == pytest.approx(100)
    assert second == dict.fromkeys(first) | {"name": "second"}


def test_failed_checks_are_warned_of():
    run = made_run(dropper_force=0.0, warnings='["slow"]')
    assert run.failed_checks == ("slack droppers",)
    (failed,) = [check for check in run.checks if not check.passed]
    assert run.warnings == ("slow", f"check failed: {failed}")
    assert run.summary()["checks_failed"] == ["slack droppers"]
    assert run.summary()["warnings"] == list(run.warnings)


def test_elasticity_is_kept_with_the_run(tmp_path):
    """Once computed it is in the data, the file and the summary, and the histories are as they were."""
    curve = cf.results.Elasticity(
        np.array([100.0, 112.5, 150.0]), np.array([0.03, 0.05, 0.04]), 90.0, np.array([100.0, 150.0])
    )
    run = made_run(wall_s=2.0)
    assert run.elasticity is None
    held = run.with_elasticity(curve)
    assert held.wall_s == 2.0
    for each in (held, held.with_elasticity(curve), cf.load_run(held.save(tmp_path / "run.nc"))):
        for name in ("position", "uplift", "support_position"):
            assert np.array_equal(getattr(each.elasticity, name), getattr(curve, name)), name
        assert each.elasticity.force == 90.0
        assert each.summary()["elasticity_non_uniformity_percent"] == 100 * curve.non_uniformity
    assert held.without_elasticity().data.identical(run.data)


def test_droppers_that_went_slack():
    forces = np.full((24, 2001), 0.5)
    forces[2, 5], forces[4, 6], forces[7, 0] = 0.0, -1.0, 88.0
    run = made_run(dropper_force=forces)
    assert run.slackened_droppers.tolist() == [2, 4]
    assert run.summary()["slack_droppers"] == 2
    assert run.summary()["largest_dropper_force_N"] == run.largest_dropper_force == 88.0
    assert made_run(made_line(dropper_every=60.0)).largest_dropper_force == 0.0


def test_energy_that_is_missing():
    energies = {"energy": [7.0, 7.2, 7.9], "driven_work": [0, 1.0, 4.0], "lost_work": [0, 1.0, 3.5]}
    run = made_run(extra={name: ("energy_time", np.array(v)) for name, v in energies.items()})
    assert run.has_energy
    assert run.missing_energy == pytest.approx([0.0, 0.2, 0.4])
    assert not made_run().has_energy
    with pytest.raises(cf.InputError, match="recorded no energy; run again with the method 'nonlinear'"):
        _ = made_run().missing_energy


def test_saved_whole_and_with_its_checksum(tmp_path):
    run = made_run(None, *TWO, start=(5.0, 4.9), times=1951, partial=partial())
    path = run.save(str(tmp_path / "run.nc"))
    assert path == tmp_path / "run.nc"
    assert path.read_bytes()[:4] == b"CDF\x02"
    loaded = cf.load_run(path)
    assert loaded.data.identical(run.data)
    assert loaded.summary() == run.summary()


@pytest.mark.parametrize(
    ("attribute", "value", "words"),
    [
        ("format", "catenary_fe run 0", r"not a run of catenary_fe \(format 'catenary_fe run 0'\)"),
        *((name, "[", "what it records of its inputs is damaged")
          for name in ("catenary", "pantographs", "evaluated_spans", "settings", "warnings")),
        ("settings", "{}", "what it records of its inputs is damaged"),
        ("settings", '{"mesh": 1, "time": {}}', "what it records of its inputs is damaged"),
        ("settings", '{"mesh": {}, "time": 1}', "what it records of its inputs is damaged"),
        ("settings", '{"mesh": {}}', "what it records of its inputs is damaged"),
        ("warnings", "1", "what it records of its inputs is damaged"),
        ("speed", "fast", "what it records of its inputs is damaged"),
    ],
)  # fmt: skip
def test_records_that_are_no_inputs(tmp_path, attribute, value, words):
    run = made_run()
    run.data.attrs[attribute] = value
    run.save(tmp_path / "run.nc")
    with pytest.raises(cf.InputError, match=rf"run\.nc: {words}"):
        cf.load_run(tmp_path / "run.nc")


@pytest.mark.parametrize("attribute", ["method", "speed", "warnings"])
def test_records_that_are_missing(tmp_path, attribute):
    run = made_run()
    del run.data.attrs[attribute]
    run.save(tmp_path / "run.nc")
    with pytest.raises(cf.InputError, match="what it records of its inputs is damaged; run again"):
        cf.load_run(tmp_path / "run.nc")


def test_a_file_without_its_checksum_is_not_trusted(tmp_path):
    made_run().data.to_netcdf(tmp_path / "run.nc", engine="scipy")
    with pytest.raises(cf.InputError, match=r"damaged: its content is not what its checksum says"):
        cf.load_run(tmp_path / "run.nc")


def test_pictures_of_a_run():
    energies = dict.fromkeys(
        ["energy", "driven_work", "lost_work", "energy_time"], ("energy_time", np.arange(3.0))
    )
    run = made_run(extra=energies)
    for plot in (run.plot_contact_force, run.plot_support_uplift, run.plot_dropper_forces, run.plot_energy):
        axes = plot()
        assert axes.get_ylabel()
        assert plot(ax=axes) is axes
