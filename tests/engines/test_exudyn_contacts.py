"""The moving contact on a system that only takes down what it is told; runs test what comes of it."""

from types import SimpleNamespace

import numpy as np
import pytest

from catenary_fe.engines.exudyn.contact import ContactParts, Contacts, WireParts
from catenary_fe.fe.contact import ContactPath

exu = pytest.importorskip("exudyn")


class Told:
    """What was set, and how often coordinates were numbered anew; the wire's places are given."""

    def __init__(self, damping=0.0, slope=0.02, sideways=0.3):
        self.set, self.numbered = {}, 0
        self._slope, self._sideways, self._damping = slope, sideways, [0.0, 0.0, damping]

    def SetMarkerParameter(self, marker, name, value):  # noqa: N802
        self.set[marker, name] = value

    SetObjectParameter = SetMarkerParameter

    def GetMarkerParameter(self, marker, name):  # noqa: N802
        return self.set.get((marker, name), -1)

    def GetObjectParameter(self, number, name):  # noqa: N802
        return self.set.get((number, name), self._damping)

    def AssembleLTGLists(self):  # noqa: N802
        self.numbered += 1

    def GetObjectOutputBody(self, body, what, place):  # noqa: N802
        assert place[1:] == [0, 0]
        if what == exu.OutputVariableType.Position:
            return [body + place[0], self._sideways, 7.0]
        return [2.0, 3.0, 2.0 * self._slope]

    def GetObjectOutput(self, number, what):  # noqa: N802
        assert what == exu.OutputVariableType.Force
        return [1, 2, 120 + number]


def contact(connector=0, ahead=0.0, rolls=False):
    return ContactParts(
        wire=0, ahead=ahead, strip=None, wire_marker=100 + connector, strip_marker=200 + connector,
        rolls=rolls, connector=connector,
    )  # fmt: skip


def moving(*contacts, damping=0.0):
    x, lengths = np.array([0.0, 1.0, 3.0, 6.0]), np.array([1.01, 2.02, 3.03])
    none, wire = np.zeros((4, 2)), WireParts("contact wire", [], [10, 11, 12], x)
    index = np.zeros((4, 2), dtype=np.int64)
    path = ContactPath(x, lengths, none, none, index, index, np.array([0, 3]))
    told, system = Told(damping), SimpleNamespace(contact_paths=(path,), axes=3)
    return told, Contacts(told, system, [wire], [SimpleNamespace(contacts=list(contacts))])


@pytest.mark.parametrize(
    ("position", "body", "local"),
    [
        (0.0, 10, 0.0), (0.5, 10, 0.505), (1.0, 11, 0.0), (2.0, 11, 1.01), (6.0, 12, 3.03),
    ],
)  # fmt: skip
def test_places_on_a_wire(position, body, local):
    told, contacts = moving(contact())
    contacts.move_to([position], 80.0)
    assert told.set[100, "bodyNumber"] == body
    assert told.set[100, "localPosition"] == pytest.approx([local, 0, 0])


def test_beyond_the_ends_of_its_wire_a_contact_does_not_act():
    touched = contact()
    told, contacts = moving(touched)
    for position, on in ((-0.5, False), (0.5, True), (7.5, False), (5.0, True)):
        contacts.move_to([position], 80.0)
        assert contacts.meets(touched) is on
        assert contacts.force(touched) == (120 if on else 0.0)
    assert told.set[0, "activeConnector"] is True


def test_a_contact_moves_from_element_to_element():
    told, contacts = moving(contact())
    for position, body, local, numbered in ((1.5, 11, 0.505, 1), (2.0, 11, 1.01, 1), (4.5, 12, 1.515, 2)):
        contacts.move_to(np.array([position]), 80.0)
        assert told.set[100, "bodyNumber"] == body
        assert told.set[100, "localPosition"] == pytest.approx([local, 0, 0])
        assert told.numbered == numbered  # anew only where the element is another
    assert set(told.set) == {(100, "bodyNumber"), (100, "localPosition")}


def test_strips_run_ahead_and_behind():
    told, contacts = moving(contact(0, ahead=0.25), contact(1, ahead=-0.25))
    contacts.move_to(np.array([1.0]), 80.0)
    assert [told.set[m, "bodyNumber"] for m in (100, 101)] == [11, 10]
    assert told.set[100, "localPosition"] == pytest.approx([0.2525, 0, 0])
    assert told.set[101, "localPosition"] == pytest.approx([0.7575, 0, 0])


def test_a_rolling_head_is_touched_where_the_wire_is():
    rolls = contact(rolls=True)
    told, contacts = moving(rolls)
    contacts.move_to(np.array([1.5]), 80.0)
    assert told.set[200, "localPosition"] == [0, 0.3, 0]
    assert contacts.lateral(rolls) == 0.3
    assert contacts.lateral(contact()) == 0.0


def test_a_damped_contact_sees_the_inclination():
    told, contacts = moving(contact(), damping=20.0)
    contacts.move_to(np.array([1.5]), 80.0)
    assert told.set[0, "damping"] == pytest.approx([80.0 * 0.02, 0.0, 20.0])
    assert contacts.force(contact()) == 120.0
