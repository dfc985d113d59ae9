"""Quality checks: each passes on a sound run, and fails where its physics is broken."""

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
        "penetration", "force balance", "pantograph energy", "energy balance", "tension drift",
        "steps in an element", "time steps in a period", "element-passing frequency", "end reflection",
        "start transient", "slack droppers",
    ]  # fmt: skip
    rows = json.loads(json.dumps(short_run.summary()["checks"], allow_nan=False))
    assert set(rows[0]) == {"name", "value", "unit", "rule", "bound", "passed"}
    assert [row["name"] for row in rows] == names


@pytest.fixture(scope="module")
def slow_run(short_shape, pantograph):
    return cf.simulate(short_shape, [pantograph], speed=60 / 3.6, method="linearised")


def test_a_short_line_meets_its_end(slow_run, short_run, tmp_path):
    """At 60 km/h the wave of the start runs to and fro on 240 m until the third span is passed."""
    check = checks_of(slow_run)["end reflection"]
    assert 40 < check.value < 60  # σ is 6 % off that of a line of 16 spans
    assert not check.passed
    lines = [w for w in slow_run.warnings if w.startswith("check failed: end reflection = ")]
    assert len(lines) == 1
    assert lines[0] in slow_run.summary()["warnings"]
    assert cf.load_run(slow_run.save(tmp_path / "run.nc")).warnings == slow_run.warnings
    assert checks_of(short_run)["end reflection"].passed  # at 250 km/h the wave is hardly back


def test_a_line_that_goes_on_has_no_end_reflection(reference, pantograph):
    """The front is back long before a slow train has passed, but what comes back is small."""
    line = reference.replace(spans=reference.spans[:7], supports=reference.supports[:8], evaluated_spans=(3,))
    run = cf.simulate(cf.find_form(line), [pantograph], speed=60 / 3.6, method="linearised")
    assert 0.1 < checks_of(run)["end reflection"].value < 8


def test_the_tone_of_fine_elements_is_judged_by_what_it_does(slow_run, short, pantograph):
    """12.8 Hz lies in the filter's band; with five elements from dropper to dropper it is faint."""
    assert "element-passing frequency" not in checks_of(slow_run)
    check = checks_of(slow_run)["element-passing tone"]
    assert 1 < check.value < 2
    assert check.passed
    x = slow_run.data["position"].values[0]
    louder = changed(slow_run, contact_force=lambda f: f + 8 * np.sin(2 * np.pi * x / 1.3))
    # 5.7 N rms, of which the filter leaves all; beside what was there
    assert checks_of(louder)["element-passing tone"].value == pytest.approx(100 * 5.66 / 115, rel=0.2)
    assert "element-passing tone" in failed(louder)
    coarse = changed(slow_run, settings=lambda s: s.replace("1.3,", "2.0,"))
    assert "element-passing frequency" in failed(coarse)


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
        ("pantograph energy", {"contact_force": lambda f: 1.05 * f}),
        ("pantograph energy", {"pantographs": lambda s: s.replace("4200.0", "3500.0")}),
        ("tension drift", {"tension_change": lambda c: c + 0.03}),
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


def test_the_stages_energy_sees_what_their_momentum_does_not(short_run):
    """A wrong spring between the masses leaves the sum of all forces as it is."""
    soft = changed(short_run, pantographs=lambda s: s.replace("4200.0", "3500.0"))
    assert "force balance" not in failed(soft)
    assert "pantograph energy" in failed(soft)


@pytest.mark.parametrize("strips", [1, 2])
def test_forces_balance_with_any_number_of_strips(short_shape, pantograph, strips):
    apart = 0.5 if strips == 2 else None
    head = cf.Panhead(strips=strips, strip_distance=apart)
    run = cf.simulate(short_shape, [pantograph.replace(head=head)], speed=70.0, method="linearised")
    assert checks_of(run)["force balance"].value < 0.05
    assert ("pantograph energy" in checks_of(run)) == (strips == 1)


@pytest.fixture(scope="module")
def balanced(short_shape, pantograph):
    return cf.simulate(short_shape, [pantograph], speed=250 / 3.6, energy=True, method="exudyn")


def test_energy_balance_of_a_damped_run(balanced, short_run, tmp_path):
    for run in (balanced, short_run):
        check = checks_of(run)["energy balance"]
        assert 0.01 < check.value < 0.5  # of 30 J, half of which the dampers take
        assert run.data["lost_work"].values[-1] > 0.3 * run.data["driven_work"].values[-1] > 3
        loaded = cf.load_run(run.save(tmp_path / "run.nc"))
        assert checks_of(loaded)["energy balance"] == check
        for name in ("energy", "driven_work", "lost_work"):
            assert "energy balance" in failed(changed(run, **{name: lambda e: 0.9 * e})), name


@pytest.mark.parametrize("name", ["energy", "driven_work", "lost_work"])
def test_both_integrators_keep_the_same_accounts(balanced, short_run, name):
    ours, theirs = (run.data[name].values for run in (short_run, balanced))
    assert theirs.max() > 5  # [J]
    assert ours == pytest.approx(theirs, abs=0.02)


def test_a_coarse_step_is_seen_in_the_energy(short_shape, pantograph):
    """The integrator's own damping, with its largest setting and few steps."""
    time = cf.TimeSettings(step=4e-3, spectral_radius=0.2)
    run = cf.simulate(short_shape, [pantograph], speed=250 / 3.6, time=time)
    assert "energy balance" in failed(run)


def test_both_integrators_read_the_same_tensions(balanced, short_run):
    """Of two wires every 50 ms: under 1 % of change, and the same within 0.02 % of the tension."""
    ours, theirs = (run.data["tension_change"].values for run in (short_run, balanced))
    assert ours.shape == theirs.shape == (2, 64)
    assert 1e-3 < ours.max() < 1e-2
    assert ours == pytest.approx(theirs, abs=2e-4)


def test_linearised_runs_record_no_energy(short_shape, pantograph):
    with pytest.raises(cf.InputError, match="take the method 'nonlinear'"):
        cf.simulate(short_shape, [pantograph], speed=70.0, energy=True, method="linearised")
