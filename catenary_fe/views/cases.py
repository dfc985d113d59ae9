"""A line under several cases of weather, drawn over one another: from above and from the side."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import checked
from catenary_fe.statics import Shape
from catenary_fe.views import style
from catenary_fe.views.stretch import Stretch, frame, stretch


@checked
@style.styled
def plot_cases(shapes: Sequence[Shape], *, spans: Sequence[int] | None = None) -> Axes:
    """Contact wires under each case, above: from the side, below: to the left of the track's centre.

    shapes : of one line, as :func:`catenary_fe.settle` returned them
    spans : numbers of the spans, from 1; unset: the whole line

    Returns the axes of the heights. Raises InputError without a case, and for spans that the line lacks.
    """
    if not shapes or any(shape.settlement is None for shape in shapes):
        raise InputError("plot_cases: give shapes that cf.settle returned, one at least")
    catenary = shapes[0].catenary
    part = stretch(catenary, spans)
    spatial = shapes[0].system.spatial
    above, *below = style.new_panels((11.0, 6.4 if spatial else 3.6), [1] * (2 if spatial else 1))
    colours = style.distinct(len(shapes))
    before = shapes[0].settlement.before if shapes[0].settlement else shapes[0]
    for ax, offset in ((above, False), *((ax, True) for ax in below)):
        frame(ax, part)
        style.mark_supports(ax, part.support_x, label=False)
        _draw(ax, before, part, offset, style.DROPPER, "as hung", "--")
        for shape, colour in zip(shapes, colours, strict=True):
            _draw(ax, shape, part, offset, colour, _name(shape), "-")
    for ax in below:
        _limits(ax, shapes)
        style.headroom(ax, 0.25)
        style.finish(ax, style.ALONG, "to the left of the track (m)", "")
    above.legend(loc="upper left", fontsize=8, ncols=4, frameon=False)
    style.headroom(above, 0.3)
    title = f"{catenary.name}: contact wire under {len(shapes)} cases{part.where}"
    return style.finish(above, style.ALONG, "height (m)", title)


def _name(shape: Shape) -> str:
    settled = shape.settlement
    return settled.conditions.name if settled and settled.conditions else "effects"


def _draw(ax: Axes, shape: Shape, part: Stretch, offset: bool, colour: str, label: str, line: str) -> None:
    for number, wire in enumerate(shape.contact_wires):
        x = part.sampled(wire.x)
        values = wire.lateral(x) if offset else wire.height(x)
        ax.plot(x, values, line, color=colour, linewidth=1.2, label=None if number else label)


def _limits(ax: Axes, shapes: Sequence[Shape]) -> None:
    """Allowed offsets to both sides, each once."""
    settled = [shape.settlement for shape in shapes]
    of_cases = [s.conditions.allowed_offset for s in settled if s and s.conditions]
    allowed = {offset for offset in of_cases if offset is not None}
    lines = []
    for offset in sorted(allowed):
        both = [ax.axhline(sign * offset, color=style.SUPPORT, linestyle="--") for sign in (1, -1)]
        both[0].set_label(f"allowed offset, {offset:g} m")
        lines.append(both[0])
    if lines:
        ax.legend(handles=lines, loc="upper left", fontsize=8, frameon=False)
