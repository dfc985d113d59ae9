"""What changes from step to step in a compiled nonlinear run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import PantographParameters, PantographState, Wires, Work
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.nonlinear.arrays import EnergyBalance, Equations, Motion, Slack
from catenary_fe.engines.nonlinear.cables import Room
from catenary_fe.engines.nonlinear.forces import ROOM
from catenary_fe.engines.recorder import InitialState, Sizes
from catenary_fe.fe.contact import PlacedPantograph

Floats = NDArray[np.float64]


@dataclass
class State:
    """Wires and pantographs at a step's end, and room for the next one's work."""

    wires: Wires
    motion: Motion
    slack: Slack
    heads: PantographParameters
    pantographs: PantographState
    work: Work
    energy: EnergyBalance

    @classmethod
    def at(
        cls,
        start: InitialState,
        total: Floats,
        equations: Equations,
        pantographs: tuple[PantographParameters, PantographState],
        sizes: Sizes,
    ) -> State:
        """At rest; ``total`` are positions and slopes there, shape (2 axes, nodes)."""
        n = equations.force.size
        wires = Wires(start.q[:, None].copy(), *(np.zeros((n, 1)) for _ in range(4)))
        motion = Motion(start.q.copy(), np.zeros(n), np.zeros(n), np.zeros(n), Room.of(total.shape[0] // 2))
        work = _work(sizes)
        work.force[0] = start.contact_forces
        return cls(
            wires,
            motion,
            _slack(equations),
            *pantographs,
            work,
            _energy_balance(start, total, equations, sizes),
        )

    @property
    def kept(self) -> list[NDArray[np.generic]]:
        """Arrays that make up the state; the others are room for work."""
        return [
            *self.wires[:4],
            self.motion.q,
            self.work.force,
            self.work.law_force,
            *self.pantographs,
            *self.energy[:-1],
        ]

    def snapshot(self) -> list[NDArray[np.generic]]:
        """A copy of the state."""
        return [array.copy() for array in self.kept]

    def restore(self, snapshot: Sequence[NDArray[np.generic]]) -> None:
        """Go back to a copy."""
        for array, values in zip(self.kept, snapshot, strict=True):
            array[:] = values

    def arrays(self) -> dict[str, NDArray[Any]]:
        """All that the next steps depend on to the last bit, by name."""
        named = {f"state_{i}": array for i, array in enumerate(self.kept)}
        return named | {f"slack_{name}": array for name, array in self.slack._asdict().items()}

    def go_on(self, arrays: Mapping[str, NDArray[Any]]) -> None:
        """Go on from :meth:`arrays`."""
        for name, array in self.arrays().items():
            array[...] = arrays[name]

    def rescale(self, old: Scheme, new: Scheme, pantographs: Sequence[PlacedPantograph]) -> None:
        """Take another time step from here on: the same state in the terms of another scheme."""
        for q, v, x in (
            (self.wires.q, self.wires.v, self.wires.x),
            (self.pantographs.q, self.pantographs.v, self.pantographs.x),
        ):
            q += (old.b - new.b) * x
            v += (old.g - new.g) * x
        for p, placed in enumerate(pantographs):
            body, m = placed.body, placed.body.size
            matrix = body.mass + new.g * body.damping + new.b * body.stiffness
            self.heads.inverse[0, p, :m, :m] = np.linalg.inv(matrix)
        self.slack.width[:] = 0  # found with another matrix


def _work(sizes: Sizes) -> Work:
    j, m = sizes.contacts, sizes.coordinates
    return Work(
        force=np.zeros((1, j)),
        law_force=np.zeros((1, sizes.laws)),
        slack=np.zeros((1, 0)),
        arm_force=np.zeros((1, 0, 2)),
        tension=np.zeros((1, 0)),
        active=np.zeros((1, 0), dtype=np.int64),
        active_count=np.zeros(1, dtype=np.int64),
        column=np.zeros((1, j, ROOM)),
        first=np.zeros((1, j), dtype=np.int64),
        width=np.zeros((1, j), dtype=np.int64),
        shape=np.zeros((1, j, 5)),
        rise=np.zeros((1, j, 5)),
        at=np.zeros((1, j, 4), dtype=np.int64),
        node=np.zeros((1, j), dtype=np.int64),
        on=np.zeros((1, j), dtype=np.int64),
        base=np.zeros((1, j)),
        head=np.zeros((1, j, m)),
        head_compliance=np.zeros((1, j, m)),
    )


def _energy_balance(start: InitialState, total: Floats, system: Equations, sizes: Sizes) -> EnergyBalance:
    j, masses = sizes.contacts, (sizes.pantographs, sizes.coordinates)
    droppers, axes = system.droppers, system.droppers.pivot.shape[1]
    span = (total[:axes, droppers.last] - total[:axes, droppers.first]).T
    lengths: Floats = np.linalg.norm(span, axis=1)
    heads = np.zeros(masses)
    for p, placed in enumerate(start.pantographs):
        heads[p, : placed.heights.size] = placed.heights
    free = system.force.size
    return EnergyBalance(
        work=np.zeros(2),
        q=start.q.copy(),
        drag=np.zeros(free),
        heads=heads,
        head_drag=np.zeros(masses),
        force=np.zeros(j),
        law_force=np.zeros(sizes.laws),
        shape=np.zeros((j, 4)),
        at=np.full((j, 4), -1),
        head=np.zeros((j, sizes.coordinates)),
        damper=np.zeros(lengths.size),
        span=lengths.copy(),
        new_damper=np.zeros(lengths.size),
        new_span=lengths.copy(),
        history=np.zeros((2, sizes.steps + 1)),
    )


def _slack(system: Equations) -> Slack:
    droppers, axes = system.droppers, system.droppers.pivot.shape[1]
    at = np.concatenate([system.dof[:axes, droppers.first], system.dof[:axes, droppers.last]]).T
    count = droppers.first.size
    return Slack(
        lack=np.zeros(count),
        row=np.zeros(at.shape),
        at=np.ascontiguousarray(at, dtype=np.int64),
        column=np.zeros((count, ROOM)),
        first=np.zeros(count, dtype=np.int64),
        width=np.zeros(count, dtype=np.int64),
    )
