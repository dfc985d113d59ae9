"""Uplifts with which pantographs reach the mean contact forces that are asked for."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from catenary_fe.analysis.checkpoint import Checkpoint
from catenary_fe.results import Run
from catenary_fe.system import AnyPantograph, InputError, Pantograph, SolverError
from catenary_fe.system.current_collection import MEAN_FORCE_TOLERANCE

Floats = NDArray[np.float64]

MEAN_FORCE_RUNS = 6


class MeanForce:
    """Uplifts [N] of a run's pantographs, and the next ones to try, by secants.

    uplifts : shape (pantographs,), to run with

    Raises InputError where uplift and air push a pantograph down.
    """

    def __init__(self, pantographs: Sequence[AnyPantograph], speed: float) -> None:
        self.uplifts = _uplifts(pantographs, speed)
        self._targets = [p.target_mean_force(speed) for p in pantographs]
        self._before: tuple[Floats, Floats] | None = None
        self._runs = 0

    def state(self) -> dict[str, Floats]:
        """What is known so far, as arrays."""
        before = self._before or (self.uplifts, np.full_like(self.uplifts, np.nan))
        return {"uplifts": self.uplifts, "before": np.array(before), "runs": np.array(float(self._runs))}

    def take_up(self, checkpoint: Checkpoint) -> None:
        """Go on from what a checkpoint carries, and let it carry on."""
        if checkpoint.kept:
            self._go_on(checkpoint.kept)
        checkpoint.carried = self.state()

    def _go_on(self, state: Mapping[str, Floats]) -> None:
        self.uplifts, self._runs = state["uplifts"], int(state["runs"])
        uplifts, means = state["before"]
        self._before = None if np.isnan(means).any() else (uplifts, means)

    def reached(self, run: Run) -> bool:
        """Whether a run with these uplifts has the means that are asked for; if not, other uplifts are set.

        Raises SolverError when it takes too many runs.
        """
        if all(target is None for target in self._targets):
            return True
        self._runs += 1
        means = np.array([s.mean for s in run.contact_force_statistics()])
        goals = np.array([m if t is None else t for m, t in zip(means, self._targets, strict=True)])
        if np.abs(means - goals).max() <= MEAN_FORCE_TOLERANCE:
            return True
        if self._runs == MEAN_FORCE_RUNS:
            raise SolverError(
                f"mean contact force: after {self._runs} runs the means are {np.round(means, 2).tolist()} N,"
                f" not {np.round(goals, 2).tolist()} N; give an uplift_force instead of a mean_force"
            )
        slope = means / self.uplifts
        if self._before is not None:
            step = self.uplifts - self._before[0]
            moved = np.abs(step) > 1e-6
            secant = (means - self._before[1]) / np.where(moved, step, 1.0)
            slope = np.where(moved & (secant > 0.3) & (secant < 3), secant, slope)
        self._before = self.uplifts, means
        self.uplifts = self.uplifts + (goals - means) / slope
        return False


def _uplifts(pantographs: Sequence[AnyPantograph], speed: float) -> Floats:
    """[N], shape (pantographs,): forces on the lowest masses, the air's included."""
    uplifts = np.array([p.static_uplift(speed) for p in pantographs])
    faults = [
        f"{pantograph.name}: uplift and aerodynamic force add up to {uplift:.6g} N at {3.6 * speed:g} km/h:"
        " must be above 0, or the head stays down; change uplift_force or aerodynamic_force"
        for pantograph, uplift in zip(pantographs, uplifts, strict=True)
        if isinstance(pantograph, Pantograph) and uplift <= 0
    ]
    if faults:
        raise InputError(*faults)
    return uplifts
