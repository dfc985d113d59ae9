"""Meshes: nodes where the loads are, no slivers, sizes as asked for."""

import hypothesis.strategies as st
import numpy as np
import pytest
from hypothesis import given, settings

import catenary_fe as cf
from catenary_fe.fe.mesh import make_mesh


def test_nodes_lie_on_droppers_and_supports(reference):
    mesh = make_mesh(reference, cf.MeshSettings())
    for wire, clamps in ((mesh.contact, mesh.lower), (mesh.messenger, mesh.upper)):
        assert wire.x[clamps.node] == pytest.approx(reference.dropper_positions, abs=1e-12)
        assert wire.x[wire.supports] == pytest.approx(reference.support_positions, abs=1e-12)


@settings(max_examples=200, deadline=None)
@given(
    st.lists(st.floats(0.05, 30), min_size=2, max_size=6),
    st.floats(0.3, 5),
    st.floats(0.1, 2),
    st.floats(1, 3),
)
def test_no_element_is_a_sliver(reference, gaps, largest, first, growth):
    at = np.cumsum(gaps)
    droppers = tuple(cf.Dropper(position=x) for x in at[:-1])
    line = reference.replace(
        spans=(cf.Span(length=at[-1], droppers=droppers),),
        supports=reference.supports[:2],
        evaluated_spans=None,
    )
    wish = cf.MeshSettings(contact_wire_element=largest, at_clamps=first, growth=growth)
    sizes = np.diff(make_mesh(line, wish).contact.x)
    assert sizes.sum() == pytest.approx(at[-1])
    assert sizes.max() <= largest * (1 + 1e-9)
    assert sizes.min() >= min(first, largest, min(gaps)) / 2 * (1 - 1e-9)


def test_halved_meshes_are_finer_everywhere(reference):
    coarse = make_mesh(reference, cf.MeshSettings()).contact.x.size
    fine = make_mesh(reference, cf.MeshSettings().halved()).contact.x.size
    assert 1.6 < fine / coarse < 2.2


@pytest.mark.parametrize(
    "wish", [{"contact_wire_element": 0.0}, {"at_clamps": -1.0}, {"growth": 0.5}, {"growth": np.nan}]
)
def test_bad_wishes(wish):
    with pytest.raises(cf.InputError, match="mesh: "):
        cf.MeshSettings(**wish)


def test_neighbouring_designs_share_stations_that_nobody_can_change(reference):
    wire = reference.contact_wire
    other = reference.replace(contact_wire=wire.replace(tension=1.1 * wire.tension))
    settings = cf.MeshSettings()
    first, second = (make_mesh(line, settings).contact.x for line in (reference, other))
    assert first is second
    with pytest.raises(ValueError, match="read-only"):
        first[0] = 1.0
    finer = cf.MeshSettings(contact_wire_element=settings.contact_wire_element / 2)
    assert make_mesh(reference, finer).contact.x.size > first.size
