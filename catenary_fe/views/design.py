"""The way of a search for a design: what each design is worth, and where its variables are."""

from __future__ import annotations

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from catenary_fe.layout.variation import unit_of
from catenary_fe.views import style

_FIGURE = {
    "std_N": "σ (N)", "max_N": "largest force (N)", "min_N": "smallest force (N)",
    "statistical_max_N": "Fₘ + 3σ (N)", "statistical_min_N": "Fₘ − 3σ (N)",
    "max_support_uplift_mm": "largest uplift (mm)", "contact_loss_percent": "contact loss (%)",
}  # fmt: skip


@style.styled
def plot_design(found: Any) -> Axes:
    """Objective over the evaluations, those that miss a criterion hollow, and the variables in their bounds.

    found : of :func:`catenary_fe.optimise`

    Returns the upper axes.
    """
    history, problem = found.history, found.problem
    objective = problem.study.objective
    count = np.arange(1, len(history) + 1)
    worth = np.abs([e.objective for e in history])
    good = np.array([e.is_good for e in history])
    figure = style.Picture(figsize=(9.0, 6.2), layout="constrained")
    axes: list[Axes] = list(figure.subplots(2, 1, sharex=True))
    upper, lower = axes
    colour = style.PANTOGRAPHS[0]
    upper.plot(count[good], worth[good], "o", color=colour, markersize=4, label="meets all criteria")
    if (~good).any():
        upper.plot(
            count[~good], worth[~good], "o", markerfacecolor="none", color="#999999", markersize=4,
            label="misses a criterion",
        )  # fmt: skip
    best = next(n for n, e in enumerate(history, start=1) if e is found.best)
    upper.plot(best, worth[best - 1], "*", color=style.PANTOGRAPHS[1], markersize=13, label="best")
    style.legend(upper, 3)
    style.headroom(upper, 0.2)
    label = f"{objective.over} {_FIGURE[objective.figure]}"
    title = f"{problem.study.name}: {label.split(' (')[0]} of {len(history)} designs"
    style.finish(upper, "", label, title)
    low, high = problem.bounds.T
    colours = style.distinct(len(problem.names))
    for n, (name, own) in enumerate(zip(problem.names, colours, strict=True)):
        share = [(e.x[n] - low[n]) / (high[n] - low[n]) for e in history]
        unit = unit_of(name.split(" ")[0])
        label = f"{name}: {low[n]:g} to {high[n]:g} {unit}".rstrip()
        lower.plot(count, share, ".", color=own, markersize=5, label=label)
    lower.axvline(best, color=style.PANTOGRAPHS[1], linewidth=0.9)
    lower.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0])
    lower.set_ylim(-0.03, 1.03)
    if len(problem.names) <= 8:
        style.headroom(lower, 0.1 + 0.09 * ((len(problem.names) + 1) // 2))
        style.legend(lower, 2)
    lower.xaxis.set_major_locator(MaxNLocator(integer=True))
    style.finish(lower, "evaluation", "place between the bounds", "variables")
    return upper
