"""Static states that are hard to find, or not there."""

import re

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.engines.faults import place_of_heads
from catenary_fe.statics import loaded, newton
from catenary_fe.statics.loaded import LoadedLine


@pytest.fixture(scope="module")
def shape(layout):
    return cf.find_form(cf.load_catenary(layout))


def lifted(shape, force):
    return cf.solve_statics(shape, [(90.0, force)])


def test_a_force_that_lifts_wires_by_metres(shape):
    """20 kN in the middle of a span, under wires of 36 kN in all."""
    state = lifted(shape, 2e4)
    assert state.contact_wire_uplift.max() == pytest.approx(10.1, abs=0.1)
    highest = int(np.argmax(state.contact_wire_z))
    assert shape.contact_wire_x[highest] == pytest.approx(90, abs=0.5)


def test_an_equilibrium_is_the_same_at_once_and_in_steps(shape, monkeypatch):
    at_once = lifted(shape, 2e3)
    newton = LoadedLine._newton
    calls = []

    def first_fails(line, moved, load):
        calls.append(load.max())
        found, residual = newton(line, moved, load)
        return (found, load) if len(calls) == 1 else (found, residual)

    monkeypatch.setattr(LoadedLine, "_newton", first_fails)
    assert lifted(shape, 2e3).contact_wire_z == pytest.approx(at_once.contact_wire_z, abs=1e-6)
    assert len(calls) == 1 + loaded._LOAD_STEPS
    assert calls[1] == pytest.approx(calls[0] / loaded._LOAD_STEPS)


def test_the_error_names_the_wire_and_the_place(shape, monkeypatch):
    monkeypatch.setattr(newton, "_ITERATIONS", 2)
    with pytest.raises(cf.SolverError) as caught:
        lifted(shape, 1e5)
    text = str(caught.value)
    assert "static load (100000 N at 90 m)" in text
    assert re.search(r"[\d.e+]+ N are left at the contact wire at \d+\.\d m", text)
    assert "try a smaller force, and look there for stiffnesses and tensions" in text
    assert caught.value.partial is None


def test_places_in_words(shape):
    said = place_of_heads(shape.catenary.support_positions, [44.2, 62.5])
    assert said == (
        "pantograph 1 at 44.2 m, in span 1, 15.8 m before support 2;"
        " pantograph 2 at 62.5 m, in span 2, 2.5 m behind support 2"
    )
