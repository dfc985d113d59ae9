"""Energy of a model, and what is done on it and lost in it while it runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.contact import locate
from catenary_fe.engines.exudyn.model import Model
from catenary_fe.engines.exudyn.pantograph import ContactItems, PantographItems
from catenary_fe.fe.cable import hermite

Floats = NDArray[np.float64]

_KINETIC = exu.OutputVariableType.KineticEnergy
_POTENTIAL = exu.OutputVariableType.PotentialEnergy


def constant_forces(mbs: exu.MainSystem, overlays: Sequence[int]) -> NDArray[np.float64]:
    """[N], shape (coordinates,): weight, pull of curves, tensions, preloads, uplift.

    overlays : numbers of the objects that carry forces along the wires
    """
    forces: NDArray[np.float64] = np.zeros(mbs.systemData.ODE2Size())
    for i in overlays:
        forces[mbs.systemData.GetObjectLTGODE2(i)] += mbs.GetObject(i)["forceVector"]
    for i in range(mbs.systemData.NumberOfLoads()):
        load = mbs.GetLoad(i)
        marker = mbs.GetMarker(load["markerNumber"])
        index = mbs.systemData.GetNodeLTGODE2(marker["nodeNumber"])[marker["coordinate"]]
        forces[index] += load["load"]
    return forces


class EnergyMeter:
    """Kinetic and stored energy of a system of wires, springs and pantographs.

    The potential of constant forces (weight, tensions, preloads, uplift) counts as stored energy. Contacts
    are not among its springs: what they do is work on wires and pantographs.
    """

    def __init__(self, mbs: exu.MainSystem) -> None:
        self._mbs = mbs
        objects = [mbs.GetObject(i) for i in range(mbs.systemData.NumberOfObjects())]
        by_type: dict[str, list[int]] = {}
        for number, item in enumerate(objects):
            by_type.setdefault(item["objectType"], []).append(number)
        self._cables = [*by_type.get("ANCFCable2D", []), *by_type.get("ANCFCable", [])]
        bodies = [i for kind in ("Mass1D", "RigidBody", "GenericODE2") for i in by_type.get(kind, [])]
        self._bodies = [*self._cables, *bodies]
        self._springs = by_type.get("ConnectorCoordinateSpringDamper", [])
        self._droppers = [  # and links, which have no law of their own and push too
            (
                i,
                objects[i]["stiffness"],
                objects[i]["referenceLength"],
                not objects[i]["springForceUserFunction"],
            )
            for i in by_type.get("ConnectorSpringDamper", [])
        ]
        self._forces = constant_forces(mbs, by_type.get("GenericODE2", []))

    def energy(self) -> float:
        """[J] at the current state, above an arbitrary zero."""
        mbs = self._mbs
        origin = [0.0, 0.0, 0.0]
        total = sum(mbs.GetObjectOutputBody(i, _KINETIC, origin) for i in self._bodies)
        total += sum(mbs.GetObjectOutputBody(i, _POTENTIAL, origin) for i in self._cables)
        total += sum(mbs.GetObjectOutput(i, _POTENTIAL) for i in self._springs)
        for i, stiffness, length, pushes in self._droppers:
            stretch = mbs.GetObjectOutput(i, exu.OutputVariableType.Distance) - length
            total += 0.5 * stiffness * (stretch if pushes else max(stretch, 0.0)) ** 2
        return float(total - self._forces @ mbs.systemData.GetODE2Coordinates())


class EnergyBalance:
    """Energy, work of the contacts and loss in the dampers, step by step.

    Work and loss of a step are those of the trapezoidal rule: the mean of a force at the step's two ends
    along the displacement between them. A contact's work on wire and head is not zero: what it does not
    store or damp comes from the moving base, which drives the force over the wire's inclination.

    every : steps between readings of the energy
    """

    def __init__(
        self, model: Model, items: Sequence[PantographItems], start: Floats, steps: int, every: int
    ) -> None:
        self._model, self._start, self._every = model, start, every
        self._meter = EnergyMeter(model.mbs)
        self._damping = _damping_matrix(model.mbs)
        self._contacts = [
            (i, contact, item.heights[k // len(model.contacts)] if item.heights else None)
            for i, item in enumerate(items)
            for k, contact in enumerate(item.contacts)
        ]
        self.work, self.loss = np.zeros(steps + 1), np.zeros(steps + 1)
        self._energy: list[float] = []
        self._before: tuple[Floats, Floats, Floats, Floats, Floats] | None = None

    @property
    def energy(self) -> Floats:
        """[J], shape (readings,)."""
        return np.array(self._energy)

    def record(self, n: int, way: float, droppers: tuple[Floats, Floats]) -> None:
        """Take down step ``n``'s end, ``way`` [m] from the start.

        droppers : [N] and [m], shape (droppers,): the dampers' part of their forces, and their lengths
        """
        data = self._model.mbs.systemData
        q = data.GetODE2Coordinates()
        push, drag = self._push(q.size, way), self._damping @ data.GetODE2Coordinates_t()
        now = (q, push, drag, *droppers)
        if self._before is not None:
            before = self._before
            moved = q - before[0]
            self.work[n] = self.work[n - 1] + (before[1] + push) @ moved / 2
            lost = (before[2] + drag) @ moved + (before[3] + now[3]) @ (now[4] - before[4])
            self.loss[n] = self.loss[n - 1] + lost / 2
        self._before = now
        if n % self._every == 0:
            self._energy.append(self._meter.energy())

    def _push(self, size: int, way: float) -> Floats:
        """[N], shape (coordinates,): generalised forces of the contacts at the current state."""
        push, mbs = np.zeros(size), self._model.mbs
        for i, contact, head in self._contacts:
            force = mbs.GetObjectOutput(contact.connector, exu.OutputVariableType.Force)[contact.wire.up]
            element, local = locate(contact.wire, float(self._start[i]) + way + contact.ahead)
            length = contact.wire.line.lengths[element]
            up, axes = contact.wire.up, contact.wire.line.axes
            shape = hermite(local / length, length).reshape(2, 2)
            for node, weights in zip(contact.wire.nodes[element : element + 2], shape, strict=True):
                first = mbs.systemData.GetNodeLTGODE2(node)
                push[first[up]] += force * weights[0]
                push[first[up + axes]] += force * weights[1]
            if head is not None:
                push[self._head(contact, head)] -= force * self._lever(contact)
        return push

    def _head(self, contact: ContactItems, head: tuple[int, int]) -> list[int]:
        node, coordinate = head
        index = self._model.mbs.systemData.GetNodeLTGODE2(node)
        return [index[coordinate], index[coordinate + 1]] if contact.rolls else [index[coordinate]]

    def _lever(self, contact: ContactItems) -> Floats:
        """Of the head's heave, and its roll: how far to the left the contact is [m]."""
        if not contact.rolls:
            return np.ones(1)
        place = self._model.mbs.GetMarkerParameter(contact.head_marker, "localPosition")
        return np.array([1.0, place[1]])


def _damping_matrix(mbs: exu.MainSystem) -> Any:
    """Sparse damping matrix of all linear dampers; those of droppers and contacts act one way only."""
    from scipy.sparse import coo_matrix

    size = mbs.systemData.ODE2Size()
    total = coo_matrix((size, size)).tocsr()
    for number in range(mbs.systemData.NumberOfObjects()):
        item = mbs.GetObject(number)
        if item["objectType"] == "GenericODE2":
            index = np.asarray(mbs.systemData.GetObjectLTGODE2(number))
            matrix = item["dampingMatrix"].GetPythonObject()
            if not isinstance(matrix, dict):  # none was given
                continue
            entries = np.asarray(matrix["triplets"])
            rows, columns = index[entries[:, 0].astype(int)], index[entries[:, 1].astype(int)]
            total = total + coo_matrix((entries[:, 2], (rows, columns)), shape=(size, size)).tocsr()
        elif item["objectType"] == "ConnectorCoordinateSpringDamper" and item["damping"]:
            ends = [_coordinate(mbs, marker) for marker in item["markerNumbers"]]
            signs = {i: sign for i, sign in zip(ends, (-1.0, 1.0), strict=True) if i is not None}
            row = coo_matrix((list(signs.values()), ([0] * len(signs), list(signs))), shape=(1, size))
            total = total + item["damping"] * (row.T @ row)
    return total.tocsr()


def _coordinate(mbs: exu.MainSystem, marker: int) -> int | None:
    """Number of the coordinate that a marker is on, None for the ground."""
    place = mbs.GetMarker(marker)
    index = mbs.systemData.GetNodeLTGODE2(place["nodeNumber"])
    return int(index[place["coordinate"]]) if len(index) else None
