"""The moving contact on a system that only takes down what it is told; runs test what comes of it."""

from types import SimpleNamespace

import numpy as np
import pytest

import catenary_fe as cf

exu = pytest.importorskip("exudyn")

from catenary_fe.engines.exudyn.contact import MovingContact, locate  # noqa: E402


class Told:
    """What was set, and how often coordinates were numbered anew; the wire's places are given."""

    def __init__(self, slope=0.02, sideways=0.3):
        self.set, self.numbered, self.height = {}, 0, 0.0
        self._slope, self._sideways = slope, sideways

    def SetMarkerParameter(self, marker, name, value):  # noqa: N802
        self.set[marker, name] = value

    def SetObjectParameter(self, number, name, value):  # noqa: N802
        self.set[number, name] = value

    def AssembleLTGLists(self):  # noqa: N802
        self.numbered += 1

    def GetObjectOutputBody(self, body, what, place):  # noqa: N802
        assert place[1:] == [0, 0]
        if what == exu.OutputVariableType.Position:
            return [body + place[0], self._sideways, 7.0]
        return [2.0, 3.0, 2.0 * self._slope]

    def GetObjectOutput(self, number, what):  # noqa: N802
        if what == exu.OutputVariableType.Force:
            return [1, 2, 120 + number]
        return [5.0, 6.0, -self.height]


def contact(connector=0, ahead=0.0, rolls=False):
    line = SimpleNamespace(x=np.array([0.0, 1.0, 3.0, 6.0]), lengths=np.array([1.01, 2.02, 3.03]))
    wire = SimpleNamespace(line=line, elements=[10, 11, 12], up=2)
    return SimpleNamespace(
        connector=connector, wire_marker=100 + connector, head_marker=200 + connector, wire=wire,
        ahead=ahead, rolls=rolls,
    )  # fmt: skip


def moving(pantograph, *contacts):
    told = Told()
    items = SimpleNamespace(pantograph=pantograph, contacts=list(contacts))
    return told, items, MovingContact(SimpleNamespace(mbs=told), [items])


@pytest.mark.parametrize(
    ("position", "element", "local"),
    [
        (0.0, 0, 0.0), (0.5, 0, 0.505), (1.0, 1, 0.0), (2.0, 1, 1.01), (6.0, 2, 3.03),
        (-0.5, 0, -0.505), (7.5, 2, 4.545),
    ],
)  # fmt: skip
def test_places_on_a_wire(position, element, local):
    found = locate(contact().wire, position)
    assert found == (element, pytest.approx(local))


def test_a_contact_moves_from_element_to_element(pantograph):
    told, _, contacts = moving(pantograph, contact())
    for position, body, local, numbered in ((1.5, 11, 0.505, 1), (2.0, 11, 1.01, 1), (4.5, 12, 1.515, 2)):
        contacts.move_to(np.array([position]), 80.0)
        assert told.set[100, "bodyNumber"] == body
        assert told.set[100, "localPosition"] == pytest.approx([local, 0, 0])
        assert told.numbered == numbered  # anew only where the element is another
    assert set(told.set) == {(100, "bodyNumber"), (100, "localPosition")}


def test_strips_run_ahead_and_behind(pantograph):
    told, _, contacts = moving(pantograph, contact(0, ahead=0.25), contact(1, ahead=-0.25))
    contacts.move_to(np.array([1.0]), 80.0)
    assert [told.set[m, "bodyNumber"] for m in (100, 101)] == [11, 10]
    assert told.set[100, "localPosition"] == pytest.approx([0.2525, 0, 0])
    assert told.set[101, "localPosition"] == pytest.approx([0.7575, 0, 0])


def test_a_rolling_head_is_touched_where_the_wire_is(pantograph):
    told, _, contacts = moving(pantograph, contact(rolls=True))
    contacts.move_to(np.array([1.5]), 80.0)
    assert told.set[200, "localPosition"] == [0, 0.3, 0]


def test_a_damped_contact_sees_the_inclination(pantograph):
    told, items, contacts = moving(pantograph.replace(contact_damping=20.0), contact())
    contacts.move_to(np.array([1.5]), 80.0)
    assert told.set[0, "damping"] == pytest.approx([80.0 * 0.02, 0.0, 20.0])
    assert contacts.inclination(items.contacts[0]) == pytest.approx(0.02)
    forces = contacts.forces(items)
    assert (forces.tolist(), forces.dtype) == ([120.0], float)


def test_an_elastic_pantograph_follows_its_law_a_step_ahead():
    law = ((0.0, 200.0), (0.1, 100.0), (0.3, 0.0))
    told, _, contacts = moving(cf.ElasticPantograph(law=law), contact())
    told.height = 0.04
    contacts.move_to(np.array([1.5]), 80.0)  # from 0 to 40 mm: 80 mm are expected
    assert (0, "stiffness") not in told.set  # the same piece as at the start
    told.height = 0.08
    contacts.move_to(np.array([1.6]), 80.0)  # 120 mm are expected: the next piece, 150 N - 500 N/m
    assert told.set[0, "stiffness"] == pytest.approx([0.0, 0.0, 500.0])
    assert told.set[0, "damping"] == pytest.approx([150.0, 0, 0])


TWO_PIECES = ((0.0, 400.0), (0.1, 300.0), (0.3, 0.0))


def settled(rest, yielding):
    """Law and wire brought together: force [N], height [m] and how often the wire was solved.

    The wire rises by ``yielding`` metres a newton from ``rest``.
    """
    pantograph = cf.ElasticPantograph(law=TWO_PIECES)
    told, _, contacts = moving(pantograph, contact())
    told.set[0, "stiffness"], told.set[0, "damping"] = [0.0, 0.0, 1000.0], [400.0, 0, 0]
    count = 0

    def solve():  # the wire under F₀ - k z
        nonlocal count
        count += 1
        k, force = told.set[0, "stiffness"][2], told.set[0, "damping"][0]
        told.height = (rest + yielding * force) / (1 + yielding * k)

    solve()
    contacts.settle_laws(solve)
    force = told.set[0, "damping"][0] - told.set[0, "stiffness"][2] * told.height
    assert force == pytest.approx(pantograph.contact_force(told.height), abs=1e-6)
    assert told.height == pytest.approx(rest + yielding * force)
    return force, told.height, count


@pytest.mark.parametrize(
    ("rest", "yielding", "solves"),
    [(0.05, 1e-4, 1), (0.05, 2e-3, 2), (0.05, 1e-2, 48), (0.0705, 1e-4, 2), (0.4, 1e-4, 2)],
)
def test_the_law_and_the_wire_meet(rest, yielding, solves):
    force, _, count = settled(rest, yielding)
    assert (force == 0) == (rest > 0.3)
    assert count == solves  # once with each straight piece; where two chase each other, by halving


@pytest.mark.parametrize(("rest", "yielding"), [(0.05, 1e-2), (0.0705, 1e-4), (0.4, 1e-4)])
def test_pieces_that_alternate_are_halved(monkeypatch, rest, yielding):
    """Without a try of straight pieces, which would find these."""
    from catenary_fe.engines.exudyn import contact as module

    before = settled(rest, yielding)[:2]
    monkeypatch.setattr(module, "_PIECES", 0)
    assert settled(rest, yielding)[:2] == pytest.approx(before)
