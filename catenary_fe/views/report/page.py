"""Puts a report together from pictures, tables and the data of its curves."""

from __future__ import annotations

import json
from typing import Any

from catenary_fe.layout import InputError, PowerSystem
from catenary_fe.results import Criterion, Run, checks_in_words, criteria_in_words, criteria_rows
from catenary_fe.results.check import checks_table
from catenary_fe.results.criteria import criteria_table
from catenary_fe.results.signal import FilterKind
from catenary_fe.statics import Shape
from catenary_fe.views import layout, plan, run_waves, static
from catenary_fe.views import run as run_pictures
from catenary_fe.views.report import series, tables
from catenary_fe.views.report.html import svg_address, template
from catenary_fe.views.spectrum import plot_force_spectrum
from catenary_fe.views.style import new_axes, styled


@styled
def report_page(
    run: Run,
    shape: Shape,
    *,
    system: PowerSystem = "AC",
    filter: FilterKind = "causal",
) -> str:
    """HTML of a run's report, complete in itself.

    shape : the static shape that the run started from
    system : whose limits the run is judged by
    filter : of the contact force's statistics

    The player and the picture of the waves are left out where the run stored no wire shapes, the elasticity
    where the run does not hold it.
    """
    try:
        motion = series.motion(run)
    except InputError:
        motion = None
    rows: list[Criterion] = [] if run.partial else criteria_rows(run, system, filter=filter)
    governing = tables.governing_figures(run, filter, rows)
    spans, several = run.evaluated_spans, len(set(shape.catenary.spans)) > 1
    content: dict[str, Any] = {
        "title": run.data.attrs["title"],
        "partial": str(run.partial) if run.partial else "",
        "speed": f"{3.6 * run.speed:g}",
        "lead": _lead(run),
        "governing": tables.why_it_governs(run, governing, rows),
        "versions": json.loads(run.data.attrs["versions"]),
        "keys": tables.key_figures(run, governing),
        "criteria": tables.Table(f"Limits of {system}", *criteria_table(rows)),
        "verdict": f"{system}: {criteria_in_words(rows)}." if rows else f"Not judged. {run.partial}.",
        "bad": any(row.passed is False for row in rows),
        "checks_verdict": _sentence(checks_in_words(run.checks)),
        "warnings": run.warnings,
        "checks": tables.Table("", *checks_table(run.checks)),
        "motion": motion is not None,
        "statistics": tables.statistics_table(run, filter),
        "by_span": tables.span_table(run, filter),
        "uplifts": tables.uplift_table(run),
        "slack": tables.slack_table(run),
        "schedule": tables.schedule_table(shape, spans if several else spans[:1]),
        "whole_schedule": tables.schedule_table(shape, None),
        "supports": tables.support_table(shape),
        "inputs": tables.input_tables(run),
        "pictures": _pictures(run, shape, filter, waves=motion is not None),
        "data": {
            "force": series.force_chart(run, filter),
            "uplift": series.uplift_chart(run),
            "motion": motion,
        },
        "footer": "Everything on this page was computed by catenary_fe; how far that can be trusted is in its"
        " validation report.",
    }
    return template("report.html.j2").render(content)


def _sentence(words: str) -> str:
    return f"{words[0].upper()}{words[1:]}."


def _lead(run: Run) -> str:
    names = [str(name) for name in run.data["pantograph"].values]
    spans = ", ".join(map(str, run.evaluated_spans))
    return (
        f"{' and '.join(names)} on {run.catenary.length:g} m of line, {len(run.catenary.spans)} spans, of"
        f" which {spans} are evaluated; {run.time[-1]:.2f} s simulated."
    )


def _pictures(run: Run, shape: Shape, filter: FilterKind, *, waves: bool) -> dict[str, str]:
    """Addresses of the pictures by name, the pictures inside them."""
    pictures = {
        "force": svg_address(run_pictures.plot_contact_force(run, filter=filter)),
        "uplift": svg_address(run_pictures.plot_support_uplift(run)),
        "droppers": svg_address(run_pictures.plot_dropper_forces(run)),
        "layout": svg_address(layout.plot_layout(shape.catenary, shape)),
        "shape": svg_address(static.plot_static_shape(shape)),
    }
    if run.has_energy:
        pictures["energy"] = svg_address(run_pictures.plot_energy(run))
    if run.reached:
        pictures["spectrum"] = svg_address(plot_force_spectrum(run))
    if shape.catenary.is_spatial:
        width = plan.head_width(run.pantographs)
        pictures["plan"] = svg_address(plan.plot_plan(shape, head_width=width))
    if curve := run.elasticity:
        pictures["elasticity"] = svg_address(static.plot_elasticity(curve))
    if waves:
        pictures["waves"] = svg_address(
            run_waves.plot_run_waves(run, ax=new_axes(None, (11.0, 5.4))), dpi=150
        )
    return pictures
