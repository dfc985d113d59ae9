"""Which tension sections a run computes at a time, and what it records of the others.

Nothing but a pantograph connects two sections: one is at rest until the first pantograph comes, and nothing
that it does reaches any after the last one has left. So a run computes those alone that pantographs are on,
and its cost grows with the length of the line, not with the square.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import CsrRows, PackedFactor, PackedRows
from catenary_fe.fe.contact import Contact, ContactPath
from catenary_fe.fe.spring import FIXED

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
_GROUP = 4  # rows that compiled loops take at once
_FILLED = 8  # of which as many coordinates are a multiple, for loops that take these at once


@dataclass(frozen=True)
class Rows:
    """Places of a line's coordinates where those of each section are filled up to a multiple of eight.

    place : shape (coordinates,)
    starts : shape (sections + 1,), where each section's begin
    """

    place: Integers
    starts: Integers

    @classmethod
    def of(cls, starts: Integers) -> Rows:
        """From where each section's coordinates begin as they are numbered on the line."""
        counts = np.diff(starts)
        filled = np.cumsum([0, *(-(-counts // _FILLED) * _FILLED)])
        return cls(np.concatenate([n + np.arange(m) for n, m in zip(filled, counts, strict=False)]), filled)

    @property
    def size(self) -> int:
        """With the idle ones."""
        return int(self.starts[-1])

    def number(self, index: Integers) -> Integers:
        """Numbers on the line as places; FIXED stays."""
        return np.append(self.place, FIXED)[index]

    def spread(self, values: Floats) -> Floats:
        """Values of the coordinates, shape (..., coordinates), with zeros for idle ones."""
        found = np.zeros((*values.shape[:-1], self.size))
        found[..., self.place] = values
        return found

    def rows_of(self, matrix: Any) -> Any:
        """A sparse matrix with rows of the coordinates, with empty ones for idle coordinates."""
        return self._selection @ matrix

    @property
    def _selection(self) -> Any:
        from scipy.sparse import csr_matrix

        entries = np.ones(self.place.size), (self.place, np.arange(self.place.size))
        return csr_matrix(entries, shape=(self.size, self.place.size))

    def matrix(self, matrix: Any, idle: float = 0.0) -> Any:
        """A matrix over the coordinates, sparse, with this on the diagonal of idle ones."""
        from scipy.sparse import csr_matrix

        entries = matrix.tocoo()
        empty = np.setdiff1d(np.arange(self.size), self.place) if idle else self.place[:0]
        values = np.append(entries.data, np.full(empty.size, idle))
        at = [np.append(self.place[index], empty) for index in (entries.row, entries.col)]
        return csr_matrix((values, at), shape=(self.size, self.size))


def sections_met(
    paths: Sequence[ContactPath], contacts: Sequence[Contact], begin: float, end: float
) -> tuple[int, int]:
    """The sections that contacts are on: the first, and the one after the last; those between two count.

    begin, end : [m] that the pantographs have run, at the first moment and at the last
    """
    found = [
        paths[contact.wire].section
        for contact in contacts
        if paths[contact.wire].x[0] <= contact.position + end
        and contact.position + begin <= paths[contact.wire].x[-1]
    ]
    return (min(found), max(found) + 1) if found else (0, paths[-1].section + 1)


class Computed:
    """Steps in which a run computed each section.

    steps : shape (sections, 2), the first and the last one; none: the last is 0
    """

    def __init__(self, sections: int) -> None:
        self.steps: Integers = np.zeros((sections, 2), dtype=np.int64)

    def add(self, sections: tuple[int, int], before: int, after: int) -> None:
        """Take the steps that lead from one number to another."""
        for section in range(*sections):
            if not self.steps[section, 1]:
                self.steps[section, 0] = before + 1
            self.steps[section, 1] = after

    def hold(self, values: Floats, of: Integers, steps: Integers) -> None:
        """Fill records with their first value until a section is computed, with their last one afterwards.

        values : shape (items, records)
        of : shape (items,), section of each
        steps : shape (records,), at whose ends they were taken
        """
        for row, section in zip(values, of.tolist(), strict=True):
            first, last = np.searchsorted(steps, self.steps[section] + np.array([0, 1]))
            row[1:first], row[last:] = row[0], row[last - 1]


def packed_part(rows: PackedRows, first: int, end: int) -> PackedRows:
    """Rows of some sections alone, as rows of their own."""
    if first == 0 and end == _GROUP * (rows.start.size - 1):
        return rows  # in each block of steps of a run on one section
    start = rows.start[first // _GROUP : end // _GROUP + 1]
    entries = slice(int(start[0]), int(start[-1]))
    return PackedRows(start - start[0], rows.column[entries] - np.uint32(first), rows.value[entries])


def factor_part(factor: PackedFactor, first: int, end: int) -> PackedFactor:
    """Likewise of a factor."""
    return PackedFactor(
        packed_part(factor.lower, first, end),
        packed_part(factor.upper, first, end),
        factor.inner[first // _GROUP : end // _GROUP],
    )


def csr_part(rows: CsrRows, which: slice, first: int) -> CsrRows:
    """Some rows, with columns that count from ``first``."""
    start = rows.start[which.start : which.stop + 1]
    entries = slice(int(start[0]), int(start[-1]))
    return CsrRows(start - start[0], rows.column[entries] - np.uint32(first), rows.value[entries])


def moved(index: Integers, first: int, end: int) -> Integers:
    """Numbers of coordinates that count from ``first``; FIXED for what is not before ``end`` or was so."""
    return np.where((index >= first) & (index < end), index - first, FIXED)


def parts_of(of: Integers, sections: int) -> Integers:
    """Shape (sections + 1,): where the items of each section begin; ``of`` never falls."""
    return np.searchsorted(of, np.arange(sections + 1))
