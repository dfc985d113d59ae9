"""Energy of wires and pantographs during a compiled run."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.linearised.start import Substructure
from catenary_fe.engines.nonlinear.state import State

if TYPE_CHECKING:
    from catenary_fe.fe.nonlinear_model import NonlinearModel

Floats = NDArray[np.float64]


class EnergyRecord:
    """Readings of the kinetic and stored energy, contacts left out: the same as Exudyn's runs record.

    The potential of constant forces (weight, tensions, preloads, uplift) counts as stored.
    """

    def __init__(self, model: NonlinearModel, bodies: Sequence[Substructure]) -> None:
        self._model, self._bodies = model, bodies
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
        for p, body in enumerate(self._bodies):
            m = len(body.K)
            x: Floats = heads.x[0, p, :m]
            y, w = heads.q[0, p, :m] + scheme.b * x, heads.v[0, p, :m] + scheme.g * x
            total += float((w @ body.M @ w + y @ body.K @ y) / 2 - body.uplift * body.load @ y)
        self._values.append(total)

    def _of_wires(self, q: Floats, v: Floats) -> float:
        return self._model.system.energy(self._model.system.spread(q)) + float(v @ (self._model.mass @ v) / 2)
