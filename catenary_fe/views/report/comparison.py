"""One HTML page with several runs side by side."""

from __future__ import annotations

from collections.abc import Sequence

from catenary_fe.results import Run
from catenary_fe.results.comparison import failed_checks, figures_table, input_differences, key_figures
from catenary_fe.results.signal import FilterKind
from catenary_fe.views.comparison import plot_force_comparison, plot_uplift_comparison
from catenary_fe.views.report.html import svg_address, template
from catenary_fe.views.report.tables import Table
from catenary_fe.views.style import styled


@styled
def comparison_page(runs: Sequence[Run], labels: Sequence[str], *, filter: FilterKind = "causal") -> str:
    """HTML of a comparison, complete in itself. Raises InputError for fewer than two runs."""
    columns = key_figures(runs, labels, filter)
    differences = [(d.name, *d.values) for d in input_differences(runs)]
    content = {
        "title": " and ".join(labels),
        "inputs": Table("", ("input", *labels), differences),
        "figures": Table("", *figures_table(columns)),
        "warnings": failed_checks(runs, labels),
        "pictures": {
            "force": svg_address(plot_force_comparison(runs, labels, filter=filter)),
            "uplift": svg_address(plot_uplift_comparison(runs, labels)),
        },
    }
    return template("comparison.html.j2").render(content)
