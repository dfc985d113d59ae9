"""The page of a conformity pack: verdicts first, then what each rests on, and the files with its numbers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from catenary_fe.results.check import checks_table
from catenary_fe.results.criteria import criteria_table
from catenary_fe.results.quantities import FORCE, UPLIFT
from catenary_fe.statics import Shape
from catenary_fe.studies.conform import Conformity, slug
from catenary_fe.views.layout import plot_layout
from catenary_fe.views.report.page import svg_address, template
from catenary_fe.views.report.tables import Table
from catenary_fe.views.run import plot_criteria
from catenary_fe.views.static import plot_elasticity
from catenary_fe.views.style import styled

_FIGURES = (*(FORCE[name] for name in ("mean", "std", "max", "min")), UPLIFT)


@styled
def conformity_page(found: Conformity, shape: Shape, record: Mapping[str, Any]) -> str:
    """HTML of a pack, complete in itself but for links to the files that have its numbers.

    shape : the line at rest
    record : of the pack, with ``verdicts``, ``inputs`` and ``warnings``
    """
    asked = found.asked
    content = {
        "title": asked.catenary.name,
        "lead": (
            f"{asked.pantograph.name} at {', '.join(f'{v:g}' for v in asked.speeds_kmh)} km/h, alone and two"
            f" of them {asked.distance:g} m apart; nonlinear runs with steps of {1e3 * asked.time.step:g} ms,"
            f" limits of {asked.system}."
        ),
        "verdicts": record["verdicts"],
        "bad": [row for row in record["verdicts"] if not row["passed"]],
        "warnings": record["warnings"],
        "known": _known(found),
        "ranges": _ranges(found),
        "reference": {f"{v} km/h": f"reference/{v}_kmh" for v, file in found.reference.items() if file},
        "static": Table("", *checks_table(found.static)),
        "non_uniformity": f"{100 * found.curve.non_uniformity:.1f}",
        "force": f"{found.curve.force:g}",
        "layout": svg_address(plot_layout(shape.catenary, shape)),
        "elasticity": svg_address(plot_elasticity(found.curve)),
        "runs": [
            {
                "title": run.title,
                "name": run.name,
                "error": run.error,
                "checks": list(run.summary.get("checks_failed", [])),
                "criteria": Table("", *criteria_table(run.criteria)) if run.criteria else None,
                "picture": svg_address(plot_criteria(run.criteria, title=run.title)) if run.criteria else "",
            }
            for run in found.runs
        ],
        "refined": _refined(found),
        "refined_runs": [f"refined/{slug(name)}" for name, run in found.refined.items() if run.file][1:],
        "refined_run": found.refined["as run"].title,
        "line_test": any(row["part"] == "line test" for row in record["verdicts"]),
        "inputs": record["inputs"],
    }
    return template("conform.html.j2").render(content)


def _known(found: Conformity) -> Table:
    rows = [
        (c.name, f"{c.computed:.6g} {c.unit}", f"{c.reference:.6g} {c.unit}", f"{100 * c.error:.2g} %",
         f"{100 * c.tolerance:g} %", "passed" if c.passed else "missed", c.source)
        for c in found.known
    ]  # fmt: skip
    return Table("", ("quantity", "computed", "known", "off by", "at most", "verdict", "source"), rows)


def _ranges(found: Conformity) -> Table:
    rows = [
        (f"{row.speed_kmh} km/h", f"{row.name} ({row.unit})", f"{row.value:.1f}",
         f"{row.low:g} to {row.high:g}", "passed" if row.passed else "missed", row.source)
        for row in found.ranges
    ]  # fmt: skip
    return Table("", ("speed", "figure", "computed", "range", "verdict", "source"), rows)


def _refined(found: Conformity) -> Table:
    columns = [
        "what was changed",
        *(f"{q.short} ({q.unit})" for q in _FIGURES),
        "σ off by",
        "criteria missed",
    ]
    rows = []
    for row in found.moved:
        if row["error"]:
            rows.append((row["changed"], *([""] * len(_FIGURES)), "", row["error"]))
            continue
        figures = [q.number(row[q.key]) for q in _FIGURES]
        off = "" if row["changed"] == "as run" else f"{row['std_N_change_percent']:+.2f} %"
        rows.append((row["changed"], *figures, off, row["missed"] or "none"))
    return Table("", columns, rows)
