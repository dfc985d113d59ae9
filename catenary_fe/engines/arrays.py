"""Arrays of linearised runs, several at once: side by side in slots, so that one factorisation serves all."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Unsigned = NDArray[np.uint32]  # the compiler need not look for negative numbers

SLOTS = 8  # as many as fill the registers


class CsrRows(NamedTuple):
    """Sparse rows: entries ``start[i]`` to ``start[i + 1]`` belong to row i."""

    start: Unsigned
    column: Unsigned
    value: Floats


class PackedRows(NamedTuple):
    """Sparse rows by fours: entries ``start[k]`` to ``start[k + 1]`` belong to rows 4 k to 4 k + 3.

    column : shape (entries,)
    value : shape (entries, 4)
    inner : shape (rows / 4, 6), of a triangular matrix: what couples the four, row by row
    """

    start: Unsigned
    column: Unsigned
    value: Floats
    inner: Floats


class ComplianceColumns(NamedTuple):
    """ComplianceColumns of the inverse of the step's matrix where they are not negligible.

    first : shape (columns,), number of the first row kept
    value : shape (columns, width)
    """

    first: Integers
    value: Floats


class Operator(NamedTuple):
    """The step's matrix L diag(1 / inverse) Lᵀ, stiffness K, damping β K + rest.

    lower, upper : L and Lᵀ without their diagonals of ones; PackedRows for one slot, CsrRows for eight
    """

    lower: Any
    upper: Any
    inverse: Floats
    stiffness: Any
    rest: Any
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
    """Elements whose inclination lengthens a gap, see :class:`~catenary_fe.fe.reduction.StretchCoupling`."""

    at: Integers
    length: Floats
    gap: Integers


class Line(NamedTuple):
    """Contact wires, one after the other, and droppers.

    first : shape (contact wires + 1,), where the wires' nodes begin
    lengths : [m], shape (nodes,), of the elements that begin there
    static, lateral : shape (nodes, 2), height and slope at rest, likewise to the left
    at : shape (nodes, 2), coordinates of height and slope
    contact_compliance : columns of the inverse for these coordinates, numbered by ``column``
    rows, k, d, tension : the droppers' elongation, stiffness, damping and tension at rest
    dropper_compliance : likewise for the droppers
    links, stretch : steady arms, inclined elements
    load : [N], shape (size,), constant, see :class:`~catenary_fe.fe.reduction.LinearModel`
    supports, heights, tensions : coordinates of heights at supports and of all nodes, and of tensions
    """

    first: Integers
    x: Floats
    lengths: Floats
    static: Floats
    lateral: Floats
    at: Integers
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
    supports: Integers
    heights: Integers
    tensions: Integers


class Wires(NamedTuple):
    """State of the wires, each of shape (size, slots): q*, v*, c, x of :class:`Scheme`, and q* + β v*."""

    q: Floats
    v: Floats
    c: Floats
    x: Floats
    w: Floats


class Heads(NamedTuple):
    """Pantographs of each slot, masses and springs; heights count from the nominal one.

    q, v, c, x : shape (slots, pantographs, coordinates), as in :class:`Scheme`
    K, D, inverse : shape (slots, pantographs, coordinates, coordinates), inverse of M + g D + b K
    load : shape (slots, pantographs, coordinates)
    owner, wire : shape (slots, contacts), pantograph (-1: none) and contact wire of each contact
    start : [m], shape (slots, contacts)
    heave, roll : shape (slots, contacts, coordinates), height of the head at the contact: as it heaves, and
        for each metre to the left
    k, d : [N/m], [N s/m], shape (slots, contacts)
    preload : [N], shape (slots, contacts), force on a wire at its nominal height, without masses
    speed : [m/s], shape (slots,)
    step, last : shape (slots,), number of the step reached and of the run's last one
    nominal : [m], height that masses count from
    """

    q: Floats
    v: Floats
    c: Floats
    x: Floats
    K: Floats
    D: Floats
    inverse: Floats
    load: Floats
    owner: Integers
    wire: Integers
    start: Floats
    heave: Floats
    roll: Floats
    k: Floats
    d: Floats
    preload: Floats
    speed: Floats
    step: Integers
    last: Integers
    nominal: float


class Records(NamedTuple):
    """Histories by slot, the last axis being the step.

    force, height : (slots, contacts, steps + 1), height above the nominal one
    masses : (slots, pantographs, coordinates, steps + 1)
    droppers : (slots, droppers, steps + 1)
    supports : (slots, contact wires * supports, steps + 1), uplift
    change, changed : (slots, gaps), [N] largest change of a gap's tension, and the step at whose end it is
    shortening, shortened : (slots, droppers), [m] largest one of each dropper while slack, and likewise
    wire : (slots, shapes, nodes of all wires), uplift at every ``every``-th step, 0: never
    """

    force: Floats
    height: Floats
    masses: Floats
    droppers: Floats
    supports: Floats
    change: Floats
    changed: Integers
    shortening: Floats
    shortened: Integers
    wire: Floats
    every: int


class Work(NamedTuple):
    """Room of one step, by slot first.

    force : [N], shape (slots, contacts)
    slack : [N], shape (slots, droppers), what is taken off a dropper that is not as a taut one
    swing : [N], shape (slots, links, 2), what a link's force has more than its tangent
    tension : [N], shape (slots, gaps), change of tension at the end of the step before
    active : shape (slots, droppers), numbers of those droppers, the first ``active_count`` of the slot
    column, first, width : shape (slots, contacts, room) and (slots, contacts), how the wires give there,
        from which row on, in how many
    shape, rise : shape (slots, contacts, 5), weights of height and inclination; last, at rest
    at : shape (slots, contacts, 4), coordinates that they weigh
    head, head_compliance : shape (slots, contacts, coordinates), height of the head there, how it yields
    """

    force: Floats
    slack: Floats
    arm_force: Floats
    tension: Floats
    active: Integers
    active_count: Integers
    column: Floats
    first: Integers
    width: Integers
    shape: Floats
    rise: Floats
    at: Integers
    head: Floats
    head_compliance: Floats
