"""Tension of the wires while they move."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.system import System

if TYPE_CHECKING:
    from catenary_fe.engines.history import History

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
INTERVAL = 0.05  # [s] between readings in a run: 4 m at 300 km/h


class TensionGauge:
    """Mean tension of each wire between its supports; of a stitch wire, between its clamps.

    A wave along the wire crosses a span of 60 m in 16 ms: within a span the tension is even, as far as what
    pantographs excite goes.
    """

    def __init__(self, system: System) -> None:
        nodes = system.first // (2 * system.axes)
        sections, owner = [], []
        for number, wire in enumerate(system.wires):
            starts = wire.supports[:-1] if wire.supports.size else np.array([0])
            sections.append(np.searchsorted(nodes, wire.first + starts))
            owner += [number] * starts.size
        self._sections, self._owner = np.concatenate(sections), np.array(owner)
        self._system, self._length = system, system.cables.length
        self._whole = np.add.reduceat(self._length, self._sections)

    def tensions(self, moved: Floats) -> Floats:
        """[N], shape (sections,), at displacements of shape (all,)."""
        pulls = np.concatenate(self._system.tensions(moved[: self._system.dof.size])) * self._length
        tensions: Floats = np.add.reduceat(pulls, self._sections) / self._whole
        return tensions

    def largest_change(self, now: Floats, before: Floats) -> tuple[Floats, Integers]:
        """Of the sections of each wire, the largest change over its tension before, and which section it is.

        Shape (wires,) both; sections count from 1, so that those of a whole wire are its spans.
        """
        share = np.abs(now / before - 1)
        by_wire = [share[self._owner == wire] for wire in np.unique(self._owner)]
        return np.array([own.max() for own in by_wire]), np.array([own.argmax() + 1 for own in by_wire])


class TensionRecord:
    """Readings of a gauge during a run."""

    def __init__(self, gauge: TensionGauge) -> None:
        self._gauge = gauge
        self._times: list[float] = []
        self._changes: list[Floats] = []
        self._spans: list[Integers] = []
        self._first: Floats | None = None

    def read(self, time: float, q: Floats) -> None:
        """Take the tensions at a time [s] and the system's coordinates then."""
        now = self._gauge.tensions(q)
        if self._first is None:
            self._first = now
        change, span = self._gauge.largest_change(now, self._first)
        self._changes.append(change)
        self._spans.append(span)
        self._times.append(time)

    def go_on(self, times: Floats, changes: Floats, spans: Integers) -> None:
        """Take up readings made before, the first one excepted, which is read again."""
        self._times, self._changes, self._spans = times.tolist(), list(changes.T), list(spans.T)

    def joined(self, history: History) -> History:
        """The history with what was read."""
        return replace(
            history, tension_change=self.changes, tension_span=self.spans, tension_times=self.times
        )

    @property
    def times(self) -> Floats:
        """[s], shape (readings,)."""
        return np.array(self._times)

    @property
    def changes(self) -> Floats:
        """Shape (wires, readings)."""
        return np.array(self._changes).T

    @property
    def spans(self) -> Integers:
        """Shape (wires, readings), from 1: where each wire's largest change is."""
        return np.array(self._spans).T
