"""Static contact at the start of a linearised run: droppers may be slack, heads may be off the wire."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.compiled import plain
from catenary_fe.engines.contact_solver import solve_points
from catenary_fe.engines.linearised.arrays import Line
from catenary_fe.engines.linearised.setup import Setup
from catenary_fe.engines.linearised.stretch import stretch_forces
from catenary_fe.engines.recorder import InitialState
from catenary_fe.fe.contact import PlacedPantograph, contacts_of
from catenary_fe.layout import SolverError

Floats = NDArray[np.float64]
_CHANGES = 50  # of what is slack or off the wire, and of the terms of second order
_SETTLED = 1e-9  # of the largest of all [m] and tensions [N], by which these may still change one


def static_contact(
    setup: Setup, pantographs: Sequence[PlacedPantograph], speed: float, signals: Floats | None = None
) -> InitialState:
    """Masses, contact forces, and wires in static equilibrium; steady arms that are links on their tangents.

    signals : shape (loads,), of loads that vary in time, at the start; unset: 0

    Raises SolverError where no consistent set of slack droppers is found, or terms of second order do not
    settle.
    """
    problem = _Contact(setup, pantographs)
    slack: list[int] = []
    off = problem.beyond
    load = setup.line.load if signals is None else setup.load_at(signals)
    shifted = setup.static.solve(load)
    for _ in range(_CHANGES):
        heads, forces, q, spring = problem.solve(slack, off, shifted)
        now = np.flatnonzero(spring <= 0).tolist()
        now_off = [j for j, force in enumerate(forces) if force < 0 or j in off]
        before, shifted = shifted, setup.static.solve(load + stretch_loads(setup.line, q))
        moved = problem.take_tangents(forces, q) | problem.take_laws(heads)
        settled = np.abs(shifted - before).max() <= _SETTLED * np.abs(q).max()
        if now == slack and now_off == off and settled and not moved:
            placed = problem.placed(heads, forces, q)
            wires = len(setup.model.contacts)
            return InitialState(q, placed, np.maximum(spring, 0.0), speed, wires)
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

    def __init__(self, setup: Setup, pantographs: Sequence[PlacedPantograph]) -> None:
        self._setup, self._pantographs = setup, pantographs
        self._first = np.cumsum([0, *(placed.body.size for placed in pantographs)])
        self._contacts = contacts_of(pantographs, len(setup.model.contacts))
        rows, rest, heads, base = [], [], [], []
        for contact in self._contacts:
            row, height, lateral = contact_row(setup, contact.wire, contact.position)
            rows.append(row)
            rest.append(height)
            placed = pantographs[contact.pantograph]
            base.append(setup.base_line.height_at_rest(placed) if contact.strip.body is None else 0.0)
            heads.append(pantographs[contact.pantograph].body.row(contact.strip, lateral))
        self._rows: Floats = np.array(rows)
        self._rest, self._heads, self._base = np.array(rest), heads, np.array(base)
        self._lifts = setup.static.solve(np.ascontiguousarray(self._rows.T)).reshape(-1, len(rows))
        paths = setup.model.contacts
        self.beyond = [j for j, c in enumerate(self._contacts) if not paths[c.wire].meets(c.position)]
        laws = [pantographs[contact.pantograph].body.contact for contact in self._contacts]
        self._laws = laws
        self._tangents = [(law.preload, law.stiffness) for law in laws]  # force at the strip's height, slope
        self.take_tangents(np.zeros(len(rows)), np.zeros(setup.model.size))
        self._own: list[Any] = []
        self._at: Floats = np.full(int(self._first[-1]), np.inf)
        self.take_laws(np.zeros(self._at.size))

    def take_tangents(self, forces: Floats, q: Floats) -> bool:
        """Take the straight piece of each law of points where its contact is; true if one changed."""
        changed, wire = False, self._rest + self._rows @ q - self._base
        for j, law in enumerate(self._laws):
            if not law.points or j in self.beyond:
                continue
            points, compliance = np.array(law.points), float(self._rows[j] @ self._lifts[:, j])
            free = float(wire[j] - compliance * forces[j])
            force = plain(solve_points)(points, len(points), free, compliance)
            height = free + compliance * force
            slope = law.slope(-height)
            tangent = (float(force + slope * height), slope)
            changed |= not np.allclose(tangent, self._tangents[j], rtol=1e-9, atol=1e-9)
            self._tangents[j] = tangent
        return changed

    def take_laws(self, heads: Floats) -> bool:
        """Take the tangents of what is not linear in the pantographs where they are; true if that changed.

        heads : shape (coordinates of all,)
        """
        parts = zip(self._pantographs, self._first, self._first[1:], strict=False)
        base = self._setup.base_line
        self._own = [p.body.static_laws(heads[a:b], base.height_at_rest(p)) for p, a, b in parts]
        before, self._at = self._at, heads
        nonlinear = any(placed.body.laws for placed in self._pantographs)
        return nonlinear and float(np.abs(heads - before).max()) > _SETTLED

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
        lifts = np.column_stack([self._lifts, self._setup.static.solve(np.ascontiguousarray(pulls.T))])
        total, count = int(self._first[-1]), len(self._contacts)
        A, right = np.zeros((total + len(rows),) * 2), np.zeros(total + len(rows))
        A[total:, total:] = rows @ lifts
        for p, placed in enumerate(self._pantographs):
            part = slice(self._first[p], self._first[p + 1])
            force, tangent, _ = self._own[p]
            A[part, part] = placed.body.stiffness + tangent
            right[part] = self._setup.base_line.load_at_rest(placed) + tangent @ self._at[part] - force
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
        q: Floats = lifts @ solved[total:] + shifted
        spring: Floats = model.dropper_tension + model.dropper_stiffness * (model.dropper_rows @ q)
        return solved[:total], solved[total : total + count], q, spring

    def _add_law(self, A: Floats, right: Floats, j: int, row: int, off: bool, raised: float) -> None:
        """The contact's law: wire's height + force / k = head's height; and its push on the head.

        raised : [m] by which terms of second order lift the wire there
        """
        contact = self._contacts[j]
        part = slice(self._first[contact.pantograph], self._first[contact.pantograph + 1])
        A[part, row] = self._heads[j]
        preload, k = self._tangents[j]
        if off or not k:
            A[row], A[row, row], right[row] = 0.0, 1.0, 0.0 if off else preload
            return
        A[row, row] += 1 / k
        A[row, part] = -self._heads[j]
        right[row] = preload / k + self._base[j] - self._rest[j] - raised

    def placed(self, heads: Floats, forces: Floats, q: Floats) -> list[PlacedPantograph]:
        """The pantographs where they start."""
        wire, found = self._rest + self._rows @ q, []
        wire[self.beyond] = np.nan
        for p, placed in enumerate(self._pantographs):
            mine = [j for j, contact in enumerate(self._contacts) if contact.pantograph == p]
            own = heads[self._first[p] : self._first[p + 1]]
            found.append(replace(placed, heights=own, forces=forces[mine], wire_heights=wire[mine]))
        return found


def contact_row(setup: Setup, wire: int, position: float) -> tuple[Floats, float, float]:
    """The height over a position as a row of the coordinates; at rest: it, and the place to the left."""
    path = setup.model.contacts[wire]
    e, weights = path.at(position)
    dof = path.dof[e : e + 2].ravel()
    row = np.zeros(setup.model.size)
    row[dof[dof >= 0]] = weights[dof >= 0]
    height, lateral = (weights @ values[e : e + 2].ravel() for values in (path.profile, path.lateral))
    surface, _ = path.surface(position)
    return row, float(height - setup.nominal) + surface, float(lateral)
