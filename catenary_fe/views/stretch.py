"""Which part of a line a picture shows: the whole of it, some spans, or both."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.layout import Catenary
from catenary_fe.layout.arguments import span_numbers
from catenary_fe.views.style import SUPPORT, mark_spans, new_axes, new_panels, runs

Floats = NDArray[np.float64]
CLOSE = 4  # spans that a picture can show with all their dimensions


@dataclass(frozen=True)
class Stretch:
    """Consecutive spans of a line.

    first, last : numbers of the spans, from 1
    """

    catenary: Catenary
    first: int
    last: int

    @property
    def spans(self) -> range:
        """Numbers of the spans, from 1."""
        return range(self.first, self.last + 1)

    @property
    def supports(self) -> range:
        """Numbers of the supports, from 0."""
        return range(self.first - 1, self.last + 1)

    @property
    def support_x(self) -> Floats:
        """[m] positions of the supports along the line."""
        return np.asarray(self.catenary.support_positions[self.first - 1 : self.last + 1])

    @property
    def start(self) -> float:
        """[m] along the line."""
        return float(self.support_x[0])

    @property
    def end(self) -> float:
        """[m] along the line."""
        return float(self.support_x[-1])

    @property
    def is_close(self) -> bool:
        """Whether there are few enough spans for their dimensions."""
        return len(self.spans) <= CLOSE

    @property
    def evaluated(self) -> list[int]:
        """Numbers of the spans that are evaluated."""
        return [n for n in self.catenary.spans_to_evaluate if n in self.spans]

    def inside(self, x: Floats) -> NDArray[np.bool_]:
        """Which positions [m] along the line lie in these spans."""
        return np.asarray((x > self.start) & (x < self.end))

    def sampled(self, nodes: Floats) -> Floats:
        """[m] positions to draw a wire at that has these nodes: close enough for a curve, nodes included."""
        low, high = max(self.start, float(nodes[0])), min(self.end, float(nodes[-1]))
        if high < low:
            return np.array([])
        points = 2 + int(1500 * (high - low) / (self.end - self.start))
        x = np.union1d(np.linspace(low, high, points), nodes)
        return x[(x >= low) & (x <= high)]

    def __str__(self) -> str:
        if self.last == self.first:
            return f"span {self.first}"
        return f"spans {self.first} {'and' if len(self.spans) == 2 else 'to'} {self.last}"


def stretch(catenary: Catenary, spans: Sequence[int] | None = None) -> Stretch:
    """From the lowest to the highest of some spans (numbers from 1); unset: the whole line.

    Raises InputError for spans that the line does not have.
    """
    count = len(catenary.spans)
    numbers = span_numbers(spans, count, range(1, count + 1))
    return Stretch(catenary, min(numbers), max(numbers))


def evaluated_pair(catenary: Catenary, among: Sequence[int] = ()) -> Stretch:
    """The first two evaluated spans that are neighbours, or the first one and a neighbour of it.

    among : numbers of spans to take them from, if any of these is evaluated
    """
    groups = runs(set(among) & set(catenary.spans_to_evaluate) or catenary.spans_to_evaluate)
    first = next((a for a, b in groups if b > a), groups[0][0])
    first = max(1, min(first, len(catenary.spans) - 1))
    return Stretch(catenary, first, min(first + 1, len(catenary.spans)))


def draw_line(
    catenary: Catenary,
    draw: Callable[[Axes, Stretch], object],
    spans: Sequence[int] | None,
    ax: Axes | None,
    size: tuple[float, float],
    among: Sequence[int] = (),
) -> Axes:
    """Draw some spans, or the whole line, and of a long one below that two spans closer.

    draw : draws a stretch on axes
    ax : unset: those of a new figure
    size : [in] of a figure for one stretch
    among : numbers of the spans that are worth drawing closer, where there is a choice

    Returns the (upper) axes.
    """
    part = stretch(catenary, spans)
    if ax is not None or spans or part.is_close:
        ax = new_axes(ax, size)
        draw(ax, part)
        _legend(ax)
        return ax
    whole, close = new_panels((size[0], 2 * size[1]), (1, 1))
    detail = evaluated_pair(catenary, among)
    draw(whole, part)
    mark_detail(whole, detail)
    draw(close, detail)
    _legend(whole)
    return whole


def mark_detail(ax: Axes, detail: Stretch) -> None:
    """A bar along the top over what is drawn closer below."""
    ax.plot(
        [detail.start, detail.end], [0.995, 0.995], color=SUPPORT, linewidth=3.0, solid_capstyle="butt",
        transform=ax.get_xaxis_transform(), label="drawn closer below",
    )  # fmt: skip


def _legend(ax: Axes) -> None:
    ax.legend(loc="upper center", ncols=8, fontsize=8, frameon=False, handlelength=1.6, columnspacing=1.4)


def mark_evaluated(ax: Axes, part: Stretch) -> None:
    """A band behind the evaluated spans of a stretch, unless they are all of it."""
    if len(part.evaluated) < len(part.spans):
        mark_spans(ax, part.catenary.support_positions, part.evaluated)
