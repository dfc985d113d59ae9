"""Measured histories at even times, filtered as a run's are, and where along the run's line they belong."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import number
from catenary_fe.results.line_test.record import MeasuredPass
from catenary_fe.results.signal import CUT_OFF, FilterKind, low_pass

Floats = NDArray[np.float64]

LEAST_RATE = 2.5 * CUT_OFF  # [Hz] fewer samples do not hold what the filter lets through
USUAL_RATE, USUAL_DISTANCE = 200.0, 0.40  # [Hz], [m]: EN 50317 asks for one of them (recalled)
LONGEST_GAP = 0.5 / CUT_OFF  # [s] between rows, over which a curve may be drawn
BEFORE = 0.5  # [s] whose gaps still matter: the filter remembers them
LEAST_CORRELATION = 0.5  # below it no place is found
ALIKE = 0.05  # by which the correlation must fall off elsewhere, for a place to be the only one
LEAST_OVERLAP = 0.5  # of the shorter of the two, over which places are tried
_EVEN = 0.2  # of a step, by which rounded times may be off even ones
_GRID = 0.1  # [m] of the correlation
_MOST_POINTS = 4_000_000


@dataclass(frozen=True)
class EvenPass:
    """A pass at even times.

    name : of the pass
    step : [s]
    x : [m], shape (times,), along the way of the train, not yet shifted
    values : by "force" [N] and "height" [m], shape (times,), unfiltered
    filtered : likewise, low-passed at 20 Hz
    speed : [m/s], shape (times,)
    gaps : [m] and [s], of each pair of rows: the place of the first, and the time between them
    notes : on what was assumed
    """

    name: str
    step: float
    x: Floats
    values: Mapping[str, Floats]
    filtered: Mapping[str, Floats]
    speed: Floats
    gaps: tuple[Floats, Floats]
    notes: tuple[str, ...]

    @property
    def rate(self) -> float:
        """[Hz]"""
        return 1 / self.step

    def check_gaps(self, begin: float, end: float, shift: float) -> None:
        """Raises InputError where rows between two places of the line [m] are too far apart."""
        at, gap = self.gaps
        before = BEFORE * float(self.speed.mean())
        inside = (at + shift >= begin - before) & (at + shift <= end)
        wide = np.flatnonzero(inside & (gap > LONGEST_GAP * (1 + 1e-6)))
        if wide.size:
            i = int(wide[0])
            more = f", and {wide.size - 1} more" if wide.size > 1 else ""
            raise InputError(
                f"{self.name}: {gap[i]:.3g} s without a row at {at[i] + shift:.1f} m of the line{more}: at"
                f" most {LONGEST_GAP:g} s; compare other spans, or split the measurement there"
            )

    def without_gaps(self, x: Floats) -> NDArray[np.bool_]:
        """Shape of ``x`` [m], along the way, not shifted: where rows are close, and were shortly before."""
        at, gap = self.gaps
        counts = np.ones(x.size, dtype=bool)
        for i in np.flatnonzero(gap > LONGEST_GAP * (1 + 1e-6)):
            counts &= (x < at[i]) | (x > at[i] + (gap[i] + BEFORE) * float(self.speed.mean()))
        return counts


def even_pass(
    one: MeasuredPass, *, speed: float | None, run_speed: float, filter: FilterKind, is_filtered: bool
) -> EvenPass:
    """A pass at even times, which are its own where those are even.

    speed : [m/s] of the train, where the pass does not say it; unset: the run's, which is noted
    is_filtered : whether it was low-passed at 20 Hz when it was measured

    Raises InputError where it says its speed itself, and for fewer than 50 samples a second.
    """
    t, x, notes = _axes(one, speed, run_speed)
    gaps = np.diff(t)
    median, apart = float(np.median(gaps)), float(np.median(np.diff(x)))
    if 1 / median < LEAST_RATE * (1 - 1e-6):
        raise InputError(
            f"{one.name}: {1 / median:.3g} samples a second ({apart:.3g} m apart): the filter of {CUT_OFF:g}"
            f" Hz needs at least {LEAST_RATE:g}; measure more finely, or look at the unit of position or time"
        )
    signals = {n: v for n in ("force", "height") if (v := getattr(one, n)) is not None}
    step = float((t[-1] - t[0]) / (t.size - 1))
    even = t[0] + step * np.arange(t.size)
    if np.abs(t - even).max() > _EVEN * step:
        step = median
        even = t[0] + step * np.arange(int((t[-1] - t[0]) / step) + 1)
        signals = {n: _through(t, v, even) for n, v in signals.items()}
        notes.append(f"{one.name}: rows at uneven times, put to {1 / step:.4g} a second")
    if 1 / step < USUAL_RATE * (1 - 1e-6) and apart > USUAL_DISTANCE * (1 + 1e-6):
        notes.append(
            f"{one.name}: {1 / step:.3g} samples a second; EN 50317 asks for {USUAL_RATE:g}, or one"
            f" every {USUAL_DISTANCE:.2f} m (recalled)"
        )
    x = np.interp(even, t, x)
    return EvenPass(
        name=one.name,
        step=step,
        x=x,
        values=signals,
        filtered=signals if is_filtered else {n: low_pass(v, step, kind=filter) for n, v in signals.items()},
        speed=np.gradient(x, step),
        gaps=(np.interp(t[:-1], even, x), gaps),
        notes=tuple(notes),
    )


def _axes(one: MeasuredPass, speed: float | None, run_speed: float) -> tuple[Floats, Floats, list[str]]:
    """Times [s], places along the way [m], and notes on what was assumed. Raises InputError."""
    notes: list[str] = []
    x, t = one.position, one.time
    if x is not None and x[-1] < x[0]:
        x = -x
        notes.append(f"{one.name}: positions fall along the way: places of the line are shift − position")
    if speed is not None and (one.speed is not None or (x is not None and t is not None)):
        raise InputError(f"speed = {3.6 * speed:g} km/h: {one.name} says its speed itself; leave it out")
    if x is not None and t is not None:
        return t, x, notes
    v = one.speed
    if v is None:
        if speed is None:
            notes.append(
                f"{one.name}: its speed is not known; taken is the run's, {3.6 * run_speed:.4g} km/h"
            )
        v = np.full((x if x is not None else t).size, speed or run_speed)  # type: ignore[union-attr]
    if x is not None:
        return _sum(np.diff(x) * (1 / v[1:] + 1 / v[:-1]) / 2), x, notes
    assert t is not None
    return t, _sum(np.diff(t) * (v[1:] + v[:-1]) / 2), notes


def _sum(steps: Floats) -> Floats:
    return np.concatenate([[0.0], np.cumsum(steps)])


def _through(t: Floats, values: Floats, at: Floats) -> Floats:
    """A smooth curve through samples; between rows that are far apart it means nothing, which is checked."""
    from scipy.interpolate import CubicSpline

    found: Floats = CubicSpline(t, values)(at)
    return found


@dataclass(frozen=True)
class Place:
    """Where a pass belongs.

    shift : [m] to add to its places
    correlation : of the two filtered signals there, from -1 to 1; None where they do not overlap
    other : [m] and correlation of the best other place that is nearly as good; None where there is none
    """

    shift: float
    correlation: float | None
    other: tuple[float, float] | None = None


def find_place(run_x: Floats, run_values: Floats, one: EvenPass, name: str, apart: float) -> Place:
    """The shift at which the cross-correlation of two filtered signals is the largest.

    run_x : [m], shape (points,), ascending, of the run's evaluated range
    run_values : shape (points,), filtered
    name : of the signal of the pass
    apart : [m] from the place found, beyond which another place is told: half a span

    Both are detrended. Pearson's correlation over the length on which they overlap, at least half of the
    longest one, is weighed by the root of that length's share. Raises InputError where it is below 0.5.
    """
    longest = max(float(one.x[-1] - one.x[0]), float(run_x[-1] - run_x[0]))
    grid = max(_GRID, longest / _MOST_POINTS)
    a, b = _on_grid(run_x, run_values, grid), _on_grid(one.x, one.filtered[name], grid)
    there = one.without_gaps(one.x[0] + grid * np.arange(b.size))
    lags, r, share = _correlations(a, b, there)
    weighed: Floats = np.where(share >= LEAST_OVERLAP, r * np.sqrt(share), -1.0)
    best = int(np.argmax(weighed))
    begin = float(run_x[0] - one.x[0])
    if r[best] < LEAST_CORRELATION:
        raise InputError(
            f"{one.name}: no clear place along the line: the {name}s of run and measurement correlate by"
            f" {r[best]:.2f} at most, must be at least {LEAST_CORRELATION:g}; give the shift"
        )
    other = _other(lags.astype(float) * grid + begin, r, weighed, best, apart)
    return Place(_at_peak(lags, weighed, best) * grid + begin, float(r[best]), other)


def correlation_at(run_x: Floats, run_values: Floats, one: EvenPass, name: str, shift: float) -> float | None:
    """Of the two filtered signals where they overlap; None where that is less than two points."""
    x = one.x + shift
    inside = (run_x >= x[0]) & (run_x <= x[-1])
    if inside.sum() < 2:
        return None
    a, b = run_values[inside], np.interp(run_x[inside], x, one.filtered[name])
    a, b = _detrended(a), _detrended(b)
    size = float(np.sqrt((a @ a) * (b @ b)))
    return float(a @ b) / size if size > 0 else None


def _detrended(values: Floats) -> Floats:
    from scipy.signal import detrend

    found: Floats = detrend(values)
    return found


def _on_grid(x: Floats, values: Floats, grid: float) -> Floats:
    at = np.arange(x[0], x[-1] + 1e-9, grid)
    return _detrended(np.interp(at, x, values))


def _correlations(a: Floats, b: Floats, there: NDArray[np.bool_]) -> tuple[NDArray[np.int64], Floats, Floats]:
    """Lags, Pearson's correlation where the two overlap, and that length's share of the longest one.

    there : shape of ``b``: what of it counts
    """
    from scipy.signal import correlate, correlation_lags

    def summed(u: Floats, v: Floats) -> Floats:
        found: Floats = correlate(u, v, method="fft")
        return found

    ones_a, ones_b = np.ones(a.size), there.astype(float)
    b = np.where(there, b, 0.0)
    n = np.maximum(np.round(summed(ones_a, ones_b)), 1)
    mean_a, mean_b = summed(a, ones_b) / n, summed(ones_a, b) / n
    spread = (summed(a * a, ones_b) / n - mean_a**2) * (summed(ones_a, b * b) / n - mean_b**2)
    scale = max(float(a.var() * b.var()), 1e-30)
    r: Floats = (summed(a, b) / n - mean_a * mean_b) / np.sqrt(np.maximum(spread, 1e-6 * scale))
    lags: NDArray[np.int64] = correlation_lags(a.size, b.size)
    share: Floats = n / n.max()
    return lags, r, share


def _at_peak(lags: NDArray[np.int64], r: Floats, best: int) -> float:
    """The lag at the top of the parabola through the largest value and its neighbours."""
    if 0 < best < r.size - 1:
        before, top, after = r[best - 1 : best + 2]
        curve = before - 2 * top + after
        if curve < 0 and min(before, after) > -1:
            return float(lags[best] + 0.5 * (before - after) / curve)
    return float(lags[best])


def _other(shifts: Floats, r: Floats, weighed: Floats, best: int, apart: float) -> tuple[float, float] | None:
    """The best place away from the one found, where it is nearly as good."""
    away = np.abs(shifts - shifts[best]) > apart
    if not away.any():
        return None
    second = int(np.flatnonzero(away)[np.argmax(weighed[away])])
    alike = weighed[second] > weighed[best] - ALIKE
    return (float(shifts[second]), float(r[second])) if alike else None


def check_shift(shift: float | None) -> None:
    """Raises InputError for a shift [m] that is no number."""
    if shift is not None:
        number("shift", shift, "m")
