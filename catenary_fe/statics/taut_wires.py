"""Statics of wires whose tension along the track is known: strings and tensioned beams in exact elements.

While a line is installed, weights (or a winch) tension each wire, and nothing pulls along the track.
Then height and lateral position are each a linear problem, H w'' - EI w'''' = -q, that has a direct solution:
elements are exact, kinks at clamps and supports are as sharp as the wire makes them, whatever the mesh.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import Cables, inner_forces, scattered, tangent_blocks
from catenary_fe.fe.installation import WireLine, curve_pulls, element_pulls, element_values, wire_kinds
from catenary_fe.fe.mesh import Mesh
from catenary_fe.layout import GRAVITY, Catenary, SolverError

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

_STIFF = 0.05  # length of an element over that of its bending zone: below it the cubic element is exact


def exact_stiffness(tension: Floats, bending_stiffness: Floats, length: Floats) -> Floats:
    """Stiffness of tensioned beams, shape (elements, 4, 4): deflection and slope at both ends.

    tension, bending_stiffness, length : [N], [N m²], [m], shape (elements,). Without bending stiffness it is
        that of strings, which know no slopes.

    Source: the stability functions of a beam under tension, derived here from w = a + b x + c cosh λx
    + d sinh λx with λ = √(H/EI), and checked against that solution in the tests.
    """
    found = np.zeros((length.size, 4, 4))
    bends = bending_stiffness > 0
    H, EI, L = tension, np.where(bends, bending_stiffness, 1.0), length
    u = np.where(bends, L * np.sqrt(H / EI), 1.0)
    end = np.exp(-np.minimum(u, 700.0))
    sech, tanh = 2 * end / (1 + end**2), (1 - end**2) / (1 + end**2)
    rest = 2 * sech - 2 + u * tanh
    cubic = u < _STIFF
    rest = np.where(cubic, 1.0, rest)
    shear = np.where(cubic, 12 + 1.2 * u**2, u**3 * tanh / rest)
    moment = np.where(cubic, 6 + u**2 / 10, u**2 * (1 - sech) / rest)
    near = np.where(cubic, 4 + 2 * u**2 / 15, u * (u - tanh) / rest)
    far = np.where(cubic, 2 - u**2 / 30, u * (tanh - u * sech) / rest)
    k = np.where(bends, shear * EI / L**3, H / L)
    m, n, f = (np.where(bends, c * EI / L**p, 0.0) for c, p in ((moment, 2), (near, 1), (far, 1)))
    found[:, 0, 0] = found[:, 2, 2] = k
    found[:, 0, 2] = found[:, 2, 0] = -k
    for i in (1, 3):
        found[:, 0, i] = found[:, i, 0] = m
        found[:, 2, i] = found[:, i, 2] = -m
        found[:, i, i] = n
    found[:, 1, 3] = found[:, 3, 1] = f
    return found


def exact_load(tension: Floats, bending_stiffness: Floats, length: Floats) -> Floats:
    """What a load of 1 N/m does at the ends, shape (elements, 4), arguments as :func:`exact_stiffness`."""
    bends = bending_stiffness > 0
    u = np.where(bends, length * np.sqrt(tension / np.where(bends, bending_stiffness, 1.0)), 1.0)
    small = u < _STIFF
    half = np.where(small, 1.0, u / 2)
    share = np.where(small, 1 / 12 - u**2 / 720, (half / np.tanh(half) - 1) / (2 * half) ** 2)
    turn = np.where(bends, share * length**2, 0.0)
    return np.stack([length / 2, turn, length / 2, -turn], axis=1)


@dataclass(frozen=True)
class TautWires:
    """All wires of a catenary, seen along one axis across the track.

    Unknowns are the nodes' displacements and behind them, of wires with bending stiffness, their slopes: both
    of shape (nodes of all wires,). Stitch wires share displacements with the messenger wire at their ends.
    """

    catenary: Catenary
    mesh: Mesh

    @cached_property
    def nodes(self) -> int:
        """Nodes of all wires."""
        return int(self.mesh.first_nodes[-1])

    @cached_property
    def dof(self) -> Integers:
        """Shape (nodes,): number of each node's displacement."""
        mesh, dof = self.mesh, np.arange(self.nodes)
        for i, ends in enumerate(mesh.stitch_ends):
            number = mesh.first_stitch + i
            own = mesh.first_nodes[number] + np.array([0, mesh.wires[number].x.size - 1])
            dof[own] = mesh.first_nodes[mesh.contact_wires] + ends
        return dof

    @cached_property
    def x(self) -> Floats:
        """[m], shape (nodes,), along the track."""
        return np.concatenate([wire.x for wire in self.mesh.wires])

    @cached_property
    def wire_of(self) -> Integers:
        """Shape (elements,): number of each element's wire."""
        return np.repeat(np.arange(len(self.mesh.wires)), [w.x.size - 1 for w in self.mesh.wires])

    def name_of(self, element: int) -> str:
        """The wire that an element belongs to, in words."""
        return self.mesh.wire_name(int(self.wire_of[element]))

    @cached_property
    def left(self) -> Integers:
        """Shape (elements,): number of each element's first node; the second one follows it."""
        return np.arange(self.wire_of.size) + self.wire_of

    @cached_property
    def length(self) -> Floats:
        """[m], shape (elements,), along the track."""
        return self.x[self.left + 1] - self.x[self.left]

    @cached_property
    def tension(self) -> Floats:
        """[N], shape (elements,), along the track."""
        return np.concatenate(element_pulls(self.catenary, self.mesh))

    def of_wire(self, name: str) -> Floats:
        """Shape (elements,): a parameter of each element's wire."""
        return element_values(self.catenary, self.mesh, name)

    @cached_property
    def weight(self) -> Floats:
        """[kg/m], shape (elements,), of the wires."""
        return self.of_wire("mass_per_length")

    @cached_property
    def axial_stiffness(self) -> Floats:
        """[N], shape (elements,)."""
        return self.of_wire("axial_stiffness")

    @cached_property
    def nominal_tension(self) -> Floats:
        """[N], shape (elements,), along the wires."""
        return self.of_wire("tension")

    @cached_property
    def curve_pulls(self) -> Floats:
        """[N/kg], shape (elements,), to the left, by the elements' masses."""
        return np.concatenate(curve_pulls(self.catenary, self.mesh))

    @cached_property
    def bending_stiffness(self) -> Floats:
        """[N m²], shape (elements,)."""
        return self.of_wire("bending_stiffness")

    @cached_property
    def index(self) -> Integers:
        """Shape (elements, 4): numbers of displacement and slope at the first node, then at the second."""
        a, b = self.left, self.left + 1
        return np.stack([self.dof[a], self.nodes + a, self.dof[b], self.nodes + b], axis=1)

    @cached_property
    def stiffness(self) -> Any:
        """Sparse, shape (2 * nodes, 2 * nodes)."""
        blocks = exact_stiffness(self.tension, self.bending_stiffness, self.length)
        return scattered([(self.index, blocks)], 2 * self.nodes)

    def load(self, per_length: Floats) -> Floats:
        """Shape (2 * nodes,): of a load [N/m] on each element, shape (elements,)."""
        values = exact_load(self.tension, self.bending_stiffness, self.length) * per_length[:, None]
        summed = np.bincount(self.index.ravel(), values.ravel(), minlength=2 * self.nodes)
        return np.asarray(summed, dtype=float)

    @cached_property
    def idle(self) -> NDArray[np.bool_]:
        """Shape (2 * nodes,): unknowns that no element has."""
        return np.asarray(self.stiffness.diagonal() == 0)

    @cached_property
    def order(self) -> Integers:
        """Shape (2 * nodes,): numbers of the unknowns along the track, in which matrices are narrow."""
        return np.argsort(np.tile(self.x, 2), kind="stable")

    def problem(self, held: Mapping[int, float], springs: Any = None) -> TautProblem:
        """The wires held at some displacements [m] by their number, with springs in a sparse matrix [N/m]."""
        K = self.stiffness if springs is None else (self.stiffness + springs).tocsr()
        return TautProblem(
            K, np.array(list(held), dtype=np.int64), np.array(list(held.values())), self.idle, self.order
        )

    def slopes(self, found: Floats, per_length: Floats) -> Floats:
        """Shape (nodes,): slopes under a load [N/m]; where a string kinks, the mean of both sides.

        found : shape (2 * nodes,)
        """
        a, b, h = self.left, self.left + 1, self.length
        chord = (found[self.dof[b]] - found[self.dof[a]]) / h
        bow = per_length * h / (2 * self.tension)
        total, count = np.zeros(self.nodes), np.zeros(self.nodes)
        for node, slope in ((a, chord + bow), (b, chord - bow)):
            total += np.bincount(node, slope, minlength=self.nodes)
            count += np.bincount(node, minlength=self.nodes)
        return np.where(self.idle[self.nodes :], total / count, found[self.nodes :])


class TautProblem:
    """A factorised linear problem of :class:`TautWires`.

    reactions of a solution are the forces that hold what is held.
    """

    def __init__(
        self, stiffness: Any, held: Integers, values: Floats, idle: NDArray[np.bool_], order: Integers
    ) -> None:
        from scipy.sparse.linalg import splu

        self._stiffness, self._held, self._values = stiffness, held, values
        free = ~idle
        free[held] = False
        self._free = order[free[order]]
        inner = stiffness[self._free][:, self._free].tocsc()
        self._factor = splu(
            inner, permc_spec="NATURAL", diag_pivot_thresh=0.0, options={"SymmetricMode": True}
        )

    def solve(self, force: Floats) -> tuple[Floats, Floats]:
        """Displacements and slopes, and reactions [N], under forces [N]; all of shape (2 * nodes,)."""
        found = np.zeros(force.size)
        found[self._held] = self._values
        found[self._free] = self._factor.solve((force - self._stiffness @ found)[self._free])
        reactions = np.zeros(force.size)
        reactions[self._held] = (self._stiffness @ found - force)[self._held]
        return found, reactions


_ITERATIONS = 40
_NEAR = 1e-4  # turn of a slope, after which the tangent hardly changes
_ENOUGH = 1e-6  # which the balance takes up: 17 N of EA ε
_SMALL = 1e-6  # change of lengths that derivatives are taken by
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
    """Slopes, shape (nodes, axes), and element lengths [m] in balance, by Newton's method.

    An element's length follows from its tension: what a turn of its ends does to that, the length undoes.
    """
    from scipy.linalg import solve_banded

    axes, left = points.shape[1], wires.left
    slopes = np.concatenate([line.slopes for line in lines])
    lengths = np.concatenate([line.lengths for line in lines])
    EA, T = wires.axial_stiffness, wires.nominal_tension
    pull = np.zeros((left.size, axes))  # [N/kg]
    pull[:, -1] = -GRAVITY
    if axes == 3:
        pull[:, 1] = wires.curve_pulls
    index = (left[:, None] * axes + np.arange(2 * axes)).astype(np.int64)
    of_slopes = np.concatenate([axes + np.arange(axes), 3 * axes + np.arange(axes)])

    def left_over(values: Floats, lengths: Floats) -> tuple[Cables, Floats, Floats]:
        """The elements, moments at their ends, and what they pull too much [N]."""
        cables = Cables(lengths, EA, wires.bending_stiffness, -T / EA)
        inner = inner_forces(cables, values)
        moment = (wires.weight * lengths**2 / 12)[:, None] * pull
        moments = np.concatenate([moment - inner[:, 1], -moment - inner[:, 3]], axis=1)
        return cables, moments, inner[:, 2, 0] - wires.tension

    turn = np.array(np.inf)
    for _ in range(_ITERATIONS):
        values = np.stack([points[left], slopes[left], points[left + 1], slopes[left + 1]], axis=1)
        cables, moments, excess = left_over(values, lengths)
        if np.abs(turn).max() > _NEAR:
            blocks = tangent_blocks(cables, values, definite=True)
            _, longer_moments, longer_excess = left_over(values, lengths * (1 + _SMALL))
            by_turn = blocks[:, 2 * axes, of_slopes]
            by_length = (longer_excess - excess) / _SMALL
            by_excess = (longer_moments - moments) / _SMALL / by_length[:, None]
            coupled = blocks[:, of_slopes[:, None], of_slopes] + by_excess[:, :, None] * by_turn[:, None]
            bands = _banded(index, coupled, slopes.size)
        out = np.bincount(index.ravel(), (moments - by_excess * excess[:, None]).ravel(), slopes.size)
        turn = solve_banded((2 * axes - 1, 2 * axes - 1), bands, out)
        longer = -(excess + (by_turn * turn[index]).sum(axis=1)) / by_length
        slopes, lengths = slopes + turn.reshape(slopes.shape), lengths * (1 + longer)
        if max(np.abs(turn).max(), np.abs(longer).max()) < _SETTLED:
            return slopes, lengths
    if not np.abs(longer).max() < _ENOUGH:
        worst = int(np.nan_to_num(np.abs(longer), nan=np.inf).argmax())
        raise SolverError(
            f"form finding: the {wires.name_of(worst)} finds no balance at {wires.x[left[worst]]:.1f} m along"
            " the line; look there for clamps that are very close, little tension and sharp kinks"
        )
    return slopes, lengths


def _banded(index: Integers, blocks: Floats, size: int) -> Floats:
    """A matrix of blocks, shape (elements, m, m), as scipy has banded ones.

    index : shape (elements, m), numbers of the rows, which follow one another
    """
    width = index.shape[1]
    row, column = np.indices((width, width))
    bands = np.zeros((2 * width - 1, size))
    np.add.at(bands, (width - 1 + row - column, index[:, column]), blocks)
    return bands
