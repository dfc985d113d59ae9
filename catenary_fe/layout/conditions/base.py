"""How the bases of pantographs, the roofs of their vehicles, move up and down in runs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, PlainValidator, WithJsonSchema, model_validator

from catenary_fe.layout.conditions.effect import (
    A_FILE,
    AS_IT_IS,
    BaseOverX,
    BaseSignal,
    Effect,
    Floats,
    Table,
    over_x,
    pairs_in_order,
    schema_of_pairs,
)
from catenary_fe.layout.conditions.irregularity import check_waves
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.parameters import Parameters

MOST = 0.5  # [m]
WAVES = 400  # of a track drawn by chance
RUN_UP = 10.0  # of the time in which a vehicle's own motion falls to 1/e
_A_V = {"low disturbance": 4.032e-7, "high disturbance": 1.080e-6}  # [m rad]
_OMEGA_C, _OMEGA_R = 0.8246, 0.0206  # [rad/m]
Wave = Annotated[float, Field(strict=True, ge=1.0, le=300.0)]
OverTime = Annotated[
    Table,
    AS_IT_IS,
    PlainValidator(lambda value: pairs_in_order(value, -MOST, MOST, "time", "s")),
    WithJsonSchema({"anyOf": [schema_of_pairs(-MOST, MOST), A_FILE]}),
]


class VehicleSuspension(Parameters):
    """One mass on a spring and a damper, which the track moves: what it passes on is the base's motion."""

    frequency: Annotated[float, Field(strict=True, ge=0.2, le=20.0)] = 1.0
    """[Hz] of the mass on its spring, undamped; 1 of a coach (assumed)"""
    damping_ratio: Annotated[float, Field(strict=True, ge=0.02, le=2.0)] = 0.2
    """[1] of the critical damping; 0.2 of a coach (assumed)"""

    @property
    def run_up(self) -> float:
        """[s] after which it has forgotten how it began."""
        slowest = min(self.damping_ratio, 0.5 / self.damping_ratio)
        return RUN_UP / (2 * np.pi * self.frequency * slowest)

    def passed_on(self, track: Floats, step: float) -> Floats:
        """[m], shape (times,): the mass's heights, at rest at first; exact for a track straight in a step."""
        from scipy.signal import cont2discrete, lfilter

        omega = 2 * np.pi * self.frequency
        damper = 2 * self.damping_ratio * omega
        above, below, _ = cont2discrete(([damper, omega**2], [1.0, damper, omega**2]), step, method="foh")
        found: Floats = track[0] + lfilter(above[0], below, track - track[0])
        return found


class BaseMotion(Parameters):
    """Vertical motion of the pantographs' bases: over x, over time, or of a track drawn by chance.

    It acts through spring and damper of the lowest stage, whatever the base's design height follows; the law
    of an elastic pantograph sees elevations above the moved base. Runs begin at rest, on bases that are where
    they are then. All vehicles are alike.
    """

    height: BaseOverX | None = None
    """[m] over x: [[0, 0.0], [10, 0.004], [20, 0.0]]"""
    height_over_time: OverTime | None = None
    """[m] over the time [s]: [[0, 0.0], [0.5, 0.004], [1, 0.0]], from whose first time on a run begins; the
    same under all pantographs"""
    track: Literal["low disturbance", "high disturbance"] | None = None
    """drawn by chance, of the spectrum of German track, A Ωc² / ((Ω² + Ωr²) (Ω² + Ωc²)) (recalled)"""
    shortest_wave: Wave = 3.0
    """[m] of a track drawn by chance; 3 to 150 are the ranges D1 to D3 of EN 13848-1 (recalled)"""
    longest_wave: Wave = 150.0
    """[m] of a track drawn by chance"""
    seed: Annotated[int, Field(strict=True, ge=0)] = 1
    """of the random numbers: the same seed, the same track"""
    suspension: VehicleSuspension | None = None
    """of the vehicle, through which heights of the track become the base's; unset: they are the base's"""

    @model_validator(mode="after")
    def _one_kind(self) -> Self:
        given = [n for n in ("height", "height_over_time", "track") if getattr(self, n) is not None]
        if len(given) != 1:
            raise ValueError("give one of height, height_over_time and track")
        if self.track is None:
            for name in ("shortest_wave", "longest_wave", "seed"):
                if name in self.model_fields_set:
                    raise ValueError(f"{name} has no effect beside {given[0]}; leave it out")
        check_waves(self.shortest_wave, self.longest_wave)
        return self

    def at(self, start: float, speed: float, times: Floats) -> Floats:
        """[m], shape (times,): heights of a base that starts at a place [m] at a speed [m/s].

        times : [s] from the start on, evenly spaced

        Raises InputError for times beyond a table of them.
        """
        if not self.suspension:
            return self._given(start, speed, times)
        step = float(times[1] - times[0])
        early = int(np.ceil(self.suspension.run_up / step))
        before = times[0] - step * np.arange(early, 0, -1)
        track = self._given(start, speed, np.concatenate([before, times]))
        return self.suspension.passed_on(track, step)[early:]

    def _given(self, start: float, speed: float, times: Floats) -> Floats:
        if self.height is not None:
            return over_x(self.height, start + speed * times)
        if self.height_over_time is not None:
            first, last = self.height_over_time[0][0], self.height_over_time[-1][0]
            if times.max(initial=0.0) > last - first + 1e-9:
                raise InputError(
                    f"base.height_over_time: it has {last - first:g} s, and the run lasts longer; give more"
                    " of it, or run a shorter way"
                )
            return over_x(self.height_over_time, first + times)
        return self.track_height(start + speed * times)

    def track_height(self, x: Floats) -> Floats:
        """[m], shape of x: of the track that is drawn by chance."""
        assert self.track
        ends = np.geomspace(2 * np.pi / self.longest_wave, 2 * np.pi / self.shortest_wave, WAVES + 1)
        numbers = np.sqrt(ends[1:] * ends[:-1])
        spectrum = _A_V[self.track] * _OMEGA_C**2 / ((numbers**2 + _OMEGA_R**2) * (numbers**2 + _OMEGA_C**2))
        phases = np.random.default_rng(self.seed).uniform(0, 2 * np.pi, WAVES)
        found: Floats = np.zeros(x.shape)
        for number, height, phase in zip(numbers, np.sqrt(2 * spectrum * np.diff(ends)), phases, strict=True):
            found += height * np.cos(number * x + phase)
        return found


@dataclass(frozen=True)
class MovingBase(Effect):
    """The bases of all pantographs."""

    given: BaseMotion

    def base_motion(self) -> BaseSignal:
        """Heights [m] from start [m], speed [m/s] and times [s]."""
        return self.given.at
