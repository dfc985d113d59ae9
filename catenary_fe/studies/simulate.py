"""Runs in time: pantographs at constant speed along the line."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.base import Progress, RunCase
from catenary_fe.engines.checkpoint import Checkpoint
from catenary_fe.engines.compiled import run_clock
from catenary_fe.engines.history import History
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.layout import AnyPantograph, CatenaryError, InputError, RunInterrupted
from catenary_fe.layout.arguments import checked, number, one_of
from catenary_fe.layout.conditions import Conditions, Effect
from catenary_fe.layout.pantograph import check_pantographs
from catenary_fe.results import Run
from catenary_fe.results.balances import OF_A_SCRIPT as MODEL_OF_A_SCRIPT
from catenary_fe.statics import Shape, settle
from catenary_fe.studies.checks import plan_run
from catenary_fe.studies.linearised import LinearisedLine, MeanForce, aimed, share_of
from catenary_fe.studies.record import kept_when_stopped, make_run, run_key
from catenary_fe.studies.resources import check_memory, demand

if TYPE_CHECKING:
    from catenary_fe.engines.exudyn.build import ExudynModel

Floats = NDArray[np.float64]

Method = Literal["nonlinear", "linearised", "exudyn"]

OF_A_SCRIPT = (
    "computed with a multibody model of a script: what the script changed or attached is not in this record;"
    " to repeat the run, repeat the script"
)
AIMING = 0.1  # share of linearised runs in the work of one that follows them

Drive = Callable[[RunCase, Floats, Progress | None, Checkpoint | None], History]

_log = logging.getLogger(__name__)


@checked
def simulate(  # long by what it documents
    shape: Shape,
    pantographs: Sequence[AnyPantograph],
    *,
    speed: float,
    positions: Sequence[float] | None = None,
    time: TimeSettings | None = None,
    store_wire: float | None = None,
    progress: Progress | None = None,
    method: Method = "nonlinear",
    energy: bool = False,
    checkpoint: str | Path | None = None,
    model: ExudynModel | None = None,
    conditions: Conditions | Sequence[Effect] | None = None,
) -> Run:
    """Run pantographs from static contact along the line at constant speed.

    Where a pantograph asks for a mean force, linearised runs find the uplift for it. Until the mean over the
    evaluated spans is within 0.1 N of it, the run is repeated with another uplift, which is seldom needed.

    shape : the catenary in static equilibrium, with its mesh
    speed : [m/s]
    positions : [m] along the line at the start, one a pantograph; unset (for one): near the first support
    time : settings of the time integration
    store_wire : [s] between stored shapes of the whole wires, rounded to whole time steps; unset: none
    progress : called with the share done, 0 to 1
    method : "nonlinear" in compiled code; "exudyn" the same with Exudyn's own solver, many times slower, to
        compare with; "linearised" about the static state, many times faster: slack droppers and contact are
        solved in each step, large motions are not there. It warns where they matter.
    energy : with the method "exudyn", record energy, work and losses of the whole system, which a check then
        judges, a tenth slower; runs with the method "nonlinear" always do
    checkpoint : file that keeps the state of a run with the method "nonlinear", every half a minute: started
        again, the same run goes on from it, with the same result. It is removed at the end
    model : with the method "exudyn", the multibody model of this shape and these pantographs to run
        (:func:`exudyn_model`), with what a script changed in it and attached to it; positions count attached
        pantographs last
    conditions : the line is settled under them first (:func:`settle`), or effects, a script's own among them

    Raises InputError for a speed in the wrong unit, energies, a checkpoint or a model of another method, a
    checkpoint of another run, a model of another line, a run that would end beyond the line or take more
    memory than there is, a pantograph that the air pushes down or a contact wire that leaves the
    panhead, SolverError where a solve fails or the mean force is not reached, RunInterrupted after Ctrl-C;
    both have the run until then as ``partial``.
    """
    if conditions is not None:
        if model is not None:
            raise InputError("conditions: a model has those of its shape; give exudyn_model a settled shape")
        shape = settle(shape, conditions)
    runs: Sequence[AnyPantograph] = pantographs
    if model is not None:
        _check_model(model, shape, pantographs, method, energy=energy)
        runs = model.records
    check_pantographs(runs)
    time = time or TimeSettings()
    _check_options(method, energy, time, store_wire, checkpoint)
    case = plan_run(shape, pantographs, speed, positions, time, runs)
    warnings = list(case.warnings)
    if method == "linearised" and time.tolerance != TimeSettings().tolerance:
        warnings.append(
            f"tolerance = {time.tolerance:g} has no effect: linearised runs have no Newton iteration"
        )
    if model is not None:
        warnings.append(OF_A_SCRIPT)
    case = replace(case, warnings=warnings)
    _check_memory(shape, case, time, store_wire, method)
    for warning in warnings:
        _log.warning(warning)
    if method == "linearised":
        (result,) = LinearisedLine(shape, time, store_wire).run([case], progress)
        if isinstance(result, CatenaryError):
            raise result
        run = result
    else:
        keeper, force = None, MeanForce(runs, speed)
        if checkpoint is not None:
            key = run_key(shape, pantographs, speed, time, case.start, store_wire)
            keeper = Checkpoint(checkpoint, key)
        if force.sought and not (keeper and keeper.kept) and len(runs) == len(pantographs):
            force, progress = _aimed(shape, case, time, progress)
        set_up = partial(_engine, shape, time, store_wire, method, energy, model)

        scripted = "" if model is None else MODEL_OF_A_SCRIPT

        def label(uplifts: Floats, history: History) -> Run:
            return make_run(shape, case, uplifts, time, history, warnings, method, scripted=scripted)

        run = _until_mean_force(case, time, force, set_up, label, progress, keeper)
    for warning in run.warnings[len(warnings) :]:
        _log.warning(warning)
    return run


def _aimed(
    shape: Shape, case: RunCase, time: TimeSettings, progress: Progress | None
) -> tuple[MeanForce, Progress | None]:
    """Uplifts to begin with, found by linearised runs, and the progress of what is left to do."""
    try:
        force = aimed(shape, case, time, share_of(progress, 0.0, AIMING))
    except KeyboardInterrupt as error:
        raise error if isinstance(error, RunInterrupted) else RunInterrupted() from None
    return force, share_of(progress, AIMING, 1 - AIMING)


def _check_options(
    method: Method,
    energy: bool,
    time: TimeSettings,
    store_wire: float | None,
    checkpoint: str | Path | None,
) -> None:
    one_of("method", method, get_args(Method))
    if energy and method == "linearised":
        raise InputError("energy: linearised runs do not record it; take the method 'nonlinear'")
    if store_wire is not None:
        number("store_wire", store_wire, "s", least=time.step, remedy="that is the time step")
    if checkpoint is not None and method != "nonlinear":
        raise InputError(
            f"checkpoint {checkpoint}: only runs with the method nonlinear keep one; leave it out"
        )


def _check_memory(
    shape: Shape, case: RunCase, time: TimeSettings, store_wire: float | None, method: Method
) -> None:
    """Raises InputError for a run that takes more memory than there is."""
    duration = case.distance / case.speed
    if store_wire is not None and store_wire > duration:
        raise InputError(
            f"store_wire = {store_wire:g} s is longer than the run, {duration:.4g} s; shorten it"
        )
    steps = int(duration / time.step)
    shapes = int(steps * time.step / store_wire) + 1 if store_wire else 0
    needs = demand(shape.catenary, shape.mesh, case.pantographs, steps, shapes, method)
    check_memory(needs, f"run at {3.6 * case.speed:g} km/h")


def _until_mean_force(
    case: RunCase,
    time: TimeSettings,
    force: MeanForce,
    set_up: Callable[[], Drive],
    label: Callable[[Floats, History], Run],
    progress: Progress | None,
    keeper: Checkpoint | None,
) -> Run:
    """Run once, or with other uplifts until the pantographs have the mean forces that they ask for.

    label : makes a run of uplifts and a history
    """
    steps = case.steps(time.step)
    if keeper:
        force.take_up(keeper)
    begin = run_clock()
    drive = set_up()
    while True:
        labelled = partial(label, force.uplifts)
        with kept_when_stopped(labelled, steps * time.step):
            run = labelled(drive(case, force.uplifts, progress, keeper))
        run = Run(run.data, run_clock() - begin)
        reached = force.reached(run)
        if keeper:
            keeper.remove() if reached else keeper.begin(force.state())
        if reached:
            return run
        begin = run_clock()


def _engine(
    shape: Shape,
    time: TimeSettings,
    store_wire: float | None,
    method: Method,
    energy: bool,
    model: ExudynModel | None,
) -> Drive:
    if method == "exudyn":
        from catenary_fe.engines.exudyn.run import ExudynEngine

        return ExudynEngine(shape, time, store_wire, energy=energy, model=model).run
    from catenary_fe.engines.nonlinear.run import NonlinearEngine

    return NonlinearEngine(shape.system, time, store_wire).run


def _check_model(
    model: ExudynModel, shape: Shape, pantographs: Sequence[AnyPantograph], method: Method, *, energy: bool
) -> None:
    """Raises InputError for a model of another line or method, or energies that a changed one has not."""
    if method != "exudyn":
        raise InputError(f"model with the method {method}: only the method 'exudyn' runs a multibody model")
    if model.shape is not shape:
        raise InputError("model is of another shape; give the one that exudyn_model was given")
    built = [parts.record for parts in model.pantographs if parts.substructure]
    if list(pantographs) != built:
        names = ", ".join(p.name for p in built) or "none"
        raise InputError(f"pantographs are not those of the model ({names}); give the same to both")
    if shape.system.base_line.motions and len(built) < len(model.pantographs):
        raise InputError(
            "conditions: base moves, and attached pantographs stand on bases of the script's own; leave base"
            " out, and move them there"
        )
    if energy:
        raise InputError(
            "energy: not of a model that a script may have changed, whose springs and masses are not those of"
            " the layout; leave it out"
        )
