"""A run again, from nothing but what it recorded."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass
from typing import cast

from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.mesh import MeshSettings
from catenary_fe.layout import InputError
from catenary_fe.results import Run
from catenary_fe.statics import Shape, find_form, settle
from catenary_fe.studies.simulate import OF_A_SCRIPT, Method, simulate


@dataclass(frozen=True)
class Rerun:
    """A run beside the one that it repeats.

    shape : the static shape found again
    again : the new run
    identical : whether all data are the same to the last bit
    contact_force : [N] largest difference of the unfiltered contact force
    support_uplift : [m] largest difference of the uplift at the supports
    statistics : [N] largest difference of mean and standard deviation over the evaluated spans
    """

    shape: Shape
    again: Run
    identical: bool
    contact_force: float
    support_uplift: float
    statistics: float


def rerun(run: Run, progress: Callable[[float], None] | None = None) -> Rerun:
    """Run again what a run recorded: layout, pantographs, speed, starts, mesh and time settings.

    Raises InputError for a partial run, one of a model that a script may have changed, and a record that
    this version does not understand.
    """
    if run.partial:
        raise InputError(f"{run.partial}: start it again with the command in its inputs.json")
    if "model" in run.data.attrs:
        raise InputError(f"the run was {OF_A_SCRIPT}")
    shape, stored = shape_of(run), run.data.get("wire_time")
    again = simulate(
        shape,
        run.pantographs,
        speed=run.speed,
        positions=run.data["position"].values[:, 0].tolist(),
        time=_settings(run)[1],
        store_wire=float(stored[1] - stored[0]) if stored is not None and stored.size > 1 else None,
        progress=progress,
        energy="energy" in run.data,
        method=cast(Method, run.method),  # simulate refuses one that it does not know
    )
    if again.time.size != run.time.size:
        raise InputError(f"the repeated run has {again.time.size} times, not {run.time.size}: other settings")
    before, after = run.contact_force_statistics(), again.contact_force_statistics()
    names = ["contact_force", "support_uplift"]
    largest = abs(again.data[names] - run.data[names]).max()
    return Rerun(
        shape=shape,
        again=again,
        identical=again.data.drop_attrs().identical(run.without_elasticity().data.drop_attrs()),
        contact_force=float(largest["contact_force"]),
        support_uplift=float(largest["support_uplift"]),
        statistics=max(
            max(abs(a.mean - b.mean), abs(a.std - b.std)) for a, b in zip(before, after, strict=True)
        ),
    )


def shape_of(run: Run) -> Shape:
    """The static shape that a run started from, found again on its mesh. Raises InputError."""
    mesh, _ = _settings(run)
    shape = find_form(run.catenary, mesh)
    return settle(shape, run.conditions) if run.conditions else shape


def _settings(run: Run) -> tuple[MeshSettings, TimeSettings]:
    settings = json.loads(run.data.attrs["settings"])
    try:
        return MeshSettings(**settings["mesh"]), TimeSettings(**settings["time"])
    except TypeError as error:
        raise InputError(f"settings of the run are not those of this version: {error}") from None
