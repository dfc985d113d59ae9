"""Waves over place and time: maps, surfaces, families of curves; of a run with its pantographs' paths."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import pairwise
from typing import Any, Literal, get_args

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.layout import InputError, Line
from catenary_fe.layout.arguments import checked, one_of, span_numbers
from catenary_fe.results import Run, WireHistory
from catenary_fe.views.style import CONTACT, new_axes, note_failed, run_title, styled

Floats = NDArray[np.float64]
Quantity = Literal["velocity", "deflection"]
_LINES = ("-", "--", ":", "-.")
_LABELS = {"velocity": "velocity, upwards (mm/s)", "deflection": "uplift (mm)"}
_SHOWN = 99.8  # [%] of the values lie inside the colour scale: a peak at the head would pale the waves


@styled
def plot_space_time(
    x: Floats,
    t: Floats,
    deflection: Floats,
    *,
    lines: Mapping[str, tuple[Floats, Floats]] | None = None,
    supports: Sequence[float] | Floats = (),
    limit: float | None = None,
    quantity: str = "deflection, upwards (mm)",
    title: str = "",
    ax: Axes | None = None,
) -> Axes:
    """Map of the deflection over place and time.

    x, t : [m] shape (points,), [s] shape (times,)
    deflection : [m] shape (times, points)
    lines : where fronts and forces run: name to their places [m] and times [s]
    supports : [m] marked along the bottom
    limit : [m] end of the colour scale; unset: the largest deflection
    quantity : what the colours are, in mm
    """
    ax = new_axes(ax, (8.0, 4.6))
    top = 1e3 * (limit or float(np.abs(deflection).max()))
    mesh = ax.pcolormesh(x, t, 1e3 * deflection, cmap="RdBu_r", vmin=-top, vmax=top, shading="nearest")
    mesh.set_rasterized(True)
    for style, (name, (place, when)) in zip(_LINES * 3, (lines or {}).items(), strict=False):
        ax.plot(place, when, color="black", linestyle=style, linewidth=0.9, label=name)
    if len(supports):
        inside = [s for s in supports if x[0] <= s <= x[-1]]
        ax.plot(inside, np.full(len(inside), t[0]), "k^", markersize=5, clip_on=False, label="support")
    ax.set(xlim=(x[0], x[-1]), ylim=(t[0], t[-1]), xlabel="position (m)", ylabel="time (s)")
    ax.set_title(title, fontsize=10, loc="left")
    figure = ax.get_figure(root=True)
    assert figure is not None
    figure.colorbar(mesh, ax=ax, label=quantity, pad=0.02)
    if lines or len(supports):
        ax.legend(loc="lower right", fontsize=7, framealpha=0.85)
    return ax


@styled
def plot_surface(x: Floats, t: Floats, deflection: Floats, *, title: str = "", ax: Any) -> Any:
    """The deflection as a surface over place and time, on axes with ``projection="3d"``.

    x, t : [m] shape (points,), [s] shape (times,)
    deflection : [m] shape (times, points)
    """
    place, when = np.meshgrid(x, t)
    ax.plot_surface(
        place, when, 1e3 * deflection, cmap="viridis", rcount=60, ccount=160, linewidth=0, antialiased=True
    )
    ax.set_xlabel("position (m)")
    ax.set_ylabel("time (s)")
    ax.set_zlabel("deflection (mm)")
    ax.set_title(title, fontsize=10, loc="left")
    ax.view_init(elev=28, azim=-120)
    return ax


@styled
def plot_family(
    x: Floats,
    curves: Mapping[str, Floats],
    *,
    dashed: Mapping[str, Floats] | None = None,
    title: str = "",
    ax: Axes | None = None,
) -> Axes:
    """Deflections at several instants or for several cases, one below the other on the colour scale.

    x : [m] shape (points,)
    curves : name to deflection [m], shape (points,)
    dashed : likewise, of the same names, drawn over them in black: the reference
    """
    ax = new_axes(ax, (8.0, 4.0))
    for i, (name, values) in enumerate(curves.items()):
        colour = colormaps["viridis"](0.05 + 0.8 * i / (len(curves) - 1)) if len(curves) > 1 else CONTACT
        ax.plot(x, 1e3 * values, color=colour, linewidth=1.6, label=name)
    for i, values in enumerate((dashed or {}).values()):
        label = "reference" if i == 0 else None
        ax.plot(x, 1e3 * values, "k--", linewidth=0.8, label=label)
    ax.set(xlabel="position (m)", ylabel="deflection, upwards (mm)")
    ax.set_title(title, fontsize=10, loc="left")
    ax.grid(color="#dddddd", linewidth=0.6)
    ax.legend(fontsize=8)
    return ax


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
    wire : name of the wire that is shown; of several tension sections "contact wire" and "messenger wire" are
        those of all, each up to the middle of the overlap, "section 2 contact wire" is that section's alone

    The rays start where the leading pantograph passes a support: ahead of it to the next support, back from
    there to the pantograph, and behind it, with the wave speed of the contact wire as a string. Droppers
    scatter waves, bending lets short ones run ahead: real fronts follow the rays loosely.

    Raises InputError where the run stored no wire shapes, or none of that wire.
    """
    one_of("quantity", quantity, get_args(Quantity))
    history = joined_wire(run, wire)
    start, end, begin, stop = _window(run, spans)
    columns = (history.x >= start) & (history.x <= end)
    rows = (history.time >= begin) & (history.time <= stop)
    values = (history.velocity if quantity == "velocity" else history.uplift)[rows][:, columns]
    drawn = plot_space_time(
        history.x[columns],
        history.time[rows],
        values,
        lines=_lines(run, start, end, begin, stop),
        supports=run.data["support_position"].values,
        limit=float(np.nanpercentile(np.abs(values), _SHOWN)),
        quantity=_LABELS[quantity],
        title=run_title(run, f": waves on the {wire}"),
        ax=ax,
    )
    return note_failed(drawn, run.failed_checks)


def joined_wire(run: Run, wire: str) -> WireHistory:
    """The wire of this name, or joined those of this name in all sections."""
    wires = run.wires()
    found = next((w for w in wires if w.name == wire), None)
    if found is None:
        names = ", ".join(f"'{w.name}'" for w in wires)
        raise InputError(f"wire '{wire}': the run stored {names}")
    parts = [found, *(w for w in wires if w.name == f"section {w.section} {wire}")]
    if len(parts) == 1 or not isinstance(run.catenary, Line):
        return found
    middles = [-np.inf, *(float(np.mean(zone)) for zone in run.catenary.common_zones), np.inf]
    shown = [(w.x > a) & (w.x <= b) for w, (a, b) in zip(parts, pairwise(middles), strict=True)]
    each = list(zip(parts, shown, strict=True))
    return WireHistory(
        wire,
        np.concatenate([w.x[own] for w, own in each]),
        np.concatenate([w.static[own] for w, own in each]),
        np.concatenate([w.height[:, own] for w, own in each], axis=1),
        found.time,
    )


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
    rays = {f"wave ahead at {3.6 * c:.0f} km/h, reflected at the next support": ahead, "wave behind": behind}
    return lines | {name: _joined(parts) for name, parts in rays.items() if parts}


def _joined(parts: Sequence[tuple[Floats, Floats]]) -> tuple[Floats, Floats]:
    """Several lines as one, with gaps between them."""
    gap = np.array([np.nan])
    return (
        np.concatenate([np.concatenate([x, gap]) for x, _ in parts]),
        np.concatenate([np.concatenate([t, gap]) for _, t in parts]),
    )
