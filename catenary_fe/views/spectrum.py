"""The contact force by frequency."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes

from catenary_fe.layout.arguments import checked, number
from catenary_fe.results import Run, spectrum
from catenary_fe.results.signal import CUT_OFF
from catenary_fe.views.style import PANTOGRAPHS, SUPPORT, finish, headroom, new_axes, note_failed, styled


@checked
@styled
def plot_force_spectrum(run: Run, *, up_to: float = 1.5 * CUT_OFF, ax: Axes | None = None) -> Axes:
    """Amplitudes of the unfiltered contact force while the pantographs are in the evaluated spans.

    up_to : [Hz] end of the axis

    Marked are the frequencies at which the train passes spans and droppers, by their mean distances.
    """
    number("up_to", up_to, "Hz", above=0.0)
    ax = new_axes(ax)
    for i, name in enumerate(run.data["pantograph"].values):
        force = run.data["contact_force"].values[i][run.window(i)]
        frequency, amplitude = spectrum(force, run.step)
        shown = frequency <= up_to
        colour = PANTOGRAPHS[i % len(PANTOGRAPHS)]
        ax.plot(frequency[shown], amplitude[shown], color=colour, marker=".", markersize=3, label=str(name))
    headroom(ax, 0.2)
    ax.set_ylim(bottom=0)
    ax.axvspan(CUT_OFF, up_to, color="#eeeeee", label=f"above the filter's {CUT_OFF:g} Hz")
    for name, distance in _distances(run).items():
        rate = run.speed / distance
        if rate < up_to:
            ax.axvline(rate, color=SUPPORT, linestyle=":", linewidth=0.9)
            ax.text(
                rate,
                0.97,
                f" {name}, {rate:.2g} Hz",
                transform=ax.get_xaxis_transform(),
                fontsize=8,
                va="top",
            )
    ax.legend(loc="upper right", fontsize=8, framealpha=0.9)
    ax.set_xlim(0, up_to)
    title = f"{run.data.attrs['title']}, {3.6 * run.speed:.0f} km/h: spectrum of the contact force"
    return note_failed(finish(ax, "frequency (Hz)", "amplitude (N)", title), run.failed_checks)


def _distances(run: Run) -> dict[str, float]:
    """[m] mean distance of what passes, in the evaluated spans."""
    supports, at = run.data["support_position"].values, run.data["dropper_position"].values
    spans = run.evaluated_spans
    start, end = supports[min(spans) - 1], supports[max(spans)]
    distances = {"spans": float(np.diff(supports)[min(spans) - 1 : max(spans)].mean())}
    inside = at[(at >= start) & (at <= end)]
    if inside.size > 1:
        distances["droppers"] = float(np.diff(inside).mean())
    return distances
