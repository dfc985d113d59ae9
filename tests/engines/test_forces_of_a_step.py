"""Forces and records of a linearised run's steps, each against its law and the equations of motion.

The state before a step is any: droppers slacken in all ways, contacts are lost, arms swing far. Short enough
to run without a compiler (NUMBA_DISABLE_JIT=1), as mutation testing does.
"""

from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np
import pytest
from kernels import entry, feel
from scipy.sparse.linalg import spsolve

import catenary_fe as cf
from catenary_fe.engines.compiled import plain
from catenary_fe.engines.generalized_alpha import advance
from catenary_fe.engines.linearised.batch import Batch
from catenary_fe.engines.linearised.forces import update_arm, update_dropper
from catenary_fe.engines.linearised.setup import Setup
from catenary_fe.engines.linearised.start import contact_row, static_contact, stretch_loads
from catenary_fe.engines.recorder import InitialState, Sizes
from catenary_fe.fe.contact import place
from catenary_fe.studies.linearised import LinearisedLine

SPEED, STEPS = 80.0, 4  # [m/s], steps of 1 ms


class State(NamedTuple):
    """Coordinates at a step's end, of wires or of heads, their rates and accelerations."""

    q: np.ndarray
    v: np.ndarray
    x: np.ndarray


class Step(NamedTuple):
    """A step that was taken: what was known before it, where it led, and its forces.

    before : q*, v* and c of wires and heads
    last : q*, v*, c and x of the heads at the end of the step before
    """

    before: tuple
    wires: State
    heads: State
    last: tuple
    tension: np.ndarray
    force: np.ndarray
    slack: np.ndarray
    swing: np.ndarray


class History(NamedTuple):
    """Steps from states that are any, and their records."""

    setup: Setup
    start: InitialState
    steps: list[Step]
    slots: Batch

    @property
    def contacts(self):
        """Each strip on each wire."""
        return self.start.contacts

    def body(self, j):
        """What the pantograph of a contact is made of."""
        return self.start.pantographs[self.contacts[j].pantograph].body

    def over(self, j, n, shift=0.0):
        """Row of the wire's height over a contact in a step; at rest: it, and the place to the left."""
        contact = self.contacts[j]
        return contact_row(self.setup, contact.wire, contact.position + SPEED * 1e-3 * (n + 1) + shift)

    def head(self, j, n):
        """Row of the head's height at a contact."""
        contact, body = self.contacts[j], self.body(j)
        row = np.zeros(self.slots.pantographs.x.shape[1:])
        _, _, lateral = self.over(j, n)
        row[contact.pantograph, : body.size] = body.row(contact.strip, lateral)
        return row


def law(spring, damper):
    """Force of a spring and damper that act one way."""
    return np.where(spring > 0, spring + np.clip(damper, -spring, spring), 0.0)


def step_back(scheme, q, v, c, x):
    """In place, from what is to be predicted for a step's end to a state that it is predicted from."""
    x[:] = 0.0
    c /= scheme.cc
    v -= scheme.vc * c
    q -= scheme.h * v + scheme.qc * c


def disturb(rng, setup, start, slots, slackening):
    """From the start, droppers, links and heads by as much as makes them leave their tangents."""
    line, rows, heads = setup.line, setup.model.dropper_rows.T, slots.pantographs
    q, v, c, x, _ = (array[:, 0] for array in slots.wires)
    size = rows.shape[1]
    q[:] = start.q + slackening * rows @ (rng.uniform(-1, 0.5, size) * 1e-3)
    q[line.links.at] += rng.uniform(-1, 1, line.links.at.shape) * [5e-4, 0.03]
    shortening = rng.uniform(-1, 1, size) * line.tension / line.d
    v[:] = rng.normal(0, 0.05, v.size) + slackening * rows @ shortening
    c[:] = rng.normal(0, 1.0, c.size)
    step_back(setup.scheme, q, v, c, x)
    for p, placed in enumerate(start.pantographs):
        size = placed.body.size
        part = 0, p, slice(size)
        heads.q[part] = placed.heights + rng.uniform(-2e-3, 2e-3, size)
        heads.v[part], heads.c[part] = rng.uniform(-2, 2, (2, size))
        step_back(setup.scheme, *(array[part] for array in heads[:4]))


def take(setup, slots):
    """One step."""
    wires, heads, work, b, g = slots.wires, slots.pantographs, slots.work, setup.scheme.b, setup.scheme.g
    tension, last = work.tension[:, 0].copy(), [array[0].copy() for array in heads[:4]]
    slots.advance(1)
    before = [[array[:, 0].copy() for array in wires[:3]], [array[0].copy() for array in heads[:3]]]
    ends = [
        State(q + b * x, v + g * x, x.copy())
        for (q, v, _), x in zip(before, (wires.x[:, 0], heads.x[0]), strict=True)
    ]
    forces = (array[0].copy() for array in (work.force, work.slack, work.arm_force))
    return Step(before, *ends, last, tension, *forces)


def travel(setup, pantographs, places, every, slackening=1.0):
    uplifts = np.full(len(places), 60.0)
    placed = place(pantographs, uplifts, np.array(places), spatial=setup.model.spatial)
    start = static_contact(setup, placed, SPEED)
    sizes = Sizes(
        pantographs=len(places) + 1, contacts=9, coordinates=6, steps=STEPS, shapes=STEPS + 1, points=3
    )
    slots, rng, steps = Batch(setup, sizes, 1, every), np.random.default_rng(5), []
    slots.load(0, start, STEPS)
    for _ in range(STEPS):
        disturb(rng, setup, start, slots, slackening)
        steps.append(take(setup, slots))
    return History(setup, start, steps, slots)


@pytest.fixture(scope="module")
def elastic():
    return cf.ElasticPantograph(force=50.0, stiffness=1000.0)


@pytest.fixture(scope="module")
def twin_setup(twin_shape):
    return LinearisedLine(twin_shape).engine.setup


@pytest.fixture(scope="module")
def in_space(twin_setup, pantograph, elastic, rolling_head):
    rolls = pantograph.replace(head=rolling_head, contact_damping=80.0)
    return travel(twin_setup, [elastic, pantograph, rolls], [75.0, 62.0, 52.0], 2)


@pytest.fixture(scope="module")
def one_link(twin_setup, pantograph):
    """But for two contacts all that acts, the other one being on its tangent."""
    return travel(with_links(twin_setup, 1), [pantograph], [52.0], 1, slackening=0.0)


@pytest.fixture(scope="module")
def two_contacts(twin_setup, pantograph):
    """All that acts, of one head."""
    return travel(with_links(twin_setup, 0), [pantograph], [52.0], 1, slackening=0.0)


def with_links(setup, count):
    """Only the first links leave their tangents."""
    links = setup.line.links
    kept = links._replace(**{name: getattr(links, name)[:count] for name in ("at", "span", "length", "k")})
    return replace(setup, line=setup.line._replace(links=kept))


@pytest.fixture(scope="module")
def plane_setup(plane_shape):
    return LinearisedLine(plane_shape).engine.setup


@pytest.fixture(scope="module")
def in_the_plane(plane_setup, pantograph, elastic):
    """The first pantograph where the line begins, where a slope is the first of all coordinates."""
    return travel(plane_setup, [pantograph.replace(contact_damping=40.0), elastic], [0.1, 70.0], 0)


@pytest.fixture(scope="module")
def one_contact(plane_setup, pantograph):
    """All that acts, so its force is solved for once, how wire and head give being exact."""
    pushing = pantograph.replace(contact_damping=20.0)
    return travel(plane_setup, [pushing], [70.0], 0, slackening=0.0)


@pytest.fixture(
    scope="module", params=["in_space", "one_link", "two_contacts", "in_the_plane", "one_contact"]
)
def history(request):
    return request.getfixturevalue(request.param)


def test_wires_move_as_forces_have_it(history):
    """M a + D v + K q = f at the step's end, f being the contacts' and what is nonlinear."""
    setup, line, model = history.setup, history.setup.line, history.setup.model
    matrix = (model.mass + setup.scheme.g * model.damping + setup.scheme.b * model.stiffness).tocsc()
    others = np.delete(np.arange(model.size), line.tensions)
    for n, step in enumerate(history.steps):
        q, v, _ = step.before[0]
        tensed = q.copy()
        tensed[line.tensions] = step.tension  # terms of second order take it from the step before
        load = stretch_loads(line, tensed) - model.damping @ v - model.stiffness @ q
        load += sum(step.force[j] * history.over(j, n)[0] for j in range(len(history.contacts)))
        load += model.dropper_rows.T @ step.slack
        load[line.links.at] += step.swing
        x = spsolve(matrix, load)
        for part, share in ((others, 1e-5), (line.tensions, 5e-5)):  # [m/s²], [N/s²]
            assert step.wires.x[part] == pytest.approx(x[part], abs=share * np.abs(x[part]).max())


def test_heads_move_as_forces_have_it(history):
    for n, step in enumerate(history.steps):
        pushed = sum(step.force[j] * history.head(j, n) for j in range(len(history.contacts)))
        for p, placed in enumerate(history.start.pantographs):
            body, part = placed.body, (p, slice(placed.body.size))
            q, v, x = (array[part] for array in step.heads)
            forces = body.mass @ x + body.damping @ v + body.stiffness @ q + pushed[part]
            assert forces == pytest.approx(placed.uplift * body.load, abs=1e-6)
        predicted = plain(advance)(history.setup.scheme, *step.last)
        for mine, other in zip(step.before[1], predicted, strict=True):
            assert mine == pytest.approx(other, abs=1e-12)


def contact_parts(history, n, j):
    """Spring's and damper's force [N] of a contact, as if it could pull."""
    step, contact = history.steps[n], history.body(j).contact
    row, rest, _ = history.over(j, n)
    ahead, behind = (history.over(j, n, shift) for shift in (1e-5, -1e-5))
    inclination = ((ahead[0] - behind[0]) @ step.wires.q + ahead[1] - behind[1]) / 2e-5
    head = history.head(j, n)
    gap = (head * step.heads.q).sum() - row @ step.wires.q - rest
    closing = (head * step.heads.v).sum() - row @ step.wires.v - SPEED * inclination
    return contact.stiffness * gap + contact.preload, contact.damping * closing


def test_contacts_follow_their_law(history):
    for n, step in enumerate(history.steps):
        for j in range(len(history.contacts)):
            assert step.force[j] == pytest.approx(law(*contact_parts(history, n, j)), abs=1e-5)
        assert np.array_equal(history.slots.records.force[0, :, n + 1], step.force)


def dropper_parts(history, step):
    """Springs' and dampers' forces [N] of droppers, as if they could push."""
    line, rows = history.setup.line, history.setup.model.dropper_rows
    return line.tension + line.k * (rows @ step.wires.q), line.d * (rows @ step.wires.v)


def test_droppers_follow_their_law(history):
    line, records, work = history.setup.line, history.slots.records, history.slots.work
    shortening = np.zeros((STEPS + 1, line.k.size))
    for n, step in enumerate(history.steps, start=1):
        spring, damper = dropper_parts(history, step)
        force = law(spring, damper)
        assert step.slack == pytest.approx(spring + damper - force, abs=1e-8)
        assert records.droppers[0, :, n] == pytest.approx(force, abs=1e-8)
        shortening[n] = np.maximum(-spring / line.k, 0.0)
    assert records.shortening[0] == pytest.approx(shortening.max(axis=0), abs=1e-12)
    assert np.array_equal(records.shortened[0], shortening.argmax(axis=0))
    changed = np.flatnonzero(np.abs(step.slack) > 1e-9)  # the next step begins with them
    assert sorted(work.active[0, : work.active_count[0]]) == changed.tolist()


def test_the_states_were_of_all_kinds(in_space, one_link):
    contacts = [contact_parts(in_space, n, j) for n in range(STEPS) for j in range(len(in_space.contacts))]
    droppers = [dropper_parts(in_space, step) for step in in_space.steps]
    for spring, damper in (np.transpose(contacts), np.hstack(droppers)):
        assert (spring <= 0).any()
        for some in (damper < -spring, (damper != 0) & (np.abs(damper) < spring), damper > spring):
            assert (some & (spring > 0)).any()
    for step in one_link.steps:
        assert not step.slack.any()


def test_links_pull_along_themselves(in_space, one_link):
    for history in (in_space, one_link):
        links = history.setup.line.links
        for step in history.steps:
            beyond = beyond_tangent(links, step.wires.q[links.at])
            assert np.abs(beyond).max() > 10
            assert step.swing == pytest.approx(beyond, abs=2e-3)


@pytest.mark.parametrize(("y", "z"), [(0.0, 0.1), (0.05, 0.3), (0.0, 0.4), (0.1, -0.1)])
def test_the_last_step_to_the_circle_squares_the_error(twin_setup, y, z):
    """As Newton's do if derivatives are right: what is left is far below the tolerance of 1 mN."""
    setup, links = twin_setup, twin_setup.line.links
    slots = Batch(setup, Sizes(1, 1, 1, 1), 1)
    slots.wires.q[links.at[0], 0] = y, z
    change = entry(update_arm)(setup.scheme, setup.line, slots.wires, slots.work, 0, 0)
    feel(slots.wires, links.compliance, change)
    moved = (slots.wires.q + setup.scheme.b * slots.wires.x)[links.at, 0]
    assert slots.work.arm_force[0, 0] == pytest.approx(beyond_tangent(links, moved)[0], abs=1e-6)


def beyond_tangent(links, moved):
    """Forces of links whose ends have moved beyond those of their tangents at rest."""
    tangents = []
    for span, length, k in zip(links.span, links.length, links.k, strict=True):
        far = np.linalg.norm(span)
        along = np.outer(span, span) / far**2
        tangents.append(-k * (along + (1 - length / far) * (np.eye(2) - along)))
    still = np.zeros_like(moved)
    return pull(links, moved) - pull(links, still) - np.einsum("nij,nj->ni", tangents, moved)


def pull(links, moved):
    """Forces of links whose ends have moved."""
    towards = links.span - moved
    far = np.linalg.norm(towards, axis=1)
    return (links.k * (far - links.length) / far)[:, None] * towards


def test_a_step_is_recorded_where_it_ends(history):
    line, records = history.setup.line, history.slots.records
    changes = [np.zeros(line.tensions.size)]
    supports, nodes = np.flatnonzero(line.supports >= 0), np.flatnonzero(line.heights >= 0)
    for n, step in enumerate(history.steps, start=1):
        q = step.wires.q
        for j in range(len(history.contacts)):
            row, rest, _ = history.over(j, n - 1)
            assert records.height[0, j, n] == pytest.approx(row @ q + rest, abs=1e-12)
        assert records.masses[0, :, :, n] == pytest.approx(step.heads.q, abs=1e-12)
        assert records.supports[0, supports, n] == pytest.approx(q[line.supports[supports]], abs=1e-12)
        changes.append(np.abs(q[line.tensions]))
        if records.every and n % records.every == 0:
            shape = records.wire[0, n // records.every, nodes]
            assert shape == pytest.approx(q[line.heights[nodes]], abs=1e-12)
    assert np.max(changes) > 10  # [N]
    assert records.change[0] == pytest.approx(np.max(changes, axis=0), abs=1e-9)
    assert np.array_equal(records.changed[0], np.argmax(changes, axis=0))
    fixed = np.delete(np.arange(line.supports.size), supports)
    assert not records.supports[0, fixed].any()
    assert not np.delete(records.wire[0], nodes, axis=1).any()


def test_a_dropper_that_gives_much_is_brought_to_its_law(twin_setup):
    """A force on it changes spring and damper by up to what the dropper would take itself."""
    for spring, damper in product((-30.0, 20.0, 50.0), (-80.0, -30.0, 15.0, 45.0, 80.0)):
        for cs, cd in ((0.02, 0.4), (0.02, 0.5)):
            one = Dropper(twin_setup, cs, cd)
            one.is_moved_to(spring, damper)
            ended = one.relaxed()
            assert sum(ended) - one.taken == pytest.approx(law(*ended), abs=1e-4)


@pytest.mark.parametrize(("spring", "damper"), [(500.0, 100.0), (0.5, 0.3), (0.5, -0.3)])
def test_a_dropper_that_is_taut_again_has_nothing_taken_off(twin_setup, spring, damper):
    one = Dropper(twin_setup, 0.02, 0.4)
    one.is_moved_to(-30.0, -20.0)
    one.relaxed()
    assert one.taken != 0
    one.is_moved_to(spring, damper)
    assert one.relaxed() == pytest.approx((spring, damper), abs=1e-4)
    assert one.taken == 0


class Dropper:
    """The fourth one, with such stiffness and damping that 1 N on it changes its forces by cs and cd."""

    def __init__(self, setup, cs, cd):
        self.scheme, self.i, self.gives = setup.scheme, 3, (cs, cd)
        self.row = setup.model.dropper_rows[self.i].toarray()[0]
        softness = self.row @ setup.factor.solve(self.row)
        self.k, self.d = (c / softness / step for c, step in ((cs, self.scheme.b), (cd, self.scheme.g)))
        line = setup.line
        self.line = line._replace(k=np.full_like(line.k, self.k), d=np.full_like(line.d, self.d))
        self.slots = Batch(setup, Sizes(1, 1, 1, 1), 1)

    @property
    def taken(self):
        return self.slots.work.slack[0, self.i]

    def is_moved_to(self, spring, damper):
        """Where it would have these forces with nothing taken off."""
        at = self.row / (self.row @ self.row)
        self.slots.wires.q[:, 0] = at * (spring - self.line.tension[self.i]) / self.k
        self.slots.wires.v[:, 0] = at * damper / self.d
        self._at = spring, damper

    def relaxed(self):
        """Its spring's and damper's force after having been brought to its law."""
        wires, work = self.slots.wires, self.slots.work
        change = entry(update_dropper)(self.scheme, self.line, wires, work, 0, self.i)
        feel(wires, self.line.dropper_compliance, [change], self.i)
        return tuple(force + c * self.taken for force, c in zip(self._at, self.gives, strict=True))
