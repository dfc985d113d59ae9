"""Forces of linearised runs that act through few coordinates: contacts and slack droppers.

Plain functions, compiled where numba is installed. In a step the coordinates at its end are q = q* + b x and
v = v* + g x, where x are the accelerations there. A force changes x by a column of the inverse of the step's
matrix. The forces are found by relaxation: each law is solved exactly in turn, until they are consistent.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from catenary_fe.engines.arrays import Floats, Heads, Line, Records, SteadyArmBars, Wires, Work
from catenary_fe.engines.compiled import compiled
from catenary_fe.engines.generalized_alpha import Scheme, advance

SWEEPS = 60
TOLERANCE = 1e-9  # [N] by which forces may still change
UNSETTLED = 1e-3  # [N] by which they may still change after the last sweep
LOOSE = 1e-3  # [N] of a link's force that is left out
FAR = 2**31  # beyond all rows


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
def weigh_contact(line: Any, heads: Heads, work: Work, c: int, j: int, position: float) -> tuple[int, float]:
    """Shape functions at a contact; the element's first node, and how far to the left it is at rest."""
    begin, end = line.first[heads.wire[c, j]], line.first[heads.wire[c, j] + 1]
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
        shape[4] += shape[m] * line.static[node, which]
        rise[4] += rise[m] * line.static[node, which]
        lateral += shape[m] * line.lateral[node, which]
        at[m] = line.at[node, which]
    return e, lateral


@compiled
def place_contact(line: Line, heads: Heads, work: Work, c: int, j: int, position: float) -> None:
    """Shape functions, and how wire and head give, at a contact."""
    e, lateral = weigh_contact(line, heads, work, c, j, position)
    shape, at = work.shape[c, j], work.at[c, j]
    low, high, size = FAR, 0, line.contact_compliance.value.shape[1]
    for m in range(4):
        if at[m] >= 0:
            begin = line.contact_compliance.first[line.column[e + m // 2, m % 2]]
            low, high = min(low, begin), max(high, begin + size)
    work.first[c, j], work.width[c, j] = low, high - low
    column = work.column[c, j, : high - low]
    column[:] = 0.0
    for m in range(4):
        k = line.column[e + m // 2, m % 2]
        if k >= 0:
            shift = line.contact_compliance.first[k] - low
            for i in range(size):
                column[shift + i] += shape[m] * line.contact_compliance.value[k, i]
    place_head(heads, work, c, j, lateral)


@compiled
def place_head(heads: Heads, work: Work, c: int, j: int, lateral: float) -> None:
    """The head's height at a contact this far to the left, as a row of its coordinates, and how it gives."""
    p, head, head_compliance = heads.owner[c, j], work.head[c, j], work.head_compliance[c, j]
    for s in range(head.size):
        head[s] = heads.heave[c, j, s] + lateral * heads.roll[c, j, s]
    for s in range(head.size):
        head_compliance[s] = 0.0
        for r in range(head.size):
            head_compliance[s] += heads.inverse[c, p, s, r] * head[r]


@compiled
def update_contact(scheme: Scheme, wires: Wires, heads: Heads, work: Work, c: int, j: int) -> float:
    """Bring one contact's force to its law; returns the change [N]."""
    p = heads.owner[c, j]
    shape, rise, at, column = work.shape[c, j], work.rise[c, j], work.at[c, j], work.column[c, j]
    z, slope, climb, give, turn = shape[4] - heads.nominal, rise[4], 0.0, 0.0, 0.0
    first = work.first[c, j]
    for m in range(4):
        i = at[m]
        if i >= 0:
            q = wires.q[i, c] + scheme.b * wires.x[i, c]
            z += shape[m] * q
            slope += rise[m] * q
            climb += shape[m] * (wires.v[i, c] + scheme.g * wires.x[i, c])
            give += shape[m] * column[i - first]
            turn += rise[m] * column[i - first]
    climb += heads.speed[c] * slope
    head, rate, light = 0.0, 0.0, 0.0
    for s in range(heads.x.shape[2]):
        row = work.head[c, j, s]
        head += row * (heads.q[c, p, s] + scheme.b * heads.x[c, p, s])
        rate += row * (heads.v[c, p, s] + scheme.g * heads.x[c, p, s])
        light += row * work.head_compliance[c, j, s]
    k, d, old = heads.k[c, j], heads.d[c, j], work.force[c, j]
    cs = k * scheme.b * (give + light)
    cd = d * (scheme.g * (give + light) + heads.speed[c] * scheme.b * turn)
    spring, damper = k * (head - z) + heads.preload[c, j], d * (rate - climb)
    force = solve_one_way(spring + cs * old, damper + cd * old, cs, cd)
    change = force - old
    work.force[c, j] = force
    for i in range(work.width[c, j]):
        wires.x[first + i, c] += change * column[i]
    for s in range(heads.x.shape[2]):
        heads.x[c, p, s] -= change * work.head_compliance[c, j, s]
    return float(abs(change))


@compiled
def update_dropper(scheme: Scheme, line: Line, wires: Wires, work: Work, c: int, i: int) -> float:
    """Bring one dropper's force to its law, from a taut one's; returns the change [N]."""
    spring, damper = dropper_parts(scheme, line, wires, c, i)
    old = work.slack[c, i]
    if old == 0.0 and spring > 0 and -spring <= damper <= spring:
        return 0.0
    give, first = 0.0, line.dropper_compliance.first[i]
    for m in range(line.rows.start[i], line.rows.start[i + 1]):
        give += line.rows.value[m] * line.dropper_compliance.value[i, line.rows.column[m] - first]
    cs, cd = line.k[i] * scheme.b * give, line.d[i] * scheme.g * give
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
def free_heads(heads: Heads, c: int) -> None:
    """Accelerations of the masses without contact."""
    pantographs, masses = heads.x.shape[1], heads.x.shape[2]
    for p in range(pantographs):
        for r in range(masses):
            heads.x[c, p, r] = 0.0
        for s in range(masses):
            load = heads.load[c, p, s]
            for r in range(masses):
                load -= heads.K[c, p, s, r] * heads.q[c, p, r] + heads.D[c, p, s, r] * heads.v[c, p, r]
            for r in range(masses):
                heads.x[c, p, r] += heads.inverse[c, p, r, s] * load


@compiled
def advance_heads(scheme: Scheme, heads: Heads, c: int) -> None:
    """From the accelerations at this step's end to the prediction for the next one."""
    for p in range(heads.x.shape[1]):
        for s in range(heads.x.shape[2]):
            q, v, k = advance(scheme, heads.q[c, p, s], heads.v[c, p, s], heads.c[c, p, s], heads.x[c, p, s])
            heads.q[c, p, s], heads.v[c, p, s], heads.c[c, p, s] = q, v, k


@compiled
def solve_contacts(
    scheme: Scheme, line: Line, wires: Wires, heads: Heads, work: Work, to: Records, c: int
) -> None:
    """Forces of contacts and droppers of one slot at the step's end."""
    contacts = 0
    for j in range(heads.owner.shape[1]):
        work.force[c, j] = 0.0
        if heads.owner[c, j] >= 0:
            position = heads.start[c, j] + heads.speed[c] * scheme.h * (heads.step[c] + 1)
            place_contact(line, heads, work, c, j, position)
            contacts += 1
    for a in range(work.active_count[c]):
        work.slack[c, work.active[c, a]] = 0.0
    links = line.links.k.size
    if links > 0:
        work.arm_force[c, :, :] = 0.0
    free_heads(heads, c)
    settled, change = True, 0.0
    while True:
        for _ in range(SWEEPS):
            change = 0.0
            for j in range(heads.owner.shape[1]):
                if heads.owner[c, j] >= 0:
                    change = max(change, update_contact(scheme, wires, heads, work, c, j))
            for a in range(work.active_count[c]):
                change = max(change, update_dropper(scheme, line, wires, work, c, work.active[c, a]))
            if links > 0:
                change = max(change, update_arms(scheme, line, wires, work, c))
            settled = change <= TOLERANCE or contacts + work.active_count[c] + links == 1
            if settled:
                break
        if not find_slack(scheme, line, wires, work, to.droppers[c, :, heads.step[c] + 1], c):
            break
    keep_slack(scheme, line, wires, work, to, c, heads.step[c] + 1)
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
def record(scheme: Scheme, line: Line, wires: Wires, heads: Heads, work: Work, to: Records, c: int) -> None:
    """Write down the state at the end of a slot's step."""
    n = heads.step[c] + 1
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
    for p in range(heads.x.shape[1]):
        for s in range(heads.x.shape[2]):
            to.masses[c, p, s, n] = heads.q[c, p, s] + scheme.b * heads.x[c, p, s]
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
