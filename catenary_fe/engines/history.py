"""What a run records, and how a run says that it came to an end before its time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import SolverError

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
FEWEST = 50  # steps that are worth keeping; filters need some


@dataclass(frozen=True)
class History:
    """What a run recorded, at every time step, the initial state included.

    time : [s], shape (times,)
    position : [m], shape (pantographs, times), along the track
    contact_force : [N], shape (pantographs, times), of all strips on all contact wires
    wire_height : [m], shape (pantographs, times), of the contact wire over the head, above its nominal
        height; of several points of contact, their mean
    mass_heights : [m], for each pantograph shape (masses, times), above the nominal contact wire height
    dropper_force : [N], shape (droppers, times)
    support_height : [m], shape (supports of all contact wires, times), of the contact wires there
    wire_x, wire_z : [m], for each wire its stations (nodes,) and its heights (shape times, nodes), or none
    wire_times : [s], times of ``wire_z``
    energy : [J], shape (energy_times,), kinetic and stored, without the contacts', or empty
    energy_times : [s]
    driven_work : [J], shape (times,), done on wires and masses by the contacts, or empty: what the moving
        bases put in over the wire's inclination, less what the contacts store and damp
    lost_work : [J], shape (times,), lost in the dampers of wires, droppers, supports and pantographs, or none
    tension_change : shape (wires, tension_times), largest relative change of each wire's tension between two
        supports since the start, or none
    tension_span : shape (wires, tension_times), number of the span (from 1) where that is
    tension_times : [s]
    notes : what to warn of in the result
    contact_lateral : [m], for each pantograph shape (contacts, times), of the wire to the left of the head's
        middle at each strip on each contact wire; no number without contact. In the plane of no times
    section_force : [N], shape (pantographs, sections, times), of the contact wires of each section, or
        none where there is one
    """

    time: Floats
    position: Floats
    contact_force: Floats
    wire_height: Floats
    mass_heights: list[Floats]
    dropper_force: Floats
    support_height: Floats
    wire_x: list[Floats]
    wire_z: list[Floats]
    wire_times: Floats | None
    energy: Floats
    energy_times: Floats
    driven_work: Floats
    lost_work: Floats | None = None
    tension_change: Floats | None = None
    tension_span: NDArray[np.int64] | None = None
    tension_times: Floats | None = None
    notes: tuple[str, ...] = ()
    section_force: Floats | None = None
    contact_lateral: Sequence[Floats] = ()

    def until(self, steps: int) -> History | None:
        """The history of the first steps, or None where those are too few to be of use."""
        if steps < FEWEST:
            return None
        n, shapes = steps + 1, 0
        if self.wire_times is not None:
            shapes = int((self.wire_times <= self.time[steps]).sum())
        energies = int((self.energy_times <= self.time[steps]).sum())
        tensions = 0 if self.tension_times is None else int((self.tension_times <= self.time[steps]).sum())
        return replace(
            self,
            time=self.time[:n],
            position=self.position[:, :n],
            contact_force=self.contact_force[:, :n],
            wire_height=self.wire_height[:, :n],
            mass_heights=[heights[:, :n] for heights in self.mass_heights],
            dropper_force=self.dropper_force[:, :n],
            support_height=self.support_height[..., :n],
            wire_z=[z[:shapes] for z in self.wire_z],
            wire_times=None if self.wire_times is None else self.wire_times[:shapes],
            energy=self.energy[:energies],
            energy_times=self.energy_times[:energies],
            driven_work=self.driven_work[:n],
            contact_lateral=[lateral[:, :n] for lateral in self.contact_lateral],
            section_force=None if self.section_force is None else self.section_force[..., :n],
            lost_work=None if self.lost_work is None else self.lost_work[:n],
            tension_change=None if self.tension_change is None else self.tension_change[:, :tensions],
            tension_span=None if self.tension_span is None else self.tension_span[:, :tensions],
            tension_times=None if self.tension_times is None else self.tension_times[:tensions],
        )


def of_contacts(force: Floats, height: Floats, sections: Integers) -> tuple[Floats, Floats, Floats | None]:
    """A pantograph's contact force, the height of the wire over its head, and the force of each section.

    force, height : [N], [m], shape (contacts, times); heights are no number beyond a wire's ends
    sections : shape (contacts,), of each contact's wire

    Of several points of contact with one section the height is the mean; of several sections the head meets
    the lower wire.
    """
    present = range(int(sections.max()) + 1)
    means = np.array([height[sections == s].mean(axis=0) for s in present])
    by_section = np.array([force[sections == s].sum(axis=0) for s in present])
    several = len(present) > 1
    return by_section.sum(axis=0), np.fmin.reduce(means), by_section if several else None


def where_pressed(lateral: Floats, force: Floats) -> Floats:
    """Places [m] of contacts, no number where their force [N] is 0; shape (contacts, times) all."""
    found: Floats = np.where(force > 0, lateral, np.nan)
    return found


def section_forces(found: Sequence[tuple[Floats, Floats, Floats | None]]) -> Floats | None:
    """[N], shape (pantographs, sections, times), of several pantographs, or none."""
    each = [forces for _, _, forces in found if forces is not None]
    return np.array(each) if each else None


class RunStopped(Exception):  # noqa: N818 the user may have wished it
    """A drive that was stopped, by a solve that failed or by the user.

    history : what was recorded until then (see :meth:`History.until`), or None where that is next to nothing
    cause : the error to end with
    """

    def __init__(self, history: History | None, cause: SolverError | KeyboardInterrupt) -> None:
        super().__init__(str(cause))
        self.history, self.cause = history, cause
