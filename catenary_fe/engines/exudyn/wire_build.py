"""One wire, its ends, supports and what it carries, as an Exudyn system."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.linearise import mass_matrix, stiffness_matrix
from catenary_fe.engines.exudyn.solver import new_system, solve_static
from catenary_fe.engines.exudyn.wire import (
    ALONG,
    WireItems,
    add_ground_coordinate,
    add_wire,
    anchor_and_tension,
    hold,
)
from catenary_fe.fe.cable import hermite
from catenary_fe.fe.installation import WireLine
from catenary_fe.fe.wire_problem import Function, WireProblem
from catenary_fe.layout import GRAVITY, InputError
from catenary_fe.layout.arguments import numbers
from catenary_fe.theory import MovingForce

Floats = NDArray[np.float64]
UP, COORDINATES = 1, 4  # the plane's
_DIFFERENCE = 1e-4  # [m] for slopes of the initial functions


@dataclass(frozen=True)
class WireSystem:
    """A system of one wire, assembled.

    mbs, wire, ground : the system, its wire and a coordinate marker that never moves
    height : [m] of the wire where it is not deflected
    mass : sparse, [kg] what the wire carries
    stiffness : sparse, [N/m] of foundation and springs
    """

    mbs: Any
    wire: WireItems
    ground: int
    height: float
    mass: Any
    stiffness: Any

    @property
    def part(self) -> slice:
        """The wire's coordinates among all of the system."""
        return _part(self.mbs, self.wire)

    def deflection(self) -> Floats:
        """[m] shape (nodes,), at the current state."""
        q = self.mbs.systemData.GetODE2Coordinates()[self.part]
        deflection: Floats = self.wire.line.z - self.height + q[UP::COORDINATES]
        return deflection

    def velocity(self) -> Floats:
        """[m/s] shape (nodes,), upwards, at the current state."""
        velocity: Floats = self.mbs.systemData.GetODE2Coordinates_t()[self.part][UP::COORDINATES]
        return velocity

    def carried_energy(self) -> float:
        """[J] in foundation and springs at the current state, above a zero that the meter knows."""
        q = self.mbs.systemData.GetODE2Coordinates()[self.part]
        return float(0.5 * q @ (self.stiffness @ q))


def build_wire(problem: WireProblem, mbs: Any = None, height: float = 0.0) -> WireSystem:
    """Build all but the moving loads and the initial velocity.

    mbs : the system to build in; unset: a new one
    height : [m] of the wire where it is not deflected
    """
    mbs = mbs or new_system()
    items = add_wire(mbs, problem.wire, _initial_line(problem, height))
    ground = add_ground_coordinate(mbs)
    _hold(mbs, items, ground, problem)
    mass, stiffness = _add_carried(mbs, items, problem, height)
    mbs.Assemble()
    return WireSystem(mbs, items, ground, height, mass, stiffness)


def set_initial_velocity(system: WireSystem, problem: WireProblem) -> None:
    """Set the initial velocity of a system that has all its parts."""
    if problem.initial_velocity is None:
        return
    data = system.mbs.systemData
    v = data.GetODE2Coordinates_t(configuration=exu.ConfigurationType.Initial)
    rate, slope_rate = _values_and_slopes(problem.initial_velocity, system.wire.line.x, "initial_velocity")
    of_wire = v[system.part].reshape(-1, COORDINATES)
    of_wire[:, UP], of_wire[:, UP + 2] = rate, slope_rate
    v[system.part] = of_wire.ravel()
    for configuration in (exu.ConfigurationType.Initial, exu.ConfigurationType.Current):
        data.SetODE2Coordinates_t(v, configuration=configuration)


def wire_at_rest(problem: WireProblem) -> Floats:
    """[m] shape (nodes,), static deflection under the moving forces where they start, and the weight.

    Raises InputError for other loads, SolverError if there is no equilibrium.
    """
    system = build_wire(problem)
    forces = np.zeros(COORDINATES * len(system.wire.nodes))
    line = system.wire.line
    for load in problem.loads:
        if not isinstance(load, MovingForce):
            raise InputError(f"{type(load).__name__}: a wire at rest takes forces known in advance only")
        e = min(max(int(np.searchsorted(line.x, load.start, side="right")) - 1, 0), line.x.size - 2)
        h = line.x[e + 1] - line.x[e]
        index = COORDINATES * e + np.array([UP, UP + 2, COORDINATES + UP, COORDINATES + UP + 2])
        forces[index] += load.contact_force(0.0, 0.0) * hermite((load.start - line.x[e]) / h, h)
    system.mbs.AddObject(eii.ObjectGenericODE2(nodeNumbers=system.wire.nodes, forceVector=forces))
    system.mbs.Assemble()
    solve_static(system.mbs, what="wire at rest")
    return system.deflection()


def vertical_matrices(problem: WireProblem) -> tuple[Any, Any]:
    """Sparse stiffness and mass matrix of small vertical motions, held nodes taken out."""
    system = build_wire(problem)
    K = stiffness_matrix(system.mbs, [system.wire]) + system.stiffness
    M = mass_matrix(system.mbs, [system.wire]) + system.mass
    held = [COORDINATES * node + UP for node in _held_nodes(problem)]
    vertical = [COORDINATES * i + j for i in range(len(system.wire.nodes)) for j in (UP, UP + 2)]
    free = np.array(sorted(set(vertical) - set(held)))
    return K[free][:, free], M[free][:, free]


def _held_nodes(problem: WireProblem) -> list[int]:
    return sorted({0, len(problem.x) - 1, *(problem.node(s) for s in problem.supports)})


def _part(mbs: exu.MainSystem, items: WireItems) -> slice:
    first = int(mbs.systemData.GetNodeLTGODE2(items.nodes[0])[0])
    return slice(first, first + COORDINATES * len(items.nodes))


def _initial_line(problem: WireProblem, height: float) -> WireLine:
    x = np.asarray(problem.x, dtype=float)
    deflection, slope = np.zeros(x.size), np.zeros(x.size)
    if problem.initial_deflection is not None:
        deflection, slope = _values_and_slopes(problem.initial_deflection, x, "initial_deflection")
    return WireLine.through(problem.wire, np.column_stack([x, height + deflection]), slope[:, None])


def _values_and_slopes(function: Function, x: Floats, name: str) -> tuple[Floats, Floats]:
    """Raises InputError where the function does not give one finite value a position."""
    before, values, after = (
        numbers(f"{name}(x)", function(at), shape=x.shape, each="one value a position")
        for at in (x - _DIFFERENCE, x, x + _DIFFERENCE)
    )
    return values, (after - before) / (2 * _DIFFERENCE)


def _hold(mbs: exu.MainSystem, items: WireItems, ground: int, problem: WireProblem) -> None:
    if problem.tensioned:
        anchor_and_tension(mbs, items, ground, problem.wire)
    else:
        for node in (0, len(items.nodes) - 1):
            hold(mbs, items, node, ALONG, ground)
    for node in _held_nodes(problem):
        hold(mbs, items, node, UP, ground)


def _add_carried(
    mbs: exu.MainSystem, items: WireItems, problem: WireProblem, height: float
) -> tuple[Any, Any]:
    """Point masses, foundation, springs, dampers and weight as one object; returns its M and K.

    The foundation's matrix is k/ρ times the vertical part of the wire's mass matrix.
    """
    from scipy.sparse import csr_matrix, diags

    mbs.Assemble()
    part = _part(mbs, items)
    wire_mass = mass_matrix(mbs, [items])[part, part]
    up = np.tile(np.eye(COORDINATES)[UP], len(items.nodes))
    slope_up = np.roll(up, 2)
    vertical = diags(up + slope_up)
    M = diags(_at_nodes(problem, problem.masses, [1.0, 1.0, 0.0, 0.0]))
    D = diags(_at_nodes(problem, problem.dampers, [0.0, 1.0, 0.0, 0.0]))
    K = diags(_at_nodes(problem, problem.springs, [0.0, 1.0, 0.0, 0.0]))
    bedding = problem.foundation_stiffness / problem.wire.mass_per_length
    K = csr_matrix(K + bedding * (vertical @ wire_mass @ vertical))
    # the springs are force-free on the undeflected wire, not where it starts
    force = -K @ ((items.line.coordinates().ravel() - height * up) * (up + slope_up))
    if problem.weight:
        force = force - GRAVITY * (wire_mass + M) @ up
    nothing = exu.MatrixContainer(csr_matrix(([0.0], ([0], [0])), shape=K.shape))
    mbs.AddObject(
        eii.ObjectGenericODE2(
            nodeNumbers=items.nodes,
            massMatrix=exu.MatrixContainer(csr_matrix(M)),
            stiffnessMatrix=exu.MatrixContainer(K),
            dampingMatrix=exu.MatrixContainer(csr_matrix(D)),
            forceVector=force,
            # as in add_overlay: keeps Exudyn from differentiating the object numerically
            jacobianUserFunction=lambda *_: nothing,
        )
    )
    return M, K


def _at_nodes(problem: WireProblem, values: Any, axes: list[float]) -> Floats:
    """Shape (coordinates,): values by position put on the coordinates of their nodes."""
    at = np.zeros((len(problem.x), COORDINATES))
    for position, value in values.items():
        at[problem.node(position)] += value * np.array(axes)
    return at.ravel()
