"""Pictures of eigenforms."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.layout import counted
from catenary_fe.layout.arguments import checked
from catenary_fe.results.modes import IN_WORDS, Modes, WireShapes
from catenary_fe.views.style import (
    CONTACT,
    DROPPER,
    MESSENGER,
    distinct,
    finish,
    mark_supports,
    new_axes,
    styled,
)


@checked
@styled
def plot_mode(modes: Modes, mode: int, *, ax: Axes | None = None) -> Axes:
    """Both wires in one eigenform (mode numbered from 0), each about its own line, droppers between them.

    Drawn is the vertical motion, of a mode that swings sideways the motion to the left.
    """
    ax = new_axes(ax, (10.0, 3.0))
    catenary = modes.catenary
    x = np.linspace(0, catenary.length, 120 * len(catenary.spans) + 1)
    wires = {
        "messenger wire": (modes.messenger, 1.0, MESSENGER),
        "contact wire": (modes.contact, -1.0, CONTACT),
    }
    kind = modes.kind(mode)
    drawn = {name: _drawn(wire, mode, kind.kind == "sideways") for name, (wire, _, _) in wires.items()}
    largest = max(np.abs(shape).max() for shape in drawn.values())
    mark_supports(ax, catenary.support_positions)
    at = catenary.dropper_positions

    def place(name: str, at: np.ndarray) -> np.ndarray:
        wire, rest, _ = wires[name]
        return np.asarray(rest + 0.8 * np.interp(at, wire.x, drawn[name]) / largest)

    ends = [place(name, at) for name in wires]
    ax.vlines(at, ends[1], ends[0], color=DROPPER, linewidth=0.6)
    for name, (_, rest, colour) in wires.items():
        ax.axhline(rest, color="#cccccc", linewidth=0.6)
        ax.plot(x, place(name, x), color=colour, linewidth=1.3, label=name)
    ax.set_yticks([1.0, -1.0], ["messenger\nwire", "contact\nwire"])
    ax.set_ylim(-2.1, 2.7)  # room for a legend
    ax.margins(x=0.01)
    part = {"along": " (its vertical part, magnified)", "sideways": " (seen from above)"}.get(kind.kind, "")
    title = f"mode {mode + 1}: {modes.frequencies[mode]:.3f} Hz, {kind}{part}"
    return finish(ax, "position along the line (m)", "", title)


def _drawn(wire: WireShapes, mode: int, sideways: bool) -> np.ndarray:
    shapes = wire.lateral if sideways and wire.lateral is not None else wire.values
    return np.asarray(shapes[mode])


@checked
@styled
def plot_spectrum(modes: Modes, *, ax: Axes | None = None) -> Axes:
    """How many modes lie below a frequency, by what they are: clusters are steps."""
    ax = new_axes(ax, (10.0, 3.6))
    kinds = [f"bays, shape {k.half_waves}" if k.kind == "bays" else k.kind for k in modes.kinds()]
    number = np.arange(1, len(modes) + 1)
    names = sorted(set(kinds), key=lambda name: (name in IN_WORDS, name.startswith("bays"), name))
    for name, colour in zip(names, distinct(len(names)), strict=True):
        of_kind = np.array([k == name for k in kinds])
        label = f"{IN_WORDS.get(name, name)}: {of_kind.sum()}"
        ax.plot(modes.frequencies[of_kind], number[of_kind], ".", color=colour, markersize=5, label=label)
    ax.legend(fontsize=8, loc="upper left")
    title = f"{modes.catenary.name}: {counted(len(modes), 'mode')} up to {modes.frequencies[-1]:.1f} Hz"
    return finish(ax, "frequency (Hz)", "number of modes below it", title)
