"""From a history's arrays to a labelled result with its provenance."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from dataclasses import asdict
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.base import RunCase
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.layout import AnyPantograph
from catenary_fe.results import Run
from catenary_fe.results.run import FORMAT
from catenary_fe.statics import Shape

if TYPE_CHECKING:
    from catenary_fe.engines.history import History

Floats = NDArray[np.float64]
_NOTES = 3  # by themselves
CHECKPOINT_FORM = 3  # rises when what a checkpoint holds changes


def make_run(
    shape: Shape,
    case: RunCase,
    uplifts: Floats,
    time: TimeSettings,
    history: History,
    warnings: Sequence[str],
    method: str,
    *,
    scripted: bool = False,
) -> Run:
    """Label what a run recorded, and note where it comes from.

    scripted : whether a script may have changed the model
    """
    import xarray as xr

    catenary, pantographs, speed = shape.catenary, case.pantographs, case.speed
    static = np.array([w.z[m.supports] for w, m in zip(shape.contact_wires, shape.mesh.wires, strict=False)])
    nominal = catenary.contact_wire_height
    by_time = ("pantograph", "time")
    variables: dict[str, Any] = {
        "position": _labelled(by_time, history.position, "m", "position along the line"),
        "contact_force": _labelled(by_time, history.contact_force, "N", "contact force, unfiltered"),
        "wire_height": _labelled(
            by_time, nominal + history.wire_height, "m", "height of the contact wire over the head"
        ),
        "mass_height": _labelled(
            ("pantograph", "mass", "time"),
            nominal + _stack(history.mass_heights),
            "m",
            "height of the masses",
        ),
        "uplift_force": _labelled(("pantograph",), uplifts, "N", "constant force on the lowest mass"),
        "dropper_force": _labelled(("dropper", "time"), history.dropper_force, "N", "dropper tension"),
        "support_uplift": _labelled(
            ("support", "time"),
            (history.support_height - static[:, :, None]).max(axis=0),
            "m",
            "uplift of the contact wire at supports",
        ),
    }
    coordinates: dict[str, Any] = {
        "time": _labelled(("time",), history.time, "s", "time"),
        "pantograph": ("pantograph", _unique([p.name for p in pantographs])),
        "dropper_position": _labelled(("dropper",), catenary.dropper_positions, "m", "position of droppers"),
        "dropper_span": ("dropper", catenary.dropper_spans),
        "support_position": _labelled(("support",), catenary.support_positions, "m", "position of supports"),
    }
    if history.wire_z:
        coordinates["wire_time"] = _labelled(("wire_time",), history.wire_times, "s", "time of wire shapes")
        for name, x, values, hanging in zip(
            _wire_names(shape), history.wire_x, history.wire_z, shape.wires, strict=True
        ):
            _add_wire_shapes(variables, coordinates, name, x, values, hanging.z)
    _add_balances(variables, coordinates, shape, history)
    attributes = _provenance(shape, pantographs, speed, time, method)
    attributes["warnings"] = json.dumps([*warnings, *_brief(history.notes)])
    if scripted:
        attributes["model"] = "of a script"
        attributes["input_sha256"] = _sha256(attributes["input_sha256"] + attributes["model"])
    return Run(xr.Dataset(variables, coordinates, attributes))


def _brief(notes: Sequence[str]) -> list[str]:
    """The first notes, and how many more there are."""
    if len(notes) <= _NOTES:
        return list(notes)
    return [*notes[: _NOTES - 1], f"{len(notes) - _NOTES + 1} more such warnings, the last one: {notes[-1]}"]


def _add_balances(
    variables: dict[str, Any], coordinates: dict[str, Any], shape: Shape, history: History
) -> None:
    """Energy, work and tension, as far as the run recorded them."""
    if history.lost_work is not None and history.energy.size:
        at = np.searchsorted(history.time, history.energy_times - 1e-9)
        coordinates["energy_time"] = _labelled(
            ("energy_time",), history.energy_times, "s", "time of energies"
        )
        for name, values, words in (
            ("energy", history.energy - history.energy[0], "kinetic and stored energy since the start"),
            ("driven_work", history.driven_work[at], "work done by the contacts"),
            ("lost_work", history.lost_work[at], "work lost in dampers"),
        ):
            variables[name] = _labelled(("energy_time",), values, "J", words)
    if history.tension_change is not None:
        words = "largest relative change of a wire's tension in a span since the start"
        coordinates["tension_time"] = _labelled(
            ("tension_time",), history.tension_times, "s", "time of tensions"
        )
        coordinates["wire"] = ("wire", _wire_names(shape))
        by_wire = ("wire", "tension_time")
        variables["tension_change"] = _labelled(by_wire, history.tension_change, "1", words)
        words = "number of the span where that is; of a stitch wire, always 1"
        variables["tension_span"] = _labelled(by_wire, history.tension_span, "1", words)


def _wire_names(shape: Shape) -> list[str]:
    contact = ["contact_wire", "left_contact_wire"][: len(shape.contact_wires)]
    stitch = [f"stitch_wire_{i + 1}" for i in shape.catenary.stitched_supports]
    return [*contact, "messenger_wire", *stitch]


def _add_wire_shapes(
    variables: dict[str, Any],
    coordinates: dict[str, Any],
    wire: str,
    x: Floats,
    values: Any,
    static: Floats,
) -> None:
    """Whole shapes of one wire over time, in single precision: 0.5 µm at a height of 6 m."""
    name, place = wire.replace("_", " "), "x" if wire == "contact_wire" else f"{wire}_x"
    height, before = f"height of the {name}", f"height of the {name} before the run"
    shapes = np.asarray(values, dtype=np.float32)
    variables[f"{wire}_height"] = _labelled(("wire_time", place), shapes, "m", height)
    coordinates[place] = _labelled((place,), x, "m", "position along the line")
    coordinates[f"static_{wire}_height"] = _labelled((place,), static, "m", before)


def _labelled(
    dims: tuple[str, ...], values: Any, units: str, name: str
) -> tuple[tuple[str, ...], Any, dict[str, str]]:
    return dims, values, {"units": units, "long_name": name}


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
        "pantographs": [p.model_dump(mode="json") for p in pantographs],
        "speed": speed,
        "positions": start.tolist(),
        "settings": {"mesh": asdict(shape.mesh_settings), "time": asdict(time), "store_wire": store_wire},
        "versions": {name: version(name) for name in ("catenary_fe", "exudyn", "numpy", "scipy", "numba")},
    }


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
        "versions": json.dumps({name: version(name) for name in ("catenary_fe", "exudyn", "numpy", "scipy")}),
    }
