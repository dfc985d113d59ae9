"""From a history's arrays to a labelled result with its provenance; runs that were stopped are marked."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import asdict
from functools import cache
from importlib.metadata import version
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.base import RunCase
from catenary_fe.engines.history import History, RunStopped
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.layout import AnyPantograph, RunInterrupted, SolverError
from catenary_fe.results import Run
from catenary_fe.results.balances import OF_A_SCRIPT
from catenary_fe.results.run import FORMAT
from catenary_fe.statics import LineShape, Shape

Floats = NDArray[np.float64]
Rows = dict[str, tuple[Any, ...]]  # dimensions, values, and of a quantity its unit and name
_NOTES = 3  # by themselves
CHECKPOINT_FORM = 8  # rises when what a checkpoint holds changes


def make_run(
    shape: Shape,
    case: RunCase,
    uplifts: Floats,
    time: TimeSettings,
    history: History,
    warnings: Sequence[str],
    method: str,
    *,
    scripted: str = "",
) -> Run:
    """Label what a run recorded, and note where it comes from.

    scripted : what a script did to the run, empty where it did nothing
    """
    import xarray as xr

    catenary, pantographs = shape.catenary, case.pantographs
    nominal, by_time = catenary.contact_wire_height, ("pantograph", "time")
    masses, wire = nominal + _stack(history.mass_heights), nominal + history.wire_height
    variables: Rows = {
        "position": (by_time, history.position, "m", "position along the line"),
        "contact_force": (by_time, history.contact_force, "N", "contact force, unfiltered"),
        "wire_height": (by_time, wire, "m", "height of the contact wire over the head"),
        "mass_height": (("pantograph", "mass", "time"), masses, "m", "height of the masses"),
        "uplift_force": (("pantograph",), uplifts, "N", "constant force on the lowest mass"),
        "dropper_force": (("dropper", "time"), history.dropper_force, "N", "dropper tension"),
        "support_uplift": (
            ("support", "time"),
            _support_uplift(shape, history),
            "m",
            "uplift of the contact wire at supports",
        ),
    }
    coordinates: Rows = {
        "time": (("time",), history.time, "s", "time"),
        "pantograph": ("pantograph", _unique([p.name for p in pantographs])),
        "dropper_position": (("dropper",), catenary.dropper_positions, "m", "position of droppers"),
        "dropper_span": ("dropper", catenary.dropper_spans),
        "support_position": (("support",), catenary.support_positions, "m", "position of supports"),
    }
    if history.section_force is not None:
        words = "contact force of each tension section's wires, unfiltered"
        variables["section_force"] = (("pantograph", "section", "time"), history.section_force, "N", words)
        coordinates["section"] = ("section", np.arange(history.section_force.shape[1]) + 1)
    _add_contact_places(variables, coordinates, shape, case, history)
    courses = shape.system.base_line.courses(case.start, case.speed, time.step, history.time.size - 1)
    if moved := [course.values[:, 0] for course in courses if course]:
        variables["base_height"] = (by_time, np.array(moved), "m", "height of the moving bases")
    _add_wire_shapes(variables, coordinates, shape, history)
    _add_balances(variables, coordinates, shape, history)
    attributes = _provenance(shape, pantographs, case.speed, time, method)
    settled = shape.settlement
    if settled and settled.conditions:
        attributes["conditions"] = settled.conditions.model_dump_json(exclude_unset=True)
        attributes["title"] += f", {settled.conditions.name}"
        attributes["input_sha256"] = _sha256(attributes["input_sha256"] + attributes["conditions"])
    if shape.has_effect and not (settled and settled.conditions):
        scripted = scripted or OF_A_SCRIPT
    attributes["warnings"] = json.dumps([*warnings, *_brief(history.notes)])
    if scripted:
        attributes["model"] = scripted
        attributes["input_sha256"] = _sha256(attributes["input_sha256"] + attributes["model"])
    return Run(xr.Dataset(_labelled(variables), _labelled(coordinates), attributes))


def _support_uplift(shape: Shape, history: History) -> Floats:
    """[m], shape (supports, times): of the contact wire that is lifted most at each support."""
    uplift = np.full((len(shape.catenary.supports), history.time.size), -np.inf)
    first = 0
    for wire, stations in zip(shape.contact_wires, shape.mesh.wires, strict=False):
        own = slice(first, first + stations.supports.size)
        at = shape.catenary.supports_at(stations.x[stations.supports])
        static = wire.z[stations.supports]
        uplift[at] = np.maximum(uplift[at], history.support_height[own] - static[:, None])
        first = own.stop
    return uplift


def _labelled(rows: Rows) -> dict[str, Any]:
    """As xarray takes them, units and names as attributes."""
    return {
        key: (dims, values, dict(zip(("units", "long_name"), words, strict=False)))
        for key, (dims, values, *words) in rows.items()
    }


def _brief(notes: Sequence[str]) -> list[str]:
    """The first notes, and how many more there are."""
    if len(notes) <= _NOTES:
        return list(notes)
    return [*notes[: _NOTES - 1], f"{len(notes) - _NOTES + 1} more such warnings, the last one: {notes[-1]}"]


def _add_balances(variables: Rows, coordinates: Rows, shape: Shape, history: History) -> None:
    """Energy, work and tension, as far as the run recorded them."""
    if history.lost_work is not None and history.energy.size:
        at = np.searchsorted(history.time, history.energy_times - 1e-9)
        place = ("energy_time",)
        energy, driven, lost = history.energy - history.energy[0], history.driven_work, history.lost_work
        coordinates["energy_time"] = (place, history.energy_times, "s", "time of energies")
        variables["energy"] = (place, energy, "J", "kinetic and stored energy since the start")
        variables["driven_work"] = (place, driven[at], "J", "work done by the contacts")
        variables["lost_work"] = (place, lost[at], "J", "work lost in dampers")
    if history.tension_change is not None:
        by_wire = ("wire", "tension_time")
        coordinates["tension_time"] = (("tension_time",), history.tension_times, "s", "time of tensions")
        coordinates["wire"] = ("wire", _wire_names(shape))
        words = "largest relative change of a wire's tension in a span since the start"
        variables["tension_change"] = (by_wire, history.tension_change, "1", words)
        words = "number of the span where that is; of a stitch wire, always 1"
        variables["tension_span"] = (by_wire, history.tension_span, "1", words)


def _wire_names(shape: Shape) -> list[str]:
    if isinstance(shape, LineShape):
        parts = enumerate(shape.sections, start=1)
        each = [[f"section_{n}_{wire}" if n > 1 else wire for wire in _wire_names(part)] for n, part in parts]
        return shape.joint.wires(each)
    contact = ["contact_wire", "left_contact_wire"][: len(shape.contact_wires)]
    stitch = [f"stitch_wire_{i + 1}" for i in shape.catenary.stitched_supports]
    return [*contact, *(["messenger_wire"] if shape.mesh.messenger else []), *stitch]


def _add_contact_places(
    variables: Rows, coordinates: Rows, shape: Shape, case: RunCase, history: History
) -> None:
    """Where the wires lie on the heads, in space: of each strip on each contact wire."""
    if not any(lateral.size for lateral in history.contact_lateral):
        return
    most = max(len(lateral) for lateral in history.contact_lateral)
    found = np.full((len(history.contact_lateral), most, history.time.size), np.nan)
    for i, lateral in enumerate(history.contact_lateral):
        found[i, : len(lateral)] = lateral
    words = "place of the contact on the head, to the left of its middle"
    variables["contact_lateral"] = (("pantograph", "contact", "time"), found, "m", words)
    wires = len(shape.contact_wires)
    names = [f"strip {n // wires + 1}, contact wire {n % wires + 1}" for n in range(most)]
    coordinates["contact"] = ("contact", names)


def _add_wire_shapes(variables: Rows, coordinates: Rows, shape: Shape, history: History) -> None:
    """Whole shapes of the wires over time, in single precision: 0.5 µm at a height of 6 m."""
    if not history.wire_z:
        return
    coordinates["wire_time"] = (("wire_time",), history.wire_times, "s", "time of wire shapes")
    wires = zip(_wire_names(shape), history.wire_x, history.wire_z, shape.wires, strict=True)
    for wire, x, values, static in wires:
        place = "x" if wire == "contact_wire" else f"{wire}_x"
        height = f"height of the {wire.replace('_', ' ')}"
        shapes = np.asarray(values, dtype=np.float32)
        variables[f"{wire}_height"] = (("wire_time", place), shapes, "m", height)
        coordinates[place] = ((place,), x, "m", "position along the line")
        coordinates[f"static_{wire}_height"] = ((place,), static.z, "m", f"{height} before the run")


def _stack(masses: Sequence[Floats]) -> Floats:
    """Shape (pantographs, masses, times); pantographs with fewer masses, or none, are filled up with nan."""
    most = max(1, *(m.shape[0] for m in masses))
    stacked = np.full((len(masses), most, masses[0].shape[1]), np.nan)
    for i, heights in enumerate(masses):
        stacked[i, : heights.shape[0]] = heights
    return stacked


def _unique(names: Sequence[str]) -> list[str]:
    if len(set(names)) == len(names):
        return list(names)
    return [f"{name} ({i})" for i, name in enumerate(names, start=1)]


def run_key(
    shape: Shape,
    pantographs: Sequence[AnyPantograph],
    speed: float,
    time: TimeSettings,
    start: Floats,
    store_wire: float | None,
) -> dict[str, Any]:
    """All that decides a nonlinear run's result, and the versions that computed it."""
    return {
        "form": CHECKPOINT_FORM,
        "layout": _sha256(shape.catenary.model_dump_json()),
        "conditions": _conditions_key(shape),
        "pantographs": [p.model_dump(mode="json") for p in pantographs],
        "speed": speed,
        "positions": start.tolist(),
        "settings": {"mesh": asdict(shape.mesh_settings), "time": asdict(time), "store_wire": store_wire},
        "versions": {**_versions(), "numba": version("numba")},
    }


def _conditions_key(shape: Shape) -> str:
    """What moved the line, also where a script's effects did."""
    settled = shape.settlement
    if settled and settled.conditions:
        return settled.conditions.model_dump_json()
    return hashlib.sha256(settled.moved.tobytes()).hexdigest() if settled else ""


@cache
def _versions() -> dict[str, str]:
    return {name: version(name) for name in ("catenary_fe", "exudyn", "numpy", "scipy")}


def _sha256(text: str) -> str:
    return hashlib.sha256(text.encode()).hexdigest()


def _provenance(
    shape: Shape, pantographs: Sequence[AnyPantograph], speed: float, time: TimeSettings, method: str
) -> dict[str, Any]:
    catenary = shape.catenary.model_dump_json()
    records = json.dumps([p.model_dump(mode="json") for p in pantographs])
    settings = json.dumps({"mesh": asdict(shape.mesh_settings), "time": asdict(time)})
    inputs = "\n".join([catenary, records, settings, repr(speed), method])
    return {
        "format": FORMAT,
        "title": shape.catenary.name,
        "source": shape.catenary.source,
        "method": method,
        "speed": speed,
        "evaluated_spans": json.dumps(shape.catenary.spans_to_evaluate),
        "catenary": catenary,
        "pantographs": records,
        "settings": settings,
        "input_sha256": _sha256(inputs),
        "versions": json.dumps(_versions()),
    }


@contextmanager
def kept_when_stopped(label: Callable[[History], Run], planned: float) -> Iterator[None]:
    """Let the error of a drive that was stopped carry the run until then.

    label : makes a run of a history
    planned : [s] that the run should have taken

    Raises SolverError or RunInterrupted with ``partial``.
    """
    try:
        yield
    except RunStopped as stopped:
        cause = stopped.cause
        error = cause if isinstance(cause, SolverError | RunInterrupted) else RunInterrupted()
        if stopped.history is not None:
            reason = str(cause) if isinstance(cause, SolverError) else "interrupted"
            error.partial = as_partial(label(stopped.history), reason, planned)
        raise error from None


def as_partial(run: Run, reason: str, planned: float) -> Run:
    """The same run, said to be a part of one that should have taken so long [s]."""
    reached = float(run.time[-1])
    title = f"PARTIAL, {reached:.2f} of {planned:.2f} s: {run.data.attrs['title']}"  # heads pictures
    record = {"reason": reason, "reached_s": reached, "planned_s": planned}
    return Run(run.data.assign_attrs(title=title, partial=json.dumps(record)), run.wall_s)
