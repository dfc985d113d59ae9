"""Static contact at the start of a linearised run: droppers may be slack, heads may be off the wire."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import Line
from catenary_fe.engines.compiled import plain
from catenary_fe.engines.kernels import stretch_forces
from catenary_fe.engines.linearised.setup import Setup
from catenary_fe.fe.reduction import ContactLine
from catenary_fe.layout import AnyPantograph, ElasticPantograph, InputError, SolverError

Floats = NDArray[np.float64]
_CHANGES = 50  # of what is slack or off the wire, and of the terms of second order
_SETTLED = 1e-9  # of the largest of all [m] and tensions [N], by which these may still change one


class Track(Protocol):
    """Contact wires that pantographs run along."""

    @property
    def contacts(self) -> tuple[ContactLine, ...]: ...

    @property
    def in_space(self) -> bool: ...


@dataclass(frozen=True)
class ContactPair:
    """One collector strip on one contact wire, and where it starts.

    ahead : [m] of the strip before the pantograph's position
    heave, roll : shape (coordinates,), height of the head there: as it heaves, and for each metre to the left
    force, wire_height : [N], [m] at the start, the height above the nominal one
    """

    wire: int
    ahead: float
    heave: Floats
    roll: Floats
    force: float = 0.0
    wire_height: float = 0.0


@dataclass(frozen=True)
class Substructure:
    """A pantograph: its matrices and contacts, and where it starts.

    M, K, D : shape (coordinates, coordinates): heights of strips, then of the other masses, then rolls
    masses : number of the heights
    load : shape (coordinates,), share of each in the uplift force
    preload : [N] force on a wire at the nominal height, of a pantograph without masses
    q : shape (coordinates,), at the start, heights above the nominal contact wire height
    """

    M: Floats
    K: Floats
    D: Floats
    masses: int
    load: Floats
    contact_stiffness: float
    contact_damping: float
    preload: float
    touches: tuple[ContactPair, ...]
    position: float = 0.0
    uplift: float = 0.0
    q: Floats = field(default_factory=lambda: np.zeros(0))


@dataclass(frozen=True)
class InitialState:
    """State in static contact: displacements q [m], shape (size,), and dropper forces [N]."""

    q: Floats
    bodies: list[Substructure]
    dropper_force: Floats
    speed: float


def static_contact(
    setup: Setup, pantographs: Sequence[AnyPantograph], uplifts: Floats, positions: Floats, speed: float
) -> InitialState:
    """Masses, contact forces, and wires in static equilibrium; steady arms that are links on their tangents.

    Raises SolverError where no consistent set of slack droppers is found, or terms of second order do not
    settle.
    """
    bodies = [
        replace(assemble_pantograph(setup.model, pantograph), uplift=float(uplift), position=float(position))
        for pantograph, uplift, position in zip(pantographs, uplifts, positions, strict=True)
    ]
    problem = _Contact(setup, bodies)
    slack: list[int] = []
    off: list[int] = []
    shifted = setup.static.solve(setup.line.load)
    for _ in range(_CHANGES):
        heads, forces, q, spring = problem.solve(slack, off, shifted)
        now = np.flatnonzero(spring <= 0).tolist()
        now_off = [j for j, force in enumerate(forces) if force < 0 or j in off]
        before, shifted = shifted, setup.static.solve(setup.line.load + stretch_loads(setup.line, q))
        if now == slack and now_off == off and np.abs(shifted - before).max() <= _SETTLED * np.abs(q).max():
            return InitialState(q, problem.started(heads, forces, q), np.maximum(spring, 0.0), speed)
        slack, off = now, now_off
    raise SolverError("static contact at the start: no equilibrium with a consistent set of slack droppers")


def stretch_loads(line: Line, q: Floats) -> Floats:
    """The terms of second order that steps have too, as a right side of K q = f: shape (size,).

    The kernel's ``couple_stretch_one`` does the same, but Python cannot call it.

    q : [m], and [N] where tensions are, shape (size,)
    """
    load = np.zeros_like(q)
    at, tension = line.stretch.at, line.tensions[line.stretch.gap]
    y, s, z, e = (np.where(i >= 0, q[i], 0.0) for i in at.T)
    arrays: Any = (line.stretch.length, y, s, z, e)
    across, first, last, longer = plain(stretch_forces)(*arrays)
    for place, force in zip(at.T, (-across, -first, across, -last), strict=True):
        free = place >= 0
        np.add.at(load, place[free], (q[tension] * force)[free])
    np.subtract.at(load, tension, longer)
    return load


class _Contact:
    """Masses, contact forces and what slack droppers lack, as one small linear system."""

    def __init__(self, setup: Setup, bodies: list[Substructure]) -> None:
        self._setup, self._bodies = setup, bodies
        self._first = np.cumsum([0, *(len(body.K) for body in bodies)])
        self._contacts = [(p, touch) for p, body in enumerate(bodies) for touch in body.touches]
        placed = [
            contact_row(setup, touch.wire, bodies[p].position + touch.ahead) for p, touch in self._contacts
        ]
        self._rows: Floats = np.array([row for row, _, _ in placed])
        self._rest = np.array([height for _, height, _ in placed])
        self._lateral = [lateral for _, _, lateral in placed]
        self._lifts = setup.static.solve(np.ascontiguousarray(self._rows.T)).reshape(-1, len(placed))

    def solve(
        self, slack: list[int], off: list[int], shifted: Floats
    ) -> tuple[Floats, Floats, Floats, Floats]:
        """Heads' coordinates, contact forces [N], displacements, and springs' forces of droppers [N].

        slack : numbers of the droppers without force
        off : numbers of the contacts off the wire
        shifted : shape (size,), displacements by terms of second order
        """
        model = self._setup.model
        pulls = model.dropper_rows[slack].toarray()
        rows = np.vstack([self._rows, pulls])
        gives = np.column_stack([self._lifts, self._setup.static.solve(np.ascontiguousarray(pulls.T))])
        total, count = int(self._first[-1]), len(self._contacts)
        A, right = np.zeros((total + len(rows),) * 2), np.zeros(total + len(rows))
        A[total:, total:] = rows @ gives
        for p, body in enumerate(self._bodies):
            part = slice(self._first[p], self._first[p + 1])
            A[part, part] = body.K
            right[part] = body.uplift * body.load
        for j in range(count):
            self._add_law(A, right, j, total + j, j in off, float(self._rows[j] @ shifted))
        for i, dropper in enumerate(slack):
            # T₀ + k e, with which a taut dropper would push, is taken off
            row = total + count + i
            A[row, total:] *= -model.dropper_stiffness[dropper]
            A[row, row] += 1.0
            stretch = float(pulls[i] @ shifted)
            right[row] = model.dropper_tension[dropper] + model.dropper_stiffness[dropper] * stretch
        solved: Floats = np.linalg.solve(A, right).astype(float)
        q: Floats = gives @ solved[total:] + shifted
        spring: Floats = model.dropper_tension + model.dropper_stiffness * (model.dropper_rows @ q)
        heads: Floats = solved[:total]
        forces: Floats = solved[total : total + count]
        return heads, forces, q, spring

    def _add_law(self, A: Floats, right: Floats, j: int, row: int, off: bool, raised: float) -> None:
        """The contact's law: wire's height + force / k = head's height; and its push on the head.

        raised : [m] of the wire there, whatever the contacts do
        """
        p, touch = self._contacts[j]
        body, part = self._bodies[p], slice(self._first[p], self._first[p + 1])
        head = touch.heave + self._lateral[j] * touch.roll
        A[part, row] = head
        k = body.contact_stiffness
        if off or not k:
            A[row], A[row, row], right[row] = 0.0, 1.0, 0.0 if off else body.preload
            return
        A[row, row] += 1 / k
        A[row, part] = -head
        right[row] = body.preload / k - self._rest[j] - raised

    def started(self, heads: Floats, forces: Floats, q: Floats) -> list[Substructure]:
        """The pantographs where they start."""
        wire = self._rest + self._rows @ q
        bodies = []
        for p, body in enumerate(self._bodies):
            touches = tuple(
                replace(touch, force=float(forces[j]), wire_height=float(wire[j]))
                for j, (owner, touch) in enumerate(self._contacts)
                if owner == p
            )
            bodies.append(replace(body, q=heads[self._first[p] : self._first[p + 1]], touches=touches))
        return bodies


def can_be_compiled(pantograph: AnyPantograph) -> bool:
    """Whether there is a :class:`Substructure` for it."""
    return not (isinstance(pantograph, ElasticPantograph) and pantograph.law)


def assemble_pantograph(model: Track, pantograph: AnyPantograph) -> Substructure:
    """A pantograph on a line's contact wires.

    Raises InputError for an elastic pantograph with a law that is not straight.
    """
    if isinstance(pantograph, ElasticPantograph):
        if not can_be_compiled(pantograph):
            raise InputError(
                f"{pantograph.name}: the linearised run takes elastic pantographs with a straight law (force"
                " and stiffness); use the nonlinear method for a law of points"
            )
        none, empty = np.zeros((0, 0)), np.zeros(0)
        force, stiffness = pantograph.tangent(0.0)
        touch = ContactPair(0, 0.0, empty, empty)
        return Substructure(none, none, none, 0, empty, stiffness, 0.0, force, (touch,))
    head, (first, *others) = pantograph.head, pantograph.stages
    strips = head.strips if head else 1
    rolls = strips if head and head.spring_distance and model.in_space else 0
    masses = strips + len(others)
    # each spring: from its mass to the next one, the last one to the base; the strips share the first stage's
    joints = np.eye(masses + rolls)
    springs = [first] * strips + others
    share = np.array([1 / strips] * strips + [1.0] * len(others) + [1 / strips] * rolls)
    for i in range(masses):
        below = strips if i < strips else i + 1
        if below < masses:
            joints[i, below] = -1.0
    lever = np.ones(masses + rolls)
    inertia = np.array([s.mass for s in springs] + [0.0] * rolls)
    if rolls:
        assert head is not None and head.spring_distance is not None
        springs = springs + [first] * rolls
        lever[masses:] = head.spring_distance**2 / 4
        inertia[masses:] = head.rolling_inertia(first.mass)
    factors = share * lever
    load = np.zeros(masses + rolls)
    load[masses - 1 if others else slice(strips)] = 1.0 if others else 1 / strips
    apart = head.strip_distance if head and head.strip_distance else 0.0
    heave = np.eye(masses + rolls)
    touches = tuple(
        ContactPair(
            wire,
            apart * (0.5 - i) if strips > 1 else 0.0,
            heave[i],
            heave[masses + i] if rolls else np.zeros(masses),
        )
        for i in range(strips)
        for wire in range(len(model.contacts))
    )
    return Substructure(
        M=np.diag(inertia * share),
        K=joints.T @ np.diag(factors * [s.stiffness for s in springs]) @ joints,
        D=joints.T @ np.diag(factors * [s.damping for s in springs]) @ joints,
        masses=masses,
        load=load,
        contact_stiffness=pantograph.contact_stiffness,
        contact_damping=pantograph.contact_damping,
        preload=0.0,
        touches=touches,
    )


def contact_row(setup: Setup, wire: int, position: float) -> tuple[Floats, float, float]:
    """The height over a position as a row of the coordinates; at rest: it, and the place to the left."""
    line = setup.model.contacts[wire]
    e = int(np.clip(np.searchsorted(line.x, position, side="right") - 1, 0, line.x.size - 2))
    xi, length = (position - line.x[e]) / (line.x[e + 1] - line.x[e]), line.lengths[e]
    shape = np.array(
        [
            1 - 3 * xi**2 + 2 * xi**3,
            length * (xi - 2 * xi**2 + xi**3),
            3 * xi**2 - 2 * xi**3,
            length * (xi**3 - xi**2),
        ]
    )
    index = line.index[e : e + 2].ravel()
    row = np.zeros(setup.model.size)
    row[index[index >= 0]] = shape[index >= 0]
    height, lateral = (shape @ values[e : e + 2].ravel() for values in (line.static, line.lateral))
    return row, float(height - setup.nominal), float(lateral)
