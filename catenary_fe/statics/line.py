"""A line of several tension sections in static equilibrium: that of its sections, side by side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.contact import BaseLine
from catenary_fe.fe.joining import Joint
from catenary_fe.fe.system import System
from catenary_fe.layout import Line
from catenary_fe.layout.parameters import changed_by_copy
from catenary_fe.statics.schedules import DropperRow, SupportRow
from catenary_fe.statics.shape import HangingWire, Shape

Floats = NDArray[np.float64]


@changed_by_copy
@dataclass(frozen=True)
class LineShape(Shape):
    """A line of several sections, each in static equilibrium; nothing but pantographs connects them.

    wires : all contact wires, then all messenger wires, then all stitch wires, each section by section
    sections : the sections' own shapes, whose places count from their own first supports
    """

    catenary: Line
    sections: tuple[Shape, ...]

    @cached_property
    def joint(self) -> Joint:
        """Where the sections' wires are among those of the line."""
        return Joint([shape.mesh for shape in self.sections], self.catenary.begins)

    @cached_property
    def system(self) -> System:
        """The assembled line, from which every engine starts."""
        line = self.catenary
        base = BaseLine(line.support_positions, line.drawn_heights - line.contact_wire_height)
        return self.joint.joined([shape.system for shape in self.sections], base)

    def dropper_schedule(self) -> list[DropperRow]:
        """The table that a crew cuts and hangs the droppers by, section by section."""
        return [
            replace(row, section=n, chainage_m=row.chainage_m + begin)
            for n, shape, begin in self._numbered
            for row in shape.dropper_schedule()
        ]

    def support_schedule(self) -> list[SupportRow]:
        """The table that a crew sets the supports by, section by section."""
        return [
            replace(row, section=n, chainage_m=row.chainage_m + begin)
            for n, shape, begin in self._numbered
            for row in shape.support_schedule()
        ]

    @property
    def _numbered(self) -> list[tuple[int, Shape, float]]:
        """Each section's number, shape, and place along the line [m]."""
        numbers = range(1, len(self.sections) + 1)
        return list(zip(numbers, self.sections, self.catenary.begins, strict=True))


def join_shapes(line: Line, shapes: Sequence[Shape]) -> LineShape:
    """The line's shape from those of its sections."""
    joint = Joint([shape.mesh for shape in shapes], line.begins)
    masts = [
        line.supports_at(shape.catenary.support_positions + begin)
        for shape, begin in zip(shapes, line.begins, strict=True)
    ]
    wires = [
        [HangingWire(w.x + begin, w.y, w.z, w.dy_dx, w.dz_dx) for w in shape.wires]
        for shape, begin in zip(shapes, line.begins, strict=True)
    ]
    return LineShape(
        catenary=line,
        mesh_settings=shapes[0].mesh_settings,
        mesh=joint.mesh(),
        installation=joint.installation(
            [shape.installation for shape in shapes], masts, line.support_positions.size
        ),
        wires=tuple(joint.wires(wires)),
        dropper_forces=np.concatenate([shape.dropper_forces for shape in shapes]),
        installed_lengths=np.concatenate([shape.installed_lengths for shape in shapes]),
        sections=tuple(shapes),
    )
