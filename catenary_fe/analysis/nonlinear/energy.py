"""Energy of wires and pantographs during a compiled run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.analysis.linearised.arrays import Scheme
from catenary_fe.analysis.linearised.start import Chain
from catenary_fe.analysis.nonlinear.state import State

if TYPE_CHECKING:
    from catenary_fe.fe.nonlinear_model import NonlinearModel

Floats = NDArray[np.float64]


class EnergyRecord:
    """Readings of the kinetic and stored energy, contacts left out: the same as Exudyn's runs record.

    The potential of constant forces (weight, tensions, preloads, uplift) counts as stored.
    """

    def __init__(self, model: NonlinearModel, chains: Sequence[Chain]) -> None:
        self._model, self._chains = model, chains
        self._values: list[float] = []

    @property
    def values(self) -> Floats:
        """[J], shape (readings,)."""
        return np.array(self._values)

    def go_on(self, values: Floats) -> None:
        """Take up readings made before, the first one excepted, which is read again."""
        self._values = values.tolist()

    def read(self, state: State, scheme: Scheme) -> None:
        """Take the energy at a step's end."""
        wires, heads = state.wires, state.heads
        q, v = (a[:, 0] + by * wires.x[:, 0] for a, by in ((wires.q, scheme.b), (wires.v, scheme.g)))
        total = self._of_wires(q[: self._model.size], v[: self._model.size])
        for p, chain in enumerate(self._chains):
            m = len(chain.K)
            x: Floats = heads.x[0, p, :m]
            y, w = heads.q[0, p, :m] + scheme.b * x, heads.v[0, p, :m] + scheme.g * x
            total += float((w @ chain.M @ w + y @ chain.K @ y) / 2 - chain.uplift * chain.load @ y)
        self._values.append(total)

    def _of_wires(self, q: Floats, v: Floats) -> float:
        from catenary_fe.fe.cable import strain_energy

        model, axes = self._model, np.arange(self._model.axes)
        total = model.reference + np.where(model.place >= 0, q[model.place], 0.0)
        index = model.first[:, None] + np.arange(4 * model.axes)
        stored = strain_energy(model.cables, total[index].reshape(-1, 4, model.axes)).sum()
        for springs, two_ends in ((model.droppers, True), (model.links, False)):
            upper = total[springs.last[:, None] + axes] if two_ends else springs.pivot
            span = np.linalg.norm(upper - total[springs.first[:, None] + axes], axis=1)
            stretch = span - springs.length
            stored += springs.stiffness @ (np.maximum(stretch, 0.0) if two_ends else stretch) ** 2 / 2
        stored += model.ground_stiffness @ q**2 / 2 - model.force @ q
        return float(stored + v @ (model.mass @ v) / 2)
