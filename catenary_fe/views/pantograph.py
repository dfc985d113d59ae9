"""A pantograph by itself: how its head yields over the frequency, and how its static force depends on it."""

from __future__ import annotations

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from catenary_fe.layout.arguments import checked
from catenary_fe.results import PantographResponse
from catenary_fe.views import style

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]
OVER = "frequency (Hz)"


@checked
@style.styled
def plot_pantograph(response: PantographResponse) -> Axes:
    """Receptance with its phase, dynamic stiffness, and the static force where it depends on the height.

    Where a measured receptance describes the pantograph, the picture has its values, and by how much the
    chain of masses is off them.

    response : as :func:`catenary_fe.pantograph_response` returned it

    Returns the first axes.
    """
    drawn = [] if not response.receptance.size else [_receptance, _phase, _stiffness]
    if response.pantograph.measured is not None:
        drawn.append(_errors)
    if response.force_varies or not drawn:
        drawn.append(_force)
    panels = style.new_panels((9.0, 1.2 + 2.3 * len(drawn)), [1.3] + [1.0] * (len(drawn) - 1))
    for draw, ax in zip(drawn, panels, strict=True):
        draw(ax, response)
    panels[0].set_title(
        f"{response.pantograph.name}: base at rest, without the wire", fontsize=10, loc="left"
    )
    return panels[0]


def _receptance(ax: Axes, response: PantographResponse) -> None:
    measured = response.pantograph.measured
    if measured is not None:
        ax.loglog(measured[0], np.abs(measured[1]), ".", color=style.CONTACT, markersize=5, label="table")
        text = f"chain of {len(response.pantograph.masses)} masses"
        ax.loglog(
            response.frequency, np.abs(response.receptance), color=style.MESSENGER, linewidth=1.1, label=text
        )
        ax.legend(fontsize=8, loc="lower left", framealpha=0.9)
    else:
        ax.loglog(response.frequency, np.abs(response.receptance), color=style.MESSENGER, linewidth=1.1)
    _own_frequencies(ax, response)
    style.finish(ax, OVER, "receptance (m/N)", "")


def _phase(ax: Axes, response: PantographResponse) -> None:
    measured = response.pantograph.measured
    if measured is not None:
        ax.semilogx(measured[0], _degrees(measured[1]), ".", color=style.CONTACT, markersize=5)
    ax.semilogx(response.frequency, _degrees(response.receptance), color=style.MESSENGER, linewidth=1.1)
    ax.set_ylim(-200, 20)
    ax.set_yticks([-180, -135, -90, -45, 0])
    _own_frequencies(ax, response)
    style.finish(ax, OVER, "its phase (°)", "")


def _degrees(values: Complex) -> Floats:
    """Between -270° and 90°: noise about 0 and -180° does not jump."""
    return np.asarray((np.rad2deg(np.angle(values)) + 270) % 360 - 270)


def _stiffness(ax: Axes, response: PantographResponse) -> None:
    stiffness = np.abs(response.dynamic_stiffness)
    ax.loglog(response.frequency, stiffness, color=style.MESSENGER, linewidth=1.1)
    mass = sum(response.pantograph.masses)
    if mass:
        omega = 2 * np.pi * response.frequency
        label = f"all masses as one, {mass:.3g} kg"
        ax.loglog(response.frequency, mass * omega**2, "--", color=style.DROPPER, linewidth=0.9, label=label)
        ax.legend(fontsize=8, loc="lower right", framealpha=0.9)
    ax.set_ylim(stiffness.min() / 2, 2 * stiffness.max())
    _own_frequencies(ax, response)
    style.finish(ax, OVER, "dynamic stiffness (N/m)", "")


def _errors(ax: Axes, response: PantographResponse) -> None:
    measured = response.pantograph.measured
    assert measured is not None
    percent = 100 * response.pantograph.errors
    ax.semilogx(measured[0], percent, ".", color=style.CONTACT, markersize=5)
    ax.set_ylim(0, max(1.0, 1.1 * percent.max()))
    _own_frequencies(ax, response)
    style.finish(ax, OVER, "error of the chain (%)", "")


def _force(ax: Axes, response: PantographResponse) -> None:
    ax.plot(response.height, response.force, color=style.MESSENGER, linewidth=1.1)
    ax.set_ylim(0, 1.15 * max(response.force.max(), 1.0))
    ax.margins(x=0.01)
    style.finish(ax, "height of the head (m)", "static force (N)", "")


def _own_frequencies(ax: Axes, response: PantographResponse) -> None:
    """Thin lines at the own frequencies within the axes."""
    low, high = response.frequency[[0, -1]]
    for f in response.own_frequencies[(response.own_frequencies > low) & (response.own_frequencies < high)]:
        ax.axvline(f, color=style.SUPPORT, linewidth=0.7, linestyle=":")
    ax.set_xlim(low, high)
