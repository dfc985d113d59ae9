"""Pictures of a catenary at rest: its static shape with the droppers' tensions, its elasticity."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.layout.arguments import checked
from catenary_fe.results import Elasticity
from catenary_fe.statics import Shape
from catenary_fe.views.stretch import Stretch, evaluated_pair, mark_detail, mark_evaluated, stretch
from catenary_fe.views.style import (
    CONTACT,
    DROPPER,
    MESSENGER,
    STITCH,
    finish,
    headroom,
    label_row,
    mark_supports,
    new_axes,
    new_panels,
    styled,
)

_LEFT = "#e6a07c"  # the left contact wire, of two


@checked
@styled
def plot_static_shape(shape: Shape, *, spans: Sequence[int] | None = None, ax: Axes | None = None) -> Axes:
    """Static height of the contact wire above its nominal height, and the dropper tensions below it.

    spans : numbers of the spans, from 1; unset: the whole line, and of a long one two spans closer
    ax : for the heights, with the tensions written at the droppers where there is room; unset: a new figure

    Returns the axes of the (whole line's) heights. Raises InputError for spans that the line does not have.
    """
    part = stretch(shape.catenary, spans)
    if ax is not None:
        return _heights(ax, shape, part)
    detail = None if spans or part.is_close else evaluated_pair(shape.catenary)
    rows = 3 if detail else 2
    whole, *others = new_panels((11.0, 2.9 * rows), [1] * rows)
    _tensions(others[0], shape, part)
    if detail:
        _heights(others[1], shape, detail)
    return _heights(whole, shape, part, detail)


def _heights(ax: Axes, shape: Shape, part: Stretch, detail: Stretch | None = None) -> Axes:
    catenary = shape.catenary
    nominal = catenary.contact_wire_height
    _frame(ax, part)
    names = ["contact wire"] if len(shape.contact_wires) == 1 else ["right contact wire", "left contact wire"]
    for wire, name, colour in zip(shape.contact_wires, names, (CONTACT, _LEFT), strict=False):
        x = part.sampled(wire.x)
        ax.plot(x, 1e3 * (wire.height(x) - nominal), color=colour, linewidth=1.4, label=name)
    chosen = part.inside(catenary.dropper_positions)
    x, design = catenary.dropper_positions[chosen], 1e3 * (catenary.design_heights[chosen] - nominal)
    size = 4 if part.is_close else 2
    ax.plot(x, design, "o", color=DROPPER, markersize=size, label="design height at the droppers")
    headroom(ax, 0.35)
    what = "static shape of the contact wire"
    if detail:
        mark_detail(ax, detail)
    else:
        texts = [f"{force:.0f} N" for force in shape.dropper_forces[chosen]]
        if label_row(ax, x, design + 1e3 * shape.height_errors[chosen], texts, above=5):
            what += ", dropper tensions"
    ax.legend(loc="upper left", fontsize=8, ncols=6, frameon=False)
    return finish(ax, "position along the line (m)", "height above nominal (mm)", _title(part, what))


def _tensions(ax: Axes, shape: Shape, part: Stretch) -> Axes:
    """Tension of each dropper, in the colour of the wire that it hangs on, or of two contact wires holds."""
    catenary = shape.catenary
    _frame(ax, part)
    chosen = part.inside(catenary.dropper_positions)
    x, forces = catenary.dropper_positions[chosen], shape.dropper_forces[chosen]
    for name, colour, of_kind in _kinds(shape):
        mine = of_kind[chosen]
        if mine.any():
            ax.vlines(x[mine], 0, forces[mine], color=colour, linewidth=1.6, label=name)
            ax.plot(x[mine], forces[mine], ".", color=colour, markersize=4)
    ax.set_ylim(0, 1.45 * forces.max(initial=1.0))
    label_row(ax, x, forces, [f"{force:.0f}" for force in forces], above=3)
    ax.legend(loc="upper left", fontsize=8, ncols=6, frameon=False)
    return finish(ax, "position along the line (m)", "dropper tension (N)", _title(part, "dropper tensions"))


def _kinds(shape: Shape) -> list[tuple[str, str, np.ndarray]]:
    """Name, colour and mask of the droppers of each kind."""
    mesh = shape.mesh
    if mesh.contact_wires > 1:
        right = mesh.lower.wire == 0
        return [("holds the right contact wire", CONTACT, right), ("holds the left one", _LEFT, ~right)]
    stitch = mesh.upper.wire >= mesh.first_stitch
    return [("on the messenger wire", MESSENGER, ~stitch), ("on a stitch wire", STITCH, stitch)]


def _frame(ax: Axes, part: Stretch) -> None:
    room = part.end - part.start
    ax.set_xlim(part.start - 0.02 * room, part.end + 0.02 * room)
    mark_evaluated(ax, part)
    mark_supports(ax, part.support_x)


def _title(part: Stretch, what: str) -> str:
    where = "" if len(part.spans) == len(part.catenary.spans) else f", {part}"
    return f"{part.catenary.name}: {what}{where}"


@styled
def plot_elasticity(elasticity: Elasticity, *, ax: Axes | None = None) -> Axes:
    """Elasticity along the line with its extremes; spans that were not computed leave a gap."""
    ax = new_axes(ax)
    x, e = elasticity.position, 1e3 * elasticity.values
    mark_supports(ax, elasticity.support_position)
    for number, piece in enumerate(_pieces(elasticity)):
        label = None if number else "elasticity"
        ax.plot(x[piece], e[piece], color=CONTACT, marker=".", markersize=4, linewidth=1.4, label=label)
    low, high = ax.get_xlim()
    for index, place in ((e.argmin(), -12), (e.argmax(), 6)):
        share = (x[index] - low) / (high - low)
        ax.annotate(
            f"{e[index]:.3f} mm/N at {x[index]:.1f} m",
            (x[index], e[index]),
            xytext=(0, place),
            textcoords="offset points",
            ha="left" if share < 0.1 else "right" if share > 0.9 else "center",
            fontsize=8,
        )
    ax.set_ylim(0, 1.2 * e.max())
    ax.legend(loc="lower right", fontsize=8)
    title = f"Elasticity under {elasticity.force:g} N, non-uniformity {100 * elasticity.non_uniformity:.1f} %"
    return finish(ax, "position along the line (m)", "elasticity (mm/N)", title)


def _pieces(elasticity: Elasticity) -> list[slice]:
    """Parts of the curve between which there is a span without any point inside it."""
    x, supports = elasticity.position, elasticity.support_position
    starts = {0}
    for a, b in pairwise(supports):
        after = int(np.searchsorted(x, a + 1e-6))
        if after < x.size and x[after] > b - 1e-6:
            starts.add(after)
    return [slice(a, b) for a, b in pairwise([*sorted(starts), x.size])]
