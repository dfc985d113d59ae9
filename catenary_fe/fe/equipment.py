"""Equipment within the spans as masses at nodes, and as mass and stiffness of elements."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.mesh import Mesh
from catenary_fe.layout import Catenary
from catenary_fe.layout.equipment import Equipment

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]


def _carried(catenary: Catenary, mesh: Mesh) -> Iterator[tuple[Equipment, int, float]]:
    """Each piece with a wire that carries it, by its number, and its mass [kg] there."""
    for item in catenary.equipment:
        count = mesh.contact_wires
        wires = range(count) if item.wire == "contact wire" else range(count, count + 1)
        for wire in wires:
            yield item, wire, item.mass / len(wires)


def add_to_elements(catenary: Catenary, mesh: Mesh, name: str, values: list[Floats]) -> None:
    """What equipment makes of a parameter of the wires' elements, by its name; changes ``values``.

    values : for each wire shape (elements,): a mass [kg/m] is added, a bending stiffness [N m²] replaced
    """
    for item, wire, mass in _carried(catenary, mesh):
        x = mesh.wires[wire].x
        middle, (begin, end) = (x[:-1] + x[1:]) / 2, item.ends(catenary)
        covered = (middle > begin) & (middle < end)
        if name == "mass_per_length" and item.length:
            values[wire][covered] += mass / item.length
        elif name == "bending_stiffness" and item.bending_stiffness is not None:
            values[wire][covered] = item.bending_stiffness


def lumped(catenary: Catenary, mesh: Mesh) -> tuple[Integers, Floats]:
    """Masses at points: numbers of their nodes among all, and what each has [kg]; shape (masses,) both."""
    found = [
        (int(mesh.first_nodes[wire] + np.abs(mesh.wires[wire].x - item.middle(catenary)).argmin()), mass)
        for item, wire, mass in _carried(catenary, mesh)
        if not item.length
    ]
    nodes, masses = zip(*found, strict=True) if found else ((), ())
    return np.array(nodes, dtype=np.int64), np.array(masses, dtype=float)
