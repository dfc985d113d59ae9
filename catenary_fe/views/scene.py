"""What moves in a run, frame by frame: what a film and the report's player draw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.results import Run, WireHistory

Floats = NDArray[np.float64]
MASS_GAP = 0.3  # [m] drawn between a pantograph's masses


@dataclass(frozen=True)
class Scene:
    """Wires, droppers and pantographs at the times of the frames.

    time : [s], shape (frames,)
    wires : with their shapes at these times; contact wires first
    dropper_x : [m], shape (droppers,)
    dropper_ends : numbers in ``wires`` of each dropper's lower and upper wire, shape (droppers, 2)
    dropper_slack : shape (frames, droppers)
    support_x : [m], shape (supports,)
    pantograph_x : [m], shape (pantographs, frames)
    rest : [m], shape (pantographs, frames), static height of the contact wire at each pantograph
    masses : for each pantograph [m] shape (masses, frames), motion above ``rest`` since the run's start
    force : [N], shape (pantographs, frames), low-passed at 20 Hz
    """

    time: Floats
    wires: tuple[WireHistory, ...]
    dropper_x: Floats
    dropper_ends: NDArray[np.int64]
    dropper_slack: NDArray[np.bool_]
    support_x: Floats
    pantograph_x: Floats
    rest: Floats
    masses: tuple[Floats, ...]
    force: Floats

    def heights(self, wire: int, frame: int, magnified: float = 1.0) -> Floats:
        """[m], shape (points,), of a wire, its motion magnified about the static shape."""
        history = self.wires[wire]
        heights: Floats = history.static + magnified * history.uplift[frame]
        return heights

    def mass_heights(self, pantograph: int, magnified: float = 1.0) -> Floats:
        """[m], shape (masses, frames), that masses are drawn at: below the wire at rest, motion magnified."""
        motion = self.masses[pantograph]
        below = MASS_GAP * np.arange(len(motion))[:, None]
        heights: Floats = self.rest[pantograph] - below + magnified * motion
        return heights

    def extent(self, start: float, end: float, magnified: float = 1.0) -> tuple[float, float]:
        """[m] lowest and highest of what is drawn between two positions [m] along the line, in all frames."""
        heights = []
        for wire in self.wires:
            shown = (wire.x >= start) & (wire.x <= end)
            heights.append((wire.static + magnified * wire.uplift)[:, shown].ravel())
        for i, x in enumerate(self.pantograph_x):
            seen = (x >= start) & (x <= end)
            heights += [self.rest[i, seen], self.mass_heights(i, magnified)[:, seen].ravel()]
        drawn = np.concatenate(heights)
        return float(np.nanmin(drawn)), float(np.nanmax(drawn))


def scene(run: Run, frames: Sequence[int] | NDArray[np.int64] | None = None) -> Scene:
    """The scene of a run at some of its stored wire shapes (numbers from 0); unset: at all of them.

    Raises InputError where the run stored no wire shapes.
    """
    wires = run.wires()
    chosen = np.arange(wires[0].time.size) if frames is None else np.asarray(frames)
    at = np.searchsorted(run.time, wires[0].time[chosen] - 0.5 * run.step)
    data = run.data
    dropper_x = np.asarray(data["dropper_position"].values)
    hung = run.catenary.dropper_contact_wires
    positions, masses = np.asarray(data["position"].values), data["mass_height"].values
    rest = np.interp(positions, wires[0].x, wires[0].static)
    moved = (masses - masses[:, :, :1] - (rest - rest[:, :1])[:, None, :])[:, :, at]
    return Scene(
        time=wires[0].time[chosen],
        wires=tuple(
            WireHistory(wire.name, wire.x, wire.static, wire.height[chosen], wire.time[chosen])
            for wire in wires
        ),
        dropper_x=dropper_x,
        dropper_ends=np.array(
            [_ends(wires, x, int(n)) for x, n in zip(dropper_x, hung, strict=True)], dtype=np.int64
        ).reshape(-1, 2),
        dropper_slack=np.asarray(data["dropper_force"].values[:, at] <= 0).T,
        support_x=np.asarray(data["support_position"].values),
        pantograph_x=positions[:, at],
        rest=rest[:, at],
        masses=tuple(m[np.isfinite(m[:, 0])] for m in moved),
        force=run.filtered_contact_force()[:, at],
    )


def _ends(wires: Sequence[WireHistory], x: float, number: int) -> tuple[int, int]:
    """The contact wire (of this number, from 0) at a dropper, and the lowest other wire above it there."""
    heights = [float(np.interp(x, w.x, w.static, left=np.nan, right=np.nan)) for w in wires]
    lower = [i for i, wire in enumerate(wires) if wire.touched][number]
    above = [i for i, wire in enumerate(wires) if not wire.touched and np.isfinite(heights[i])]
    return lower, min(above, key=lambda i: heights[i], default=lower)
