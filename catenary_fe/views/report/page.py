"""Puts a report together from pictures, tables and the data of its curves."""

from __future__ import annotations

import base64
import io
import json
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

from matplotlib import rc_context
from matplotlib.axes import Axes

from catenary_fe.equilibrium import Shape
from catenary_fe.results import Elasticity, Run
from catenary_fe.results.signal import FilterKind
from catenary_fe.system import InputError
from catenary_fe.views import layout, run_waves
from catenary_fe.views import run as run_pictures
from catenary_fe.views.report import series, tables
from catenary_fe.views.spectrum import plot_force_spectrum
from catenary_fe.views.style import new_axes

if TYPE_CHECKING:
    from jinja2 import Template

ASSETS = ("uPlot.min.css", "report.css", "uPlot.iife.min.js", "report.js", "uPlot.LICENSE")


def report_page(
    run: Run, shape: Shape, elasticity: Elasticity | None = None, *, filter: FilterKind = "causal"
) -> str:
    """HTML of a run's report, complete in itself.

    shape : the static shape that the run started from
    elasticity : of the line; unset: the report shows none
    filter : of the contact force's statistics

    The player and the picture of the waves are left out where the run stored no wire shapes.
    """
    try:
        motion = series.motion(run)
    except InputError:
        motion = None
    spans, several = run.evaluated_spans, len(set(shape.catenary.spans)) > 1
    content: dict[str, Any] = {
        "title": run.data.attrs["title"],
        "speed": f"{3.6 * run.speed:g}",
        "lead": _lead(run),
        "versions": json.loads(run.data.attrs["versions"]),
        "keys": tables.key_figures(run, filter),
        "criteria": None,
        "warnings": run.warnings,
        "checks": tables.checks_table(run),
        "motion": motion is not None,
        "statistics": tables.statistics_table(run, filter),
        "uplifts": tables.uplift_table(run),
        "slack": tables.slack_table(run),
        "schedule": tables.schedule_table(shape, spans if several else spans[:1]),
        "whole_schedule": tables.schedule_table(shape, None),
        "inputs": tables.input_tables(run),
        "pictures": _pictures(run, shape, elasticity, waves=motion is not None),
        "data": {
            "force": series.force_chart(run, filter),
            "uplift": series.uplift_chart(run),
            "motion": motion,
        },
        "footer": "Everything on this page was computed by catenary_fe; how far that can be trusted is in its"
        " validation report.",
    }
    return _template().render(content)


def _lead(run: Run) -> str:
    names = " and ".join(str(name) for name in run.data["pantograph"].values)
    spans = ", ".join(map(str, run.evaluated_spans))
    return (
        f"{names} on {run.catenary.length:g} m of line, {len(run.catenary.spans)} spans, of which {spans}"
        f" are evaluated; {run.time[-1]:.2f} s simulated."
    )


def _pictures(run: Run, shape: Shape, elasticity: Elasticity | None, *, waves: bool) -> dict[str, str]:
    """Addresses of the pictures by name, the pictures inside them."""
    pictures = {
        "force": _svg(run_pictures.plot_contact_force(run)),
        "spectrum": _svg(plot_force_spectrum(run)),
        "uplift": _svg(run_pictures.plot_support_uplift(run)),
        "droppers": _svg(run_pictures.plot_dropper_forces(run)),
        "layout": _svg(layout.plot_layout(shape.catenary, shape)),
        "shape": _svg(layout.plot_static_shape(shape)),
    }
    if elasticity:
        pictures["elasticity"] = _svg(layout.plot_elasticity(elasticity))
    if waves:
        pictures["waves"] = _svg(run_waves.plot_run_waves(run, ax=new_axes(None, (11.0, 5.4))), dpi=150)
    return pictures


def _svg(ax: Axes, dpi: int = 100) -> str:
    """A data address of the picture as SVG: sharp on paper, and the same bytes each time."""
    figure, file = ax.get_figure(root=True), io.BytesIO()
    assert figure is not None
    with rc_context({"svg.hashsalt": "catenary_fe", "path.simplify_threshold": 0.3}):
        figure.savefig(file, format="svg", dpi=dpi, metadata={"Date": None})
    return "data:image/svg+xml;base64," + base64.b64encode(file.getvalue()).decode("ascii")


@cache
def _template() -> Template:
    """The page's template, with style and scripts as they are."""
    from jinja2 import Environment, StrictUndefined
    from markupsafe import Markup

    folder = resources.files(__package__).joinpath("assets")
    assets = {name: Markup(folder.joinpath(name).read_text(encoding="utf-8")) for name in ASSETS}
    environment = Environment(autoescape=True, undefined=StrictUndefined)
    environment.globals["assets"] = assets
    return environment.from_string(folder.joinpath("report.html.j2").read_text(encoding="utf-8"))
