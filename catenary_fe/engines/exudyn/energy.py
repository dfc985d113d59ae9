"""Energy of a model, and what is done on it and lost in it while it runs."""

from __future__ import annotations

from collections.abc import Sequence

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

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
