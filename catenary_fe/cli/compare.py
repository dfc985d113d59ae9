"""Several runs side by side."""

from __future__ import annotations

from pathlib import Path
from typing import Any, get_args

import click

from catenary_fe.cli.criteria import kept_evaluation
from catenary_fe.cli.folder import output_folder, run_in
from catenary_fe.cli.surroundings import readable
from catenary_fe.cli.terminal import (
    json_option,
    output_option,
    print_json,
    print_table,
    print_warnings,
    quiet_option,
    working,
)
from catenary_fe.results.signal import FilterKind


@click.command(
    epilog="\b\nExamples:\n  catenary-fe compare run250 run300\n"
    "  catenary-fe compare before after -o comparison"
)
@click.argument("folders", nargs=-1, required=True, type=click.Path(), metavar="FOLDER FOLDER...")
@click.option(
    "--filter",
    "filter_kind",
    type=click.Choice(get_args(FilterKind)),
    help="Low-pass of the contact forces; unset: as in the runs' summaries, causal where they differ.",
)
@output_option
@json_option
@quiet_option
def compare(
    folders: tuple[str, ...],
    filter_kind: FilterKind | None,
    output: str | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Put the runs in two or more FOLDERs side by side: what went in differently, and what came out.

    With -o, also pictures of forces, differences and uplifts, and a page comparison.html.
    """
    from catenary_fe.results.comparison import failed_checks, figures_table, input_differences, key_figures

    runs, labels = [run_in(folder) for folder in folders], _labels(folders)
    kind, warnings = common_filter(folders, labels, filter_kind)
    warnings += failed_checks(runs, labels)
    columns, inputs = key_figures(runs, labels, kind), input_differences(runs)
    result: dict[str, Any] = {
        "inputs_that_differ": [{"name": d.name} | dict(zip(labels, d.values, strict=True)) for d in inputs],
        "runs": [{"label": column.label, **column.values} for column in columns],
        "filter": kind,
        "warnings": warnings,
    }
    with output_folder(output) as folder, working("pictures", bool(output) and not quiet):
        if folder:
            from catenary_fe.views.comparison import plot_force_comparison, plot_uplift_comparison
            from catenary_fe.views.report import comparison_page

            folder.json("comparison.json", result)
            folder.table("comparison.csv", result["runs"])
            folder.picture("contact_force.png", plot_force_comparison(runs, labels, filter=kind))
            folder.picture("support_uplift.png", plot_uplift_comparison(runs, labels))
            folder.text("comparison.html", comparison_page(runs, labels, filter=kind))
    if as_json:
        print_json(result)
    elif not quiet:
        if inputs:
            print_table("what went in differently", ("input", *labels), [(d.name, *d.values) for d in inputs])
        else:
            click.echo("the inputs are the same")
        print_table(f"what came out, {kind} filter", *figures_table(columns))
    if not as_json:
        print_warnings(warnings)


def common_filter(
    folders: tuple[str, ...], labels: list[str], chosen: FilterKind | None
) -> tuple[FilterKind, list[str]]:
    """The filter of all figures, and what to warn of: runs whose own figures are another filter's."""
    kinds = [kept_evaluation(folder)[0] for folder in folders]
    kind: FilterKind = chosen or (kinds[0] if len(set(kinds)) == 1 else "causal")
    return kind, [
        f"{label}: its own summary has figures of the {own} filter, here they are of the {kind} one"
        for label, own in zip(labels, kinds, strict=True)
        if own != kind
    ]


def _labels(folders: tuple[str, ...]) -> list[str]:
    """Last parts of the paths, or the whole paths where those are not unique."""
    names = [readable(Path(folder).resolve().name) for folder in folders]
    return names if len(set(names)) == len(names) else [readable(folder) for folder in folders]
