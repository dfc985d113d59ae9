"""Ice on the wires."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from catenary_fe.layout.conditions.effect import Effect, Floats, OverX, WireKind, WirePart, over_x
from catenary_fe.layout.parameters import GRAVITY, Parameters, Positive


class Ice(Parameters):
    """Ice, even round the wire: its weight, its mass, and the diameter that wind then meets."""

    load: OverX
    """[N/m] weight on each wire, or a table over x: [[0, 3.5], [400, 7.5]]"""
    wires: tuple[WireKind, ...] = ("contact_wire", "messenger_wire", "stitch_wire")
    """on which"""
    density: Positive = 700.0
    """[kg/m³] of the ice, from which its thickness follows"""

    def on(self, part: WirePart) -> Floats:
        """[N/m], shape (places,)."""
        return over_x(self.load, part.x) if part.kind in self.wires else part.nothing[0]


@dataclass(frozen=True)
class IceMass(Effect):
    """What the ice weighs and how it moves with the wires."""

    ice: Ice

    def mass(self, part: WirePart) -> Floats:
        """[kg/m], shape (places,)."""
        return self.ice.on(part) / GRAVITY


def iced_diameter(ice: Ice | None, part: WirePart) -> Floats:
    """[m], shape (places,), outside."""
    section = part.diameter**2 + part.nothing[0]
    if ice:
        section += 4 * ice.on(part) / (np.pi * ice.density * GRAVITY)
    outside: Floats = np.sqrt(section)
    return outside
