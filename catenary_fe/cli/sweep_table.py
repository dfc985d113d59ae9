"""A sweep's folder: table, remarks, pictures, kept runs, and the record that its report is made of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from importlib.metadata import version
from pathlib import Path
from typing import TYPE_CHECKING, Any

from catenary_fe.cli.folder import Folder, keep_file, output_folder
from catenary_fe.cli.surroundings import readable
from catenary_fe.cli.terminal import print_table
from catenary_fe.cli.verdicts import Verdict, in_words, remarks
from catenary_fe.layout import PowerSystem
from catenary_fe.layout.variation import unit_of
from catenary_fe.results.quantities import DROPPER_FORCE, FORCE, SLACK_DROPPERS, UPLIFT

if TYPE_CHECKING:
    from catenary_fe.studies.sweep import BrokenCase, SweepCase, SweepSettings
    from catenary_fe.studies.sweep_store import Record

RECORD = "sweep.json"
_FIGURES = (
    *(FORCE[name] for name in ("mean", "std", "statistical_min", "statistical_max", "min", "max")),
    FORCE["long_contact_loss"], UPLIFT,
)  # fmt: skip


def sweep_record(
    cases: Sequence[SweepCase | BrokenCase],
    records: Sequence[Record],
    verdicts: Sequence[Verdict],
    settings: SweepSettings,
    system: PowerSystem | None,
    axes: Mapping[str, Sequence[Any]],
) -> dict[str, Any]:
    """What the report of a sweep is made of, ready for JSON; the force along the line is in ``cases``."""
    from catenary_fe.studies.sweep import SweepCase

    lines = [case.catenary for case in cases if isinstance(case, SweepCase)]
    places = {tuple(line.support_positions.tolist()) for line in lines}
    return {
        "title": lines[0].name,
        "method": settings.method,
        "time_step_ms": 1e3 * settings.time.step,
        "criteria_system": system,
        "version": version("catenary_fe"),
        "axes": dict(axes),
        "support_positions_m": list(places.pop()) if len(places) == 1 else None,
        "said": in_words(verdicts, system),
        "cases": [
            {
                "number": number,
                "key": case.key(settings) if isinstance(case, SweepCase) else None,
                "run": f"runs/{number:04d}" if "run" in record else None,
                "rows": table_rows(record, verdict, system),
                "support_uplift_mm": record.get("summary", {}).get("support_uplift_mm", {}),
            }
            | verdict.as_dict()
            for number, (case, record, verdict) in enumerate(
                zip(cases, records, verdicts, strict=True), start=1
            )
        ],
    }


def table_rows(record: Record, verdict: Verdict, system: PowerSystem | None) -> list[dict[str, Any]]:
    """One row a pantograph; a failed case has one row with its error."""
    values = {k: readable(v) if isinstance(v, str) else v for k, v in record["values"].items()}
    if verdict.error:
        return [values | {"error": verdict.error}]
    summary = record["summary"]
    several = len(summary["pantographs"]) > 1
    keys = (UPLIFT.key, SLACK_DROPPERS.key, DROPPER_FORCE.key, "simulated_s")
    common = {key: summary[key] for key in keys}
    return [
        values
        | {"number": i}
        | ({"governs": "yes" if statistics["name"] == verdict.governing else ""} if several else {})
        | {key: value for key, value in statistics.items() if key != "name"}
        | common
        | {"checks_failed": "; ".join(verdict.failed_checks)}
        | ({"criteria_missed": verdict.missed_by(statistics["name"])} if system else {})
        | {"warnings": len(verdict.warnings), "error": ""}
        for i, statistics in enumerate(summary["pantographs"], start=1)
    ]


def force_rows(records: Sequence[Record]) -> Iterator[dict[str, Any]]:
    """Rows of a table: the force that records keep, case by case, pantograph by pantograph."""
    for record in records:
        force = record.get("force", {"x": [], "values": []})
        for number, values in enumerate(force["values"], start=1):
            for x, newton in zip(force["x"], values, strict=True):
                place = {"number": number, "position_m": x, "contact_force_0_20_Hz_N": newton}
                yield record["values"] | place


def write_sweep(
    output: str,
    made: Mapping[str, Any],
    verdicts: Sequence[Verdict],
    records: Sequence[Record],
) -> None:
    """Table, remarks and pictures, the force along the line and the runs that records have, the record."""
    rows = rows_of(made)
    columns = dict.fromkeys(key for row in sorted(rows, key=len, reverse=True) for key in row)
    with output_folder(output) as folder:
        assert folder is not None
        folder.json(RECORD, made)
        folder.table("sweep.csv", [_with_units({key: row.get(key, "") for key in columns}) for row in rows])
        for name, found in (("remarks.csv", remarks(verdicts)), ("force.csv", force_rows(records))):
            if said := [_with_units(row) for row in found]:
                folder.table(name, said)
            else:
                folder.forget(name)  # of an earlier state of the sweep
        folder.forget("report.html")
        _pictures(folder, rows, made["axes"])
    for case, record in zip(made["cases"], records, strict=True):
        if case["run"]:
            system = made["criteria_system"]
            judged = {"criteria_system": system, "criteria": case["criteria"]} if system else {}
            keep_run(Path(output, case["run"]), record["run"], record["summary"] | judged)


def _pictures(folder: Folder, rows: Sequence[Mapping[str, Any]], axes: Mapping[str, Sequence[Any]]) -> None:
    from catenary_fe import views

    x, by = axis_of(axes)
    good = [row for row in rows if not row["error"]]
    if good and x:
        folder.picture("contact_force.png", views.plot_sweep_forces(good, x, by))
        folder.picture("standard_deviation.png", views.plot_sweep_deviation(good, x, by))
        folder.picture("support_uplift.png", views.plot_sweep_uplift(good, x, by))


def keep_run(target: Path, file: str, summary: Mapping[str, Any]) -> None:
    """A folder as of a run, with what its report needs; the run's file is there once, under two names."""
    with output_folder(str(target)) as folder:
        assert folder is not None
        folder.json("summary.json", summary)
        keep_file(file, folder.path / "run.nc")
        folder.forget("report.html")


def rows_of(made: Mapping[str, Any]) -> list[dict[str, Any]]:
    """Rows of a sweep's table."""
    return [row for case in made["cases"] for row in case["rows"]]


def _with_units(row: dict[str, Any]) -> dict[str, Any]:
    """A table's row, columns of varied values named with their units."""
    return {f"{key} [{unit}]" if (unit := unit_of(key)) else key: value for key, value in row.items()}


def axis_of(axes: Mapping[str, Sequence[Any]]) -> tuple[str | None, list[str]]:
    """What goes along the horizontal axis, and what tells the curves apart."""
    varied = [name for name, values in axes.items() if len(values) > 1]
    numeric = [name for name in varied if not any(isinstance(v, bool | str) for v in axes[name])]
    x = numeric[0] if numeric else None
    return x, [name for name in varied if name != x]


def print_sweep(made: Mapping[str, Any]) -> None:
    """The table on the terminal."""
    axes, rows = made["axes"], rows_of(made)
    varied = [name for name, values in axes.items() if len(values) > 1] or ["speed_kmh"]
    if any(row.get("number", 1) > 1 for row in rows):
        varied += ["number", "governs"]
    said = [key for key in ("checks_failed", "criteria_missed") if any(key in row for row in rows)]
    table = [
        [
            *(row.get(name, "") for name in varied),
            *("failed" if row["error"] else q.number(row[q.key]) for q in _FIGURES),
            *(len(row[key].split("; ")) if row.get(key) else "" for key in said),
        ]
        for row in rows
    ]
    titles = [*varied, *(f"{q.short} {q.unit}" for q in _FIGURES), *(key.replace("_", " ") for key in said)]
    print_table("sweep", titles, table)
