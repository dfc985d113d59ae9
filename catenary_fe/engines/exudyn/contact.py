"""The contact that moves along the wires, from step to step."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.pantograph import ContactItems, PantographItems, Track
from catenary_fe.engines.exudyn.wire import WireItems
from catenary_fe.layout import ElasticPantograph

Floats = NDArray[np.float64]
_PIECES, _HALVINGS = 6, 40  # straight pieces of a law to try for the start, then halvings of its force


class MovingContact:
    """Moves each pantograph's contact points along the wires, from step to step."""

    def __init__(self, track: Track, pantographs: Sequence[PantographItems]) -> None:
        self._mbs = track.mbs
        self._pantographs = pantographs
        self._at = {contact.connector: (-1, 0.0) for items in pantographs for contact in items.contacts}
        self._elevation = [0.0] * len(pantographs)
        self._tangent = [
            p.pantograph.tangent(0.0) if isinstance(p.pantograph, ElasticPantograph) else None
            for p in pantographs
        ]

    def move_to(self, positions: Floats, speed: float) -> None:
        """Put the pantographs at these positions [m] along the track, shape (pantographs,)."""
        changed = False
        for i, items in enumerate(self._pantographs):
            for contact in items.contacts:
                changed |= self._move(contact, float(positions[i]))
                if isinstance(items.pantograph, ElasticPantograph):
                    self._follow_law(i, items.pantograph)
                elif items.pantograph.contact_damping:
                    self._see_inclination(contact, items.pantograph.contact_damping, speed)
        if changed:
            self._mbs.AssembleLTGLists()

    def _move(self, contact: ContactItems, position: float) -> bool:
        """True if the contact is on another element than before."""
        before = self._at[contact.connector][0]
        element, local = locate(contact.wire, position + contact.ahead)
        self._at[contact.connector] = element, local
        if element != before:
            self._mbs.SetMarkerParameter(contact.wire_marker, "bodyNumber", contact.wire.elements[element])
        self._mbs.SetMarkerParameter(contact.wire_marker, "localPosition", [local, 0, 0])
        if contact.rolls:
            body, place = contact.wire.elements[element], exu.OutputVariableType.Position
            sideways = float(self._mbs.GetObjectOutputBody(body, place, [local, 0, 0])[1])
            self._mbs.SetMarkerParameter(contact.head_marker, "localPosition", [0, sideways, 0])
        return element != before

    def _see_inclination(self, contact: ContactItems, damping: float, speed: float) -> None:
        values = damping * np.eye(3)[contact.wire.up]
        values[0] = speed * self.inclination(contact)
        self._mbs.SetObjectParameter(contact.connector, "damping", list(values))

    def forces(self, items: PantographItems) -> Floats:
        """[N], shape (contacts,), on a pantograph's wires at the current state."""
        force = exu.OutputVariableType.Force
        values = [self._mbs.GetObjectOutput(c.connector, force)[c.wire.up] for c in items.contacts]
        return np.array(values, dtype=float)

    def inclination(self, contact: ContactItems) -> float:
        """dz/dx of the wire at a contact, at the current state."""
        element, local = self._at[contact.connector]
        slope = self._mbs.GetObjectOutputBody(
            contact.wire.elements[element], exu.OutputVariableType.Director1, [local, 0, 0]
        )
        return float(slope[contact.wire.up] / slope[0])

    def settle_laws(self, solve: Callable[[], None]) -> None:
        """Bring static wire and the laws of elastic pantographs together.

        solve : finds static equilibrium with the forces as they are set
        """
        laws = {
            i: items.pantograph
            for i, items in enumerate(self._pantographs)
            if isinstance(items.pantograph, ElasticPantograph) and items.pantograph.law
        }
        for _ in range(_PIECES if laws else 0):
            if not self._take_tangents(laws):
                return
            solve()
        if laws:
            # the straight pieces alternate; but the wire rises with the force, and the law falls
            low, high = dict.fromkeys(laws, 0.0), {i: law.law[0][1] for i, law in laws.items()}
            for _ in range(_HALVINGS):
                middle = {i: (low[i] + high[i]) / 2 for i in laws}
                for i, force in middle.items():
                    self._set_law(i, (force, 0.0))
                solve()
                for i, law in laws.items():
                    rising = law.contact_force(self._elevation_now(i)) > middle[i]
                    (low if rising else high)[i] = middle[i]
            self._take_tangents(laws)
            solve()

    def _take_tangents(self, laws: dict[int, ElasticPantograph]) -> bool:
        """Take the straight piece of each law where the wire is now; true if one of them changed."""
        changed = False
        for i, law in laws.items():
            self._elevation[i] = self._elevation_now(i)
            changed |= self._set_law(i, law.tangent(self._elevation[i]))
        return changed

    def _follow_law(self, i: int, pantograph: ElasticPantograph) -> None:
        """Take the straight piece of the law where the wire is expected at the step's end."""
        before, now = self._elevation[i], self._elevation_now(i)
        self._elevation[i] = now
        self._set_law(i, pantograph.tangent(2 * now - before))

    def _elevation_now(self, i: int) -> float:
        (contact,) = self._pantographs[i].contacts
        displacement = exu.OutputVariableType.Displacement
        return -float(self._mbs.GetObjectOutput(contact.connector, displacement)[contact.wire.up])

    def _set_law(self, i: int, tangent: tuple[float, float]) -> bool:
        """Let a connector push with F₀ − k · elevation; true if it did not before."""
        if tangent == self._tangent[i]:
            return False
        self._tangent[i] = tangent
        (contact,) = self._pantographs[i].contacts
        stiffness = tangent[1] * np.eye(3)[contact.wire.up]
        self._mbs.SetObjectParameter(contact.connector, "stiffness", list(stiffness))
        self._mbs.SetObjectParameter(contact.connector, "damping", [tangent[0], 0, 0])
        return True


def locate(wire: WireItems, position: float) -> tuple[int, float]:
    """Number of the wire's element at a position [m] along the track, and the arc length [m] inside it."""
    x = wire.line.x
    element = min(max(int(np.searchsorted(x, position, side="right")) - 1, 0), x.size - 2)
    fraction = (position - x[element]) / (x[element + 1] - x[element])
    return element, float(fraction * wire.line.lengths[element])
