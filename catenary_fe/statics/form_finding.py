"""All wires of a line in static equilibrium, their droppers cut at design heights or of given lengths."""

from __future__ import annotations

from functools import cached_property
from math import tan
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.assembly import balanced
from catenary_fe.fe.cable import scattered
from catenary_fe.fe.equipment import lumped
from catenary_fe.fe.installation import Installation, point_masses
from catenary_fe.fe.mesh import MeshSettings, make_mesh
from catenary_fe.fe.spring import spring_blocks
from catenary_fe.fe.track import cant_forces, leaning_weights
from catenary_fe.layout import GRAVITY, Catenary, SolverError, SteadyArm
from catenary_fe.layout.as_built import set_heights
from catenary_fe.layout.rules import dropper_names
from catenary_fe.statics.as_set import mast_springs
from catenary_fe.statics.rules import check_arms
from catenary_fe.statics.shape import HangingWire, Shape
from catenary_fe.statics.taut_wires import TautProblem, TautWires, installed_lines

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Fixed = dict[int, float]

_LEAST_STEP = 1e-6  # of a Newton step: below it no step lowers the energy any more


class WireSubstructures:
    """All wires of a catenary and what is known of them so far.

    found : [m], shape (axes - 1, 2 * nodes), per axis across the track the nodes' places, then their slopes;
        heights are the last
    pull : [N], shape (droppers,), of each dropper on its contact wire, upwards
    reactions : [N], shape (axes - 1, 2 * nodes), forces of masts on the wires
    """

    def __init__(self, catenary: Catenary, settings: MeshSettings, as_set: Shape | None = None) -> None:
        """as_set : the line when arms and supports were set, which now give; unset: they are set here"""
        self.catenary, self.settings = catenary, settings
        self.mesh = make_mesh(catenary, settings)
        self.wires = TautWires(catenary, self.mesh)
        self.axes = 3 if catenary.is_spatial else 2
        self.masts = mast_springs(catenary, self.wires, as_set) if as_set else None
        droppers = catenary.droppers
        self.stiffness = np.array([d.stiffness for d in droppers], dtype=float)
        self.found = np.zeros((self.axes - 1, 2 * self.wires.nodes))
        self.pull, self._half_weight = np.zeros(len(droppers)), np.zeros(len(droppers))
        self._lengths = np.zeros(len(droppers))
        self._lower = self.wires.dof[self.mesh.nodes(self.mesh.lower)]
        self._upper = self.wires.dof[self.mesh.nodes(self.mesh.upper)]
        self._shift = catenary.lower_clamp_positions - catenary.dropper_positions
        self.reactions = np.zeros_like(self.found)
        if self.axes == 3:
            guess = -catenary.lateral_pulls / self.mesh.contact_wires
            for _, i, at, _ in self._arms():
                self.reactions[0, at] = guess[i]

    # what acts

    def set_dropper_weights(self, lengths: Floats) -> None:
        """Lengths [m] of the droppers, of which their weight comes."""
        per_length = np.array([d.mass_per_length for d in self.catenary.droppers])
        self._half_weight, self._lengths = GRAVITY * per_length * lengths / 2, lengths

    def _clamps(self, which: str) -> Floats:
        """[N], shape (droppers,): weight at one end of the droppers."""
        masses = np.array([getattr(d, which) for d in self.catenary.droppers], dtype=float)
        return GRAVITY * masses + self._half_weight

    def _length_ratio(self) -> Floats:
        """Shape (elements,): length of wire, under its nominal tension, over that along the track."""
        wires = self.wires
        rise = self.found[:, wires.dof[wires.left + 1]] - self.found[:, wires.dof[wires.left]]
        arc = np.sqrt(1 + ((rise / wires.length) ** 2).sum(axis=0))
        stretch = 1 + (arc * wires.tension - wires.nominal_tension) / wires.axial_stiffness
        ratio: Floats = arc / stretch
        return ratio

    def _distributed_loads(self) -> Floats:
        """[N/m], shape (axes - 1, elements): weight, and in curves the pull to their inside."""
        weight = self.wires.weight * self._length_ratio()
        loads = -GRAVITY * weight[None]
        if self.axes == 3:
            loads = np.stack([self.wires.curve_pulls * weight, loads[0]])
        return loads

    def _arms(self) -> list[tuple[int, int, int, SteadyArm]]:
        """Contact wire, support, displacement and arm of every steady arm between the line's ends."""
        return [
            (wire, i, self._at_support(wire, i), support.steady_arm)
            for i, support in list(enumerate(self.catenary.supports))[1:-1]
            if support.steady_arm
            for wire in range(self.mesh.contact_wires)
        ]

    def _at_support(self, wire: int, support: int) -> int:
        node = self.mesh.first_nodes[wire] + self.mesh.wires[wire].supports[support]
        return int(self.wires.dof[node])

    def _lift(self, at: int, arm: SteadyArm) -> float:
        """[N] upward, of a bar of given inclination under the lateral force that it has."""
        return abs(float(self.reactions[0, at])) * tan(arm.inclination or 0.0)

    def _vertical_loads(self) -> Floats:
        """[N], shape (2 * nodes,), of the wires, what they carry at masts and stitch wires' clamps."""
        force = self.wires.load(self._distributed_loads()[-1])
        for _, i, at, arm in self._arms():
            force[at] -= GRAVITY * arm.hanging_mass
            if self.masts:
                continue
            if arm.stiffness is not None and not arm.holds_height:
                force[at] += arm.preload + arm.stiffness * self.catenary.contact_wire_heights[i]
            elif not arm.holds_height:
                force[at] += self._lift(at, arm)
        if self.masts:
            force[self.masts.at] += self.masts.force + self.masts.stiffness * self.masts.height
        nodes, masses = lumped(self.catenary, self.mesh)
        np.add.at(force, self.wires.dof[nodes], -GRAVITY * masses)
        if self.catenary.stitch_wire:
            clamps = self.mesh.first_nodes[self.mesh.contact_wires] + self.mesh.stitch_ends.ravel()
            np.add.at(force, clamps, -GRAVITY * self.catenary.stitch_wire.clamp_mass)
        return force

    def _lateral_loads(self) -> Floats:
        """[N], shape (2 * nodes,), to the left: of curves and cant on the wires and what they carry."""
        mesh, catenary = self.mesh, self.catenary
        force = self.wires.load(self._distributed_loads()[0])
        masses = point_masses(catenary, mesh, self._lengths)[1]
        at_nodes = cant_forces(catenary, mesh) + leaning_weights(catenary, mesh, masses)
        np.add.at(force, self.wires.dof, at_nodes)
        return force

    # what holds

    def _fixed_heights(self) -> Fixed:
        """Heights [m] that masts hold, by displacement."""
        catenary, heights = self.catenary, self.catenary.contact_wire_heights.tolist()
        held: Fixed = {}
        last = len(catenary.supports) - 1
        for wire in range(self.mesh.contact_wires):
            held |= {self._at_support(wire, i): heights[i] for i in (0, last)}
        held |= {at: heights[i] for _, i, at, arm in self._arms() if arm.holds_height}
        if self.mesh.messenger:
            for i, height in enumerate(catenary.messenger_support_heights.tolist()):
                held[self._at_support(self.mesh.contact_wires, i)] = height
        given_way = set(self.masts.at.tolist()) if self.masts else set()
        return {at: height for at, height in held.items() if at not in given_way}

    def _fixed_lateral(self) -> Fixed:
        """Lateral positions [m] that masts hold, by displacement."""
        catenary, held, last = self.catenary, {}, len(self.catenary.supports) - 1
        for i, support in enumerate(catenary.supports):
            if self.mesh.messenger:
                held[self._at_support(self.mesh.contact_wires, i)] = float(catenary.messenger_staggers[i])
            if not (support.steady_arm or i in (0, last)):
                continue
            for wire, offset in enumerate(catenary.contact_wire_offsets):
                held[self._at_support(wire, i)] = float(catenary.staggers[i]) + offset
        return held

    @cached_property
    def _arm_springs(self) -> Any:
        """Sparse stiffness [N/m] of arms that do not hold the contact wire's height."""
        from scipy.sparse import diags

        springs = np.zeros(2 * self.wires.nodes)
        if self.masts:
            springs[self.masts.at] = self.masts.stiffness
            return diags(springs).tocsr()
        for _, _, at, arm in self._arms():
            springs[at] = 0.0 if arm.holds_height else arm.stiffness or 0.0
        return diags(springs).tocsr()

    @cached_property
    def _heights(self) -> TautProblem:
        """The wires with their droppers cut, the contact wires held where the droppers were."""
        held = dict(zip(self._lower.tolist(), set_heights(self.catenary).tolist(), strict=True))
        return self.wires.problem(held | self._fixed_heights(), self._arm_springs)

    # equilibrium

    def solve_cut_wires(self) -> None:
        """Hang all wires once more, droppers at their design heights, with what is known from before.

        First the contact wires, whose droppers' pull then loads the wires above them.
        """
        force = self._vertical_loads()
        _, reactions = self._heights.solve(force)
        self.pull = reactions[self._lower] + self._clamps("contact_wire_clamp_mass")
        np.add.at(force, self._upper, -np.maximum(self.pull, 0.0) - self._clamps("messenger_clamp_mass"))
        self.found[-1], self.reactions[-1] = self._heights.solve(force)
        if self.axes == 3:
            self._solve_lateral()

    def _solve_lateral(self) -> None:
        """Lateral positions of the wires, the droppers leaning between them."""
        righting = np.maximum(self.pull, 0.0) / np.maximum(self.spread()[:, -1], 1e-3)
        index = np.stack([self._lower, self._upper], axis=1)
        blocks = righting[:, None, None] * np.array([[1.0, -1.0], [-1.0, 1.0]])
        leaning = scattered([(index, blocks)], 2 * self.wires.nodes)
        problem = self.wires.problem(self._fixed_lateral(), leaning)
        self.found[0], self.reactions[0] = problem.solve(self._lateral_loads())

    def solve_on_droppers(self, lengths: Floats) -> None:
        """One step towards where droppers of given lengths [m], shape (droppers,), make the wires hang.

        A Newton step on the stored energy, which is convex: shortened where it would raise it.
        """
        if self.masts:
            self.masts = self.masts.turned(self.found, self.reactions)
            self.__dict__.pop("_arm_springs", None)
        force = np.zeros_like(self.found)
        if self.axes == 3:
            force[0] = self._lateral_loads()
        force[-1] = self._vertical_loads()
        np.add.at(force[-1], self._lower, -self._clamps("contact_wire_clamp_mass"))
        np.add.at(force[-1], self._upper, -self._clamps("messenger_clamp_mass"))
        step = self._newton_step(force, lengths)
        before, share = self._energy(self.found, force, lengths), 1.0
        slope = -float((self._residual(self.found, force, lengths) * step).sum())
        while (
            self._energy(self.found + share * step, force, lengths)
            > before + 1e-4 * share * slope + 1e-12 * abs(before)
            and share > _LEAST_STEP
        ):
            share /= 2
        self.found = self.found + share * step
        span = self.spread()
        now = np.linalg.norm(span, axis=1)
        self.pull = self.tensions(lengths) * span[:, -1] / now
        self.reactions = -self._residual(self.found, force, lengths)

    def _residual(self, found: Floats, force: Floats, lengths: Floats) -> Floats:
        """[N], shape (axes - 1, 2 * nodes), out of balance before the reactions at fixed coordinates."""
        residual = np.stack([f - self.wires.stiffness @ u for f, u in zip(force, found, strict=True)])
        residual[-1] -= self._arm_springs @ found[-1]
        span = self.spread(found)
        pull = (self.tensions(lengths, span) / np.linalg.norm(span, axis=1))[:, None] * span
        for k in range(self.axes - 1):
            np.add.at(residual[k], self._lower, pull[:, k + 1])
            np.add.at(residual[k], self._upper, -pull[:, k + 1])
        return residual

    def _energy(self, found: Floats, force: Floats, lengths: Floats) -> float:
        """[J] in wires, arms and droppers, with the potential of the loads."""
        bent = sum(float(u @ (self.wires.stiffness @ u)) for u in found)
        bent += float(found[-1] @ (self._arm_springs @ found[-1]))
        droppers = float((self.tensions(lengths, self.spread(found)) ** 2 / self.stiffness).sum())
        return (bent + droppers) / 2 - float((force * found).sum())

    def _newton_step(self, force: Floats, lengths: Floats) -> Floats:
        from scipy.sparse import block_diag
        from scipy.sparse.linalg import splu

        size = 2 * self.wires.nodes
        K = block_diag([*[self.wires.stiffness] * (self.axes - 2), self.wires.stiffness + self._arm_springs])
        span = self.spread()
        tension = self.tensions(lengths, span)
        blocks = spring_blocks(span, tension, np.where(tension > 0, self.stiffness, 0.0))[:, 1:, 1:]
        axis = size * np.arange(self.axes - 1)
        lower, upper = self._lower[:, None] + axis, self._upper[:, None] + axis
        index, blocks = np.hstack([lower, upper]), np.block([[blocks, -blocks], [-blocks, blocks]])
        K = (K + scattered([(index, blocks)], K.shape[0])).tocsr()
        free = np.tile(~self.wires.idle, self.axes - 1)
        held = np.array(list(self._fixed_heights()), dtype=np.int64) + axis[-1]
        free[held] = False
        if self.axes == 3:
            free[list(self._fixed_lateral())] = False
        at = np.flatnonzero(free)
        step = np.zeros(free.size)
        step[at] = splu(K[at][:, at].tocsc()).solve(self._residual(self.found, force, lengths).ravel()[at])
        return step.reshape(self.found.shape)

    # what came of it

    def spread(self, found: Floats | None = None) -> Floats:
        """[m], shape (droppers, axes), from the droppers' lower to their upper clamps."""
        places = self.found if found is None else found
        across = (places[:, self._upper] - places[:, self._lower]).T
        return np.column_stack([-self._shift, across])

    def tensions(self, lengths: Floats, span: Floats | None = None) -> Floats:
        """[N], shape (droppers,), of droppers of given lengths [m]."""
        now = np.linalg.norm(self.spread() if span is None else span, axis=1)
        tension: Floats = np.maximum(self.stiffness * (now - lengths), 0.0)
        return tension

    def unsettled(self, what: str, change: Floats) -> SolverError:
        """The error of passes that come to no end.

        change : [m], shape (droppers,) or of ``found``, in the last one
        """
        if change.ndim == 1:
            place = dropper_names(self.catenary)[int(np.abs(change).argmax())]
        else:
            node = int(np.abs(change[:, : self.wires.nodes]).max(axis=0).argmax())
            place = f"a wire at {self.wires.x[node]:.1f} m along the line"
        return SolverError(
            f"{what} by {1e3 * np.abs(change).max():.3g} mm a pass, most at {place}; look there for little"
            " tension, long spans and stagger that leaves a steady arm or a dropper without a hold"
        )

    def shape(self, lengths: Floats) -> Shape:
        """The wires as cable elements, hung on droppers of given lengths [m].

        Raises InputError for steady arms that would have to push.
        """
        wires, mesh, n = self.wires, self.mesh, self.wires.nodes
        loads = self._distributed_loads()
        slopes = [wires.slopes(u, load) for u, load in zip(self.found, loads, strict=True)]
        points = np.column_stack([wires.x, *self.found[:, :n][:, wires.dof]])
        arm_forces = self._arm_forces()
        support_forces = np.zeros((len(self.catenary.supports), self.axes - 1))
        if mesh.messenger:
            supported = [self._at_support(mesh.contact_wires, i) for i in range(len(support_forces))]
            support_forces = self._with_springs(self.reactions)[:, supported].T
        check_arms(self.catenary, arm_forces)
        lines = installed_lines(wires, points, np.column_stack(slopes))
        balance = np.zeros(2 * self.axes * n)
        installation, system = balanced(
            self.catenary, mesh, Installation(lines, lengths, arm_forces, support_forces, balance)
        )
        span = self.spread()
        shape = Shape(
            catenary=self.catenary,
            mesh_settings=self.settings,
            mesh=mesh,
            installation=installation,
            wires=tuple(HangingWire.from_coordinates(line.coordinates()) for line in lines),
            dropper_forces=self.tensions(lengths, span),
            installed_lengths=np.linalg.norm(span, axis=1),
        )
        shape.__dict__["system"] = system  # it is assembled already
        return shape

    def _with_springs(self, reactions: Floats) -> Floats:
        """[N], shape (axes - 1, 2 * nodes): reactions, and forces of what was set before."""
        found = reactions.copy()
        if self.masts:
            found[-1, self.masts.at] = self.masts.forces(self.found[-1])
        return found

    def _arm_forces(self) -> Floats:
        """[N], shape (contact wires, spans + 1, axes - 1), of the arms on the wires."""
        forces = np.zeros((self.mesh.contact_wires, len(self.catenary.supports), self.axes - 1))
        on_wires = self._with_springs(self.reactions)
        for wire, i, at, arm in self._arms():
            forces[wire, i] = on_wires[:, at]
            if not (arm.holds_height or self.masts):
                raised = self.found[-1, at] - self.catenary.contact_wire_heights[i]
                lift = self._lift(at, arm) if arm.stiffness is None else arm.preload - arm.stiffness * raised
                forces[wire, i, -1] = lift
        return forces
