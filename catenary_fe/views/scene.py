"""What moves in a run, frame by frame: what a film and the report's player draw."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.results import Run, WireHistory

Floats = NDArray[np.float64]


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
    masses : for each pantograph [m] shape (masses, frames), motion above the height in the first frame
    force : [N], shape (pantographs, frames), low-passed at 20 Hz
    nominal : [m] nominal contact wire height
    """

    time: Floats
    wires: tuple[WireHistory, ...]
    dropper_x: Floats
    dropper_ends: NDArray[np.int64]
    dropper_slack: NDArray[np.bool_]
    support_x: Floats
    pantograph_x: Floats
    masses: tuple[Floats, ...]
    force: Floats
    nominal: float

    def heights(self, wire: int, frame: int, magnified: float = 1.0) -> Floats:
        """[m], shape (points,), of a wire, its motion magnified about the static shape."""
        history = self.wires[wire]
        heights: Floats = history.static + magnified * history.uplift[frame]
        return heights


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
    masses = data["mass_height"].values
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
        pantograph_x=np.asarray(data["position"].values[:, at]),
        masses=tuple(m[np.isfinite(m[:, 0])][:, at] - m[np.isfinite(m[:, 0])][:, :1] for m in masses),
        force=run.filtered_contact_force()[:, at],
        nominal=run.catenary.contact_wire_height,
    )


def _ends(wires: Sequence[WireHistory], x: float, number: int) -> tuple[int, int]:
    """The contact wire (of this number, from 0) at a dropper, and the lowest other wire above it there."""
    heights = [float(np.interp(x, w.x, w.static, left=np.nan, right=np.nan)) for w in wires]
    lower = [i for i, wire in enumerate(wires) if wire.touched][number]
    above = [i for i, wire in enumerate(wires) if not wire.touched and np.isfinite(heights[i])]
    return lower, min(above, key=lambda i: heights[i], default=lower)
