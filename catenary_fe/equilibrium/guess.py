"""Where form finding starts: wires roughly where they will hang."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from catenary_fe.equilibrium.cut_wires import CutWires
from catenary_fe.fe.wire import WireLine
from catenary_fe.system import GRAVITY, Catenary

Floats = NDArray[np.float64]


def guess_lines(wires: CutWires) -> list[WireLine]:
    """Contact wires at their design heights, the messenger wire on parabolas, stitch wires straight."""
    catenary, mesh = wires.catenary, wires.mesh
    lines = [contact_guess(wires, i) for i in range(mesh.contact_wires)]
    lines.append(_messenger_guess(wires))
    for i, ends in enumerate(mesh.stitch_ends):
        assert catenary.stitch_wire is not None
        x = mesh.wires[mesh.first_stitch + i].x
        a, b = lines[mesh.contact_wires].points[ends]
        rise = (b - a)[1:] / (b - a)[0]
        points = np.column_stack([x, a[1:] + (x - x[0])[:, None] * rise])
        lines.append(WireLine.through(catenary.stitch_wire, points, np.tile(rise, (x.size, 1))))
    return lines


def contact_guess(wires: CutWires, number: int) -> WireLine:
    """A contact wire on straight lines between its design heights and from stagger to stagger."""
    catenary, mesh = wires.catenary, wires.mesh.wires[number]
    droppers = wires.mesh.lower.on(number)
    at = np.concatenate([catenary.support_positions, catenary.dropper_positions[droppers]])
    nominal = np.full(len(catenary.supports), catenary.contact_wire_height)
    heights = np.concatenate([nominal, catenary.design_heights[droppers]])
    order = np.argsort(at)
    z = np.interp(mesh.x, at[order], heights[order])
    y = _staggers(catenary, mesh.x, catenary.staggers) + catenary.contact_wire_offsets[number]
    points, rises = _in_axes(wires.axes, mesh.x, (y, np.gradient(y, mesh.x)), (z, np.gradient(z, mesh.x)))
    return WireLine.through(catenary.contact_wire, points, rises, wires.pulls[number])


def _messenger_guess(wires: CutWires) -> WireLine:
    """Parabolas between the supports, for the weight of all wires."""
    catenary, number = wires.catenary, wires.mesh.contact_wires
    mesh = wires.mesh.wires[number]
    mass = catenary.messenger_wire.mass_per_length + number * catenary.contact_wire.mass_per_length
    heights, positions = catenary.messenger_support_heights, catenary.support_positions
    load = GRAVITY * mass / (2 * catenary.messenger_wire.tension)
    z, slope = np.empty_like(mesh.x), np.empty_like(mesh.x)
    for i in range(len(catenary.spans)):
        a, b = positions[i], positions[i + 1]
        part = slice(mesh.supports[i], mesh.supports[i + 1] + 1)
        x = mesh.x[part]
        rise = (heights[i + 1] - heights[i]) / (b - a)
        z[part] = heights[i] + rise * (x - a) - load * (x - a) * (b - x)
        slope[part] = rise - load * (a + b - 2 * x)
    staggers = np.array([support.messenger_stagger for support in catenary.supports])
    y = _staggers(catenary, mesh.x, staggers)
    points, rises = _in_axes(wires.axes, mesh.x, (y, np.gradient(y, mesh.x)), (z, slope))
    return WireLine.through(catenary.messenger_wire, points, rises, wires.pulls[number])


def _staggers(catenary: Catenary, x: Floats, at_supports: Floats) -> Floats:
    return np.interp(x, catenary.support_positions, at_supports)


def _in_axes(
    axes: int, x: Floats, sideways: tuple[Floats, Floats], up: tuple[Floats, Floats]
) -> tuple[Floats, Floats]:
    """Points and inclinations in the plane or in space, from pairs of coordinate and derivative."""
    kept = (sideways, up) if axes == 3 else (up,)
    return np.column_stack([x, *(value for value, _ in kept)]), np.column_stack([d for _, d in kept])
