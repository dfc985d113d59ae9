"""Forces on the wires, and how the wires give to a force at one place."""

from __future__ import annotations

import numpy as np

from catenary_fe.engines.arrays import Floats, Integers
from catenary_fe.engines.compiled import compiled
from catenary_fe.engines.contact_solver import one_way
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.kernels import lower, upper
from catenary_fe.engines.nonlinear.arrays import EnergyBalance, Equations, Factor, Motion, Slack, SpringArrays

REACH = 64  # groups of four coordinates beyond which a force is not felt within a step
ROOM = 4 * 3 * REACH  # coordinates of the largest window


@compiled
def take_links(links: SpringArrays, total: Floats, inner: Floats) -> None:
    """Take the forces of links off those on all coordinates; links pull and push."""
    axes = links.pivot.shape[1]
    for i in range(links.first.size):
        a, square = links.first[i], 0.0
        for k in range(axes):
            square += (links.pivot[i, k] - total[a + k]) ** 2
        length = np.sqrt(square)
        pull = links.k[i] * (length - links.length[i]) / length
        for k in range(axes):
            inner[a + k] += pull * (links.pivot[i, k] - total[a + k])


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
    """Add the droppers' pull to the forces on all coordinates; write it down; find what each lacks.

    forces : shape (droppers, times)
    """
    droppers, total, inner = system.droppers, motion.total, motion.inner
    axes = droppers.pivot.shape[1]
    for i in range(droppers.first.size):
        a, b = droppers.first[i], droppers.last[i]
        square, work = 0.0, 0.0
        for k in range(axes):
            span = total[b + k] - total[a + k]
            square += span * span
            work += span * (_at(motion.v, system.dof[b + k]) - _at(motion.v, system.dof[a + k]))
        length = np.sqrt(square)
        spring = droppers.k[i] * (length - droppers.length[i])
        damper = droppers.d[i] * work / length
        force = one_way(spring, damper)
        forces[i, time] = force
        energy.new_damper[i], energy.new_span[i] = force - max(spring, 0.0), length
        slack.lack[i] = _lack(scheme, droppers.k[i], droppers.d[i], spring, damper)
        for k in range(axes):
            direction = (total[b + k] - total[a + k]) / length
            inner[a + k] += force * direction
            inner[b + k] -= force * direction
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


@compiled
def solve(factor: Factor, x: Floats) -> None:
    """Solve with the step's matrix at rest, in place."""
    groups = x.size // 4
    lower(factor.packed, x, 0, groups)
    upper(factor.packed, x, 0, groups)
