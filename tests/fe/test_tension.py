"""The gauge of the wires' tension: closed form of a stretched wire, and of one that is lifted."""

import numpy as np
import pytest

from catenary_fe.engines.exudyn.model import build_model
from catenary_fe.engines.exudyn.solver import release, solve_static
from catenary_fe.engines.tension import TensionGauge


def gauge_of(model):
    return TensionGauge(model.system)


@pytest.fixture(scope="module")
def model(short_shape):
    built = build_model(short_shape.catenary, short_shape.mesh, short_shape.installation)
    built.mbs.Assemble()
    solve_static(built.mbs, what="test")
    yield built
    release(built.mbs)


def test_at_rest_the_wires_have_their_tension(model, short):
    tensions = gauge_of(model).tensions(model.mbs.systemData.GetODE2Coordinates())
    contact, messenger = np.split(tensions, 2)
    assert contact == pytest.approx(short.contact_wire.tension, rel=1e-4)
    # a wire that sags carries its horizontal pull over the cosine of its slope
    assert messenger == pytest.approx(short.messenger_wire.tension, rel=5e-4)
    assert (messenger > short.messenger_wire.tension).all()


def test_a_stretched_wire(model, short):
    """All nodes of the contact wire's last span move on by 0.1 ‰: EA times that, and no other span."""
    gauge, q = gauge_of(model), model.mbs.systemData.GetODE2Coordinates().copy()
    before = gauge.tensions(q)
    x, width, ends = model.contact.line.x, model.node_width, model.mesh.wires[0].supports
    first = int(ends[-2])
    nodes = np.arange(first, x.size)
    q[width * nodes] += 1e-4 * (x[nodes] - x[first])
    q[width * nodes + model.axes] += 1e-4
    change = gauge.tensions(q) - before
    assert change[3] == pytest.approx(1e-4 * short.contact_wire.axial_stiffness, rel=2e-3)
    # its first node's slope reaches into the element before
    assert np.abs(np.delete(change, [2, 3])).max() < 1e-6
    share, span = gauge.largest_change(before + change, before)
    assert share == pytest.approx([change[3] / before[3], 0], abs=1e-9)
    assert span[0] == 4
