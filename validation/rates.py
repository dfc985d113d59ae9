"""Rates of convergence: fitted, compared with what theory says, drawn."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from validation.check import Check, compare
from validation.paper_wire import Floats

REASON = "the rate that theory gives ± 0.2: a slope fitted over a factor of 2 to 8 is not yet the limit"


def rate(size: Floats, error: Floats) -> float:
    """Slope of the straight line through the errors on logarithmic axes."""
    return float(np.polyfit(np.log(size), np.log(error), 1)[0])


def compare_rate(name: str, size: Floats, error: Floats, order: float, *, source: str) -> Check:
    return compare(name, rate(size, error), order, 0.2, source=source, reason=REASON, absolute=True)


def draw_rate(ax: Axes, size: Floats, error: Floats, order: int, name: str) -> None:
    """Errors, and a line of the order that theory has through the smallest one."""
    (line,) = ax.loglog(size, error, "o", markersize=5, label=f"{name}: order {rate(size, error):.2f}")
    ax.loglog(
        size, error[-1] * (size / size[-1]) ** order, "--", color=line.get_color(), label=f"order {order}"
    )
    ax.set_xticks(size, [f"{value:g}" for value in size])
    ax.set_xticks([], minor=True)
    ax.legend(fontsize=8)
