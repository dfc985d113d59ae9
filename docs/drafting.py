"""How the drawings of the reference pages are drawn: lines, dimensions, forces, springs."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Circle

from catenary_fe.views.style import SUPPORT

Point = tuple[float, float]
DIMENSION, FORCE, TRACK, NOTE, MAST = "#222222", "#b00020", "#999999", "#555555", "#999999"
CENTRE_LINE, CENTRE, DASHED = "#777777", (0, (8, 3, 2, 3)), (0, (6, 3))
THIN, SMALL, USUAL = 0.7, 8.0, 8.5  # width of a dimension line, sizes of letters


def new_axes(width: float, height: float, panels: int = 1, ratios: Sequence[float] = (1,)) -> list[Axes]:
    figure = Figure(figsize=(width, height), layout="constrained", facecolor="white")
    found = figure.subplots(1, panels, width_ratios=ratios, squeeze=False)[0]
    for ax in found:
        ax.set_axis_off()
        ax.set_aspect("equal")
    return list(found)


def line(ax: Axes, *points: Point, color: str = SUPPORT, width: float = 1.2, style: object = "-") -> None:
    x, y = zip(*points, strict=True)
    ax.plot(x, y, color=color, linewidth=width, linestyle=style, solid_capstyle="round")


def thin(ax: Axes, *points: Point, style: object = "-") -> None:
    """An extension line of a dimension."""
    line(ax, *points, color=DIMENSION, width=0.5, style=style)


def label(ax: Axes, at: Point, text: str, **options: object) -> None:
    style = {"ha": "center", "va": "center", "fontsize": USUAL} | options
    ax.text(*at, text, bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0}, **style)


def key(ax: Axes, at: Point, text: str, **options: object) -> None:
    """The name of a key, as it is typed."""
    label(ax, at, text, **({"family": "monospace", "fontsize": USUAL, "color": DIMENSION} | options))


def dimension(ax: Axes, a: Point, b: Point, text: str, place: Point | None = None, **options: object) -> None:
    """An arrow from a to b with the key's name, in its middle or at a place."""
    arrow = {"arrowstyle": "<|-|>", "linewidth": THIN, "color": DIMENSION, "mutation_scale": 8}
    ax.annotate("", xy=b, xytext=a, arrowprops=arrow | {"shrinkA": 0, "shrinkB": 0})
    key(ax, place or ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2), text, **options)


def force(ax: Axes, tail: Point, head: Point, text: str, place: Point, **options: object) -> None:
    arrow = {"arrowstyle": "-|>", "linewidth": 1.5, "color": FORCE, "mutation_scale": 11}
    ax.annotate("", xy=head, xytext=tail, arrowprops=arrow | {"shrinkA": 0, "shrinkB": 0})
    label(ax, place, text, **({"color": FORCE} | options))


def coordinate_axis(ax: Axes, origin: Point, head: Point, name: str, away: float = 0.18) -> None:
    arrow = {"arrowstyle": "->", "linewidth": 1.0, "color": "black", "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", xy=head, xytext=origin, arrowprops=arrow)
    d = np.subtract(head, origin)
    ax.text(*(np.array(head) + away * d / np.linalg.norm(d)), name, ha="center", va="center", style="italic")


def into_page(ax: Axes, at: Point, radius: float) -> None:
    ax.add_patch(Circle(at, radius, fill=False, linewidth=1.0))
    d = radius * np.sqrt(0.5)
    for s in (-1, 1):
        line(ax, (at[0] - d, at[1] - s * d), (at[0] + d, at[1] + s * d), color="black", width=1.0)


def wire_seen_along(ax: Axes, at: Point, color: str, radius: float = 0.05) -> None:
    ax.add_patch(Circle(at, radius, color=color, zorder=5))


def spring(ax: Axes, a: Point, b: Point, turns: int = 5, width: float = 0.1) -> None:
    """A zigzag from a to b with straight ends."""
    a_, b_ = np.array(a), np.array(b)
    along = b_ - a_
    across = np.array([-along[1], along[0]]) / np.linalg.norm(along)
    s = np.concatenate([[0.0], np.linspace(0.2, 0.8, 2 * turns + 1), [1.0]])
    side = np.concatenate([[0.0, 0.0], np.tile([1.0, -1.0], turns)[: 2 * turns - 1], [0.0, 0.0]])
    points = a_ + s[:, None] * along + width * side[:, None] * across
    ax.plot(*points.T, color=SUPPORT, linewidth=1.1)


def damper(ax: Axes, a: Point, b: Point, width: float = 0.1) -> None:
    """An upright dashpot from a up to b."""
    (x, low), (_, high) = a, b
    middle, half = (low + high) / 2, 0.16 * (high - low)
    line(ax, (x, low), (x, middle - half), width=1.1)
    line(ax, (x - width, middle + half), (x - width, middle - half), (x + width, middle - half),
          (x + width, middle + half), width=1.1)  # fmt: skip
    line(ax, (x - 0.8 * width, middle), (x + 0.8 * width, middle), width=1.1)
    line(ax, (x, middle), (x, high), width=1.1)


def ground(ax: Axes, left: Point, right: Point, below: bool = True) -> None:
    line(ax, left, right, width=1.2)
    step, d = 0.09, -0.07 if below else 0.07
    for x in np.arange(left[0], right[0] - 0.01, step):
        line(ax, (x, left[1] + d), (x + 0.07, left[1]), width=0.6)
