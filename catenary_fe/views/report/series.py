"""A run's curves and motion as plain data, small enough to lie in a page."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.results import Run
from catenary_fe.results.signal import FilterKind
from catenary_fe.views.film import MASS_GAP, Scene, scene
from catenary_fe.views.style import pantograph_colour, sequence, wire_colour

Floats = NDArray[np.float64]
_POINTS = 8000  # of a curve
_MOTION = 4_000_000  # [bytes] of the player's wire shapes, before base64
_RANGE = 32_000  # of 16-bit numbers
_SUPPORTS = 15  # all supports' uplift up to so many, else those of the evaluated spans


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
    every = _stride(run.time.size, _POINTS // 4)
    uplift = 1e3 * run.data["support_uplift"].values[:, ::every]
    inner = range(1, uplift.shape[0] - 1)
    evaluated = [n - 1 for n in run.uplift_by_support() if n - 1 in inner]
    shown = [i for i in inner if i in evaluated or len(inner) <= _SUPPORTS]
    colours = dict(zip(evaluated, sequence(len(evaluated)), strict=True))
    series = [
        {
            "label": f"support {i + 1}",
            "colour": colours.get(i, "#999999"),
            "faint": i not in evaluated,
            "shown": True,
            "values": _numbers(uplift[i], 2),
        }
        for i in shown
    ]
    supports, x = run.data["support_position"].values, run.data["position"].values
    begin, end = supports[min(run.evaluated_spans) - 1], supports[max(run.evaluated_spans)]
    inside = ((x >= begin) & (x <= end)).any(axis=0)
    band = [float(t) for t in run.time[inside][[0, -1]]] if inside.any() else []
    return {"x": _numbers(run.time[::every], 4), "series": series, "lines": [], "band": band, "marks": []}


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
