"""Runs whose histories are given, so that all that is computed from them is known beforehand."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

import numpy as np
import xarray as xr

import catenary_fe as cf
from catenary_fe.results.run import FORMAT

HEIGHT = 5.3  # [m] nominal, of the contact wire
AnyPantograph = cf.Pantograph | cf.ElasticPantograph


def made_line(
    lengths: Sequence[float] = (50.0,) * 6, dropper_every: float = 10.0, **others: Any
) -> cf.Catenary:
    """Straight spans with droppers at equal distances, nothing else; waves run at 100 and 120 m/s."""
    spans = [
        cf.Span(
            length=a, droppers=[cf.Dropper(position=x) for x in np.arange(dropper_every, a, dropper_every)]
        )
        for a in lengths
    ]
    values = {
        "contact_wire": cf.Wire(mass_per_length=1.0, tension=10e3, axial_stiffness=1e7),
        "messenger_wire": cf.Wire(mass_per_length=1.0, tension=14.4e3, axial_stiffness=1e7),
        "supports": [cf.Support()] * (len(spans) + 1),
        "contact_wire_height": HEIGHT,
    }
    return cf.Catenary(spans=spans, **(values | others))


def made_pantograph(*stages: tuple[float, float, float], **others: Any) -> cf.Pantograph:
    """Of (mass, stiffness, damping), head first; unset: one light head on a spring."""
    chain = [cf.Stage(mass=m, stiffness=k, damping=c) for m, k, c in stages or [(10.0, 100.0, 10.0)]]
    return cf.Pantograph(**({"stages": chain, "uplift_force": 100.0} | others))


def made_run(
    line: cf.Catenary | None = None,
    *pantographs: AnyPantograph,
    speed: float = 50.0,
    step: float = 2e-3,
    times: int = 2001,
    start: Sequence[float] = (5.0,),
    mesh: Mapping[str, float] | None = None,
    wall_s: float | None = None,
    extra: Mapping[str, Any] | None = None,
    **given: Any,
) -> cf.Run:
    """A run at rest (100 N, everything at its nominal place), but for what is given.

    extra : further variables, as xarray takes them
    given : variables by name, as arrays that are spread over their shape, or attributes by name
    """
    line, pantographs = line or made_line(), pantographs or (made_pantograph(),)
    time = step * np.arange(times)
    data = xr.Dataset(
        _at_rest(line, pantographs, np.asarray(start)[:, None] + speed * time) | dict(extra or {}),
        {
            "time": ("time", time),
            "pantograph": ("pantograph", [p.name for p in pantographs]),
            "dropper_position": ("dropper", line.dropper_positions),
            "dropper_span": ("dropper", line.dropper_spans),
            "support_position": ("support", line.support_positions),
        },
        _provenance(line, pantographs, speed, asdict(cf.MeshSettings()) if mesh is None else dict(mesh)),
    )
    for name, values in given.items():
        if name in data:
            data[name].values[:] = values
        else:
            data.attrs[name] = values
    return cf.Run(data, wall_s)


def _at_rest(line: cf.Catenary, pantographs: Sequence[AnyPantograph], position: np.ndarray) -> dict[str, Any]:
    n, times = position.shape
    masses = [_masses(p) for p in pantographs]
    heights = np.full((n, max(1, *masses, 1), times), np.nan)
    for own, count in zip(heights, masses, strict=True):
        own[:count] = HEIGHT
    return {
        "position": (("pantograph", "time"), position),
        "contact_force": (("pantograph", "time"), np.full((n, times), 100.0)),
        "wire_height": (("pantograph", "time"), np.full((n, times), HEIGHT)),
        "mass_height": (("pantograph", "mass", "time"), heights),
        "uplift_force": ("pantograph", np.full(n, 100.0)),
        "dropper_force": (("dropper", "time"), np.full((len(line.droppers), times), 50.0)),
        "support_uplift": (("support", "time"), np.zeros((len(line.supports), times))),
    }


def _masses(pantograph: AnyPantograph) -> int:
    if isinstance(pantograph, cf.ElasticPantograph):
        return 0
    return len(pantograph.stages) + (pantograph.head.strips - 1 if pantograph.head else 0)


def _provenance(
    line: cf.Catenary, pantographs: Sequence[AnyPantograph], speed: float, mesh: dict[str, float]
) -> dict[str, Any]:
    return {
        "format": FORMAT,
        "title": line.name,
        "method": "nonlinear",
        "speed": speed,
        "evaluated_spans": json.dumps(line.spans_to_evaluate),
        "catenary": line.model_dump_json(),
        "pantographs": json.dumps([p.model_dump(mode="json") for p in pantographs]),
        "settings": json.dumps({"mesh": mesh, "time": asdict(cf.TimeSettings())}),
        "versions": json.dumps({"catenary_fe": "0"}),
        "warnings": "[]",
    }
