"""Picture of a catenary's layout with its dimensions."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.layout import Catenary
from catenary_fe.layout.arguments import checked
from catenary_fe.statics import Shape
from catenary_fe.views.lines import Line, draw_lines, hanging_lines, sketched_lines, upper_wires
from catenary_fe.views.stretch import Stretch, draw_line, evaluated_pair, mark_evaluated
from catenary_fe.views.style import DROPPER, SUPPORT, finish, label_row, styled

_BELOW = 0.75  # [m] of room under the contact wire, for dimensions


@checked
@styled
def plot_layout(
    catenary: Catenary,
    shape: Shape | None = None,
    *,
    spans: Sequence[int] | None = None,
    to_scale: bool = False,
    ax: Axes | None = None,
) -> Axes:
    """Draw wires, droppers and supports with their dimensions, the evaluated spans marked.

    shape : where it is known, the wires are drawn as they hang; else the messenger wire as a parabola
    spans : numbers of the spans, from 1; unset: the whole line, and of a long one two spans closer below it
    to_scale : the same scale along and up, of the first evaluated spans where ``spans`` is unset; else
        heights are exaggerated, and the title says how much

    Raises InputError for spans that the line does not have.
    """

    def draw(ax: Axes, part: Stretch) -> None:
        _draw(ax, part, shape, to_scale)

    if to_scale and not spans:
        spans = evaluated_pair(catenary).spans
    return draw_line(catenary, draw, spans, ax, (11.0, 1.8 if to_scale else 4.4))


def _draw(ax: Axes, part: Stretch, shape: Shape | None, to_scale: bool) -> None:
    catenary = part.catenary
    lines = hanging_lines(shape, part) if shape else sketched_lines(catenary, part)
    contact = [line for line in lines if line.name == "contact wire"]
    low = min(float(line.z.min()) for line in contact) - _BELOW
    top = float(catenary.messenger_support_heights[part.supports].max())
    high = top + (0.1 if to_scale else 0.32) * (top - low)
    ax.set_ylim(low, high)
    room = part.end - part.start
    ax.set_xlim(part.start - 0.02 * room, part.end + 0.02 * room)
    mark_evaluated(ax, part)
    draw_lines(ax, lines, "z")
    _draw_droppers(ax, part, lines, upper_wires(catenary, shape))
    _draw_supports(ax, part, lines, low)
    scale = "to scale"
    if to_scale:
        ax.set_aspect("equal")
    else:
        _draw_dimensions(ax, part, lines, low)
        box = ax.get_window_extent()
        exaggeration = box.height / (high - low) / (box.width / (1.04 * room))
        scale = f"heights about {exaggeration:.0f} times exaggerated"
    where = "" if len(part.spans) == len(catenary.spans) else f", {part}"
    finish(
        ax, "position along the line (m)", "height above rail (m)", f"{catenary.name}: layout{where}, {scale}"
    )


def _draw_droppers(ax: Axes, part: Stretch, lines: list[Line], upper: np.ndarray) -> None:
    catenary = part.catenary
    shown = np.flatnonzero(part.inside(catenary.dropper_positions))
    x = catenary.dropper_positions[shown]
    below = [lines[catenary.dropper_contact_wires[i]].height(catenary.dropper_positions[i]) for i in shown]
    above = [lines[upper[i]].height(catenary.dropper_positions[i]) for i in shown]
    ax.vlines(x, below, above, color=DROPPER, linewidth=0.9 if part.is_close else 0.6, label="dropper")


def _draw_supports(ax: Axes, part: Stretch, lines: list[Line], low: float) -> None:
    """A line up to each messenger wire's support with the support's number, and the steady arms."""
    catenary, x = part.catenary, part.support_x
    tops = catenary.messenger_support_heights[part.supports]
    wire = lines[0].height(x)
    ax.vlines(x, low, tops, color=SUPPORT, linewidth=0.8, linestyle=":")
    ax.plot(x, tops, "v", color=SUPPORT, markersize=7 if part.is_close else 4, label="support")
    arms = [
        n
        for n, i in enumerate(part.supports)
        if catenary.supports[i].steady_arm and 0 < i < len(catenary.spans)
    ]
    if arms:
        ax.plot(
            x[arms],
            wire[arms],
            "o",
            color=SUPPORT,
            markersize=5 if part.is_close else 3,
            fillstyle="none",
            label="steady arm",
        )
    label_row(ax, x, tops, [str(i + 1) for i in part.supports], size=8, above=6)


def _draw_dimensions(ax: Axes, part: Stretch, lines: list[Line], low: float) -> None:
    x, spans = part.support_x, [part.catenary.spans[n - 1] for n in part.spans]
    middles = (x[:-1] + x[1:]) / 2
    if not part.is_close:
        label_row(ax, middles, low + 0.2, [f"{span.length:g} m" for span in spans], size=8)
        return
    for number, span, a, b in zip(part.spans, spans, x[:-1], x[1:], strict=True):
        _dimension(ax, (a, low + 0.2), (b, low + 0.2), f"span {number}: {span.length:g} m")
    at = part.catenary.dropper_positions
    stations = np.union1d(x, at[part.inside(at)])
    distances = [f"{round(b - a, 3):g}" for a, b in pairwise(stations)]
    if label_row(ax, (stations[:-1] + stations[1:]) / 2, low + 0.53, distances):
        ax.vlines(stations, low + 0.49, low + 0.59, color=DROPPER, linewidth=0.6)
    bottom, top = (
        float(lines[0].height(x[:1])[0]),
        float(part.catenary.messenger_support_heights[part.first - 1]),
    )
    at = x[0] + 0.006 * (part.end - part.start)
    _dimension(ax, (at, bottom), (at, top), f"system height {round(top - bottom, 3):g} m", vertical=True)


def _dimension(
    ax: Axes, start: tuple[float, float], end: tuple[float, float], text: str, vertical: bool = False
) -> None:
    ax.annotate("", start, end, arrowprops={"arrowstyle": "<->", "linewidth": 0.7, "color": "#333333"})
    middle = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    if vertical:
        ax.annotate(text, middle, (2, 0), textcoords="offset points", va="center", rotation=90, fontsize=8)
    else:
        ax.text(*middle, text, va="center", ha="center", fontsize=8, backgroundcolor="white")
