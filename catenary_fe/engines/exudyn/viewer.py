"""A model in Exudyn's own viewer, where there is a screen."""

from __future__ import annotations

import ctypes
import os
import sys
from ctypes.util import find_library

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.build import ExudynModel, exudyn_model
from catenary_fe.layout import InputError
from catenary_fe.statics import Shape

_SIZE = 1280, 640  # [pixels]
_CONTACT, _MESSENGER = [0.77, 0.31, 0.11, 1.0], [0.12, 0.35, 0.52, 1.0]


def view_model(shape: Shape, spans: tuple[int, int], *, wait: bool = True) -> NDArray[np.uint8]:
    """Show the model at rest until the viewer is closed; returns what it showed first, shape (y, x, 3).

    spans : first and last one in view, from 1
    wait : false: close it at once

    Raises InputError where there is no screen.
    """
    require_screen()
    model, catenary = exudyn_model(shape), shape.catenary
    _dress(model)
    container = model.mbs.variables["container"]
    settings = container.visualizationSettings
    settings.window.renderWindowSize = list(_SIZE)
    settings.openGL.lineWidth = 3
    settings.openGL.multiSampling = 4
    settings.general.autoFitScene = False
    settings.general.drawWorldBasis = False
    settings.general.drawCoordinateSystem = False
    settings.general.showSolverInformation = False
    settings.nodes.show = False
    settings.markers.show = False
    settings.loads.show = False
    settings.general.rendererStartupTimeout = 30_000  # ms, for a busy machine
    try:
        started = container.renderer.Start()
    except exu.InternalError:
        started = False
    if not started:
        raise InputError("the viewer's window did not open; look at the graphics driver (OpenGL)")
    try:
        left, right = catenary.support_positions[[spans[0] - 1, spans[1]]]
        middle = catenary.contact_wire_height + catenary.system_height / 2
        height = 0.53 * (right - left) * _SIZE[1] / _SIZE[0]  # above and below the middle
        turned = [0.0, 0.0, 0.0] if not model.system.spatial else [-np.pi / 2, 0.0, 0.0]  # its y points up
        centre = [(left + right) / 2, middle, 0.0]  # as seen, after the turn
        container.renderer.SetModelView(zoom=height, rotationVector=turned, centerPoint=centre)
        picture: NDArray[np.uint8] = np.asarray(container.renderer.RedrawAndGetImage(), dtype=np.uint8)
        if wait:
            container.renderer.DoIdleTasks(-1, False)
    finally:
        container.renderer.Stop()
    return picture


def _dress(model: ExudynModel) -> None:
    """Wires in their colours; the springs to the ground, which stands at the origin, are not shown."""
    mbs = model.mbs
    for number, wire in enumerate(model.wires):
        colour = _CONTACT if number < len(model.contact_wires) else _MESSENGER
        for element in wire.elements:
            mbs.SetObjectParameter(element, "Vcolor", colour)
    for number in (*model.supports.values(), *model.holds.values(), *model.clamps.values()):
        mbs.SetObjectParameter(number, "Vshow", False)


def require_screen() -> None:
    """Raises InputError where no window can be opened: Exudyn would end the whole program there."""
    if sys.platform != "linux" or _x_server_answers():
        return
    display = os.environ.get("DISPLAY")
    there = f"the X server {display} does not answer" if display else "DISPLAY is not set"
    raise InputError(
        f"no screen for Exudyn's viewer: {there}; run it at a desktop, or see the line in a report instead:"
        " catenary-fe info LAYOUT -o DIR draws it, catenary-fe report DIR moves it"
    )


def _x_server_answers() -> bool:
    name = find_library("X11")
    if not (name and os.environ.get("DISPLAY")):
        return False
    library = ctypes.CDLL(name)
    library.XOpenDisplay.restype = ctypes.c_void_p
    display = library.XOpenDisplay(None)
    if display:
        library.XCloseDisplay(ctypes.c_void_p(display))
    return bool(display)
