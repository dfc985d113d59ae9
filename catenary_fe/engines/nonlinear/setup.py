"""From the assembled line to the arrays of a compiled run."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.factor import csr_rows, factorise, packed_factor, packed_rows
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.nonlinear.arrays import Equations, Factor, SpringArrays, Stations
from catenary_fe.engines.nonlinear.cables import Elements
from catenary_fe.engines.recorder import surfaces_of
from catenary_fe.engines.sections import Rows, parts_of
from catenary_fe.fe.cable import tangent_blocks
from catenary_fe.fe.cuts import section_part
from catenary_fe.fe.spring import FIXED, Springs
from catenary_fe.fe.system import System

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Parameters:
    """What stays the same in all runs on a line; each section's coordinates are filled up to fours."""

    system: System

    @cached_property
    def rows(self) -> Rows:
        """Places of the free coordinates."""
        return Rows.of(self.system.section_starts)

    @cached_property
    def sections(self) -> list[System]:
        """The line's tension sections, over the same coordinates."""
        count = self.rows.starts.size - 1
        return [section_part(self.system, n) for n in range(count)] if count > 1 else [self.system]

    @cached_property
    def parts(self) -> tuple[Integers, Integers, Integers]:
        """Where the rows, droppers and links of each section begin, shape (sections + 1,)."""
        section, count = self.system.section, self.rows.starts.size - 1
        springs = self.system.droppers, self.system.arms
        droppers, links = (parts_of(section[each.first], count) for each in springs)
        return self.rows.starts, droppers, links

    @cached_property
    def equations(self) -> Equations:
        """Forces; mass and damping of what is no wire, wires have theirs by element."""
        line, rows, width = self.system, self.rows, 2 * self.system.axes
        elements = _elements(line)
        return Equations(
            reference=elements.placed(by_kind(line.reference, width)),
            dof=elements.placed(by_kind(rows.number(line.dof), width).astype(np.int32), FIXED),
            elements=elements,
            droppers=_arrays(line.droppers, width),
            links=_arrays(line.arms, width),
            patterns=csr_rows(rows.rows_of(line.patterns)),
            stiffness=packed_rows(rows.matrix(line.free(self._linear_stiffness))),
            force=rows.spread(line.gather(line.force)),
            mass=packed_rows(rows.matrix(line.free(line.mass - line.wire_mass), 1.0)),
            damping=packed_rows(rows.matrix(line.free(line.other_damping))),
        )

    @cached_property
    def mass(self) -> Any:
        """[kg] over the free coordinates, sparse."""
        return self.system.free(self.system.mass)

    @property
    def _linear_stiffness(self) -> Any:
        from scipy.sparse import diags

        return diags(self.system.ground_stiffness) + self.system.linear_stiffness

    @cached_property
    def _taut_damping(self) -> Any:
        return self.system.free(self.system.damping() + self.system.taut_damping())

    @cached_property
    def stations(self) -> Stations:
        """Contact wires and heights."""
        paths, rest = self.system.contact_paths, self.system.reference[self.system.heights]
        node = [path.index[:, 0] // (2 * self.system.axes) for path in paths]
        return Stations(
            first=np.cumsum([0, *(path.x.size for path in paths)]),
            x=np.concatenate([path.x for path in paths]),
            lengths=np.concatenate([[*path.lengths, 1.0] for path in paths]),
            profile=np.concatenate([path.profile for path in paths]),
            lateral=np.concatenate([path.lateral for path in paths]),
            at=self.rows.number(np.concatenate([path.dof for path in paths])),
            across=self.rows.number(np.concatenate([path.across_dof for path in paths])),
            node=np.concatenate(node),
            supports=np.concatenate([own[path.supports] for own, path in zip(node, paths, strict=True)]),
            heights=np.arange(rest.size),
            surfaces=surfaces_of(paths),
            rest=rest,
            rest_supports=np.concatenate([path.profile[path.supports, 0] for path in paths]),
        )

    def factor(self, scheme: Scheme, moved: Floats) -> Factor:
        """Factorise the step's matrix where all coordinates are displaced like this."""
        tangent = self.system.tangent(moved)
        matrix = self.mass + scheme.g * self._taut_damping + scheme.b * tangent
        factor = factorise(self.rows.matrix(matrix, 1.0))
        return Factor(packed_factor(factor, single=True), np.zeros(factor.shape[0]))


def _elements(line: System) -> Elements:
    """The cables by their first nodes."""
    axes, cables = line.axes, line.cables
    damping = np.zeros((0, cables.length.size))
    if line.beta:
        rest = line.of_elements(line.reference)
        blocks = line.beta * tangent_blocks(cables, rest).reshape(-1, 4, axes, 4, axes)
        scale = np.stack([cables.length, *np.ones((2, cables.length.size))])
        parts = np.einsum("epkql,pe,qe->epkql", blocks[:, [2, 1, 3]][:, :, :, [2, 1, 3]], scale, scale)
        damping = parts.reshape(-1, 3 * axes, 3 * axes)[:, *np.tril_indices(3 * axes)].T
    return Elements.by_node(
        line.first // (2 * axes),
        line.alpha,
        length=cables.length,
        mass=line.mass_per_length * cables.length,
        axial=cables.axial_stiffness,
        bending=cables.bending_stiffness,
        rest=1 + cables.rest_strain,
        damping=damping.astype(np.float32),
    )


def by_kind(values: NDArray[Any], width: int) -> NDArray[Any]:
    """Values of all coordinates, which follow one another node by node, as shape (width, nodes)."""
    return np.ascontiguousarray(values.reshape(-1, width).T)


def _arrays(springs: Springs, width: int) -> SpringArrays:
    return SpringArrays(
        springs.first // width,
        springs.last // width,
        springs.pivot,
        springs.length,
        springs.stiffness,
        springs.damping,
    )
