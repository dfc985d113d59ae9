"""A record of wind: speeds over time at stations along the line."""

from __future__ import annotations

from typing import Any

import numpy as np
from pydantic import PlainValidator, WithJsonSchema

from catenary_fe.layout.conditions.effect import (
    Floats,
    Table,
    number_between,
    schema_over_x,
    table_over_x,
)
from catenary_fe.layout.parameters import LARGEST, shorten

FASTEST = 100.0  # [m/s]
Rows = tuple[tuple[float, float, float], ...]


class WindRecord:
    """Straight in time at each station, and between stations; the same beyond the first and the last one.

    rows : time [s], place [m] and speed [m/s], in any order of the stations

    x : [m], shape (stations,)
    begin, end : [s], between which all stations have speeds
    means : [m/s], shape (stations,), over that time

    Raises ValueError for times of a station that do not rise, and for stations with no time in common.
    """

    def __init__(self, rows: Rows) -> None:
        self._series: list[Floats] = []
        given = np.array(rows)
        self.x: Floats = np.unique(given[:, 1])
        for x in self.x:
            series = given[given[:, 1] == x][:, [0, 2]]
            steps = np.diff(series[:, 0])
            if not steps.size or steps.min() <= 0:
                raise ValueError(f"at x = {x:g} m: must have at least two times, in order")
            self._series.append(series)
        self.begin = float(max(series[0, 0] for series in self._series))
        self.end = float(min(series[-1, 0] for series in self._series))
        if self.end <= self.begin:
            raise ValueError(
                f"one station begins at {self.begin:g} s, another ends at {self.end:g} s: must have a time in"
                " common"
            )
        self.means: Floats = np.array([self._mean(series) for series in self._series])

    def _mean(self, series: Floats) -> float:
        inside = (series[:, 0] > self.begin) & (series[:, 0] < self.end)
        times = np.array([self.begin, *series[inside, 0], self.end])
        return float(np.trapezoid(np.interp(times, *series.T), times) / (self.end - self.begin))

    @property
    def steady(self) -> Table:
        """The means [m/s] as a table over x [m]."""
        return tuple(zip(self.x.tolist(), self.means.tolist(), strict=True))

    def at(self, station: int, times: Floats) -> Floats:
        """[m/s], shape (times,), from the time on at which all stations have begun."""
        speeds: Floats = np.interp(self.begin + times, *self._series[station].T)
        return speeds

    def shares(self, x: Floats) -> Floats:
        """Shape (stations, places): by which the stations' speeds make up those at places [m]."""
        return np.array([np.interp(x, self.x, row) for row in np.eye(self.x.size)])


def _speed(value: Any) -> float | Table | Rows:
    """A number, a table over x, or rows of time, place and speed."""
    if not (isinstance(value, (list, tuple)) and value and _is_row(value[0])):
        return table_over_x(value, 0.0, FASTEST)
    rows = []
    for n, row in enumerate(value, start=1):
        if not _is_row(row):
            raise ValueError(f"entry {n}: {shorten(row)}: must be a row [time, x, speed], as the first one")
        time, x = (
            number_between(v, -LARGEST, LARGEST, f"entry {n}: {name} ")
            for v, name in zip(row, ("time", "x"), strict=False)
        )
        rows.append((time, x, number_between(row[2], 0.0, FASTEST, f"entry {n}: speed ")))
    WindRecord(tuple(rows))
    return tuple(rows)


def _is_row(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(value) == 3


_ROW = {
    "type": "array",
    "prefixItems": [{"type": "number"}] * 2 + [{"type": "number", "minimum": 0.0, "maximum": FASTEST}],
    "minItems": 3,
    "maxItems": 3,
}
SPEED = (
    PlainValidator(_speed),
    WithJsonSchema(schema_over_x(0.0, FASTEST, {"type": "array", "items": _ROW})),
)
