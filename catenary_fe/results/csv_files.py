"""Tables as CSV: each number with the digits that its unit is worth."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from catenary_fe.results.files import STRAY

DECIMALS = {
    "mm_per_N": 4, "N_per_m": 1, "kN": 3, "mm": 2, "m": 3, "N": 1, "s": 4, "Hz": 4, "deg": 2, "percent": 3,
    "ratio": 6,
}  # fmt: skip
"""Of numbers in a column whose name ends with this unit; others keep ten digits."""
FINER = {"length_m": 4, "installed_length_m": 4}
"""Of these columns: what is cut and checked to the millimetre needs one decimal more."""
OF_HISTORIES = DECIMALS | {"m": 6, "N": 2, "s": 6}
"""Of numbers that vary in time: an uplift is worth a micrometre, a time step may be one too."""


def decimals_of(column: str, decimals: Mapping[str, int] = DECIMALS) -> int | None:
    """Decimals of a column by the unit that its name ends with; None without one."""
    if column in FINER:
        return FINER[column]
    units = [unit for unit in decimals if column == unit or column.endswith(f"_{unit}")]
    return decimals[max(units, key=len)] if units else None


def common_name(column: str) -> str:
    """A column's name without the number of its contact wire."""
    return column.replace("_1_", "_").replace("_2_", "_")


def cell(value: Any, decimals: int | None) -> Any:
    """A value as a table holds it; what is no decimal number stays as it is."""
    if not isinstance(value, float | np.floating):
        return value
    if decimals is None:
        return f"{value:.10g}"
    return f"{round(float(value), decimals) + 0.0:.{decimals}f}"  # never -0.00


def write_csv(
    path: Path,
    columns: Sequence[str],
    rows: Iterable[Sequence[Any]],
    decimals: Mapping[str, int] = DECIMALS,
) -> None:
    """Write rows under named columns, a column's unit being the end of its name."""
    digits = [decimals_of(name, decimals) for name in columns]
    with path.open("w", newline="", encoding="utf-8", errors=STRAY) as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([cell(value, n) for value, n in zip(row, digits, strict=True)] for row in rows)
