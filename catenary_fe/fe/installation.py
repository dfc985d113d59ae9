"""How a catenary was installed: where its wires hang, and what acts on them there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from catenary_fe.fe.equipment import add_to_elements, lumped, wear_elements
from catenary_fe.fe.mesh import Mesh
from catenary_fe.layout import GRAVITY, Catenary, Wire
from catenary_fe.layout.as_built import tension_ratio
from catenary_fe.layout.terminations import WireField, tension_shares
from catenary_fe.layout.track import curvatures, lean

Floats = NDArray[np.float64]

_GAUSS_X, _GAUSS_W = np.polynomial.legendre.leggauss(5)


@dataclass(frozen=True)
class WireLine:
    """Where a wire hangs: positions and slopes at its nodes, arc lengths between them.

    points : [m], shape (nodes, axes)
    slopes : shape (nodes, axes), derivatives of the points along the wire
    lengths : [m], shape (nodes - 1,), of the elements under the wire's nominal tension
    """

    points: Floats
    slopes: Floats
    lengths: Floats

    @classmethod
    def through(
        cls, wire: Wire, points: ArrayLike, inclinations: ArrayLike, pulls: ArrayLike | None = None
    ) -> WireLine:
        """The wire that hangs through given points with given inclinations (cubic between the points).

        points : [m], shape (nodes, axes)
        inclinations : shape (nodes, axes - 1), derivatives along the track of all axes but the first
        pulls : [N], shape (nodes - 1,), pull along the track in each element; unset: the nominal tension.
            Where the wire is inclined it is stretched a little more than that.
        """
        points, rises = np.array(points, dtype=float), np.array(inclinations, dtype=float)
        tension = np.full(len(points) - 1, wire.tension) if pulls is None else np.asarray(pulls, dtype=float)
        h = np.diff(points[:, 0])[:, None, None]
        xi = ((_GAUSS_X + 1) / 2)[:, None]
        inclination = (
            6 * (xi - xi**2) * np.diff(points[:, 1:], axis=0)[:, None] / h
            + (1 - 4 * xi + 3 * xi**2) * rises[:-1, None]
            + (3 * xi**2 - 2 * xi) * rises[1:, None]
        )
        arc = np.sqrt(1 + (inclination**2).sum(axis=2))
        stretch = 1 + (arc * tension[:, None] - wire.tension) / wire.axial_stiffness
        lengths = h[:, 0, 0] * ((arc / stretch) @ _GAUSS_W) / 2
        at_nodes = np.concatenate([tension[:1], (tension[:-1] + tension[1:]) / 2, tension[-1:]])
        arc = np.sqrt(1 + (rises**2).sum(axis=1))
        slope = (1 + (arc * at_nodes - wire.tension) / wire.axial_stiffness) / arc
        return cls(points, np.column_stack([slope, rises * slope[:, None]]), lengths)

    @property
    def axes(self) -> int:
        """2 in the plane, 3 in space."""
        return int(self.points.shape[1])

    @property
    def x(self) -> Floats:
        """[m], shape (nodes,), along the track."""
        return self.points[:, 0]

    @property
    def z(self) -> Floats:
        """[m], shape (nodes,), up."""
        return self.points[:, -1]

    def coordinates(self) -> Floats:
        """Shape (nodes, 2 * axes): reference coordinates of the nodes, points then slopes."""
        return np.hstack([self.points, self.slopes])


@dataclass(frozen=True)
class Installation:
    """What the crew sets: how the wires hang, and the droppers, arms and supports that make them do so.

    lines : the wires' static lines, in the order of the mesh
    dropper_lengths : [m], shape (droppers,), stress-free
    arm_forces : [N], shape (contact wires, spans + 1, axes - 1), of the arms on the wires where they hang:
        to the left (in space only) and up; 0 without an arm
    support_forces : [N], shape (spans + 1, axes - 1), likewise, on the messenger wire
    balance : [N], shape (coordinates of all nodes,), constant forces that keep the wires on these lines.
        Cubic elements round the kinks that a wire has at clamps and supports: without these forces they
        would hang elsewhere, by millimetres. They vanish with the elements' length
    """

    lines: tuple[WireLine, ...]
    dropper_lengths: Floats
    arm_forces: Floats
    support_forces: Floats
    balance: Floats

    @property
    def axes(self) -> int:
        """2 in the plane, 3 in space."""
        return self.lines[0].axes

    def coordinates(self) -> Floats:
        """Shape (coordinates of all nodes,): of each node its point, then its slope."""
        return np.concatenate([line.coordinates().ravel() for line in self.lines])


def dropper_damping(catenary: Catenary) -> Floats:
    """[N s/m], shape (droppers,): a taut dropper's own damping and its share of the β K damping."""
    return np.array([d.damping + catenary.damping.beta * d.stiffness for d in catenary.droppers])


def wire_kinds(catenary: Catenary, mesh: Mesh) -> list[Wire]:
    """Each wire's parameters, in the order of the mesh."""
    lines: list[Wire] = [catenary.contact_wire] * mesh.contact_wires
    if catenary.messenger_wire:
        lines.append(catenary.messenger_wire)
    if catenary.stitch_wire:
        lines += [catenary.stitch_wire] * len(mesh.stitch_ends)
    return lines


def element_values(catenary: Catenary, mesh: Mesh, name: str) -> Floats:
    """Shape (elements of all wires,): a parameter of each element's wire, by its name."""
    counts = [wire.x.size - 1 for wire in mesh.wires]
    values = [
        np.full(n, float(getattr(kind, name)))
        for n, kind in zip(counts, wire_kinds(catenary, mesh), strict=True)
    ]
    wear_elements(catenary, mesh, name, values)
    add_to_elements(catenary, mesh, name, values)
    return np.concatenate(values)


def element_pulls(catenary: Catenary, mesh: Mesh) -> list[Floats]:
    """[N], for each wire shape (elements,): pull along the track as installed.

    Between a stitch wire's clamps the two wires share the messenger wire's tension.
    """
    pulls = [
        kind.tension * element_shares(catenary, mesh, number)
        for number, kind in enumerate(wire_kinds(catenary, mesh))
    ]
    for a, b in mesh.stitch_ends:
        assert catenary.stitch_wire is not None
        pulls[mesh.contact_wires][a:b] -= catenary.stitch_wire.tension
    return pulls


def element_shares(catenary: Catenary, mesh: Mesh, number: int) -> Floats:
    """Shape (elements,): what friction leaves of a wire's nominal tension; the wire by its number."""
    x = mesh.wires[number].x
    if number >= mesh.first_stitch:
        return np.ones(x.size - 1)
    return tension_shares(catenary, wire_field(mesh, number), (x[:-1] + x[1:]) / 2)


def curve_pulls(catenary: Catenary, mesh: Mesh) -> list[Floats]:
    """[N/kg], for each wire shape (elements,): pull to the left by the element's mass, T/(R ρ) + g sin φ.

    Seen from a track that curves with the radius R, a straight wire under the tension T bends as if a force
    T/R a metre pulled it towards the centre; what this leaves out is of the order of y/R, 0.1 %. Seen from
    one that leans by φ, a part of its weight pulls it to the lower rail.
    """
    pulls = element_pulls(catenary, mesh)
    counts = np.cumsum([p.size for p in pulls])[:-1]
    masses = np.split(element_values(catenary, mesh, "mass_per_length"), counts)
    found = []
    for wire, pull, mass in zip(mesh.wires, pulls, masses, strict=True):
        middle = (wire.x[:-1] + wire.x[1:]) / 2
        weight = GRAVITY * np.sin(lean(catenary, middle))
        found.append(pull * curvatures(catenary, middle) / mass + weight)
    return found


def point_masses(catenary: Catenary, mesh: Mesh, lengths: Floats) -> tuple[Floats, Floats]:
    """[kg], shape (nodes of all wires,) each: masses that move with the nodes, and that weigh on them.

    Of clamps, droppers, equipment and arms.
    """
    masses = np.zeros(mesh.first_nodes[-1])
    half = np.array([d.mass_per_length for d in catenary.droppers]) * lengths / 2
    below = np.array([d.contact_wire_clamp_mass for d in catenary.droppers])
    above = np.array([d.messenger_clamp_mass for d in catenary.droppers])
    np.add.at(masses, mesh.nodes(mesh.lower), below + half)
    np.add.at(masses, mesh.nodes(mesh.upper), above + half)
    if catenary.stitch_wire:
        ends = mesh.first_nodes[mesh.contact_wires] + mesh.stitch_ends
        masses[ends.ravel()] += catenary.stitch_wire.clamp_mass
    np.add.at(masses, *lumped(catenary, mesh))
    hanging = masses.copy()
    for node, mass in _weights(catenary, mesh):
        masses[node] += mass
    for i, support in list(enumerate(catenary.supports))[1:-1]:
        if arm := support.steady_arm:
            for first, wire in zip(mesh.first_nodes, mesh.wires[: mesh.contact_wires], strict=False):
                masses[first + wire.supports[i]] += arm.tip_mass
                hanging[first + wire.supports[i]] += arm.hanging_mass
    return masses, hanging


def _weights(catenary: Catenary, mesh: Mesh) -> list[tuple[int, float]]:
    """Nodes at the ends of wires, which move along the track alone, and mass [kg] of their weights there.

    Weights of T/(g i) that move i times as far as the wire are to it a mass of T i/g.
    """
    found = []
    for number, kind in enumerate(wire_kinds(catenary, mesh)[: mesh.first_stitch]):
        name = wire_field(mesh, number)
        for node, end in ((0, catenary.begin), (mesh.wires[number].x.size - 1, catenary.end)):
            if ratio := end.of(name).ratio:
                found.append(
                    (
                        int(mesh.first_nodes[number]) + node,
                        ratio * tension_ratio(catenary, name) * kind.tension / GRAVITY,
                    )
                )
    return found


def wire_field(mesh: Mesh, number: int) -> WireField:
    """What a wire, no stitch wire, is called in a layout."""
    return "contact_wire" if number < mesh.contact_wires else "messenger_wire"
