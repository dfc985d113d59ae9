"""Before a run: where it goes, and where physics and discretisation disagree: the rule, and both numbers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.base import RunCase
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.layout import AnyPantograph, Catenary, InputError, counted
from catenary_fe.layout.arguments import numbers
from catenary_fe.layout.current_collection import WAVE_SPEED_SHARE, gradient_limit
from catenary_fe.layout.rules import layout_warnings, pantograph_warnings
from catenary_fe.layout.terminations import slowest_contact_wire
from catenary_fe.results.signal import CUT_OFF
from catenary_fe.statics import LineShape, Shape
from catenary_fe.statics.cases import pushed_arms

Floats = NDArray[np.float64]

FASTEST = 600 / 3.6  # [m/s] no train on a catenary is faster
SLOWEST = 5 / 3.6  # [m/s]
OUT_OF_REACH = 0.2  # [m] above the design line: of wires that run off, no head meets them there
RUN_IN = 2  # spans before the evaluated ones, for the start's transient to be left behind


def check_speed(speed: float) -> None:
    """Raises InputError for a speed [m/s] that is not one, or looks like another unit."""
    if not np.isfinite(speed) or speed <= 0:
        raise InputError(f"speed = {speed:g} m/s, {3.6 * speed:g} km/h: must be above 0")
    if not SLOWEST <= speed <= FASTEST:
        rule = "above 600 km/h" if speed > FASTEST else "below 5 km/h"
        raise InputError(
            f"speed = {speed:g} m/s is {3.6 * speed:g} km/h: {rule}, it looks like the wrong unit;"
            " the interface takes m/s (km/h divided by 3.6), --speed-kmh takes km/h"
        )


def check_heads(shape: Shape, pantographs: Sequence[AnyPantograph], start: float, end: float) -> None:
    """Raises InputError where a contact wire leaves the panhead, or a pantograph has one wire too many.

    start, end : [m] along the line, what is run over
    """
    wires, faults = shape.contact_wires, []
    several = isinstance(shape, LineShape)
    for pantograph in pantographs:
        if not pantograph.masses:
            if len(shape.catenary.contact_wire_offsets) > 1:
                faults.append(
                    f"{pantograph.name}: an elastic pantograph has one force for one contact wire, the layout"
                    " has two; take a pantograph of masses"
                )
            continue
        half = pantograph.panhead.width / 2
        for wire in wires:
            x = np.linspace(start, end, max(2, int(np.ceil(end - start)) + 1))
            x = np.union1d(x, wire.x[(wire.x >= start) & (wire.x <= end)])
            x = x[(x >= wire.x[0]) & (x <= wire.x[-1])]
            x = x[wire.height(x) - shape.catenary.design_line(x) < OUT_OF_REACH] if several else x
            if not x.size:
                continue
            y = wire.lateral(x)
            worst = int(np.abs(y).argmax())
            if abs(y[worst]) > half:
                faults.append(
                    f"{pantograph.name}: the contact wire leaves the head at {x[worst]:.1f} m (span"
                    f" {int(np.searchsorted(shape.catenary.support_positions, x[worst]))}): it lies"
                    f" {abs(y[worst]):.3f} m from the track's centre, the head reaches {half:g} m; lower the"
                    " stagger, shorten the span in the curve, or take a wider head"
                )
    if faults:
        raise InputError(*faults)


def run_warnings(
    shape: Shape,
    pantographs: Sequence[AnyPantograph],
    speed: float,
    start: Floats,
    time: TimeSettings,
) -> list[str]:
    """What to know before trusting a run: each line has the rule and both numbers."""
    catenary = shape.catenary
    wave_speed = slowest_contact_wire(catenary).wave_speed
    found = layout_warnings(catenary)
    found += dict.fromkeys(line for p in pantographs for line in pantograph_warnings(p, speed))
    if not catenary.is_spatial:
        found += dict.fromkeys(
            f"{p.name}: head.spring_distance has no effect in the vertical plane, where no head rolls"
            for p in pantographs
            if p.head and p.head.spring_distance
        )
    if speed > WAVE_SPEED_SHARE * wave_speed:
        found.append(
            f"speed {3.6 * speed:.4g} km/h is {speed / wave_speed:.3f} of the contact wire's wave speed,"
            f" {3.6 * wave_speed:.0f} km/h; the rule is at most {WAVE_SPEED_SHARE:g}, as waves pile up ahead"
            " of the pantograph; raise contact_wire.tension, or lower the speed"
        )
    limit = gradient_limit(speed).value or 0.0
    for span, gradient in enumerate(catenary.gradients.tolist(), start=1):
        if abs(gradient) > limit + 1e-9:
            found.append(
                f"span {span}: the contact wire's gradient of {1e3 * gradient:.3g} ‰ is above the"
                f" {1e3 * limit:g} ‰ that EN 50119 (recalled) has for {3.6 * speed:.4g} km/h: spread the"
                " change of height over more spans, or lower the speed"
            )
    if pushed := pushed_arms(shape):
        found.append(
            f"{counted(len(pushed), 'support')}, the first one {pushed[0]}: the wind pushes the arm, and"
            " arms only pull: here they are bars that push, too; give more stagger on that side, or less wind"
        )
    longest = float(np.diff(shape.mesh.contact.x).max())
    wavelength = (wave_speed - speed) / CUT_OFF
    if 0 < wavelength < longest:  # beyond the wave speed nothing runs ahead
        found.append(
            f"elements of the contact wire of up to {longest:.2f} m are longer than the waves of"
            f" {CUT_OFF:g} Hz ahead of the pantograph, {wavelength:.2f} m, and cannot carry them; take"
            " shorter ones (--element-m)"
        )
    if time.step > 1 / (20 * CUT_OFF):
        found.append(
            f"time step {1e3 * time.step:g} ms: less than 20 steps in a period of {CUT_OFF:g} Hz; use at most"
            f" {1e3 / (20 * CUT_OFF):g} ms"
        )
    if speed * time.step > longest:
        found.append(
            f"a pantograph jumps {speed * time.step:.2f} m a step, over elements of {longest:.2f} m; use a"
            " smaller time step"
        )
    supports = catenary.support_positions
    reached = int(np.searchsorted(supports, start.max(), side="right")) - 1
    first = min(catenary.spans_to_evaluate)
    if first - 1 - reached < RUN_IN:
        found.append(
            f"the start at {start.max():g} m is only {supports[first - 1] - start.max():g} m before span"
            f" {first}, the first evaluated one; {RUN_IN} spans let the start's transient fade: evaluate"
            " later spans, or start earlier"
        )
    return found


def plan_run(
    shape: Shape,
    pantographs: Sequence[AnyPantograph],
    speed: float,
    positions: Sequence[float] | None,
    time: TimeSettings,
    runs: Sequence[AnyPantograph] | None = None,
    *,
    short: bool = False,
) -> RunCase:
    """A run from near the first support to as near to the last one, with what to know before trusting it.

    positions : [m] along the line at the start; unset (for one pantograph): near the first support
    runs : all pantographs on the line, with those that a script attached; unset: the same
    short : whether it ends as soon as all pantographs have passed the span behind the last evaluated one

    Raises InputError for an unlikely speed, a run that does not fit on the line, a wire that leaves a head.
    """
    check_speed(speed)
    runs = pantographs if runs is None else runs
    start, distance = _route(shape.catenary, len(runs), positions)
    if short:
        supports = shape.catenary.support_positions
        behind = min(max(shape.catenary.spans_to_evaluate) + 1, supports.size - 1)
        distance = min(distance, float(supports[behind] - start.min()))
    check_heads(shape, pantographs, float(start.min()), float(start.max()) + distance)
    return RunCase(runs, speed, start, distance, run_warnings(shape, pantographs, speed, start, time))


def run_margin(catenary: Catenary) -> float:
    """[m] from the line's ends within which no run starts or ends: where one pantograph alone does."""
    return float(np.diff(catenary.support_positions).min()) / 6


def two_apart(catenary: Catenary, distance: float, rear: float | None = None) -> tuple[float, float]:
    """[m] where two pantographs start, the front one first; unset: the rear one where one alone does."""
    rear = run_margin(catenary) if rear is None else rear
    return rear + distance, rear


def _route(catenary: Catenary, count: int, positions: Sequence[float] | None) -> tuple[Floats, float]:
    """[m] starts, and the distance that each pantograph runs; all pass the evaluated spans."""
    length, supports = catenary.length, catenary.support_positions
    margin = run_margin(catenary)
    if positions is None:
        if count > 1:
            raise InputError(
                f"{count} pantographs need their positions at the start, in metres along the line"
            )
        positions = [margin]
    start = np.atleast_1d(numbers("positions", positions))
    if start.shape != (count,):
        raise InputError(
            f"{counted(start.size, 'position')} for {counted(count, 'pantograph')}: give one for each"
        )
    for value in start:
        if not margin <= value < length - margin:
            raise InputError(
                f"pantograph at {value:g} m: must start between {margin:g} m and {length - margin:g} m, a"
                " sixth of a span from the line's ends"
            )
    if count > 1 and np.diff(np.sort(start)).min() < 1:
        raise InputError("two pantographs start less than 1 m apart; give positions that differ")
    first, last = min(catenary.spans_to_evaluate) - 1, max(catenary.spans_to_evaluate)
    distance = length - margin - start.max()
    if first == 0:
        raise InputError(
            "evaluated_spans: a run starts in the line's first span, which therefore cannot be evaluated; add"
            " spans (three are the least) or name later ones in evaluated_spans"
        )
    if start.max() > supports[first]:
        raise InputError(
            f"a pantograph starts at {start.max():g} m, inside or behind the evaluated spans, which begin at"
            f" {supports[first]:g} m; start earlier or evaluate later spans"
        )
    if start.min() + distance < supports[last]:
        raise InputError(
            f"the run would end beyond the line: when the last pantograph leaves the evaluated spans at"
            f" {supports[last]:g} m, the first one would be at {supports[last] + np.ptp(start):g} m of"
            f" {length:g} m; use more spans, evaluate earlier ones, or put the pantographs closer together"
        )
    return start, float(distance)
