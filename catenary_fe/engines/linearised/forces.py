"""Forces of linearised runs that act through few coordinates: contacts, slack droppers, arms that swing.

Each law is solved exactly in turn, until they are consistent.
"""

from __future__ import annotations

import numpy as np

from catenary_fe.engines.arrays import Floats, PantographParameters, PantographState, Records, Wires, Work
from catenary_fe.engines.compiled import compiled
from catenary_fe.engines.contact_solver import (
    SWEEPS,
    TOLERANCE,
    free_heads,
    lateral_place,
    one_way,
    place_base,
    place_head,
    update_contact,
    weigh_contact,
)
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.linearised.arrays import Line, SteadyArmBars
from catenary_fe.engines.pantograph_laws import update_laws

UNSETTLED = 1e-3  # [N] by which they may still change after the last sweep
LOOSE = 1e-3  # [N] of a link's force that is left out
FAR = 2**31  # beyond all rows


@compiled
def place_contact(
    line: Line, heads: PantographParameters, work: Work, c: int, j: int, position: float
) -> None:
    """Shape functions, and how wire and head compliance, at a contact."""
    e, lateral = weigh_contact(line, heads, work, c, j, position)
    shape, at = work.shape[c, j], work.at[c, j]
    low, high, size = FAR, 0, line.contact_compliance.value.shape[1]
    for m in range(4):
        if at[m] >= 0:
            begin = line.contact_compliance.first[line.column[e + m // 2, m % 2]]
            low, high = min(low, begin), max(high, begin + size)
    work.first[c, j], work.width[c, j] = min(low, high), max(high - low, 0)
    column = work.column[c, j, : work.width[c, j]]
    column[:] = 0.0
    for m in range(4):
        k = line.column[e + m // 2, m % 2]
        if k >= 0 and work.on[c, j]:
            shift = line.contact_compliance.first[k] - low
            for i in range(size):
                column[shift + i] += shape[m] * line.contact_compliance.value[k, i]
    place_head(heads, work, c, j, lateral)


@compiled
def update_dropper(scheme: Scheme, line: Line, wires: Wires, work: Work, c: int, i: int) -> float:
    """Bring one dropper's force to its law, from a taut one's; returns the change [N]."""
    spring, damper = dropper_parts(scheme, line, wires, c, i)
    old = work.slack[c, i]
    if old == 0.0 and spring > 0 and -spring <= damper <= spring:
        return 0.0
    compliance, first = 0.0, line.dropper_compliance.first[i]
    for m in range(line.rows.start[i], line.rows.start[i + 1]):
        compliance += line.rows.value[m] * line.dropper_compliance.value[i, line.rows.column[m] - first]
    cs, cd = line.k[i] * scheme.b * compliance, line.d[i] * scheme.g * compliance
    spring -= cs * old
    damper -= cd * old
    new = 0.0
    if not (spring > 0 and -spring <= damper <= spring):
        new = (damper - spring) / (1 - cd + cs)
        if not damper + cd * new > spring + cs * new > 0:
            new = (spring + damper) / (1 - cs - cd)
    change = new - old
    work.slack[c, i] = new
    for m in range(line.dropper_compliance.value.shape[1]):
        wires.x[first + m, c] += change * line.dropper_compliance.value[i, m]
    return float(abs(change))


@compiled
def update_arms(scheme: Scheme, line: Line, wires: Wires, work: Work, c: int) -> float:
    """Bring all links' forces to what they are on their circles; returns the largest change [N]."""
    change = 0.0
    for i in range(line.links.k.size):
        change = max(change, update_arm(scheme, line, wires, work, c, i))
    return change


@compiled
def update_arm(scheme: Scheme, line: Line, wires: Wires, work: Work, c: int, i: int) -> float:
    """Bring a link's force from its tangent to what it is on its circle; returns the change [N]."""
    links, force = line.links, work.arm_force[c, i]
    a, b = links.at[i, 0], links.at[i, 1]
    y = wires.q[a, c] + scheme.b * wires.x[a, c]
    z = wires.q[b, c] + scheme.b * wires.x[b, c]
    first_y, first_z = links.compliance.first[2 * i], links.compliance.first[2 * i + 1]
    of_y, of_z = links.compliance.value[2 * i], links.compliance.value[2 * i + 1]
    yy, zy = scheme.b * of_y[a - first_y], scheme.b * of_y[b - first_y]
    yz, zz = scheme.b * of_z[a - first_z], scheme.b * of_z[b - first_z]
    change_y, change_z = 0.0, 0.0
    for _ in range(SWEEPS):
        more_y, more_z, ky, kc, kz = beyond_tangent(links, i, y, z)
        off_y, off_z = more_y - force[0] - change_y, more_z - force[1] - change_z
        if abs(off_y) + abs(off_z) < LOOSE:
            break
        # Newton: (I - R' G) d = off, R' the derivative of the force beyond the tangent
        m11, m12 = 1 - (ky * yy + kc * zy), -(ky * yz + kc * zz)
        m21, m22 = -(kc * yy + kz * zy), 1 - (kc * yz + kz * zz)
        determinant = m11 * m22 - m12 * m21
        dy = (m22 * off_y - m12 * off_z) / determinant
        dz = (m11 * off_z - m21 * off_y) / determinant
        change_y, change_z = change_y + dy, change_z + dz
        y, z = y + yy * dy + yz * dz, z + zy * dy + zz * dz
    if change_y == 0.0 and change_z == 0.0:
        return 0.0
    force[0] += change_y
    force[1] += change_z
    for m in range(of_y.size):
        wires.x[first_y + m, c] += change_y * of_y[m]
    for m in range(of_z.size):
        wires.x[first_z + m, c] += change_z * of_z[m]
    return float(abs(change_y) + abs(change_z))


@compiled
def beyond_tangent(
    links: SteadyArmBars, i: int, y: float, z: float
) -> tuple[float, float, float, float, float]:
    """Force of a link [N] beyond its tangent at rest, and its derivatives yy, yz, zz, at displacements."""
    fy, fz, ky, kc, kz = link_force(links, i, y, z)
    rest_y, rest_z, ry, rc, rz = link_force(links, i, 0.0, 0.0)
    ky, kc, kz = ky - ry, kc - rc, kz - rz
    return fy - rest_y - ry * y - rc * z, fz - rest_z - rc * y - rz * z, ky, kc, kz


@compiled
def link_force(links: SteadyArmBars, i: int, y: float, z: float) -> tuple[float, float, float, float, float]:
    """Force of a link on the wire [N], and its derivatives yy, yz, zz."""
    sy, sz, k = links.span[i, 0] - y, links.span[i, 1] - z, links.k[i]
    square = sy * sy + sz * sz
    pull = k * (1 - links.length[i] / np.sqrt(square))
    stiff = (k - pull) / square
    return pull * sy, pull * sz, -pull - stiff * sy * sy, -stiff * sy * sz, -pull - stiff * sz * sz


@compiled
def dropper_parts(scheme: Scheme, line: Line, wires: Wires, c: int, i: int) -> tuple[float, float]:
    """Spring's and damper's force [N] of a dropper, as if it could push."""
    e, rate = 0.0, 0.0
    for m in range(line.rows.start[i], line.rows.start[i + 1]):
        k = line.rows.column[m]
        e += line.rows.value[m] * (wires.q[k, c] + scheme.b * wires.x[k, c])
        rate += line.rows.value[m] * (wires.v[k, c] + scheme.g * wires.x[k, c])
    return line.tension[i] + line.k[i] * e, line.d[i] * rate


@compiled
def solve_contacts(
    scheme: Scheme,
    line: Line,
    wires: Wires,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    to: Records,
    c: int,
) -> None:
    """Forces of contacts and droppers of one slot at the step's end."""
    contacts, time = 0, scheme.h * (pantographs.step[c] + 1)
    for j in range(heads.owner.shape[1]):
        work.force[c, j] = 0.0
        if heads.owner[c, j] >= 0:
            position = heads.start[c, j] + heads.speed[c, j] * time
            place_contact(line, heads, work, c, j, position)
            place_base(heads, work, c, j, time)
            contacts += 1
    for a in range(work.active_count[c]):
        work.slack[c, work.active[c, a]] = 0.0
    links = line.links.k.size
    if links > 0:
        work.arm_force[c, :, :] = 0.0
    laws = heads.laws.kind.shape[1]
    if laws > 0:
        work.law_force[c, :] = 0.0
    free_heads(heads, pantographs, c, time)
    settled, change = True, 0.0
    while True:
        for _ in range(SWEEPS):
            change = 0.0
            for j in range(heads.owner.shape[1]):
                if heads.owner[c, j] >= 0:
                    change = max(change, update_contact(scheme, wires, heads, pantographs, work, c, j))
            for a in range(work.active_count[c]):
                change = max(change, update_dropper(scheme, line, wires, work, c, work.active[c, a]))
            if links > 0:
                change = max(change, update_arms(scheme, line, wires, work, c))
            if laws > 0:
                change = max(change, update_laws(scheme, heads, pantographs, work, c, time))
            settled = change <= TOLERANCE or contacts + work.active_count[c] + links + laws == 1
            if settled:
                break
        if not find_slack(scheme, line, wires, work, to.droppers[c, :, pantographs.step[c] + 1], c):
            break
    keep_slack(scheme, line, wires, work, to, c, pantographs.step[c] + 1)
    if not settled and change > UNSETTLED:
        work.force[c, :] = np.nan  # the run's end says so


@compiled
def find_slack(scheme: Scheme, line: Line, wires: Wires, work: Work, forces: Floats, c: int) -> bool:
    """Forces of all droppers; those that are not as taut ones become active: true if there are new ones."""
    more = False
    for i in range(line.k.size):
        spring, damper = dropper_parts(scheme, line, wires, c, i)
        forces[i] = one_way(spring, damper)
        if not (spring > 0 and -spring <= damper <= spring) and not is_active(work, c, i):
            work.active[c, work.active_count[c]] = i
            work.active_count[c] += 1
            more = True
    return more


@compiled
def is_active(work: Work, c: int, i: int) -> bool:
    """Whether a dropper is in the list of active ones."""
    for a in range(work.active_count[c]):  # noqa: SIM110 compiled, a generator is not
        if work.active[c, a] == i:
            return True
    return False


@compiled
def keep_slack(scheme: Scheme, line: Line, wires: Wires, work: Work, to: Records, c: int, n: int) -> None:
    """Take taut droppers off the list of active ones; write down how far the others shorten in step n."""
    kept = 0
    for a in range(work.active_count[c]):
        i = work.active[c, a]
        if work.slack[c, i] != 0.0:
            spring, _ = dropper_parts(scheme, line, wires, c, i)
            shorter = -spring / line.k[i]
            if shorter > to.shortening[c, i]:
                to.shortening[c, i], to.shortened[c, i] = shorter, n
            work.active[c, kept] = i
            kept += 1
    work.active_count[c] = kept


@compiled
def record(
    scheme: Scheme,
    line: Line,
    wires: Wires,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    to: Records,
    c: int,
) -> None:
    """Write down the pantographs at the end of a slot's step."""
    n = pantographs.step[c] + 1
    for j in range(heads.owner.shape[1]):
        if heads.owner[c, j] < 0:
            continue
        to.force[c, j, n] = work.force[c, j]
        z = work.shape[c, j, 4] - heads.nominal
        for m in range(4):
            i = work.at[c, j, m]
            if i >= 0:
                z += work.shape[c, j, m] * (wires.q[i, c] + scheme.b * wires.x[i, c])
        to.height[c, j, n] = z
        if to.lateral.shape[2] > 0:
            to.lateral[c, j, n] = lateral_place(scheme, line, wires, work, c, j)
    for p in range(pantographs.x.shape[1]):
        for s in range(pantographs.x.shape[2]):
            to.masses[c, p, s, n] = pantographs.q[c, p, s] + scheme.b * pantographs.x[c, p, s]
    for s in range(line.supports.size):
        i = line.supports[s]
        if i >= 0:
            to.supports[c, s, n] = wires.q[i, c] + scheme.b * wires.x[i, c]
    for s in range(line.tensions.size):
        i = line.tensions[s]
        tension = wires.q[i, c] + scheme.b * wires.x[i, c]
        work.tension[c, s] = tension
        if abs(tension) > to.change[c, s]:
            to.change[c, s], to.changed[c, s] = abs(tension), n
    if to.every > 0 and n % to.every == 0:
        for node in range(line.heights.size):
            i = line.heights[node]
            if i >= 0:
                to.wire[c, n // to.every, node] = wires.q[i, c] + scheme.b * wires.x[i, c]
