"""Static answers: the wires under given forces, and the elasticity along the line."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import checked, number, numbers, on_the_wire, span_numbers, whole
from catenary_fe.layout.parameters import changed_by_copy, shorten
from catenary_fe.results import Elasticity
from catenary_fe.statics import LineShape, Shape
from catenary_fe.statics.loaded import LoadedLine

Floats = NDArray[np.float64]
MOST_FORCE = 1e4  # [N] more would lift the wire over its supports
POINTS = 24  # of a span
MOST_POINTS = 10_000


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


@checked
def solve_statics(shape: Shape, forces: Sequence[tuple[float, float]] = ()) -> StaticState:
    """Static equilibrium under vertical forces on the contact wire; droppers may go slack.

    forces : pairs of position [m] along the line and upward force [N]

    Raises InputError for positions beyond the line and for lines of several sections, SolverError if there
    is no equilibrium.
    """
    if isinstance(shape, LineShape):
        raise InputError(
            f"static state of {len(shape.sections)} tension sections, which do not move each other; take one"
            " of shape.sections"
        )
    pairs = numbers("forces", forces, each="pairs of position and force")
    if pairs.size and (pairs.ndim != 2 or pairs.shape[1] != 2):
        raise InputError(f"forces = {shorten(forces)}: must be pairs of position [m] and force [N]")
    x, force = pairs.reshape(-1, 2).T
    x = on_the_wire("position", x, shape.catenary.support_positions)
    line = LoadedLine(shape)
    system, mesh = line.system, shape.mesh
    moved = line.solve(x.tolist(), force.tolist())
    total = (system.reference + moved).reshape(-1, 2 * system.axes)
    ends, up = mesh.first_nodes, system.axes - 1
    contact = total[: ends[1]]
    messenger = total[ends[mesh.contact_wires] : ends[mesh.first_stitch]]
    droppers = system.droppers
    return StaticState(
        contact_wire_x=contact[:, 0],
        contact_wire_z=contact[:, up],
        messenger_wire_x=messenger[:, 0],
        messenger_wire_z=messenger[:, up],
        contact_wire_uplift=contact[:, up] - shape.contact_wire_z,
        dropper_forces=droppers.tension(droppers.span(total.ravel())),
    )


@checked
def elasticity(
    shape: Shape,
    *,
    force: float = 100.0,
    spans: Sequence[int] | None = None,
    positions: Sequence[float] | Floats | None = None,
    points_per_span: int | None = None,
    progress: Callable[[float], None] | None = None,
) -> Elasticity:
    """Uplift of the contact wire under a static force, point by point; droppers may go slack.

    force : [N] upward
    spans : numbers of spans, from 1; unset: the evaluated ones
    positions : [m] along the line, instead of spans
    points_per_span : evenly spread, besides the droppers and supports; unset: 24

    Raises InputError for a force that is not positive, positions beyond the line, and for positions beside
    spans or points_per_span.
    """
    catenary = shape.catenary
    number("elasticity: force", force, "N", above=0.0, most=MOST_FORCE, remedy="100 to 200 N are usual")
    if positions is None:
        count = POINTS if points_per_span is None else points_per_span
        whole("elasticity: points_per_span", count, least=2, most=MOST_POINTS)
        numbered = span_numbers(spans, len(catenary.spans), catenary.spans_to_evaluate)
        x = _points(shape, numbered, count)
    elif spans is not None or points_per_span is not None:
        raise InputError("elasticity: positions and spans or points_per_span: give one or the other")
    else:
        x = np.sort(np.atleast_1d(on_the_wire("position", positions, catenary.support_positions)))
    if x.ndim != 1 or not x.size:
        raise InputError(f"elasticity: positions = {shorten(positions)}: must be a list of positions [m]")
    lifts = _lifts(shape, x, force, progress)
    supports = catenary.support_positions
    inside = supports[(supports >= x[0] - 1e-9) & (supports <= x[-1] + 1e-9)]
    return Elasticity(position=x, uplift=lifts, force=force, support_position=inside)


def _lifts(shape: Shape, x: Floats, force: float, progress: Callable[[float], None] | None) -> Floats:
    """[m], shape (points,): of the contact wire at places x [m]; of several sections, of the lower one's."""
    if not isinstance(shape, LineShape):
        return LoadedLine(shape).lifts(x, force, progress)
    if shape.has_effect:
        raise InputError(
            "elasticity of several sections is that of each by itself, without what with_effect added to the"
            " line; add it to a section: shape.sections[0].with_effect(...)"
        )
    paths, lifts = shape.system.contact_paths, np.empty(x.size)
    section = np.array([paths[shape.system.served(place)[0]].section for place in x.tolist()])
    for n in np.unique(section).tolist():
        mine = np.flatnonzero(section == n)
        own = x[mine] - shape.catenary.begins[n]
        lifts[mine] = LoadedLine(shape.sections[n]).lifts(own, force, None)
        if progress:
            progress((int(mine[-1]) + 1) / x.size)
    return lifts


def _points(shape: Shape, spans: Sequence[int], count: int) -> Floats:
    catenary = shape.catenary
    supports, droppers = catenary.support_positions, catenary.dropper_positions
    parts = []
    for n in spans:
        a, b = supports[n - 1], supports[n]
        parts += [np.linspace(a, b, count + 1), droppers[(droppers > a) & (droppers < b)]]
    return np.unique(np.round(np.concatenate(parts), 9))
