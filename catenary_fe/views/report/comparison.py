"""One HTML page with several runs side by side."""

from __future__ import annotations

from collections.abc import Sequence

from catenary_fe.results import Run
from catenary_fe.results.comparison import QUANTITIES, Column, failed_checks, input_differences, key_figures
from catenary_fe.results.signal import FilterKind
from catenary_fe.views.comparison import plot_force_comparison, plot_uplift_comparison
from catenary_fe.views.report.html import svg_address, template
from catenary_fe.views.report.tables import Table
from catenary_fe.views.style import styled

_DIGITS = {
    "contact_loss_percent": 2,
    "contact_loss_over_5_ms_percent": 2,
    "losses_over_5_ms": 0,
    "elasticity_non_uniformity_percent": 2,
    "slack_droppers": 0,
    "checks_failed": 0,
}


@styled
def comparison_page(runs: Sequence[Run], labels: Sequence[str], *, filter: FilterKind = "causal") -> str:
    """HTML of a comparison, complete in itself. Raises InputError for fewer than two runs."""
    columns = key_figures(runs, labels, filter)
    differences = [(d.name, *d.values) for d in input_differences(runs)]
    content = {
        "title": " and ".join(labels),
        "inputs": Table("", ("input", *labels), differences),
        "figures": figures_table(columns),
        "warnings": failed_checks(runs, labels),
        "pictures": {
            "force": svg_address(plot_force_comparison(runs, labels, filter=filter)),
            "uplift": svg_address(plot_uplift_comparison(runs, labels)),
        },
    }
    return template("comparison.html.j2").render(content)


def figures_table(columns: Sequence[Column]) -> Table:
    """Key figures; where two columns are compared, with their difference."""
    rows = []
    for key, name in QUANTITIES.items():
        values = [column.values[key] for column in columns]
        digits = _DIGITS.get(key, 1)
        if all(value is None for value in values):
            continue
        texts = ["–" if value is None else f"{value:.{digits}f}" for value in values]
        if len(values) == 2:
            known = [value for value in values if value is not None]
            change = f"{round(known[-1] - known[0], digits) + 0.0:+.{digits}f}"
            texts.append(change if len(known) == 2 else "–")
        rows.append((name, *texts))
    names = [column.label for column in columns]
    return Table("", ("", *names, *(["difference"] if len(names) == 2 else [])), rows)
