"""Single wires, alone or in pairs, as assembled systems: the models behind the paper's figures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import Cables, mass_blocks, scattered
from catenary_fe.fe.contact import BaseLine
from catenary_fe.fe.installation import WireLine
from catenary_fe.fe.spring import FIXED, Springs
from catenary_fe.fe.system import System, WireNodes
from catenary_fe.fe.wire_problem import Function, WirePair, WireProblem
from catenary_fe.layout import GRAVITY
from catenary_fe.layout.arguments import numbers

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
UP, AXES, WIDTH = 1, 2, 4  # the plane's
_DIFFERENCE = 1e-4  # [m] for slopes of the initial functions


@dataclass(frozen=True)
class _Part:
    """One wire of a system: its problem, its height [m] where it is not deflected, and its first node."""

    problem: WireProblem
    height: float
    first: int

    @property
    def x(self) -> Floats:
        return np.asarray(self.problem.x, dtype=float)

    def at(self, position: float, axis: int) -> int:
        """Number of a coordinate at a node's position [m]."""
        return WIDTH * (self.first + self.problem.node(position)) + axis

    def line(self) -> WireLine:
        """Where the wire is let go."""
        deflection, slope = values_and_slopes(self.problem.initial_deflection, self.x, "initial_deflection")
        points = np.column_stack([self.x, self.height + deflection])
        return WireLine.through(self.problem.wire, points, slope[:, None])

    def held(self) -> list[int]:
        """Numbers of the coordinates that are held."""
        ends = [self.x[0], self.x[-1]]
        along = ends[:1] if self.problem.tensioned else ends
        up = [*ends, *np.atleast_1d(self.problem.supports)]
        return [*(self.at(x, 0) for x in along), *(self.at(x, UP) for x in up)]

    def clamps(self) -> Integers:
        problem = self.problem
        places = [*problem.supports, *problem.masses, *problem.springs, *problem.dampers]
        nodes = [0, self.x.size - 1, *(problem.node(x) for x in places)]
        return np.unique(np.array(nodes, dtype=np.int64))


def wire_system(problem: WireProblem) -> System:
    """A single wire where it is let go, without its moving loads."""
    return _assemble([_Part(problem, 0.0, 0)], None)


def pair_system(pair: WirePair) -> System:
    """Two wires, the lower one first, and the dropper between them."""
    lower = _Part(pair.lower, 0.0, 0)
    return _assemble([lower, _Part(pair.upper, pair.height, lower.x.size)], pair)


def values_and_slopes(function: Function | None, x: Floats, name: str) -> tuple[Floats, Floats]:
    """A function of positions, and its slopes, at the nodes; 0 without one.

    Raises InputError where the function does not give one finite value a position.
    """
    if function is None:
        return np.zeros(x.size), np.zeros(x.size)
    before, values, after = (
        numbers(f"{name}(x)", function(at), shape=x.shape, each="one value a position")
        for at in (x - _DIFFERENCE, x, x + _DIFFERENCE)
    )
    return values, (after - before) / (2 * _DIFFERENCE)


def initial_velocity(problem: WireProblem, first: int, size: int) -> Floats:
    """[m/s], shape (all,), of a wire whose first node has this number, in a system of this size."""
    x = np.asarray(problem.x, dtype=float)
    rate, slope = values_and_slopes(problem.initial_velocity, x, "initial_velocity")
    v = np.zeros(size)
    nodes = WIDTH * (first + np.arange(x.size))
    v[nodes + UP], v[nodes + UP + AXES] = rate, slope
    return v


def _assemble(parts: Sequence[_Part], pair: WirePair | None) -> System:
    from scipy.sparse import csr_matrix, diags

    lines = [part.line() for part in parts]
    size = WIDTH * sum(part.x.size for part in parts)
    first = np.concatenate([WIDTH * (part.first + np.arange(part.x.size - 1)) for part in parts])
    reference = np.concatenate([line.coordinates().ravel() for line in lines])

    def of_wires(name: str) -> Floats:
        each = [np.full(part.x.size - 1, float(getattr(part.problem.wire, name))) for part in parts]
        return np.concatenate(each)

    lengths, per_length = np.concatenate([line.lengths for line in lines]), of_wires("mass_per_length")
    blocks, index = mass_blocks(lengths, per_length, AXES), first[:, None] + np.arange(2 * WIDTH)
    wire_mass = scattered([(index, blocks)], size)
    point_mass, springs, dampers = (_at_nodes(parts, name, size) for name in ("masses", "springs", "dampers"))
    mass = (wire_mass + diags(point_mass + np.roll(point_mass, -1))).tocsr()
    foundation = _foundation(parts, blocks, per_length, index, size)
    up = (np.arange(size) % WIDTH == UP).astype(float)
    weighs = np.concatenate([np.full(WIDTH * p.x.size, float(p.problem.weight)) for p in parts])
    undeflected = np.concatenate(
        [np.column_stack([p.x, 0 * p.x + p.height, 0 * p.x + 1, 0 * p.x]).ravel() for p in parts]
    )
    # the springs are force-free on the undeflected wire, not where it starts
    force = -(foundation + diags(springs)) @ (reference - undeflected) - GRAVITY * weighs * (mass @ up)
    for part in parts:
        if part.problem.tensioned:
            force[part.at(part.x[-1], 0)] += part.problem.wire.tension
    if pair is not None:
        for part, sign in zip(parts, (-1.0, 1.0), strict=True):
            force[part.at(pair.position, UP)] += sign * pair.preload
    EA = of_wires("axial_stiffness")
    return System(
        axes=AXES,
        reference=reference,
        dof=_dof(parts, size),
        first=first,
        cables=Cables(lengths, EA, of_wires("bending_stiffness"), -of_wires("tension") / EA),
        mass_per_length=per_length,
        element_mass=blocks,
        wire_mass=wire_mass,
        mass=mass,
        droppers=_dropper(parts, pair),
        arms=_springs(0, pulls_only=False),
        ground_stiffness=springs,
        ground_damping=dampers,
        linear_stiffness=foundation,
        linear_damping=csr_matrix((size, size)),
        force=force,
        alpha=0.0,
        beta=0.0,
        wires=tuple(_nodes(part, number, pair) for number, part in enumerate(parts)),
        contact_wire_height=0.0,
        base_line=BaseLine(np.zeros(1), np.zeros(1)),
    )


def _dof(parts: Sequence[_Part], size: int) -> Integers:
    """Numbers of the free coordinates in the order of their stations."""
    moves = np.setdiff1d(np.arange(size), [i for part in parts for i in part.held()])
    station = np.concatenate([np.repeat(part.x, WIDTH) for part in parts])
    dof = np.full(size, FIXED, dtype=np.int64)
    dof[moves[np.argsort(station[moves], kind="stable")]] = np.arange(moves.size)
    return dof


def _nodes(part: _Part, number: int, pair: WirePair | None) -> WireNodes:
    clamps = part.clamps()
    if pair is not None:
        clamps = np.union1d(clamps, [part.problem.node(pair.position)])
    return WireNodes(
        name=("wire", "upper wire")[number],
        first=part.first,
        x=part.x,
        contact=number == 0,
        supports=np.array([0, part.x.size - 1]),
        clamps=clamps,
        tension=np.full(part.x.size - 1, part.problem.wire.tension),
    )


def _foundation(
    parts: Sequence[_Part], blocks: Floats, per_length: Floats, index: Integers, size: int
) -> Any:
    """k/ρ times the vertical part of the wires' mass matrix."""
    from scipy.sparse import diags

    bedding = np.concatenate([np.full(p.x.size - 1, p.problem.foundation_stiffness) for p in parts])
    matrix = scattered([(index, blocks * (bedding / per_length)[:, None, None])], size)
    vertical = diags((np.arange(size) % AXES == UP).astype(float))
    return (vertical @ matrix @ vertical).tocsr()


def _at_nodes(parts: Sequence[_Part], name: str, size: int) -> Floats:
    """Shape (all,): values by position put on the heights of their nodes."""
    values = np.zeros(size)
    for part in parts:
        for position, value in getattr(part.problem, name).items():
            values[part.at(position, UP)] += value
    return values


def _dropper(parts: Sequence[_Part], pair: WirePair | None) -> Springs:
    if pair is None:
        return _springs(0, pulls_only=True)
    found = _springs(1, pulls_only=True)
    found.first[0], found.last[0] = (part.at(pair.position, 0) for part in parts)
    found.length[0] = pair.height - pair.preload / pair.stiffness
    found.stiffness[0], found.damping[0] = pair.stiffness, pair.damping
    return found


def _springs(count: int, *, pulls_only: bool) -> Springs:
    none, nowhere = np.zeros(count), np.zeros(count, dtype=np.int64)
    return Springs(
        nowhere, nowhere.copy(), np.zeros((count, AXES)), none, none.copy(), none.copy(), pulls_only
    )
