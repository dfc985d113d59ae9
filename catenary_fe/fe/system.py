"""The assembled line: wires, droppers, arms and supports as arrays and sparse matrices, for every engine.

    M q̈ + D q̇ + f_cables(q) + f_droppers(q, q̇) + f_links(q) + K_ground q = f

q are displacements from the lines on which the wires were installed. "All" coordinates are those of the
wires' nodes, of each its point and then its slope; "free" ones are those that move: what is held is left out,
and the ends of stitch wires share the messenger wire's coordinates.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import (
    Cables,
    hermite,
    inner_forces,
    mean_stretch,
    scattered,
    strain_energy,
    tangent_blocks,
)
from catenary_fe.fe.contact import BaseLine, ContactPath, EvenCurve
from catenary_fe.fe.spring import FIXED, Springs
from catenary_fe.layout import Wire
from catenary_fe.layout.conditions.effect import WireKind

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

_SAME_PLACE = 1e-3  # [m] of masts


@dataclass(frozen=True)
class WireNodes:
    """A wire of the system: what it is called, the number of its first node, and its stations.

    x : [m], shape (nodes,)
    contact : whether pantographs run along it
    supports : numbers of its own nodes at the supports
    clamps : likewise where something is fixed to it, its ends among them: there its tension may step
    tension : [N], shape (nodes - 1,), nominal pull along the track in each element
    section : number of its tension section, from 0
    irregularity : of a contact wire's running surface, or None
    kind, wire : what it is called in a layout, and its parameters; none of a wire by itself
    """

    name: str
    first: int
    x: Floats
    contact: bool
    supports: Integers
    clamps: Integers
    tension: Floats
    section: int = 0
    kind: WireKind = "contact_wire"
    wire: Wire | None = None
    irregularity: EvenCurve | None = None


@dataclass(frozen=True)
class TimeLoad:
    """A load that varies in time.

    pattern : [N], shape (all,), forces on all coordinates where the signal is 1
    signal : of times [s], shape (times,), numbers of that shape
    """

    pattern: Floats
    signal: Callable[[Floats], Floats]


@dataclass(frozen=True)
class System:
    """The assembled line.

    axes : 2 in the plane, 3 in space; up is the last one
    reference : shape (all,), points [m] and slopes from which displacements count
    dof : shape (all,), number of the free coordinate, or FIXED; numbered section by section, in the order of
        their stations
    first : shape (elements,), number of each cable element's first coordinate among all; those of its two
        nodes follow one another
    cables : the elements
    mass_per_length : [kg/m], shape (elements,)
    element_mass : [kg], shape (elements, 4 * axes, 4 * axes)
    wire_mass, mass : sparse, [kg], over all coordinates: of the wires, and with what they carry
    droppers, arms : springs
    ground_stiffness, ground_damping : [N/m], [N s/m], shape (all,), of springs to the ground
    linear_stiffness, linear_damping : [N/m], [N s/m], sparse, over all coordinates, of what else is linear
    force : [N], shape (all,), constant: weight, tensions, curves, preloads, balance
    alpha, beta : Rayleigh damping of the wires
    wires : contact wires, messenger wire, stitch wires
    contact_wire_height : [m], nominal, from which pantographs count
    base_line : what the bases of pantographs follow
    time_loads : besides the constant forces
    """

    axes: int
    reference: Floats
    dof: Integers
    first: Integers
    cables: Cables
    mass_per_length: Floats
    element_mass: Floats
    wire_mass: Any
    mass: Any
    droppers: Springs
    arms: Springs
    ground_stiffness: Floats
    ground_damping: Floats
    linear_stiffness: Any
    linear_damping: Any
    force: Floats
    alpha: float
    beta: float
    wires: tuple[WireNodes, ...]
    contact_wire_height: float
    base_line: BaseLine
    time_loads: tuple[TimeLoad, ...] = ()

    @property
    def size(self) -> int:
        """Number of free coordinates."""
        return int(self.dof.max(initial=FIXED)) + 1

    @property
    def spatial(self) -> bool:
        """Whether it has coordinates across the track."""
        return self.axes == 3

    @cached_property
    def section(self) -> Integers:
        """Shape (all,): number of each coordinate's tension section, from 0."""
        width = 2 * self.axes
        return np.repeat([w.section for w in self.wires], [width * w.x.size for w in self.wires])

    @cached_property
    def section_starts(self) -> Integers:
        """Shape (sections + 1,): where the free coordinates of each section begin."""
        moves = self.dof >= 0
        of_free = np.zeros(self.size, dtype=np.int64)
        of_free[self.dof[moves]] = self.section[moves]
        starts: Integers = np.searchsorted(of_free, np.arange(int(self.section.max(initial=0)) + 2))
        return starts

    @cached_property
    def contact_paths(self) -> tuple[ContactPath, ...]:
        """The contact wires as pantographs meet them."""
        axes, up = self.axes, self.axes - 1
        paths = []
        for wire in self.wires:
            if not wire.contact:
                continue
            nodes = 2 * axes * (wire.first + np.arange(wire.x.size))
            index: Integers = nodes[:, None] + np.array([up, up + axes])
            lateral: Integers = nodes[:, None] + np.array([1, 1 + axes])
            paths.append(
                ContactPath(
                    x=wire.x,
                    lengths=self.cables.length[np.searchsorted(self.first, nodes[:-1])],
                    profile=self.reference[index],
                    lateral=self.reference[lateral] if self.spatial else np.zeros((wire.x.size, 2)),
                    index=index,
                    dof=self.dof[index],
                    supports=wire.supports,
                    section=wire.section,
                    irregularity=wire.irregularity,
                    across=lateral if self.spatial else lateral[:0],
                    across_dof=self.dof[lateral] if self.spatial else lateral[:0],
                )
            )
        return tuple(paths)

    def served(self, position: float) -> list[int]:
        """Numbers of the contact wires that a head meets at a place [m] along the track: the lowest ones.

        At one height, as in the middle of an overlap, they are those of the first section there.
        """
        paths = self.contact_paths
        there = [n for n, path in enumerate(paths) if path.meets(position)]
        if len({paths[n].section for n in there}) == 1:
            return there
        heights = {n: float(self.row(n, position) @ self.reference) for n in there}
        section = paths[min(there, key=heights.__getitem__)].section
        return [n for n in there if paths[n].section == section]

    @property
    def support_positions(self) -> Floats:
        """[m], shape (spans + 1,), along the track."""
        x = np.sort(np.concatenate([path.x[path.supports] for path in self.contact_paths]))
        return x[np.diff(x, prepend=-np.inf) > _SAME_PLACE]

    @cached_property
    def heights(self) -> Integers:
        """Shape (nodes of all wires,): numbers of the heights among all coordinates."""
        return np.arange(self.axes - 1, self.dof.size, 2 * self.axes)

    def name(self, coordinate: int) -> str:
        """A coordinate among all in words: wire, place, and what it is."""
        node, which = divmod(coordinate, 2 * self.axes)
        wire = next(w for w in reversed(self.wires) if w.first <= node)
        axis = ("along the track", *(("to the left",) if self.spatial else ()), "up")[which % self.axes]
        kind = "slope" if which >= self.axes else "position"
        return f"{wire.name} at {wire.x[node - wire.first]:.1f} m, {kind} {axis}"

    def spread(self, free: Floats) -> Floats:
        """From values of the free coordinates, shape (..., free), to all, 0 where they cannot move."""
        spread: Floats = np.where(self.dof >= 0, free[..., self.dof], 0.0)
        return spread

    def gather(self, values: Floats) -> Floats:
        """From forces on all coordinates, shape (..., all), to the free ones."""
        gathered: Floats = (self.transformation.T @ values.T).T
        return gathered

    @cached_property
    def transformation(self) -> Any:
        """Sparse, shape (all, free): T with q = T x."""
        from scipy.sparse import csr_matrix

        moves = np.flatnonzero(self.dof >= 0)
        entries = np.ones(moves.size), (moves, self.dof[moves])
        return csr_matrix(entries, shape=(self.dof.size, self.size))

    def out_of_balance(self, moved: Floats) -> Floats:
        """[N], shape (all,): constant forces less what the line answers to displacements ``moved``."""
        total = self.reference + moved
        index = self.elements()
        residual: Floats = self.force - self.ground_stiffness * moved - self.linear_stiffness @ moved
        values = inner_forces(self.cables, self.of_elements(total))
        residual -= np.bincount(index.ravel(), values.ravel(), minlength=residual.size)
        for springs in (self.droppers, self.arms):
            at = springs.index()
            residual += np.bincount(at.ravel(), springs.forces(total).ravel(), minlength=residual.size)
        return residual

    def row(self, wire: int, x: float, axis: int = -1) -> Floats:
        """Shape (all,): a wire's coordinate at any place [m] along the track as made of all coordinates.

        wire : its number
        axis : 0 along the track, -1 up, 1 in space to the left
        """
        row = np.zeros(self.dof.size)
        np.put(row, *self.weights(wire, x, axis))
        return row

    def weights(self, wire: int, x: float, axis: int = -1) -> tuple[Integers, Floats]:
        """Numbers and weights, shape (4,) each, of what is not 0 in :meth:`row`."""
        nodes, axes = self.wires[wire], self.axes
        e = int(np.clip(np.searchsorted(nodes.x, x, side="right") - 1, 0, nodes.x.size - 2))
        first = 2 * axes * (nodes.first + e) + axis % axes
        length = self.cables.length[np.searchsorted(self.first, 2 * axes * (nodes.first + e))]
        share = (x - nodes.x[e]) / (nodes.x[e + 1] - nodes.x[e])
        return first + axes * np.arange(4), hermite(share, length)

    def distributed(self, per_length: Floats, axis: int = -1) -> Floats:
        """[N], shape (all,): forces of a load along the wires.

        per_length : [N/m], shape (elements,)
        axis : 0 along the track, -1 up, 1 in space to the left
        """
        blocks = self.element_mass * (per_length / self.mass_per_length)[:, None, None]
        points = np.arange(self.dof.size) % (2 * self.axes) == axis % self.axes
        forces: Floats = scattered([(self.elements(), blocks)], self.dof.size) @ points.astype(float)
        return forces

    @cached_property
    def patterns(self) -> Any:
        """[N], sparse, shape (free, loads), of the loads that vary in time."""
        return (self.transformation.T @ self.time_patterns).tocsr()

    @cached_property
    def time_patterns(self) -> Any:
        """[N], sparse, shape (all, loads), of the loads that vary in time."""
        from scipy.sparse import csr_matrix, vstack

        rows = [csr_matrix(load.pattern) for load in self.time_loads]
        return vstack([csr_matrix((0, self.dof.size)), *rows]).T.tocsr()

    def signals(self, times: Floats) -> Floats:
        """Shape (loads, times), of the loads that vary in time, at times [s]."""
        found = [np.asarray(load.signal(times), dtype=float) for load in self.time_loads]
        return np.reshape(found, (-1, times.size))

    def varying(self, time: float) -> Floats:
        """[N], shape (all,): sum of the loads that vary in time, at a time [s]."""
        found = np.zeros(self.dof.size)
        for load in self.time_loads:
            found += float(load.signal(np.array([time]))[0]) * load.pattern
        return found

    def forces(self, moved: Floats, rates: Floats, time: float) -> Floats:
        """[N], shape (free,): all that accelerates the line, but for contacts.

        moved, rates : [m], [m/s], shape (all,), displacements and velocities
        time : [s]
        """
        varying = self.patterns @ self.signals(np.array([time]))[:, 0]
        total, droppers = self.reference + moved, self.droppers
        drag = self.damping() @ rates
        at, pull = droppers.index(), droppers.damper_forces(total, rates)
        drag -= np.bincount(at.ravel(), pull.ravel(), minlength=drag.size)
        found: Floats = self.gather(self.out_of_balance(moved) - drag) + varying
        return found

    def tensions(self, moved: Floats) -> list[Floats]:
        """[N], for each wire shape (nodes - 1,): tension of its elements, mean of each."""
        values = self.of_elements(self.reference + moved)
        pulls = self.cables.axial_stiffness * (mean_stretch(self.cables, values) - self.cables.rest_strain)
        return np.split(pulls, np.cumsum([wire.x.size - 1 for wire in self.wires])[:-1])

    def tangent(self, moved: Floats, *, taut: bool = True) -> Any:
        """Stiffness over the free coordinates, sparse.

        moved : shape (all,), displacements
        taut : all droppers count as taut, else slack ones are left out
        """
        total = self.reference + moved
        parts = [self._wire_part(total), *self._spring_parts(total, taut)]
        return scattered(parts, self.size, self.dof) + self.free(self.linear_stiffness)

    def _wire_part(self, total: Floats) -> tuple[Integers, Floats]:
        index = self.elements()
        return index, tangent_blocks(self.cables, self.of_elements(total))

    def _spring_parts(self, total: Floats, taut: bool) -> list[tuple[Integers, Floats]]:
        springs = [(s.index(), s.blocks(total, taut=taut)) for s in (self.droppers, self.arms)]
        return [*springs, (np.arange(self.dof.size)[:, None], self.ground_stiffness[:, None, None])]

    def wire_stiffness(self) -> Any:
        """Stiffness of the wires alone where they were installed, over all coordinates, sparse."""
        return scattered([self._wire_part(self.reference)], self.dof.size)

    def damping(self) -> Any:
        """Damping over all coordinates, without that of droppers, sparse: α M + β K of the wires, springs.

        β K is of the wires with their tension's stiffness; what supports and arms damp is given with them.
        """
        wires = self.alpha * self.wire_mass + self.beta * self.wire_stiffness()
        return (wires + self.other_damping).tocsr()

    @property
    def other_damping(self) -> Any:
        """Likewise, of springs and what else is no wire."""
        from scipy.sparse import diags

        return (diags(self.ground_damping) + self.linear_damping).tocsr()

    def elongations(self) -> Any:
        """Sparse, shape (droppers, all): each dropper's elongation with the coordinates, at rest."""
        from scipy.sparse import coo_matrix

        span, index = self.droppers.span(self.reference), self.droppers.index()
        direction = span / np.linalg.norm(span, axis=1)[:, None]
        values = np.hstack([-direction, direction])
        rows = np.repeat(np.arange(len(index)), index.shape[1])
        shape = (len(index), self.dof.size)
        return coo_matrix((values.ravel(), (rows, index.ravel())), shape=shape).tocsr()

    def taut_damping(self) -> Any:
        """Damping of all droppers, taut, over all coordinates, sparse."""
        from scipy.sparse import diags

        rows = self.elongations()
        return (rows.T @ diags(self.droppers.damping) @ rows).tocsr()

    def spring_stiffness(self) -> Any:
        """Stiffness of all but the wires at rest, droppers taut, over all coordinates, sparse."""
        return scattered(self._spring_parts(self.reference, True), self.dof.size) + self.linear_stiffness

    def free(self, matrix: Any) -> Any:
        """A matrix over all coordinates as one over the free ones."""
        return (self.transformation.T @ matrix @ self.transformation).tocsr()

    def energy(self, moved: Floats) -> float:
        """[J] stored in wires and springs, with the potential of the constant forces."""
        total = self.reference + moved
        stored = strain_energy(self.cables, self.of_elements(total)).sum()
        stored += self.droppers.energy(total) + self.arms.energy(total)
        stored += (self.ground_stiffness * moved**2).sum() / 2 + moved @ (self.linear_stiffness @ moved) / 2
        return float(stored - self.force @ moved)

    def elements(self) -> Integers:
        """Shape (elements, 4 * axes): coordinates of each cable element."""
        return self.first[:, None] + np.arange(4 * self.axes)

    def of_elements(self, values: Floats) -> Floats:
        """Values of all coordinates by element, shape (elements, 4, axes)."""
        return values[self.elements()].reshape(-1, 4, self.axes)
