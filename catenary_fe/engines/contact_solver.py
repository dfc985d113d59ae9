"""The contact between pantographs and wires, which all compiled engines share, and pantographs in a step.

In a step the coordinates at its end are q = q* + b x and
v = v* + g x, where x are the accelerations there. A force changes x by a column of the inverse of the step's
matrix. The forces are found by relaxation: each law is solved exactly in turn, until they are consistent.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from catenary_fe.engines.arrays import (
    Floats,
    PantographParameters,
    PantographState,
    Surfaces,
    Wires,
    Work,
)
from catenary_fe.engines.compiled import compiled
from catenary_fe.engines.generalized_alpha import Scheme, advance

SWEEPS = 60
TOLERANCE = 1e-9  # [N] by which forces may still change


@compiled
def one_way(spring: float, damper: float) -> float:
    """A spring and damper that act one way: the damper's part is at most the spring's."""
    if spring <= 0:
        return 0.0
    return spring + min(max(damper, -spring), spring)


@compiled
def solve_one_way(spring: float, damper: float, cs: float, cd: float) -> float:
    """The force F with F = one_way(spring - cs F, damper - cd F)."""
    F = (spring + damper) / (1 + cs + cd)
    s, r = spring - cs * F, damper - cd * F
    if s > 0 and -s <= r <= s:
        return max(F, 0.0)  # rounded
    F = 2 * spring / (1 + 2 * cs)
    if F > 0 and damper - cd * F > spring - cs * F:
        return F
    return 0.0


@compiled
def solve_points(law: Floats, points: int, free: float, compliance: float) -> float:
    """The force F of a falling law of points at the height free + compliance · F [m] of the wire."""
    F = law[0, 1]
    if free + compliance * F > law[0, 0]:
        F = law[points - 1, 1]
        for i in range(points - 1):
            slope = (law[i, 1] - law[i + 1, 1]) / (law[i + 1, 0] - law[i, 0])
            here = (law[i, 1] - slope * (free - law[i, 0])) / (1 + slope * compliance)
            if free + compliance * here <= law[i + 1, 0]:
                F = here
                break
    return float(F)


@compiled
def weigh_contact(
    line: Any, heads: PantographParameters, work: Work, c: int, j: int, position: float
) -> tuple[int, float]:
    """Shape functions at a contact; the element's first node, and how far to the left it is at rest.

    Before the wire's first node and beyond its last one there is none: the force is 0, the height no number.
    """
    begin, end = line.first[heads.wire[c, j]], line.first[heads.wire[c, j] + 1]
    work.on[c, j] = line.x[begin] <= position <= line.x[end - 1]
    if not work.on[c, j]:
        work.shape[c, j, :4], work.shape[c, j, 4] = 0.0, np.nan
        work.rise[c, j, :], work.at[c, j, :] = 0.0, -1
        work.force[c, j] = 0.0
        work.node[c, j] = begin
        return begin, 0.0
    e, above = begin, end - 1
    while above - e > 1:  # np.searchsorted takes seconds to compile
        middle = (e + above) // 2
        if line.x[middle] <= position:
            e = middle
        else:
            above = middle
    width = line.x[e + 1] - line.x[e]
    xi, length = (position - line.x[e]) / width, line.lengths[e]
    shape, rise, at = work.shape[c, j], work.rise[c, j], work.at[c, j]
    shape[0] = 1 - 3 * xi**2 + 2 * xi**3
    shape[1] = length * (xi - 2 * xi**2 + xi**3)
    shape[2] = 3 * xi**2 - 2 * xi**3
    shape[3] = length * (xi**3 - xi**2)
    rise[0] = 6 * (xi**2 - xi) / width
    rise[1] = length * (1 - 4 * xi + 3 * xi**2) / width
    rise[2] = -rise[0]
    rise[3] = length * (3 * xi**2 - 2 * xi) / width
    shape[4], rise[4], lateral = 0.0, 0.0, 0.0
    for m in range(4):
        node, which = e + m // 2, m % 2
        shape[4] += shape[m] * line.profile[node, which]
        rise[4] += rise[m] * line.profile[node, which]
        lateral += shape[m] * line.lateral[node, which]
        at[m] = line.at[node, which]
    work.node[c, j] = e
    if line.surfaces.last[heads.wire[c, j]] >= 0:
        height, slope = surface_at(line.surfaces, heads.wire[c, j], position)
        shape[4] += height
        rise[4] += slope
    return e, lateral


@compiled
def surface_at(surfaces: Surfaces, wire: int, position: float) -> tuple[float, float]:
    """Height [m] and slope of a contact wire's running surface; or height and rate of a base at a time."""
    last, h = surfaces.last[wire], surfaces.step[wire]
    share = min(max((position - surfaces.first[wire]) / h, 0.0), float(last))
    e = min(int(share), last - 1)
    xi = share - e
    a, b = surfaces.values[wire, e], surfaces.values[wire, e + 1]
    return cubic(a[0], a[1], b[0], b[1], h, xi)


@compiled
def cubic(a: float, da: float, b: float, db: float, h: float, xi: float) -> tuple[float, float]:
    """A cubic through two values with their slopes, and its own slope, at a share of the way between."""
    value = a + xi * (h * da + xi * (3 * (b - a) - h * (2 * da + db) + xi * (2 * (a - b) + h * (da + db))))
    slope = da + xi * (2 * (3 * (b - a) / h - 2 * da - db) + 3 * xi * (2 * (a - b) / h + da + db))
    return value, slope


@compiled
def lateral_place(scheme: Scheme, line: Any, wires: Wires, work: Work, c: int, j: int) -> float:
    """[m] of the wire to the left at a contact at the step's end; no number beyond the wire's ends."""
    if not work.on[c, j]:
        return float(np.nan)
    y = 0.0
    for m in range(4):
        node, which = work.node[c, j] + m // 2, m % 2
        y += work.shape[c, j, m] * line.lateral[node, which]
        i = line.across[node, which]
        if i >= 0:
            y += work.shape[c, j, m] * (wires.q[i, c] + scheme.b * wires.x[i, c])
    return y


@compiled
def place_head(heads: PantographParameters, work: Work, c: int, j: int, lateral: float) -> None:
    """The head's height at a contact this far to the left, as a row of coordinates, and its compliance."""
    p, head, head_compliance = heads.owner[c, j], work.head[c, j], work.head_compliance[c, j]
    for s in range(head.size):
        height = 0.0
        for k in range(heads.shape.shape[3] - 1, -1, -1):
            height = height * lateral + heads.shape[c, j, s, k]
        head[s] = height
    for s in range(head.size):
        head_compliance[s] = 0.0
        for r in range(head.size):
            head_compliance[s] += heads.inverse[c, p, s, r] * head[r]


@compiled
def place_base(heads: PantographParameters, work: Work, c: int, j: int, time: float) -> None:
    """Height of a strip that no body carries, at a time [s]; of others it is in their coordinates."""
    carried = False
    for s in range(heads.shape.shape[2]):
        carried = carried or heads.shape[c, j, s, 0] != 0.0
    p = heads.owner[c, j]
    work.base[c, j] = 0.0 if carried else risen_base(heads, c, p, time)


@compiled
def update_contact(
    scheme: Scheme,
    wires: Wires,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    c: int,
    j: int,
) -> float:
    """Bring one contact's force to its law, and the head; returns the change [N], which the wires await."""
    if not work.on[c, j]:
        return 0.0
    p = heads.owner[c, j]
    shape, rise, at, column = work.shape[c, j], work.rise[c, j], work.at[c, j], work.column[c, j]
    z, slope, climb, wire_compliance, turn = shape[4] - heads.nominal, rise[4], 0.0, 0.0, 0.0
    first = work.first[c, j]
    for m in range(4):
        i = at[m]
        if i >= 0:
            q = wires.q[i, c] + scheme.b * wires.x[i, c]
            z += shape[m] * q
            slope += rise[m] * q
            climb += shape[m] * (wires.v[i, c] + scheme.g * wires.x[i, c])
            wire_compliance += shape[m] * column[i - first]
            turn += rise[m] * column[i - first]
    climb += heads.speed[c, j] * slope
    head, rate, light = work.base[c, j], 0.0, 0.0
    for s in range(pantographs.x.shape[2]):
        row = work.head[c, j, s]
        head += row * (pantographs.q[c, p, s] + scheme.b * pantographs.x[c, p, s])
        rate += row * (pantographs.v[c, p, s] + scheme.g * pantographs.x[c, p, s])
        light += row * work.head_compliance[c, j, s]
    k, d, old = heads.k[c, j], heads.d[c, j], work.force[c, j]
    cs = k * scheme.b * (wire_compliance + light)
    cd = d * (scheme.g * (wire_compliance + light) + heads.speed[c, j] * scheme.b * turn)
    spring, damper = k * (head - z) + heads.preload[c, j], d * (rate - climb)
    if heads.points[c, j]:
        compliance = scheme.b * (wire_compliance + light)
        force = solve_points(heads.law[c, j], heads.points[c, j], z - head - compliance * old, compliance)
    else:
        force = solve_one_way(spring + cs * old, damper + cd * old, cs, cd)
    change = force - old
    work.force[c, j] = force
    for s in range(pantographs.x.shape[2]):
        pantographs.x[c, p, s] -= change * work.head_compliance[c, j, s]
    return float(change)


@compiled
def move_wires(wires: Wires, c: int, first: int, column: Floats, change: float) -> None:
    """What a force's change makes of the accelerations, by its column of the inverse from a row on."""
    for i in range(column.size):
        wires.x[first + i, c] += change * column[i]


@compiled
def base_height(heads: PantographParameters, c: int, p: int, time: float) -> float:
    """[m] that what a pantograph's base follows has risen at a time [s]."""
    x, z = heads.base_x, heads.base_z
    if heads.follows[c, p] == 0.0 or x.size < 2:
        return 0.0
    position, e = heads.place[c, p] + heads.pace[c] * time, 0
    while e < x.size - 2 and x[e + 1] <= position:
        e += 1
    return float(z[e] + (z[e + 1] - z[e]) * (position - x[e]) / (x[e + 1] - x[e]))


@compiled
def risen_base(heads: PantographParameters, c: int, p: int, time: float) -> float:
    """[m] that a pantograph's base has risen at a time [s], by what it follows and by what moves it."""
    risen, base = base_height(heads, c, p, time), c * heads.follows.shape[1] + p
    if heads.base.last[base] >= 0:
        height, _ = surface_at(heads.base, base, time)
        risen += height
    return float(risen)


@compiled
def free_heads(heads: PantographParameters, pantographs: PantographState, c: int, time: float) -> None:
    """Accelerations of the masses without contact, at a time [s]."""
    count, size = pantographs.x.shape[1], pantographs.x.shape[2]
    for p in range(count):
        risen = base_height(heads, c, p, time)
        for r in range(size):
            pantographs.x[c, p, r] = 0.0
        for s in range(size):
            load = heads.load[c, p, s] + risen * heads.base_load[c, p, s]
            for r in range(size):
                load -= (
                    heads.K[c, p, s, r] * pantographs.q[c, p, r]
                    + heads.D[c, p, s, r] * pantographs.v[c, p, r]
                )
            for r in range(size):
                pantographs.x[c, p, r] += heads.inverse[c, p, r, s] * load
        row = c * count + p
        if heads.base.last[row] >= 0:
            height, rate = surface_at(heads.base, row, time)
            for s in range(size):
                load = height * heads.base_stiffness[c, p, s] + rate * heads.base_damping[c, p, s]
                for r in range(size):
                    pantographs.x[c, p, r] += heads.inverse[c, p, r, s] * load


@compiled
def advance_heads(scheme: Scheme, pantographs: PantographState, c: int) -> None:
    """From the accelerations at this step's end to the prediction for the next one."""
    for p in range(pantographs.x.shape[1]):
        for s in range(pantographs.x.shape[2]):
            q, v, k = advance(
                scheme,
                pantographs.q[c, p, s],
                pantographs.v[c, p, s],
                pantographs.c[c, p, s],
                pantographs.x[c, p, s],
            )
            pantographs.q[c, p, s], pantographs.v[c, p, s], pantographs.c[c, p, s] = q, v, k
