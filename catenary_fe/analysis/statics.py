"""Static answers: the wires under given forces, and the elasticity along the line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.equilibrium import Shape, check_shape
from catenary_fe.equilibrium.loaded import LoadedLine
from catenary_fe.results import Elasticity
from catenary_fe.system import InputError
from catenary_fe.system.frozen import changed_by_copy

Floats = NDArray[np.float64]


@changed_by_copy
@dataclass(frozen=True)
class StaticState:
    """The catenary under static forces.

    contact_wire_x, contact_wire_z, messenger_wire_x, messenger_wire_z : [m], shape (nodes,)
    contact_wire_uplift : [m], shape (nodes,), above the unloaded shape
    dropper_forces : [N], shape (droppers,)
    """

    contact_wire_x: Floats
    contact_wire_z: Floats
    messenger_wire_x: Floats
    messenger_wire_z: Floats
    contact_wire_uplift: Floats
    dropper_forces: Floats


def solve_statics(shape: Shape, forces: Sequence[tuple[float, float]] = ()) -> StaticState:
    """Static equilibrium under vertical forces on the contact wire; droppers may go slack.

    forces : pairs of position [m] along the line and upward force [N]

    Raises InputError for positions beyond the line, SolverError if there is no equilibrium.
    """
    check_shape(shape)
    _check_positions(shape, np.array([x for x, _ in forces], dtype=float))
    line = LoadedLine(shape)
    system, mesh = line.system, shape.mesh
    moved = line.solve([x for x, _ in forces], [f for _, f in forces])
    total = (system.reference + moved).reshape(-1, 2 * system.axes)
    ends, up = mesh.first_nodes, system.axes - 1
    contact = total[: ends[1]]
    messenger = total[ends[mesh.contact_wires] : ends[mesh.contact_wires + 1]]
    droppers = system.droppers
    return StaticState(
        contact_wire_x=contact[:, 0],
        contact_wire_z=contact[:, up],
        messenger_wire_x=messenger[:, 0],
        messenger_wire_z=messenger[:, up],
        contact_wire_uplift=contact[:, up] - shape.contact_wire_z,
        dropper_forces=droppers.tension(droppers.span(total.ravel())),
    )


def elasticity(
    shape: Shape,
    *,
    force: float = 100.0,
    spans: Sequence[int] | None = None,
    positions: Sequence[float] | Floats | None = None,
    points_per_span: int = 24,
    progress: Callable[[float], None] | None = None,
) -> Elasticity:
    """Uplift of the contact wire under a static force, point by point; droppers may go slack.

    force : [N] upward
    spans : numbers of spans, from 1; unset: the evaluated ones
    positions : [m] along the line, instead of spans
    points_per_span : evenly spread, besides the droppers and supports

    Raises InputError for a force that is not positive or positions beyond the line.
    """
    check_shape(shape)
    if not (np.isfinite(force) and force > 0):
        raise InputError(f"elasticity: force = {force!r} N: must be above 0; 100 to 200 N are usual")
    if points_per_span < 2:
        raise InputError(f"elasticity: points_per_span = {points_per_span}: at least 2 are needed")
    x = (
        _points(shape, spans or shape.catenary.spans_to_evaluate, points_per_span)
        if positions is None
        else np.sort(np.asarray(positions, dtype=float))
    )
    _check_positions(shape, x)
    lifts = LoadedLine(shape).lifts(x, force, progress)
    supports = shape.catenary.support_positions
    inside = supports[(supports >= x[0] - 1e-9) & (supports <= x[-1] + 1e-9)]
    return Elasticity(position=x, uplift=lifts, force=force, support_position=inside)


def _points(shape: Shape, spans: Sequence[int], count: int) -> Floats:
    catenary = shape.catenary
    supports, droppers = catenary.support_positions, catenary.dropper_positions
    parts = []
    for number in spans:
        if not 1 <= number <= len(catenary.spans):
            raise InputError(f"span {number}: the line has spans 1 to {len(catenary.spans)}")
        a, b = supports[number - 1], supports[number]
        parts += [np.linspace(a, b, count + 1), droppers[(droppers > a) & (droppers < b)]]
    return np.unique(np.round(np.concatenate(parts), 9))


def _check_positions(shape: Shape, x: Floats) -> None:
    length = shape.catenary.length
    for value in x:
        if not 0 <= value <= length:
            raise InputError(f"position {value:g} m lies beyond the line, which runs from 0 to {length:g} m")
