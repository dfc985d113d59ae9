"""Springs between points of the wires, or from them to fixed pivots: droppers, and steady arms as bars."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

FIXED = -1  # number of a coordinate that cannot move


@dataclass(frozen=True)
class Springs:
    """Springs between points: droppers, which only pull, and steady arms that are bars on a fixed pivot.

    first : shape (springs,), number of the first coordinate of the point at the lower end
    last : shape (springs,), likewise of the other end; FIXED where that is a pivot
    pivot : [m], shape (springs, axes), of bars: the fixed end
    length : [m], shape (springs,), without force
    stiffness, damping : [N/m], [N s/m], shape (springs,)
    pulls_only : whether they go slack instead of pushing
    """

    first: Integers
    last: Integers
    pivot: Floats
    length: Floats
    stiffness: Floats
    damping: Floats
    pulls_only: bool

    def only(self, kept: NDArray[np.bool_]) -> Springs:
        """Some of them, shape (springs,)."""
        arrays = {name: value[kept] for name, value in vars(self).items() if name != "pulls_only"}
        return replace(self, **arrays)

    def index(self) -> Integers:
        """Shape (springs, axes or 2 * axes): coordinates of the lower, then of the upper end."""
        axes = np.arange(self.pivot.shape[1])
        lower = self.first[:, None] + axes
        return np.hstack([lower, self.last[:, None] + axes]) if self.pulls_only else lower

    def span(self, total: Floats) -> Floats:
        """[m], shape (..., springs, axes), from the lower to the upper end; total : shape (..., all)."""
        axes = np.arange(self.pivot.shape[1])
        upper = total[..., self.last[:, None] + axes] if self.pulls_only else self.pivot
        span: Floats = upper - total[..., self.first[:, None] + axes]
        return span

    def tension(self, span: Floats) -> Floats:
        """[N], shape (..., springs)."""
        tension: Floats = self.stiffness * (np.linalg.norm(span, axis=-1) - self.length)
        return np.maximum(tension, 0.0) if self.pulls_only else tension

    def forces(self, total: Floats) -> Floats:
        """[N], shape (..., *index): on the points."""
        span = self.span(total)
        pull: Floats = (self.tension(span) / np.linalg.norm(span, axis=-1))[..., None] * span
        return np.concatenate([pull, -pull], axis=-1) if self.pulls_only else pull

    def damper_forces(self, total: Floats, rates: Floats) -> Floats:
        """[N], shape (springs, 2 * axes): of the dampers of droppers, at most their springs' forces."""
        span = self.span(total)
        direction = span / np.linalg.norm(span, axis=-1)[..., None]
        axes, spring = np.arange(self.pivot.shape[1]), self.tension(span)
        rate = rates[self.last[:, None] + axes] - rates[self.first[:, None] + axes]
        drag = np.clip(self.damping * (rate * direction).sum(axis=1), -spring, spring)
        return np.hstack([drag[:, None] * direction, -drag[:, None] * direction])

    def blocks(self, total: Floats, *, taut: bool) -> Floats:
        """Stiffness [N/m], shape (springs, m, m), over :meth:`index`.

        taut : slack droppers count as just taut, not as gone
        """
        block = self.span_blocks(self.span(total), taut=taut)
        return np.block([[block, -block], [-block, block]]) if self.pulls_only else block

    def span_blocks(self, span: Floats, *, taut: bool = False) -> Floats:
        """Stiffness [N/m], shape (springs, axes, axes), against a change of the span [m]."""
        stiffness = self.stiffness
        if self.pulls_only and not taut:
            stiffness = np.where(np.linalg.norm(span, axis=1) > self.length, stiffness, 0.0)
        return spring_blocks(span, self.tension(span), stiffness)

    def energy(self, total: Floats) -> float:
        """[J]"""
        return float((self.tension(self.span(total)) ** 2 / (2 * self.stiffness)).sum())


def spring_blocks(span: Floats, tension: Floats, stiffness: Floats) -> Floats:
    """Stiffness [N/m] of springs at one end, shape (..., springs, axes, axes).

    span : [m], shape (..., springs, axes), from end to end
    tension, stiffness : [N], [N/m], shape (..., springs) or (springs,)
    """
    now = np.linalg.norm(span, axis=-1)
    direction = span / now[..., None]
    axial = direction[..., :, None] * direction[..., None, :]
    across = (tension / now)[..., None, None] * (np.eye(span.shape[-1]) - axial)
    blocks: Floats = stiffness[..., None, None] * axial + across
    return blocks
