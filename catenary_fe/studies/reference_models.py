"""The reference model of EN 50318:2002, and the ranges in which its results must lie.

No text of the standard was open to us: ranges and the published result are from secondary sources.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from catenary_fe.layout import Catenary, Dropper, RayleighDamping, SteadyArm, Support, library

SOURCE = "EN 50318:2002 (secondary source)"
PANTOGRAPH = "EN 50318:2002"
NAMES = (
    ("mean force", "N"),
    ("standard deviation", "N"),
    ("statistical maximum", "N"),
    ("statistical minimum", "N"),
    ("actual maximum", "N"),
    ("actual minimum", "N"),
    ("largest uplift at a support", "mm"),
    ("loss of contact", "%"),
)
RANGES = {  # by speed [km/h], in the order of the names
    250: ((110, 120), (26, 31), (190, 210), (20, 40), (175, 210), (50, 75), (48, 55), (0, 0)),
    300: ((110, 120), (32, 40), (210, 230), (-5, 20), (190, 225), (30, 55), (55, 65), (0, 0)),
}
PUBLISHED = {  # inside the ranges (secondary source); the loss of contact is not among them
    250: (118.2, 27.6, 201.1, 35.5, 193.7, 70.3, 52.2),
    300: (118.7, 32.8, 213.2, 19.2, 195.4, 54.7, 59.7),
}
_KEYS = (
    "mean_N", "std_N", "statistical_max_N", "statistical_min_N", "max_N", "min_N", "max_support_uplift_mm",
    "contact_loss_percent",
)  # fmt: skip


def reference_line(spans: int = 10, evaluated_spans: Sequence[int] = (5, 6)) -> Catenary:
    """The model of EN 50318:2002, or fewer spans of it; sources as of the library."""
    arm = SteadyArm(stiffness=300.0, mass=0.3, holds_design_height=True)
    at = (5.0, 10.5, 17.0, 23.5, 30.0, 36.5, 43.0, 49.5, 55.0)
    return Catenary.regular(
        name="EN 50318:2002 reference model",
        spans=spans,
        span_length=60.0,
        droppers=[Dropper(position=x) for x in at],
        contact_wire=library.wire("EN 50318:2002 contact wire", tension=20e3),
        messenger_wire=library.wire("EN 50318:2002 messenger wire", tension=16e3),
        support=Support(messenger_stiffness=5e5, steady_arm=arm),
        damping=RayleighDamping(beta=1e-4),
        evaluated_spans=tuple(evaluated_spans),
    )


@dataclass(frozen=True)
class InRange:
    """A figure of the model beside its range.

    value, low, high : in ``unit``
    """

    speed_kmh: int
    name: str
    unit: str
    value: float
    low: float
    high: float
    source: str = SOURCE

    @property
    def passed(self) -> bool:
        """Whether it lies inside."""
        return self.low <= self.value <= self.high

    def as_dict(self) -> dict[str, Any]:
        """Ready for JSON and tables."""
        return {
            "speed_kmh": self.speed_kmh, "figure": self.name, "unit": self.unit, "computed": self.value,
            "from": self.low, "to": self.high, "passed": self.passed, "source": self.source,
        }  # fmt: skip


def in_ranges(summary: dict[str, Any], speed_kmh: int) -> list[InRange]:
    """Figures of a run's summary at 250 or 300 km/h beside the ranges of that speed."""
    found = summary["pantographs"][0] | summary
    rows = zip(NAMES, _KEYS, RANGES[speed_kmh], strict=True)
    return [InRange(speed_kmh, name, unit, float(found[key]), *limits) for (name, unit), key, limits in rows]
