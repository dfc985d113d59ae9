"""Picture of a catenary from above: stagger, steady arms, curves."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.layout import AnyPantograph, Panhead, arguments
from catenary_fe.layout.arguments import checked
from catenary_fe.statics import Shape
from catenary_fe.views.lines import draw_lines, hanging_lines
from catenary_fe.views.stretch import Stretch, draw_line, mark_evaluated
from catenary_fe.views.style import (
    DROPPER,
    SUPPORT,
    finish,
    label_row,
    mark_supports,
    rotation_that_fits,
    styled,
)

_CURVE = "#7b4fa3"
_HEAD = "#dfe7ec"


@checked
@styled
def plot_plan(
    shape: Shape, *, spans: Sequence[int] | None = None, head_width: float = 1.2, ax: Axes | None = None
) -> Axes:
    """Draw all wires from above, y to the left of the track's centre, with curves, steady arms, their pull.

    spans : numbers of the spans, from 1; unset: the whole line, and of a long one two spans closer below it
    head_width : [m] of the panhead's working part, drawn as a band

    Raises InputError for spans that the line does not have.
    """
    arguments.number("head_width", head_width, "m", above=0.0)

    def draw(ax: Axes, part: Stretch) -> None:
        _draw(ax, part, shape, head_width)

    curved = [n for n, span in enumerate(shape.catenary.spans, start=1) if span.curve_radius]
    return draw_line(shape.catenary, draw, spans, ax, (11.0, 4.2), curved)


def head_width(pantographs: Iterable[AnyPantograph]) -> float:
    """[m] of the working part of the first head that is described; else of the usual one."""
    heads = (p.head for p in pantographs if p.head)
    return next(heads, Panhead()).width


def _draw(ax: Axes, part: Stretch, shape: Shape, width: float) -> None:
    catenary = part.catenary
    room = part.end - part.start
    ax.set_xlim(part.start - 0.02 * room, part.end + 0.02 * room)
    mark_evaluated(ax, part)
    ax.axhspan(-width / 2, width / 2, color=_HEAD, alpha=0.7, zorder=0.5, label=f"panhead, {width:g} m")
    ax.axhline(0.0, color=SUPPORT, linewidth=0.7, linestyle="-.", label="track centre")
    draw_lines(ax, hanging_lines(shape, part), "y")
    _draw_droppers(ax, part, shape)
    _draw_arms(ax, part, shape)
    mark_supports(ax, part.support_x, label=False)
    low, high = ax.get_ylim()
    ax.set_ylim(low - 0.25 * (high - low), high + 0.3 * (high - low))
    above = high + 0.08 * (high - low)
    label_row(ax, part.support_x, above, [str(i + 1) for i in part.supports], size=8, above=1)
    _draw_curves(ax, part)
    where = "" if len(part.spans) == len(catenary.spans) else f", {part}"
    title = f"{catenary.name}: plan{where}, {_curve(part)}; sideways much exaggerated"
    finish(ax, "position along the track (m)", "to the left of the track (m)", title)


def _curves(part: Stretch) -> list[tuple[float, int, int]]:
    """Radius, first and last span of each run of spans that curve alike."""
    groups = groupby(part.spans, key=lambda n: part.catenary.spans[n - 1].curve_radius or 0.0)
    found = [(radius, list(numbers)) for radius, numbers in groups]
    return [(radius, numbers[0], numbers[-1]) for radius, numbers in found if radius]


def _curve(part: Stretch) -> str:
    curves = _curves(part)
    if not curves:
        return "straight track"
    if len(curves) > 2:
        radii = [abs(radius) for radius, _, _ in curves]
        return f"{len(curves)} curves, radii {min(radii):g} to {max(radii):g} m"
    said = []
    for radius, first, last in curves:
        where = Stretch(part.catenary, first, last)
        here = "" if where == part else f", in {where}"
        said.append(f"curve to the {'left' if radius > 0 else 'right'}, radius {abs(radius):g} m{here}")
    return " and ".join(said)


def _draw_curves(ax: Axes, part: Stretch) -> None:
    """A bar along the bottom under each curve."""
    supports, axes = part.catenary.support_positions, ax.get_xaxis_transform()
    for number, (radius, first, last) in enumerate(_curves(part)):
        ends = supports[first - 1], supports[last]
        ax.plot(ends, (0.1, 0.1), color=_CURVE, linewidth=3.0, solid_capstyle="butt", transform=axes,
                label=None if number else "curve")  # fmt: skip
        side = "left" if radius > 0 else "right"
        if (ends[1] - ends[0]) > 0.08 * (part.end - part.start):
            text = f"{side}, R {abs(radius):g} m"
            box = {"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.8}
            ax.text(
                sum(ends) / 2, 0.025, text, transform=axes, ha="center", fontsize=8, color=_CURVE, bbox=box
            )


def _draw_droppers(ax: Axes, part: Stretch, shape: Shape) -> None:
    mesh = shape.mesh
    points = np.concatenate([np.column_stack([w.x, w.y]) for w in shape.wires])
    shown = part.inside(shape.catenary.dropper_positions)
    ends = points[mesh.nodes(mesh.lower)][shown], points[mesh.nodes(mesh.upper)][shown]
    gap = np.full(ends[0].shape, np.nan)
    x, y = np.stack([*ends, gap], axis=1).reshape(-1, 2).T
    ax.plot(x, y, color=DROPPER, linewidth=0.7)


def _draw_arms(ax: Axes, part: Stretch, shape: Shape) -> None:
    """Arms as long as they are, seen from above, with the force that they hold sideways."""
    forces, catenary = shape.installation.arm_forces, shape.catenary
    ends: list[tuple[float, float]] = []
    texts = []
    for i in part.supports:
        arm = catenary.supports[i].steady_arm
        if arm is None or i in (0, len(catenary.spans)):
            continue
        for wire, (stations, force) in enumerate(zip(shape.mesh.wires, forces[:, i], strict=False)):
            hanging, node = shape.wires[wire], stations.supports[i]
            x, y = hanging.x[node], hanging.y[node]
            reach = arm.length * force[0] / np.linalg.norm(force) if arm.length else 0.15
            ax.plot([x, x], [y, y + reach], color=SUPPORT, linewidth=2.2, solid_capstyle="round")
            ax.plot(x, y + reach, marker="s", color=SUPPORT, markersize=4)
            if wire == 0:
                ends.append((x, y + reach))
        texts.append(" + ".join(f"{abs(force[0]):.0f}" for force in forces[:, i]) + " N")
    _name_forces(ax, ends, texts)


def _name_forces(ax: Axes, ends: Sequence[tuple[float, float]], texts: Sequence[str]) -> None:
    """Beside the arms' ends, upright where there is little room, to the left of the last one."""
    rotation = rotation_that_fits(ax, [x for x, _ in ends], texts, 8)
    if rotation is None:
        return
    for number, (place, text) in enumerate(zip(ends, texts, strict=True), start=1):
        last = number == len(ends)
        ax.annotate(
            text,
            place,
            xytext=(-6 if last else 6, 0),
            textcoords="offset points",
            ha="right" if last else "left",
            va="center",
            rotation=rotation,
            fontsize=8,
        )
