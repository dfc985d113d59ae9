"""What a modal run returns: the motion as a sum of eigenforms."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from catenary_fe.layout import InputError
from catenary_fe.layout.arguments import checked, numbers, one_of, whole
from catenary_fe.layout.frozen import changed_by_copy
from catenary_fe.results.modes import Modes

Floats = NDArray[np.float64]


@changed_by_copy
@dataclass(frozen=True)
class ModalRun:
    """One pantograph on a line that answers with a limited number of eigenforms.

    modes : those that were summed
    time : [s], shape (times,)
    position : [m], shape (times,), of the pantograph along the track
    contact_force : [N], shape (times,)
    wire_height : [m], shape (times,), of the contact wire over the head, above the rail
    mass_height : [m], shape (masses, times), above the rail; no masses for an elastic pantograph
    coordinates : [m √kg], shape (times, modes)
    """

    modes: Modes
    time: Floats
    position: Floats
    contact_force: Floats
    wire_height: Floats
    mass_height: Floats
    coordinates: Floats

    @checked
    def uplift(self, x: ArrayLike, every: int = 1) -> Floats:
        """[m], shape (times, points): uplift of the contact wire at positions [m], at every so many times."""
        whole("every", every, least=1)
        uplift: Floats = np.tensordot(self.coordinates[::every], self.modes.contact.at(x), axes=1)
        return uplift

    @checked
    def error_against(self, signal: ArrayLike, of: str = "contact_force") -> float:
        """Root mean square of the difference to a signal of the same times, over the signal's deviation.

        of : "contact_force" or "wire_height"

        Raises InputError for a signal of other times, or one that is constant.
        """
        one_of("of", of, ("contact_force", "wire_height"))
        full = numbers("signal", signal, shape=self.time.shape, each="one value a time")
        if np.ptp(full) == 0:
            raise InputError("signal is constant: it has no deviation to compare with")
        return float(np.sqrt(np.mean((getattr(self, of) - full) ** 2)) / full.std())
