"""What sits on the wires, and what has worn off: masses at nodes, mass and stiffness of elements."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.mesh import Mesh
from catenary_fe.layout import Catenary
from catenary_fe.layout.equipment import Equipment
from catenary_fe.layout.installed import broken_droppers

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


def wear_elements(catenary: Catenary, mesh: Mesh, name: str, values: list[Floats]) -> None:
    """What is left of a parameter of the contact wires' elements, by its name; changes ``values``.

    values : for each wire shape (elements,): mass [kg/m] and EA [N] with the area, EI [N m²] with its square
    """
    power = {"mass_per_length": 1, "axial_stiffness": 1, "bending_stiffness": 2}.get(name)
    if power is None or not catenary.wear:
        return
    for wire in range(mesh.contact_wires):
        x = mesh.wires[wire].x
        left = np.ones(x.size - 1)
        for wear in catenary.wear:
            if wear.contact_wire in (None, wire + 1):
                begin, end = wear.ends(catenary)
                covered = np.clip(np.minimum(x[1:], end) - np.maximum(x[:-1], begin), 0, None) / np.diff(x)
                left -= (1 - wear.area_left) * covered
        values[wire] *= left**power


def lumped(catenary: Catenary, mesh: Mesh) -> tuple[Integers, Floats]:
    """Masses at points: numbers of their nodes among all, and what each has [kg]; shape (masses,) both.

    Of equipment, and of the clamps that broken droppers left.
    """
    found = [
        (int(mesh.first_nodes[wire] + np.abs(mesh.wires[wire].x - item.middle(catenary)).argmin()), mass)
        for item, wire, mass in _carried(catenary, mesh)
        if not item.length
    ]
    broken = broken_droppers(catenary)
    for clamps, left in zip(mesh.loose, (broken.lower, broken.upper), strict=True):
        found += zip(mesh.nodes(clamps).tolist(), left.tolist(), strict=True)
    nodes, masses = zip(*found, strict=True) if found else ((), ())
    return np.array(nodes, dtype=np.int64), np.array(masses, dtype=float)
