"""Nodes along the wires: on every clamp and support, and close where the wire kinks."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import Catenary, InputError
from catenary_fe.layout.arguments import number
from catenary_fe.layout.equipment import stations
from catenary_fe.layout.installed import broken_droppers
from catenary_fe.layout.parameters import changed_by_copy

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
MOST_ELEMENTS = 200_000  # of a wire: 200 km at 1 m, some gigabytes

_ROUNDING = 1e-6  # [m] stations closer than this are one
_CLAMP_ROOM = 0.05  # [m] a dropper this close to a stitch wire's clamp hangs on the messenger wire


@changed_by_copy
@dataclass(frozen=True, kw_only=True)
class MeshSettings:
    """Element lengths [m]. The defaults come from the study in ``models/studies/convergence.py``.

    A wire kinks at clamps and supports, within a length of √(EI/T), about 0.1 m: elements start there with
    the length ``at_clamps`` and grow away from them up to the largest one.

    contact_wire_element : largest, of the wire that the pantograph touches
    messenger_wire_element : largest, of the messenger wire and of stitch wires
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
            number(f"mesh: {name}", getattr(self, name), "m", above=0.0)
        number("mesh: growth", self.growth, least=1.0)

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
    """Stations of one wire's nodes.

    x : [m], shape (nodes,), ascending
    supports : shape (spans + 1,), node number at each support; empty for a stitch wire
    """

    x: Floats
    supports: Integers


@dataclass(frozen=True)
class Clamps:
    """Where the droppers are clamped at one of their ends.

    wire : shape (droppers,), number of the wire in the mesh
    node : shape (droppers,), number of the node on that wire
    """

    wire: Integers
    node: Integers

    def on(self, wire: int) -> Integers:
        """Numbers of the droppers that are clamped on a wire."""
        return np.flatnonzero(self.wire == wire)


@dataclass(frozen=True)
class Mesh:
    """Meshes of all wires of a catenary: contact wires, then the messenger wire if any, then stitch wires.

    contact_wires : how many there are
    lower, upper : where the droppers are clamped, below on a contact wire, above on the messenger or a
        stitch wire
    stitch_ends : shape (stitch wires, 2), nodes of the messenger wire that stitch wires are clamped on
    messengers : how many messenger wires there are: one a tension section, or none
    loose : lower and upper clamps that broken droppers left on the wires; empty on a line of several
        sections, whose sections have them
    """

    wires: tuple[WireMesh, ...]
    contact_wires: int
    lower: Clamps
    upper: Clamps
    stitch_ends: Integers
    messengers: int = 1
    loose: tuple[Clamps, ...] = ()

    @property
    def contact(self) -> WireMesh:
        """The contact wire; of two, the right one."""
        return self.wires[0]

    @property
    def messenger(self) -> WireMesh | None:
        """The messenger wire; None without one."""
        return self.wires[self.contact_wires] if self.messengers else None

    @property
    def first_stitch(self) -> int:
        """Number of the first stitch wire among all wires, whether there is one or not."""
        return self.contact_wires + self.messengers

    @cached_property
    def first_nodes(self) -> Integers:
        """Shape (wires + 1,): number of each wire's first node among all nodes, and their count."""
        return np.cumsum([0, *(wire.x.size for wire in self.wires)])

    def wire_name(self, number: int) -> str:
        """A wire in words, by its number."""
        if number < self.contact_wires:
            return "contact wire"
        return "messenger wire" if number < self.first_stitch else "stitch wire"

    def nodes(self, clamps: Clamps) -> Integers:
        """Shape (droppers,): numbers of clamped nodes among the nodes of all wires."""
        numbers: Integers = self.first_nodes[clamps.wire] + clamps.node
        return numbers


def make_mesh(catenary: Catenary, settings: MeshSettings) -> Mesh:
    """Mesh all wires with nodes at their droppers, supports and clamps.

    Raises InputError for a line so long, or elements so short, that no machine could take them.
    """
    at, low, below, hangs = _clamped(catenary)
    contact_wires = len(catenary.contact_wire_offsets)
    above = np.full(at.size, contact_wires)
    stitched = list(catenary.stitched_supports)
    middles, halves = catenary.support_positions[stitched], catenary.stitch_wire_lengths[stitched] / 2
    for i, (middle, half) in enumerate(zip(middles, halves, strict=True)):
        above[np.abs(at - middle) < half - _CLAMP_ROOM] = contact_wires + 1 + i
    ends = np.stack([middles - halves, middles + halves], axis=1)
    extra = stations(catenary, "contact wire")
    lines = [
        _line_mesh(catenary, np.append(low[below == i], extra), settings, settings.contact_wire_element)
        for i in range(contact_wires)
    ]
    hangers = [at[above == contact_wires], ends.ravel(), stations(catenary, "messenger wire")]
    if catenary.messenger_wire:
        lines.append(_line_mesh(catenary, np.concatenate(hangers), settings, settings.messenger_wire_element))
    for i, pair in enumerate(ends):
        on_it = at[above == contact_wires + 1 + i]
        x = _stations(np.concatenate([pair, on_it]), settings, settings.messenger_wire_element)
        lines.append(WireMesh(x, np.array([], dtype=np.int64)))
    return Mesh(
        wires=tuple(lines),
        contact_wires=contact_wires,
        lower=_clamps(lines, below[hangs], low[hangs]),
        upper=_clamps(lines, above[hangs], at[hangs]),
        loose=tuple(_clamps(lines, wires[~hangs], x[~hangs]) for wires, x in ((below, low), (above, at))),
        stitch_ends=np.searchsorted(lines[-1 if not ends.size else contact_wires].x, ends - _ROUNDING),
        messengers=1 if catenary.messenger_wire else 0,
    )


def _clamped(catenary: Catenary) -> tuple[Floats, Floats, Integers, NDArray[np.bool_]]:
    """Of all droppers with clamps on the wires: places [m] above and below, contact wire, whether they hang.

    Those that hang come first, then the broken ones.
    """
    low, wires = catenary.lower_clamp_positions, catenary.dropper_contact_wires
    broken = broken_droppers(catenary)
    at = np.concatenate([catenary.dropper_positions, broken.x])
    hangs = np.arange(at.size) < low.size
    return at, np.concatenate([low, broken.x]), np.concatenate([wires, broken.contact_wires]), hangs


def _clamps(lines: list[WireMesh], wires: Integers, at: Floats) -> Clamps:
    node = np.zeros(at.size, dtype=np.int64)
    for wire in np.unique(wires).tolist():
        node[wires == wire] = np.searchsorted(lines[wire].x, at[wires == wire] - _ROUNDING)
    return Clamps(wires, node)


def _line_mesh(catenary: Catenary, clamps: Floats, settings: MeshSettings, largest: float) -> WireMesh:
    if catenary.length > MOST_ELEMENTS * largest:
        raise InputError(
            f"mesh: {catenary.length:g} m of wire in elements of {largest:g} m: more than"
            f" {MOST_ELEMENTS:,} elements; take longer elements, and look for a span length that is a slip of"
            " the pen"
        )
    x = _stations(np.concatenate([catenary.support_positions, clamps]), settings, largest)
    return WireMesh(x=x, supports=np.searchsorted(x, catenary.support_positions - _ROUNDING))


def _stations(fixed: Floats, settings: MeshSettings, largest: float) -> Floats:
    """Nodes on the fixed stations and, graded, between them."""
    fixed = np.unique(fixed)
    fixed = fixed[np.concatenate([[True], np.diff(fixed) > _ROUNDING])]
    return _between(tuple(fixed.tolist()), min(settings.at_clamps, largest), settings.growth, largest)


@lru_cache(maxsize=32)  # neighbouring designs have the same ones
def _between(fixed: tuple[float, ...], first: float, growth: float, largest: float) -> Floats:
    parts = [a + _graded(b - a, first, growth, largest) for a, b in pairwise(fixed)]
    stations = np.append(np.concatenate(parts), fixed[-1])
    stations.setflags(write=False)
    return stations


def _graded(length: float, first: float, growth: float, largest: float) -> Floats:
    """Stations from 0 to short of ``length``, symmetric, elements growing from both ends."""
    half: list[float] = []
    size, reach = first, first
    while reach < length / 2:
        half.append(size)
        size = min(size * growth, largest)
        reach += size
    if half and length - 2 * sum(half) < half[-1]:
        half.pop()  # what is left in the middle must not be a sliver
    rest = length - 2 * sum(half)
    middle = max(1, int(np.ceil(rest / largest - 1e-9)))
    sizes = np.array([*half, *[rest / middle] * middle, *half[::-1]])
    return np.concatenate([[0.0], np.cumsum(sizes)[:-1]])
