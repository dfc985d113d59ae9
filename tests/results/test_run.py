"""A run's data: labelled, complete, the same after saving, the same again."""

import json

import numpy as np
import pytest

import catenary_fe as cf


def test_every_variable_has_a_unit_and_a_name(short_run):
    for variable in short_run.data.data_vars.values():
        assert variable.attrs["units"] in ("m", "N", "J", "1")
        assert variable.attrs["long_name"]
    assert short_run.data["contact_wire_height"].dims == ("wire_time", "x")


def test_provenance(short_run, short, pantograph):
    assert short_run.catenary == short
    assert short_run.pantographs == (pantograph,)
    assert short_run.speed == pytest.approx(250 / 3.6)
    assert len(short_run.data.attrs["input_sha256"]) == 64
    assert set(json.loads(short_run.data.attrs["versions"])) == {"catenary_fe", "exudyn", "numpy", "scipy"}
    settings = json.loads(short_run.data.attrs["settings"])
    assert settings["time"]["step"] == 1e-3
    assert settings["mesh"]["at_clamps"] == 0.5


def test_saved_and_loaded(short_run, tmp_path):
    loaded = cf.load_run(short_run.save(tmp_path / "run.nc"))
    assert loaded.data.identical(short_run.data)
    assert loaded.contact_force_statistics() == short_run.contact_force_statistics()
    assert not list(tmp_path.glob("*.part"))


def test_a_repeated_run_saves_the_same_bytes(short_run, short_shape, pantograph, tmp_path):
    again = cf.simulate(short_shape, [pantograph], speed=250 / 3.6, store_wire=0.02)
    first, second = (r.save(tmp_path / f"{i}.nc").read_bytes() for i, r in enumerate((short_run, again)))
    assert first == second


@pytest.mark.parametrize("content", [None, b"", b"CDF\x02 but then nothing", b"name = 'a layout'"])
def test_files_that_are_not_runs(tmp_path, content):
    path = tmp_path / "x.nc"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(cf.InputError, match=r"x\.nc: "):
        cf.load_run(path)


def test_saving_where_it_cannot_be_saved(short_run, tmp_path):
    with pytest.raises(cf.InputError, match="cannot be written"):
        short_run.save(tmp_path / "no" / "folder" / "run.nc")


def test_windows(short_run):
    x = short_run.data["position"].values[0]
    inside = short_run.window(0)
    assert x[inside].min() == pytest.approx(120, abs=0.1)
    assert x[inside].max() == pytest.approx(180, abs=0.1)
    with pytest.raises(cf.InputError, match="span 9"):
        short_run.window(0, spans=[9])


def test_summary_is_json_with_the_keys_that_were_promised(short_run):
    summary = json.loads(json.dumps(short_run.summary(), allow_nan=False))
    assert {
        "speed_kmh", "method", "evaluated_spans", "pantographs", "max_support_uplift_mm",
        "simulated_s", "wall_s", "real_time_factor", "warnings",
    } <= set(summary)  # fmt: skip
    assert {
        "name", "mean_N", "std_N", "std_0_5_Hz_N", "std_5_20_Hz_N", "statistical_max_N", "statistical_min_N",
        "max_N", "min_N", "contact_loss_percent", "contact_loss_over_5_ms_percent", "losses_over_5_ms",
        "longest_loss_ms", "contact_point_range_mm",
    } == set(summary["pantographs"][0])  # fmt: skip


def test_dropper_forces_start_at_the_static_ones(short_run, short_shape):
    start = short_run.data["dropper_force"].values[:, 0]
    far = short_run.data["dropper_position"].values > 120
    assert start[far] == pytest.approx(short_shape.dropper_forces[far], abs=0.5)


def test_contact_follows_from_the_gap(short_run, pantograph):
    """Head height, wire height and force belong together at every instant."""
    depth = short_run.data["mass_height"].values[0, 0] - short_run.data["wire_height"].values[0]
    expected = pantograph.contact_stiffness * np.maximum(depth, 0)
    assert short_run.data["contact_force"].values[0] == pytest.approx(expected, abs=1e-6)


def test_newtons_law_of_the_pantograph(short_run, pantograph):
    """Uplift minus base spring, damper and contact force is the masses' momentum gained."""
    force = short_run.data["contact_force"].values[0]
    heights = short_run.data["mass_height"].values[0] - 5.3
    lower = pantograph.stages[-1]
    net = 120 - force - lower.stiffness * heights[1]
    momentum = np.trapezoid(net, dx=short_run.step) - lower.damping * (heights[1, -1] - heights[1, 0])
    velocity = (heights[:, -1] - heights[:, -2]) / short_run.step
    gained = sum(s.mass * v for s, v in zip(pantograph.stages, velocity, strict=True))
    # backward differences are half a step late: an acceleration of 1 g on 22 kg moves this by 0.1 N s
    assert momentum == pytest.approx(gained, abs=0.1)
