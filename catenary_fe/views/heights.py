"""Picture of the contact wire's heights along a line, and of its gradients."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.layout.arguments import checked, number
from catenary_fe.layout.current_collection import gradient_limit
from catenary_fe.statics import Shape
from catenary_fe.views import style
from catenary_fe.views.static import RUN_OFF
from catenary_fe.views.stretch import Stretch, frame, legend, stretch


@checked
@style.styled
def plot_heights(
    shape: Shape, *, speed: float | None = None, spans: Sequence[int] | None = None, ax: Axes | None = None
) -> Axes:
    """Height of the contact wire above the rail along the line, below it the gradient of each span.

    speed : [m/s] whose limit of the gradient is drawn; unset: none is
    spans : numbers of the spans, from 1; unset: the whole line
    ax : for the heights alone; unset: a new figure with the gradients

    Returns the axes of the heights. Raises InputError for spans that the line does not have, and for a speed
    of zero and below.
    """
    if speed is not None:
        number("speed", speed, "m/s", above=0.0)
    part = stretch(shape.catenary, spans)
    if ax is not None:
        return _heights(ax, shape, part)
    ax, below = style.new_panels((11.0, 5.4), (3, 2))
    _gradients(below, part, speed)
    return _heights(ax, shape, part)


def _heights(ax: Axes, shape: Shape, part: Stretch) -> Axes:
    catenary, label = part.catenary, "contact wire at rest"
    frame(ax, part)
    for wire in shape.contact_wires:
        x = part.sampled(wire.x)
        z = wire.height(x)
        z[z - catenary.design_line(x) > RUN_OFF] = np.nan
        ax.plot(x, z, color=style.CONTACT, linewidth=1.4, label=label)
        label = ""
    x, z = part.support_x, catenary.design_line(part.support_x)
    style.mark_supports(ax, x, label=False)
    ax.plot(
        x, z, "o", color=style.SUPPORT, markersize=4, fillstyle="none", label="design height at a support"
    )
    low, high = ax.get_ylim()
    room = max(high - low, 0.1)
    ax.set_ylim(low - 0.1 * room, high + 0.5 * room)
    style.number_row(ax, x, high + 0.2 * room, [i + 1 for i in part.supports])
    new = np.diff(z, prepend=np.nan, append=np.nan) != 0  # the ends, too
    shown = new[:-1] | new[1:]
    above = np.column_stack([x, z + 0.09 * room])[shown]
    style.label_beside(ax, above, [f"{height:.2f}" for height in z[shown]], size=7)
    legend(ax)
    title = f"{catenary.name}: heights of the contact wire{part.where}"
    return style.finish(ax, style.ALONG, "height above rail (m)", title)


def _gradients(ax: Axes, part: Stretch, speed: float | None) -> None:
    """The design's gradient in each span, as steps, with the limits at a speed."""
    gradients = 1e3 * part.catenary.gradients[part.first - 1 : part.last]
    frame(ax, part)
    style.mark_supports(ax, part.support_x, label=False)
    ax.axhline(0.0, color=style.SUPPORT, linewidth=0.7)
    ax.stairs(gradients, part.support_x, color=style.CONTACT, linewidth=1.6, label="gradient of a span")
    most = float(np.abs(gradients).max())
    limit = None if speed is None else gradient_limit(speed).value
    if speed is not None and limit is not None:
        most = max(most, 1e3 * limit)
        label = f"limit at {3.6 * speed:.0f} km/h (EN 50119, recalled)"
        for sign in (1, -1):
            ax.axhline(sign * 1e3 * limit, color=style.SLACK, linewidth=1.0, linestyle="--", label=label)
            label = ""
    most = most or 1.0
    ax.set_ylim(-1.3 * most, 1.8 * most)
    legend(ax)
    style.finish(ax, style.ALONG, "gradient (‰)", "Design gradient of the contact wire, rising above 0")
