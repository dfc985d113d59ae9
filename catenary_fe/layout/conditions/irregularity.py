"""A contact wire whose running surface is not even."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Self

import numpy as np
from pydantic import Field, model_validator

from catenary_fe.layout.conditions.effect import Effect, Floats, SurfaceOverX, WirePart, over_x
from catenary_fe.layout.parameters import Parameters

WAVES = 400  # of a surface drawn by chance
Wave = Annotated[float, Field(strict=True, ge=0.5, le=1000)]


class ContactWireIrregularity(Parameters):
    """By how much the running surface lies above the wire's line: a table over x, or drawn by chance.

    What pantographs meet beside sag and waves: bends, kinks, wear. One that is drawn has as much of each wave
    number between the longest and the shortest wave; that is assumed, no measured spectrum was found.
    """

    height: SurfaceOverX | None = None
    """[m] above the wire's line, over x: [[0, 0.0], [0.5, 0.001], [1, 0.0]]"""
    deviation: Annotated[float, Field(strict=True, gt=0, le=0.1)] | None = None
    """[m] standard deviation of a surface drawn by chance"""
    shortest_wave: Wave = 0.5
    """[m] of a surface drawn by chance"""
    longest_wave: Wave = 30.0
    """[m] of a surface drawn by chance"""
    seed: Annotated[int, Field(strict=True, ge=0)] = 1
    """of the random numbers: the same seed, the same surface"""

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        if (self.height is None) == (self.deviation is None):
            raise ValueError("give either height, a table over x, or deviation, of a surface drawn by chance")
        if self.height is not None:
            for name in ("shortest_wave", "longest_wave", "seed"):
                if name in self.model_fields_set:
                    raise ValueError(f"{name} has no effect beside height; leave it out")
        check_waves(self.shortest_wave, self.longest_wave)
        return self

    def at(self, x: Floats) -> Floats:
        """[m], shape of x."""
        if self.height is not None:
            return over_x(self.height, x)
        assert self.deviation is not None
        rng = np.random.default_rng(self.seed)
        return drawn_waves(x, self.deviation, self.shortest_wave, self.longest_wave, rng)


def check_waves(shortest: float, longest: float) -> None:
    """Raises ValueError where two wavelengths [m] are not in order."""
    if shortest >= longest:
        raise ValueError(f"shortest_wave = {shortest:g} m is not shorter than longest_wave = {longest:g} m")


def drawn_waves(
    x: Floats, deviation: float, shortest: float, longest: float, rng: np.random.Generator
) -> Floats:
    """Shape of x [m]: waves between two lengths [m], as much of each wave number, phases by chance."""
    numbers = 2 * np.pi * np.linspace(1 / longest, 1 / shortest, WAVES)
    found: Floats = np.zeros(x.shape)
    for number, phase in zip(numbers, rng.uniform(0, 2 * np.pi, WAVES), strict=True):
        found += np.cos(number * x + phase)
    found *= deviation * np.sqrt(2 / WAVES)
    return found


@dataclass(frozen=True)
class UnevenSurface(Effect):
    """The same on all contact wires."""

    given: ContactWireIrregularity

    def irregularity(self, part: WirePart) -> Floats:
        """[m], shape (places,)."""
        return self.given.at(part.x)
