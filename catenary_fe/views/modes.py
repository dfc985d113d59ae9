"""Pictures of eigenforms."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.results.modes import Modes, WireShapes
from catenary_fe.views.style import CONTACT, DROPPER, MESSENGER, finish, mark_supports, new_axes


def plot_mode(modes: Modes, mode: int, *, ax: Axes | None = None) -> Axes:
    """Both wires in one eigenform (mode numbered from 0), each about its own line, droppers between them."""
    ax = new_axes(ax, (10.0, 3.0))
    catenary = modes.catenary
    x = np.linspace(0, catenary.length, 120 * len(catenary.spans) + 1)
    wires = {
        "messenger wire": (modes.messenger, 1.0, MESSENGER),
        "contact wire": (modes.contact, -1.0, CONTACT),
    }
    largest = max(np.abs(wire.values[mode]).max() for wire in (modes.contact, modes.messenger))
    mark_supports(ax, catenary.support_positions)
    at = catenary.dropper_positions
    ends = [rest + 0.8 * _shape(wire, mode, at) / largest for wire, rest, _ in wires.values()]
    ax.vlines(at, ends[1], ends[0], color=DROPPER, linewidth=0.6)
    for name, (wire, rest, colour) in wires.items():
        ax.axhline(rest, color="#cccccc", linewidth=0.6)
        ax.plot(x, rest + 0.8 * _shape(wire, mode, x) / largest, color=colour, linewidth=1.3, label=name)
    ax.set_yticks([1.0, -1.0], ["messenger\nwire", "contact\nwire"])
    ax.set_ylim(-2.1, 2.7)  # room for a legend
    ax.margins(x=0.01)
    title = f"mode {mode + 1}: {modes.frequencies[mode]:.3f} Hz, {modes.kind(mode)}"
    return finish(ax, "position along the line (m)", "", title)


def _shape(wire: WireShapes, mode: int, x: np.ndarray) -> np.ndarray:
    return np.asarray(np.interp(x, wire.x, wire.values[mode]))


def plot_spectrum(modes: Modes, *, ax: Axes | None = None) -> Axes:
    """How many modes lie below a frequency, by what they are: clusters are steps."""
    ax = new_axes(ax, (10.0, 3.6))
    kinds = [f"bays, shape {k.half_waves}" if k.kind == "bays" else k.kind for k in modes.kinds()]
    number = np.arange(1, len(modes) + 1)
    names = sorted(set(kinds), key=lambda name: (name == "along", name.startswith("bays"), name))
    colours = (MESSENGER, CONTACT, "#3a7d44", "#7b4fa3", "#b8860b", "#555555", "#008b8b")
    for name, colour in zip(names, colours, strict=False):
        of_kind = np.array([k == name for k in kinds])
        text = "along the track" if name == "along" else name
        label = f"{text}: {of_kind.sum()}"
        ax.plot(modes.frequencies[of_kind], number[of_kind], ".", color=colour, markersize=5, label=label)
    ax.legend(fontsize=8, loc="upper left")
    title = f"{modes.catenary.name}: {len(modes)} modes up to {modes.frequencies[-1]:.1f} Hz"
    return finish(ax, "frequency (Hz)", "number of modes below it", title)
