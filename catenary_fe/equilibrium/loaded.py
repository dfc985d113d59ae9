"""The line under static forces on its contact wire, in large motions and with droppers that go slack."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.equilibrium.shape import Shape
from catenary_fe.fe.cable import Cables, hermite, inner_forces, tangent_blocks
from catenary_fe.fe.system import System, assemble, spring_blocks
from catenary_fe.system import SolverError

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Progress = Callable[[float], None]

_ITERATIONS, _LEAST_STEP, _LOAD_STEPS = 60, 1e-4, 20
_SETTLED = 1e-9  # of the largest force on a coordinate; rounding of EA ε leaves 1e-5 N
_FLOOR = 1e-4  # [N]
_WINDOW = 1  # spans to both sides of a force, beyond which the line answers it linearly: the error is < 1e-5
_CORRECTIONS, _SAME = 12, 1e-4  # of a lift: change of the last correction


class LoadedLine:
    """A line at rest that is loaded and solved for, again and again. Two contact wires share each force."""

    def __init__(self, shape: Shape) -> None:
        self.shape = shape
        self.system: System = assemble(shape.catenary, shape.mesh, shape.installation)

    def at(self, x: float) -> tuple[Integers, Floats]:
        """Coordinates at a place [m] along the line, and how a height there is made of them.

        Shape (contact wires, 4) both: height and vertical slope of the two nodes about it.
        """
        mesh, axes = self.shape.mesh, self.system.axes
        index, weights = [], []
        for number, line in enumerate(self.shape.installation.lines[: mesh.contact_wires]):
            stations = mesh.wires[number].x
            e = min(max(int(np.searchsorted(stations, x, side="right")) - 1, 0), stations.size - 2)
            first = 2 * axes * (int(mesh.first_nodes[number]) + e) + axes - 1
            index.append(first + axes * np.arange(4))
            share = (x - stations[e]) / (stations[e + 1] - stations[e])
            weights.append(hermite(share, line.lengths[e]) / mesh.contact_wires)
        return np.array(index), np.array(weights)

    def load(self, positions: Sequence[float] | Floats, forces: Sequence[float] | Floats) -> Floats:
        """[N], shape (all,): upward forces [N] at places [m] along the line."""
        load = np.zeros(self.system.place.size)
        for x, force in zip(positions, forces, strict=True):
            index, weights = self.at(float(x))
            np.add.at(load, index, float(force) * weights)
        return load

    def solve(self, positions: Sequence[float] | Floats, forces: Sequence[float] | Floats) -> Floats:
        """Displacements, shape (all,), under upward forces [N] at places [m] along the line.

        Raises SolverError, with the place, if no equilibrium is found.
        """
        load = self.load(positions, forces)
        moved, residual = self._newton(np.zeros_like(load), load)
        for step in range(1, _LOAD_STEPS + 1) if residual is not None else ():
            moved, residual = self._newton(moved if step > 1 else 0 * moved, load * step / _LOAD_STEPS)
            if residual is not None:
                break
        if residual is None:
            return moved
        what = ", ".join(f"{f:g} N at {x:g} m" for x, f in zip(positions, forces, strict=True))
        raise SolverError(
            f"static load ({what}): no static equilibrium found, neither at once nor in {_LOAD_STEPS} steps"
            f" of the load: {np.abs(residual).max():.3g} N are left {self._place(residual)}; try a smaller"
            " force, and look there for stiffnesses and tensions that are far from usual values"
        )

    def _newton(self, moved: Floats, load: Floats) -> tuple[Floats, Floats | None]:
        """Displacements, and what is left out of balance if that is too much, shape (all,).

        Newton's method on the energy, the step shortened where it would raise it.
        """
        from scipy.sparse.linalg import splu

        system = self.system
        floor = max(_FLOOR, _SETTLED * float(np.abs(system.force + load).max()))
        for _ in range(_ITERATIONS):
            residual = system.gather(system.out_of_balance(moved) + load)
            if not np.isfinite(residual).all():
                break
            if np.abs(residual).max() <= floor:
                return moved, None
            try:
                step = splu(system.tangent(moved, taut=False).tocsc()).solve(residual)
            except RuntimeError:  # singular
                break
            energy, slope = system.energy(moved) - load @ moved, float(residual @ step)
            share = 1.0
            while share > _LEAST_STEP:
                trial = moved + share * system.spread(step)
                rise = system.energy(trial) - load @ trial - energy
                if rise <= -1e-4 * share * slope + 1e-11 * abs(energy):
                    break
                share /= 2
            moved = moved + share * system.spread(step)
        return moved, system.spread(system.gather(system.out_of_balance(moved) + load))

    def _place(self, residual: Floats) -> str:
        """Where most is out of balance, in words."""
        mesh = self.shape.mesh
        worst = int(np.nan_to_num(np.abs(residual), nan=np.inf).argmax()) // (2 * self.system.axes)
        wire = int(np.searchsorted(mesh.first_nodes, worst, side="right")) - 1
        x = mesh.wires[wire].x[worst - mesh.first_nodes[wire]]
        return f"on the {mesh.wire_name(wire)} at {x:.1f} m along the line"

    def lifts(self, positions: Floats, force: float, progress: Progress | None = None) -> Floats:
        """[m], shape (points,): lift of the contact wire at each place [m] under a force [N] there.

        Raises SolverError, with the place, if no equilibrium is found.
        """
        supports = self.shape.catenary.support_positions
        span = np.clip(np.searchsorted(supports, positions, side="right") - 1, 0, supports.size - 2)
        lifts, rest = np.empty(positions.size), _AtRest(self)
        for number in np.unique(span):
            mine = np.flatnonzero(span == number)
            near = supports[[max(number - _WINDOW, 0), min(number + 1 + _WINDOW, supports.size - 1)]]
            lifts[mine] = rest.lifts(positions[mine], force, near)
            if progress:
                progress((int(mine[-1]) + 1) / positions.size)
        return lifts


class _AtRest:
    """The line's stiffness at rest, and what it takes to correct its answer for large motions.

    Each answer is that of the tangent at rest, with slack droppers and turned arms put into it by a Woodbury
    update, corrected by what wires and droppers near the force do otherwise, until nothing changes.
    """

    def __init__(self, line: LoadedLine) -> None:
        from scipy.sparse.linalg import splu

        self.line, self.system = line, line.system
        self.stiffness = self.system.tangent(np.zeros(self.system.place.size))
        self._factor = splu(  # in the order of the stations the factor is narrow
            self.stiffness.tocsc(),
            permc_spec="NATURAL",
            diag_pivot_thresh=0.0,
            options={"SymmetricMode": True},
        )
        self._columns: dict[tuple[bool, int], Floats] = {}

    def lifts(self, positions: Floats, force: float, near: Floats) -> Floats:
        """[m], shape (points,); near : [m] between which wires and springs are taken as they are."""
        system, line = self.system, self.line
        around = _Surroundings(line, near)
        free = np.stack([system.gather(line.load([x], [force])) for x in positions])
        moved = self._factor.solve(free.T).T
        lifts: Floats = (free * moved).sum(axis=1) / force
        for _ in range(_CORRECTIONS):
            before = lifts
            spread = system.spread(moved)
            residual = free - (self.stiffness @ moved.T).T + around.extra(spread)
            moved = moved + self._updated(self._factor.solve(residual.T).T, around.changes(spread))
            lifts = (free * moved).sum(axis=1) / force
            if np.abs(lifts - before).max() <= _SAME * np.abs(lifts).max():
                return lifts
        whole = [system.gather(line.solve([x], [force])) for x in positions]
        return np.array([f @ u / force for f, u in zip(free, whole, strict=True)])

    def _updated(self, answers: Floats, changes: dict[tuple[bool, int], Floats]) -> Floats:
        """Answers of the line at rest, shape (points, free), as those of the line with changed springs.

        changes : of stiffness [N/m], shape (points, axes, axes), by spring
        """
        if not changes:
            return answers
        from scipy.sparse import vstack

        points, axes = len(answers), self.system.axes
        rows = vstack([self._span_change(*spring) for spring in changes]).tocsr()
        columns = np.concatenate([self._column(*spring) for spring in changes], axis=1)
        blocks = np.stack(list(changes.values()), axis=1)

        def changed(values: Floats) -> Floats:
            of_each = values.reshape(len(values), blocks.shape[1], axes, -1)
            product: Floats = np.einsum("psij,psjk->psik", blocks, of_each)
            return product.reshape(points, rows.shape[0], -1)

        inner = np.eye(rows.shape[0]) + changed((rows @ columns)[None])
        loads = np.linalg.solve(inner, changed((rows @ answers.T).T))[:, :, 0]
        updated: Floats = answers - loads @ columns.T
        return updated

    def _span_change(self, dropper: bool, number: int) -> Any:
        """Sparse, shape (axes, free): of a spring's span with the free coordinates."""
        from scipy.sparse import csr_matrix

        axes = self.system.axes
        springs = self.system.droppers if dropper else self.system.arms
        place = self.system.place[springs.index()[number]]
        signs = np.repeat([-1.0, 1.0][: place.size // axes], axes)
        moves = place >= 0
        entries = signs[moves], (np.arange(place.size)[moves] % axes, place[moves])
        return csr_matrix(entries, shape=(axes, self.system.size))

    def _column(self, dropper: bool, number: int) -> Floats:
        """Shape (free, axes): answers of the line to forces that open a spring's span."""
        if (dropper, number) not in self._columns:
            row = self._span_change(dropper, number)
            self._columns[dropper, number] = self._factor.solve(row.toarray().T)
        return self._columns[dropper, number]


class _Surroundings:
    """Elements, droppers and arms near a force, at many displacements at once."""

    def __init__(self, line: LoadedLine, near: Floats) -> None:
        system, mesh = line.system, line.shape.mesh
        self.system = system
        x = np.repeat(np.concatenate([wire.x for wire in mesh.wires]), 2 * system.axes)
        inside = (x >= near[0] - 1e-6) & (x <= near[1] + 1e-6)
        kept = inside[system.first]
        self.index = system.first[kept][:, None] + np.arange(4 * system.axes)
        self.cables = Cables(*(values[kept] for values in vars(system.cables).values()))
        rest = system.reference[self.index].reshape(-1, 4, system.axes)
        self.blocks, self.inner = tangent_blocks(self.cables, rest), inner_forces(self.cables, rest)
        self.droppers, self.arms = (s.only(inside[s.first]) for s in (system.droppers, system.arms))
        self._numbers = [np.flatnonzero(inside[s.first]) for s in (system.droppers, system.arms)]

    def extra(self, moved: Floats) -> Floats:
        """[N], shape (points, free): what the line's forces have that its tangent at rest has not.

        moved : shape (points, all)
        """
        system, (points, size) = self.system, moved.shape
        many = Cables(*(np.tile(values, points) for values in vars(self.cables).values()))
        here = moved[:, self.index]
        total = (system.reference[self.index] + here).reshape(-1, 4, system.axes)
        inner = inner_forces(many, total).reshape(points, *self.index.shape)
        linear = np.einsum("eij,pej->pei", self.blocks, here)
        found = _summed(linear + self.inner.reshape(self.index.shape) - inner, self.index, size)
        for springs in (self.droppers, self.arms):
            index, blocks = springs.index(), springs.blocks(system.reference, taut=True)
            linear = np.einsum("eij,pej->pei", blocks, moved[:, index])
            now = springs.forces(system.reference + moved)
            found += _summed(now - springs.forces(system.reference) + linear, index, size)
        return system.gather(found)

    def changes(self, moved: Floats) -> dict[tuple[bool, int], Floats]:
        """Slack droppers and turned arms: change of stiffness [N/m], shape (points, axes, axes).

        moved : shape (points, all). Keys are whether it is a dropper, and its number
        """
        reference, found = self.system.reference, {}
        for springs, numbers in zip((self.droppers, self.arms), self._numbers, strict=True):
            rest = springs.span(reference)
            at_rest = spring_blocks(rest, springs.tension(rest), springs.stiffness)
            now, tension = springs.span(reference + moved), springs.tension(rest)
            if springs.pulls_only:
                change = -at_rest * (springs.tension(now) <= 0)[:, :, None, None]
            else:  # its axial force changes little: it turns
                change = spring_blocks(now, tension, springs.stiffness) - at_rest
            for i in np.flatnonzero(change.any(axis=(0, 2, 3))):
                found[springs.pulls_only, int(numbers[i])] = change[:, i]
        return found


def _summed(values: Floats, index: Integers, size: int) -> Floats:
    """Shape (points, size), of values at coordinates, shape (points, *index.shape)."""
    points = len(values)
    place = (size * np.arange(points)[:, None] + index.ravel()).ravel()
    summed = np.bincount(place, values.reshape(points, -1).ravel(), minlength=points * size)
    return np.asarray(summed, dtype=float).reshape(points, size)
