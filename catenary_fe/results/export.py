"""Tables as CSV, and the histories of a run as such tables, for spreadsheets and other programs."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.results.files import STRAY, atomic_write, cannot_be_written
from catenary_fe.results.quantities import DECIMALS, OF_HISTORIES, decimals_of
from catenary_fe.results.run import Run
from catenary_fe.results.signal import FilterKind

Floats = NDArray[np.float64]
Table = dict[str, Floats]


def history_tables(run: Run, filter: FilterKind = "causal") -> dict[str, Table]:
    """Tables by name, each a column of floats by heading with its unit; time comes first.

    One table a pantograph, one of the supports' uplift, one of the droppers' forces.

    filter : of the filtered contact force
    """
    data, filtered = run.data, run.filtered_contact_force(filter)
    tables: dict[str, Table] = {}
    for i in range(filtered.shape[0]):
        masses = data["mass_height"].values[i]
        tables[f"pantograph_{i + 1}"] = {
            "time_s": run.time,
            "position_m": data["position"].values[i],
            "contact_force_N": data["contact_force"].values[i],
            "contact_force_0_20_Hz_N": filtered[i],
            "wire_height_m": data["wire_height"].values[i],
            **_contact_places(data, i),
            **{f"mass_{n + 1}_height_m": z for n, z in enumerate(masses) if np.isfinite(z).all()},
        }
    tables["support_uplift"] = {"time_s": run.time} | {
        f"support_{i}_at_{_metres(x)}_m_uplift_m": values
        for i, (x, values) in enumerate(
            zip(data["support_position"].values, data["support_uplift"].values, strict=True), start=1
        )
    }
    spans = data["dropper_span"].values
    first = np.searchsorted(spans, spans)  # number of the first dropper in each one's span
    tables["dropper_force"] = {"time_s": run.time} | {
        f"span_{spans[i]}_dropper_{i - first[i] + 1}_at_{_metres(x)}_m_force_N": values
        for i, (x, values) in enumerate(
            zip(data["dropper_position"].values, data["dropper_force"].values, strict=True)
        )
    }
    return tables


def _contact_places(data: Any, pantograph: int) -> Table:
    """Columns of the contacts' places on a pantograph's head, where a run in space has them."""
    if "contact_lateral" not in data:
        return {}
    each = data["contact_lateral"].values[pantograph]
    several = len(each) > 1
    return {
        f"{f'contact_{n}_' if several else 'contact_'}lateral_m": y
        for n, y in enumerate(each, start=1)
        if np.isfinite(y).any()
    }


def _metres(x: float) -> str:
    """To the millimetre, without zeros at the end."""
    return f"{round(float(x), 3) + 0.0:.10g}"


def write_tables(tables: Mapping[str, Table], folder: Path, every: int = 1) -> list[Path]:
    """Write each table as a CSV file of its name, at every n-th time; returns the files.

    Raises InputError for a folder that cannot be written or a number of times below 1.
    """
    if every < 1:
        raise InputError(f"every {every} times: must be at least 1")
    written = []
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, table in tables.items():
            path = folder / f"{name}.csv"
            with atomic_write(path) as aside:
                rows = np.column_stack(list(table.values()))[::every].tolist()
                write_csv(aside, list(table), rows, OF_HISTORIES)
            written.append(path)
    except OSError as error:
        raise InputError(cannot_be_written(folder, error)) from None
    return written


def common_name(column: str) -> str:
    """A column's name without the number of its contact wire."""
    return column.replace("_1_", "_").replace("_2_", "_")


def cell(value: Any, decimals: int | None) -> Any:
    """A value as it is written to CSV; anything but a decimal number stays as it is."""
    if not isinstance(value, float | np.floating):
        return value
    if decimals is None:
        return f"{value:.10g}"
    return f"{round(float(value), decimals) + 0.0:.{decimals}f}"  # never -0.00


def write_csv(
    path: Path, columns: Sequence[str], rows: Iterable[Sequence[Any]], decimals: Mapping[str, int] = DECIMALS
) -> None:
    """Write rows under named columns, a column's unit being the end of its name."""
    digits = [decimals_of(name, decimals) for name in columns]
    with path.open("w", newline="", encoding="utf-8", errors=STRAY) as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([cell(value, n) for value, n in zip(row, digits, strict=True)] for row in rows)
