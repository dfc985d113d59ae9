"""Quality checks of a run as objects, and why and when a run that did not finish was stopped."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any, Literal

from numpy import isfinite

from catenary_fe.layout.parameters import changed_by_copy

FAILED = "check failed: "  # begins the warning of a check that fails


@changed_by_copy
@dataclass(frozen=True)
class Check:
    """One check: what was found, what it must be, and what to do if it is not.

    name : short, for tables and JSON
    rule : whether the bound is the largest ("at most") or the smallest ("at least") good value
    text : what value and bound are, and the remedy
    """

    name: str
    value: float
    unit: str
    rule: Literal["at most", "at least"]
    bound: float
    text: str

    @property
    def value_text(self) -> str:
        """Value and unit as tables write them."""
        text = f"{self.value:.4g}" if abs(self.value) >= 1e-3 else f"{self.value:.1g}"
        return f"{text} {self.unit}".rstrip()

    @property
    def bound_text(self) -> str:
        """Rule, bound and unit as tables write them."""
        return f"{self.rule} {self.bound:.4g} {self.unit}".rstrip()

    @property
    def verdict(self) -> str:
        """'passed' or 'failed'."""
        return "passed" if self.passed else "failed"

    @property
    def passed(self) -> bool:
        """False also where the value is not a number."""
        return self.value <= self.bound if self.rule == "at most" else self.value >= self.bound

    def as_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        return {
            "name": self.name,
            "value": self.value if isfinite(self.value) else None,
            "unit": self.unit,
            "rule": self.rule,
            "bound": self.bound,
            "passed": bool(self.passed),
        }

    def __str__(self) -> str:
        return f"{self.name} = {self.value_text}, must be {self.bound_text}: {self.text}"


def checks_table(checks: Sequence[Check]) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Names of the columns, and a row of texts for each check."""
    columns = ("check", "value", "bound", "verdict")
    return columns, [(c.name, c.value_text, c.bound_text, c.verdict) for c in checks]


def checks_in_words(checks: Sequence[Check]) -> str:
    """How many checks fail, and which."""
    failed = [check.name for check in checks if not check.passed]
    if not failed:
        return f"all {len(checks)} checks passed"
    return f"{len(failed)} of {len(checks)} checks failed: {', '.join(failed)}"


@dataclass(frozen=True)
class Partial:
    """Why and when a run was stopped before its end.

    reached_s, planned_s : [s]
    """

    reason: str
    reached_s: float
    planned_s: float

    def as_dict(self) -> dict[str, Any]:
        """Ready for JSON."""
        return asdict(self)

    def __str__(self) -> str:
        return (
            f"PARTIAL run: it ended after {self.reached_s:.2f} of {self.planned_s:.2f} s; spans that were not"
            f" passed have no figures ({self.reason})"
        )
