"""Some sections of a line alone, as arrays that compiled steps take for a line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import Records, Wires
from catenary_fe.engines.nonlinear.arrays import (
    EnergyBalance,
    Equations,
    Factor,
    Motion,
    Slack,
    SpringArrays,
    Stations,
)
from catenary_fe.engines.nonlinear.setup import Parameters
from catenary_fe.engines.nonlinear.state import State
from catenary_fe.engines.sections import csr_part, factor_part, moved, packed_part
from catenary_fe.fe.spring import FIXED

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


class Arrays(NamedTuple):
    """What of a run a leg's steps change."""

    wires: Wires
    flat: Wires
    motion: Motion
    slack: Slack
    energy: EnergyBalance
    records: Records


@dataclass(frozen=True)
class Leg:
    """A part of a line.

    rows, droppers : where its free coordinates and droppers are among those of the line
    """

    sections: tuple[int, int]
    rows: slice
    droppers: slice
    equations: Equations
    stations: Stations

    @classmethod
    def of(cls, parameters: Parameters, sections: tuple[int, int]) -> Leg:
        """From the first section to before the last."""
        a, b = sections
        section = parameters.system.section[parameters.system.heights]
        nodes = np.flatnonzero((section >= a) & (section < b))
        place = np.full(section.size + 1, FIXED)
        place[nodes] = np.arange(nodes.size)
        rows, droppers, links = (slice(int(starts[a]), int(starts[b])) for starts in parameters.parts)
        stations = parameters.stations
        return cls(
            sections,
            rows,
            droppers,
            _equations(parameters.equations, nodes, place, rows, droppers, links),
            stations._replace(
                at=moved(stations.at, rows.start, rows.stop),
                across=moved(stations.across, rows.start, rows.stop),
                node=place[stations.node],
                supports=place[stations.supports],
                heights=place[stations.heights],
            ),
        )

    def factor(self, factor: Factor) -> Factor:
        """Its part of the step's matrix."""
        first, end = self.rows.start, self.rows.stop
        return Factor(factor_part(factor.packed, first, end), factor.window[self.rows])

    def arrays(self, state: State, records: Records) -> Arrays:
        """Its part of the run: views."""
        wires = Wires(*(array[self.rows] for array in state.wires))
        motion, slack, energy = state.motion, state.slack, state.energy
        return Arrays(
            wires,
            Wires(*(array.reshape(-1) for array in wires)),
            Motion(
                q=motion.q[self.rows],
                v=motion.v[self.rows],
                residual=motion.residual[self.rows],
                before=motion.before[self.rows],
                room=motion.room,
            ),
            Slack(
                lack=slack.lack[self.droppers],
                row=slack.row[self.droppers],
                at=moved(slack.at[self.droppers], self.rows.start, self.rows.stop),
                column=slack.column[self.droppers],
                first=slack.first[self.droppers],
                width=slack.width[self.droppers],
            ),
            energy._replace(
                **{name: getattr(energy, name)[self.rows] for name in ("q", "drag")},
                **{
                    name: getattr(energy, name)[self.droppers]
                    for name in ("damper", "span", "new_damper", "new_span")
                },
            ),
            records._replace(droppers=records.droppers[:, self.droppers]),
        )

    def take_over(self, state: State, before: Leg) -> None:
        """Number anew what the energy balance keeps of contacts; compliances are found again."""
        at = state.energy.at
        at[at >= 0] += before.rows.start - self.rows.start
        state.slack.width[:] = 0


def _equations(
    whole: Equations,
    nodes: Integers,
    place: Integers,
    rows: slice,
    droppers: slice,
    links: slice,
) -> Equations:
    first, end, elements = rows.start, rows.stop, whole.elements.at(nodes)
    return Equations(
        reference=elements.placed(whole.reference[:, nodes]),
        dof=elements.placed(moved(whole.dof[:, nodes].astype(np.int64), first, end).astype(np.int32), FIXED),
        elements=elements,
        droppers=_springs(whole.droppers, droppers, place),
        links=_springs(whole.links, links, place),
        force=whole.force[rows],
        patterns=csr_part(whole.patterns, rows, 0),
        stiffness=packed_part(whole.stiffness, first, end),
        mass=packed_part(whole.mass, first, end),
        damping=packed_part(whole.damping, first, end),
    )


def _springs(springs: SpringArrays, which: slice, place: Integers) -> SpringArrays:
    return SpringArrays(
        first=place[springs.first[which]],
        last=place[springs.last[which]],
        pivot=springs.pivot[which],
        length=springs.length[which],
        k=springs.k[which],
        d=springs.d[which],
    )
