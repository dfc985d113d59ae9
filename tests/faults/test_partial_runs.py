"""Runs that fail or are interrupted in the middle: what was computed is kept and marked where it is shown."""

import json
import os
import signal
import time

import numpy as np
import pytest
from faults import LINEAR, OPTIONS, PANTOGRAPH, content, wait_until

import catenary_fe as cf

COARSE = cf.TimeSettings(step=4e-3)


@pytest.fixture(scope="module")
def shape(layout):
    return cf.find_form(cf.load_catenary(layout))


def interrupted(shape, pantographs, share, **settings):
    """The error of a run that the user stops when a share of it is done."""

    def stop(done):
        if done >= share:
            raise KeyboardInterrupt

    settings = {"method": "exudyn", "time": COARSE} | settings
    with pytest.raises(cf.RunInterrupted) as caught:
        cf.simulate(shape, pantographs, speed=200 / 3.6, progress=stop, **settings)
    return caught.value


@pytest.fixture(scope="module")
def whole(shape, pantograph):
    return cf.simulate(shape, [pantograph], speed=200 / 3.6, time=COARSE, store_wire=0.02, method="exudyn")


@pytest.fixture(scope="module")
def early(shape, pantograph):
    """Stopped inside the evaluated span."""
    return interrupted(shape, [pantograph], 0.5, store_wire=0.02).partial


def test_what_was_computed_is_that_of_the_whole_run(early, whole):
    n = early.time.size
    assert 0.4 < n / whole.time.size < 0.7
    for name in (
        "position",
        "contact_force",
        "wire_height",
        "mass_height",
        "dropper_force",
        "support_uplift",
    ):
        assert np.array_equal(early.data[name].values, whole.data[name].values[..., :n])
    shapes = early.data.sizes["wire_time"]
    assert early.data["wire_time"].values[-1] <= early.time[-1] < early.data["wire_time"].values[-1] + 0.02
    assert np.array_equal(early.data["contact_wire_height"], whole.data["contact_wire_height"][:shapes])


def test_a_partial_run_says_so_and_gives_no_figures(early, whole, tmp_path):
    assert whole.partial is None
    assert "partial" not in whole.summary()
    assert early.partial.reason == "interrupted"
    assert early.partial.reached_s == early.time[-1]
    assert early.partial.planned_s == pytest.approx(whole.time[-1])
    loaded = cf.load_run(early.save(tmp_path / "run.nc"))
    assert loaded.partial == early.partial
    summary = loaded.summary()
    assert next(iter(summary)) == "partial"
    figures = summary["pantographs"][0]
    assert figures.pop("name") == PANTOGRAPH
    assert set(figures.values()) == {None}
    assert figures.keys() == whole.summary()["pantographs"][0].keys() - {"name"}
    assert summary["max_support_uplift_mm"] is None
    assert {c.name for c in early.checks} < {c.name for c in whole.checks}
    assert "start transient" not in {c["name"] for c in summary["checks"]}
    assert summary["warnings"][0].startswith("PARTIAL run: it ended after ")
    for ask in (early.contact_force_statistics, early.largest_support_uplift):
        with pytest.raises(cf.InputError, match=r"spans \[2\]: the run is partial and ended at \d\d\.\d m"):
            ask()
    assert early.contact_force_statistics(spans=[1])[0].mean == pytest.approx(
        whole.contact_force_statistics(spans=[1])[0].mean
    )
    with pytest.raises(cf.InputError, match="only whole runs are judged"):
        cf.criteria_rows(early, "AC")


def test_spans_that_were_passed_keep_their_figures(shape, pantograph, whole):
    late = interrupted(shape, [pantograph], 0.95).partial
    assert late.reached
    ours, theirs = late.contact_force_statistics()[0], whole.contact_force_statistics()[0]
    assert (ours.mean, ours.std) == pytest.approx((theirs.mean, theirs.std), rel=1e-9)
    assert late.summary()["max_support_uplift_mm"] is not None


def test_of_two_pantographs_the_one_that_passed(shape, pantograph):
    run = interrupted(shape, [pantograph] * 2, 0.7, positions=[50.0, 12.0]).partial
    first, second = run.summary()["pantographs"]
    assert first["mean_N"] == pytest.approx(120, abs=15)
    assert second["mean_N"] is None
    assert not run.reached


def test_a_compiled_run_keeps_its_finished_blocks(shape, pantograph):
    time = cf.TimeSettings(step=2e-3)
    whole = cf.simulate(shape, [pantograph], speed=200 / 3.6, time=time, store_wire=0.02)
    early = interrupted(shape, [pantograph], 0.5, method="nonlinear", time=time, store_wire=0.02).partial
    n = early.time.size
    assert n > 50 and n % 25 == 1  # blocks of 50 ms
    assert not early.reached
    assert np.array_equal(early.data["contact_force"].values, whole.data["contact_force"].values[:, :n])
    shapes = early.data.sizes["wire_time"]
    assert np.array_equal(early.data["contact_wire_height"], whole.data["contact_wire_height"][:shapes])


def test_an_interrupt_between_readings_keeps_them_together(shape, pantograph, monkeypatch):
    from catenary_fe.engines.nonlinear.recorder import EnergyRecord
    from catenary_fe.engines.tension import TensionRecord

    for record in (EnergyRecord, TensionRecord):
        read, count = record.read, iter(range(10**6))

        def stopping(self, *state, read=read, count=count):
            if next(count) == 20:
                raise KeyboardInterrupt
            read(self, *state)

        with monkeypatch.context() as patched:
            patched.setattr(record, "read", stopping)
            with pytest.raises(cf.RunInterrupted) as caught:
                cf.simulate(shape, [pantograph], speed=200 / 3.6)
        data = caught.value.partial.data
        assert data.sizes["energy_time"] == data.sizes["tension_time"] == 20


def test_next_to_nothing_is_not_kept(shape, pantograph):
    assert interrupted(shape, [pantograph], 0.0).partial is None


def test_every_picture_of_a_partial_run_is_marked(call, early, tmp_path):
    early.save(tmp_path / "run.nc")
    early.plot_support_uplift()
    for axes in (early.plot_contact_force(), early.plot_support_uplift(), early.plot_dropper_forces()):
        assert axes.get_title(loc="left").startswith("PARTIAL, ") or axes.get_title().startswith("PARTIAL, ")
    code, out, err = call("report", tmp_path)
    assert (code, err) == (0, "")
    page = (tmp_path / "report.html").read_text()
    assert page.index("PARTIAL run: it ended after") < page.index("<h2>Criteria</h2>")
    assert "Not judged. PARTIAL run" in page
    assert "passed</td>" not in page.split('id="warnings"')[0]
    assert call("film", tmp_path, "-o", tmp_path / "a.gif", "--fps", 5)[0] == 0
    assert call("waves", tmp_path, "-o", tmp_path / "a.png")[0] == 0
    assert call("export", tmp_path)[0] == 0
    for words in (["compare", tmp_path, tmp_path], ["rerun", tmp_path]):
        code, out, err = call(*words)
        assert (code, out, len(err.splitlines())) == (3, "", 1)
        assert "partial" in err.lower()


def test_a_run_that_fails_is_kept_as_partial(call, layout, tmp_path):
    """Droppers of 10 MN/m: no step length that is tried converges when they go slack."""
    stiff = tmp_path / "stiff.toml"
    stiff.write_text(layout.read_text().replace("stiffness = 100e3", "stiffness = 1e7"))
    folder = tmp_path / "run"
    options = ["--pantograph", PANTOGRAPH, "--speed-kmh", "200", "--time-step-ms", "8"]
    options += ["--method", "exudyn"]
    code, out, err = call("run", stiff, *options, "-o", folder)
    assert (code, out) == (4, "")
    assert "kept in" in err
    last = err.splitlines()[-1]
    assert last.startswith("error: run at 200 km/h: no convergence after t = 0.6")
    assert "with steps of 0.008 s and of 1/8 of it; pantograph 1 at 4" in last
    assert "in span 1" in last
    assert "m before support 2" in last
    assert "the dropper of span 1 at" in last
    assert "(1e+07 N/m)" in last
    assert [p.name for p in folder.iterdir()] == ["partial"]
    summary = json.loads((folder / "partial" / "summary.json").read_text())
    assert summary["partial"]["reason"] == last.removeprefix("error: ")
    run = cf.load_run(folder / "partial" / "run.nc")
    assert run.partial.reached_s == pytest.approx(0.6, abs=0.1)
    (said,) = [w for w in run.warnings if "computed in steps of 1/2 of it" in w]
    assert "pantograph 1 at 4" in said and "m before support 2: the 200 ms from there" in said
    before = content(folder / "partial")
    assert call("run", stiff, *options[:-1], "linearised", "-o", tmp_path / "other")[0] == 0
    assert content(folder / "partial") == before
    assert call("run", layout, *LINEAR, "-o", folder)[0] == 0  # a whole run: the partial one is out of date
    assert not (folder / "partial").exists()


@pytest.mark.slow
def test_smaller_steps_carry_a_run_over_a_hard_place(layout):
    """Droppers of 1 MN/m fail at steps of 8 ms, and not at half of it."""
    catenary = cf.load_catenary(layout)
    stiff = catenary.replace(
        spans=tuple(
            s.replace(droppers=tuple(d.replace(stiffness=1e6) for d in s.droppers)) for s in catenary.spans
        )
    )
    shape, pantograph = cf.find_form(stiff), cf.library.pantograph(PANTOGRAPH)
    coarse, fine = (
        cf.simulate(shape, [pantograph], speed=200 / 3.6, time=cf.TimeSettings(step=step), method="exudyn")
        for step in (8e-3, 2e-3)
    )
    assert [w for w in coarse.warnings if "on from there in steps of" in w]
    assert not [w for w in fine.warnings if "on from there in steps of" in w]
    ours, theirs = coarse.contact_force_statistics()[0], fine.contact_force_statistics()[0]
    assert ours.mean == pytest.approx(theirs.mean, abs=1.0)
    assert ours.std == pytest.approx(theirs.std, rel=0.1)
    assert np.isfinite(coarse.data["contact_force"]).all()


@pytest.mark.parametrize(
    ("number", "code"),
    [pytest.param(signal.SIGINT, 130, marks=pytest.mark.slow), (signal.SIGTERM, 143)],
)
def test_a_run_that_is_stopped_by_a_signal(start, layout, finished, tmp_path, number, code):
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "run.nc").write_bytes((finished / "run.nc").read_bytes())  # of a run before
    process = start("run", layout, *OPTIONS, "--time-step-ms", "0.2", "--method", "exudyn", "-o", folder)
    wait_until(lambda: list(folder.glob(".part-*")), process)
    time.sleep(3)  # form finding, and some hundred steps
    os.killpg(process.pid, number)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out) == (code, "")
    kept, last = (line for line in err.splitlines() if line)
    assert kept.startswith("partial: ")
    assert kept.endswith(f" s are kept in {folder / 'partial'}")
    assert last == "interrupted"
    assert (folder / "run.nc").read_bytes() == (finished / "run.nc").read_bytes()
    assert {p.name for p in folder.iterdir()} == {"run.nc", "partial"}
    assert cf.load_run(folder / "partial" / "run.nc").partial.reason == "interrupted"


def test_a_linearised_run_that_is_stopped_leaves_nothing(start, layout, tmp_path):
    process = start("run", layout, *LINEAR, "--time-step-ms", "0.01", "-o", tmp_path / "run")
    wait_until((tmp_path / "run" / ".lock").exists, process)
    time.sleep(2)
    process.send_signal(signal.SIGTERM)
    out, err = process.communicate(timeout=60)
    assert (process.returncode, out, err) == (143, "", "\ninterrupted\n")
    assert not (tmp_path / "run").exists()
