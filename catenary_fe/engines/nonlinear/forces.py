"""Forces on the wires, and how the wires give to a force at one place."""

from __future__ import annotations

from typing import Any

import numpy as np

from catenary_fe.engines.arrays import SLOTS, Floats, Integers
from catenary_fe.engines.compiled import apart, compiled
from catenary_fe.engines.contact_solver import one_way
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.kernels import lower, upper
from catenary_fe.engines.lanes import add_to, follow, gather, last, lead, load_eight
from catenary_fe.engines.nonlinear.arrays import EnergyBalance, Equations, Factor, Motion, Slack
from catenary_fe.engines.nonlinear.cables import (
    damp,
    factors_of,
    inner_forces,
    nothing,
    plus,
    points_of,
    rates_of,
    taken,
)

REACH = 64  # groups of four coordinates beyond which a force is not felt within a step
ROOM = 4 * 3 * REACH  # coordinates of the largest window


@compiled
def take_links(system: Equations, q: Floats, forces: Floats) -> None:
    """Add the forces of links to those on the free coordinates; links pull and push."""
    links, axes = system.links, system.links.pivot.shape[1]
    for i in range(links.first.size):
        a, square = links.first[i], 0.0
        for k in range(axes):
            square += (links.pivot[i, k] - place_at(system, q, k, a)) ** 2
        length = np.sqrt(square)
        pull = links.k[i] * (length - links.length[i]) / length
        for k in range(axes):
            _add(forces, system.dof[k, a], pull * (links.pivot[i, k] - place_at(system, q, k, a)))


@compiled
def _add(forces: Floats, place: int, force: float) -> None:
    if place >= 0:
        forces[place] += force


@apart
def take_cables(system: Equations, motion: Motion, x: Floats, forces: Floats) -> None:
    """Take the cables' inner forces, damping and inertia from those on the free coordinates.

    x : [m/s²], shape (free,), accelerations
    """
    elements, room, axes = system.elements, motion.room, system.dof.shape[0] // 2
    for e in range(0, elements.length.size, SLOTS):
        products = nothing(elements)
        for axis in range(axes):
            ends = _places(system, motion.q, e, axis)
            products = plus(products, points_of(elements, room, e, axis, ends))
            rates_of(elements, room, e, axis, _ends(system, motion.v, e, axis))
        damp(elements, room, e)
        factors = factors_of(elements, e, products)
        for axis in range(axes):
            inner = inner_forces(room, axis, factors)
            _put(system, forces, e, axis, taken(elements, room, e, axis, inner, _ends(system, x, e, axis)))


@apart
def damp_cables(system: Equations, motion: Motion, forces: Floats) -> None:
    """Take the cables' damping from forces on the free coordinates."""
    elements, room, axes = system.elements, motion.room, system.dof.shape[0] // 2
    for e in range(0, elements.length.size, SLOTS):
        for axis in range(axes):
            rates_of(elements, room, e, axis, _ends(system, motion.v, e, axis))
        damp(elements, room, e)
        zero = 0.0 * load_eight(elements.length, e)
        for axis in range(axes):
            none, still = (zero, zero, zero), (zero, zero, zero, zero)
            _put(system, forces, e, axis, taken(elements, room, e, axis, none, still))


@compiled
def _ends(system: Equations, values: Floats, e: int, axis: int) -> Any:
    """Of eight elements, one axis of free coordinates' values: positions and slopes at both ends."""
    dof, places, axes = system.dof, system.dof.shape[1], system.dof.shape[0] // 2
    i, j = axis * places + e, (axes + axis) * places + e
    y, s = gather(values, dof, i), gather(values, dof, j)
    z, t = (
        follow(y, _at(values, dof[axis, e + SLOTS])),
        follow(s, _at(values, dof[axes + axis, e + SLOTS])),
    )
    return y, s, z, t


@compiled
def _places(system: Equations, q: Floats, e: int, axis: int) -> Any:
    """Likewise where the wires are."""
    X, places, axes = system.reference, system.dof.shape[1], system.dof.shape[0] // 2
    i, j, moved = axis * places + e, (axes + axis) * places + e, _ends(system, q, e, axis)
    first, last = load_eight(X, i) + moved[0], load_eight(X, i + 1) + moved[2]
    return first, load_eight(X, j) + moved[1], last, load_eight(X, j + 1) + moved[3]


@compiled
def _put(system: Equations, forces: Floats, e: int, axis: int, by_ends: Any) -> None:
    """Add what eight elements took from their nodes."""
    dof, places, axes, end = system.dof, system.dof.shape[1], system.dof.shape[0] // 2, e + SLOTS
    add_to(forces, dof, axis * places + e, by_ends[0] + lead(by_ends[2]))
    add_to(forces, dof, (axes + axis) * places + e, by_ends[1] + lead(by_ends[3]))
    _add(forces, dof[axis, end], last(by_ends[2]))
    _add(forces, dof[axes + axis, end], last(by_ends[3]))


@compiled
def place_at(system: Equations, q: Floats, m: int, n: int) -> float:
    """A coordinate of a node where the wires are: of what is free, less its reference is q."""
    return float(system.reference[m, n] + _at(q, system.dof[m, n]))


@compiled
def take_droppers(
    system: Equations,
    scheme: Scheme,
    motion: Motion,
    slack: Slack,
    energy: EnergyBalance,
    forces: Floats,
    time: int,
) -> None:
    """Add the droppers' pull to the forces on the free coordinates; write it down; find what each lacks.

    forces : shape (droppers, times)
    """
    droppers, q, dof = system.droppers, motion.q, system.dof
    axes = droppers.pivot.shape[1]
    for i in range(droppers.first.size):
        a, b = droppers.first[i], droppers.last[i]
        square, work = 0.0, 0.0
        for k in range(axes):
            span = place_at(system, q, k, b) - place_at(system, q, k, a)
            slack.row[i, axes + k] = span
            square += span * span
            work += span * (_at(motion.v, dof[k, b]) - _at(motion.v, dof[k, a]))
        length = np.sqrt(square)
        spring = droppers.k[i] * (length - droppers.length[i])
        damper = droppers.d[i] * work / length
        force = one_way(spring, damper)
        forces[i, time] = force
        energy.new_damper[i], energy.new_span[i] = force - max(spring, 0.0), length
        slack.lack[i] = _lack(scheme, droppers.k[i], droppers.d[i], spring, damper)
        for k in range(axes):
            direction = slack.row[i, axes + k] / length
            _add(motion.residual, dof[k, a], force * direction)
            _add(motion.residual, dof[k, b], -force * direction)
            slack.row[i, k], slack.row[i, axes + k] = -direction, direction


@compiled
def _at(values: Floats, place: int) -> float:
    return values[place] if place >= 0 else 0.0


@compiled
def _lack(scheme: Scheme, k: float, d: float, spring: float, damper: float) -> float:
    """By how much the tangent of :func:`one_way` is less than a taut dropper's."""
    taut = scheme.b * k + scheme.g * d
    if spring <= 0 or damper < -spring:
        return taut
    if damper > spring:
        return taut - 2 * scheme.b * k
    return 0.0


@compiled
def local_compliance(factor: Factor, at: Integers, weights: Floats, column: Floats) -> tuple[int, int]:
    """The wires' answer to forces ``weights`` at the free coordinates ``at``, near them.

    Written to ``column``; returns from which coordinate on, and in how many.
    """
    groups = factor.window.size // 4
    low, high = groups, -1
    for m in range(at.size):
        if at[m] >= 0:
            low, high = min(low, at[m] // 4), max(high, at[m] // 4)
    if high < 0:
        return 0, 0
    first, last = max(low - REACH, 0), min(high + REACH + 1, low + 2 * REACH, groups)
    begin, end, window = 4 * first, 4 * last, factor.window
    for m in range(at.size):
        if at[m] >= 0:
            window[at[m]] += weights[m]
    lower(factor.packed, window, low, last)  # what is outside is zero
    upper(factor.packed, window, first, last)
    for i in range(begin, end):
        column[i - begin] = window[i]
        window[i] = 0.0
    return begin, end - begin


@compiled
def woodbury_update(factor: Factor, slack: Slack, x: Floats) -> None:
    """Correct a solution with the step's matrix at rest for the droppers that are not as taut ones.

    x : shape (free,)
    """
    for i in range(slack.lack.size):
        if slack.lack[i] == 0.0:
            continue
        if slack.width[i] == 0:
            first, width = local_compliance(factor, slack.at[i], slack.row[i], slack.column[i])
            slack.first[i], slack.width[i] = first, width
        moved, give, first = 0.0, 0.0, slack.first[i]
        for m in range(slack.at.shape[1]):
            k = slack.at[i, m]
            if k >= 0:
                moved += slack.row[i, m] * x[k]
                give += slack.row[i, m] * slack.column[i, k - first]
        change = slack.lack[i] * moved / (1 - slack.lack[i] * give)
        for m in range(slack.width[i]):
            x[first + m] += change * slack.column[i, m]


@apart
def solve(factor: Factor, x: Floats) -> None:
    """Solve with the step's matrix at rest, in place."""
    groups = x.size // 4
    lower(factor.packed, x, 0, groups)
    upper(factor.packed, x, 0, groups)
