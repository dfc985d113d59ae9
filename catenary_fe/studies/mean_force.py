"""Uplifts with which pantographs reach the mean contact forces that are asked for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.checkpoint import Checkpoint
from catenary_fe.layout import AnyPantograph, SolverError
from catenary_fe.layout.current_collection import MEAN_FORCE_TOLERANCE
from catenary_fe.results import Run

Floats = NDArray[np.float64]

MEAN_FORCE_RUNS = 6
SLOPES = 0.3, 3.0  # of a mean over its uplift, at least and at most: others are chance
TOO_SMALL = 1e-6  # [N]


class MeanForce:
    """Uplifts [N] of a run's pantographs, and the next ones to try, by secants.

    uplifts : shape (pantographs,), to run with
    sought : whether any pantograph asks for a mean force

    Raises InputError where uplift and air push a pantograph down.
    """

    def __init__(self, pantographs: Sequence[AnyPantograph], speed: float) -> None:
        self.uplifts = np.array([p.static_uplift(speed) for p in pantographs])
        self._pantographs = pantographs
        self._targets = [p.target_mean_force(speed) for p in pantographs]
        self.sought = any(target is not None for target in self._targets)
        self._before: tuple[Floats, Floats] | None = None
        self._slope: Floats | None = None  # what a newton more adds to a mean, by the last runs
        self._known: Floats | None = None  # likewise, by runs of another kind
        self._runs = 0

    def state(self) -> dict[str, Floats]:
        """What is known so far, as arrays."""
        nothing = np.full_like(self.uplifts, np.nan)
        before = self._before or (self.uplifts, nothing)
        slope = nothing if self._known is None else self._known
        runs = np.array(float(self._runs))
        return {"uplifts": self.uplifts, "before": np.array(before), "slope": slope, "runs": runs}

    def take_up(self, checkpoint: Checkpoint) -> None:
        """Go on from what a checkpoint carries, and let it carry on."""
        if state := checkpoint.kept:
            self.uplifts, self._runs = state["uplifts"], int(state["runs"])
            uplifts, means = state["before"]
            self._before = None if np.isnan(means).any() else (uplifts, means)
            self._known = None if np.isnan(state["slope"]).any() else state["slope"]
        checkpoint.carried = self.state()

    def given(self) -> list[AnyPantograph]:
        """The pantographs with these uplifts, not asking for a mean force. Raises InputError."""
        return [
            p.with_uplift(float(uplift)) for p, uplift in zip(self._pantographs, self.uplifts, strict=True)
        ]

    def aim(self, run: Run) -> float:
        """Set the next uplifts by a run with these ones; returns by how much [N] it misses a mean force."""
        means, goals = self._means(run)
        self._slope = self._slope_at(means)
        self._before = self.uplifts, means
        self.uplifts = self.uplifts + (goals - means) / self._slope
        return float(np.abs(goals - means).max())

    def begin_anew(self) -> None:
        """Runs to come are of another kind: of those before, only how a mean follows its uplift is kept."""
        self._known = self._slope
        self._before, self._runs = None, 0

    def reached(self, run: Run) -> bool:
        """Whether a run with these uplifts has the means that are asked for; if not, other uplifts are set.

        Raises SolverError when it takes too many runs.
        """
        if not self.sought:
            return True
        self._runs += 1
        if self.aim(run) <= MEAN_FORCE_TOLERANCE:
            return True
        if self._runs == MEAN_FORCE_RUNS:
            means, goals = self._means(run)
            raise SolverError(
                f"mean contact force: after {self._runs} runs the means are {np.round(means, 2).tolist()} N,"
                f" not {np.round(goals, 2).tolist()} N; give an uplift_force instead of a mean_force"
            )
        return False

    def _means(self, run: Run) -> tuple[Floats, Floats]:
        """Mean contact forces of a run, and those that it should have, the same where none is asked for."""
        means = np.array([s.mean for s in run.contact_force_statistics()])
        return means, np.array([m if t is None else t for m, t in zip(means, self._targets, strict=True)])

    def _slope_at(self, means: Floats) -> Floats:
        low, high = SLOPES
        slope = self._known
        if slope is None:
            slope = np.clip(means / np.maximum(self.uplifts, TOO_SMALL), low, high)
        if self._before is None:
            return slope
        step = self.uplifts - self._before[0]
        moved = np.abs(step) > TOO_SMALL
        secant = (means - self._before[1]) / np.where(moved, step, 1.0)
        return np.where(moved & (secant > low) & (secant < high), secant, slope)
