"""Static states of a model under vertical forces on the contact wire."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.contact import locate
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.model import Installation, Model, build_model
from catenary_fe.fe.solver import release, solve_static
from catenary_fe.system import Catenary

Floats = NDArray[np.float64]


class LoadedCatenary:
    """A catenary whose contact wire carries vertical forces that can be moved and solved for again.

    Two contact wires share each force.
    """

    def __init__(self, catenary: Catenary, mesh: Mesh, installation: Installation, forces: int = 1) -> None:
        self.model: Model = build_model(catenary, mesh, installation)
        mbs = self.model.mbs
        self._markers = [
            [
                mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=wire.elements[0], localPosition=[0, 0, 0]))
                for wire in self.model.contacts
            ]
            for _ in range(forces)
        ]
        self._loads = [
            [mbs.AddLoad(eii.LoadForceVector(markerNumber=m, loadVector=[0, 0, 0])) for m in markers]
            for markers in self._markers
        ]
        mbs.Assemble()
        self.solve([0.0] * forces, [0.0] * forces)

    def solve(self, positions: Sequence[float] | Floats, forces: Sequence[float] | Floats) -> Floats:
        """Heights [m] of the contact wire at the positions [m] along the track under the upward forces [N].

        Starts from the state solved for last. Raises SolverError if there is no convergence.
        """
        mbs = self.model.mbs
        for x, force, markers, loads in zip(positions, forces, self._markers, self._loads, strict=True):
            for wire, marker, load in zip(self.model.contacts, markers, loads, strict=True):
                element, local = locate(wire, float(x))
                mbs.SetMarkerParameter(marker, "bodyNumber", wire.elements[element])
                mbs.SetMarkerParameter(marker, "localPosition", [local, 0, 0])
                share = float(force) / len(loads)
                mbs.SetLoadParameter(load, "loadVector", list(share * np.eye(3)[wire.up]))
        what = ", ".join(f"{f:g} N at {x:g} m" for x, f in zip(positions, forces, strict=True))
        solve_static(mbs, what=f"static load ({what})")
        return self.heights(positions)

    def release(self) -> None:
        """Free the model's memory; it must not be used any more."""
        release(self.model.mbs)

    def heights(self, positions: Sequence[float] | Floats) -> Floats:
        """[m] of the contact wire at positions [m] along the track; of two wires, their mean."""
        output, position = self.model.mbs.GetObjectOutputBody, exu.OutputVariableType.Position
        found = np.zeros(len(positions))
        for wire in self.model.contacts:
            places = [locate(wire, float(x)) for x in positions]
            found += [output(wire.elements[e], position, [s, 0, 0])[wire.up] for e, s in places]
        return found / len(self.model.contacts)


def lift_curve(
    catenary: Catenary,
    mesh: Mesh,
    installation: Installation,
    positions: Floats,
    force: float,
    progress: Callable[[float], None] | None = None,
) -> Floats:
    """[m], shape (points,): lift of the contact wire at each position [m] under a force [N] there."""
    loaded = LoadedCatenary(catenary, mesh, installation)
    before = loaded.heights(positions)
    lifts = np.empty(positions.size)
    for i, x in enumerate(positions):
        lifts[i] = loaded.solve([x], [force])[0] - before[i]
        if progress:
            progress((i + 1) / positions.size)
    loaded.release()
    return lifts
