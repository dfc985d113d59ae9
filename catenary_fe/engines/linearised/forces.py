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
    move_wires,
    one_way,
    place_base,
    place_head,
    update_contact,
    weigh_contact,
)
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.linearised.arrays import Line, Near, SteadyArmBars
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
            add_scaled(column[shift : shift + size], shape[m], line.contact_compliance.value[k])
    place_head(heads, work, c, j, lateral)


@compiled
def add_scaled(to: Floats, factor: float, values: Floats) -> None:
    """to += factor values"""
    for i in range(to.size):
        to[i] += factor * values[i]


@compiled
def update_dropper(scheme: Scheme, line: Line, wires: Wires, work: Work, c: int, i: int) -> float:
    """Bring one dropper's force to its law, from a taut one's; returns the change [N], to be felt."""
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
    work.slack[c, i] = new
    return float(new - old)


@compiled
def update_arm(scheme: Scheme, line: Line, wires: Wires, work: Work, c: int, i: int) -> tuple[float, float]:
    """Bring a link's force from its tangent to its circle; returns the change [N], to be felt."""
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
    force[0] += change_y
    force[1] += change_z
    return change_y, change_z


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
    near: Near,
    to: Records,
    c: int,
) -> None:
    """Forces of contacts and droppers of one slot at the step's end."""
    n = pantographs.step[c] + 1
    forces, time = line.links.k.size + heads.laws.kind.shape[1], scheme.h * n
    for j in range(heads.owner.shape[1]):
        work.force[c, j] = 0.0
        if heads.owner[c, j] >= 0:
            position = heads.start[c, j] + heads.speed[c, j] * time
            place_contact(line, heads, work, c, j, position)
            place_base(heads, work, c, j, time)
            forces += 1
    for a in range(work.active_count[c]):
        work.slack[c, work.active[c, a]] = 0.0
    if line.links.k.size > 0:
        work.arm_force[c, :, :] = 0.0
    if heads.laws.kind.shape[1] > 0:
        work.law_force[c, :] = 0.0
    free_heads(heads, pantographs, c, time)
    while True:
        begin_sweeps(line, wires, heads, work, near, c)
        for _ in range(SWEEPS):
            change = sweep(scheme, line, wires, heads, pantographs, work, near, c, time)
            settled = change <= TOLERANCE or forces + work.active_count[c] == 1
            if settled:
                break
        end_sweeps(line, wires, heads, work, near, c)
        if not find_slack(scheme, line, wires, work, to.droppers[c, :, n], c):
            break
    keep_slack(scheme, line, wires, work, to, c, n)
    if not settled and change > UNSETTLED:
        work.force[c, :] = np.nan  # the run's end says so


@compiled
def begin_sweeps(
    line: Line, wires: Wires, heads: PantographParameters, work: Work, near: Near, c: int
) -> None:
    """Find the coordinates that laws read."""
    near.many[0] = 0
    for j in range(heads.owner.shape[1]):
        if heads.owner[c, j] >= 0:
            for m in range(4):
                read_too(near, work.at[c, j, m])
    for a in range(work.active_count[c]):
        i = work.active[c, a]
        for m in range(line.rows.start[i], line.rows.start[i + 1]):
            read_too(near, line.rows.column[m])
    for i in range(line.links.k.size):
        read_too(near, line.links.at[i, 0])
        read_too(near, line.links.at[i, 1])
    for k in range(near.many[0]):
        near.free[k] = wires.x[near.at[k], c]


@compiled
def read_too(near: Near, i: int) -> None:
    """A law reads this coordinate, too, if it is one."""
    many = near.many[0]
    if i < 0:
        return
    for k in range(many):
        if near.at[k] == i:
            return
    near.at[many] = i
    near.many[0] = many + 1


@compiled
def sweep(
    scheme: Scheme,
    line: Line,
    wires: Wires,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    near: Near,
    c: int,
    time: float,
) -> float:
    """Bring each force to its law in turn; returns the largest change [N]."""
    largest, contacts = 0.0, heads.owner.shape[1]
    for j in range(contacts):
        if heads.owner[c, j] >= 0:
            change = update_contact(scheme, wires, heads, pantographs, work, c, j)
            push(wires, near, c, j, work.first[c, j], work.column[c, j, : work.width[c, j]], change)
            largest = max(largest, abs(change))
    give = line.dropper_compliance
    for a in range(work.active_count[c]):
        i = work.active[c, a]
        change = update_dropper(scheme, line, wires, work, c, i)
        push(wires, near, c, contacts + i, give.first[i], give.value[i], change)
        largest = max(largest, abs(change))
    give = line.links.compliance
    for i in range(line.links.k.size):
        y, z = update_arm(scheme, line, wires, work, c, i)
        m = contacts + line.k.size + 2 * i
        push(wires, near, c, m, give.first[2 * i], give.value[2 * i], y)
        push(wires, near, c, m + 1, give.first[2 * i + 1], give.value[2 * i + 1], z)
        largest = max(largest, abs(y) + abs(z))
    if heads.laws.kind.shape[1] > 0:
        largest = max(largest, update_laws(scheme, heads, pantographs, work, c, time))
    return largest


@compiled
def push(wires: Wires, near: Near, c: int, of: int, first: int, column: Floats, change: float) -> None:
    """What a force's change [N] does to the coordinates that laws read; the others have yet to feel it."""
    if change == 0.0:
        return
    near.owed[of] += change
    for k in range(near.many[0]):
        i = near.at[k]
        if first <= i < first + column.size:
            wires.x[i, c] += change * column[i - first]


@compiled
def end_sweeps(line: Line, wires: Wires, heads: PantographParameters, work: Work, near: Near, c: int) -> None:
    """Let all coordinates feel what is owed."""
    for k in range(near.many[0]):
        wires.x[near.at[k], c] = near.free[k]
    contacts = heads.owner.shape[1]
    for j in range(contacts):
        if heads.owner[c, j] >= 0:
            pay(wires, near, c, j, work.first[c, j], work.column[c, j, : work.width[c, j]])
    give = line.dropper_compliance
    for a in range(work.active_count[c]):
        i = work.active[c, a]
        pay(wires, near, c, contacts + i, give.first[i], give.value[i])
    give = line.links.compliance
    for m in range(2 * line.links.k.size):
        pay(wires, near, c, contacts + line.k.size + m, give.first[m], give.value[m])


@compiled
def pay(wires: Wires, near: Near, c: int, of: int, first: int, column: Floats) -> None:
    """Let all coordinates feel what is owed of a force."""
    if near.owed[of] != 0.0:
        move_wires(wires, c, first, column, near.owed[of])
        near.owed[of] = 0.0


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
        work.tension[s, c] = tension
        if abs(tension) > to.change[c, s]:
            to.change[c, s], to.changed[c, s] = abs(tension), n
    if to.every > 0 and n % to.every == 0:
        for node in range(line.heights.size):
            i = line.heights[node]
            if i >= 0:
                to.wire[c, n // to.every, node] = wires.q[i, c] + scheme.b * wires.x[i, c]
