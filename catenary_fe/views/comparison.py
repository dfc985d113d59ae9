"""Pictures of several runs over one another."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.results import Run
from catenary_fe.results.quantities import in_short
from catenary_fe.results.signal import FilterKind
from catenary_fe.views import style

Floats = NDArray[np.float64]


@style.styled
def plot_force_comparison(
    runs: Sequence[Run], labels: Sequence[str], *, filter: FilterKind = "causal"
) -> Axes:
    """Contact forces of each run's first pantograph along the line, and below their differences to the first.

    Returns the axes of the forces; the differences are in the axes below it. Supports are the first run's.
    """
    figure = style.Picture(figsize=(11.0, 6.4), layout="constrained")
    force, difference = figure.subplots(2, 1, sharex=True, height_ratios=(3, 2))
    curves = [_force(run, filter) for run in runs]
    first_x, first = curves[0]
    for axes in (force, difference):
        style.mark_supports(axes, runs[0].data["support_position"].values, label=axes is force)
    colours = style.distinct(len(runs))
    for i, ((x, values), label, colour) in enumerate(zip(curves, labels, colours, strict=True)):
        statistics = runs[i].contact_force_statistics(filter=filter)[0]
        name = f"{label}: {in_short(statistics, ('mean', 'std'))}"
        force.plot(x, values, color=colour, linewidth=1.1, label=name)
        if i:
            there = np.interp(first_x, x, values, left=np.nan, right=np.nan)
            difference.plot(
                first_x, there - first, color=colour, linewidth=1.1, label=f"{label} − {labels[0]}"
            )
    for axes in (force, difference):
        style.headroom(axes, 0.2)
        style.legend(axes, 3)
        axes.margins(x=0.01)
    style.finish(force, "", "contact force\n0 to 20 Hz (N)", "Contact force of the first pantographs")
    style.finish(difference, style.ALONG, "difference (N)", "")
    chosen: Axes = note_all_failed(force, runs, labels)
    return chosen


@style.styled
def plot_uplift_comparison(runs: Sequence[Run], labels: Sequence[str], *, ax: Axes | None = None) -> Axes:
    """Largest uplift at each support of each run."""
    ax = style.new_axes(ax)
    for run, label, colour in zip(runs, labels, style.distinct(len(runs)), strict=True):
        x = run.data["support_position"].values[1:-1]
        by_support = run.uplift_by_support(range(1, x.size + 2))
        uplift = [1e3 * lift for lift in list(by_support.values())[1:-1]]
        ax.plot(x, uplift, "o-", color=colour, linewidth=0.8, markersize=5, label=label)
    ax.set_ylim(bottom=0)
    style.headroom(ax, 0.2)
    style.legend(ax)
    style.finish(ax, style.ALONG, "largest uplift (mm)", "Largest uplift at the supports")
    return note_all_failed(ax, runs, labels)


def note_all_failed(ax: Axes, runs: Sequence[Run], labels: Sequence[str]) -> Axes:
    """Say under the title which run fails which checks."""
    for run, label in zip(runs, labels, strict=True):
        style.note_failed(ax, run.failed_checks, f" by {label}")
    return ax


def _force(run: Run, filter: FilterKind) -> tuple[Floats, Floats]:
    return np.asarray(run.data["position"].values[0]), run.filtered_contact_force(filter)[0]
