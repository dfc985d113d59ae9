"""Which part of a line a picture shows, and the wires in it: as they hang, or sketched."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.layout import GRAVITY, Catenary
from catenary_fe.layout import Line as SectionedLine
from catenary_fe.layout.arguments import runs, span_numbers
from catenary_fe.statics import Shape
from catenary_fe.views.style import SUPPORT, mark_spans, new_axes, new_panels, wire_colour

Floats = NDArray[np.float64]
CLOSE = 4  # spans that a picture can show with all their dimensions
_WIDTHS = {"stitch wire": 1.2}  # others 1.6
_KINDS = ("contact wire", "messenger wire", "stitch wire")


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

    @property
    def where(self) -> str:
        """Which spans these are, for a title; nothing for the whole line."""
        return "" if len(self.spans) == len(self.catenary.spans) else f", {self}"

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


def overlap_spans(catenary: Catenary) -> list[int]:
    """Numbers of the spans in which a pantograph goes over from one tension section to the next."""
    if not isinstance(catenary, SectionedLine):
        return []
    middles = [(begin + end) / 2 for begin, end in catenary.common_zones]
    numbers = {int(np.searchsorted(catenary.support_positions, x + d)) for x in middles for d in (-1, 1)}
    return sorted(numbers)


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
        legend(ax)
        return ax
    whole, close = new_panels((size[0], 2 * size[1]), (1, 1))
    detail = evaluated_pair(catenary, among)
    draw(whole, part)
    mark_detail(whole, detail)
    draw(close, detail)
    legend(whole)
    return whole


def mark_detail(ax: Axes, detail: Stretch) -> None:
    """A bar along the top over what is drawn closer below."""
    ax.plot(
        [detail.start, detail.end], [0.995, 0.995], color=SUPPORT, linewidth=3.0, solid_capstyle="butt",
        transform=ax.get_xaxis_transform(), label="drawn closer below",
    )  # fmt: skip


def legend(ax: Axes) -> None:
    """What the lines and marks of a line's picture are, along its top."""
    ax.legend(loc="upper center", ncols=8, fontsize=8, frameon=False, handlelength=1.6, columnspacing=1.4)


def frame(ax: Axes, part: Stretch) -> None:
    """Limits along the line, and a band behind the evaluated spans, unless they are all of the stretch."""
    margin = 0.02 * (part.end - part.start)
    ax.set_xlim(part.start - margin, part.end + margin)
    if len(part.evaluated) < len(part.spans):
        mark_spans(ax, part.catenary.support_positions, part.evaluated)


@dataclass(frozen=True)
class Line:
    """A wire as it is drawn: coordinates [m] of shape (points,), and its name."""

    x: Floats
    y: Floats
    z: Floats
    name: str
    section: int = 0

    @property
    def colour(self) -> str:
        """Of its kind of wire."""
        return wire_colour(self.name)

    @property
    def width(self) -> float:
        """[pt]"""
        return _WIDTHS.get(self.name, 1.6)

    def height(self, x: Floats) -> Floats:
        """[m] at positions x [m] along the line, no number beyond the wire's ends."""
        return np.asarray(np.interp(x, self.x, self.z, left=np.nan, right=np.nan))


def hanging_lines(shape: Shape, part: Stretch) -> list[Line]:
    """All wires as they hang in a stretch, in the order of the mesh: cubic between the nodes."""
    lines = []
    for number, wire in enumerate(shape.wires):
        name = shape.mesh.wire_name(number)
        x = part.sampled(wire.x)
        empty = np.array([])
        lines.append(
            Line(x, wire.lateral(x), wire.height(x), name) if x.size else Line(x, empty, empty, name)
        )
    return lines


def sketched_lines(catenary: Catenary, part: Stretch) -> list[Line]:
    """Contact wires at design heights, messenger wire as parabolas, stitch wires straight."""
    lines = []
    for number, section, begin in sections_of(catenary):
        for (at, high), name in zip(_sketch(section), _names(section), strict=True):
            shown = part.sampled(at + begin)
            lines.append(Line(shown, np.zeros_like(shown), np.interp(shown, at + begin, high), name, number))
    return sorted(lines, key=lambda line: _KINDS.index(line.name))


def sections_of(catenary: Catenary) -> list[tuple[int, Catenary, float]]:
    """Number from 0, layout, and [m] where it begins, of each tension section."""
    if not isinstance(catenary, SectionedLine):
        return [(0, catenary, 0.0)]
    numbers = range(len(catenary.sections))
    return list(zip(numbers, catenary.sections, catenary.begins, strict=True))


def _sketch(catenary: Catenary) -> list[tuple[Floats, Floats]]:
    """[m], places and heights of each wire of a section."""
    supports, heights = catenary.support_positions, catenary.messenger_support_heights
    x = np.concatenate([supports, catenary.dropper_positions])
    z = np.concatenate([catenary.contact_wire_heights, catenary.design_heights])
    order = np.argsort(x)
    contact_wires = len(catenary.contact_wire_offsets)
    if catenary.messenger_wire is None:
        return [(x[order], z[order])] * contact_wires
    mass = contact_wires * catenary.contact_wire.mass_per_length + catenary.messenger_wire.mass_per_length
    along = np.unique(np.concatenate([np.linspace(0, catenary.length, 60 * len(catenary.spans)), supports]))
    span = np.clip(np.searchsorted(supports, along, side="right") - 1, 0, len(catenary.spans) - 1)
    a, b = supports[span], supports[span + 1]
    sag = GRAVITY * mass * (along - a) * (b - along) / (2 * catenary.messenger_wire.tension)
    messenger = along, np.interp(along, supports, heights) - sag
    points = [(x[order], z[order])] * contact_wires + [messenger]
    if catenary.stitch_wire:
        for support in catenary.stitched_supports:
            ends = supports[support] + catenary.stitch_wire_lengths[support] / 2 * np.array([-1.0, 1.0])
            points.append((ends, np.interp(ends, *messenger)))
    return points


def _names(catenary: Catenary) -> list[str]:
    """Of each wire, in the order of the mesh."""
    contact = ["contact wire"] * len(catenary.contact_wire_offsets)
    messenger = ["messenger wire"] if catenary.messenger_wire else []
    return [*contact, *messenger, *["stitch wire"] * len(catenary.stitched_supports)]


def upper_wires(catenary: Catenary, shape: Shape | None) -> NDArray[np.int64]:
    """Shape (droppers,): number of the wire that each dropper hangs on, in the order of the mesh."""
    if shape is not None:
        return shape.mesh.upper.wire
    wires = []
    parts = sections_of(catenary)
    kinds = [(_KINDS.index(name), n) for n, section, _ in parts for name in _names(section)]
    place = np.argsort(sorted(range(len(kinds)), key=kinds.__getitem__))  # as sketched lines are sorted
    first = 0
    for _, section, _ in parts:
        at, contact_wires = section.dropper_positions, len(section.contact_wire_offsets)
        own = np.full(at.size, contact_wires)
        for i, support in enumerate(section.stitched_supports, start=1):
            half = section.stitch_wire_lengths[support] / 2
            near = np.abs(section.support_positions[support] - at) < half
            own[near] = contact_wires + i
        wires.append(place[first + own])
        first += len(_names(section))
    return np.concatenate(wires)


def served_height(lines: Sequence[Line], x: Floats) -> Floats:
    """[m], of the lowest contact wire at positions x [m] along the line."""
    heights = [line.height(x) for line in lines if line.name == _KINDS[0] and line.x.size]
    return np.asarray(np.fmin.reduce(heights))


def draw_lines(ax: Axes, lines: list[Line], axis: str) -> None:
    """Draw wires against their heights, "z", or their lateral positions, "y"; each kind is named once."""
    named: set[str] = set()
    for line in reversed(lines):
        if line.x.size:
            label = None if line.name in named else line.name
            ax.plot(line.x, getattr(line, axis), color=line.colour, linewidth=line.width, label=label)
            named.add(line.name)
