"""The line under static forces on its contact wire, in large motions and with droppers that go slack."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import Cables, inner_forces, scattered, tangent_blocks
from catenary_fe.fe.cuts import elements_across, only, part_between
from catenary_fe.fe.spring import FIXED, spring_blocks
from catenary_fe.fe.system import System
from catenary_fe.layout import SolverError
from catenary_fe.statics.newton import solve_loaded
from catenary_fe.statics.shape import Shape

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Progress = Callable[[float], None]

_LOAD_STEPS = 20
_NEAR, _FAR = 1, 2  # spans beside that of a force; what is left out there moves a lift by up to 4e-4
_NARROW: dict[str, Any] = {  # in the order of the stations the factor is narrow
    "permc_spec": "NATURAL",
    "diag_pivot_thresh": 0.0,
    "options": {"SymmetricMode": True},
}
_CORRECTIONS, _SAME = 12, 1e-4  # of a lift: change of the last correction


class LoadedLine:
    """A line at rest that is loaded and solved for, again and again.

    Two contact wires share each force; where there are those of two sections, the lower ones take it.
    """

    def __init__(self, shape: Shape) -> None:
        self.shape = shape
        self.system: System = shape.system

    def load(self, positions: Sequence[float] | Floats, forces: Sequence[float] | Floats) -> Floats:
        """[N], shape (all,): upward forces [N] at places [m] along the line."""
        load = np.zeros(self.system.dof.size)
        for x, force in zip(positions, forces, strict=True):
            wires = self.system.served(float(x))
            for wire in wires:
                load += float(force) / len(wires) * self.system.row(wire, float(x))
        return load

    def _free_loads(self, positions: Floats, force: float) -> Floats:
        """[N], shape (points, free): of a force [N] at each place [m], as :meth:`load` has them."""
        loads = np.zeros((positions.size, self.system.size))
        for load, x in zip(loads, positions.tolist(), strict=True):
            wires = self.system.served(x)
            for wire in wires:
                index, weights = self.system.weights(wire, x)
                free = self.system.dof[index]
                load[free[free >= 0]] += force / len(wires) * weights[free >= 0]
        return loads

    def solve(self, positions: Sequence[float] | Floats, forces: Sequence[float] | Floats) -> Floats:
        """Displacements, shape (all,), under upward forces [N] at places [m] along the line.

        Raises SolverError, with the place, if no equilibrium is found.
        """
        load = self.load(positions, forces)
        moved, residual = solve_loaded(self.system, load, 0 * load)
        for step in range(1, _LOAD_STEPS + 1) if residual is not None else ():
            guess = moved if step > 1 else 0 * moved
            moved, residual = solve_loaded(self.system, load * step / _LOAD_STEPS, guess)
            if residual is not None:
                break
        if residual is None:
            return moved
        what = ", ".join(f"{f:g} N at {x:g} m" for x, f in zip(positions, forces, strict=True))
        worst = int(np.nan_to_num(np.abs(residual), nan=np.inf).argmax())
        raise SolverError(
            f"static load ({what}): no static equilibrium found, neither at once nor in {_LOAD_STEPS} steps"
            f" of the load: {np.abs(residual).max():.3g} N are left at the {self.system.name(worst)}; try a"
            " smaller force, and look there for stiffnesses and tensions that are far from usual values"
        )

    def lifts(self, positions: Floats, force: float, progress: Progress | None = None) -> Floats:
        """[m], shape (points,): lift of the contact wire at each place [m] under a force [N] there.

        Raises SolverError, with the place, if no equilibrium is found.
        """
        from scipy.sparse.linalg import splu

        system, supports = self.system, self.shape.catenary.support_positions
        stiffness = system.tangent(np.zeros(system.dof.size))
        factor = splu(stiffness.tocsc(), **_NARROW)
        span = np.clip(np.searchsorted(supports, positions, side="right") - 1, 0, supports.size - 2)
        lifts = np.empty(positions.size)
        for number in np.unique(span):
            mine = np.flatnonzero(span == number)
            near, far = (
                supports[[max(number - n, 0), min(number + 1 + n, supports.size - 1)]] for n in (_NEAR, _FAR)
            )
            loads = self._free_loads(positions[mine], force)
            around = _Surroundings(self, stiffness, near, far)
            linear = factor.solve(loads.T).T
            moved = around.corrected(linear, loads)
            if moved is None:
                lifts[mine] = [self._lift(float(x), force) for x in positions[mine]]
            else:
                # what is left at the ends of that part of the line moves the points by their influence
                residual = loads - (stiffness @ moved.T).T
                residual[:, around.part] += around.extra(moved)
                lifts[mine] = (loads * moved + linear * residual).sum(axis=1) / force
            if progress:
                progress((int(mine[-1]) + 1) / positions.size)
        return lifts

    def _lift(self, x: float, force: float) -> float:
        """[m], by Newton's method on the whole line."""
        return float(self.load([x], [1.0]) @ self.solve([x], [force]))


class _Surroundings:
    """The line near a force, where it answers otherwise than its tangent at rest.

    Wires, droppers and arms are taken as they are between the places ``near`` [m]; what they do otherwise
    is answered by the tangent at rest between the places ``far``, slack droppers and turned arms put into it
    by a Woodbury update, until nothing changes.
    """

    def __init__(self, line: LoadedLine, stiffness: Any, near: Floats, far: Floats) -> None:
        from scipy.sparse.linalg import splu

        system, mesh = line.system, line.shape.mesh
        x = np.repeat(np.concatenate([wire.x for wire in mesh.wires]), 2 * system.axes)
        around = (x > far[0] + 1e-6) & (x <= far[1] + 1e-6) if far[0] > 0 else x <= far[1] + 1e-6
        free = system.dof[around & (system.dof >= 0)]
        self.part = slice(int(free.min()), int(free.max()) + 1)  # they are numbered by station
        # cut towards what holds it along the track a wire is held, at its other end it moves as under weights
        cuts = [_loose(system, x, cut + 1e-6, n == 0) for n, cut in enumerate(far) if cut > 0]
        loose = only(system, np.concatenate([np.zeros(0, dtype=np.int64), *cuts]))
        at_rest = loose.of_elements(system.reference)
        inside, size = system.dof - self.part.start, self.part.stop - self.part.start
        place = np.where(inside < size, inside, FIXED)  # below 0 what lies before it
        taken = scattered([(loose.elements(), tangent_blocks(loose.cables, at_rest))], size, place)
        self._stiffness = stiffness[self.part, self.part] - taken
        self._factor = splu(self._stiffness.tocsc(), **_NARROW)
        self._take(part_between(system, x, near[0] - 1e-6, near[1] + 1e-6))
        rest = self._reference[self._index].reshape(-1, 4, system.axes)
        self._blocks, self._inner = tangent_blocks(self._cables, rest), inner_forces(self._cables, rest)
        self._at_rest = [
            (s.index(), s.blocks(self._reference, taut=True), s.forces(self._reference))
            for s in self._springs
        ]
        self._known: dict[tuple[bool, int], tuple[Any, Floats]] = {}

    def _take(self, inside: System) -> None:
        """Elements and springs, their coordinates numbered anew."""
        index, springs = inside.elements(), (inside.droppers, inside.arms)
        used = np.unique(np.concatenate([index.ravel(), *(s.index().ravel() for s in springs)]))
        self.axes, self._reference, self._dof = inside.axes, inside.reference[used], inside.dof[used]
        self._index, self._cables = np.searchsorted(used, index), inside.cables
        self._springs = [
            replace(s, first=np.searchsorted(used, s.first), last=np.searchsorted(used, s.last))
            for s in springs
        ]
        self._gather = inside.transformation[used][:, self.part].T.tocsr()

    def corrected(self, linear: Floats, loads: Floats) -> Floats | None:
        """Answers, shape (points, free), from those of the tangent at rest; None where they do not settle.

        loads : [N], shape (points, free)
        """
        moved, before = linear.copy(), (loads * linear).sum(axis=1)
        added = np.zeros_like(linear[:, self.part])
        for _ in range(_CORRECTIONS):
            residual = self.extra(moved) - (self._stiffness @ added.T).T
            step = self._updated(self._factor.solve(residual.T).T, self._changes(self._near(moved)))
            added += step
            moved[:, self.part] += step
            lifts = (loads * moved).sum(axis=1)
            if np.abs(lifts - before).max() <= _SAME * np.abs(lifts).max():
                return moved
            before = lifts
        return None

    def _near(self, moved: Floats) -> Floats:
        """Shape (points, coordinates inside), of the free ones."""
        return np.where(self._dof >= 0, moved[:, self._dof], 0.0)

    def extra(self, free: Floats) -> Floats:
        """[N], shape (points, part): what the line's forces have that its tangent at rest has not.

        free : displacements, shape (points, free)
        """
        moved = self._near(free)
        points, size = moved.shape
        many = Cables(*(np.tile(values, points) for values in vars(self._cables).values()))
        here = moved[:, self._index]
        total = (self._reference[self._index] + here).reshape(-1, 4, self.axes)
        inner = inner_forces(many, total).reshape(points, *self._index.shape)
        linear = _each(self._blocks, here)
        found = _summed(linear + self._inner.reshape(self._index.shape) - inner, self._index, size)
        for springs, (index, blocks, forces) in zip(self._springs, self._at_rest, strict=True):
            linear = _each(blocks, moved[:, index])
            now = springs.forces(self._reference + moved)
            found += _summed(now - forces + linear, index, size)
        extra: Floats = (self._gather @ found.T).T
        return extra

    def _changes(self, moved: Floats) -> dict[tuple[bool, int], Floats]:
        """Slack droppers and turned arms: change of stiffness [N/m], shape (points, axes, axes).

        moved : shape (points, coordinates inside). Keys are whether it is a dropper, and its number
        """
        found = {}
        for springs in self._springs:
            rest, now = springs.span(self._reference), springs.span(self._reference + moved)
            at_rest = spring_blocks(rest, springs.tension(rest), springs.stiffness)
            if springs.pulls_only:
                change = -at_rest * (springs.tension(now) <= 0)[:, :, None, None]
            else:  # its axial force changes little: it turns
                change = spring_blocks(now, springs.tension(rest), springs.stiffness) - at_rest
            for i in np.flatnonzero(change.any(axis=(0, 2, 3))).tolist():
                found[springs.pulls_only, i] = change[:, i]
        return found

    def _updated(self, answers: Floats, changes: dict[tuple[bool, int], Floats]) -> Floats:
        """Answers of the line at rest, shape (points, part), as those of the line with changed springs.

        changes : of stiffness [N/m], shape (points, axes, axes), by spring
        """
        if not changes:
            return answers
        from scipy.sparse import vstack

        points, axes = len(answers), self.axes
        known = [self._opened(*spring) for spring in changes]
        rows = vstack([row for row, _ in known]).tocsr()
        columns = np.concatenate([column for _, column in known], axis=1)
        blocks = np.stack(list(changes.values()), axis=1)

        def changed(values: Floats) -> Floats:
            of_each = values.reshape(len(values), blocks.shape[1], axes, -1)
            product: Floats = np.einsum("psij,psjk->psik", blocks, of_each)
            return product.reshape(points, rows.shape[0], -1)

        inner = np.eye(rows.shape[0]) + changed((rows @ columns)[None])
        loads = np.linalg.solve(inner, changed((rows @ answers.T).T))[:, :, 0]
        # not by BLAS, whose threads cost more than they bring on so little
        updated: Floats = answers - np.einsum("pm,fm->pf", loads, columns)
        return updated

    def _opened(self, dropper: bool, number: int) -> tuple[Any, Floats]:
        """A spring's span with the free coordinates, sparse, shape (axes, part), and what opening it does.

        That is the line's answer, shape (part, axes), to forces that open the span.
        """
        from scipy.sparse import csr_matrix

        if (dropper, number) not in self._known:
            at = self._springs[0 if dropper else 1].index()[number]
            signs = np.repeat([-1.0, 1.0][: at.size // self.axes], self.axes)
            shape = (self.axes, self._reference.size)
            row = csr_matrix((signs, (np.arange(at.size) % self.axes, at)), shape=shape) @ self._gather.T
            self._known[dropper, number] = row, self._factor.solve(row.toarray().T)
        return self._known[dropper, number]


def _loose(system: System, x: Floats, cut: float, left: bool) -> Integers:
    """Numbers of the elements across a cut [m] of wires that nothing holds along the track beyond it.

    x : [m], shape (all,), stations of the coordinates
    left : beyond it is on its left, else on its right
    """
    across = elements_across(system, x, cut)
    firsts = [wire.first for wire in system.wires]
    owner = np.searchsorted(firsts, system.first[across] // (2 * system.axes), side="right") - 1
    holds = [_holds(system, int(n)) for n in owner]
    held = [bool(((at <= cut) if left else (at > cut)).any()) for at in holds]
    loose: Integers = across[~np.array(held, dtype=bool)]
    return loose


def _each(blocks: Floats, values: Floats) -> Floats:
    """Shape (points, blocks, m): blocks of shape (blocks, m, m) by values of shape (points, blocks, m)."""
    product: Floats = np.matmul(blocks, values.transpose(1, 2, 0)).transpose(2, 0, 1)
    return product


def _summed(values: Floats, index: Integers, size: int) -> Floats:
    """Shape (points, size), of values at coordinates, shape (points, *index.shape)."""
    points = len(values)
    at = (size * np.arange(points)[:, None] + index.ravel()).ravel()
    summed = np.bincount(at, values.reshape(points, -1).ravel(), minlength=points * size)
    return np.asarray(summed, dtype=float).reshape(points, size)


def _holds(system: System, wire: int) -> Floats:
    """[m], places where a wire, or the one that a stitch wire is clamped on, is held along the track.

    Springs count where nothing else holds it.
    """
    mine, fixed, springs = system.wires[wire], [np.array([])], [np.array([])]
    for other in system.wires:
        if (other.section, other.contact) == (mine.section, mine.contact):
            along = 2 * system.axes * (other.first + np.arange(other.x.size))
            fixed.append(other.x[system.dof[along] == FIXED])
            springs.append(other.x[system.ground_stiffness[along] > 0])
    held = np.concatenate(fixed)
    return held if held.size else np.concatenate(springs)
