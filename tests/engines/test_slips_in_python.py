"""Slips of those who script: one clear line, not the inside of a program."""

import logging

import numpy as np
import pytest

import catenary_fe as cf

SLIPS = {
    "a pantograph alone": (lambda s, p: cf.simulate(s, p, speed=50.0), "pantographs = Pantograph"),
    "a name": (lambda s, p: cf.simulate(s, "DSA250", speed=50.0), "pantographs = 'DSA250': give a list"),
    "a list of names": (lambda s, p: cf.simulate(s, ["DSA250"], speed=50.0), "pantograph 1 = 'DSA250'"),
    "no pantograph": (lambda s, p: cf.simulate(s, [], speed=50.0), "pantographs is empty"),
    "no shape": (lambda s, p: cf.simulate(s.catenary, [p], speed=50.0), r"give find_form\(catenary\)"),
    "elasticity": (lambda s, p: cf.elasticity(s.catenary), "must be a static shape"),
    "statics": (lambda s, p: cf.solve_statics(s.catenary), "must be a static shape"),
    "modes": (lambda s, p: cf.solve_modes(s.catenary), "must be a static shape"),
    "a file's name": (lambda s, p: cf.find_form("line.toml"), "catenary = 'line.toml': must be a Catenary"),
    "heights": (lambda s, p: cf.find_heights("line.toml"), "load_catenary reads a file"),
}


@pytest.mark.parametrize("slip", SLIPS)
def test_slips(short_shape, pantograph, slip):
    ask, words = SLIPS[slip]
    with pytest.raises(cf.InputError, match=words) as caught:
        ask(short_shape, pantograph)
    assert len(caught.value.problems) == 1


def test_a_run_is_read_from_its_folder(short_run, tmp_path):
    short_run.save(tmp_path / "run.nc")
    assert cf.load_run(tmp_path).data.identical(short_run.data)


def test_many_notes_are_told_by_their_number():
    from catenary_fe.studies.record import _brief

    assert _brief(["a", "b", "c"]) == ["a", "b", "c"]
    assert _brief(["a", "b", "c", "d", "e"]) == ["a", "b", "3 more such warnings, the last one: e"]


def test_beyond_the_wave_speed_no_mesh_is_asked_for(short_shape, pantograph):
    from catenary_fe.engines.settings import TimeSettings
    from catenary_fe.studies.checks import run_warnings

    wave_speed = short_shape.catenary.contact_wire.wave_speed
    said = run_warnings(short_shape, [pantograph], 1.01 * wave_speed, np.array([20.0]), TimeSettings())
    assert not [line for line in said if "refine the mesh" in line]
    (line,) = [line for line in said if "wave speed" in line]
    assert "is 1.010 of the contact wire's wave speed" in line


@pytest.mark.parametrize("method", ["linearised", "nonlinear"])
def test_failed_checks_are_logged_whatever_the_method(short_shape, pantograph, caplog, method):
    settings = cf.TimeSettings(step=0.01)
    with caplog.at_level(logging.WARNING, logger="catenary_fe"):
        run = cf.simulate(short_shape, [pantograph], speed=140 / 3.6, time=settings, method=method)
    assert "time steps in a period" in run.failed_checks
    assert [record.getMessage() for record in caplog.records] == list(run.warnings)
    assert len([w for w in run.warnings if w.startswith("check failed")]) == len(run.failed_checks)


def test_modes_that_no_mesh_resolves_are_logged(short, caplog):
    line = short.replace(spans=short.spans[:2], supports=short.supports[:3], evaluated_spans=None)
    coarse = cf.MeshSettings(contact_wire_element=6.0, messenger_wire_element=6.0, at_clamps=6.0)
    shape = cf.find_form(line, coarse)
    cf.solve_modes(shape, count=2)
    assert not caplog.records
    cf.solve_modes(shape, count=40)
    assert "waves are shorter than two elements" in caplog.text
