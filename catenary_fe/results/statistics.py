"""Contact-force statistics in the field's terms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.results.quantities import FORCE
from catenary_fe.results.signal import FilterKind, band_pass, low_pass

Floats = NDArray[np.float64]
LONG_LOSS = 5e-3  # [s] shorter losses make no arc that EN 50317 counts (recalled)


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class ForceStatistics:
    """Statistics of one pantograph's contact force, low-passed at 20 Hz, over the evaluated spans.

    mean, std : [N]
    std_0_5, std_5_20 : [N] standard deviation between 0 and 5 Hz, and between 5 and 20 Hz
    statistical_max, statistical_min : [N] mean ± 3 std
    max, min : [N] actual extremes of the filtered force
    contact_loss : share of the time at which the unfiltered force is 0, however short each loss is
    long_contact_loss : share of the time in losses longer than 5 ms, likewise; this is what is judged
    long_losses : number of these
    longest_loss : [s] of the longest loss, be it a long one or not
    contact_point_range : [m] between highest and lowest point of contact
    filter : which low-pass was used
    """

    pantograph: str
    mean: float
    std: float
    std_0_5: float
    std_5_20: float
    statistical_max: float
    statistical_min: float
    max: float
    min: float
    contact_loss: float
    long_contact_loss: float
    long_losses: int
    longest_loss: float
    contact_point_range: float
    filter: FilterKind

    def as_dict(self) -> dict[str, float | str]:
        """In display units, ready for JSON."""
        return {"name": self.pantograph} | {q.key: q.shown(getattr(self, own)) for own, q in FORCE.items()}

    @classmethod
    def from_dict(cls, record: Mapping[str, Any], filter: FilterKind) -> ForceStatistics:
        """What :meth:`as_dict` returned, other entries left out; ``filter``: which low-pass was used."""
        values: dict[str, Any] = {own: q.si(record[q.key]) for own, q in FORCE.items()}
        return cls(pantograph=record["name"], filter=filter, **values)

    @classmethod
    def none_as_dict(cls, pantograph: str) -> dict[str, float | str | None]:
        """As :meth:`as_dict`, all None: of spans that were not passed."""
        return {"name": pantograph, **{q.key: None for q in FORCE.values()}}

    def __str__(self) -> str:
        said = {own: q.text(self) for own, q in FORCE.items()}
        return (
            f"{self.pantograph}: mean {said['mean']}, standard deviation {said['std']}, "
            f"statistical maximum {said['statistical_max']} and minimum {said['statistical_min']}, "
            f"actual maximum {said['max']} and minimum {said['min']}, contact loss {said['contact_loss']}, "
            f"{said['long_contact_loss']} in {self.long_losses} losses longer than 5 ms, the longest "
            f"{said['longest_loss']}"
        )


def force_statistics(
    *,
    name: str,
    force: Floats,
    height: Floats,
    inside: NDArray[np.bool_],
    step: float,
    filter: FilterKind = "causal",
) -> ForceStatistics:
    """Filter the whole history, then evaluate the part inside the window.

    name : of the pantograph
    force : [N], shape (times,), unfiltered
    height : [m], shape (times,), of the point of contact
    inside : shape (times,), true where the force is evaluated
    step : [s] between the times
    """
    filtered = low_pass(force, step, kind=filter)[inside]
    mean, std = float(filtered.mean()), float(filtered.std())
    return ForceStatistics(
        pantograph=name,
        mean=mean,
        std=std,
        std_0_5=float(low_pass(force, step, 5.0, kind=filter)[inside].std()),
        std_5_20=float(band_pass(force, step, 5.0, 20.0, kind=filter)[inside].std()),
        statistical_max=mean + 3 * std,
        statistical_min=mean - 3 * std,
        max=float(filtered.max()),
        min=float(filtered.min()),
        contact_loss=float((force[inside] <= 0).mean()),
        **_long_losses(force <= 0, inside, step),
        contact_point_range=float(np.ptp(height[inside])),
        filter=filter,
    )


def governing(
    figures: Sequence[ForceStatistics | None], excess: Mapping[str, float] | None = None
) -> str | None:
    """Name of the governing pantograph; None where there are no figures.

    excess : by name, how many times its limit the criterion is that a pantograph misses by most

    It is the one that misses a limit by most; where none misses any, the one whose standard deviation is the
    largest share of its mean force, which every power system limits.
    """
    known = [s for s in figures if s]
    if not known:
        return None
    over = excess or {}
    worst = max(known, key=lambda s: (over.get(s.pantograph, 0.0), s.std / max(s.mean, 1e-9)))
    return worst.pantograph


def _long_losses(lost: NDArray[np.bool_], inside: NDArray[np.bool_], step: float) -> dict[str, Any]:
    """Of the losses that reach into the window: those that last; each sample stands for one step."""
    edges = np.flatnonzero(np.diff(lost, prepend=False, append=False))
    losses = [(a, b) for a, b in edges.reshape(-1, 2) if inside[a:b].any()]
    long = [(a, b) for a, b in losses if (b - a) * step > LONG_LOSS * (1 + 1e-9)]
    return {
        "long_contact_loss": float(sum(inside[a:b].sum() for a, b in long) / inside.sum()),
        "long_losses": len(long),
        "longest_loss": float(max((b - a for a, b in losses), default=0) * step),
    }
