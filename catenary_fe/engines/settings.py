"""What a user may choose about the time integration; no solver is loaded to choose it."""

from __future__ import annotations

from dataclasses import dataclass

from catenary_fe.layout.arguments import number
from catenary_fe.layout.parameters import changed_by_copy

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
        number("time step", self.step, "s", least=SHORTEST_STEP, most=0.02, remedy="0.001 s is usual")
        number("tolerance", self.tolerance, above=0.0, most=0.01)
        number("spectral_radius", self.spectral_radius, least=0.0, most=1.0)
