"""Gusts: wind that varies in time and along the line, on top of the steady one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from catenary_fe.layout.conditions.effect import Effect, Floats, Signal, WirePart, over_x
from catenary_fe.layout.conditions.ice import Ice
from catenary_fe.layout.conditions.wind import Wind
from catenary_fe.layout.errors import InputError
from catenary_fe.theory import GustField, generate_gusts
from catenary_fe.theory import Gusts as GustStatistics

CUT_OFF = 5.0  # [Hz] of the gusts; wires swing at 1 Hz
BETWEEN = 5.0  # [m] between places whose gusts are loads of their own
FINE = 5  # places of the field from one of these to the next, over which its mean is taken


class _History:
    """One field of gusts on all wires of a line, made when it is first asked for.

    Each load is a tent over two lengths of ``BETWEEN``, and its gust the mean of the field under it: what is
    finer than the tents would count too much if it were taken at their tops alone.
    """

    def __init__(self, gusts: GustStatistics, seed: int, duration: float) -> None:
        self._gusts, self._seed, self._duration = gusts, seed, duration
        self._first, self._last = np.inf, -np.inf
        self._field: GustField | None = None
        self._now: tuple[bytes, Floats] | None = None
        self._signals: dict[int, Signal] = {}

    def signal(self, place: int) -> Signal:
        """The gust [m/s] under a tent by its number, over times."""
        self._first, self._last = min(self._first, place), max(self._last, place)
        if place not in self._signals:
            self._signals[place] = lambda times: self._at(times)[place - int(self._first)]
        return self._signals[place]

    def _at(self, times: Floats) -> Floats:
        """[m/s], shape (tents, times); the same times are asked for tent by tent."""
        if np.max(times, initial=0.0) > self._duration:
            raise InputError(
                f"wind.gusts: duration = {self._duration:g} s, and the run lasts longer; give more seconds"
            )
        key = times.tobytes()
        if self._now is None or self._now[0] != key:
            self._now = key, self._means(self._whole.at(times))
        return self._now[1]

    @property
    def _whole(self) -> GustField:
        if self._field is None:
            first, last = FINE * (int(self._first) - 1), FINE * (int(self._last) + 1)
            stations = BETWEEN / FINE * np.arange(first, last + 1)
            self._field = generate_gusts(
                self._gusts, stations, duration=self._duration, seed=self._seed, cut_off=CUT_OFF
            )
        return self._field

    def _means(self, fine: Floats) -> Floats:
        weights = 1.0 - np.abs(np.arange(1 - FINE, FINE)) / FINE
        windows = np.lib.stride_tricks.sliding_window_view(fine[1:-1], 2 * FINE - 1, axis=0)[::FINE]
        means: Floats = windows @ weights / weights.sum()
        return means


@dataclass(frozen=True)
class GustLoads(Effect):
    """The drag of gusts, linear in them: 2 k U u, as they are small beside the wind."""

    wind: Wind
    ice: Ice | None = None
    _history: list[_History] = field(default_factory=list)

    def in_time(self, part: WirePart) -> Sequence[tuple[Floats, Signal]]:
        """Loads [N/m], shape (3, places), each with its gust."""
        history, mean = self._field(), self._mean
        steady = self.wind.across(part.x)
        slope = 2 * self.wind.resistance(part, self.ice) * np.abs(steady)
        slope = slope * over_x(self.wind.steady, part.x) / mean * self.wind.across_share
        first, last = int(np.floor(part.x[0] / BETWEEN)), int(np.ceil(part.x[-1] / BETWEEN))
        found = []
        for place in range(first, last + 1):
            tent = np.maximum(1.0 - np.abs(part.x / BETWEEN - place), 0.0)
            load = part.nothing
            load[1] = tent * slope
            if load.any():
                found.append((load, history.signal(place)))
        return found

    @property
    def _mean(self) -> float:
        """[m/s] that the field is made for; where the wind is stronger its gusts are, too."""
        speed = self.wind.steady
        return float(np.mean([v for _, v in speed]) if isinstance(speed, tuple) else speed)

    def _field(self) -> _History:
        if not self._history:
            given = self.wind.gusts
            assert given is not None
            statistics = GustStatistics(
                mean_speed=self._mean,
                intensity=given.intensity,
                length_scale=given.length_scale,
                decay=given.decay,
            )
            self._history.append(_History(statistics, given.seed, given.duration))
        return self._history[0]
