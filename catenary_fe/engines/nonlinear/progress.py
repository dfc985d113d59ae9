"""How far a compiled nonlinear run has come: its state and what it recorded until then."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import Records
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.nonlinear.energy import EnergyRecord
from catenary_fe.engines.nonlinear.state import State

if TYPE_CHECKING:
    from catenary_fe.engines.exudyn.run import History
    from catenary_fe.engines.tension import TensionRecord

_BY_STEP = ("force", "height", "masses", "droppers", "supports")


@dataclass
class RunRecorder:
    """A run under way."""

    state: State
    records: Records
    tension: TensionRecord
    energy: EnergyRecord

    def read(self, scheme: Scheme, displacements: NDArray[np.float64]) -> None:
        """Take tensions and energy where the run is now; displacements of all coordinates."""
        self.energy.read(self.state, scheme)  # first: what has no time yet is cut where a run is interrupted
        self.tension.read(scheme.h * int(self.state.heads.step[0]), displacements)

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
        done = int(self.state.heads.step[0])
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
        done = int(self.state.heads.step[0])
        self.state.energy.history[:, : done + 1] = arrays["energy"]
        for name in _BY_STEP:
            getattr(self.records, name)[..., : done + 1] = arrays[f"record_{name}"]
        if self.records.every:
            self.records.wire[:, : done // self.records.every + 1] = arrays["record_wire"]
        return done
