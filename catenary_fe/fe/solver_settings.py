"""What a user may choose about the time integration; no solver is loaded to choose it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from catenary_fe.system import InputError
from catenary_fe.system.frozen import changed_by_copy

SHORTEST_STEP = 1e-6  # [s] below it a run takes weeks, and its histories more memory than there is


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class TimeSettings:
    """Time integration. The defaults come from the study in ``models/studies/convergence.py``.

    step : [s] fixed time step
    tolerance : relative, of the Newton iteration
    spectral_radius : of the generalised-α method at high frequencies, 1: trapezoidal rule, no damping

    Raises InputError for values outside their bounds.
    """

    step: float = 1e-3
    tolerance: float = 1e-4
    spectral_radius: float = 0.9

    def __post_init__(self) -> None:
        if not (np.isfinite(self.step) and SHORTEST_STEP <= self.step <= 0.02):
            raise InputError(
                f"time step = {self.step!r} s: must lie between {SHORTEST_STEP:g} and 0.02 s; 0.001 is usual"
            )
        if not 0 < self.tolerance <= 1e-2:
            raise InputError(f"tolerance = {self.tolerance!r}: must lie between 0 and 0.01")
        if not 0 <= self.spectral_radius <= 1:
            raise InputError(f"spectral_radius = {self.spectral_radius!r}: must lie between 0 and 1")
