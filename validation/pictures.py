"""What all pictures share."""

from __future__ import annotations

from typing import Any

from matplotlib.axes import Axes

COMPUTED: dict[str, Any] = {"color": "#c1440e", "linewidth": 1.4}
REFERENCE: dict[str, Any] = {"color": "black", "linewidth": 1.0, "linestyle": "--"}


def label(ax: Axes, x: str, y: str, title: str = "") -> None:
    """Label the axes and draw a light grid."""
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    if title:
        ax.set_title(title, fontsize=9)
    ax.grid(alpha=0.25)
    ax.tick_params(labelsize=8)
