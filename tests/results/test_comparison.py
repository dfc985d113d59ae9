"""Runs side by side and as tables, on runs whose histories are given."""

import csv
import json

import numpy as np
import pytest
from made_runs import HEIGHT, made_line, made_pantograph, made_run

import catenary_fe as cf
from catenary_fe.results.comparison import COMPARED, failed_checks, input_differences, key_figures
from catenary_fe.results.export import history_tables, write_tables

TWO = (made_pantograph(name="first"), made_pantograph(name="second"))


def differences(*runs):
    return {d.name: d.values for d in input_differences(runs)}


def test_key_figures_of_each_pantograph_of_each_run():
    forces, uplift = np.full((24, 2001), 0.5), np.zeros((7, 2001))
    forces[2, 5], forces[4, 6], uplift[3, 9] = 0.0, -1.0, 0.0625
    swinging = 100 + 10 * np.sin(2 * np.pi * 3 * 2e-3 * np.arange(2001))
    first = made_run(dropper_force=forces, support_uplift=uplift, contact_force=swinging)
    second = made_run(None, *TWO, start=(5.0, 6.0), dropper_force=0.0)
    columns = key_figures([first, second], ["a", "b"], "zero-phase")
    assert [c.label for c in columns] == ["a", "b: first", "b: second"]
    assert all(list(c.values) == [q.key for q in COMPARED] for c in columns)
    own = columns[0].values
    assert own["std_N"] == first.contact_force_statistics(filter="zero-phase")[0].std
    assert own["std_N"] != key_figures([first, second], ["a", "b"])[0].values["std_N"]
    assert own["max_support_uplift_mm"] == 62.5
    assert (own["slack_droppers"], own["checks_failed"]) == (2, 0)
    assert columns[2].values["slack_droppers"] == 24
    assert columns[2].values["checks_failed"] == 1


@pytest.mark.parametrize("number", [0, 1])
def test_fewer_than_two_runs_are_not_compared(number):
    with pytest.raises(cf.InputError, match=f"{number} run to compare: give at least two"):
        key_figures([made_run()] * number, ["a"] * number)


def test_failed_checks_are_named_by_run():
    good, bad = made_run(), made_run(dropper_force=0.0)
    (line,) = failed_checks([good, bad], ["good", "bad"])
    assert line.startswith("bad: check failed: slack droppers = 100 %, must be at most 10 %")


def test_equal_runs_have_equal_inputs():
    assert differences(made_run(), made_run(), made_run()) == {}


def test_inputs_that_differ():
    line = made_line()
    other = line.replace(
        contact_wire=line.contact_wire.replace(tension=12e3, source="another book"), evaluated_spans=(2, 3)
    )
    soft = made_pantograph((10.0, 80.0, 10.0))
    found = differences(made_run(), made_run(other, soft, speed=70 / 3.6, start=(7.0,), method="linearised"))
    assert found == {
        "speed (km/h)": ("180", "70"),
        "method": ("nonlinear", "linearised"),
        "evaluated spans": ("3, 4", "2, 3"),
        "start (m)": ("5", "7"),
        "catenary: contact wire: tension": ("10000", "12000"),
        "pantograph 1: stages: stiffness": ("100", "80"),
    }


def test_rounding_is_no_difference():
    assert differences(made_run(), made_run(start=(5.0 + 1e-11,), speed=50.0 + 1e-12)) == {}


def test_what_only_some_runs_have():
    arm = made_line(supports=[cf.Support(messenger_stiffness=5e5)] * 7)
    found = differences(made_run(), made_run(arm, *TWO, start=(5.0, 6.0)))
    assert found["catenary: supports: messenger stiffness"] == ("–", "500000")
    assert found["pantograph 2: name"] == ("–", "second")
    assert found["start (m)"] == ("5", "5, 6")


def test_the_same_values_in_other_places():
    spans = made_line((50.0, 50.0, 50.0, 60.0, 50.0, 50.0)), made_line((50.0, 50.0, 60.0, 50.0, 50.0, 50.0))
    found = differences(*(made_run(line) for line in spans))
    assert found["catenary: spans: length"] == ("50, 60", "50, 60, in other places")
    more = made_line((50.0, 50.0, 50.0, 60.0, 60.0, 50.0))
    found = differences(made_run(spans[0]), made_run(more))
    assert found["catenary: spans: length"] == ("50, 60", "50, 60, in other places")
    longer = made_line((50.0, 50.0, 50.0, 60.0, 50.0, 50.0, 50.0))
    found = differences(made_run(spans[0]), made_run(longer))
    assert "catenary: spans: length" not in found
    assert found["number of spans"] == ("6", "7")


def test_many_values_are_told_by_their_number_and_reach():
    twelve, thirteen = (made_line([50.0 + i for i in range(n)], dropper_every=60.0) for n in (12, 13))
    found = differences(made_run(twelve), made_run(thirteen))
    listed = ", ".join(str(50 + i) for i in range(12))
    assert found["catenary: spans: length"] == (listed, "13 different values, 50 to 62")
    named = made_run(
        versions=json.dumps({f"v{i}": "x" for i in range(3)} | {"all": [str(i) for i in range(20)]})
    )
    assert differences(made_run(), named)["version: all"] == ("–", "20 different values")


def test_histories_as_tables():
    masses = np.full((2, 2, 2001), HEIGHT)
    masses[1, 1] = np.nan
    pantographs = made_pantograph((8.0, 4000.0, 100.0), (15.0, 50.0, 90.0), name="first"), TWO[1]
    run = made_run(
        made_line((50.0, 50.0, 62.5)), *pantographs, start=(5.0, 6.0), mass_height=masses, speed=35.0,
        contact_force=np.array([[100.0], [120.0]]) + np.random.default_rng(1).normal(size=(2, 2001)),
    )  # fmt: skip
    tables = history_tables(run, "zero-phase")
    assert list(tables) == ["pantograph_1", "pantograph_2", "support_uplift", "dropper_force"]
    headings = [
        "time_s", "position_m", "contact_force_N", "contact_force_0_20_Hz_N", "wire_height_m",
        "mass_1_height_m", "mass_2_height_m",
    ]  # fmt: skip
    assert list(tables["pantograph_1"]) == headings
    assert list(tables["pantograph_2"]) == headings[:-1]
    for i in (0, 1):
        table = tables[f"pantograph_{i + 1}"]
        assert np.array_equal(table["time_s"], run.time)
        assert np.array_equal(table["position_m"], run.data["position"][i])
        assert np.array_equal(table["contact_force_0_20_Hz_N"], run.filtered_contact_force("zero-phase")[i])
        assert np.array_equal(table["mass_1_height_m"], masses[i, 0])
    assert list(tables["support_uplift"])[-1] == "support_4_at_162.5_m_uplift_m"
    assert list(tables["dropper_force"])[:2] == ["time_s", "span_1_dropper_1_at_10_m_force_N"]
    assert list(tables["support_uplift"])[0:2] == ["time_s", "support_1_at_0_m_uplift_m"]


def test_tables_are_written_at_every_so_many_times(tmp_path):
    table = {"time_s": np.arange(7) / 3, "force_N": np.array([1e3 / 7] * 6 + [np.nan])}
    folder = tmp_path / "new" / "folder"
    paths = write_tables({"a": table, "b": table}, folder, every=3)
    assert paths == [folder / "a.csv", folder / "b.csv"]
    rows = list(csv.reader(paths[1].read_text(encoding="utf-8").splitlines()))
    assert rows == [
        ["time_s", "force_N"],
        ["0.000000", "142.86"],
        ["1.000000", "142.86"],
        ["2.000000", "nan"],
    ]
    assert len(write_tables({"a": table}, folder)[0].read_bytes().splitlines()) == 8
    assert len(write_tables({"a": table}, folder, every=1)) == 1  # what is there may be written over


def test_tables_that_cannot_be_written(tmp_path):
    with pytest.raises(cf.InputError, match="every 0 times: must be at least 1"):
        write_tables({}, tmp_path, every=0)
    (tmp_path / "file").write_text("")
    with pytest.raises(cf.InputError, match=r"file: cannot be written: .*choose another folder"):
        write_tables({}, tmp_path / "file")
