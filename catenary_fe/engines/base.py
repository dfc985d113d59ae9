"""What engines are asked for, and what they share."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.contact import PlacedPantograph, place
from catenary_fe.fe.system import System
from catenary_fe.layout import AnyPantograph

Floats = NDArray[np.float64]
Progress = Callable[[float], None]


@dataclass(frozen=True)
class RunCase:
    """One run to do.

    speed : [m/s]
    start : [m], shape (pantographs,), positions along the track
    distance : [m] that each pantograph runs
    warnings : known before the run
    """

    pantographs: Sequence[AnyPantograph]
    speed: float
    start: Floats
    distance: float
    warnings: Sequence[str] = ()

    def placed(self, uplifts: Floats, system: System) -> list[PlacedPantograph]:
        """The pantographs, each with its uplift [N], on a line where they start."""
        spatial, height = system.spatial, system.contact_wire_height
        return place(self.pantographs, uplifts, self.start, spatial=spatial, height=height, speed=self.speed)

    def steps(self, step: float) -> int:
        """Number of time steps [s]."""
        return int(np.floor(self.distance / (self.speed * step) + 1e-9))
