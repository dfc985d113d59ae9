"""Modes of lines in space: what swings sideways is told apart from what swings up and down."""

import numpy as np
import pytest

import catenary_fe as cf


@pytest.fixture(scope="module")
def line(reference_layout):
    line = cf.load_catenary(reference_layout.with_name("en50318_2018_ac_simple.toml"))
    return line.replace(spans=line.spans[:3], supports=line.supports[:4], evaluated_spans=None)


def test_the_lowest_sideways_modes_are_those_of_strings_from_arm_to_arm(line):
    """The messenger wire's weight and the leaning droppers stiffen them a little."""
    modes = cf.solve_modes(cf.find_form(line), count=12)
    sideways = [k.kind == "sideways" for k in modes.kinds()]
    wire, length = line.contact_wire, line.spans[0].length
    string = wire.wave_speed / (2 * length)
    assert sum(sideways) >= 3
    assert modes.frequencies[sideways][0] == pytest.approx(string, rel=0.15)
    assert (modes.along + modes.sideways <= 1 + 1e-9).all()
    for number in np.flatnonzero(sideways):
        assert str(modes.kind(int(number))) == "sideways"
        assert modes.sideways[number] > 0.8
        aside, up = (np.abs(getattr(modes.contact, part)[number]).max() for part in ("lateral", "values"))
        assert aside > 2 * up
        assert modes.plot(int(number)).get_title(loc="left").endswith("sideways (seen from above)")


def test_in_the_plane_nothing_swings_sideways(line):
    modes = cf.solve_modes(cf.find_form(line.planar()), count=12)
    assert not modes.sideways.any()
    assert modes.contact.lateral is None
    assert "sideways" not in modes.count_by_kind()
