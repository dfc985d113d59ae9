"""Waves of a run over place and time, with the pantographs' paths and the rays of the wave speed."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Literal, get_args

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import checked, one_of, span_numbers
from catenary_fe.results import Run
from catenary_fe.views.space_time import plot_space_time
from catenary_fe.views.style import note_failed, styled

Floats = NDArray[np.float64]
Quantity = Literal["velocity", "deflection"]
_LABELS = {"velocity": "velocity, upwards (mm/s)", "deflection": "uplift (mm)"}
_SHOWN = 99.8  # [%] of the values lie inside the colour scale: a peak at the head would pale the waves


@checked
@styled
def plot_run_waves(
    run: Run,
    *,
    quantity: Quantity = "velocity",
    spans: Sequence[int] | None = None,
    wire: str = "contact wire",
    ax: Axes | None = None,
) -> Axes:
    """Map of a wire's velocity or uplift over place and time.

    quantity : "velocity", which shows waves of all sizes, or "deflection", above the static shape
    spans : numbers of the spans, from 1; unset: the evaluated ones and one on either side
    wire : name of the wire that is shown

    The rays start where the leading pantograph passes a support: ahead of it to the next support, back from
    there to the pantograph, and behind it, with the wave speed of the contact wire as a string. Droppers
    scatter waves, bending lets short ones run ahead: real fronts follow the rays loosely.

    Raises InputError where the run stored no wire shapes, or none of that wire.
    """
    one_of("quantity", quantity, get_args(Quantity))
    history = next((w for w in run.wires() if w.name == wire), None)
    if history is None:
        names = ", ".join(f"'{w.name}'" for w in run.wires())
        raise InputError(f"wire '{wire}': the run stored {names}")
    start, end, begin, stop = _window(run, spans)
    columns = (history.x >= start) & (history.x <= end)
    rows = (history.time >= begin) & (history.time <= stop)
    values = (history.velocity if quantity == "velocity" else history.uplift)[rows][:, columns]
    title = f"{run.data.attrs['title']}, {3.6 * run.speed:.0f} km/h: waves on the {wire}"
    drawn = plot_space_time(
        history.x[columns],
        history.time[rows],
        values,
        lines=_lines(run, start, end, begin, stop),
        supports=run.data["support_position"].values,
        limit=float(np.nanpercentile(np.abs(values), _SHOWN)),
        quantity=_LABELS[quantity],
        title=title,
        ax=ax,
    )
    return note_failed(drawn, run.failed_checks)


def _window(run: Run, spans: Sequence[int] | None) -> tuple[float, float, float, float]:
    """Place and time shown: from when the first pantograph enters until the last one leaves."""
    supports = run.data["support_position"].values
    evaluated, count = run.evaluated_spans, supports.size - 1
    around = range(max(1, min(evaluated) - 1), min(count, max(evaluated) + 1) + 1)
    numbers = span_numbers(spans, count, around)
    start, end = float(supports[min(numbers) - 1]), float(supports[max(numbers)])
    positions = run.data["position"].values
    first, last = positions.max(axis=0), positions.min(axis=0)
    begin = run.time[min(int(np.searchsorted(first, start)), run.time.size - 1)]
    stop = run.time[min(int(np.searchsorted(last, end)), run.time.size - 1)]
    if stop <= begin:
        raise InputError(f"no pantograph was ever inside spans {numbers}")
    return start, end, float(begin), float(stop)


def _lines(run: Run, start: float, end: float, begin: float, stop: float) -> dict[str, tuple[Floats, Floats]]:
    positions, names = run.data["position"].values, run.data["pantograph"].values
    lines = {str(name): (x, run.time) for name, x in zip(names, positions, strict=True)}
    lead = positions[np.argmax(positions[:, 0])]
    v, c = run.speed, run.catenary.contact_wire.wave_speed
    supports = run.data["support_position"].values
    ahead: list[tuple[Floats, Floats]] = []
    behind: list[tuple[Floats, Floats]] = []
    for a, b in pairwise(supports[(supports >= max(start, lead[0])) & (supports <= end)]):
        t = (a - lead[0]) / v
        if c > v:
            meeting = t + 2 * (b - a) / (c + v)
            ahead.append((np.array([a, b, a + v * (meeting - t)]), np.array([t, t + (b - a) / c, meeting])))
        behind.append((np.array([a, start]), np.array([t, t + (a - start) / c])))
    rays = {
        f"wave ahead at {3.6 * c:.0f} km/h, reflected at the next support": ahead,
        "wave behind": behind,
    }
    return lines | {name: _joined(parts) for name, parts in rays.items() if parts}


def _joined(parts: Sequence[tuple[Floats, Floats]]) -> tuple[Floats, Floats]:
    """Several lines as one, with gaps between them."""
    gap = np.array([np.nan])
    return (
        np.concatenate([np.concatenate([x, gap]) for x, _ in parts]),
        np.concatenate([np.concatenate([t, gap]) for _, t in parts]),
    )
