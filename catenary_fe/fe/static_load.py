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
from catenary_fe.fe.solver import solve_static
from catenary_fe.fe.wire import UP
from catenary_fe.system import Catenary

Floats = NDArray[np.float64]


class LoadedCatenary:
    """A catenary whose contact wire carries vertical forces that can be moved and solved for again."""

    def __init__(self, catenary: Catenary, mesh: Mesh, installation: Installation, forces: int = 1) -> None:
        self.model: Model = build_model(catenary, mesh, installation)
        mbs, wire = self.model.mbs, self.model.contact
        self._markers = [
            mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=wire.elements[0], localPosition=[0, 0, 0]))
            for _ in range(forces)
        ]
        self._loads = [
            mbs.AddLoad(eii.LoadForceVector(markerNumber=m, loadVector=[0, 0, 0])) for m in self._markers
        ]
        mbs.Assemble()
        self.solve([0.0] * forces, [0.0] * forces)

    def solve(self, positions: Sequence[float] | Floats, forces: Sequence[float] | Floats) -> Floats:
        """Heights [m] of the contact wire at the positions [m] along the track under the upward forces [N].

        Starts from the state solved for last. Raises SolverError if there is no convergence.
        """
        mbs, wire = self.model.mbs, self.model.contact
        places = [locate(wire, float(x)) for x in positions]
        for i, (element, local) in enumerate(places):
            mbs.SetMarkerParameter(self._markers[i], "bodyNumber", wire.elements[element])
            mbs.SetMarkerParameter(self._markers[i], "localPosition", [local, 0, 0])
            mbs.SetLoadParameter(self._loads[i], "loadVector", [0, float(forces[i]), 0])
        what = ", ".join(f"{f:g} N at {x:g} m" for x, f in zip(positions, forces, strict=True))
        solve_static(mbs, what=f"static load ({what})")
        return self.heights(places)

    def heights(self, places: Sequence[tuple[int, float]]) -> Floats:
        """[m] of the contact wire at (element, arc length inside it)."""
        position = exu.OutputVariableType.Position
        output = self.model.mbs.GetObjectOutputBody
        elements = self.model.contact.elements
        return np.array([output(elements[e], position, [s, 0, 0])[UP] for e, s in places])


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
    before = loaded.heights([locate(loaded.model.contact, float(x)) for x in positions])
    lifts = np.empty(positions.size)
    for i, x in enumerate(positions):
        lifts[i] = loaded.solve([x], [force])[0] - before[i]
        if progress:
            progress((i + 1) / positions.size)
    return lifts
