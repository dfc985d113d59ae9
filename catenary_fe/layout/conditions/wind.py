"""Wind on the wires: drag across the line, and how it damps them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Annotated, Self, cast

import numpy as np
from pydantic import Field, model_validator

from catenary_fe.layout.conditions.effect import AS_IT_IS, Effect, Floats, NumberOrTable, WirePart, over_x
from catenary_fe.layout.conditions.ice import Ice, iced_diameter
from catenary_fe.layout.conditions.wind_record import SPEED, Rows, WindRecord
from catenary_fe.layout.parameters import NonNegative, Parameters, Positive


class Gusts(Parameters):
    """Gusts in time and along the line: von Kármán's spectrum, Davenport's coherence (`theory.Gusts`)."""

    intensity: Annotated[float, Field(strict=True, gt=0, le=1)]
    """[1] standard deviation over the mean speed; 0.16 in open country"""
    length_scale: Positive
    """[m] of the gusts along the wind; 80 near the ground"""
    decay: NonNegative = 10.0
    """[1] of the coherence along the line: 10 is a value for design, measured ones are from 7 to 50"""
    seed: Annotated[int, Field(strict=True, ge=0)] = 1
    """of the random numbers: the same seed, the same gusts"""
    duration: Annotated[float, Field(strict=True, gt=0, le=3600)] = 120.0
    """[s] of the history; a run that lasts longer is refused"""


Direction = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=-360, le=360)]


class Wind(Parameters):
    """Wind, level; what blows along the line does nothing.

    Its drag on a wire is ½ ρ v² C G d a metre, v across the line, d the wire's diameter, with ice on it if
    there is any (Kießling, Puschmann, Schmieder: Contact Lines for Electric Railways; EN 50119).
    """

    speed: Annotated[NumberOrTable | Rows, AS_IT_IS, *SPEED]
    """[m/s] at the wires, or a table over x: [[0, 20], [300, 29]]; or as it was measured, rows of a time [s],
    a place x [m] and the speed there, whose mean is the steady wind, and from whose first time runs begin"""
    direction: Direction = 90.0
    """[°] to which it blows from the line's direction: 90: from the right to the left; -90: to the right"""
    air_density: Positive = 1.25
    """[kg/m³] of the air"""
    drag_coefficient: Positive = 1.0
    """[1] of a wire"""
    span_factor: Annotated[float, Field(strict=True, gt=0, le=1)] = 1.0
    """[1] of the load, where the speed is that of gusts shorter than a span; 0.75 on tensioned wires"""
    gusts: Gusts | None = None
    """in runs, which then begin with the wires at rest in the first gust; unset: steady wind"""

    @model_validator(mode="after")
    def _vary_once(self) -> Self:
        if self.record and self.gusts:
            raise ValueError("gusts beside a speed measured over time: both vary the wind; leave out one")
        return self

    @cached_property
    def record(self) -> WindRecord | None:
        """Of a speed measured over time; else none."""
        speed = self.speed
        return WindRecord(speed) if isinstance(speed, tuple) and len(speed[0]) == 3 else None

    @property
    def steady(self) -> NumberOrTable:
        """[m/s], or a table over x: the mean over time."""
        return self.record.steady if self.record else cast(NumberOrTable, self.speed)

    @property
    def across_share(self) -> float:
        """[1] of the speed that blows to the left."""
        return float(np.sin(np.radians(self.direction)))

    @property
    def blows(self) -> bool:
        """Whether it does anything to the wires."""
        steady = self.steady
        values = [v for _, v in steady] if isinstance(steady, tuple) else [steady]
        return bool(max(values) > 0 and abs(self.across_share) > 1e-9)

    def across(self, x: Floats) -> Floats:
        """[m/s], shape of x: to the left."""
        return over_x(self.steady, x) * self.across_share

    def resistance(self, part: WirePart, ice: Ice | None) -> Floats:
        """[N s²/m³], shape (places,): drag a metre over the speed's square."""
        per_diameter = 0.5 * self.air_density * self.drag_coefficient * self.span_factor
        return per_diameter * iced_diameter(ice, part)


@dataclass(frozen=True)
class Drag(Effect):
    """Steady wind: drag, and that wires which move through it are damped (quasi-steady).

    A wire that moves with v feels the wind without v: drag falls by 2 k u v to the side, k u v up and down.
    """

    wind: Wind
    ice: Ice | None = None

    def load(self, part: WirePart) -> Floats:
        """[N/m], shape (3, places)."""
        found, across = part.nothing, self.wind.across(part.x)
        found[1] = self.wind.resistance(part, self.ice) * np.abs(across) * across
        return found

    def damping(self, part: WirePart) -> Floats:
        """[N s/m²], shape (3, places)."""
        found, across = part.nothing, np.abs(self.wind.across(part.x))
        drag = self.wind.resistance(part, self.ice) * across
        found[1], found[2] = 2 * drag, drag
        return found
