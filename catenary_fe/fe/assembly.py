"""From a line as it was installed to its assembled system."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import Cables, mass_blocks, scattered
from catenary_fe.fe.contact import BaseLine, EvenCurve, surface_places
from catenary_fe.fe.installation import (
    Installation,
    WireLine,
    curve_pulls,
    dropper_damping,
    element_pulls,
    element_shares,
    element_values,
    point_masses,
    wire_field,
    wire_kinds,
)
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.spring import FIXED, Springs
from catenary_fe.fe.system import System, WireNodes
from catenary_fe.fe.track import cant_forces, leaning_weights
from catenary_fe.layout import GRAVITY, Catenary, Wire
from catenary_fe.layout.conditions.effect import outer_diameter
from catenary_fe.layout.equipment import stations
from catenary_fe.layout.installed import worn_surface
from catenary_fe.layout.terminations import midpoint_place

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

LINK_STIFFNESS = 1e7  # [N/m] of a steady arm along its length: a tube's, far stiffer than the wire on it


def assemble(catenary: Catenary, mesh: Mesh, installation: Installation) -> System:
    """The line as it was installed, as one system."""
    from scipy.sparse import csr_matrix, diags

    lines, axes = installation.lines, installation.axes
    width, first_nodes = 2 * axes, mesh.first_nodes
    size = width * int(first_nodes[-1])
    first = np.concatenate(
        [width * (n + np.arange(line.lengths.size)) for n, line in zip(first_nodes, lines, strict=False)]
    )
    lengths = np.concatenate([line.lengths for line in lines])
    per_length, EA, EI, tension = (
        element_values(catenary, mesh, name)
        for name in ("mass_per_length", "axial_stiffness", "bending_stiffness", "tension")
    )
    index, blocks = first[:, None] + np.arange(2 * width), mass_blocks(lengths, per_length, axes)
    wire_mass = scattered([(index, blocks)], size)
    masses, hanging = point_masses(catenary, mesh, installation.dropper_lengths)
    ups, points = np.zeros((size // width, width)), np.zeros((size // width, width))
    ups[:, axes - 1], points[:, :axes] = 1.0, 1.0
    force = -GRAVITY * (wire_mass @ ups.ravel() + np.repeat(hanging, width) * ups.ravel())
    if axes == 3:
        pulls = np.concatenate(curve_pulls(catenary, mesh))[:, None, None]
        lefts = np.roll(ups, -1, axis=1)
        force += scattered([(index, blocks * pulls)], size) @ lefts.ravel()
        at_nodes = cant_forces(catenary, mesh) + leaning_weights(catenary, mesh, hanging)
        force += (at_nodes[:, None] * lefts).ravel()
    held = _Restraints(catenary, mesh, installation, size)
    return System(
        axes=axes,
        reference=installation.coordinates(),
        dof=held.dof(lines),
        first=first,
        cables=Cables(lengths, EA, EI, -tension / EA),
        mass_per_length=per_length,
        element_mass=blocks,
        wire_mass=wire_mass,
        mass=(wire_mass + diags(np.repeat(masses, width) * points.ravel())).tocsr(),
        droppers=_droppers(catenary, mesh, installation),
        arms=held.bars(),
        ground_stiffness=held.stiffness,
        ground_damping=held.damping,
        linear_stiffness=csr_matrix((size, size)),
        linear_damping=csr_matrix((size, size)),
        force=force + held.force + installation.balance,
        alpha=float(catenary.damping.alpha),
        beta=float(catenary.damping.beta),
        wires=_wires(catenary, mesh),
        contact_wire_height=catenary.contact_wire_height,
        base_line=BaseLine(catenary.support_positions, catenary.drawn_heights - catenary.contact_wire_height),
    )


def _wires(catenary: Catenary, mesh: Mesh) -> tuple[WireNodes, ...]:
    found = []
    pulls, kinds = element_pulls(catenary, mesh), wire_kinds(catenary, mesh)
    for n, (first, wire, pull) in enumerate(zip(mesh.first_nodes, mesh.wires, pulls, strict=False)):
        clamps = [mesh.lower.node[mesh.lower.on(n)], mesh.upper.node[mesh.upper.on(n)]]
        clamps += [wire.supports, np.array([0, wire.x.size - 1])]
        if n == mesh.contact_wires:
            clamps.append(mesh.stitch_ends.ravel())
        clamps.append(np.searchsorted(wire.x, np.array(stations(catenary, mesh.wire_name(n))) - 1e-6))
        fixed = np.unique(np.concatenate(clamps))
        contact = n < mesh.contact_wires
        found.append(
            WireNodes(
                name=mesh.wire_name(n),
                first=int(first),
                x=wire.x,
                contact=contact,
                supports=wire.supports,
                clamps=fixed,
                tension=pull,
                irregularity=_worn(catenary, n, kinds[n], wire.x) if contact else None,
                kind="stitch_wire" if n >= mesh.first_stitch else wire_field(mesh, n),
                wire=kinds[n],
            )
        )
    return tuple(found)


def _worn(catenary: Catenary, number: int, wire: Wire, x: Floats) -> EvenCurve | None:
    """The running surface that wear has left of a contact wire with nodes at x [m]."""
    places = surface_places(x)
    return EvenCurve.through(places, worn_surface(catenary, number, outer_diameter(wire), places))


def balanced(catenary: Catenary, mesh: Mesh, installation: Installation) -> tuple[Installation, System]:
    """The installation with the forces that keep its wires exactly where their lines are, and its system.

    installation : without such forces
    """
    none = np.zeros_like(installation.balance)
    system = assemble(catenary, mesh, replace(installation, balance=none))
    residual = system.gather(system.out_of_balance(none))
    balance = none.copy()
    moves = np.flatnonzero(system.dof >= 0)
    _, one_each = np.unique(system.dof[moves], return_index=True)
    at = moves[one_each]  # of coordinates that follow another one, the leading one
    balance[at] = -residual[system.dof[at]]
    return replace(installation, balance=balance), replace(system, force=system.force + balance)


def _droppers(catenary: Catenary, mesh: Mesh, installation: Installation) -> Springs:
    width, count = 2 * installation.axes, len(catenary.droppers)
    return Springs(
        first=width * mesh.nodes(mesh.lower).astype(np.int64),
        last=width * mesh.nodes(mesh.upper).astype(np.int64),
        pivot=np.zeros((count, installation.axes)),
        length=np.asarray(installation.dropper_lengths, dtype=float),
        stiffness=np.array([d.stiffness for d in catenary.droppers], dtype=float),
        damping=np.asarray(dropper_damping(catenary), dtype=float),
        pulls_only=True,
    )


class _Restraints:
    """What holds the wires at masts and ends: springs and preloads, fixed coordinates, bars."""

    def __init__(self, catenary: Catenary, mesh: Mesh, installation: Installation, size: int) -> None:
        self.catenary, self.mesh, self.installation = catenary, mesh, installation
        self.axes, self.width = installation.axes, 2 * installation.axes
        self.stiffness, self.damping, self.force = np.zeros(size), np.zeros(size), np.zeros(size)
        self.leader = np.arange(size)
        self.fixed = np.zeros(size, dtype=bool)
        self._bars: list[tuple[int, Floats, float]] = []
        self._ends()
        self._stitch_wires()
        for number in range(mesh.contact_wires):
            self._arms(number)
        self._supports()

    def at(self, wire: int, node: int, axis: int) -> int:
        """Number of a coordinate."""
        return self.width * (int(self.mesh.first_nodes[wire]) + node) + axis

    def _ends(self) -> None:
        """Contact and messenger wires are held or pulled along the track at their ends and at a midpoint.

        Where friction takes tension at a support, that pulls along the track too.
        """
        catenary, mesh = self.catenary, self.mesh
        for number, kind in enumerate(wire_kinds(catenary, mesh)[: mesh.first_stitch]):
            wire, name = mesh.wires[number], wire_field(mesh, number)
            pulls = kind.tension * element_shares(catenary, mesh, number)
            for node, end, pull in (
                (0, catenary.begin.of(name), -pulls[0]),
                (wire.x.size - 1, catenary.end.of(name), pulls[-1]),
            ):
                at = self.at(number, node, 0)
                if end.kind == "fixed":
                    self.fixed[at] = True
                else:
                    self._spring(at, end.stiffness or 0.0, 0.0, float(pull))
            inner = [self.at(number, node, 0) for node in range(1, wire.x.size - 1)]
            self.force[inner] -= np.diff(pulls)
            anchor = midpoint_place(catenary, name)
            if anchor is not None:
                self.fixed[self.at(number, int(np.abs(wire.x - anchor).argmin()), 0)] = True

    def _stitch_wires(self) -> None:
        mesh = self.mesh
        for i, clamps in enumerate(mesh.stitch_ends.tolist()):
            number = mesh.first_stitch + i
            for node, clamp in zip((0, mesh.wires[number].x.size - 1), clamps, strict=True):
                for axis in range(self.axes):
                    self.leader[self.at(number, node, axis)] = self.at(mesh.contact_wires, clamp, axis)

    def _spring(self, at: int, stiffness: float, damping: float, preload: float) -> None:
        self.stiffness[at] += stiffness
        self.damping[at] += damping
        self.force[at] += preload

    def _arms(self, number: int) -> None:
        """Steady arms; at the line's ends the wire is held where it is."""
        last, up = len(self.catenary.supports) - 1, self.axes - 1
        for i, support in enumerate(self.catenary.supports):
            node, arm = int(self.mesh.wires[number].supports[i]), support.steady_arm
            force = self.installation.arm_forces[number, i]
            sideways = [self.at(number, node, axis) for axis in range(1, up)]
            at_end = i in (0, last)
            if at_end or (arm and arm.length is None):
                self.fixed[sideways] = True
            if at_end:
                self.fixed[self.at(number, node, up)] = True
            elif arm and arm.stiffness is not None:
                self._spring(self.at(number, node, up), arm.stiffness, arm.damping, float(force[-1]))
            elif arm and arm.length is not None:
                self._bar(number, node, arm.length, force)

    def _bar(self, number: int, node: int, length: float, force: Floats) -> None:
        """A stiff spring to a pivot that lies where the force on the wire points to."""
        pull = float(np.linalg.norm(force))
        pivot = self.installation.lines[number].points[node] + length * np.array([0.0, *force]) / pull
        self._bars.append((self.at(number, node, 0), pivot, length - pull / LINK_STIFFNESS))

    def _supports(self) -> None:
        last, up, wire = len(self.catenary.supports) - 1, self.axes - 1, self.mesh.contact_wires
        if self.mesh.messenger is None:
            return
        for i, support in enumerate(self.catenary.supports):
            node = int(self.mesh.messenger.supports[i])
            springs = {up: (support.messenger_stiffness, support.messenger_damping)}
            if up > 1:
                springs[1] = (support.messenger_lateral_stiffness, support.messenger_lateral_damping)
            for axis, (stiffness, damping) in springs.items():
                at = self.at(wire, node, axis)
                if i in (0, last) or stiffness is None:
                    self.fixed[at] = True
                else:
                    self._spring(at, stiffness, damping, float(self.installation.support_forces[i, axis - 1]))

    def bars(self) -> Springs:
        """The steady arms that are bars."""
        count = len(self._bars)
        return Springs(
            first=np.array([first for first, _, _ in self._bars], dtype=np.int64),
            last=np.full(count, FIXED, dtype=np.int64),
            pivot=np.array([pivot for _, pivot, _ in self._bars], dtype=float).reshape(count, self.axes),
            length=np.array([length for _, _, length in self._bars], dtype=float),
            stiffness=np.full(count, LINK_STIFFNESS),
            damping=np.zeros(count),
            pulls_only=False,
        )

    def dof(self, lines: Sequence[WireLine]) -> Integers:
        """Numbers of the free coordinates in the order of their stations, FIXED for those that are held."""
        station = np.concatenate([np.repeat(line.x, self.width) for line in lines])
        leads = (self.leader == np.arange(self.leader.size)) & ~self.fixed
        free = np.flatnonzero(leads)
        order = free[np.argsort(station[free], kind="stable")]
        dof = np.full(self.leader.size, FIXED, dtype=np.int64)
        dof[order] = np.arange(order.size)
        return np.where(self.fixed, FIXED, dof[self.leader])
