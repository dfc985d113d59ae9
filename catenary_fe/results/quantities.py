"""Names, symbols, units, digits and keys of the figures that tables, reports, files and the docs show."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

FACTORS = {"N": 1, "mm": 1000, "ms": 1000, "%": 100, "": 1}
"""From SI to the unit that a figure is shown in."""
DIGITS = {"N": 1, "mm": 1, "ms": 1, "km/h": 1, "%": 2, "": 0}
"""Decimals of a figure in tables, by its unit."""
DECIMALS = {
    "mm_per_N": 4, "N_per_m": 1, "kN": 3, "mm": 2, "m": 3, "N": 1, "s": 4, "Hz": 4, "deg": 2, "percent": 3,
    "ratio": 6,
}  # fmt: skip
"""Decimals of numbers in a CSV column whose name ends with this unit; others keep ten digits."""
FINER = {"length_m": 4, "installed_length_m": 4}
"""Of these columns: what is cut and checked to the millimetre needs one decimal more."""
OF_HISTORIES = DECIMALS | {"m": 6, "N": 2, "s": 6}
"""Of numbers that vary in time: an uplift is worth a micrometre, a time step may be one too."""


@dataclass(frozen=True)
class Quantity:
    """How a figure is shown.

    key : in JSON and CSV, with its unit
    name : in words
    unit : that it is shown in
    attribute : name of the value, in SI units, in ForceStatistics; empty for a figure of the whole run
    symbol : in formulas
    short : where there is little room
    share_of : what a percentage is a share of
    """

    key: str
    name: str
    unit: str
    attribute: str = ""
    symbol: str = ""
    short: str = ""
    share_of: str = ""

    @property
    def label(self) -> str:
        """Name, symbol and unit, for a row of a table."""
        unit = f"{self.unit} {self.share_of}".rstrip()
        return f"{self.name} {self.symbol}".rstrip() + (f" ({unit})" if unit else "")

    @property
    def short_label(self) -> str:
        """Short name and unit, for a column of a table."""
        return f"{self.short} ({self.unit})"

    @property
    def digits(self) -> int:
        """Decimals in tables."""
        return DIGITS[self.unit]

    def shown(self, value: Any) -> Any:
        """A value in SI units, in the unit that is shown."""
        return FACTORS[self.unit] * value

    def si(self, shown: Any) -> Any:
        """A value in the unit that is shown, in SI units."""
        factor = FACTORS[self.unit]
        return shown if factor == 1 else shown / factor

    def number(self, shown: float | None) -> str:
        """A value in the unit that is shown, as tables write it; '–' for None."""
        return "–" if shown is None else f"{shown:.{self.digits}f}"

    def text(self, statistics: Any) -> str:
        """The value in statistics, with its unit."""
        return f"{self.number(self.shown(getattr(statistics, self.attribute)))} {self.unit}".rstrip()


_TIME = "of the time"
FORCE = {
    q.attribute: q
    for q in (
        Quantity("mean_N", "mean force", "N", "mean", "Fₘ", "mean"),
        Quantity("std_N", "standard deviation", "N", "std", "σ", "σ"),
        Quantity("std_0_5_Hz_N", "of which 0 to 5 Hz", "N", "std_0_5"),
        Quantity("std_5_20_Hz_N", "of which 5 to 20 Hz", "N", "std_5_20"),
        Quantity("statistical_max_N", "statistical maximum", "N", "statistical_max", "Fₘ + 3σ", "stat. max"),
        Quantity("statistical_min_N", "statistical minimum", "N", "statistical_min", "Fₘ − 3σ", "stat. min"),
        Quantity("max_N", "actual maximum", "N", "max", short="max"),
        Quantity("min_N", "actual minimum", "N", "min", short="min"),
        Quantity("contact_loss_percent", "contact loss, however short", "%", "contact_loss", share_of=_TIME),
        Quantity("contact_loss_over_5_ms_percent", "contact loss over 5 ms", "%", "long_contact_loss",
                 short="loss > 5 ms", share_of=_TIME),
        Quantity("losses_over_5_ms", "number of losses over 5 ms", "", "long_losses"),
        Quantity("longest_loss_ms", "longest loss", "ms", "longest_loss"),
        Quantity("contact_point_range_mm", "range of the contact point", "mm", "contact_point_range"),
    )
}  # fmt: skip
"""Figures of a pantograph's contact force over the evaluated spans, by their attribute in ForceStatistics."""
UPLIFT = Quantity("max_support_uplift_mm", "largest uplift at a support", "mm", short="uplift")
LATERAL = Quantity("largest_contact_lateral_mm", "farthest contact from the middle of a head", "mm")
SLACK_DROPPERS = Quantity("slack_droppers", "droppers that went slack", "")
DROPPER_FORCE = Quantity("largest_dropper_force_N", "largest force of a dropper", "N")
NON_UNIFORMITY = Quantity("elasticity_non_uniformity_percent", "non-uniformity of the elasticity", "%")
CHECKS_FAILED = Quantity("checks_failed", "checks failed", "")
OF_RUN = (UPLIFT, LATERAL, SLACK_DROPPERS, DROPPER_FORCE, NON_UNIFORMITY)
"""Figures of a whole run."""


def in_short(statistics: Any, names: Iterable[str]) -> str:
    """Some figures of the contact force, by their attributes, in one line."""
    return ", ".join(f"{FORCE[name].short} {FORCE[name].text(statistics)}" for name in names)


def figure_rows(
    quantities: Iterable[Quantity], columns: Sequence[Mapping[str, Any]]
) -> list[tuple[str, ...]]:
    """One row per quantity: its label, and its number in each column of values by key."""
    return [(q.label, *(q.number(column.get(q.key)) for column in columns)) for q in quantities]


def decimals_of(column: str, decimals: Mapping[str, int] = DECIMALS) -> int | None:
    """Decimals of a CSV column by the unit that its name ends with; None without one."""
    if column in FINER:
        return FINER[column]
    units = [unit for unit in decimals if column == unit or column.endswith(f"_{unit}")]
    return decimals[max(units, key=len)] if units else None
