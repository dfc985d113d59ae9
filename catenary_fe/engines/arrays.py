"""Arrays of linearised runs, several at once: side by side in slots, so that one factorisation serves all."""

from __future__ import annotations

from typing import NamedTuple

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
    """

    start: Unsigned
    column: Unsigned
    value: Floats


class PackedFactor(NamedTuple):
    """A symmetric matrix (I + V)ᵀ S⁻¹ (I + V), S in blocks of four: no four rows wait for one another.

    lower, upper : Vᵀ and V, which have an even number of entries for each four rows
    inner : shape (rows / 4, 10), what is on and above the diagonals of S, block by block
    """

    lower: PackedRows
    upper: PackedRows
    inner: Floats


class Surfaces(NamedTuple):
    """Curves, see ``EvenCurve`` in ``fe.contact``: running surfaces of contact wires, or bases over time.

    first, step : [m] or [s], shape (curves,)
    last : shape (curves,), number of each one's last place; -1: it is 0 everywhere
    values : shape (curves, places, 2)
    """

    first: Floats
    step: Floats
    last: Integers
    values: Floats


class Wires(NamedTuple):
    """State of the wires, each of shape (size, slots): q*, v*, c, x of :class:`Scheme`, and q* + β v*."""

    q: Floats
    v: Floats
    c: Floats
    x: Floats
    w: Floats


class Laws(NamedTuple):
    """Forces inside pantographs that are not linear, see ``Law`` in ``layout.substructure``.

    kind, owner : shape (slots, laws), -1: none; and the pantograph
    row : shape (slots, laws, coordinates)
    to_base : shape (slots, laws)
    values : shape (slots, laws, 2)
    frame : shape (slots, laws, points, 4)
    """

    kind: Integers
    owner: Integers
    row: Floats
    to_base: Floats
    values: Floats
    frame: Floats


class PantographParameters(NamedTuple):
    """Pantographs of each slot and their contacts; heights count from the nominal contact wire height.

    K, D, inverse : shape (slots, pantographs, coordinates, coordinates), inverse of M + g D + b K
    load : shape (slots, pantographs, coordinates)
    base_load : [N/m], likewise, for each metre that the base has risen
    follows, place : shape (slots, pantographs), 1 where the base follows the design height; [m] at the start
    owner, wire : shape (slots, contacts), pantograph (-1: none) and contact wire of each contact
    start : [m], shape (slots, contacts)
    shape : shape (slots, contacts, coordinates, powers), height of the strip at the contact, by powers of its
        place [m] to the left
    k, d : [N/m], [N s/m], shape (slots, contacts)
    preload : [N], shape (slots, contacts), force on a wire at the height of its strip
    points : shape (slots, contacts), number of points of the contact's law; 0: it is straight
    law : [m] and [N], shape (slots, contacts, points, 2), of wires above the strip and forces
    speed, pace : [m/s], shape (slots, contacts), and (slots,) of the pantographs
    last : shape (slots,), number of the run's last step
    nominal : [m], height that coordinates count from
    base_x, base_z : [m], shape (points,), the line that bases follow
    base_stiffness, base_damping : [N/m], [N s/m], shape (slots, pantographs, coordinates), of the springs and
        dampers to the base
    base : by how much each base moves up beside that, slot by slot, over the time
    laws : what is not linear in them
    """

    K: Floats
    D: Floats
    inverse: Floats
    load: Floats
    base_load: Floats
    follows: Floats
    place: Floats
    owner: Integers
    wire: Integers
    start: Floats
    shape: Floats
    k: Floats
    d: Floats
    preload: Floats
    points: Integers
    law: Floats
    speed: Floats
    pace: Floats
    last: Integers
    nominal: float
    base_x: Floats
    base_z: Floats
    base_stiffness: Floats
    base_damping: Floats
    base: Surfaces
    laws: Laws


class PantographState(NamedTuple):
    """State of the pantographs of each slot, and how far each slot's run is.

    q, v, c, x : shape (slots, pantographs, coordinates), as in :class:`Scheme`
    step : shape (slots,), number of the step reached
    """

    q: Floats
    v: Floats
    c: Floats
    x: Floats
    step: Integers


class Records(NamedTuple):
    """Histories by slot, the last axis being the step.

    force, height : (slots, contacts, steps + 1), height above the nominal one
    lateral : likewise, of the wire to the left of the head's middle; in the plane of no steps
    masses : (slots, pantographs, coordinates, steps + 1)
    droppers : (slots, droppers, steps + 1)
    supports : (slots, contact wires * supports, steps + 1), uplift
    change, changed : (slots, gaps), [N] largest change of a gap's tension, and the step at whose end it is
    shortening, shortened : (slots, droppers), [m] largest one of each dropper while slack, and likewise
    wire : (slots, shapes, nodes of all wires), uplift at every ``every``-th step, 0: never
    """

    force: Floats
    height: Floats
    lateral: Floats
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
    law_force : [N], shape (slots, laws)
    slack : [N], shape (slots, droppers), what is taken off a dropper that is not as a taut one
    swing : [N], shape (slots, links, 2), what a link's force has more than its tangent
    tension : [N], shape (gaps, slots), change of tension at the end of the step before
    active : shape (slots, droppers), numbers of those droppers, the first ``active_count`` of the slot
    column, first, width : shape (slots, contacts, room) and (slots, contacts), how the wires give there,
        from which row on, in how many
    shape, rise : shape (slots, contacts, 5), weights of height and inclination; last, at rest
    at : shape (slots, contacts, 4), coordinates that they weigh
    node : shape (slots, contacts), first node of the element there
    on : shape (slots, contacts), 1 where a strip is between the ends of its wire
    base : [m], shape (slots, contacts), height of strips that no body carries
    head, head_compliance : shape (slots, contacts, coordinates), height of the head there, how it yields
    """

    force: Floats
    law_force: Floats
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
    node: Integers
    on: Integers
    base: Floats
    head: Floats
    head_compliance: Floats
