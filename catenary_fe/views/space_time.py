"""Waves on a wire over place and time: maps, surfaces, families of curves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.views.style import CONTACT, new_axes, styled

Floats = NDArray[np.float64]
_LINES = ("-", "--", ":", "-.")


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
        colour = family_colour(i, len(curves))
        ax.plot(x, 1e3 * values, color=colour, linewidth=1.6, label=name)
    for i, values in enumerate((dashed or {}).values()):
        label = "reference" if i == 0 else None
        ax.plot(x, 1e3 * values, "k--", linewidth=0.8, label=label)
    ax.set(xlabel="position (m)", ylabel="deflection, upwards (mm)")
    ax.set_title(title, fontsize=10, loc="left")
    ax.grid(color="#dddddd", linewidth=0.6)
    ax.legend(fontsize=8)
    return ax


def family_colour(number: int, count: int) -> Any:
    """Colours that rise with the number of a curve in its family."""
    from matplotlib import colormaps

    return CONTACT if count == 1 else colormaps["viridis"](0.05 + 0.8 * number / max(1, count - 1))
