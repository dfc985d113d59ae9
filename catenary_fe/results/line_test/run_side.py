"""A run's side of a comparison with a line test: what of it is compared, and where passes belong on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.results.line_test.comparison import PlacedPass
from catenary_fe.results.line_test.record import LineTest
from catenary_fe.results.line_test.signals import EvenPass, Place, correlation_at, find_place
from catenary_fe.results.run import Run
from catenary_fe.results.signal import FilterKind, high_pass, low_pass, spectrum
from catenary_fe.results.statistics import ForceStatistics, force_statistics

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]
_MARGIN = 0.5  # [m] that a span may lack at its ends: the first and last samples never lie at supports


class RunSide:
    """The run's side of a comparison.

    x : [m], shape (times,), of its pantograph
    supports : [m]
    """

    def __init__(self, run: Run, pantograph: int, filter: FilterKind) -> None:
        self.run, self.pantograph, self.filter = run, pantograph, filter
        self.window = run.window(pantograph)
        self.x = np.asarray(run.data["position"].values[pantograph])
        self.supports = np.asarray(run.data["support_position"].values)
        self.values = {
            "force": np.asarray(run.data["contact_force"].values[pantograph]),
            "height": np.asarray(run.data["wire_height"].values[pantograph]),
        }
        spans = run.evaluated_spans
        self.first, self.last = float(self.supports[min(spans) - 1]), float(self.supports[max(spans)])

    def place_of(self, one: EvenPass, shift: float | None) -> Place:
        """Where a pass belongs: as given, or where it correlates best. Raises InputError."""
        name = "force" if "force" in one.values else "height"
        inside = (self.x >= self.first) & (self.x <= self.last)
        x, values = self.x[inside], low_pass(self.values[name], self.run.step, kind=self.filter)[inside]
        if shift is not None:
            return Place(shift, correlation_at(x, values, one, name, shift))
        return find_place(x, values, one, name, float(np.diff(self.supports).mean()) / 2)

    def common_range(self, even: Sequence[EvenPass], places: Sequence[Place]) -> tuple[float, float]:
        """[m] from where to where all passes and the evaluated spans reach. Raises InputError."""
        if not even:
            return 0.0, 0.0
        ends = [(one.x[0] + p.shift, one.x[-1] + p.shift) for one, p in zip(even, places, strict=True)]
        begin = max(self.first, *(float(e[0]) for e in ends))
        end = min(self.last, *(float(e[1]) for e in ends))
        if end - begin < float(np.diff(self.supports).min()):
            each = (f"{one.name} {a:.1f} to {b:.1f} m" for one, (a, b) in zip(even, ends, strict=True))
            raise InputError(
                f"less than a span to compare: the run is evaluated from {self.first:g} to {self.last:g} m of"
                f" the line, and with its shift there is: {', '.join(each)}; look at the shift, or evaluate"
                " other spans"
            )
        for one, place in zip(even, places, strict=True):
            one.check_gaps(begin, end, place.shift)
        return begin, end

    def inside(self, x: Floats, begin: float, end: float, spans: Sequence[int] | None = None) -> Bools:
        """Shape of ``x``: what lies in the range and in these spans, or the evaluated ones."""
        found = np.zeros(x.size, dtype=bool)
        for n in spans or self.run.evaluated_spans:
            found |= (x >= self.supports[n - 1]) & (x <= self.supports[n])
        return found & (x >= begin - 1e-9) & (x <= end + 1e-9)

    def spans_in(self, begin: float, end: float) -> list[int]:
        """Evaluated spans that lie in the range as a whole."""
        return [
            n
            for n in sorted(set(self.run.evaluated_spans))
            if self.supports[n - 1] >= begin - _MARGIN and self.supports[n] <= end + _MARGIN
        ]

    def statistics(self, begin: float, end: float, spans: Sequence[int] | None = None) -> ForceStatistics:
        """Of the run over what is compared."""
        return force_statistics(
            name=str(self.run.data["pantograph"].values[self.pantograph]),
            force=self.values["force"],
            height=self.values["height"],
            inside=self.inside(self.x, begin, end, spans),
            step=self.run.step,
            filter=self.filter,
        )

    def by_span(self, begin: float, end: float) -> dict[int, ForceStatistics]:
        """Of the run by span."""
        return {n: self.statistics(begin, end, [n]) for n in self.spans_in(begin, end)}

    def height_range(self, begin: float, end: float) -> float:
        """[m] of the run's point of contact, filtered."""
        height = low_pass(self.values["height"], self.run.step, kind=self.filter)
        return float(np.ptp(height[self.inside(self.x, begin, end)]))

    def spectrum(self, begin: float, end: float) -> tuple[Floats, Floats]:
        """[Hz] and [N] of the run's unfiltered force."""
        return spectrum(self.values["force"][self.inside(self.x, begin, end)], self.run.step)

    def placed(self, one: EvenPass, place: Place, begin: float, end: float, is_filtered: bool) -> PlacedPass:
        """A pass with its statistics over what is compared."""
        x = one.x + place.shift
        inside = self.inside(x, begin, end)
        force, height = one.filtered.get("force"), one.filtered.get("height")

        def figures(spans: Sequence[int] | None) -> ForceStatistics:
            return self._measured(one, self.inside(x, begin, end, spans), is_filtered)

        return PlacedPass(
            name=one.name,
            place=place,
            x=x,
            force=force,
            height=height,
            inside=inside,
            statistics=figures(None) if force is not None else None,
            by_span={n: figures([n]) for n in self.spans_in(begin, end)} if force is not None else {},
            height_range=float(np.ptp(height[inside])) if height is not None else None,
            spectrum=spectrum(one.values["force"][inside], one.step) if force is not None else None,
            rate=one.rate,
            speed=float(one.speed[inside].mean()),
        )

    def _measured(self, one: EvenPass, inside: Bools, is_filtered: bool) -> ForceStatistics:
        raw = one.values["force"]
        found = force_statistics(
            name=one.name, force=raw, height=np.zeros(raw.size), inside=inside, step=one.step,
            filter=self.filter,
        )  # fmt: skip
        if not is_filtered:
            return found
        own = raw[inside]
        mean, std = float(own.mean()), float(own.std())
        above_5 = high_pass(raw, one.step, 5.0, kind=self.filter)[inside]
        return replace(
            found,
            mean=mean,
            std=std,
            std_5_20=float(above_5.std()),
            statistical_max=mean + 3 * std,
            statistical_min=mean - 3 * std,
            max=float(own.max()),
            min=float(own.min()),
        )

    def uplifts(self, test: LineTest, notes: list[str]) -> dict[int, tuple[float, float]]:
        """[m] of run and measurement by support; notes on supports that are left out."""
        largest: dict[int, float] = {}
        for one in test.passes:
            for n, values in one.uplift.items():
                largest[n] = max(largest.get(n, -np.inf), float(values.max()))
        own = self.run.uplift_by_support()
        if others := [n for n in sorted(largest) if n not in own]:
            listed = ", ".join(map(str, others))
            notes.append(f"uplift of support {listed}: left out, not of the run's evaluated spans")
        return {n: (own[n], largest[n]) for n in sorted(largest) if n in own}

    def notes_on(self, passes: Sequence[PlacedPass], begin: float, end: float) -> list[str]:
        """How much is compared, and where each pass was put."""
        if not passes:
            return []
        numbers = np.array(sorted(set(self.run.evaluated_spans)))
        starts, ends = self.supports[numbers - 1], self.supports[numbers]
        length = float((np.minimum(ends, end) - np.maximum(starts, begin)).clip(0).sum())
        total = float((ends - starts).sum())
        spans = self.spans_in(begin, end)
        said = [
            f"compared: {length:.1f} m of the {total:g} m that the run evaluates, from {begin:.1f} to"
            f" {end:.1f} m, {len(spans)} whole spans"
        ]
        for p in passes:
            r = "–" if p.place.correlation is None else f"{p.place.correlation:.3f}"
            said.append(f"{p.name}: shift {p.place.shift:.2f} m, correlation {r}")
        return said
