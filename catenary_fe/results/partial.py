"""What a run that was stopped says of itself."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any


@dataclass(frozen=True)
class Partial:
    """Why and when a run ended before its time.

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
