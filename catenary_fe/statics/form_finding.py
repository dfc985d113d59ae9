"""Form finding: dropper lengths that give the contact wire its design height, and the reverse."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.mesh import MeshSettings
from catenary_fe.layout import Catenary
from catenary_fe.layout.arguments import checked
from catenary_fe.layout.catenary_rules import check_lengths
from catenary_fe.statics.hanging import Hanging
from catenary_fe.statics.rules import check_pulls, check_room, check_stretch, given_lengths
from catenary_fe.statics.shape import Shape

Floats = NDArray[np.float64]

_SETTLED = 1e-8  # [m] change from pass to pass, where form finding ends
_PASSES = 100  # four are enough in the plane, more where much hangs on how the droppers lean


@checked
def find_form(catenary: Catenary, mesh: MeshSettings | None = None) -> Shape:
    """The static shape of a line; where its droppers have no lengths, with those that its design takes.

    A line whose droppers all have a length is hung with these, and the contact wire lies where they let it
    (``shape.height_errors``); ``catenary.without_dropper_lengths()`` is the same line without. Otherwise each
    dropper gets the length with which the contact wire has its design height there:

    The contact wires, held at their design heights, give the droppers' pull; stitch and messenger wires,
    loaded with it, give the room between the wires and, in space, how the droppers lean. Each is a linear
    problem; they are solved in turn until nothing changes.

    mesh : element lengths; a shape belongs to its mesh

    Raises InputError where only some droppers have a length, for impossible lengths, and for a design in
    which a dropper or a steady arm would have to push or has no room; SolverError where the passes do not
    come to an end.
    """
    check_lengths(catenary)
    if catenary.gives_dropper_lengths:
        return find_heights(catenary, None, mesh)
    hanging = Hanging(catenary, mesh or MeshSettings())
    lengths = np.zeros(len(catenary.droppers))
    for _ in range(_PASSES):
        before = lengths
        hanging.hang()
        check_pulls(catenary, hanging.pull)
        span = hanging.spread()
        check_room(catenary, span[:, -1])
        distance = np.linalg.norm(span, axis=1)
        tension = hanging.pull * distance / span[:, -1]
        check_stretch(catenary, distance, tension)
        lengths = distance - tension / hanging.stiffness
        hanging.take_lengths(lengths)
        if np.abs(lengths - before).max(initial=0.0) < _SETTLED:
            break
    else:
        raise hanging.restless("form finding: dropper lengths still change", lengths - before)
    return hanging.shape(lengths)


@checked
def find_heights(
    catenary: Catenary, lengths: Sequence[float] | Floats | None = None, mesh: MeshSettings | None = None
) -> Shape:
    """The reverse of form finding: the static shape that given dropper lengths result in.

    The shape's catenary has these lengths, so that a run on it records them.

    lengths : [m], shape (droppers,), stress-free; unset: those that the layout gives
    mesh : element lengths; a shape belongs to its mesh

    Raises InputError for missing or impossible lengths, SolverError where no equilibrium is found.
    """
    lengths = given_lengths(catenary, lengths)
    hanging = Hanging(catenary.with_dropper_lengths(lengths), mesh or MeshSettings())
    hanging.take_lengths(lengths)
    hanging.hang()
    for _ in range(_PASSES):
        before = hanging.found.copy()
        hanging.hang_on_droppers(lengths)
        if np.abs(hanging.found - before).max() < _SETTLED:
            break
    else:
        raise hanging.restless("static shape: the wires still move", hanging.found - before)
    return hanging.shape(lengths)
