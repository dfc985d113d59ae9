"""Picture of a catenary from above: stagger, steady arms, curves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.equilibrium import Shape
from catenary_fe.system import Catenary
from catenary_fe.views.layout import hanging_lines
from catenary_fe.views.style import (
    DROPPER,
    SUPPORT,
    finish,
    headroom,
    mark_supports,
    new_axes,
    styled,
)


@styled
def plot_plan(
    shape: Shape, *, spans: Sequence[int] | None = None, head_width: float = 1.2, ax: Axes | None = None
) -> Axes:
    """Draw all wires from above, y to the left of the track's centre, with steady arms and their pull.

    spans : numbers of the spans, from 1; unset: the evaluated ones, at most four
    head_width : [m] of the panhead's working part, drawn as a band
    """
    catenary = shape.catenary
    spans = spans or catenary.spans_to_evaluate[:4]
    supports = catenary.support_positions
    start, end = supports[min(spans) - 1], supports[max(spans)]
    ax = new_axes(ax, (11.0, 4.2))
    ax.axhspan(-head_width / 2, head_width / 2, color="#f1efe8", label=f"panhead, {head_width:g} m")
    ax.axhline(0.0, color=SUPPORT, linewidth=0.7, linestyle="-.", label="track centre")
    named: set[str] = set()
    lines = hanging_lines(shape)
    for line in reversed(lines):
        inside = (line.x >= start - 1e-6) & (line.x <= end + 1e-6)
        if inside.any():
            label = line.name if line.name not in named else None
            ax.plot(line.x[inside], line.y[inside], color=line.colour, linewidth=line.width, label=label)
            named.add(line.name)
    _draw_droppers(ax, shape, start, end)
    _draw_arms(ax, shape, range(min(spans) - 1, max(spans) + 1))
    mark_supports(ax, supports[min(spans) - 1 : max(spans) + 1])
    ax.margins(x=0.02)
    headroom(ax, 0.3)
    ax.legend(loc="upper center", ncols=6, fontsize=8, frameon=False)
    title = f"{catenary.name}: plan, {_curve(catenary, spans)}; sideways much exaggerated"
    return finish(ax, "position along the track (m)", "to the left of the track (m)", title)


def _curve(catenary: Catenary, spans: Sequence[int]) -> str:
    radii = {catenary.spans[n - 1].curve_radius or 0.0 for n in spans}
    if len(radii) > 1:
        return "curve radii " + ", ".join(f"{r:g} m" if r else "straight" for r in sorted(radii))
    (radius,) = radii
    side = "left" if radius > 0 else "right"
    return f"curve to the {side}, radius {abs(radius):g} m" if radius else "straight track"


def _draw_droppers(ax: Axes, shape: Shape, start: float, end: float) -> None:
    mesh = shape.mesh
    points = np.concatenate([np.column_stack([w.x, w.y]) for w in shape.wires])
    for a, b in zip(points[mesh.nodes(mesh.lower)], points[mesh.nodes(mesh.upper)], strict=True):
        if start < a[0] < end:
            ax.plot([a[0], b[0]], [a[1], b[1]], color=DROPPER, linewidth=0.7)


def _draw_arms(ax: Axes, shape: Shape, numbers: range) -> None:
    """Arms as long as they are, seen from above, with the force that they hold sideways."""
    forces, catenary = shape.installation.arm_forces, shape.catenary
    for i in numbers:
        arm = catenary.supports[i].steady_arm
        if arm is None or i in (0, len(catenary.spans)):
            continue
        sides = []
        for wire, (stations, force) in enumerate(zip(shape.mesh.wires, forces[:, i], strict=False)):
            hanging, node = shape.wires[wire], stations.supports[i]
            x, y = hanging.x[node], hanging.y[node]
            reach = arm.length * force[0] / np.linalg.norm(force) if arm.length else 0.15
            ax.plot([x, x], [y, y + reach], color=SUPPORT, linewidth=2.2, solid_capstyle="round")
            ax.plot(x, y + reach, marker="s", color=SUPPORT, markersize=4)
            sides.append((y + reach, abs(force[0])))
        ax.annotate(
            " + ".join(f"{force:.0f}" for _, force in sides) + " N",
            (x, sides[0][0]),
            xytext=(6, 0),
            textcoords="offset points",
            va="center",
            fontsize=8,
        )
