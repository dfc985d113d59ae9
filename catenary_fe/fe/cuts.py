"""Parts of an assembled line, over the same coordinates."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import Cables
from catenary_fe.fe.system import System

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def part_between(system: System, x: Floats, begin: float, end: float) -> System:
    """The same coordinates with the elements, droppers and arms of a part of the line alone.

    x : [m], shape (all,), stations of the coordinates
    begin, end : [m]
    """
    inside = (x >= begin) & (x <= end)
    kept = inside[system.first] & inside[_last(system)]
    return replace(
        only(system, kept),
        droppers=system.droppers.only(inside[system.droppers.first]),
        arms=system.arms.only(inside[system.arms.first]),
    )


def elements_across(system: System, x: Floats, cut: float) -> Integers:
    """Numbers of the elements that begin before a cut [m] and end behind it.

    x : [m], shape (all,), stations of the coordinates
    """
    return np.flatnonzero((x[system.first] <= cut) & (x[_last(system)] > cut))


def section_part(system: System, section: int) -> System:
    """The same coordinates with the elements, springs and constant forces of a tension section alone."""
    from scipy.sparse import diags

    mine = system.section == section
    own = diags(mine.astype(float))
    return replace(
        only(system, mine[system.first]),
        droppers=system.droppers.only(mine[system.droppers.first]),
        arms=system.arms.only(mine[system.arms.first]),
        ground_stiffness=system.ground_stiffness * mine,
        linear_stiffness=(own @ system.linear_stiffness @ own).tocsr(),
        force=system.force * mine,
    )


def only(system: System, kept: NDArray[np.bool_] | Integers) -> System:
    """The same coordinates with some of the elements: their numbers, or shape (elements,) whether."""
    cables = Cables(*(values[kept] for values in vars(system.cables).values()))
    return replace(
        system,
        first=system.first[kept],
        cables=cables,
        mass_per_length=system.mass_per_length[kept],
        element_mass=system.element_mass[kept],
    )


def _last(system: System) -> Integers:
    """Shape (elements,): the last coordinate of each element."""
    return system.first + 4 * system.axes - 1
