"""Wires as pictures draw them: as they hang, or sketched where that is not known."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.layout import GRAVITY, Catenary
from catenary_fe.statics import Shape
from catenary_fe.views.stretch import Stretch
from catenary_fe.views.style import wire_colour

Floats = NDArray[np.float64]
_WIDTHS = {"stitch wire": 1.2}  # others 1.6


@dataclass(frozen=True)
class Line:
    """A wire as it is drawn: coordinates [m] of shape (points,), and its name."""

    x: Floats
    y: Floats
    z: Floats
    name: str

    @property
    def colour(self) -> str:
        """Of its kind of wire."""
        return wire_colour(self.name)

    @property
    def width(self) -> float:
        """[pt]"""
        return _WIDTHS.get(self.name, 1.6)

    def height(self, x: Floats) -> Floats:
        """[m] at positions x [m] along the line."""
        return np.asarray(np.interp(x, self.x, self.z))


def hanging_lines(shape: Shape, part: Stretch) -> list[Line]:
    """All wires as they hang in a stretch, in the order of the mesh: cubic between the nodes."""
    lines = []
    for wire, name in zip(shape.wires, _names(shape.catenary), strict=True):
        x = part.sampled(wire.x)
        empty = np.array([])
        lines.append(
            Line(x, wire.lateral(x), wire.height(x), name) if x.size else Line(x, empty, empty, name)
        )
    return lines


def sketched_lines(catenary: Catenary, part: Stretch) -> list[Line]:
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
    lines = []
    for (at, high), name in zip(points, _names(catenary), strict=True):
        shown = part.sampled(at)
        lines.append(Line(shown, np.zeros_like(shown), np.interp(shown, at, high), name))
    return lines


def _names(catenary: Catenary) -> list[str]:
    """Of each wire, in the order of the mesh."""
    contact = ["contact wire"] * len(catenary.contact_wire_offsets)
    return [*contact, "messenger wire", *["stitch wire"] * len(catenary.stitched_supports)]


def upper_wires(catenary: Catenary, shape: Shape | None) -> NDArray[np.int64]:
    """Shape (droppers,): number of the wire that each dropper hangs on, in the order of the mesh."""
    if shape is not None:
        return shape.mesh.upper.wire
    at = catenary.dropper_positions
    wires = np.full(at.size, len(catenary.contact_wire_offsets))
    if catenary.stitch_wire:
        for i, support in enumerate(catenary.stitched_supports, start=1):
            near = np.abs(catenary.support_positions[support] - at) < catenary.stitch_wire.length / 2
            wires[near] = len(catenary.contact_wire_offsets) + i
    return wires


def draw_lines(ax: Axes, lines: list[Line], axis: str) -> None:
    """Draw wires against their heights, "z", or their places sideways, "y"; each kind is named once."""
    named: set[str] = set()
    for line in reversed(lines):
        if line.x.size:
            label = None if line.name in named else line.name
            ax.plot(line.x, getattr(line, axis), color=line.colour, linewidth=line.width, label=label)
            named.add(line.name)
