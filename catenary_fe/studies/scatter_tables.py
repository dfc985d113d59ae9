"""Tables of a study's samples: one row a run, bands of figures and forces, shares of variance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import PowerSystem
from catenary_fe.results import judge
from catenary_fe.results.quantities import FORCE, UPLIFT
from catenary_fe.studies.sampling import Indices, group_indices, quantile_range
from catenary_fe.studies.scatter_cases import NOMINAL, Case
from catenary_fe.studies.sweep import SweepCase
from catenary_fe.studies.sweep_figures import key_figures_of
from catenary_fe.studies.sweep_store import Record

Floats = NDArray[np.float64]
Row = dict[str, Any]
OUTCOMES = (
    *(FORCE[name] for name in ("mean", "std", "statistical_max", "statistical_min", "max", "min",
                               "contact_loss", "long_contact_loss")),
    UPLIFT,
)  # fmt: skip
"""Figures whose bands are given."""
EXPLAINED = FORCE["std"], FORCE["mean"], FORCE["max"], UPLIFT
"""Figures whose variance is shared out among the inputs."""
LOW, HIGH = 0.05, 0.95


def sample_rows(
    cases: Sequence[Case], records: Sequence[Record], system: PowerSystem | None
) -> Iterator[Row]:
    """One row a pantograph of a run; of a run that failed one, with its error."""
    for case, record in zip(cases, records, strict=True):
        if "error" in record or not isinstance(case, SweepCase):
            yield case.values | {"number": 1, "error": record["error"]}
            continue
        summary = record["summary"]
        rows = judge(key_figures_of(record, case), system) if system else []
        for number, statistics in enumerate(summary["pantographs"], start=1):
            of_it = [row.name for row in rows if row.pantograph in (statistics["name"], None)
                     and row.passed is False]  # fmt: skip
            yield (
                case.values
                | {"number": number}
                | {q.key: statistics.get(q.key, summary.get(q.key)) for q in OUTCOMES}
                | ({"criteria_missed": "; ".join(of_it)} if system else {})
                | {"error": ""}
            )


def grouped(rows: Sequence[Row]) -> dict[tuple[float, str, int], list[Row]]:
    """Rows of runs that did not fail, by speed, pantograph and its number."""
    found: dict[tuple[float, str, int], list[Row]] = {}
    for row in rows:
        if not row["error"]:
            found.setdefault((row["speed_kmh"], row["pantograph"], row["number"]), []).append(row)
    return found


def _key(group: tuple[float, str, int]) -> Row:
    return dict(zip(("speed_kmh", "pantograph", "number"), group, strict=True))


def figure_bands(rows: Sequence[Row], seed: int) -> list[Row]:
    """For each speed and pantograph, each figure in one row, in the unit that its key ends with.

    seed : of the bootstrap of the 95 % quantile
    """
    found = []
    for group, members in grouped(rows).items():
        nominal = next((row for row in members if row["sample"] == NOMINAL), None)
        scattered = [row for row in members if row["sample"] != NOMINAL]
        for q in OUTCOMES if scattered else ():
            values = np.array([row[q.key] for row in scattered], dtype=float)
            sure = quantile_range(values, HIGH, seed)
            figures = {
                "nominal": None if nominal is None else float(nominal[q.key]),
                "mean": float(values.mean()),
                "deviation": float(values.std(ddof=1)) if values.size > 1 else None,
                "low_5": float(np.quantile(values, LOW)),
                "median": float(np.median(values)),
                "high_95": float(np.quantile(values, HIGH)),
                "high_95_at_least": sure[0],
                "high_95_at_most": sure[1],
            }
            found.append(_key(group) | {"figure": q.key, "samples": values.size} | figures)
    return found


def missed_shares(rows: Sequence[Row]) -> list[Row]:
    """For each speed and pantograph: samples that ran, the share that misses a criterion, and which."""
    found = []
    for group, members in grouped(rows).items():
        scattered = [row for row in members if row["sample"] != NOMINAL]
        if scattered and "criteria_missed" in scattered[0]:
            texts = [row["criteria_missed"] for row in scattered]
            counts: dict[str, int] = {}
            for text in texts:
                for name in dict.fromkeys(text.split("; ") if text else ()):
                    counts[name] = counts.get(name, 0) + 1
            share = sum(map(bool, texts)) / len(texts)
            found.append(_key(group) | {"samples": len(texts), "missed_share": share, "missed": counts})
    return found


def force_bands(records: Sequence[Record]) -> list[Row]:
    """For each speed and pantograph: x [m] and forces [N] as arrays, nominal and quantiles at each place."""
    groups: dict[tuple[float, str, int], dict[int, tuple[Floats, Floats]]] = {}
    for record in records:
        values = record["values"]
        force = record.get("force", {"x": [], "values": []})
        for number, row in enumerate(force["values"], start=1):
            group = values["speed_kmh"], values["pantograph"], number
            groups.setdefault(group, {})[values["sample"]] = np.array(force["x"]), np.array(row)
    found = []
    for group, curves in groups.items():
        scattered = [sample for sample in curves if sample != NOMINAL]
        if not scattered:
            continue
        x = curves[NOMINAL if NOMINAL in curves else scattered[0]][0]
        # where lengths of spans scatter, places do: those of the nominal line are taken
        rows = np.array([np.interp(x, *curves[sample]) for sample in scattered])
        low, median, high = np.quantile(rows, (LOW, 0.5, HIGH), axis=0)
        nominal = curves[NOMINAL][1] if NOMINAL in curves else None
        found.append(
            _key(group) | {"x": x, "nominal": nominal, "low_5": low, "median": median, "high_95": high}
        )
    return found


def force_table(bands: Sequence[Mapping[str, Any]]) -> Iterator[Row]:
    """Rows of a table of force bands, place by place."""
    for band in bands:
        for i, x in enumerate(band["x"].tolist()):
            yield {
                **{key: band[key] for key in ("speed_kmh", "pantograph", "number")},
                "position_m": x,
                "nominal_N": "" if band["nominal"] is None else float(band["nominal"][i]),
                **{f"{name}_percent_force_N": float(band[f"{side}_{name}"][i])
                   for side, name in (("low", "5"), ("high", "95"))},
                "median_force_N": float(band["median"][i]),
            }  # fmt: skip


def sensitivity_rows(
    records: Sequence[Record], samples: int, per_sample: int, places: Sequence[str], seed: int
) -> list[Row]:
    """Sobol' indices, one row a speed, pantograph, figure and input.

    records : of two samples A and B, and of A with the values of each input from B, one after the other
    per_sample : cases of one sample
    seed : of the bootstrap
    """
    found: list[Row] = []
    for case in range(per_sample):
        rows = records[case::per_sample]
        first = next((row for row in rows if "summary" in row), None)
        for number in range(len(first["summary"]["pantographs"]) if first else 0):
            outcomes = np.array([_outcomes(row, number) for row in rows]).T
            parts = outcomes.reshape(len(EXPLAINED), len(places) + 2, samples).swapaxes(0, 1)
            indices = group_indices(parts[0], parts[1], parts[2:], seed)
            values = rows[0]["values"]
            group = values["speed_kmh"], values["pantograph"], number + 1
            found += _index_rows(group, indices, places)
    return found


def _outcomes(record: Record, number: int) -> list[float]:
    """Of one pantograph; nan of a run that failed."""
    if "summary" not in record:
        return [np.nan] * len(EXPLAINED)
    summary = record["summary"]
    return [summary["pantographs"][number].get(q.key, summary.get(q.key)) for q in EXPLAINED]


def _index_rows(group: tuple[float, str, int], indices: Indices, places: Sequence[str]) -> Iterator[Row]:
    for q, quantity in enumerate(EXPLAINED):
        for i, place in enumerate(places):
            yield _key(group) | {
                "figure": quantity.key,
                "input": place,
                "first_order": float(indices.first[q, i]),
                "first_order_at_least": float(indices.first_range[0, q, i]),
                "first_order_at_most": float(indices.first_range[1, q, i]),
                "total": float(indices.total[q, i]),
                "total_at_least": float(indices.total_range[0, q, i]),
                "total_at_most": float(indices.total_range[1, q, i]),
                "samples": indices.samples,
            }
