"""Newton's method on an energy, and the static contact of pantographs and line that a run starts from."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.contact import PlacedPantograph, contacts_of
from catenary_fe.fe.system import System
from catenary_fe.layout import SolverError

Floats = NDArray[np.float64]

_ITERATIONS, _LEAST_STEP = 60, 1e-4
_SETTLED = 1e-9  # of the largest force on a coordinate; rounding of EA ε leaves 1e-5 N
_FLOOR = 1e-4  # [N]


def minimise(
    x: Floats,
    residual: Callable[[Floats], Floats],
    tangent: Callable[[Floats], Any],
    energy: Callable[[Floats], float],
    floor: float,
) -> tuple[Floats, bool]:
    """Coordinates with the least energy, from a first guess, and whether they were found.

    x : shape (size,)
    residual : forces out of balance, less the derivative of the energy, shape (size,)
    tangent : its second derivative, sparse
    floor : [N] out of balance that is good enough
    """
    from scipy.sparse.linalg import splu

    for _ in range(_ITERATIONS):
        out = residual(x)
        if not np.isfinite(out).all():
            break
        if np.abs(out).max(initial=0.0) <= floor:
            return x, True
        try:
            step = splu(tangent(x).tocsc()).solve(out)
        except RuntimeError:  # singular
            break
        before, slope, share = energy(x), float(out @ step), 1.0
        while share > _LEAST_STEP:
            rise = energy(x + share * step) - before
            if rise <= -1e-4 * share * slope + 1e-11 * abs(before):
                break
            share /= 2
        x = x + share * step
    return x, False


def force_floor(system: System, load: Floats) -> float:
    """[N] out of balance that counts as equilibrium.

    load : [N], shape (all,), besides the constant forces
    """
    return max(_FLOOR, _SETTLED * float(np.abs(system.force + load).max()))


def free_part(system: System, moved: Floats) -> Floats:
    """Shape (free,), displacements or rates of the free coordinates, from those of all."""
    moves = system.dof >= 0
    free = np.zeros(system.size)
    free[system.dof[moves]] = moved[moves]
    return free


def solve_loaded(system: System, load: Floats, guess: Floats) -> tuple[Floats, Floats | None]:
    """Displacements under a load, and what is left out of balance [N] if that is too much, shape (all,) each.

    load : [N], shape (all,), besides the constant forces
    guess : shape (all,), displacements to start from
    """

    def residual(x: Floats) -> Floats:
        return system.gather(system.out_of_balance(system.spread(x)) + load)

    x, found = minimise(
        free_part(system, guess),
        residual,
        lambda x: system.tangent(system.spread(x), taut=False),
        lambda x: system.energy(system.spread(x)) - float(load @ system.spread(x)),
        force_floor(system, load),
    )
    return system.spread(x), None if found else system.spread(residual(x))


def static_contact(
    system: System, pantographs: Sequence[PlacedPantograph]
) -> tuple[Floats, list[PlacedPantograph]]:
    """Displacements of the line, shape (all,), and the pantographs with their heights and contact forces.

    Raises SolverError if there is no equilibrium.
    """
    problem = _StaticContact(system, pantographs)
    floor = force_floor(system, np.zeros(system.dof.size))
    x, found = minimise(problem.guess(), problem.residual, problem.tangent, problem.energy, floor)
    if not found:
        residual = problem.residual(x)
        worst = int(np.nan_to_num(np.abs(residual), nan=np.inf).argmax())
        where = "at a pantograph"
        if worst < system.size:
            where = "at the " + system.name(int(np.flatnonzero(system.dof == worst)[0]))
        raise SolverError(
            f"static contact at the start: no equilibrium found, {np.abs(residual).max():.3g} N are left"
            f" {where}; look there for tensions, stiffnesses or forces that are far from usual values, or"
            " refine the mesh"
        )
    return problem.line_part(x), problem.placed(x)


class _StaticContact:
    """Line, pantographs and contacts over one list of coordinates: the line's free ones, then theirs."""

    def __init__(self, system: System, pantographs: Sequence[PlacedPantograph]) -> None:
        from scipy.linalg import block_diag
        from scipy.sparse import csr_matrix, lil_matrix

        self.system, self.pantographs = system, pantographs
        self.varying: Floats = system.patterns @ system.signals(np.zeros(1))[:, 0]  # as a run begins
        self.contacts = contacts_of(pantographs, len(system.contact_paths))
        bodies = [p.body for p in pantographs]
        self.first = system.size + np.cumsum([0, *(body.size for body in bodies)])
        self.K = csr_matrix(block_diag(np.zeros((0, 0)), *(body.stiffness for body in bodies)))
        base = system.base_line
        self.load = np.concatenate([np.zeros(0), *(base.load_at_rest(p) for p in pantographs)])
        self.risen = [base.height_at_rest(p) for p in pantographs]
        rows = lil_matrix((len(self.contacts), int(self.first[-1])))
        self.rest, self.base = np.zeros((2, len(self.contacts)))
        self.on = np.array(
            [system.contact_paths[c.wire].meets(c.position) for c in self.contacts], dtype=bool
        )
        for j, contact in enumerate(self.contacts):
            if not self.on[j]:
                self.rest[j] = np.nan
                continue
            row, lateral = system.row(contact.wire, contact.position), 0.0
            if system.spatial:
                lateral = float(system.row(contact.wire, contact.position, 1) @ system.reference)
            rows[j, : system.size] = -system.gather(row)
            own = slice(*self.first[contact.pantograph : contact.pantograph + 2])
            rows[j, own] = bodies[contact.pantograph].row(contact.strip, lateral)
            surface, _ = system.contact_paths[contact.wire].surface(contact.position)
            self.rest[j] = float(row @ system.reference) - system.contact_wire_height + surface
            if contact.strip.body is None:
                self.base[j] = self.risen[contact.pantograph]
        self.rows: Any = rows.tocsr()

    def guess(self) -> Floats:
        """The line at rest, the heads so deep in it that they carry the uplift."""
        x = np.zeros(int(self.first[-1]))
        for number, placed in enumerate(self.pantographs):
            law = placed.body.contact
            mine = [j for j, contact in enumerate(self.contacts) if contact.pantograph == number]
            met = [j for j in mine if self.on[j]]
            depth = placed.uplift / len(met) / law.stiffness if law.stiffness and met else 0.0
            begin = self.first[number]
            x[begin : begin + len(placed.body.bodies)] = self.rest[met].mean() + depth if met else 0.0
        return x

    def line_part(self, x: Floats) -> Floats:
        """Displacements of the line, shape (all,)."""
        return self.system.spread(x[: self.system.size])

    def _of_laws(self, what: str, x: Floats) -> Floats:
        """Shape (contacts,): "force" [N], "slope" [N/m] or "energy" [J] of each contact."""
        laws = [self.pantographs[contact.pantograph].body.contact for contact in self.contacts]
        depths = (self.rows @ x + self.base - self.rest).tolist()
        parts = zip(laws, depths, self.on, strict=True)
        return np.array([getattr(law, what)(depth) if on else 0.0 for law, depth, on in parts])

    def _laws(self, x: Floats) -> tuple[Floats, Any, float]:
        """What is not linear inside the pantographs: forces, their tangent, stored energy."""
        from scipy.linalg import block_diag
        from scipy.sparse import csr_matrix

        parts = [
            p.body.static_laws(x[a:b], risen)
            for p, a, b, risen in zip(self.pantographs, self.first, self.first[1:], self.risen, strict=False)
        ]
        forces = np.concatenate([np.zeros(0), *(force for force, _, _ in parts)])
        tangent = csr_matrix(block_diag(np.zeros((0, 0)), *(slopes for _, slopes, _ in parts)))
        return forces, tangent, sum(energy for _, _, energy in parts)

    def residual(self, x: Floats) -> Floats:
        n = self.system.size
        line = self.system.gather(self.system.out_of_balance(self.line_part(x))) + self.varying
        own = self.load - self.K @ x[n:] - self._laws(x)[0]
        residual: Floats = np.concatenate([line, own]) - self.rows.T @ self._of_laws("force", x)
        return residual

    def tangent(self, x: Floats) -> Any:
        from scipy.sparse import block_diag, diags

        line = self.system.tangent(self.line_part(x), taut=False)
        own = self.K + self._laws(x)[1]
        return block_diag([line, own]) + self.rows.T @ diags(self._of_laws("slope", x)) @ self.rows

    def energy(self, x: Floats) -> float:
        y = x[self.system.size :]
        own = float(y @ (self.K @ y) / 2 - self.load @ y)
        own += self._laws(x)[2]
        own += float(self._of_laws("energy", x).sum() - self.varying @ x[: self.system.size])
        return self.system.energy(self.line_part(x)) + own

    def placed(self, x: Floats) -> list[PlacedPantograph]:
        n, forces = self.system.size, self._of_laws("force", x)
        heights = self.rest - self.rows[:, :n] @ x[:n]
        found = []
        for number, placed in enumerate(self.pantographs):
            mine = [j for j, contact in enumerate(self.contacts) if contact.pantograph == number]
            own = x[self.first[number] : self.first[number + 1]]
            found.append(replace(placed, heights=own.copy(), forces=forces[mine], wire_heights=heights[mine]))
        return found
