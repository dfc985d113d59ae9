"""Static states that are hard to find, or not there."""

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.fe import solver
from catenary_fe.fe.faults import place_of_heads


@pytest.fixture(scope="module")
def shape(layout):
    return cf.find_form(cf.load_catenary(layout))


def lifted(shape, force):
    return cf.solve_statics(shape, [(90.0, force)])


def test_a_force_that_needs_continuation(shape, monkeypatch):
    """20 kN in the middle of a span lift wires of 36 kN in all by 10 m: not found at once."""
    state = lifted(shape, 2e4)
    assert state.contact_wire_uplift.max() == pytest.approx(10.1, abs=0.1)
    highest = int(np.argmax(state.contact_wire_z))
    assert shape.contact_wire_x[highest] == pytest.approx(90, abs=0.5)
    monkeypatch.setattr(solver, "LOAD_STEPS", 1)
    with pytest.raises(cf.SolverError, match="no static equilibrium found"):
        lifted(shape, 2e4)


def test_an_equilibrium_is_the_same_with_and_without_continuation(shape, monkeypatch):
    at_once = lifted(shape, 2e3)
    settle = solver._settled
    monkeypatch.setattr(solver, "_settled", _only_stabilised(settle))
    assert lifted(shape, 2e3).contact_wire_z == pytest.approx(at_once.contact_wire_z, abs=1e-6)


def _only_stabilised(settle):
    """As if the first attempt, in one step, always failed."""
    calls = []

    def settled(mbs, load_steps=1):
        calls.append(load_steps)
        return settle(mbs, load_steps) if len(calls) % 3 != 1 else False

    return settled


def test_the_error_names_the_wire_and_the_place(shape, monkeypatch):
    monkeypatch.setattr(solver, "LOAD_STEPS", 1)
    with pytest.raises(cf.SolverError) as caught:
        lifted(shape, 1e5)
    text = str(caught.value)
    assert "static load (100000 N at 90 m)" in text
    assert "the solve ran away at" in text
    assert "under 20000 N" in text or "under 16000 N" in text
    assert "look there for tensions, lengths, stiffnesses or forces that are far from usual values" in text
    assert caught.value.partial is None


def test_places_in_words(shape):
    said = place_of_heads(shape.catenary, [44.2, 62.5])
    assert said == (
        "pantograph 1 at 44.2 m, in span 1, 15.8 m before support 2;"
        " pantograph 2 at 62.5 m, in span 2, 2.5 m behind support 2"
    )
