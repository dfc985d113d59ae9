"""The page of a sweep: verdicts over what was varied, envelopes, each case to open."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from catenary_fe.results import Criterion
from catenary_fe.results.criteria import criteria_table
from catenary_fe.results.quantities import FORCE, UPLIFT, figure_rows
from catenary_fe.views import sweep
from catenary_fe.views.report.page import svg_address, template
from catenary_fe.views.report.tables import Table
from catenary_fe.views.style import styled

Made = Mapping[str, Any]
_SHOWN = (*(FORCE[name] for name in ("mean", "std", "statistical_max", "statistical_min")), UPLIFT)


@styled
def sweep_page(made: Made, x: str | None, by: Sequence[str], forces: Mapping[int, Mapping[str, Any]]) -> str:
    """HTML of a sweep, complete in itself but for links to the pages of kept runs.

    made : the sweep's record
    x, by : what goes along horizontal axes, and what tells curves apart
    forces : by the number of a case, the force along the line that was kept: ``x`` [m], ``values`` [N]
    """
    ran = [case for case in made["cases"] if not case["error"]]
    judged = [case for case in ran if case["criteria"]]
    content = {
        "title": made["title"],
        "lead": _lead(made),
        "said": made["said"],
        "bad": any(case["missed"] for case in map(_case, made["cases"])),
        "pictures": _pictures(made, ran, judged, x, by, forces),
        "columns": [*_varied(made), *(f"{q.short} ({q.unit})" for q in _SHOWN)],
        "judged": bool(judged),
        "cases": [_case(case) | {"cells": _cells(made, case)} for case in made["cases"]],
    }
    return template("sweep.html.j2").render(content)


def _lead(made: Made) -> str:
    axes = "; ".join(f"{sweep.place_title(key)}: {_values(v)}" for key, v in made["axes"].items())
    count = len(made["cases"])
    return (
        f"{count} {'case' if count == 1 else 'cases'}, {made['method']} runs with steps of"
        f" {made['time_step_ms']:g} ms. {axes[0].upper()}{axes[1:]}."
    )


def _values(values: Sequence[Any]) -> str:
    texts = [f"{v:g}" if isinstance(v, float) else str(v) for v in values]
    return ", ".join(texts) if len(texts) <= 8 else f"{texts[0]} to {texts[-1]}, {len(texts)} values"


def _varied(made: Made) -> list[str]:
    """Titles of what has several values; the speed always."""
    return [sweep.place_title(key) for key in _varied_keys(made)]


def _varied_keys(made: Made) -> list[str]:
    return [key for key, v in made["axes"].items() if len(v) > 1 or key == "speed_kmh"]


def _cells(made: Made, case: Made) -> list[str]:
    """What tells a case from the others, and its governing pantograph's figures."""
    own = [f"{v:g}" if isinstance(v, float) else str(v) for v in map(case["values"].get, _varied_keys(made))]
    if case["error"]:
        return [*own, *([""] * len(_SHOWN))]
    row = next((r for r in case["rows"] if r.get("governs")), case["rows"][0])
    return [*own, *(q.number(row[q.key]) for q in _SHOWN)]


def _case(case: Made) -> dict[str, Any]:
    """A case in words and tables."""
    rows = [Criterion(**{k: row[k] for k in Criterion.__dataclass_fields__}) for row in case["criteria"]]
    telling = [row for row in case["criteria"] if row["used"] is not None]
    telling = [row for row in telling if row["passed"] is False or not row["tolerance"]]
    worst = max(telling, key=sweep.share_of_limit, default=None)
    names = [f"pantograph {row['number']}" for row in case["rows"] if "number" in row]
    return {
        "number": case["number"],
        "run": case["run"],
        "error": case["error"],
        "warnings": [*case["checks_failed"].values(), *case["warnings"]],
        "checks_failed": "; ".join(case["checks_failed"]),
        "missed": [row["label"] for row in case["criteria"] if row["passed"] is False],
        "worst": f"{min(999.0, 100 * worst['used']):.0f} % {worst['label']}" if worst else "",
        "criteria": Table("", *criteria_table(rows)) if rows else None,
        "figures": None if case["error"] else Table(
            "", ("", *names), figure_rows(FORCE.values(), case["rows"])
        ),
        "uplifts": ", ".join(
            f"{support}: {UPLIFT.number(lift)}" for support, lift in case["support_uplift_mm"].items()
        ),
    }  # fmt: skip


def _pictures(
    made: Made, ran: Sequence[Made], judged: Sequence[Made], x: str | None, by: Sequence[str],
    forces: Mapping[int, Mapping[str, Any]],
) -> list[tuple[str, str, str]]:  # fmt: skip
    """Heading, address and caption of each."""
    found = []
    if judged and x:
        found.append(
            (
                "Verdicts",
                svg_address(sweep.plot_verdicts(judged, x)),
                "Of all cases with this value, the one that uses most of the limit; 100 is the limit, of a"
                " mean less its scatter the whole margin.",
            )
        )
    if ran and x:
        rows = [row for case in ran for row in case["rows"]]
        for heading, plot, text in (
            ("Contact force", sweep.plot_sweep_forces, "Means, what they scatter by, and extremes."),
            ("Standard deviation", sweep.plot_sweep_deviation, "Beside the largest one that is allowed."),
            ("Uplift at the supports", sweep.plot_sweep_uplift, "The largest one at a support."),
        ):
            found.append((heading, svg_address(plot(rows, x, by)), text))
    if kept := [{**case, "force": forces[case["number"]]} for case in ran if case["number"] in forces]:
        found.append(
            (
                "Contact force along the line",
                svg_address(sweep.plot_force_envelopes(kept, x, made["support_positions_m"])),
                "Lowest and highest force at each place, of all cases and pantographs with this value.",
            )
        )
    return found
