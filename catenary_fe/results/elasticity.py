"""Elasticity of a catenary: how far a static force lifts the contact wire."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout.frozen import changed_by_copy

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Floats = NDArray[np.float64]


@changed_by_copy
@dataclass(frozen=True)
class Elasticity:
    """Uplift under a static force, point by point along the line.

    position : [m], shape (points,), along the line
    uplift : [m], shape (points,), under the force
    force : [N] upward
    support_position : [m] of the supports in the range, for the picture
    """

    position: Floats
    uplift: Floats
    force: float
    support_position: Floats

    @property
    def values(self) -> Floats:
        """[m/N], shape (points,): uplift over force."""
        return self.uplift / self.force

    @property
    def non_uniformity(self) -> float:
        """(e_max − e_min)/(e_max + e_min) over the range."""
        e = self.values
        return float((e.max() - e.min()) / (e.max() + e.min()))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the curve. See :func:`catenary_fe.views.plot_elasticity`."""
        from catenary_fe.views import plot_elasticity

        return plot_elasticity(self, ax=ax)
