"""Wires that are warmer or colder than when they were hung."""

from __future__ import annotations

from dataclasses import dataclass

from catenary_fe.layout.conditions.effect import Effect, Floats, NumberOrTable, WirePart, over_x


@dataclass(frozen=True)
class Warming(Effect):
    """Lengthening by temperature.

    temperature : [°C], a number or a table over x
    installed : [°C] at which the line was hung
    """

    temperature: NumberOrTable
    installed: float

    def strain(self, part: WirePart) -> Floats:
        """[1], shape (places,)."""
        return part.wire.thermal_expansion * (over_x(self.temperature, part.x) - self.installed)
