"""Drawings of the reference pages: which dimension a key means, and which sign it has. Not to scale."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from drafting import (
    CENTRE,
    CENTRE_LINE,
    DASHED,
    DIMENSION,
    FORCE,
    MAST,
    NOTE,
    SMALL,
    THIN,
    TRACK,
    USUAL,
    Point,
    coordinate_axis,
    damper,
    dimension,
    force,
    ground,
    into_page,
    key,
    label,
    line,
    new_axes,
    spring,
    thin,
    wire_seen_along,
)
from matplotlib import rc_context
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Arc, Circle, Rectangle

from catenary_fe.views.style import CONTACT, DROPPER, MESSENGER, STITCH, SUPPORT

STYLE = {"svg.hashsalt": "catenary_fe", "svg.fonttype": "path", "font.size": USUAL}
# of the span that is drawn
LENGTH, HEIGHT, TOP, HALF_STITCH, DROPPERS = 9.0, 2.5, 4.5, 1.35, (0.9, 2.7, 4.5, 6.3, 8.1)


def draw_all(folder: Path) -> None:
    """Write all drawings as SVG, unless they are newer than what draws them."""
    folder.mkdir(parents=True, exist_ok=True)
    changed = max(path.stat().st_mtime for path in Path(__file__).parent.glob("dra*.py"))
    for name, draw in DRAWINGS.items():
        path = folder / f"{name}.svg"
        if not path.exists() or path.stat().st_mtime < changed:
            with rc_context(STYLE):
                draw().savefig(path, metadata={"Date": None})


def support() -> Figure:
    """A support, seen along the track: heights and staggers."""
    (ax,) = new_axes(7.2, 6.2)
    contact, top, stagger, messenger = 3.4, 4.7, 0.62, 0.3  # drawn, not to scale
    # left is left: y grows to the left on the page
    at = {"contact": (-stagger, contact), "messenger": (-messenger, top), "pivot": (-1.75, contact + 0.28)}
    line(ax, (-3.6, 0.0), (2.6, 0.0), color=TRACK, width=0.8)
    label(ax, (2.25, -0.14), "top of rail", color=NOTE, fontsize=SMALL)
    for y in (-0.75, 0.75):
        ax.add_patch(Rectangle((y - 0.06, -0.3), 0.12, 0.3, color=TRACK))
    ax.add_patch(Rectangle((-1.25, -0.48), 2.5, 0.18, color="#cccccc"))
    line(ax, (0, -0.6), (0, 5.5), color=CENTRE_LINE, width=0.8, style=CENTRE)
    label(ax, (0, 5.62), "centre of the track", color=NOTE, fontsize=SMALL)
    ax.add_patch(Rectangle((-3.45, -0.5), 0.22, 5.9, color="#bbbbbb"))
    label(ax, (-3.34, 5.55), "mast", color=NOTE, fontsize=SMALL)
    line(ax, (-3.23, top + 0.02), at["messenger"], width=2.0, color=MAST)
    line(ax, (-3.23, contact + 0.1), (-1.2, top + 0.02), width=2.0, color=MAST)
    line(ax, (-2.9, contact + 0.29), (-1.3, contact + 0.55), width=2.0, color=MAST)
    line(ax, (-1.75, contact + 0.47), at["pivot"], width=2.0, color=MAST)
    line(ax, at["pivot"], at["contact"], width=2.4)
    ax.add_patch(Circle(at["pivot"], 0.05, facecolor="white", edgecolor=SUPPORT, zorder=6))
    wire_seen_along(ax, at["contact"], CONTACT, 0.07)
    wire_seen_along(ax, at["messenger"], MESSENGER, 0.07)
    label(ax, (-1.6, contact - 0.02), "steady arm", fontsize=SMALL)
    label(ax, (-2.3, top + 0.2), "cantilever", color=NOTE, fontsize=SMALL)
    label(ax, (-messenger + 0.42, top + 0.16), "messenger wire", color=MESSENGER, fontsize=SMALL, ha="left")
    label(ax, (-stagger - 0.1, contact - 0.28), "contact wire", color=CONTACT, fontsize=SMALL, ha="right")
    for x, z in (at["contact"], at["messenger"]):
        thin(ax, (x + 0.08, z), (2.3, z))
    dimension(ax, (1.9, 0), (1.9, contact), "contact_wire_height")
    dimension(ax, (1.9, contact), (1.9, top), "system_height")
    for (x, z), level in ((at["contact"], 2.55), (at["messenger"], 5.25)):
        thin(ax, (x, z), (x, level + np.sign(level - z) * 0.1))
    dimension(ax, (0, 2.55), (-stagger, 2.55), "stagger > 0", (-stagger - 0.12, 2.3))
    dimension(
        ax, (0, 5.25), (-messenger, 5.25), "messenger_stagger > 0", (-messenger - 0.12, 5.25), ha="right"
    )
    force(ax, (-stagger, contact), (0.35, contact), "pull of the wire", (0.42, contact + 0.16), ha="left")
    coordinate_axis(ax, (1.2, 0.7), (0.6, 0.7), "y")
    coordinate_axis(ax, (1.2, 0.7), (1.2, 1.3), "z")
    into_page(ax, (1.2, 0.7), 0.07)
    ax.text(1.36, 0.58, "x", style="italic")
    ax.set(xlim=(-3.7, 3.1), ylim=(-0.7, 5.8))
    return ax.figure


def span() -> Figure:
    """A span, seen from the side: what is counted from where."""
    (ax,) = new_axes(9.6, 5.4)
    ax.set_aspect("auto")
    _span_parts(ax)
    _span_dimensions(ax)
    coordinate_axis(ax, (LENGTH + 1.25, 0.45), (LENGTH + 1.8, 0.45), "x")
    coordinate_axis(ax, (LENGTH + 1.25, 0.45), (LENGTH + 1.25, 1.15), "z")
    ax.set(xlim=(-1.3, LENGTH + 2.4), ylim=(-0.35, TOP + 1.1))
    return ax.figure


def _messenger(x: float) -> float:
    return TOP - 4.4 * (x / LENGTH) * (1 - x / LENGTH)


def _contact(x: float) -> float:
    xi = np.clip((x - DROPPERS[0]) / (DROPPERS[-1] - DROPPERS[0]), 0, 1)
    return float(HEIGHT - 4 * 0.4 * xi * (1 - xi))


def _span_parts(ax: Axes) -> None:
    line(ax, (-1.2, 0), (LENGTH + 2.2, 0), color=TRACK, width=0.8)
    label(ax, (LENGTH + 1.45, -0.14), "top of rail", color=NOTE, fontsize=SMALL)
    x = np.linspace(0, LENGTH, 181)
    for shift in (-LENGTH, 0.0, LENGTH):  # the neighbours are cut off
        shown = x[(x + shift > -1.1) & (x + shift < LENGTH + 1.75)]
        ax.plot(shown + shift, [_messenger(v) for v in shown], color=MESSENGER, linewidth=1.8)
        ax.plot(shown + shift, [_contact(v) for v in shown], color=CONTACT, linewidth=1.8)
    low, half = TOP - 0.85, HALF_STITCH
    ends = (LENGTH - half, _messenger(LENGTH - half)), (LENGTH + half, _messenger(half))
    line(ax, ends[0], (LENGTH - 0.9, low), (LENGTH + 0.9, low), ends[1], color=STITCH, width=1.3)
    line(ax, (LENGTH + 0.9, _contact(0.9)), (LENGTH + 0.9, low), color=DROPPER)
    for i, d in enumerate(DROPPERS, start=1):
        line(ax, (d, _contact(d)), (d, _messenger(d) if i < 5 else low), color=DROPPER)
        label(ax, (d + 0.13, _contact(d) + 0.16), str(i), fontsize=7.5, color=DROPPER)
    for at, name in ((0.0, "support n"), (LENGTH, "support n + 1")):
        line(ax, (at, -0.25), (at, TOP + 0.75), width=0.8, style=":")
        ax.plot(at, TOP, marker="v", color=SUPPORT, markersize=8)
        ax.plot(at, HEIGHT, marker="o", color=SUPPORT, markersize=6, fillstyle="none")
        label(ax, (at, TOP + 0.92), name)
    label(ax, (LENGTH + 0.1, low - 0.17), "stitch wire", color=STITCH, fontsize=SMALL)
    label(ax, (2.75, _messenger(2.75) + 0.2), "messenger wire", color=MESSENGER, fontsize=SMALL)
    label(ax, (7.2, _contact(7.2) - 0.17), "contact wire", color=CONTACT, fontsize=SMALL)


def _span_dimensions(ax: Axes) -> None:
    thin(ax, (0, HEIGHT), (LENGTH, HEIGHT), style=DASHED)
    dimension(ax, (0, TOP + 0.62), (LENGTH, TOP + 0.62), "span n: length")
    for number, level in ((1, 1.3), (3, 0.75)):
        d = DROPPERS[number]
        dimension(ax, (0, level), (d, level), "position")
        thin(ax, (d, level - 0.1), (d, _contact(d)))
    for low, high, name in ((0, HEIGHT, "contact_wire_height"), (HEIGHT, TOP, "system_height")):
        dimension(ax, (-0.55, low), (-0.55, high), name, rotation=90)
        thin(ax, (-0.65, high), (0, high))
    d = DROPPERS[2]
    dimension(
        ax, (d + 0.45, HEIGHT), (d + 0.45, _contact(d)), "pre_sag", (d + 0.55, HEIGHT + 0.14), ha="left"
    )
    thin(ax, (d, _contact(d)), (d + 0.55, _contact(d)))
    d, text = DROPPERS[3], "height_offset < 0"
    dimension(ax, (d - 0.3, HEIGHT), (d - 0.3, _contact(d)), text, (d - 0.1, HEIGHT + 0.42), ha="left")
    thin(ax, (d - 0.4, _contact(d)), (d, _contact(d)))
    thin(ax, (d - 0.3, HEIGHT + 0.04), (d - 0.05, HEIGHT + 0.34))
    d = DROPPERS[1]
    dimension(ax, (d - 0.28, _contact(d)), (d - 0.28, _messenger(d)), "length", rotation=90)
    for z in (_contact(d), _messenger(d)):
        thin(ax, (d - 0.36, z), (d, z))
    left, right, level = LENGTH - HALF_STITCH, LENGTH + HALF_STITCH, TOP + 0.25
    for end in (left, right):
        thin(ax, (end, _messenger(left)), (end, level + 0.08))
    text, place = "stitch_wire.length", (right + 0.03, level + 0.17)
    dimension(ax, (left, level), (right, level), text, place, fontsize=7.5)


def steady_arm() -> Figure:
    """A steady arm as a link, and as the spring that stands for it in the plane."""
    left, right = new_axes(9.6, 3.9, 2, (1.75, 1))
    _link(left)
    _spring_arm(right)
    return left.figure


def _link(ax: Axes) -> None:
    wire, tilt, length = (0.0, 0.0), np.radians(16), 3.4
    pivot = (length * np.cos(tilt), length * np.sin(tilt))
    line(ax, wire, pivot, width=3.0)
    line(ax, pivot, (pivot[0], pivot[1] + 0.45), width=2.0, color=MAST)
    line(ax, (pivot[0] - 0.5, pivot[1] + 0.5), (pivot[0] + 0.5, pivot[1] + 0.4), width=2.0, color=MAST)
    ax.add_patch(Circle(pivot, 0.07, facecolor="white", edgecolor=SUPPORT, zorder=6))
    label(ax, (pivot[0] + 0.2, pivot[1] - 0.02), "pivot", ha="left")
    wire_seen_along(ax, wire, CONTACT, 0.11)
    turn = np.degrees(tilt)
    ax.add_patch(Arc(pivot, 2 * length, 2 * length, theta1=180 - turn * 0.45, theta2=180 + turn * 1.75,
                       color="#777777", linewidth=0.8, linestyle="--"))  # fmt: skip
    label(ax, (0.22, 1.35), "path of the wire end", fontsize=SMALL, color=NOTE, ha="left")
    across = 0.42 * np.array([-np.sin(tilt), np.cos(tilt)])
    a, b = tuple(np.array(wire) + across), tuple(np.array(pivot) + across)
    dimension(ax, a, b, "length", rotation=turn)
    for low, high in ((wire, a), (pivot, b)):
        thin(ax, low, tuple(np.array(high) * 1.0))
    line(ax, wire, (2.5, 0), color=DIMENSION, width=0.5, style=DASHED)
    ax.add_patch(Arc(wire, 3.6, 3.6, theta1=0, theta2=turn, color=DIMENSION, linewidth=THIN))
    key(ax, (2.0, 0.24), "inclination", ha="left")
    force(ax, (0, 0), (-1.3, 0), "pull of the wire $H$", (-0.75, 0.2))
    force(ax, (0, 0), (0, -0.9), "weight that hangs here:\nwire, clamp_mass,\nhalf of the arm", (0.12, -0.75),
           ha="left", fontsize=SMALL)  # fmt: skip
    dimension(ax, (-1.75, 0), (-1.75, 1.15), "uplift_room", (-1.85, 0.58), ha="right")
    thin(ax, (-1.85, 1.15), (-0.2, 1.15))
    thin(ax, (-1.85, 0), (-1.3, 0))
    label(ax, (-1.3, 1.3), "first thing in the way", fontsize=SMALL, color=NOTE)
    label(ax, (0.9, -1.75), 'a link (length): in space; here side = "right", seen along the track')
    ax.set(xlim=(-3.1, 4.2), ylim=(-1.9, 2.0))


def _spring_arm(ax: Axes) -> None:
    ground(ax, (-0.9, 1.75), (0.9, 1.75), below=False)
    spring(ax, (-0.45, 1.75), (-0.45, 0.55))
    damper(ax, (0.45, 0.55), (0.45, 1.75))
    ax.add_patch(Rectangle((-0.7, 0.2), 1.4, 0.35, facecolor="white", edgecolor=SUPPORT))
    key(ax, (0, 0.375), "mass")
    line(ax, (0, 0.2), (0, 0))
    wire_seen_along(ax, (0, -0.08), CONTACT, 0.11)
    key(ax, (-0.68, 1.15), "stiffness", ha="right")
    key(ax, (0.68, 1.15), "damping", ha="left")
    force(ax, (0, -1.05), (0, -0.2), "preload", (0.14, -0.75), ha="left", family="monospace")
    label(ax, (0, -1.75), "a spring (stiffness): in the plane")
    ax.set(xlim=(-2.0, 2.0), ylim=(-1.9, 2.0))


def signs() -> Figure:
    """Stagger and curve from above: which sides are positive, and where the wire pulls."""
    figure = Figure(figsize=(9.6, 6.2), layout="constrained", facecolor="white")
    straight, curve = figure.subplots(2, 1, height_ratios=(1, 1.1))
    for ax in (straight, curve):
        ax.set_axis_off()
    _straight_track(straight)
    _curved_track(curve)
    return figure


def _straight_track(ax: Axes) -> None:
    x, y = np.arange(4) * 3.0, 0.6 * np.array([1, -1, 1, -1])
    line(ax, (-0.9, 0), (10.4, 0), color=CENTRE_LINE, width=0.8, style=CENTRE)
    label(ax, (10.45, 0), "centre of the track", ha="left", fontsize=SMALL, color=NOTE)
    line(ax, (-0.9, 0.24), *zip(x, y, strict=True), (9.9, -0.24), color=CONTACT, width=1.8)
    for i in range(4):
        side = np.sign(y[i])
        line(ax, (x[i], y[i]), (x[i], y[i] + 0.75 * side), width=2.4)
        ax.plot(x[i], y[i] + 0.75 * side, "o", markersize=5, color="white", markeredgecolor=SUPPORT)
        ax.plot(x[i], y[i], "o", color=CONTACT, markersize=4)
        force(ax, (x[i], y[i]), (x[i], y[i] - 0.95 * side), "", (x[i], y[i]))
        label(ax, (x[i] + 0.12, y[i] + 0.55 * side), f"support {i + 1}", ha="left")
    for i, sign in ((1, "<"), (2, ">")):
        at, place = x[i] + 0.55, (x[i] + 0.65, y[i] / 2 - 0.02)
        dimension(ax, (at, 0), (at, y[i]), f"stagger {sign} 0", place, ha="left")
        thin(ax, (x[i], y[i]), (x[i] + 0.62, y[i]))
    label(ax, (0.1, -0.5), "pull of the wire", color=FORCE, ha="left")
    label(ax, (0.12, y[0] + 1.15), "arms stand on the outer side of the zigzag: they only pull", ha="left")
    coordinate_axis(ax, (-2.2, -0.5), (-1.6, -0.5), "x")
    coordinate_axis(ax, (-2.2, -0.5), (-2.2, 0.15), "y")
    label(ax, (-2.2, 0.55), "left", fontsize=SMALL, color=NOTE)
    ax.set(xlim=(-2.6, 12.1), ylim=(-1.6, 2.0), title="stagger, on a straight track")


def _curved_track(ax: Axes) -> None:
    radius, stagger, angles = 9.0, -0.3, np.radians([-45, -15, 15, 45])
    ax.set_aspect("equal")

    def at(angle: float, offset: float) -> Point:
        """A point to the left (inside) of the track's centre."""
        r = radius - offset
        return float(r * np.sin(angle)), float(radius - r * np.cos(angle))

    arc = [at(a, 0) for a in np.linspace(np.radians(-53), np.radians(53), 90)]
    line(ax, *arc, color=CENTRE_LINE, width=0.8, style=CENTRE)
    line(ax, *(at(a, stagger) for a in angles), color=CONTACT, width=1.8)
    for i, a in enumerate(angles, start=1):
        line(ax, at(a, stagger), at(a, stagger - 0.8), width=2.4)
        ax.plot(*at(a, stagger - 0.8), "o", markersize=5, color="white", markeredgecolor=SUPPORT)
        ax.plot(*at(a, stagger), "o", color=CONTACT, markersize=4)
        force(ax, at(a, stagger), at(a, stagger + 1.3), "", (0, 0))
        label(ax, at(a, stagger - 1.15), f"support {i}")
    label(ax, at(np.radians(-16.5), 1.25), "pull of the wire", color=FORCE, ha="right")
    arrow = {"arrowstyle": "-|>", "linewidth": THIN, "color": DIMENSION}
    ax.annotate("", xy=(0, 4.2), xytext=(0, 0), arrowprops=arrow)
    key(ax, (0.15, 3.0), "curve_radius > 0", ha="left")
    label(ax, (0.15, 2.55), "towards the centre, on the left", ha="left", fontsize=SMALL, color=NOTE)
    beside = np.radians(19.5)
    thin(ax, at(angles[2], stagger), at(beside + 0.03, stagger))
    dimension(
        ax, at(beside, 0), at(beside, stagger), "stagger < 0", at(beside + 0.05, stagger - 0.25), ha="left"
    )
    dimension(ax, (0, stagger), at(0, 0), "", (0, 0))
    parallel = [at(a, stagger) for a in np.linspace(angles[1], angles[2], 40)]
    line(ax, *parallel, color=DIMENSION, width=0.8, style=":")
    label(ax, (0, -0.55), "at mid-span: stagger +\nlength² / (8 curve_radius)", fontsize=SMALL, va="top")
    coordinate_axis(ax, at(np.radians(-58), 0), at(np.radians(-54), 0), "x")
    ax.set(xlim=(-10.5, 10.5), ylim=(-1.75, 4.4), title="a curve to the left, the arms on the outer side")


def pantograph() -> Figure:
    """A pantograph as a chain of stages, and what its head may have besides."""
    chain, front, side = new_axes(9.6, 3.7, 3, (1.3, 1.2, 0.8))
    _stages(chain)
    _head_from_the_front(front)
    _head_from_the_side(side)
    return chain.figure


def _stages(ax: Axes) -> None:
    line(ax, (-1.1, 4.05), (1.1, 4.05), color=CONTACT, width=2.0)
    label(ax, (-1.1, 4.2), "contact wire", color=CONTACT, fontsize=SMALL, ha="left")
    spring(ax, (0, 3.45), (0, 4.05), turns=3, width=0.08)
    key(ax, (0.2, 3.72), "contact_stiffness", ha="left")
    for low, name, number in ((3.1, "mass", 1), (1.6, "mass", 2)):
        ax.add_patch(Rectangle((-0.7, low), 1.4, 0.35, facecolor="white", edgecolor=SUPPORT))
        key(ax, (0, low + 0.175), name)
        label(ax, (-0.85, low + 0.175), f"stage {number}" + (", the head" if number == 1 else ""), ha="right")
    for bottom, top in ((1.95, 3.1), (0.45, 1.6)):
        spring(ax, (-0.35, bottom), (-0.35, top))
        damper(ax, (0.35, bottom), (0.35, top))
        key(ax, (-0.55, (bottom + top) / 2), "stiffness", ha="right")
        key(ax, (0.55, (bottom + top) / 2), "damping", ha="left")
    ground(ax, (-0.8, 0.45), (0.8, 0.45))
    label(ax, (0, 0.12), "base, moves along the track", fontsize=SMALL, color=NOTE)
    force(ax, (0, 0.95), (0, 1.58), "", (0, 0))
    label(ax, (1.0, 1.78), "uplift_force +\naerodynamic_force", color=FORCE, family="monospace",
           fontsize=USUAL - 0.5, ha="left")  # fmt: skip
    line(ax, (0.06, 1.4), (0.95, 1.72), color=FORCE, width=0.5)
    ax.set(xlim=(-2.6, 3.2), ylim=(-0.1, 4.4))


def _head_from_the_front(ax: Axes) -> None:
    ax.add_patch(Rectangle((-1.5, 2.6), 3.0, 0.18, facecolor="white", edgecolor=SUPPORT, linewidth=1.3))
    line(ax, (-1.5, 2.69), (-2.0, 2.2), width=1.3)
    line(ax, (1.5, 2.69), (2.0, 2.2), width=1.3)
    for y in (-0.95, 0.95):
        spring(ax, (y, 1.5), (y, 2.6))
    line(ax, (-1.3, 1.5), (1.3, 1.5), width=2.0)
    wire_seen_along(ax, (-0.6, 2.86), CONTACT, 0.07)
    label(ax, (-0.6, 3.05), "contact wire", color=CONTACT, fontsize=SMALL)
    line(ax, (0, 1.2), (0, 3.5), color=CENTRE_LINE, width=0.8, style=CENTRE)
    dimension(ax, (-1.5, 3.35), (1.5, 3.35), "width")
    for y in (-1.5, 1.5):
        thin(ax, (y, 2.8), (y, 3.42))
    dimension(ax, (-0.95, 1.15), (0.95, 1.15), "spring_distance", (0, 0.93))
    for y in (-0.95, 0.95):
        thin(ax, (y, 1.5), (y, 1.07))
    turn = {"arrowstyle": "<|-|>", "linewidth": THIN, "color": DIMENSION, "connectionstyle": "arc3,rad=-0.35"}
    ax.annotate("", xy=(2.25, 2.0), xytext=(2.05, 3.15), arrowprops=turn)
    key(ax, (2.3, 3.35), "roll_inertia")
    label(ax, (0, 0.3), "head, seen along the track", fontsize=8.5)
    ax.set(xlim=(-2.6, 3.2), ylim=(-0.1, 4.4))


def _head_from_the_side(ax: Axes) -> None:
    for x in (-0.75, 0.75):
        ax.add_patch(
            Rectangle((x - 0.2, 2.6), 0.4, 0.18, facecolor="white", edgecolor=SUPPORT, linewidth=1.3)
        )
        spring(ax, (x, 1.5), (x, 2.6))
    line(ax, (-1.1, 1.5), (1.1, 1.5), width=2.0)
    line(ax, (-1.5, 2.84), (1.5, 2.84), color=CONTACT, width=2.0)
    dimension(ax, (-0.75, 3.2), (0.75, 3.2), "strip_distance", (0, 3.4))
    for x in (-0.75, 0.75):
        thin(ax, (x, 2.6), (x, 3.28))
    label(ax, (0, 0.3), "strips = 2, from the side", fontsize=8.5)
    ax.set(xlim=(-1.8, 1.8), ylim=(-0.1, 4.4))


DRAWINGS: dict[str, Callable[[], Figure]] = {
    "support": support,
    "span": span,
    "steady_arm": steady_arm,
    "signs": signs,
    "pantograph": pantograph,
}
