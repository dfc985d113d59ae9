"""Arrays of linearised runs, several at once: side by side in lanes, so that one factorisation serves all."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Unsigned = NDArray[np.uint32]  # the compiler need not look for negative numbers

LANES = 8  # as many as fill the registers


class Scheme(NamedTuple):
    """Generalised-α of a fixed time step h (Arnold and Brüls 2007), which has one more state c a coordinate.

    With x the accelerations at the step's end, there q = q* + b x and v = v* + g x. The next step has
    q* + h v* + qx x + qc c, then v* + vx x + vc c, and cx x + cc c.
    """

    h: float
    b: float
    g: float
    qx: float
    qc: float
    vx: float
    vc: float
    cx: float
    cc: float


class Rows(NamedTuple):
    """Sparse rows: entries ``start[i]`` to ``start[i + 1]`` belong to row i."""

    start: Unsigned
    column: Unsigned
    value: Floats


class Quads(NamedTuple):
    """Sparse rows by fours: entries ``start[k]`` to ``start[k + 1]`` belong to rows 4 k to 4 k + 3.

    column : shape (entries,)
    value : shape (entries, 4)
    inner : shape (rows / 4, 6), of a triangular matrix: what couples the four, row by row
    """

    start: Unsigned
    column: Unsigned
    value: Floats
    inner: Floats


class Columns(NamedTuple):
    """Columns of the inverse of the step's matrix where they are not negligible.

    first : shape (columns,), number of the first row kept
    value : shape (columns, width)
    """

    first: Integers
    value: Floats


class Operator(NamedTuple):
    """The step's matrix L diag(1 / inverse) Lᵀ, stiffness K, damping β K + rest.

    lower, upper : L and Lᵀ without their diagonals of ones; all are Quads for one lane, Rows for eight
    """

    lower: Any
    upper: Any
    inverse: Floats
    stiffness: Any
    rest: Any
    beta: float


class Links(NamedTuple):
    """Steady arms that swing, see :class:`~catenary_fe.fe.linear_model.SwingingLinks`.

    at : shape (links, 2)
    yielding : columns of the inverse for these coordinates, one link's two after the other
    """

    at: Integers
    span: Floats
    length: Floats
    k: Floats
    yielding: Columns


class Bowed(NamedTuple):
    """Elements whose inclination lengthens a gap, see :class:`~catenary_fe.fe.linear_model.Bows`."""

    at: Integers
    length: Floats
    gap: Integers


class Line(NamedTuple):
    """Contact wires, one after the other, and droppers.

    first : shape (contact wires + 1,), where the wires' nodes begin
    lengths : [m], shape (nodes,), of the elements that begin there
    static, lateral : shape (nodes, 2), height and slope at rest, likewise to the left
    at : shape (nodes, 2), coordinates of height and slope
    give : columns of the inverse for these coordinates, numbered by ``column``
    rows, k, d, tension : the droppers' elongation, stiffness, damping and tension at rest
    yielding : columns of the inverse for the droppers
    links, bows : steady arms, inclined elements
    load : [N], shape (size,), constant, see :class:`~catenary_fe.fe.linear_model.LinearModel`
    supports, heights, tensions : coordinates of heights at supports and of all nodes, and of tensions
    """

    first: Integers
    x: Floats
    lengths: Floats
    static: Floats
    lateral: Floats
    at: Integers
    column: Integers
    give: Columns
    rows: Rows
    k: Floats
    d: Floats
    tension: Floats
    yielding: Columns
    links: Links
    bows: Bowed
    load: Floats
    supports: Integers
    heights: Integers
    tensions: Integers


class Wires(NamedTuple):
    """State of the wires, each of shape (size, lanes): q*, v*, c, x of :class:`Scheme`, and q* + β v*."""

    q: Floats
    v: Floats
    c: Floats
    x: Floats
    w: Floats


class Heads(NamedTuple):
    """Pantographs of each lane, each a chain of masses; heights count from the nominal contact wire height.

    q, v, c, x : shape (lanes, pantographs, coordinates), as in :class:`Scheme`
    K, D, inverse : shape (lanes, pantographs, coordinates, coordinates), inverse of M + g D + b K
    load : shape (lanes, pantographs, coordinates)
    owner, wire : shape (lanes, contacts), pantograph (-1: none) and contact wire of each contact
    start : [m], shape (lanes, contacts)
    heave, roll : shape (lanes, contacts, coordinates), height of the head at the contact: as it heaves, and
        for each metre to the left
    k, d : [N/m], [N s/m], shape (lanes, contacts)
    preload : [N], shape (lanes, contacts), force on a wire at its nominal height, without masses
    speed : [m/s], shape (lanes,)
    step, last : shape (lanes,), number of the step reached and of the run's last one
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
    """Histories by lane, the last axis being the step.

    force, height : (lanes, contacts, steps + 1), height above the nominal one
    masses : (lanes, pantographs, coordinates, steps + 1)
    droppers : (lanes, droppers, steps + 1)
    supports : (lanes, contact wires * supports, steps + 1), uplift
    change, changed : (lanes, gaps), [N] largest change of a gap's tension, and the step at whose end it is
    shortening, shortened : (lanes, droppers), [m] largest one of each dropper while slack, and likewise
    wire : (lanes, shapes, nodes of all wires), uplift at every ``every``-th step, 0: never
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
    """Room of one step, by lane first.

    force : [N], shape (lanes, contacts)
    slack : [N], shape (lanes, droppers), what is taken off a dropper that is not as a taut one
    swing : [N], shape (lanes, links, 2), what a link's force has more than its tangent
    tension : [N], shape (lanes, gaps), change of tension at the end of the step before
    active : shape (lanes, droppers), numbers of those droppers, the first ``active_count`` of the lane
    column, first, width : shape (lanes, contacts, room) and (lanes, contacts), how the wires give there,
        from which row on, in how many
    shape, rise : shape (lanes, contacts, 5), weights of height and inclination; last, at rest
    at : shape (lanes, contacts, 4), coordinates that they weigh
    head, soft : shape (lanes, contacts, coordinates), the head's height there as a row, and how it gives
    """

    force: Floats
    slack: Floats
    swing: Floats
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
    soft: Floats
