"""Wires with their droppers cut: each hangs alone, held or loaded where it was cut."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import tan

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.model import curve_pulls, element_pulls
from catenary_fe.fe.single_wire import At, Cut, WireStatics, solve_wire
from catenary_fe.fe.wire import WireLine
from catenary_fe.system import GRAVITY, Catenary, SolverError, SteadyArm, Wire

Floats = NDArray[np.float64]
_ANCHORS = 0, -1  # a line's first and last support hold the contact wire


@dataclass(frozen=True)
class DropperForces:
    """What the droppers do to the wires.

    pull : [N], shape (droppers,), vertical, on the contact wires
    lean : shape (droppers,), how far the upper end lies to the left of the lower one, over the height
    righting : [N/m], shape (droppers,), pull over height: it grows sideways as the lower end moves
    half_weight : [N], shape (droppers,), of a dropper's half
    """

    pull: Floats
    lean: Floats
    righting: Floats
    half_weight: Floats


class CutWires:
    """All wires of a catenary, to be hung one by one.

    axes : 2 in the plane, 3 in space
    """

    def __init__(self, catenary: Catenary, mesh: Mesh) -> None:
        self.catenary, self.mesh = catenary, mesh
        self.axes = 3 if catenary.is_spatial else 2
        self.up = self.axes - 1
        self.pulls = element_pulls(catenary, mesh)
        self._side = curve_pulls(catenary, mesh) if self.axes == 3 else [None] * len(mesh.wires)
        self.arm_forces = np.zeros((mesh.contact_wires, len(catenary.supports), self.axes - 1))
        self.support_forces = np.zeros((len(catenary.supports), self.axes - 1))
        if self.axes == 3:  # a first guess for links of given inclination
            held = [support.steady_arm is not None for support in catenary.supports]
            self.arm_forces[:, :, 0] = -catenary.lateral_pulls * held / mesh.contact_wires

    def clamp_weights(self, which: str) -> Floats:
        """[N], shape (droppers,), of the clamps at one of the droppers' ends."""
        return GRAVITY * np.array([getattr(d, which) for d in self.catenary.droppers])

    def hang_contact_wire(
        self, number: int, line: WireLine, forces: DropperForces
    ) -> tuple[WireLine, DropperForces]:
        """Hang a contact wire at its design heights: its line, and the droppers' pull that takes.

        The forces of its steady arms are found with it.
        """
        catenary, up = self.catenary, self.up
        mesh, droppers = self.mesh.wires[number], self.mesh.lower.on(number)
        nodes = self.mesh.lower.node[droppers]
        held: dict[At, float] = {
            (int(n), up): float(z) for n, z in zip(nodes, catenary.design_heights[droppers], strict=True)
        }
        loads: dict[At, float] = {}
        springs: dict[At, tuple[float, float]] = {}
        if self.axes == 3:
            sideways = (forces.pull * forces.lean)[droppers]
            for n, force, righting in zip(nodes.tolist(), sideways, forces.righting[droppers], strict=True):
                loads[n, 1] = float(force)
                springs[n, 1] = float(righting), float(line.points[n, 1])
        self._register(number, held, loads, springs)
        cut = Cut(held, loads, springs, self._side[number])
        statics = solve_wire(catenary.contact_wire, line, cut, what="form finding of the contact wire")
        self._read_arms(number, statics)
        pull = forces.pull.copy()
        weight = self.clamp_weights("contact_wire_clamp_mass") + forces.half_weight
        pull[droppers] = [statics.reactions[int(n), up] for n in nodes] + weight[droppers]
        found = replace(forces, pull=pull)
        return straightened(catenary.contact_wire, mesh.x, statics, self.pulls[number], held), found

    def _register(
        self,
        number: int,
        held: dict[At, float],
        loads: dict[At, float],
        springs: dict[At, tuple[float, float]],
    ) -> None:
        """Hold the wire at its arms and ends, as far as they do."""
        catenary = self.catenary
        nominal = catenary.contact_wire_height
        anchors = [range(len(catenary.supports))[i] for i in _ANCHORS]
        for i, support in enumerate(catenary.supports):
            node, arm = int(self.mesh.wires[number].supports[i]), support.steady_arm
            if self.axes == 3 and (arm or i in anchors):
                held[node, 1] = support.stagger + catenary.contact_wire_offsets[number]
            if i in anchors or (arm and arm.holds_height):
                held[node, self.up] = nominal
            elif arm and arm.stiffness is not None:
                springs[node, self.up] = (arm.stiffness, nominal)
                loads[node, self.up] = arm.preload - GRAVITY * arm.mass
            elif arm:
                loads[node, self.up] = self._lift(number, i, arm) - GRAVITY * arm.hanging_mass

    def _lift(self, number: int, support: int, arm: SteadyArm) -> float:
        """[N] upward, of a link of given inclination under the sideways force that it has."""
        return abs(float(self.arm_forces[number, support, 0])) * tan(arm.inclination or 0.0)

    def _read_arms(self, number: int, statics: WireStatics) -> None:
        supports, nominal = self.catenary.supports, self.catenary.contact_wire_height
        for i, support in list(enumerate(supports))[1:-1]:
            node, arm = int(self.mesh.wires[number].supports[i]), support.steady_arm
            if not arm:
                continue
            force = self.arm_forces[number, i]
            if self.axes == 3:
                force[0] = statics.reactions[node, 1]
            if arm.holds_height:
                force[-1] = statics.reactions[node, self.up] + GRAVITY * arm.hanging_mass
            elif arm.stiffness is not None:
                force[-1] = arm.preload - arm.stiffness * (statics.points[node, self.up] - nominal)
            else:
                force[-1] = self._lift(number, i, arm)

    def hang_messenger_wire(
        self, line: WireLine, forces: DropperForces, stitch_pulls: dict[At, float]
    ) -> WireLine:
        """Hang the messenger wire under its droppers and stitch wires; its supports' forces are found too."""
        catenary, mesh = self.catenary, self.mesh
        supports = mesh.messenger.supports
        held: dict[At, float] = {}
        for i, node in enumerate(supports.tolist()):
            held[node, self.up] = float(catenary.messenger_support_heights[i])
            if self.axes == 3:
                held[node, 1] = catenary.supports[i].messenger_stagger
        loads = self._hangers(mesh.contact_wires, forces)
        for at, force in stitch_pulls.items():
            loads[at] = loads.get(at, 0.0) + force
        cut = Cut(held, loads, side_pull=self._side[mesh.contact_wires])
        statics = solve_wire(catenary.messenger_wire, line, cut, what="form finding of the messenger wire")
        for i, node in enumerate(supports.tolist()):
            self.support_forces[i] = [statics.reactions[node, axis] for axis in range(1, self.axes)]
        pulls = self.pulls[mesh.contact_wires]
        return straightened(catenary.messenger_wire, mesh.messenger.x, statics, pulls, held)

    def hang_stitch_wire(
        self, number: int, line: WireLine, ends: Floats, forces: DropperForces
    ) -> tuple[WireLine, dict[At, float]]:
        """Hang a stitch wire between its clamps on the messenger wire.

        number : of the wire in the mesh
        ends : [m], shape (2, axes), points of the messenger wire under the clamps

        Returns its line and its pull on the messenger wire.
        """
        stitch, mesh = self.catenary.stitch_wire, self.mesh.wires[number]
        assert stitch is not None
        last = mesh.x.size - 1
        held: dict[At, float] = {
            (node, axis): float(end[axis])
            for node, end in zip((0, last), ends, strict=True)
            for axis in range(1, self.axes)
        }
        cut = Cut(held, self._hangers(number, forces), side_pull=self._side[number])
        statics = solve_wire(stitch, line, cut, what="form finding of a stitch wire")
        pulls: dict[At, float] = {}
        on_messenger = self.mesh.stitch_ends[number - self.mesh.first_stitch].tolist()
        for node, clamp, along in zip((0, last), on_messenger, (1, -1), strict=True):
            pulls[clamp, 0] = along * stitch.tension
            for axis in range(1, self.axes):
                pulls[clamp, axis] = -statics.reactions[node, axis]
            pulls[clamp, self.up] -= GRAVITY * stitch.clamp_mass
        return straightened(stitch, mesh.x, statics, self.pulls[number], held), pulls

    def _hangers(self, wire: int, forces: DropperForces) -> dict[At, float]:
        """Loads of the droppers that hang on a wire."""
        droppers = self.mesh.upper.on(wire)
        nodes = self.mesh.upper.node[droppers].tolist()
        weight = self.clamp_weights("messenger_clamp_mass") + forces.half_weight
        down = (forces.pull + weight)[droppers]
        loads: dict[At, float] = {(n, self.up): -float(f) for n, f in zip(nodes, down, strict=True)}
        if self.axes == 3:
            sideways = (forces.pull * forces.lean)[droppers]
            loads |= {(n, 1): -float(f) for n, f in zip(nodes, sideways, strict=True)}
        return loads


def straightened(
    wire: Wire, x: Floats, statics: WireStatics, pulls: Floats, held: Mapping[At, float]
) -> WireLine:
    """The line that was found, with the nodes back at their stations: clamps sit where they are wanted.

    held : [m] coordinates that stay, though their node slid along the track, by node and axis

    Raises SolverError where the wire hangs so low that it folds back.
    """
    from scipy.interpolate import CubicHermiteSpline

    found = statics.points
    forward = np.diff(found[:, 0]) > 0
    if not forward.all() or not np.isfinite(found).all():
        raise SolverError(
            f"form finding: a wire under {wire.tension:g} N hangs so low that it folds back, near"
            f" {x[int(forward.argmin())]:.1f} m along the line; look for too little tension"
        )
    curve = CubicHermiteSpline(found[:, 0], found[:, 1:], statics.inclinations, extrapolate=True)
    points = np.column_stack([x, curve(x)])
    for at, coordinate in held.items():
        points[at] = coordinate
    return WireLine.through(wire, points, curve(x, 1), pulls)
