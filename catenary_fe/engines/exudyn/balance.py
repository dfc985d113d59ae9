"""Energy in runs by Exudyn's solver: what is stored, what contacts and bases did, what dampers took."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.build import ExudynModel
from catenary_fe.engines.exudyn.laws import drag_of_laws
from catenary_fe.fe.contact import EvenCurve

Floats = NDArray[np.float64]
Bases = Sequence[EvenCurve | None]


def base_motion(bases: Bases, time: float) -> list[tuple[float, float]]:
    """Heights [m] and rates [m/s] of bases that move."""
    return [base.at(time) if base else (0.0, 0.0) for base in bases]


class EnergyBalance:
    """Energy, work of contacts and loads in time, and loss in the dampers, step by step.

    Kinetic and stored energy are those of line and pantographs; the potential of constant forces (weight,
    tensions, preloads, uplift) counts as stored. Work and loss of a step are those of the trapezoidal rule:
    the mean of a force at the step's two ends along the displacement between them. A contact's work on wire
    and head is not zero: what it does not store or damp comes from the moving base, which drives the force
    over the wire's inclination.

    every : steps between readings of the energy
    """

    def __init__(self, model: ExudynModel, uplifts: Floats, bases: Bases, steps: int, every: int) -> None:
        self._bases = bases
        self.every, self._model, self._contacts = every, model, model.contacts
        self._damping, self._droppers = model.system.damping(), model.system.droppers
        self._line = model.system.dof.size
        self._bodies = [
            (parts, parts.substructure, parts.index(model.mbs), float(uplift))
            for parts, uplift in zip(model.pantographs, uplifts, strict=True)
            if parts.substructure
        ]
        self.work, self.loss = np.zeros(steps + 1), np.zeros(steps + 1)
        self._energy: list[float] = []
        self._before: tuple[Floats, ...] | None = None

    @property
    def energy(self) -> Floats:
        """[J], shape (readings,)."""
        return np.array(self._energy)

    def record(
        self,
        n: int,
        state: tuple[Floats, Floats],
        driving: Floats,
        drag: Floats,
        droppers: Floats,
    ) -> None:
        """Take down step ``n``'s end.

        state : coordinates and velocities
        driving, drag : [N], shape (coordinates,), forces whose work is counted, and of dampers
        droppers : [N], shape (droppers,), tensions
        """
        q, v = state
        span = self._droppers.span(self._model.system.reference + q[: self._line])
        damped, length = droppers - self._droppers.tension(span), np.linalg.norm(span, axis=1)
        now = (q, driving, drag, damped, length)
        if self._before is not None:
            before = self._before
            moved = q - before[0]
            self.work[n] = self.work[n - 1] + (before[1] + now[1]) @ moved / 2
            lost = (before[2] + now[2]) @ moved + (before[3] + now[3]) @ (now[4] - before[4])
            self.loss[n] = self.loss[n - 1] + lost / 2
        self._before = now
        if n % self.every == 0:
            self._energy.append(self._energy_of(q, v))

    def driving(self, time: float, q: Floats, positions: Floats, forces: list[list[float]]) -> Floats:
        """[N], shape (coordinates,): generalised forces of the contacts, and loads that vary in time [s].

        positions : [m] of the pantographs
        forces : [N] of each pantograph's contacts
        """
        found, paths = np.zeros(q.size), self._model.system.contact_paths
        found[: self._line] = self._model.system.varying(time)
        moved = base_motion(self._bases, time)
        for i, (parts, body, index, _) in enumerate(self._bodies):
            risen = self._model.system.base_line.under(body, float(positions[i]))
            found[index] += risen * body.base_load
            found[index] += moved[i][0] * body.base_stiffness + moved[i][1] * body.base_damping
            still, _, _ = body.static_laws(q[index])  # as of springs: on a base at rest they store
            found[index] += still - body.static_laws(q[index], risen + moved[i][0])[0]
            for contact, force in zip(parts.contacts, forces[i], strict=True):
                path = paths[contact.wire]
                e, weights = path.at(float(positions[i]) + contact.ahead)
                found[path.index[e : e + 2].ravel()] += force * weights
                if contact.strip:
                    found[index] -= force * body.row(contact.strip, self._contacts.lateral(contact))
        return found

    def drag(self, time: float, v: Floats) -> Floats:
        """[N], shape (coordinates,), at a time [s]: of line and pantographs, not of droppers."""
        drag, moved = np.zeros(v.size), base_motion(self._bases, time)
        drag[: self._line] = self._damping @ v[: self._line]
        for i, (_, body, index, _) in enumerate(self._bodies):
            drag[index] = body.damping @ v[index] + drag_of_laws(body, v[index], moved[i][1])
        return drag

    def _energy_of(self, q: Floats, v: Floats) -> float:
        """[J] above an arbitrary zero."""
        system, moving = self._model.system, v[: self._line]
        total = system.energy(q[: self._line]) + float(moving @ (system.mass @ moving) / 2)
        for _, body, index, uplift in self._bodies:
            y, w = q[index], v[index]
            total += body.energy(y, w) - uplift * float(body.load @ y)
        return total
