"""How far a compiled nonlinear run has come: its state and what it recorded until then."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from catenary_fe.analysis.linear_arrays import Records
from catenary_fe.analysis.nonlinear.state import State

if TYPE_CHECKING:
    from catenary_fe.fe.tension import TensionRecord

_BY_STEP = ("force", "height", "masses", "droppers", "supports")


@dataclass
class Course:
    """A run under way."""

    state: State
    records: Records
    tension: TensionRecord

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What a run needs to go on from here with the same result."""
        done = int(self.state.heads.step[0])
        found = self.state.arrays() | {
            "tension_times": self.tension.times,
            "tension_changes": self.tension.changes,
        }
        for name in _BY_STEP:
            found[f"record_{name}"] = getattr(self.records, name)[..., : done + 1]
        if self.records.every:
            found["record_wire"] = self.records.wire[:, : done // self.records.every + 1]
        return found

    def go_on(self, arrays: Mapping[str, NDArray[Any]]) -> int:
        """Go on from :meth:`arrays`; returns the number of steps done."""
        self.state.go_on(arrays)
        self.tension.go_on(arrays["tension_times"], arrays["tension_changes"])
        done = int(self.state.heads.step[0])
        for name in _BY_STEP:
            getattr(self.records, name)[..., : done + 1] = arrays[f"record_{name}"]
        if self.records.every:
            self.records.wire[:, : done // self.records.every + 1] = arrays["record_wire"]
        return done
