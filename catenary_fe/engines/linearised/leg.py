"""Some sections of a linearised line alone, as arrays that compiled steps take for a line."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import Records, Wires, Work
from catenary_fe.engines.linearised.arrays import ComplianceColumns, Line, Operator, StretchCoupling
from catenary_fe.engines.linearised.setup import Setup, Slices
from catenary_fe.engines.sections import csr_part, factor_part, moved, packed_part

Integers = NDArray[np.int64]


@dataclass(frozen=True)
class Leg:
    """A part of a line for one slot."""

    sections: tuple[int, int]
    at: Slices[slice]
    line: Line
    operator: Operator

    @classmethod
    def of(cls, setup: Setup, sections: tuple[int, int]) -> Leg:
        """From the first section to before the last."""
        a, b = sections
        at = Slices(*(slice(int(starts[a]), int(starts[b])) for starts in setup.parts))
        first, end = at.rows.start, at.rows.stop
        whole = setup.operator
        operator = whole._replace(
            factor=factor_part(whole.factor, first, end),
            stiffness=packed_part(whole.stiffness, first, end),
            rest=packed_part(whole.rest, first, end),
        )
        return cls(sections, at, _line(setup.line, at), operator)

    def wires(self, wires: Wires) -> Wires:
        """Its part of the state."""
        return Wires(*(array[self.at.rows] for array in wires))

    def work(self, work: Work) -> Work:
        """Its part of the room of a step; active droppers count from its first one."""
        return work._replace(
            slack=work.slack[:, self.at.droppers],
            active=work.active[:, self.at.droppers],
            arm_force=work.arm_force[:, self.at.links],
            tension=work.tension[self.at.gaps],
        )

    def records(self, records: Records) -> Records:
        """Its part of the history; supports and nodes elsewhere are left out by their numbers."""
        return records._replace(
            droppers=records.droppers[:, self.at.droppers],
            shortening=records.shortening[:, self.at.droppers],
            shortened=records.shortened[:, self.at.droppers],
            change=records.change[:, self.at.gaps],
            changed=records.changed[:, self.at.gaps],
        )

    def take_over(self, work: Work, before: Leg) -> None:
        """Keep the active droppers that are also here, numbered anew."""
        active = before.work(work).active[0, : work.active_count[0]] + before.at.droppers.start
        own = active - self.at.droppers.start
        kept = own[(own >= 0) & (active < self.at.droppers.stop)]
        work.active_count[0] = kept.size
        self.work(work).active[0, : kept.size] = kept


def _line(line: Line, at: Slices[slice]) -> Line:
    first, end = at.rows.start, at.rows.stop
    both = slice(2 * at.links.start, 2 * at.links.stop)
    stretch, links = line.stretch, line.links
    mine = (stretch.gap >= at.gaps.start) & (stretch.gap < at.gaps.stop)
    return line._replace(
        at=moved(line.at, first, end),
        across=moved(line.across, first, end),
        contact_compliance=_columns(line.contact_compliance, slice(None), first),
        rows=csr_part(line.rows, at.droppers, first),
        k=line.k[at.droppers],
        d=line.d[at.droppers],
        tension=line.tension[at.droppers],
        dropper_compliance=_columns(line.dropper_compliance, at.droppers, first),
        links=links._replace(
            at=links.at[at.links] - first,
            span=links.span[at.links],
            length=links.length[at.links],
            k=links.k[at.links],
            compliance=_columns(links.compliance, both, first),
        ),
        stretch=StretchCoupling(
            moved(stretch.at[mine], first, end),
            stretch.length[mine],
            stretch.gap[mine] - at.gaps.start,
            stretch.stiffness[mine],
        ),
        load=line.load[at.rows],
        patterns=csr_part(line.patterns, at.rows, 0),
        supports=moved(line.supports, first, end),
        heights=moved(line.heights, first, end),
        tensions=line.tensions[at.gaps] - first,
    )


def _columns(columns: ComplianceColumns, which: slice, first: int) -> ComplianceColumns:
    return ComplianceColumns(columns.first[which] - first, columns.value[which])
