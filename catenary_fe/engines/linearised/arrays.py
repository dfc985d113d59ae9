"""Arrays of a linearised line, which its runs share."""

from __future__ import annotations

from typing import NamedTuple

from catenary_fe.engines.arrays import CsrRows, Floats, Integers, PackedFactor, PackedRows, Surfaces


class ComplianceColumns(NamedTuple):
    """Columns of the inverse of the step's matrix where they are not negligible.

    first : shape (columns,), number of the first row kept
    value : shape (columns, width)
    """

    first: Integers
    value: Floats


class Operator(NamedTuple):
    """Factor of the step's matrix, stiffness K, damping β K + rest.

    stiffness : what of K the line's elements do not have
    """

    factor: PackedFactor
    stiffness: PackedRows
    rest: PackedRows
    beta: float


class SteadyArmBars(NamedTuple):
    """Steady arms that swing, see :class:`~catenary_fe.fe.reduction.SteadyArmBars`.

    at : shape (links, 2)
    compliance : columns of the inverse for these coordinates, one link's two after the other
    """

    at: Integers
    span: Floats
    length: Floats
    k: Floats
    compliance: ComplianceColumns


class StretchCoupling(NamedTuple):
    """Elements whose inclination lengthens a gap, see :class:`~catenary_fe.fe.reduction.StretchCoupling`.

    stiffness : shape (elements, 11), what of the stiffness they have, see ``linearised.stretch``
    """

    at: Integers
    length: Floats
    gap: Integers
    stiffness: Floats


class Line(NamedTuple):
    """Contact wires, one after the other, and droppers.

    first : shape (contact wires + 1,), where the wires' nodes begin
    lengths : [m], shape (nodes,), of the elements that begin there
    profile, lateral : shape (nodes, 2), height and slope at rest, likewise to the left
    at, across : shape (nodes, 2), coordinates of height and slope, and likewise to the left
    contact_compliance : columns of the inverse for these coordinates, numbered by ``column``
    rows, k, d, tension : the droppers' elongation, stiffness, damping and tension at rest
    dropper_compliance : likewise for the droppers
    links, stretch : steady arms, inclined elements
    load : [N], shape (size,), constant, see :class:`~catenary_fe.fe.reduction.LinearModel`
    patterns : [N], rows of coordinates, of loads that vary in time
    surfaces : of the contact wires
    supports, heights, tensions : coordinates of heights at supports and of all nodes, and of tensions
    """

    first: Integers
    x: Floats
    lengths: Floats
    profile: Floats
    lateral: Floats
    at: Integers
    across: Integers
    column: Integers
    contact_compliance: ComplianceColumns
    rows: CsrRows
    k: Floats
    d: Floats
    tension: Floats
    dropper_compliance: ComplianceColumns
    links: SteadyArmBars
    stretch: StretchCoupling
    load: Floats
    patterns: CsrRows
    surfaces: Surfaces
    supports: Integers
    heights: Integers
    tensions: Integers


class Near(NamedTuple):
    """The coordinates that the laws of one slot's forces read: while these are sought, they alone move.

    at : shape (room,), numbers of the coordinates, ``many[0]`` of them
    free : [m/s²], shape (room,), their accelerations without what is owed
    owed : [N], shape (contacts + droppers + 2 links,), changes of forces that all others have yet to feel
    """

    at: Integers
    many: Integers
    free: Floats
    owed: Floats
