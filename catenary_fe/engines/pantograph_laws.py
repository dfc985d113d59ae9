"""Forces inside pantographs that are not linear: stops, dampers that differ, dry friction, a frame's motion.

Each acts along one row of a pantograph's coordinates, against it, and is solved in the same sweeps as the
contacts: exactly by itself, again and again until all agree (see :mod:`catenary_fe.engines.contact_solver`).
"""

from __future__ import annotations

from catenary_fe.engines.arrays import Floats, PantographParameters, PantographState, Work
from catenary_fe.engines.compiled import compiled
from catenary_fe.engines.contact_solver import base_height, cubic, surface_at
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.layout.bodies import DAMPER, FRAME, FRICTION, STOP


@compiled
def begin_laws(heads: PantographParameters, pantographs: PantographState, work: Work, c: int) -> None:
    """Take the forces of the step before as a first guess at this one's."""
    for n in range(heads.laws.kind.shape[1]):
        if heads.laws.kind[c, n] >= 0:
            push_by_law(heads, pantographs, work, c, n, work.law_force[c, n])


@compiled
def push_by_law(
    heads: PantographParameters, pantographs: PantographState, work: Work, c: int, n: int, change: float
) -> None:
    """What a change of a law's force makes of the accelerations."""
    p = heads.laws.owner[c, n]
    for s in range(pantographs.x.shape[2]):
        pantographs.x[c, p, s] -= change * law_compliance(heads, c, n, s)


@compiled
def law_compliance(heads: PantographParameters, c: int, n: int, s: int) -> float:
    """How a coordinate gives to a law's force of 1 N."""
    p, found = heads.laws.owner[c, n], 0.0
    for r in range(heads.laws.row.shape[2]):
        found += heads.inverse[c, p, s, r] * heads.laws.row[c, n, r]
    return found


@compiled
def update_laws(
    scheme: Scheme, heads: PantographParameters, pantographs: PantographState, work: Work, c: int, time: float
) -> float:
    """Bring each law's force to what it should be at a time [s]; returns the largest change [N]."""
    largest = 0.0
    for n in range(heads.laws.kind.shape[1]):
        if heads.laws.kind[c, n] < 0:
            continue
        p, u, w, a, give = heads.laws.owner[c, n], 0.0, 0.0, 0.0, 0.0
        for s in range(pantographs.x.shape[2]):
            row = heads.laws.row[c, n, s]
            if row != 0.0:
                u += row * (pantographs.q[c, p, s] + scheme.b * pantographs.x[c, p, s])
                w += row * (pantographs.v[c, p, s] + scheme.g * pantographs.x[c, p, s])
                a += row * pantographs.x[c, p, s]
                give += row * law_compliance(heads, c, n, s)
        grounded = heads.laws.to_base[c, n]
        if grounded != 0.0:
            u += grounded * base_height(heads, c, p, time)
            base = c * pantographs.x.shape[1] + p
            if heads.base.last[base] >= 0:
                height, rate = surface_at(heads.base, base, time)
                u += grounded * height
                w += grounded * rate
        old = work.law_force[c, n]
        force = solve_law(scheme, heads, c, n, u, w, a, give, old)
        if force != old:
            work.law_force[c, n] = force
            push_by_law(heads, pantographs, work, c, n, force - old)
            largest = max(largest, abs(force - old))
    return largest


@compiled
def solve_law(
    scheme: Scheme,
    heads: PantographParameters,
    c: int,
    n: int,
    u: float,
    w: float,
    a: float,
    give: float,
    old: float,
) -> float:
    """The force of a law where elongation, rate and acceleration are u, w, a under the force old.

    give : by how much the acceleration falls with each newton
    """
    kind, first, second = heads.laws.kind[c, n], heads.laws.values[c, n, 0], heads.laws.values[c, n, 1]
    if kind == STOP:  # limit and stiffness
        free = u + scheme.b * give * old - first
        return float(max(second * free / (1 + second * scheme.b * give), 0.0))
    if kind == DAMPER:
        free = w + scheme.g * give * old
        return float(max(first * free / (1 + first * scheme.g * give), 0.0))
    if kind == FRICTION:  # as much as it takes to stand still, and no more than it has
        return float(min(max((w + scheme.g * give * old) / (scheme.g * give), -first), first))
    mass, mass_slope, force, force_slope = frame_at(heads.laws.frame[c, n], first, second, u)
    missing = mass * a + mass_slope * w * w / 2 + force - old
    slope = mass + scheme.b * (mass_slope * a + force_slope) + scheme.g * mass_slope * w
    return old + missing / (1 + give * slope)


@compiled
def frame_at(table: Floats, first: float, step: float, u: float) -> tuple[float, float, float, float]:
    """What a frame at a height has more than the linear one: mass and its slope, force down and its slope.

    table : shape (points, 4), these values over even heights from ``first`` on; cubic between
    """
    share = min(max((u - first) / step, 0.0), float(table.shape[0] - 1))
    e = min(int(share), table.shape[0] - 2)
    xi = share - e
    mass, mass_slope = cubic(table[e, 0], table[e, 1], table[e + 1, 0], table[e + 1, 1], step, xi)
    force, force_slope = cubic(table[e, 2], table[e, 3], table[e + 1, 2], table[e + 1, 3], step, xi)
    return mass, mass_slope, force, force_slope


__all__ = ["FRAME", "begin_laws", "frame_at", "update_laws"]
