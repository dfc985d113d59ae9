"""Physics guards: each passes on a sound run, and fails where its physics is broken."""

import json

import numpy as np
import pytest

import catenary_fe as cf


def checks_of(run):
    return {check.name: check for check in run.checks}


def changed(run, **changes):
    """The run with changed variables (a function of their values) or attributes."""
    data = run.data.copy(deep=True)
    for name, change in changes.items():
        if name in data:
            data[name].values[:] = change(data[name].values)
        else:
            data.attrs[name] = change(data.attrs[name])
    return cf.Run(data)


def failed(run):
    return {check.name for check in run.checks if not check.passed}


def test_names_and_json(short_run):
    names = [check.name for check in short_run.checks]
    assert names == [
        "penetration", "force balance", "element-passing frequency", "steps in an element",
        "time steps in a period", "end reflection", "start transient", "slack droppers",
    ]  # fmt: skip
    rows = json.loads(json.dumps(short_run.summary()["checks"], allow_nan=False))
    assert set(rows[0]) == {"name", "value", "unit", "rule", "bound", "passed"}
    assert [row["name"] for row in rows] == names


def test_a_short_line_meets_its_end(short_run, tmp_path):
    """240 m: the wave of the start is back in the third span before the pantograph has left it."""
    check = checks_of(short_run)["end reflection"]
    c = np.sqrt(16e3 / 1.07)  # the messenger wire's, the faster one
    meeting = (2 * 240 - 10 - 10) / (c + 250 / 3.6)
    assert check.value == pytest.approx(10 + 250 / 3.6 * meeting)
    assert check.bound == 180
    assert not check.passed
    lines = [w for w in short_run.warnings if w.startswith("check failed: end reflection = ")]
    assert len(lines) == 1
    assert lines[0] in short_run.summary()["warnings"]
    assert cf.load_run(short_run.save(tmp_path / "run.nc")).warnings == short_run.warnings


def test_penetration_is_force_over_stiffness(short_run, pantograph):
    check = checks_of(short_run)["penetration"]
    deepest = short_run.data["contact_force"].values.max() / pantograph.contact_stiffness
    assert check.value == pytest.approx(1e3 * deepest, rel=1e-6)
    assert check.passed


@pytest.mark.parametrize(
    ("name", "changes"),
    [
        ("penetration", {"wire_height": lambda z: z - 0.01}),
        ("force balance", {"contact_force": lambda f: 1.02 * f}),
        ("force balance", {"contact_force": lambda f: np.nan * f}),
        ("element-passing frequency", {"settings": lambda s: s.replace("1.3,", "3.6,")}),
        ("steps in an element", {"settings": lambda s: s.replace("0.5,", "0.1,")}),
        ("slack droppers", {"dropper_force": lambda f: np.where(f < 60, 0.0, f)}),
        ("start transient", {"contact_force": lambda f: np.where(np.arange(f.size) < 1590, f, 1.3 * f)}),
    ],
)
def test_a_broken_run_fails_its_check(short_run, name, changes):
    assert name not in failed(short_run) or name == "start transient"
    assert name in failed(changed(short_run, **changes))


def test_a_stiff_contact_needs_a_smaller_step(short_run):
    """500 kN/m on 7.2 kg sound at 42 Hz: 1 ms makes 24 steps; four times as stiff, 12."""

    def stiffer(factor):
        def change(text):
            records = json.loads(text)
            records[0]["contact_stiffness"] *= factor
            return json.dumps(records)

        return checks_of(changed(short_run, pantographs=change))["time steps in a period"]

    frequency = np.sqrt(500e3 / short_run.pantographs[0].stages[0].mass) / (2 * np.pi)
    assert stiffer(10).value == pytest.approx(1e3 / frequency)
    assert stiffer(10).passed
    assert not stiffer(40).passed
