"""Several tension sections as one mesh, one installation and one system: their wires side by side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import Cables
from catenary_fe.fe.contact import BaseLine
from catenary_fe.fe.installation import Installation, WireLine
from catenary_fe.fe.mesh import Clamps, Mesh, MeshSettings, WireMesh, make_mesh
from catenary_fe.fe.spring import FIXED, Springs
from catenary_fe.fe.system import System, WireNodes
from catenary_fe.layout import Catenary, Line

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


class Joint:
    """Where the wires of several sections are among those of the line.

    All contact wires come first, then the messenger wires, then the stitch wires, each in the order of the
    sections.

    begins : [m] along the line of each section
    """

    def __init__(self, meshes: Sequence[Mesh], begins: Sequence[float]) -> None:
        self.meshes, self.begins = meshes, begins
        owner = np.repeat(np.arange(len(meshes)), [len(mesh.wires) for mesh in meshes])
        kinds = np.concatenate(
            [
                np.repeat([0, 1, 2], [m.contact_wires, m.messengers, len(m.wires) - m.first_stitch])
                for m in meshes
            ]
        )
        self.order: Integers = np.lexsort((np.arange(owner.size), kinds))
        self.section: Integers = owner[self.order]
        self.place = np.argsort(self.order)
        self._first_wire = np.cumsum([0, *(len(mesh.wires) for mesh in meshes)])

    def wires(self, of_sections: Sequence[Sequence[Any]]) -> list[Any]:
        """What each section has of each of its wires, in the order of the line."""
        flat = [each for section in of_sections for each in section]
        return [flat[i] for i in self.order]

    def mesh(self) -> Mesh:
        """The sections' meshes as one."""
        moved = [
            [WireMesh(wire.x + begin, wire.supports) for wire in mesh.wires]
            for mesh, begin in zip(self.meshes, self.begins, strict=True)
        ]
        return Mesh(
            wires=tuple(self.wires(moved)),
            contact_wires=sum(mesh.contact_wires for mesh in self.meshes),
            lower=self._clamps([mesh.lower for mesh in self.meshes]),
            upper=self._clamps([mesh.upper for mesh in self.meshes]),
            stitch_ends=np.concatenate([mesh.stitch_ends for mesh in self.meshes]),
            messengers=sum(mesh.messengers for mesh in self.meshes),
        )

    def _clamps(self, of_sections: Sequence[Clamps]) -> Clamps:
        wires = [self.place[n + c.wire] for n, c in zip(self._first_wire, of_sections, strict=False)]
        return Clamps(np.concatenate(wires), np.concatenate([clamps.node for clamps in of_sections]))

    def installation(
        self, parts: Sequence[Installation], masts: Sequence[Integers], count: int
    ) -> Installation:
        """The sections' installations as one.

        masts : of each section, the numbers of its supports among those of the line
        count : number of supports of the line
        """
        lines = [
            [
                WireLine(line.points + begin * np.eye(line.axes)[0], line.slopes, line.lengths)
                for line in p.lines
            ]
            for p, begin in zip(parts, self.begins, strict=True)
        ]
        axes, contact_wires = parts[0].axes, sum(mesh.contact_wires for mesh in self.meshes)
        arms, supports = np.zeros((contact_wires, count, axes - 1)), np.zeros((count, axes - 1))
        first = 0
        for part, at in zip(parts, masts, strict=True):
            arms[first : first + len(part.arm_forces), at] = part.arm_forces
            first += len(part.arm_forces)
            supports[at] += part.support_forces
        width = 2 * axes
        balances = [
            np.split(p.balance, width * m.first_nodes[1:-1]) for p, m in zip(parts, self.meshes, strict=True)
        ]
        return Installation(
            lines=tuple(self.wires(lines)),
            dropper_lengths=np.concatenate([part.dropper_lengths for part in parts]),
            arm_forces=arms,
            support_forces=supports,
            balance=np.concatenate(self.wires(balances)),
        )

    def joined(self, parts: Sequence[System], base_line: BaseLine) -> System:
        """The sections' systems as one; nothing but a pantograph connects them."""
        width = 2 * parts[0].axes
        sizes = [np.array([width * wire.x.size for wire in part.wires]) for part in parts]
        flat = np.concatenate(sizes)
        starts = np.concatenate([[0], np.cumsum(flat)[:-1]])
        old = np.concatenate([starts[i] + np.arange(flat[i]) for i in self.order])  # by new numbers
        new = np.argsort(old)
        shift = np.cumsum([0, *(part.dof.size for part in parts)])
        moved = [self._moved(part, begin) for part, begin in zip(parts, self.begins, strict=True)]

        def each(name: str) -> Any:
            return np.concatenate([getattr(part, name) for part in moved])[old]

        def matrix(name: str) -> Any:
            from scipy.sparse import block_diag

            return block_diag([getattr(part, name) for part in moved]).tocsr()[old][:, old]

        firsts = np.concatenate([new[n + p.first] for n, p in zip(shift, moved, strict=False)])
        order = np.argsort(firsts)

        def elements(name: str) -> Any:
            return np.concatenate([getattr(part, name) for part in moved])[order]

        cables = Cables(
            *(
                np.concatenate([getattr(part.cables, field.name) for part in moved])[order]
                for field in fields(Cables)
            )
        )
        whole = parts[0]
        return replace(
            whole,
            reference=each("reference"),
            dof=self._dof(parts)[old],
            first=firsts[order],
            cables=cables,
            mass_per_length=elements("mass_per_length"),
            element_mass=elements("element_mass"),
            wire_mass=matrix("wire_mass"),
            mass=matrix("mass"),
            droppers=_springs([part.droppers for part in moved], shift, new),
            arms=_springs([part.arms for part in moved], shift, new),
            ground_stiffness=each("ground_stiffness"),
            ground_damping=each("ground_damping"),
            linear_stiffness=matrix("linear_stiffness"),
            linear_damping=matrix("linear_damping"),
            force=each("force"),
            wires=self._wire_nodes(parts, width),
            base_line=base_line,
            time_loads=tuple(
                replace(load, pattern=self._spread(load.pattern, shift[n], old))
                for n, part in enumerate(moved)
                for load in part.time_loads
            ),
        )

    def _moved(self, part: System, begin: float) -> System:
        width = 2 * part.axes
        reference, pivot = part.reference.copy(), part.arms.pivot.copy()
        reference[::width] += begin
        pivot[:, 0] += begin
        return replace(part, reference=reference, arms=replace(part.arms, pivot=pivot))

    def _spread(self, pattern: Floats, first: int, old: Integers) -> Floats:
        whole = np.zeros(old.size)
        whole[first : first + pattern.size] = pattern
        return whole[old]

    def _dof(self, parts: Sequence[System]) -> Integers:
        """Numbered section by section: a run can compute some of them alone."""
        counts = np.cumsum([0, *(part.size for part in parts)])
        return np.concatenate(
            [np.where(p.dof == FIXED, FIXED, p.dof + n) for p, n in zip(parts, counts, strict=False)]
        )

    def _wire_nodes(self, parts: Sequence[System], width: int) -> tuple[WireNodes, ...]:
        named = [
            [
                replace(
                    wire,
                    name=f"section {n}: {wire.name}",
                    x=wire.x + begin,
                    section=n - 1,
                    irregularity=wire.irregularity and wire.irregularity.moved(float(begin)),
                )
                for wire in part.wires
            ]
            for n, (part, begin) in enumerate(zip(parts, self.begins, strict=True), start=1)
        ]
        found, first = [], 0
        for wire in self.wires(named):
            found.append(replace(wire, first=first))
            first += wire.x.size
        return tuple(found)


def _springs(parts: Sequence[Springs], shift: Integers, new: Integers) -> Springs:
    def numbers(name: str) -> Integers:
        found = [
            np.where(getattr(p, name) == FIXED, FIXED, new[np.maximum(getattr(p, name), 0) + n])
            for p, n in zip(parts, shift, strict=False)
        ]
        return np.concatenate(found)

    others: dict[str, Any] = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in ("pivot", "length", "stiffness", "damping")
    }
    return replace(parts[0], first=numbers("first"), last=numbers("last"), **others)


def mesh_of(catenary: Catenary, settings: MeshSettings) -> Mesh:
    """The mesh of a line of one section or several, as :func:`make_mesh`."""
    if not isinstance(catenary, Line):
        return make_mesh(catenary, settings)
    return Joint([make_mesh(section, settings) for section in catenary.sections], catenary.begins).mesh()
