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
from catenary_fe.fe.cuts import section_part
from catenary_fe.fe.spring import Springs
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
        """Forces, mass and damping."""
        line, cables, rows = self.system, self.system.cables, self.rows
        return Equations(
            reference=line.reference,
            dof=rows.number(line.dof),
            elements=Elements(
                line.first,
                cables.length,
                cables.axial_stiffness,
                cables.bending_stiffness,
                1 + cables.rest_strain,
            ),
            droppers=_arrays(line.droppers),
            links=_arrays(line.arms),
            patterns=csr_rows(rows.rows_of(line.patterns)),
            stiffness=packed_rows(rows.matrix(line.free(self._linear_stiffness))),
            force=rows.spread(line.gather(line.force)),
            mass=packed_rows(rows.matrix(self.mass, 1.0)),
            damping=packed_rows(rows.matrix(line.free(self._damping))),
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
    def _damping(self) -> Any:
        return self.system.damping()

    @cached_property
    def _taut_damping(self) -> Any:
        return self.system.free(self._damping + self.system.taut_damping())

    @cached_property
    def stations(self) -> Stations:
        """Contact wires and heights."""
        paths, rest = self.system.contact_paths, self.system.reference[self.system.heights]
        return Stations(
            first=np.cumsum([0, *(path.x.size for path in paths)]),
            x=np.concatenate([path.x for path in paths]),
            lengths=np.concatenate([[*path.lengths, 1.0] for path in paths]),
            profile=np.concatenate([path.profile for path in paths]),
            lateral=np.concatenate([path.lateral for path in paths]),
            at=self.rows.number(np.concatenate([path.dof for path in paths])),
            across=self.rows.number(np.concatenate([path.across_dof for path in paths])),
            left=np.concatenate([path.across for path in paths]),
            supports=np.concatenate([path.index[path.supports, 0] for path in paths]),
            heights=self.system.heights,
            surfaces=surfaces_of(paths),
            rest=rest,
            rest_supports=np.concatenate([path.profile[path.supports, 0] for path in paths]),
        )

    def factor(self, scheme: Scheme, moved: Floats) -> Factor:
        """Factorise the step's matrix where all coordinates are displaced like this."""
        tangent = self.system.tangent(moved)
        matrix = self.mass + scheme.g * self._taut_damping + scheme.b * tangent
        factor = factorise(self.rows.matrix(matrix, 1.0))
        return Factor(packed_factor(factor), np.zeros(factor.shape[0]))


def _arrays(springs: Springs) -> SpringArrays:
    return SpringArrays(
        springs.first, springs.last, springs.pivot, springs.length, springs.stiffness, springs.damping
    )
