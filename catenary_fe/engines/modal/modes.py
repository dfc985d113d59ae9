"""Modal analysis: eigenfrequencies and shapes of a line about its static state."""

from __future__ import annotations

import logging

import numpy as np

from catenary_fe.layout import counted
from catenary_fe.layout.arguments import checked, number, whole
from catenary_fe.results.modes import Modes, WireShapes
from catenary_fe.statics import Shape

_HIGHEST = 1e4  # [Hz] no mesh of a line resolves more
_log = logging.getLogger(__name__)


@checked
def solve_modes(shape: Shape, *, count: int | None = None, below: float | None = None) -> Modes:
    """Eigenfrequencies and shapes about the static state, droppers taut; sparse, so that long lines work.

    shape : the catenary in static equilibrium, with its mesh
    count : how many modes, from the lowest, as far as the mesh holds them; unset, and with no ``below``: 40
    below : [Hz] all modes up to this frequency (with ``count``: at most so many)

    Raises InputError for a count or frequency that is not positive, more than a third of all modes of a long
    line, or a dropper that is slack at rest; SolverError where the eigenvalue iteration fails.
    """
    from catenary_fe.engines.modal.eigen import linear_system, solve_eigen

    if count is not None:
        whole("modes: count", count, least=1)
    if below is not None:
        number("modes: below", below, "Hz", above=0.0, most=_HIGHEST)
    system = linear_system(shape.catenary, shape.mesh, shape.installation)
    nodes = [wire.x.size for wire in shape.mesh.wires]
    wanted = count or (40 if below is None else _expected(shape, below))
    pairs = solve_eigen(system, nodes, wanted)
    while below is not None and count is None and pairs.frequencies[-1] <= below:
        if wanted >= system.size - 1:
            break
        wanted = min(int(1.3 * wanted) + 10, system.size - 1)
        pairs = solve_eigen(system, nodes, wanted)
    up = system.node_width // 2 - 1
    contact, messenger = (
        WireShapes(
            shape.wires[wire].x,
            pairs.shapes[wire][:, :, up],
            pairs.shapes[wire][:, :, -1],
            pairs.shapes[wire][:, :, 1] if up > 1 else None,
        )
        for wire in (0, shape.mesh.contact_wires)
    )
    modes = Modes(
        shape.catenary,
        pairs.frequencies,
        contact,
        messenger,
        pairs.along,
        pairs.sideways,
        pairs.damping_ratios,
    )
    modes = modes if below is None else modes.below(below)
    for warning in mode_warnings(shape, modes):
        _log.warning(warning)
    return modes


def mode_warnings(shape: Shape, modes: Modes) -> list[str]:
    """What to know before trusting modes: the rule and both numbers."""
    wires = (
        (shape.catenary.contact_wire, shape.mesh.contact.x),
        (shape.catenary.messenger_wire, shape.mesh.messenger.x),
    )
    resolved = min(wire.wave_speed / (2 * float(np.diff(x).max())) for wire, x in wires)
    above = int((modes.frequencies > resolved).sum())
    if not above:
        return []
    return [
        f"above {resolved:.0f} Hz waves are shorter than two elements: {counted(above, 'mode')}, up to"
        f" {modes.frequencies[-1]:.0f} Hz; refine the mesh, or leave them out"
    ]


def _expected(shape: Shape, below: float) -> int:
    """Modes of the two wires as strings with as many half-waves along the line, and some to spare."""
    wires = shape.catenary.contact_wire, shape.catenary.messenger_wire
    strings = sum(2 * shape.catenary.length * below / wire.wave_speed for wire in wires)
    return int(1.1 * strings) + 10
