"""Nodes along the wires: on every clamp and support, and close where the wire kinks."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.system import Catenary, InputError

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class MeshSettings:
    """Largest element lengths. The defaults come from the study in ``models/studies/convergence.py``.

    contact_wire_element : [m] of the wire that the pantograph touches
    messenger_wire_element : [m]

    Raises InputError for lengths that are not positive.
    """

    contact_wire_element: float = 1.0
    messenger_wire_element: float = 2.0

    def __post_init__(self) -> None:
        for name in ("contact_wire_element", "messenger_wire_element"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0):
                raise InputError(f"mesh: {name} = {value!r} m: must be a positive length")

    def halved(self) -> MeshSettings:
        """The same mesh with elements half as long."""
        return MeshSettings(
            contact_wire_element=self.contact_wire_element / 2,
            messenger_wire_element=self.messenger_wire_element / 2,
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
    """Mesh both wires with nodes at all droppers and supports."""
    return Mesh(
        contact=_wire_mesh(catenary, settings.contact_wire_element),
        messenger=_wire_mesh(catenary, settings.messenger_wire_element),
    )


def _wire_mesh(catenary: Catenary, largest: float) -> WireMesh:
    supports, droppers = catenary.support_positions, catenary.dropper_positions
    fixed = np.unique(np.concatenate([supports, droppers]))
    x = np.concatenate([_subdivide(a, b, largest) for a, b in zip(fixed[:-1], fixed[1:], strict=True)])
    x = np.append(x, fixed[-1])
    return WireMesh(x=x, droppers=np.searchsorted(x, droppers), supports=np.searchsorted(x, supports))


def _subdivide(start: float, end: float, largest: float) -> Floats:
    count = max(1, int(np.ceil((end - start) / largest - 1e-9)))
    return np.linspace(start, end, count + 1)[:-1]
