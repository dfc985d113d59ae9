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
        return self._model.system.energy(self._model.system.spread(q)) + float(v @ (self._model.mass @ v) / 2)
