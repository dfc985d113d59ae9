"""Pictures of a line at rest: its shape with the droppers' tensions, its elasticity, its eigenforms."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.layout import counted
from catenary_fe.layout.arguments import checked
from catenary_fe.results import Elasticity
from catenary_fe.results.modes import IN_WORDS, Modes, WireShapes
from catenary_fe.statics import HangingWire, LineShape, Shape
from catenary_fe.views import style
from catenary_fe.views.stretch import (
    Stretch,
    evaluated_pair,
    frame,
    legend,
    mark_detail,
    overlap_spans,
    stretch,
)

RUN_OFF = 0.3  # [m] above the design line: higher wires run off to their anchors
SHADES = (style.CONTACT, "#e6a07c")  # of right and left contact wire, or of neighbouring sections


@checked
@style.styled
def plot_static_shape(
    shape: Shape, *, spans: Sequence[int] | None = None, design: Shape | None = None, ax: Axes | None = None
) -> Axes:
    """Static height of the contact wire above its nominal height, and the dropper tensions below it.

    spans : numbers of the spans, from 1; unset: the whole line, and of a long one two spans closer
    design : of a line that hangs otherwise: its wire and its dropper tensions are drawn behind
    ax : for the heights, with the tensions written at the droppers where there is room; unset: a new figure

    Returns the axes of the (whole line's) heights. Raises InputError for spans that the line does not have.
    """
    part = stretch(shape.catenary, spans)
    if ax is not None:
        return _heights(ax, shape, part, design=design)
    detail = None if spans or part.is_close else evaluated_pair(shape.catenary, overlap_spans(shape.catenary))
    rows = 3 if detail else 2
    whole, *others = style.new_panels((11.0, 2.9 * rows), [1] * rows)
    _tensions(others[0], shape, part, design)
    if detail:
        _heights(others[1], shape, detail, design=design)
    return _heights(whole, shape, part, detail, design)


def _heights(
    ax: Axes, shape: Shape, part: Stretch, detail: Stretch | None = None, design: Shape | None = None
) -> Axes:
    catenary = shape.catenary
    nominal = catenary.design_line
    frame(ax, part)
    style.mark_supports(ax, part.support_x)
    for number, wire in enumerate(design.contact_wires if design else ()):
        x = part.sampled(wire.x)
        label = None if number else "contact wire as designed"
        ax.plot(x, 1e3 * (wire.height(x) - nominal(x)), "--", color=style.DROPPER, linewidth=0.9, label=label)
    named: set[str] = set()
    for wire, name, colour in named_contact_wires(shape):
        x = part.sampled(wire.x)
        height = wire.height(x) - nominal(x)
        height[height > RUN_OFF] = np.nan
        label = None if name in named else name
        ax.plot(x, 1e3 * height, color=colour, linewidth=1.4, label=label)
        named.add(name)
    chosen = part.inside(catenary.dropper_positions)
    chosen &= catenary.design_heights - nominal(catenary.dropper_positions) < RUN_OFF
    x = catenary.dropper_positions[chosen]
    wanted = 1e3 * (catenary.design_heights[chosen] - nominal(x))
    size = 4 if part.is_close else 2
    ax.plot(x, wanted, "o", color=style.DROPPER, markersize=size, label="design height at the droppers")
    above = "design line" if catenary.changes_height else "nominal"
    style.headroom(ax, 0.35)
    what = "static shape of the contact wire"
    if detail:
        mark_detail(ax, detail)
    else:
        texts = [f"{force:.0f} N" for force in shape.dropper_forces[chosen]]
        if style.label_row(ax, x, wanted + 1e3 * shape.height_errors[chosen], texts, above=5):
            what += ", dropper tensions"
    return _finished(ax, part, f"height above {above} (mm)", what)


def named_contact_wires(shape: Shape) -> list[tuple[HangingWire, str, str]]:
    """Each contact wire with its name and colour; sections that are neighbours differ."""
    colours = SHADES
    if isinstance(shape, LineShape):
        numbers = range(1, len(shape.sections) + 1)
        names = [
            f"contact wire, section{'s' if len(own) > 1 else ''} {', '.join(map(str, own[:3]))}"
            f"{' ...' if len(own) > 3 else ''}"
            for own in (numbers[::2], numbers[1::2])
        ]
        parity = [int(section) % 2 for section in shape.joint.section]
        wires = zip(shape.contact_wires, parity, strict=False)
        return [(wire, names[which], colours[which]) for wire, which in wires]
    sides = len(shape.catenary.contact_wire_offsets)
    names = ["right contact wire", "left contact wire"] if sides > 1 else ["contact wire"]
    return list(zip(shape.contact_wires, names, colours, strict=False))


def _tensions(ax: Axes, shape: Shape, part: Stretch, design: Shape | None = None) -> Axes:
    """Tension of each dropper, in the colour of the wire that it hangs on, or of two contact wires holds."""
    catenary = shape.catenary
    frame(ax, part)
    style.mark_supports(ax, part.support_x)
    chosen = part.inside(catenary.dropper_positions)
    x, forces = catenary.dropper_positions[chosen], shape.dropper_forces[chosen]
    if design:
        of_design = design.catenary.dropper_positions
        there = part.inside(of_design)
        ax.plot(of_design[there], design.dropper_forces[there], "o", color=style.DROPPER, markersize=5,
                fillstyle="none", label="as designed")  # fmt: skip
    for name, colour, of_kind in _kinds(shape):
        mine = of_kind[chosen]
        if mine.any():
            ax.vlines(x[mine], 0, forces[mine], color=colour, linewidth=min(1.6, 300 / x.size), label=name)
            ax.plot(x[mine], forces[mine], ".", color=colour, markersize=4)
    ax.set_ylim(0, 1.45 * forces.max(initial=1.0))
    style.label_row(ax, x, forces, [f"{force:.0f}" for force in forces], above=3)
    return _finished(ax, part, "dropper tension (N)", "dropper tensions")


def _finished(ax: Axes, part: Stretch, y: str, what: str) -> Axes:
    legend(ax)
    return style.finish(ax, style.ALONG, y, f"{part.catenary.name}: {what}{part.where}")


def _kinds(shape: Shape) -> list[tuple[str, str, np.ndarray]]:
    """Name, colour and mask of the droppers of each kind."""
    mesh = shape.mesh
    if len(shape.catenary.contact_wire_offsets) > 1 and not isinstance(shape, LineShape):
        right = mesh.lower.wire == 0
        return [
            ("holds the right contact wire", style.CONTACT, right),
            ("holds the left one", SHADES[1], ~right),
        ]
    stitch = mesh.upper.wire >= mesh.first_stitch
    return [("on the messenger wire", style.MESSENGER, ~stitch), ("on a stitch wire", style.STITCH, stitch)]


@style.styled
def plot_elasticity(elasticity: Elasticity, *, ax: Axes | None = None) -> Axes:
    """Elasticity along the line with its extremes; spans that were not computed leave a gap."""
    ax = style.new_axes(ax)
    x, e = elasticity.position, 1e3 * elasticity.values
    style.mark_supports(ax, elasticity.support_position)
    for number, piece in enumerate(_pieces(elasticity)):
        label = None if number else "elasticity"
        ax.plot(x[piece], e[piece], color=style.CONTACT, marker=".", markersize=4, linewidth=1.4, label=label)
    low, high = ax.get_xlim()
    for index, place in ((e.argmin(), -12), (e.argmax(), 6)):
        share = (x[index] - low) / (high - low)
        side = "left" if share < 0.1 else "right" if share > 0.9 else "center"
        text = f"{e[index]:.3f} mm/N at {x[index]:.1f} m"
        style.annotate(ax, text, (x[index], e[index]), (0, place), ha=side)
    ax.set_ylim(0, 1.2 * e.max())
    ax.legend(loc="lower right", fontsize=8)
    title = f"Elasticity under {elasticity.force:g} N, non-uniformity {100 * elasticity.non_uniformity:.1f} %"
    return style.finish(ax, style.ALONG, "elasticity (mm/N)", title)


def _pieces(elasticity: Elasticity) -> list[slice]:
    """Parts of the curve between which there is a span without any point inside it."""
    x, supports = elasticity.position, elasticity.support_position
    starts = {0}
    for a, b in pairwise(supports):
        after = int(np.searchsorted(x, a + 1e-6))
        if after < x.size and x[after] > b - 1e-6:
            starts.add(after)
    return [slice(a, b) for a, b in pairwise([*sorted(starts), x.size])]


@checked
@style.styled
def plot_mode(modes: Modes, mode: int, *, ax: Axes | None = None) -> Axes:
    """Both wires in one eigenform (mode numbered from 0), each about its own line, droppers between them.

    Drawn is the vertical motion, of a lateral mode the motion to the left.
    """
    ax = style.new_axes(ax, (10.0, 3.0))
    catenary = modes.catenary
    x = np.linspace(0, catenary.length, 120 * len(catenary.spans) + 1)
    wires = {"contact wire": (modes.contact, -1.0, style.CONTACT)}
    if modes.messenger:
        wires = {"messenger wire": (modes.messenger, 1.0, style.MESSENGER), **wires}
    kind = modes.kind(mode)
    drawn = {name: _drawn(wire, mode, kind.kind == "sideways") for name, (wire, _, _) in wires.items()}
    largest = max(np.abs(shape).max() for shape in drawn.values())
    style.mark_supports(ax, catenary.support_positions)
    at = catenary.dropper_positions

    def place(name: str, at: np.ndarray) -> np.ndarray:
        wire, rest, _ = wires[name]
        return np.asarray(rest + 0.8 * np.interp(at, wire.x, drawn[name]) / largest)

    ends = [place(name, at) for name in wires]
    ax.vlines(at, ends[-1], ends[0], color=style.DROPPER, linewidth=0.6)
    for name, (_, rest, colour) in wires.items():
        ax.axhline(rest, color="#cccccc", linewidth=0.6)
        ax.plot(x, place(name, x), color=colour, linewidth=1.3, label=name)
    ax.set_yticks([rest for _, rest, _ in wires.values()], [name.replace(" ", "\n") for name in wires])
    ax.set_ylim(-2.1, 2.7)  # room for a legend
    ax.margins(x=0.01)
    part = {"along": " (its vertical part, magnified)", "sideways": " (seen from above)"}.get(kind.kind, "")
    title = f"mode {mode + 1}: {modes.frequencies[mode]:.3f} Hz, {kind}{part}"
    return style.finish(ax, style.ALONG, "", title)


def _drawn(wire: WireShapes, mode: int, lateral: bool) -> np.ndarray:
    shapes = wire.lateral if lateral and wire.lateral is not None else wire.values
    return np.asarray(shapes[mode])


@checked
@style.styled
def plot_spectrum(modes: Modes, *, ax: Axes | None = None) -> Axes:
    """How many modes lie below a frequency, by what they are: clusters are steps."""
    ax = style.new_axes(ax, (10.0, 3.6))
    kinds = [f"bays, shape {k.half_waves}" if k.kind == "bays" else k.kind for k in modes.kinds()]
    number = np.arange(1, len(modes) + 1)
    names = sorted(set(kinds), key=lambda name: (name in IN_WORDS, name.startswith("bays"), name))
    for name, colour in zip(names, style.distinct(len(names)), strict=True):
        of_kind = np.array([k == name for k in kinds])
        label = f"{IN_WORDS.get(name, name)}: {of_kind.sum()}"
        ax.plot(modes.frequencies[of_kind], number[of_kind], ".", color=colour, markersize=5, label=label)
    ax.legend(fontsize=8, loc="upper left")
    title = f"{modes.catenary.name}: {counted(len(modes), 'mode')} up to {modes.frequencies[-1]:.1f} Hz"
    return style.finish(ax, "frequency (Hz)", "number of modes below it", title)
