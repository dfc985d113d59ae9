"""From where the wires shall hang to cable elements that hang there."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import Cables, inner_forces, tangent_blocks
from catenary_fe.fe.installation import WireLine, curve_pulls, wire_kinds
from catenary_fe.layout import GRAVITY, SolverError
from catenary_fe.statics.taut_wires import TautWires

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

_ITERATIONS = 40
_FACTORS = 2  # iterations with a tangent of their own: after them it hardly changes
_ENOUGH = 1e-6  # which the balance takes up: 17 N of EA ε
_SETTLED = 1e-9  # change of slopes and, by their length, of lengths


def installed_lines(wires: TautWires, points: Floats, inclinations: Floats) -> tuple[WireLine, ...]:
    """Lines of cable elements through given points, under each wire's tension along the track.

    points : [m], shape (nodes of all wires, axes)
    inclinations : shape (nodes of all wires, axes - 1), where the slopes are looked for

    A cubic element has no kink: at clamps and supports its slope lies between the wire's two. So the nodes
    stay on their points, and the slopes turn until they are free of moments; elements are as long as gives
    them their tension.
    """
    mesh, catenary = wires.mesh, wires.catenary
    ends = mesh.first_nodes
    pulls = np.split(wires.tension, np.cumsum([w.x.size - 1 for w in mesh.wires])[:-1])
    lines = [
        WireLine.through(kind, points[a:b], inclinations[a:b], pull)
        for kind, a, b, pull in zip(wire_kinds(catenary, mesh), ends[:-1], ends[1:], pulls, strict=True)
    ]
    slopes, lengths = _settled(wires, points, lines)
    parts = zip(ends[:-1], ends[1:], np.split(lengths, np.cumsum([p.size for p in pulls])[:-1]), strict=True)
    return tuple(WireLine(points[a:b], slopes[a:b], part) for a, b, part in parts)


def _settled(wires: TautWires, points: Floats, lines: list[WireLine]) -> tuple[Floats, Floats]:
    """Slopes, shape (nodes, axes), and element lengths [m] in balance."""
    from scipy.linalg import cho_solve_banded

    axes, left = points.shape[1], wires.left
    slopes = np.concatenate([line.slopes for line in lines])
    lengths = np.concatenate([line.lengths for line in lines])
    EA, T = wires.of_wire("axial_stiffness"), wires.of_wire("tension")
    pull = np.zeros((left.size, axes))  # [N/kg]
    pull[:, -1] = -GRAVITY
    if axes == 3:
        pull[:, 1] = np.concatenate(curve_pulls(wires.catenary, wires.mesh))
    place = (left[:, None] * axes + np.arange(2 * axes)).astype(np.int64)
    for iteration in range(_ITERATIONS):
        cables = Cables(lengths, EA, wires.bending_stiffness, -T / EA)
        values = np.stack([points[left], slopes[left], points[left + 1], slopes[left + 1]], axis=1)
        inner = inner_forces(cables, values)
        moment = (wires.weight * lengths**2 / 12)[:, None] * pull
        moments = np.concatenate([moment - inner[:, 1], -moment - inner[:, 3]], axis=1)
        if iteration < _FACTORS:
            factor = _factor(place, tangent_blocks(cables, values, definite=True), axes, slopes.size)
        out = np.bincount(place.ravel(), moments.ravel(), minlength=slopes.size)
        turn = cho_solve_banded((factor, False), out).reshape(slopes.shape)
        longer = (inner[:, 2, 0] - wires.tension) / EA
        slopes, lengths = slopes + turn, lengths * (1 + longer)
        if max(np.abs(turn).max(), np.abs(longer).max()) < _SETTLED:
            return slopes, lengths
    if not np.abs(longer).max() < _ENOUGH:
        worst = int(np.nan_to_num(np.abs(longer), nan=np.inf).argmax())
        raise SolverError(
            f"form finding: the {wires.name_of(worst)} finds no balance at {wires.x[left[worst]]:.1f} m along"
            " the line; look there for clamps that are very close, little tension and sharp kinks"
        )
    return slopes, lengths


def _factor(place: Integers, blocks: Floats, axes: int, size: int) -> Floats:
    """Banded Cholesky factor of the slopes' stiffness.

    place : shape (elements, 2 * axes), numbers of the slopes
    blocks : shape (elements, 4 * axes, 4 * axes), of points and slopes
    """
    from scipy.linalg import cholesky_banded

    of_slopes = np.concatenate([axes + np.arange(axes), 3 * axes + np.arange(axes)])
    row, column = np.triu_indices(2 * axes)
    bands = np.zeros((2 * axes, size))
    np.add.at(
        bands,
        (2 * axes - 1 + row - column, place[:, column]),
        blocks[:, of_slopes[row], of_slopes[column]],
    )
    factor: Floats = cholesky_banded(bands)
    return factor
