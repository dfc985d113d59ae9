"""Pages made of pictures, tables and the data of curves: a report, a comparison, an index of pictures."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Any

from matplotlib.axes import Axes

from catenary_fe.layout import InputError, PowerSystem
from catenary_fe.layout.arguments import listed
from catenary_fe.results import Criterion, Run, checks_in_words, criteria_in_words, criteria_rows
from catenary_fe.results.check import checks_table
from catenary_fe.results.comparison import failed_checks, figures_table, input_differences, key_figures
from catenary_fe.results.criteria import criteria_table
from catenary_fe.results.line_test import LineTestComparison
from catenary_fe.results.line_test.tables import all_tables
from catenary_fe.results.signal import FilterKind
from catenary_fe.statics import Shape
from catenary_fe.views import comparison
from catenary_fe.views.line_test import plot_line_test
from catenary_fe.views.report import headline, series, tables
from catenary_fe.views.run import plot_force_spectrum, run_pictures
from catenary_fe.views.static import plot_elasticity
from catenary_fe.views.style import new_axes, own_style, run_title, styled
from catenary_fe.views.waves import plot_run_waves

if TYPE_CHECKING:
    from jinja2 import Environment, Template

ASSETS = ("uPlot.min.css", "report.css", "uPlot.iife.min.js", "charts.js", "player.js", "report.js",
          "uPlot.LICENSE")  # fmt: skip


@styled
def report_page(run: Run, shape: Shape, *, system: PowerSystem = "AC", filter: FilterKind = "causal") -> str:
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
    governing = headline.governing_figures(run, filter, rows)
    checks = checks_in_words(run.checks)
    content: dict[str, Any] = {
        "title": run.data.attrs["title"],
        "partial": str(run.partial) if run.partial else "",
        "speed": f"{3.6 * run.speed:g}",
        "lead": _lead(run),
        "governing": headline.why_it_governs(run, governing, rows),
        "versions": json.loads(run.data.attrs["versions"]),
        "keys": headline.key_figures(run, filter, governing),
        "system": system,
        "criteria": headline.criteria_bars(rows),
        "closest": headline.closest(rows),
        "verdict": f"{system}: {criteria_in_words(rows)}." if rows else f"Not judged. {run.partial}.",
        "bad": any(row.passed is False for row in rows),
        "checks_verdict": checks[0].upper() + checks[1:] + ".",
        "warnings": run.warnings,
        "checks": tables.Table("", *checks_table(run.checks)),
        "motion": motion is not None,
        "statistics": tables.statistics_table(run, filter),
        "by_span": tables.span_table(run, filter),
        "uplifts": tables.uplift_table(run),
        "slack": tables.slack_table(run),
        "spans": tables.line_spans_table(shape.catenary),
        "schedule": tables.schedule_table(shape),
        "supports": tables.support_table(shape),
        "inputs": tables.input_tables(run),
        "pictures": _pictures(run, shape, filter, moving=motion is not None),
        "data": {
            "force": series.force_chart(run, filter),
            "uplift": series.uplift_chart(run),
            "heights": series.heights_chart(run, shape),
            "plan": series.plan_chart(run, shape) if shape.catenary.is_spatial else None,
            "spans": series.line_spans(run),
            "motion": motion,
        },
        "footer": "Everything on this page was computed by catenary_fe; how far that can be trusted is in its"
        " validation report.",
    }
    return template("report.html.j2").render(content)


def _lead(run: Run) -> str:
    names = [str(name) for name in run.data["pantograph"].values]
    spans = listed(run.evaluated_spans)
    return (
        f"{' and '.join(names)} on {run.catenary.length:g} m of line, {len(run.catenary.spans)} spans, of"
        f" which {spans} are evaluated; {run.time[-1]:.2f} s simulated."
    )


def _pictures(run: Run, shape: Shape, filter: FilterKind, *, moving: bool) -> dict[str, str]:
    """Addresses of the pictures by name, the pictures inside them."""
    pictures = {name: svg_address(ax) for name, ax in run_pictures(run, shape, filter)}
    if run.reached:
        pictures["spectrum"] = svg_address(plot_force_spectrum(run))
    if curve := run.elasticity:
        pictures["elasticity"] = svg_address(plot_elasticity(curve))
    if moving:
        pictures["waves"] = svg_address(plot_run_waves(run, ax=new_axes(None, (11.0, 5.4))), dpi=150)
    return pictures


@styled
def comparison_page(runs: Sequence[Run], labels: Sequence[str], *, filter: FilterKind = "causal") -> str:
    """HTML of a comparison, complete in itself. Raises InputError for fewer than two runs."""
    columns = key_figures(runs, labels, filter)
    differences = [(d.name, *d.values) for d in input_differences(runs)]
    content = {
        "title": " and ".join(labels),
        "inputs": tables.Table("", ("input", *labels), differences),
        "figures": tables.Table("", *figures_table(columns)),
        "warnings": failed_checks(runs, labels),
        "pictures": {
            "force": svg_address(comparison.plot_force_comparison(runs, labels, filter=filter)),
            "uplift": svg_address(comparison.plot_uplift_comparison(runs, labels)),
        },
    }
    return template("comparison.html.j2").render(content)


@styled
def line_test_page(compared: LineTestComparison, title: str) -> str:
    """HTML of a run beside a line test, complete in itself.

    title : what was compared with what
    """
    rows, run = compared.criteria, compared.run
    known = any(row.limit is not None for row in rows)
    content = {
        "title": title,
        "lead": f"{run_title(run, '')}; pantograph {run.data['pantograph'].values[compared.pantograph]}.",
        "verdict": f"Deviations: {criteria_in_words(rows)}." if known else "Not judged: no limit is known.",
        "bad": any(row.passed is False for row in rows),
        "criteria": tables.Table("", *criteria_table(rows)),
        "figures": [tables.Table(caption, *found) for caption, found in all_tables(compared)],
        "warnings": [*failed_checks([run], ["run"]), *compared.warnings],
        "notes": compared.notes,
        "picture_address": svg_address(plot_line_test(compared)),
    }
    return template("line_test.html.j2").render(content)


@dataclass(frozen=True)
class PageEntry:
    """One figure of the page.

    name : of its script and its picture, without ending
    title : one line
    caption, numbers : what it says; ``numbers`` by name
    failure : why there is no picture, or nothing
    """

    name: str
    title: str
    caption: str = ""
    numbers: dict[str, float] = field(default_factory=dict)
    failure: str = ""


def index_page(title: str, entries: Sequence[PageEntry]) -> str:
    """HTML that shows each figure, or names it and why it failed; its links are relative."""
    failed = [entry for entry in entries if entry.failure]
    return template("index.html.j2").render(title=title, entries=entries, failed=failed) + "\n"


def svg_address(ax: Axes, dpi: int = 100) -> str:
    """A data address of the picture as SVG: sharp on paper, and the same bytes each time.

    dpi : of what is a bitmap inside it
    """
    figure, file = ax.get_figure(root=True), io.BytesIO()
    assert figure is not None
    with own_style({"path.simplify_threshold": 0.3}):
        figure.savefig(file, format="svg", dpi=dpi, metadata={"Date": None})
    return "data:image/svg+xml;base64," + base64.b64encode(file.getvalue()).decode("ascii")


def template(name: str) -> Template:
    """A template by its file's name; ``assets`` in it are style and scripts as they are."""
    return _environment().get_template(name)


@cache
def _environment() -> Environment:
    from jinja2 import Environment, PackageLoader, StrictUndefined
    from markupsafe import Markup

    folder = resources.files(__package__).joinpath("assets")
    environment = Environment(
        loader=PackageLoader(__package__, "assets"), autoescape=True, undefined=StrictUndefined
    )
    environment.globals["assets"] = {
        name: Markup(folder.joinpath(name).read_text(encoding="utf-8")) for name in ASSETS
    }
    return environment
