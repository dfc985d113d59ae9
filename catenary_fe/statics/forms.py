"""Form finding: dropper lengths that bring the contact wire to its design height, and the line as it is."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.mesh import MeshSettings
from catenary_fe.layout import Catenary, InputError, Line, SolverError
from catenary_fe.layout.arguments import checked
from catenary_fe.layout.as_built import deviations
from catenary_fe.layout.rules import check_lengths
from catenary_fe.statics.form_finding import WireSubstructures
from catenary_fe.statics.line import join_shapes
from catenary_fe.statics.rules import (
    check_bridged,
    check_pulls,
    check_reach,
    check_room,
    check_stretch,
    given_lengths,
)
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

    What has changed since the droppers were cut (`state` and `clamp_shift` of droppers, `wear`, `as_built`)
    changes no length, and no setting of an arm or a support: the line as designed gives both, and the line as
    it is is hung with them. Lengths that are `as_built` longer are, and heights to which the wire was set
    give other lengths.

    mesh : element lengths; a shape belongs to its mesh

    Raises InputError where only some droppers have a length, for impossible lengths, and for a design in
    which a dropper or a steady arm would have to push or has no room; SolverError where the passes do not
    come to an end.
    """
    if isinstance(catenary, Line):
        return join_shapes(catenary, _of_sections(catenary, mesh))
    check_lengths(catenary)
    mesh = mesh or MeshSettings()
    designed = catenary.as_designed()
    if heights := catenary.as_built and catenary.as_built.of_heights:
        designed = designed.replace(as_built=heights)
    if catenary.gives_dropper_lengths:
        shape = _hang(designed, given_lengths(designed, None), mesh)
        check_bridged(designed, shape.dropper_lengths, shape.height_errors)
    else:
        shape = _find_lengths(designed, mesh)
    if catenary == designed:
        return shape
    longer = deviations(catenary, "dropper_length", catenary.designed_positions)
    return _hang(catenary, (shape.dropper_lengths + longer)[catenary.hanging], mesh, shape)


@checked
def find_heights(
    catenary: Catenary, lengths: Sequence[float] | Floats | None = None, mesh: MeshSettings | None = None
) -> Shape:
    """The reverse of form finding: the static shape that given dropper lengths result in.

    The shape's catenary has these lengths, so that a run on it records them.

    lengths : [m], shape (designed droppers,), stress-free; unset: those that the layout gives. Droppers that
        are missing or broken count: they were cut, too
    mesh : element lengths; a shape belongs to its mesh

    Raises InputError for missing or impossible lengths, SolverError where no equilibrium is found.
    """
    return find_form(catenary.with_dropper_lengths(given_lengths(catenary.as_designed(), lengths)), mesh)


def _find_lengths(catenary: Catenary, mesh: MeshSettings) -> Shape:
    """A line with the dropper lengths that bring the contact wire to its design heights."""
    wires = WireSubstructures(catenary, mesh)
    lengths = np.zeros(len(catenary.droppers))
    for _ in range(_PASSES):
        before = lengths
        wires.solve_cut_wires()
        check_pulls(catenary, wires.pull)
        span = wires.spread()
        check_room(catenary, span[:, -1])
        distance = np.linalg.norm(span, axis=1)
        tension = wires.pull * distance / span[:, -1]
        check_stretch(catenary, distance, tension)
        lengths = distance - tension / wires.stiffness
        wires.set_dropper_weights(lengths)
        if np.abs(lengths - before).max(initial=0.0) < _SETTLED:
            break
    else:
        raise wires.unsettled("form finding: dropper lengths still change", lengths - before)
    return wires.shape(lengths)


def _hang(catenary: Catenary, lengths: Floats, mesh: MeshSettings, as_set: Shape | None = None) -> Shape:
    """A line hung with droppers of given lengths [m].

    as_set : the line when arms and supports were set; unset: they are set now
    """
    check_reach(catenary, lengths)
    wires = WireSubstructures(catenary, mesh, as_set)
    wires.set_dropper_weights(lengths)
    wires.solve_cut_wires()
    for _ in range(_PASSES):
        before = wires.found.copy()
        wires.solve_on_droppers(lengths)
        if np.abs(wires.found - before).max() < _SETTLED:
            break
    else:
        raise wires.unsettled("static shape: the wires still move", wires.found - before)
    return wires.shape(lengths)


def _of_sections(line: Line, mesh: MeshSettings | None) -> list[Shape]:
    """The sections' shapes, equal ones found once."""
    found: dict[Catenary, Shape] = {}
    for number, section in enumerate(line.sections, start=1):
        try:
            found[section] = found.get(section) or find_form(section, mesh)
        except (InputError, SolverError) as error:
            raise type(error)(*(f"section {number}: {line}" for line in str(error).splitlines())) from None
    return [found[section] for section in line.sections]
