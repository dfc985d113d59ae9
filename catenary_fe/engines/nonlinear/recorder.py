"""How far a compiled nonlinear run has come: its state and what it recorded until then."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import Records
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.history import History
from catenary_fe.engines.nonlinear.setup import Parameters
from catenary_fe.engines.nonlinear.state import State
from catenary_fe.engines.tension import TensionRecord
from catenary_fe.fe.contact import PlacedPantograph

Floats = NDArray[np.float64]
_BY_STEP = ("force", "height", "lateral", "masses", "droppers", "supports")


class EnergyRecord:
    """Readings of the kinetic and stored energy, contacts left out: the same as Exudyn's runs record.

    The potential of constant forces (weight, tensions, preloads, uplift) counts as stored.
    """

    def __init__(self, parameters: Parameters, pantographs: Sequence[PlacedPantograph]) -> None:
        self._parameters, self._pantographs = parameters, pantographs
        self._stored: Floats = np.full(parameters.rows.starts.size - 1, np.nan)
        self._values: list[float] = []

    @property
    def values(self) -> Floats:
        """[J], shape (readings,)."""
        return np.array(self._values)

    def go_on(self, values: Floats) -> None:
        """Take up readings made before, the first one excepted, which is read again."""
        self._values = values.tolist()
        self._stored[:] = np.nan

    def read(self, state: State, scheme: Scheme, sections: tuple[int, int]) -> None:
        """Take the energy at a step's end; sections that were not computed in it store what they did."""
        wires, own, system = state.wires, state.pantographs, self._parameters.system
        q, v = (a[:, 0] + by * wires.x[:, 0] for a, by in ((wires.q, scheme.b), (wires.v, scheme.g)))
        rows = self._parameters.rows.place
        q, v = q[rows], v[rows]
        moved = system.spread(q)
        for section, part in enumerate(self._parameters.sections):
            if sections[0] <= section < sections[1] or np.isnan(self._stored[section]):
                self._stored[section] = part.energy(moved)
        total = float(self._stored.sum() + v @ (self._parameters.mass @ v) / 2)
        for p, placed in enumerate(self._pantographs):
            body, m = placed.body, placed.body.size
            x: Floats = own.x[0, p, :m]
            y, w = own.q[0, p, :m] + scheme.b * x, own.v[0, p, :m] + scheme.g * x
            total += body.energy(y, w, self._risen(state, scheme, p)) - placed.uplift * float(body.load @ y)
        self._values.append(total)

    def _risen(self, state: State, scheme: Scheme, p: int) -> float:
        """[m] of a pantograph's base now, by what it follows and by what moves it."""
        heads, step = state.heads, int(state.pantographs.step[0])
        position = float(heads.place[0, p] + heads.pace[0] * scheme.h * step)
        moved = heads.base.values[p, step, 0] if heads.base.last[p] >= 0 else 0.0
        line, body = self._parameters.system.base_line, self._pantographs[p].body
        return line.under(body, position) + float(moved)


@dataclass
class RunRecorder:
    """A run under way."""

    state: State
    records: Records
    tension: TensionRecord
    energy: EnergyRecord

    def read(
        self, scheme: Scheme, displacements: NDArray[np.float64], sections: tuple[int, int] = (0, 0)
    ) -> None:
        """Take tensions and energy where the run is now.

        displacements : [m], shape (all,)
        sections : from the first one that was computed to before the last
        """
        # energies first: what has no time yet is cut where a run is interrupted
        self.energy.read(self.state, scheme, sections)
        self.tension.read(scheme.h * int(self.state.pantographs.step[0]), displacements)

    def joined(self, history: History) -> History:
        """The history with what was read on the way."""
        return replace(
            self.tension.joined(history),
            energy=self.energy.values,
            energy_times=self.tension.times,
            driven_work=self.state.energy.history[0],
            lost_work=self.state.energy.history[1],
        )

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a run needs to go on from here with the same result."""
        done = int(self.state.pantographs.step[0])
        found = self.state.arrays() | {
            "tension_times": self.tension.times,
            "tension_changes": self.tension.changes,
            "tension_spans": self.tension.spans,
            "energies": self.energy.values,
            "energy": self.state.energy.history[:, : done + 1],
        }
        for name in _BY_STEP:
            found[f"record_{name}"] = getattr(self.records, name)[..., : done + 1]
        if self.records.every:
            found["record_wire"] = self.records.wire[:, : done // self.records.every + 1]
        return found

    def go_on(self, arrays: Mapping[str, NDArray[Any]]) -> int:
        """Go on from :meth:`arrays`; returns the number of steps done."""
        self.state.go_on(arrays)
        self.tension.go_on(*(arrays[f"tension_{name}"] for name in ("times", "changes", "spans")))
        self.energy.go_on(arrays["energies"])
        done = int(self.state.pantographs.step[0])
        self.state.energy.history[:, : done + 1] = arrays["energy"]
        for name in _BY_STEP:
            getattr(self.records, name)[..., : done + 1] = arrays[f"record_{name}"]
        if self.records.every:
            self.records.wire[:, : done // self.records.every + 1] = arrays["record_wire"]
        return done
