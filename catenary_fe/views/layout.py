"""Pictures of a catenary at rest: its layout with dimensions, its static shape, its elasticity."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.equilibrium import Shape
from catenary_fe.results import Elasticity
from catenary_fe.system import GRAVITY, Catenary
from catenary_fe.views.style import (
    CONTACT,
    DROPPER,
    MESSENGER,
    STITCH,
    SUPPORT,
    finish,
    headroom,
    mark_supports,
    new_axes,
    styled,
)

Floats = NDArray[np.float64]


@styled
def plot_layout(
    catenary: Catenary,
    shape: Shape | None = None,
    *,
    spans: Sequence[int] | None = None,
    to_scale: bool = False,
    ax: Axes | None = None,
) -> Axes:
    """Draw wires, droppers and supports of some spans with their dimensions.

    shape : where it is known, the wires are drawn as they hang; else the messenger wire as a parabola
    spans : numbers of the spans, from 1; unset: the first two
    to_scale : the same scale along and up; else heights are exaggerated, and the title says how much
    """
    spans = spans or range(1, min(2, len(catenary.spans)) + 1)
    supports = catenary.support_positions
    start, end = supports[min(spans) - 1], supports[max(spans)]
    room = end - start
    ax = new_axes(ax, (11.0, 1.8 if to_scale else 4.6))
    lines = hanging_lines(shape) if shape else _sketched_lines(catenary)
    named: set[str] = set()
    for line in reversed(lines):
        inside = (line.x >= start - 1e-6) & (line.x <= end + 1e-6)
        if inside.any():
            label = line.name if line.name not in named else None
            ax.plot(line.x[inside], line.z[inside], color=line.colour, linewidth=line.width, label=label)
            named.add(line.name)
    for i, x in enumerate(catenary.dropper_positions):
        if start < x < end:
            hung = lines[_hung_on(catenary, i)]
            below = lines[catenary.dropper_contact_wires[i]]
            heights = np.interp(x, below.x, below.z), np.interp(x, hung.x, hung.z)
            ax.plot([x, x], heights, color=DROPPER, linewidth=0.9)
    _draw_supports(ax, catenary, range(min(spans) - 1, max(spans) + 1))
    if not to_scale:
        _draw_dimensions(ax, catenary, spans)
    low = catenary.contact_wire_height - 0.75
    high = catenary.messenger_support_heights[min(spans) - 1 : max(spans) + 1].max() + 0.4
    ax.set_ylim(low, high)
    ax.set_xlim(start - 0.02 * room, end + 0.02 * room)
    scale = "to scale"
    if to_scale:
        ax.set_aspect("equal")
    else:
        width, height = ax.get_figure(root=True).get_size_inches()  # type: ignore[union-attr]
        exaggeration = (room / (0.88 * width)) / ((high - low) / (0.75 * height))
        scale = f"heights about {exaggeration:.0f} times exaggerated"
        ax.legend(loc="upper center", ncols=4, fontsize=8, frameon=False)
    return finish(
        ax, "position along the line (m)", "height above rail (m)", f"{catenary.name}: layout, {scale}"
    )


@dataclass(frozen=True)
class Line:
    """A wire as it is drawn: coordinates [m] of shape (points,), colour and line width, name."""

    x: Floats
    y: Floats
    z: Floats
    colour: str
    width: float
    name: str


def hanging_lines(shape: Shape) -> list[Line]:
    """All wires as they hang, in the order of the mesh."""
    return [
        Line(wire.x, wire.y, wire.z, *style)
        for wire, style in zip(shape.wires, _styles(shape.catenary), strict=True)
    ]


def _styles(catenary: Catenary) -> list[tuple[str, float, str]]:
    """Colour, line width and name of each wire, in the order of the mesh."""
    contact = [(CONTACT, 1.6, "contact wire")] * len(catenary.contact_wire_offsets)
    stitch = [(STITCH, 1.2, "stitch wire")] * len(catenary.stitched_supports)
    return [*contact, (MESSENGER, 1.6, "messenger wire"), *stitch]


def _hung_on(catenary: Catenary, dropper: int) -> int:
    """Number of the wire that a dropper hangs on, in the order of the mesh."""
    messenger = len(catenary.contact_wire_offsets)
    if catenary.stitch_wire:
        middles = catenary.support_positions[list(catenary.stitched_supports)]
        near = np.abs(middles - catenary.dropper_positions[dropper]) < catenary.stitch_wire.length / 2
        if near.any():
            return messenger + 1 + int(np.flatnonzero(near)[0])
    return messenger


def _sketched_lines(catenary: Catenary) -> list[Line]:
    """Contact wires at design heights, messenger wire as parabolas, stitch wires straight."""
    supports, heights = catenary.support_positions, catenary.messenger_support_heights
    x = np.concatenate([supports, catenary.dropper_positions])
    nominal = np.full(supports.size, catenary.contact_wire_height)
    z = np.concatenate([nominal, catenary.design_heights])
    order = np.argsort(x)
    contact_wires = len(catenary.contact_wire_offsets)
    mass = contact_wires * catenary.contact_wire.mass_per_length + catenary.messenger_wire.mass_per_length
    along = np.unique(np.concatenate([np.linspace(0, catenary.length, 60 * len(catenary.spans)), supports]))
    span = np.clip(np.searchsorted(supports, along, side="right") - 1, 0, len(catenary.spans) - 1)
    a, b = supports[span], supports[span + 1]
    sag = GRAVITY * mass * (along - a) * (b - along) / (2 * catenary.messenger_wire.tension)
    messenger = along, np.interp(along, supports, heights) - sag
    points = [(x[order], z[order])] * contact_wires + [messenger]
    if catenary.stitch_wire:
        for middle in supports[list(catenary.stitched_supports)]:
            ends = middle + catenary.stitch_wire.length / 2 * np.array([-1.0, 1.0])
            points.append((ends, np.interp(ends, *messenger)))
    return [
        Line(x, np.zeros_like(x), z, *style) for (x, z), style in zip(points, _styles(catenary), strict=True)
    ]


def _draw_supports(ax: Axes, catenary: Catenary, numbers: Sequence[int] | range) -> None:
    for n, i in enumerate(numbers):
        x = catenary.support_positions[i]
        top, bottom = catenary.messenger_support_heights[i], catenary.contact_wire_height
        ax.plot([x, x], [bottom - 0.75, top], color=SUPPORT, linewidth=0.8, linestyle=":")
        ax.plot(x, top, marker="v", color=SUPPORT, markersize=7, label="support" if n == 0 else None)
        if catenary.supports[i].steady_arm and 0 < i < len(catenary.spans):
            label = None if "steady arm" in ax.get_legend_handles_labels()[1] else "steady arm"
            ax.plot(
                x, bottom, "o", color=SUPPORT, markersize=5, fillstyle="none", linestyle="none", label=label
            )


def _draw_dimensions(ax: Axes, catenary: Catenary, spans: Sequence[int]) -> None:
    supports, nominal = catenary.support_positions, catenary.contact_wire_height
    for number in spans:
        a, b = supports[number - 1], supports[number]
        _dimension(ax, (a, nominal - 0.55), (b, nominal - 0.55), f"span {number}: {b - a:g} m")
        stations = [a, *(a + d.position for d in catenary.spans[number - 1].droppers), b]
        for left, right in pairwise(stations):
            ax.plot([left, left], [nominal - 0.26, nominal - 0.16], color=DROPPER, linewidth=0.6)
            ax.text(
                (left + right) / 2, nominal - 0.22, f"{right - left:g}", ha="center", va="center", fontsize=7
            )
        ax.plot([b, b], [nominal - 0.26, nominal - 0.16], color=DROPPER, linewidth=0.6)
    x = supports[min(spans) - 1] + 0.012 * (supports[max(spans)] - supports[min(spans) - 1])
    top = catenary.messenger_support_heights[min(spans) - 1]
    _dimension(ax, (x, nominal), (x, top), f"system height {top - nominal:g} m", vertical=True)


def _dimension(
    ax: Axes, start: tuple[float, float], end: tuple[float, float], text: str, vertical: bool = False
) -> None:
    ax.annotate("", start, end, arrowprops={"arrowstyle": "<->", "linewidth": 0.7, "color": "#333333"})
    middle = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    if vertical:
        box = {"facecolor": "white", "edgecolor": "none", "pad": 1.5}
        ax.annotate(text, middle, (5, 0), textcoords="offset points", va="center", fontsize=8, bbox=box)
    else:
        ax.text(*middle, text, va="center", ha="center", fontsize=8, backgroundcolor="white")


@styled
def plot_static_shape(shape: Shape, *, spans: Sequence[int] | None = None, ax: Axes | None = None) -> Axes:
    """Static height of the contact wire above its nominal height, and the dropper tensions.

    spans : numbers of the spans, from 1; unset: the evaluated ones
    """
    catenary = shape.catenary
    spans = spans or catenary.spans_to_evaluate
    start, end = catenary.support_positions[min(spans) - 1], catenary.support_positions[max(spans)]
    ax = new_axes(ax)
    nodes = shape.contact_wire_x
    inside = nodes[(nodes > start) & (nodes < end)]
    x = np.union1d(np.linspace(start, end, 80 * len(spans) + 1), inside)  # the nodes hold the kinks
    z = 1e3 * (shape.contact_wire_height(x) - catenary.contact_wire_height)
    mark_supports(ax, catenary.support_positions[min(spans) - 1 : max(spans) + 1])
    ax.plot(x, z, color=CONTACT, linewidth=1.6, label="contact wire")
    at = catenary.dropper_positions
    chosen = (at > start) & (at < end)
    ax.plot(
        at[chosen],
        1e3 * (catenary.design_heights[chosen] - catenary.contact_wire_height),
        "o",
        color=DROPPER,
        markersize=4,
        label="design height at the droppers",
    )
    for position, height, force in zip(
        at[chosen], 1e3 * shape.height_errors[chosen], shape.dropper_forces[chosen], strict=True
    ):
        design = 1e3 * (np.interp(position, at, catenary.design_heights) - catenary.contact_wire_height)
        ax.annotate(
            f"{force:.0f} N",
            (position, design + height),
            xytext=(0, 7),
            textcoords="offset points",
            ha="center",
            fontsize=7,
        )
    headroom(ax, 0.35)
    ax.legend(loc="upper left", fontsize=8, ncols=3, frameon=False)
    title = f"{catenary.name}: static shape of the contact wire, dropper tensions"
    return finish(ax, "position along the line (m)", "height above nominal (mm)", title)


@styled
def plot_elasticity(elasticity: Elasticity, *, ax: Axes | None = None) -> Axes:
    """Elasticity along the line with its extremes."""
    ax = new_axes(ax)
    x, e = elasticity.position, 1e6 * elasticity.values / 1e3
    mark_supports(ax, elasticity.support_position)
    ax.plot(x, e, color=CONTACT, marker=".", markersize=4, linewidth=1.4, label="elasticity")
    for index, place in ((e.argmin(), -12), (e.argmax(), 6)):
        ax.annotate(
            f"{e[index]:.3f} mm/N at {x[index]:g} m",
            (x[index], e[index]),
            xytext=(0, place),
            textcoords="offset points",
            ha="center",
            fontsize=8,
        )
    ax.set_ylim(0, 1.2 * e.max())
    ax.legend(loc="lower right", fontsize=8)
    title = f"Elasticity under {elasticity.force:g} N, non-uniformity {100 * elasticity.non_uniformity:.1f} %"
    return finish(ax, "position along the line (m)", "elasticity (mm/N)", title)
