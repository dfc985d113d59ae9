"""Nodes along the wires: on every clamp and support, and close where the wire kinks."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from catenary_fe.system import Catenary, InputError

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
MOST_ELEMENTS = 200_000  # of a wire: 200 km at 1 m, some gigabytes


@dataclass(frozen=True, kw_only=True)
class MeshSettings:
    """Element lengths [m]. The defaults come from the study in ``models/studies/convergence.py``.

    A wire kinks at clamps and supports, within a length of √(EI/T), about 0.1 m: elements start there with
    the length ``at_clamps`` and grow away from them up to the largest one.

    contact_wire_element : largest, of the wire that the pantograph touches
    messenger_wire_element : largest
    at_clamps : next to droppers and supports
    growth : ratio of neighbouring lengths

    Raises InputError for lengths that are not positive and ratios below 1.
    """

    contact_wire_element: float = 1.3
    messenger_wire_element: float = 2.0
    at_clamps: float = 0.5
    growth: float = 2.0

    def __post_init__(self) -> None:
        for name in ("contact_wire_element", "messenger_wire_element", "at_clamps"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise InputError(f"mesh: {name} = {value!r} m: must be a positive length")
        if not (np.isfinite(self.growth) and self.growth >= 1):
            raise InputError(f"mesh: growth = {self.growth!r}: must be a ratio of at least 1")

    def halved(self) -> MeshSettings:
        """The same mesh with elements half as long."""
        return MeshSettings(
            contact_wire_element=self.contact_wire_element / 2,
            messenger_wire_element=self.messenger_wire_element / 2,
            at_clamps=self.at_clamps / 2,
            growth=self.growth,
        )


@dataclass(frozen=True)
class WireMesh:
    """Stations of one wire's nodes, and which of them carry droppers and supports.

    x : [m], shape (nodes,), ascending
    droppers : shape (droppers,), node number at each dropper
    supports : shape (spans + 1,), node number at each support
    """

    x: Floats
    droppers: Integers
    supports: Integers


@dataclass(frozen=True)
class Mesh:
    """Meshes of the two wires of a catenary."""

    contact: WireMesh
    messenger: WireMesh


def make_mesh(catenary: Catenary, settings: MeshSettings) -> Mesh:
    """Mesh both wires with nodes at all droppers and supports.

    Raises InputError for a line so long, or elements so short, that no machine could take them.
    """
    return Mesh(
        contact=_wire_mesh(catenary, settings, settings.contact_wire_element),
        messenger=_wire_mesh(catenary, settings, settings.messenger_wire_element),
    )


def _wire_mesh(catenary: Catenary, settings: MeshSettings, largest: float) -> WireMesh:
    supports, droppers = catenary.support_positions, catenary.dropper_positions
    if catenary.length > MOST_ELEMENTS * largest:
        raise InputError(
            f"mesh: {catenary.length:g} m of wire in elements of {largest:g} m: more than"
            f" {MOST_ELEMENTS:,} elements; take longer elements, and look for a span length that is a slip of"
            " the pen"
        )
    fixed = np.unique(np.concatenate([supports, droppers]))
    parts = [
        a + _graded(b - a, min(settings.at_clamps, largest), settings.growth, largest)
        for a, b in pairwise(fixed)
    ]
    x = np.append(np.concatenate(parts), fixed[-1])
    return WireMesh(x=x, droppers=np.searchsorted(x, droppers), supports=np.searchsorted(x, supports))


def _graded(length: float, first: float, growth: float, largest: float) -> Floats:
    """Stations from 0 to short of ``length``, symmetric, elements growing from both ends."""
    half: list[float] = []
    while sum(half) + (size := min(first * growth ** len(half), largest)) < length / 2:
        half.append(size)
    if half and length - 2 * sum(half) < half[-1]:
        half.pop()  # what is left in the middle must not be a sliver
    rest = length - 2 * sum(half)
    middle = max(1, int(np.ceil(rest / largest - 1e-9)))
    sizes = np.array([*half, *[rest / middle] * middle, *half[::-1]])
    return np.concatenate([[0.0], np.cumsum(sizes)[:-1]])
