"""A run's curves and motion as plain data, small enough to lie in a page."""

from __future__ import annotations

import base64
from collections.abc import Callable, Sequence
from itertools import cycle, pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.results import Run
from catenary_fe.results.signal import FilterKind
from catenary_fe.statics import HangingWire, Shape
from catenary_fe.views.film import MASS_GAP, Scene, scene
from catenary_fe.views.layout import head_width
from catenary_fe.views.static import RUN_OFF, named_contact_wires
from catenary_fe.views.style import (
    DROPPER,
    MESSENGER,
    SLACK,
    SUPPORT,
    distinct,
    pantograph_colour,
    wire_colour,
)

Floats = NDArray[np.float64]
_POINTS = 8000  # of a curve
_MOTION = 4_000_000  # [bytes] of the player's wire shapes, before base64
_RANGE = 32_000  # of 16-bit numbers
_UPLIFTS = 160_000  # numbers of all supports' uplift together


def force_chart(run: Run, filter: FilterKind) -> dict[str, Any]:
    """Contact force against the position along the line, all pantographs over one axis."""
    positions, every = run.data["position"].values, _stride(run.time.size)
    way = run.speed * run.step * every
    x = np.minimum(np.arange(positions.min(), positions.max() + way / 2, way), positions.max())
    filtered, raw = run.filtered_contact_force(filter), run.data["contact_force"].values
    names, statistics = run.data["pantograph"].values, run.figures(filter)
    series = []
    for i, name in enumerate(names):
        colour = pantograph_colour(i)
        for label, values, faint in (("unfiltered", raw[i], True), ("0 to 20 Hz", filtered[i], False)):
            on_axis = np.interp(x, positions[i], values, left=np.nan, right=np.nan)
            shown = not faint or len(names) == 1
            series.append({"label": f"{name}, {label}", "colour": colour, "faint": faint, "shown": shown,
                           "values": _numbers(on_axis, 1)})  # fmt: skip
    lines = [
        {"value": round(value, 2), "colour": pantograph_colour(i), "dashed": dashed}
        for i, s in enumerate(statistics)
        if s
        for value, dashed in ((s.mean, False), (s.statistical_max, True), (s.statistical_min, True))
    ]
    return {"x": _numbers(x, 3), "series": series, "lines": lines, "band": _evaluated(run),
            "marks": _numbers(run.data["support_position"].values, 3)}  # fmt: skip


def uplift_chart(run: Run) -> dict[str, Any]:
    """Uplift at the supports against time, in mm."""
    count = run.data.sizes["support"]
    every = _stride(run.time.size, min(_POINTS // 2, _UPLIFTS // count))
    uplift = 1e3 * run.data["support_uplift"].values[:, ::every]
    inner = range(1, uplift.shape[0] - 1)
    evaluated = [n - 1 for n in run.uplift_by_support() if n - 1 in inner]
    series = [
        {
            "label": f"support {i + 1}",
            "colour": colour,
            "faint": False,
            "shown": i in evaluated,
            "spans": [i, i + 1],
            "values": _numbers(uplift[i], 1),
        }
        for i, colour in zip(inner, cycle(distinct(8)), strict=False)
    ]
    supports, x = run.data["support_position"].values, run.data["position"].values
    begin, end = supports[min(run.evaluated_spans) - 1], supports[max(run.evaluated_spans)]
    inside = ((x >= begin) & (x <= end)).any(axis=0)
    band = [float(t) for t in run.time[inside][[0, -1]]] if inside.any() else []
    return {"x": _numbers(run.time[::every], 4), "series": series, "lines": [], "band": band, "marks": []}


def line_spans(run: Run) -> dict[str, Any]:
    """What the reader can choose: the spans, and the times in which a pantograph is inside each of them."""
    supports, x = run.data["support_position"].values, run.data["position"].values
    passed = []
    for begin, end in pairwise(supports.tolist()):
        times = run.time[((x >= begin) & (x <= end)).any(axis=0)]
        passed.append([round(float(t), 3) for t in times[[0, -1]]] if times.size else None)
    return {"supports": _numbers(supports, 3), "evaluated": list(run.evaluated_spans), "passed": passed}


def heights_chart(run: Run, shape: Shape) -> dict[str, Any]:
    """Height of the contact wires at rest against the place along the line, where they are in reach."""
    catenary = shape.catenary
    x = np.unique(np.concatenate([wire.x for wire in shape.contact_wires]))
    design = catenary.design_line(x)
    series = [_of_line("design", "#777777", design, 3)]
    for (name, colour), z in _merged(x, named_contact_wires(shape), lambda wire, at: wire.height(at)).items():
        z[z - design > RUN_OFF] = np.nan
        series.append(_of_line(name, colour, z, 4))
    return _along(run, x, series)


def plan_chart(run: Run, shape: Shape) -> dict[str, Any]:
    """Place of contact and messenger wires across the track against the place along the line."""
    x = np.unique(np.concatenate([wire.x for wire in shape.contact_wires]))
    contact = named_contact_wires(shape)
    messenger = [
        (wire, f"messenger wire{name.removeprefix('contact wire')}", MESSENGER)
        for wire, (_, name, _) in zip(
            shape.wires[len(contact) : shape.mesh.first_stitch], contact, strict=False
        )
    ]
    found = _merged(x, [*messenger, *contact], lambda wire, at: wire.lateral(at))
    half = head_width(run.pantographs) / 2
    edges = [{"value": side * half, "colour": "#9aa5b0", "dashed": True, "whole": True} for side in (-1, 1)]
    series = [_of_line(name, colour, y, 4) for (name, colour), y in found.items()]
    return _along(run, x, series) | {"lines": edges}


def _merged(
    x: Floats,
    wires: Sequence[tuple[HangingWire, str, str]],
    value: Callable[[HangingWire, Floats], Floats],
) -> dict[tuple[str, str], Floats]:
    """Values at places x [m] by name and colour; wires of one name lie behind each other along the line."""
    found: dict[tuple[str, str], Floats] = {}
    for wire, name, colour in wires:
        values = found.setdefault((name, colour), np.full(x.size, np.nan))
        own = (x >= wire.x[0]) & (x <= wire.x[-1])
        values[own] = value(wire, x[own])
    return found


def _of_line(label: str, colour: str, values: Floats, digits: int) -> dict[str, Any]:
    faint = label == "design"
    return {
        "label": label,
        "colour": colour,
        "faint": faint,
        "shown": True,
        "values": _numbers(values, digits),
    }


def _along(run: Run, x: Floats, series: list[dict[str, Any]]) -> dict[str, Any]:
    return {"x": _numbers(x, 3), "series": series, "lines": [], "band": _evaluated(run),
            "marks": _numbers(run.data["support_position"].values, 3)}  # fmt: skip


def motion(run: Run) -> dict[str, Any]:
    """What the player draws, wire shapes as 16-bit numbers; frames are left out of very long runs.

    Raises InputError where the run stored no wire shapes.
    """
    wires = run.wires()
    frames = wires[0].time.size
    every = max(1, int(np.ceil(2 * frames * sum(w.x.size for w in wires) / _MOTION)))
    seen = scene(run, np.arange(0, frames, every))
    catenary, names = run.catenary, run.data["pantograph"].values
    return {
        "time": _numbers(seen.time, 4),
        "wires": [_wire(seen, i) for i in range(len(seen.wires))],
        "droppers": {
            "x": _numbers(seen.dropper_x, 3),
            "ends": seen.dropper_ends.tolist(),
            "slack": _base64(seen.dropper_slack.astype(np.uint8)),
        },
        "supports": {
            "x": _numbers(seen.support_x, 3),
            "top": _numbers(catenary.messenger_support_heights, 3),
            "design": _numbers(catenary.design_line(seen.support_x), 4),
        },
        "pantographs": [
            {
                "name": str(name),
                "colour": pantograph_colour(i),
                "x": _numbers(seen.pantograph_x[i], 3),
                "rest": _numbers(seen.rest[i], 5),
                "masses": [_numbers(m, 5) for m in seen.masses[i]],
                "force": _numbers(seen.force[i], 1),
            }
            for i, name in enumerate(names)
        ],
        "mass_gap": MASS_GAP,
        "colours": {"dropper": DROPPER, "slack": SLACK, "support": SUPPORT},
        "band": _evaluated(run),
    }


def _wire(seen: Scene, number: int) -> dict[str, Any]:
    wire = seen.wires[number]
    uplift = np.nan_to_num(wire.uplift)
    unit = max(float(np.abs(uplift).max()) / _RANGE, 1e-9)
    return {
        "name": wire.name,
        "touched": wire.touched,
        "colour": wire_colour(wire.name),
        "x": _numbers(wire.x, 3),
        "static": _numbers(wire.static, 5),
        "unit": unit,
        "uplift": _base64(np.round(uplift / unit).astype("<i2")),
    }


def _evaluated(run: Run) -> list[float]:
    supports, spans = run.data["support_position"].values, run.evaluated_spans
    return [float(supports[min(spans) - 1]), float(supports[max(spans)])]


def _stride(size: int, points: int = _POINTS) -> int:
    return int(np.ceil(size / points))


def _numbers(values: Floats, digits: int) -> list[float | None]:
    """Rounded, with None for what is not a number, which JSON does not know."""
    return [round(v, digits) if np.isfinite(v) else None for v in np.asarray(values, dtype=float).tolist()]


def _base64(values: NDArray[Any]) -> str:
    return base64.b64encode(np.ascontiguousarray(values).tobytes()).decode("ascii")
