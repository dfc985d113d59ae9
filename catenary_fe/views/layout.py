"""Pictures of a layout: from the side with its dimensions, from above with stagger and curves."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby, pairwise

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.layout import AnyPantograph, Catenary, Panhead
from catenary_fe.layout.arguments import checked, number
from catenary_fe.layout.terminations import midpoint_place, wires_with_ends
from catenary_fe.statics import LineShape, Shape
from catenary_fe.views import stretch, style

_BELOW = 0.75  # [m] of room under the contact wire, for dimensions
_CURVE = "#7b4fa3"
_SAME_PLACE = 0.02  # [m]
_HEAD = "#dfe7ec"


@checked
@style.styled
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

    def draw(ax: Axes, part: stretch.Stretch) -> None:
        _draw(ax, part, shape, to_scale)

    if to_scale and not spans:
        spans = stretch.evaluated_pair(catenary).spans
    return stretch.draw_line(
        catenary, draw, spans, ax, (11.0, 1.8 if to_scale else 4.4), stretch.overlap_spans(catenary)
    )


def _draw(ax: Axes, part: stretch.Stretch, shape: Shape | None, to_scale: bool) -> None:
    catenary = part.catenary
    lines = stretch.hanging_lines(shape, part) if shape else stretch.sketched_lines(catenary, part)
    contact = [line for line in lines if line.name == "contact wire"]
    low = min(float(line.z.min()) for line in contact if line.z.size) - _BELOW
    top = float(catenary.messenger_support_heights[part.supports].max())
    top = max([top, *(float(line.z.max()) for line in lines if line.z.size)])
    high = top + (0.1 if to_scale else 0.32) * (top - low)
    ax.set_ylim(low, high)
    stretch.frame(ax, part)
    stretch.draw_lines(ax, lines, "z")
    _draw_droppers(ax, part, lines, stretch.upper_wires(catenary, shape))
    _draw_supports(ax, part, lines, low)
    _draw_equipment(ax, part, lines)
    _draw_ends(ax, part)
    scale = "to scale"
    if to_scale:
        ax.set_aspect("equal")
    else:
        _draw_dimensions(ax, part, lines, low)
        box = ax.get_window_extent()
        exaggeration = box.height / (high - low) / (box.width / (1.04 * (part.end - part.start)))
        scale = f"heights about {exaggeration:.0f} times exaggerated"
    style.finish(ax, style.ALONG, "height above rail (m)", f"{catenary.name}: layout{part.where}, {scale}")


def _draw_droppers(ax: Axes, part: stretch.Stretch, lines: list[stretch.Line], upper: np.ndarray) -> None:
    catenary = part.catenary
    shown = np.flatnonzero(part.inside(catenary.dropper_positions))
    x, low = catenary.dropper_positions[shown], catenary.lower_clamp_positions[shown]
    below = [
        lines[catenary.dropper_contact_wires[i]].height(catenary.lower_clamp_positions[i]) for i in shown
    ]
    above = [lines[upper[i]].height(catenary.dropper_positions[i]) for i in shown]
    width = 0.9 if part.is_close else 0.6
    slid = np.flatnonzero(low != x)
    ax.vlines(x[low == x], np.array(below)[low == x], np.array(above)[low == x], color=style.DROPPER,
              linewidth=width, label="dropper")  # fmt: skip
    for i in slid:
        ax.plot((low[i], x[i]), (below[i], above[i]), color=style.DROPPER, linewidth=width)


def _draw_supports(ax: Axes, part: stretch.Stretch, lines: list[stretch.Line], low: float) -> None:
    """A line up to each messenger wire's support with the support's number, and the steady arms."""
    catenary, x = part.catenary, part.support_x
    tops = catenary.messenger_support_heights[part.supports]
    wire = stretch.served_height(lines, x)
    ax.vlines(x, low, tops, color=style.SUPPORT, linewidth=0.8, linestyle=":")
    ax.plot(x, tops, "v", color=style.SUPPORT, markersize=7 if part.is_close else 4, label="support")
    inner = range(1, len(catenary.spans))
    arms = [n for n, i in enumerate(part.supports) if i in inner and catenary.supports[i].steady_arm]
    if arms:
        at, size = (x[arms], wire[arms]), 5 if part.is_close else 3
        ax.plot(*at, "o", color=style.SUPPORT, markersize=size, fillstyle="none", label="steady arm")
    above = max(float(tops.max()), *(float(line.z.max()) for line in lines if line.z.size))
    room = 0.03 * np.ptp(ax.get_ylim())
    style.number_row(ax, x, above + room, [i + 1 for i in part.supports])


def _draw_equipment(ax: Axes, part: stretch.Stretch, lines: list[stretch.Line]) -> None:
    """Equipment over its length on its wire, with its name in a close drawing."""
    catenary = part.catenary
    label: str | None = "equipment"
    for item in catenary.equipment:
        middle = item.middle(catenary)
        if not part.inside(np.array([middle]))[0]:
            continue
        there = [w for w in lines if w.name == item.wire and w.x.size and w.x[0] <= middle <= w.x[-1]]
        wire = min(there, key=lambda w: float(w.height(np.array(middle))))
        x = np.linspace(*item.ends(catenary), 9)
        ax.plot(x, wire.height(x), color=style.SUPPORT, linewidth=5, solid_capstyle="round", label=label)
        label = None
        if part.is_close and item.name:
            place = (middle, float(wire.height(x)[4]))
            style.annotate(ax, item.name, place, (0, -6), ha="center", va="top")


_ENDS = {  # marker, and whether it is filled
    "fixed end": ("s", "full"), "end on weights": ("s", "none"), "end on a spring": ("D", "none"),
    "midpoint anchor": ("X", "full"),
}  # fmt: skip


def _draw_ends(ax: Axes, part: stretch.Stretch) -> None:
    """Where wires are held and tensioned along the track, each kind named once."""
    found: dict[str, list[tuple[float, float]]] = {}
    kinds = {"fixed": "fixed end", "weights": "end on weights", "spring": "end on a spring"}
    for _, section, begin in stretch.sections_of(part.catenary):
        supports = section.support_positions
        heights = {
            "contact_wire": section.contact_wire_heights,
            "messenger_wire": section.messenger_support_heights,
        }
        for wire in wires_with_ends(section):
            for i, end in ((0, section.begin.of(wire)), (-1, section.end.of(wire))):
                at = begin + float(supports[i]), float(heights[wire][i])
                found.setdefault(kinds[end.kind], []).append(at)
            place = midpoint_place(section, wire)
            if place is not None:
                at = begin + place, float(np.interp(place, supports, heights[wire]))
                found.setdefault("midpoint anchor", []).append(at)
    for kind, (marker, fill) in _ENDS.items():
        shown = [at for at in found.get(kind, ()) if part.start <= at[0] <= part.end]
        if shown:
            x, z = zip(*shown, strict=True)
            ax.plot(x, z, marker, color=style.SUPPORT, markersize=5, fillstyle=fill, label=kind)


def _draw_dimensions(ax: Axes, part: stretch.Stretch, lines: list[stretch.Line], low: float) -> None:
    x, spans = part.support_x, [part.catenary.spans[n - 1] for n in part.spans]
    if not part.is_close:
        _span_lengths(ax, x, low + 0.2, [span.length for span in spans])
        return
    for n, span, a, b in zip(part.spans, spans, x[:-1], x[1:], strict=True):
        _dimension(ax, (a, low + 0.2), (b, low + 0.2), f"span {n}: {span.length:g} m")
    at = part.catenary.dropper_positions
    stations = np.union1d(x, at[part.inside(at)])
    stations = stations[np.diff(stations, prepend=-np.inf) > _SAME_PLACE]  # of two lines in an overlap
    distances = [f"{round(b - a, 3):g}" for a, b in pairwise(stations)]
    if style.label_row(ax, (stations[:-1] + stations[1:]) / 2, low + 0.53, distances):
        ax.vlines(stations, low + 0.49, low + 0.59, color=style.DROPPER, linewidth=0.6)
    if part.catenary.messenger_wire is None:
        return
    bottom, top = (
        stretch.served_height(lines, x[:1])[0],
        part.catenary.messenger_support_heights[part.first - 1],
    )
    at = x[0] + 0.006 * (part.end - part.start)
    _dimension(ax, (at, bottom), (at, top), f"system height {round(top - bottom, 3):g} m", vertical=True)


def _span_lengths(ax: Axes, x: np.ndarray, z: float, lengths: Sequence[float]) -> None:
    """The length of each span; where there is no room, of each run of equal spans, with their number."""
    texts = [f"{length:g} m" for length in lengths]
    middles = (x[:-1] + x[1:]) / 2
    if style.rotation_that_fits(ax, middles, texts, 8) == 0:
        style.label_row(ax, middles, z, texts, size=8)
        return
    groups = [list(numbers) for _, numbers in groupby(range(len(lengths)), key=lambda i: texts[i])]
    ends = [(float(x[group[0]]), float(x[group[-1] + 1])) for group in groups]
    texts = [f"{len(group)} × {texts[group[0]]}" if len(group) > 1 else texts[group[0]] for group in groups]
    if style.rotation_that_fits(ax, [sum(pair) / 2 for pair in ends], texts, 8) == 0:
        for (a, b), text in zip(ends, texts, strict=True):
            _dimension(ax, (a, z), (b, z), text)


def _dimension(
    ax: Axes, start: tuple[float, float], end: tuple[float, float], text: str, vertical: bool = False
) -> None:
    ax.annotate("", start, end, arrowprops={"arrowstyle": "<->", "linewidth": 0.7, "color": "#333333"})
    middle = (start[0] + end[0]) / 2, (start[1] + end[1]) / 2
    if vertical:
        style.annotate(ax, text, middle, (2, 0), va="center", rotation=90)
    else:
        ax.text(*middle, text, va="center", ha="center", fontsize=8, backgroundcolor="white")


@checked
@style.styled
def plot_plan(
    shape: Shape, *, spans: Sequence[int] | None = None, head_width: float = 1.2, ax: Axes | None = None
) -> Axes:
    """Draw all wires from above, y to the left of the track's centre, with curves, steady arms, their pull.

    spans : numbers of the spans, from 1; unset: the whole line, and of a long one two spans closer below it
    head_width : [m] of the panhead's working part, drawn as a band

    Raises InputError for spans that the line does not have.
    """
    number("head_width", head_width, "m", above=0.0)

    def draw(ax: Axes, part: stretch.Stretch) -> None:
        _draw_plan(ax, part, shape, head_width)

    curved = [n for n, span in enumerate(shape.catenary.spans, start=1) if any(span.curvatures)]
    among = stretch.overlap_spans(shape.catenary) or curved
    return stretch.draw_line(shape.catenary, draw, spans, ax, (11.0, 4.2), among)


def head_width(pantographs: Iterable[AnyPantograph]) -> float:
    """[m] of the working part of the first head that is described; else of the usual one."""
    heads = (p.head for p in pantographs if p.head)
    return next(heads, Panhead()).width


def _draw_plan(ax: Axes, part: stretch.Stretch, shape: Shape, width: float) -> None:
    catenary = part.catenary
    stretch.frame(ax, part)
    ax.axhspan(-width / 2, width / 2, color=_HEAD, alpha=0.7, zorder=0.5, label=f"panhead, {width:g} m")
    ax.axhline(0.0, color=style.SUPPORT, linewidth=0.7, linestyle="-.", label="track centre")
    stretch.draw_lines(ax, stretch.hanging_lines(shape, part), "y")
    _droppers_from_above(ax, part, shape)
    _draw_arms(ax, part, shape)
    style.mark_supports(ax, part.support_x, label=False)
    low, high = ax.get_ylim()
    ax.set_ylim(low - 0.25 * (high - low), high + 0.3 * (high - low))
    above = high + 0.08 * (high - low)
    style.number_row(ax, part.support_x, above, [i + 1 for i in part.supports])
    _draw_curves(ax, part)
    title = f"{catenary.name}: plan{part.where}, {_curve(part)}; lateral positions much exaggerated"
    style.finish(ax, "position along the track (m)", "to the left of the track (m)", title)


def _curves(part: stretch.Stretch) -> list[tuple[tuple[float, ...], int, int]]:
    """Radii (0: straight), first and last span of each run of spans that curve alike.

    One radius of a circular curve, two of a transition.
    """
    groups = groupby(part.spans, key=lambda n: part.catenary.spans[n - 1].curvatures)
    found = [(curvatures, list(numbers)) for curvatures, numbers in groups if any(curvatures)]
    return [(_radii(*curvatures), numbers[0], numbers[-1]) for curvatures, numbers in found]


def _radii(begin: float, end: float) -> tuple[float, ...]:
    radii = (1 / begin if begin else 0.0, 1 / end if end else 0.0)
    return radii[:1] if begin == end else radii


def _side(radii: tuple[float, ...]) -> str:
    sides = dict.fromkeys("left" if radius > 0 else "right" for radius in radii if radius)
    return " then ".join(sides)


def _radius(radii: tuple[float, ...]) -> str:
    return " to ".join(f"{abs(radius):g}" if radius else "∞" for radius in radii)


def _curve(part: stretch.Stretch) -> str:
    curves = _curves(part)
    if not curves:
        return "straight track"
    if len(curves) > 2:
        known = [abs(radius) for radii, _, _ in curves for radius in radii if radius]
        return f"{len(curves)} curves, radii {min(known):g} to {max(known):g} m"
    said = []
    for radii, first, last in curves:
        where = stretch.Stretch(part.catenary, first, last)
        here = "" if where == part else f", in {where}"
        said.append(f"curve to the {_side(radii)}, radius {_radius(radii)} m{here}")
    return " and ".join(said)


def _draw_curves(ax: Axes, part: stretch.Stretch) -> None:
    """A bar along the bottom under each curve."""
    supports, axes = part.catenary.support_positions, ax.get_xaxis_transform()
    for i, (radii, first, last) in enumerate(_curves(part)):
        ends = supports[first - 1], supports[last]
        ax.plot(ends, (0.1, 0.1), color=_CURVE, linewidth=3.0, solid_capstyle="butt", transform=axes,
                label=None if i else "curve")  # fmt: skip
        if (ends[1] - ends[0]) > 0.08 * (part.end - part.start):
            text = f"{_side(radii)}, R {_radius(radii)} m"
            box = {"facecolor": "white", "edgecolor": "none", "pad": 1.0, "alpha": 0.8}
            ax.text(
                sum(ends) / 2, 0.025, text, transform=axes, ha="center", fontsize=8, color=_CURVE, bbox=box
            )


def _droppers_from_above(ax: Axes, part: stretch.Stretch, shape: Shape) -> None:
    mesh = shape.mesh
    points = np.concatenate([np.column_stack([w.x, w.y]) for w in shape.wires])
    shown = part.inside(shape.catenary.dropper_positions)
    ends = points[mesh.nodes(mesh.lower)][shown], points[mesh.nodes(mesh.upper)][shown]
    gap = np.full(ends[0].shape, np.nan)
    x, y = np.stack([*ends, gap], axis=1).reshape(-1, 2).T
    ax.plot(x, y, color=style.DROPPER, linewidth=0.7)


def _draw_arms(ax: Axes, part: stretch.Stretch, shape: Shape) -> None:
    """Arms at their length, seen from above, with the lateral force that they take."""
    ends: list[tuple[float, float]] = []
    texts: list[str] = []
    parts = shape.sections if isinstance(shape, LineShape) else (shape,)
    for section, (_, _, begin) in zip(parts, stretch.sections_of(shape.catenary), strict=True):
        _draw_arms_of(ax, part, section, begin, ends, texts)
    order = np.argsort([x for x, _ in ends], kind="stable")
    _name_forces(ax, [ends[i] for i in order], [texts[i] for i in order])


def _draw_arms_of(
    ax: Axes,
    part: stretch.Stretch,
    shape: Shape,
    begin: float,
    ends: list[tuple[float, float]],
    texts: list[str],
) -> None:
    """The arms of a section that begins at a place [m]; their ends and forces are added to the lists."""
    forces, catenary = shape.installation.arm_forces, shape.catenary
    places = catenary.support_positions + begin
    for i in range(1, len(catenary.spans)):
        arm = catenary.supports[i].steady_arm
        if arm is None or not part.start - 1e-6 <= places[i] <= part.end + 1e-6:
            continue
        for wire, (stations, force) in enumerate(zip(shape.mesh.wires, forces[:, i], strict=False)):
            hanging, node = shape.wires[wire], stations.supports[i]
            x, y = hanging.x[node] + begin, hanging.y[node]
            reach = arm.length * force[0] / np.linalg.norm(force) if arm.length else 0.15
            ax.plot([x, x], [y, y + reach], color=style.SUPPORT, linewidth=2.2, solid_capstyle="round")
            ax.plot(x, y + reach, marker="s", color=style.SUPPORT, markersize=4)
            if wire == 0:
                ends.append((x, y + reach))
        texts.append(" + ".join(f"{abs(force[0]):.0f}" for force in forces[:, i]) + " N")


def _name_forces(ax: Axes, ends: Sequence[tuple[float, float]], texts: Sequence[str]) -> None:
    """Beside the arms' ends, upright where there is little room, and left out where there is none."""
    first = {x: text for (x, _), text in zip(ends, texts, strict=True)}  # of arms at one support
    rotation = style.rotation_that_fits(ax, list(first), list(first.values()), 8)
    style.label_beside(ax, ends, texts, upright=rotation != 0)
