"""The gauge of the wires' tension: closed form of a stretched wire, and of one that is lifted."""

import numpy as np
import pytest

from catenary_fe.engines.tension import TensionGauge


@pytest.fixture(scope="module")
def system(short_shape):
    return short_shape.system


def test_at_rest_the_wires_have_their_tension(system, short):
    tensions = TensionGauge(system).tensions(0 * system.reference)
    contact, messenger = np.split(tensions, 2)
    assert contact == pytest.approx(short.contact_wire.tension, rel=1e-4)
    # a wire that sags carries its horizontal pull over the cosine of its slope
    assert messenger == pytest.approx(short.messenger_wire.tension, rel=5e-4)
    assert (messenger > short.messenger_wire.tension).all()


def test_a_stretched_wire(system, short):
    """All nodes of the contact wire's last span move on by 0.1 ‰: EA times that, and no other span."""
    gauge, q = TensionGauge(system), 0 * system.reference
    before = gauge.tensions(q)
    wire, width = system.wires[0], 2 * system.axes
    first = int(wire.supports[-2])
    nodes = np.arange(first, wire.x.size)
    q[width * nodes] += 1e-4 * (wire.x[nodes] - wire.x[first])
    q[width * nodes + system.axes] += 1e-4
    change = gauge.tensions(q) - before
    assert change[3] == pytest.approx(1e-4 * short.contact_wire.axial_stiffness, rel=2e-3)
    # its first node's slope reaches into the element before
    assert np.abs(np.delete(change, [2, 3])).max() < 1e-6
    share, span = gauge.largest_change(before + change, before)
    assert share == pytest.approx([change[3] / before[3], 0], abs=1e-9)
    assert span[0] == 4
