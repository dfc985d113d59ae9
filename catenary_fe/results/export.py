"""Tables as CSV, and the histories of a run as such tables, for spreadsheets and other programs."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping, Sequence
from datetime import datetime
from importlib.util import find_spec
from io import BytesIO
from pathlib import Path
from typing import Any
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import Catenary, InputError, layout_text
from catenary_fe.layout.arguments import checked
from catenary_fe.results.files import STRAY, atomic_write, cannot_be_written, write_text
from catenary_fe.results.quantities import DECIMALS, OF_HISTORIES, decimals_of
from catenary_fe.results.run import Run
from catenary_fe.results.signal import FilterKind

Floats = NDArray[np.float64]
Table = dict[str, Floats]


@checked
def save_catenary(catenary: Catenary, path: str | Path, *, comment: str = "") -> Path:
    """Write a catenary as a layout file, which :func:`load_catenary` reads as an equal one; returns its path.

    comment : lines to stand above it

    Raises InputError for a path that cannot be written, and for what the file format cannot say.
    """
    write_text(path, layout_text(catenary, comment=comment))
    return Path(path)


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
    numbers = run.catenary.dropper_numbers
    tables["dropper_force"] = {"time_s": run.time} | {
        f"span_{spans[i]}_dropper_{numbers[i]}_at_{_metres(x)}_m_force_N": values
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


def check_xlsx() -> None:
    """Raises InputError where the package that writes workbooks is not there."""
    if find_spec("openpyxl") is None:
        raise InputError('a workbook needs the package openpyxl: pip install "catenary_fe[xlsx]"')


def write_xlsx(path: Path, sheets: Mapping[str, tuple[Sequence[str], Sequence[Mapping[str, Any]]]]) -> None:
    """Write a workbook (XLSX), with the digits that the columns' units are worth; the same bytes each time.

    sheets : by name, columns and rows

    Raises InputError where openpyxl is missing, or the file cannot be written.
    """
    check_xlsx()
    from openpyxl import Workbook
    from openpyxl.styles import Font
    from openpyxl.utils import get_column_letter

    book = Workbook()
    assert book.active is not None
    book.remove(book.active)
    book.properties.created = book.properties.modified = datetime(2000, 1, 1)
    for name, (columns, rows) in sheets.items():
        sheet = book.create_sheet(name)
        sheet.append(list(columns))
        sheet.freeze_panes = "A2"
        for number, column in enumerate(columns, start=1):
            sheet.cell(1, number).font = Font(bold=True)
            sheet.column_dimensions[get_column_letter(number)].width = max(8, len(column) + 2)
        for row in rows:
            sheet.append([_rounded(row[column], decimals_of(column)) for column in columns])
            for number, column in enumerate(columns, start=1):
                if isinstance(row[column], float) and (decimals := decimals_of(column)) is not None:
                    sheet.cell(sheet.max_row, number).number_format = f"0.{'0' * decimals}".rstrip(".")
    buffer = BytesIO()
    book.save(buffer)
    with atomic_write(path) as aside, ZipFile(buffer) as made, ZipFile(aside, "w", ZIP_DEFLATED) as kept:
        for entry in made.infolist():
            text = re.sub(rb"(<dcterms:modified[^>]*>)[^<]*", rb"\g<1>2000-01-01T00:00:00Z", made.read(entry))
            kept.writestr(ZipInfo(entry.filename), text, ZIP_DEFLATED)  # without the time of day


def _rounded(value: Any, decimals: int | None) -> Any:
    """As :func:`cell`, as a number."""
    if not isinstance(value, float | np.floating):
        return value
    return float(value) if decimals is None else round(float(value), decimals) + 0.0
