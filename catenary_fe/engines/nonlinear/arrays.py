"""Arrays of a compiled nonlinear run. "All" coordinates are those of the wires' nodes; "free" ones move.

All coordinates stand by what they are, shape (2 axes, nodes): places along each axis, then slopes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import CsrRows, Floats, Integers, PackedFactor, PackedRows, Surfaces
from catenary_fe.engines.nonlinear.cables import Elements, Room

Numbers = NDArray[np.int32]  # half as much to read


class SpringArrays(NamedTuple):
    """Springs between points of the wires (droppers), or between them and fixed points (links).

    first, last : numbers of the points' nodes; ``last`` of links has no use
    pivot : [m], shape (springs, axes), fixed points of links
    length, k, d : [m], [N/m], [N s/m], shape (springs,)
    """

    first: Integers
    last: Integers
    pivot: Floats
    length: Floats
    k: Floats
    d: Floats


class Equations(NamedTuple):
    """Equations of motion, see :class:`~catenary_fe.fe.system.System`.

    reference, dof : shape (2 axes, places), the latter the number of the free coordinate, or FIXED; there are
        eight places more than elements have, at least as many as nodes
    force : shape (free,)
    patterns : [N], rows of the free coordinates, of loads that vary in time
    stiffness, mass, damping : over the free coordinates, of what is not a cable and linear
    """

    reference: Floats
    dof: Numbers
    elements: Elements
    droppers: SpringArrays
    links: SpringArrays
    force: Floats
    patterns: CsrRows
    stiffness: PackedRows
    mass: PackedRows
    damping: PackedRows


class Stations(NamedTuple):
    """Contact wires, one after the other, as linearised runs have them in their ``Line``.

    first : shape (contact wires + 1,), where the wires' nodes begin
    x, lengths : [m], shape (nodes,)
    profile, lateral : shape (nodes, 2), height and slope of the reference, likewise to the left
    at, across : shape (nodes, 2), free coordinates of height and slope, and likewise to the left
    node : shape (nodes,), numbers among the nodes of all wires
    supports : shape (contact wires * supports,), likewise; FIXED: not here
    heights : shape (nodes of all wires,), likewise
    surfaces : of the contact wires
    rest : [m], shape (nodes of all wires,), heights that uplifts count from
    rest_supports : [m], shape (contact wires * supports,), likewise at supports
    """

    first: Integers
    x: Floats
    lengths: Floats
    profile: Floats
    lateral: Floats
    at: Integers
    across: Integers
    node: Integers
    supports: Integers
    heights: Integers
    surfaces: Surfaces
    rest: Floats
    rest_supports: Floats


class Factor(NamedTuple):
    """Of the step's matrix at rest, M + g D + b K, all droppers taut.

    window : shape (free,), zero outside :func:`~catenary_fe.engines.nonlinear.forces.local_compliance`
    """

    packed: PackedFactor
    window: Floats


class Motion(NamedTuple):
    """State at a step's end as it is iterated.

    q, v, residual, before : shape (free,), the last one of x
    room : for what elements need
    """

    q: Floats
    v: Floats
    residual: Floats
    before: Floats
    room: Room


class EnergyBalance(NamedTuple):
    """What contacts put into wires and masses, and what dampers take.

    Of a step: the mean of a force at its two ends, along the displacement between them. So all but the last
    three are of the end of the last step, or part of one.

    work : [J], shape (2,), of contacts and of dampers
    q, drag : [m], [N], shape (free,), displacements and the wires' own damping
    heads, head_drag : [m], [N], shape (pantographs, coordinates), likewise
    force, shape, at, head : as in ``Work`` of one slot, where the contacts were; none at the start
    law_force : [N], shape (laws,), of the pantographs' laws a step ago, of frames without inertia
    damper, span : [N], [m], shape (droppers,), the dampers' part of their forces, and lengths
    new_damper, new_span : likewise at the end of the step that is iterated
    history : [J], shape (2, steps + 1), ``work`` at all steps
    """

    work: Floats
    q: Floats
    drag: Floats
    heads: Floats
    head_drag: Floats
    force: Floats
    shape: Floats
    at: Integers
    head: Floats
    law_force: Floats
    damper: Floats
    span: Floats
    new_damper: Floats
    new_span: Floats
    history: Floats


class Slack(NamedTuple):
    """How droppers give, for those that are not as taut ones.

    lack : shape (droppers,), stiffness in the step's matrix that a dropper has less than a taut one
    row : shape (droppers, 2 * axes), its direction at its lower and upper end
    at : shape (droppers, 2 * axes), free coordinates of these
    column : shape (droppers, room), of the inverse of the step's matrix, times ``row``
    first, width : shape (droppers,), from which row on, in how many; no column yet: width 0
    """

    lack: Floats
    row: Floats
    at: Integers
    column: Floats
    first: Integers
    width: Integers
