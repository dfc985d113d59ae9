"""Contact-force statistics in the field's terms."""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from catenary_fe.results.signal import FilterKind, band_pass, low_pass
from catenary_fe.system.frozen import changed_by_copy

Floats = NDArray[np.float64]


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class ForceStatistics:
    """Statistics of one pantograph's contact force, low-passed at 20 Hz, over the evaluated spans.

    mean, std : [N]
    std_0_5, std_5_20 : [N] standard deviation between 0 and 5 Hz, and between 5 and 20 Hz
    statistical_max, statistical_min : [N] mean ± 3 std
    max, min : [N] actual extremes of the filtered force
    contact_loss : share of the time without contact, of the unfiltered force
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
    contact_point_range: float
    filter: FilterKind

    def as_dict(self) -> dict[str, float | str]:
        """In display units, ready for JSON."""
        return {
            "name": self.pantograph,
            "mean_N": self.mean,
            "std_N": self.std,
            "std_0_5_Hz_N": self.std_0_5,
            "std_5_20_Hz_N": self.std_5_20,
            "statistical_max_N": self.statistical_max,
            "statistical_min_N": self.statistical_min,
            "max_N": self.max,
            "min_N": self.min,
            "contact_loss_percent": 100 * self.contact_loss,
            "contact_point_range_mm": 1e3 * self.contact_point_range,
        }

    @classmethod
    def none_as_dict(cls, pantograph: str) -> dict[str, float | str | None]:
        """As :meth:`as_dict`, with nothing in it: of spans that were not passed."""
        names = [f.name for f in fields(cls) if f.name not in ("pantograph", "filter")]
        empty = cls(pantograph=pantograph, filter="causal", **dict.fromkeys(names, float("nan")))
        return dict.fromkeys(empty.as_dict()) | {"name": pantograph}

    def __str__(self) -> str:
        return (
            f"{self.pantograph}: mean {self.mean:.1f} N, standard deviation {self.std:.1f} N, "
            f"statistical maximum {self.statistical_max:.1f} N and minimum {self.statistical_min:.1f} N, "
            f"actual maximum {self.max:.1f} N and minimum {self.min:.1f} N, "
            f"contact loss {100 * self.contact_loss:.2f} %"
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
        contact_point_range=float(np.ptp(height[inside])),
        filter=filter,
    )
