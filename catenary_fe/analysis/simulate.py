"""Runs in time: pantographs at constant speed along the line."""

from __future__ import annotations

import logging
import time as clock
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.analysis.checks import check_heads, check_speed, run_warnings
from catenary_fe.analysis.record import make_run
from catenary_fe.equilibrium import Shape
from catenary_fe.fe.solver_settings import TimeSettings
from catenary_fe.results import Run
from catenary_fe.system import AnyPantograph, InputError, Pantograph, SolverError
from catenary_fe.system.current_collection import MEAN_FORCE_TOLERANCE

Floats = NDArray[np.float64]
Progress = Callable[[float], None]

_MEAN_FORCE_RUNS = 5
_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Plan:
    """Where a run starts and ends.

    start : [m], shape (pantographs,)
    distance : [m] that each pantograph runs
    """

    start: Floats
    distance: float


def simulate(
    shape: Shape,
    pantographs: Sequence[AnyPantograph],
    *,
    speed: float,
    positions: Sequence[float] | None = None,
    time: TimeSettings | None = None,
    store_wire: float | None = None,
    progress: Progress | None = None,
) -> Run:
    """Run pantographs from static contact along the line at constant speed.

    Where a pantograph asks for a mean force, the run is repeated with another uplift until the mean over the
    evaluated spans is within 0.1 N of it.

    shape : the catenary in static equilibrium, with its mesh
    speed : [m/s]
    positions : [m] along the line at the start, one a pantograph; unset (for one): near the first support
    time : settings of the time integration
    store_wire : [s] between stored shapes of the whole wires; unset: none
    progress : called with the share done, 0 to 1

    Raises InputError for a speed in the wrong unit, a run that would end beyond the line, a pantograph that
    the air pushes down or a contact wire that leaves the head sideways, SolverError where a solve fails or
    the mean force is not reached.
    """
    if not pantographs:
        raise InputError("pantographs is empty; give at least one")
    check_speed(speed)
    time = time or TimeSettings()
    if store_wire is not None and not (np.isfinite(store_wire) and store_wire >= time.step):
        raise InputError(f"store_wire = {store_wire!r} s: must be at least the time step, {time.step:g} s")
    plan = plan_run(shape, len(pantographs), positions)
    check_heads(shape, pantographs, float(plan.start.min()), float(plan.start.max() + plan.distance))
    warnings = run_warnings(shape, pantographs, speed, plan.start, time)
    for warning in warnings:
        _log.warning(warning)
    uplifts = _uplifts(pantographs, speed)
    targets = [p.target_mean_force(speed) for p in pantographs]
    for _ in range(_MEAN_FORCE_RUNS):
        begin = clock.perf_counter()
        run = _drive(shape, pantographs, uplifts, speed, plan, time, store_wire, progress, warnings)
        run = Run(run.data, clock.perf_counter() - begin)
        if all(target is None for target in targets):
            return run
        means = np.array([s.mean for s in run.contact_force_statistics()])
        goals = np.array([m if t is None else t for m, t in zip(means, targets, strict=True)])
        if np.abs(means - goals).max() <= MEAN_FORCE_TOLERANCE:
            return run
        uplifts = uplifts * goals / means
    raise SolverError(
        f"mean contact force: after {_MEAN_FORCE_RUNS} runs the means are {np.round(means, 2).tolist()} N,"
        f" not {np.round(goals, 2).tolist()} N; give an uplift_force instead of a mean_force"
    )


def _uplifts(pantographs: Sequence[AnyPantograph], speed: float) -> Floats:
    """[N], shape (pantographs,): forces on the lowest masses, the air's included."""
    uplifts = np.array([p.static_uplift(speed) for p in pantographs])
    faults = [
        f"{pantograph.name}: uplift and aerodynamic force add up to {uplift:.6g} N at {3.6 * speed:g} km/h:"
        " must be above 0, or the head stays down; change uplift_force or aerodynamic_force"
        for pantograph, uplift in zip(pantographs, uplifts, strict=True)
        if isinstance(pantograph, Pantograph) and uplift <= 0
    ]
    if faults:
        raise InputError(*faults)
    return uplifts


def _drive(
    shape: Shape,
    pantographs: Sequence[AnyPantograph],
    uplifts: Floats,
    speed: float,
    plan: Plan,
    time: TimeSettings,
    store_wire: float | None,
    progress: Progress | None,
    warnings: Sequence[str],
) -> Run:
    from catenary_fe.fe.drive import Trip, drive

    steps = int(np.floor(plan.distance / (speed * time.step) + 1e-9))
    trip = Trip(speed, plan.start, steps, time, wire_interval=store_wire)
    pairs = list(zip(pantographs, uplifts.tolist(), strict=True))
    journey = drive(shape.catenary, shape.mesh, shape.installation, pairs, trip, progress)
    return make_run(shape, pantographs, uplifts, speed, time, journey, warnings)


def plan_run(shape: Shape, count: int, positions: Sequence[float] | None) -> Plan:
    """Start near the first support, end as near to the last one; all pantographs pass the evaluated spans.

    Raises InputError where that does not fit on the line.
    """
    catenary = shape.catenary
    length, supports = catenary.length, catenary.support_positions
    margin = float(np.diff(supports).min()) / 6
    if positions is None:
        if count > 1:
            raise InputError(
                f"{count} pantographs need their positions at the start, in metres along the line"
            )
        positions = [margin]
    start = np.asarray(positions, dtype=float)
    if start.size != count:
        raise InputError(f"{start.size} positions for {count} pantographs: give one for each")
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
    return Plan(start, float(distance))
