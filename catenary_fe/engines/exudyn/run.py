"""Runs by Exudyn's solver: pantographs along the multibody model, and what is recorded at every step."""

from __future__ import annotations

import logging
from dataclasses import replace

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.base import Progress, RunCase
from catenary_fe.engines.checkpoint import Checkpoint
from catenary_fe.engines.exudyn.balance import Bases, EnergyBalance, base_motion
from catenary_fe.engines.exudyn.build import ExudynModel, exudyn_model
from catenary_fe.engines.exudyn.solver import solve_dynamic, solve_static
from catenary_fe.engines.faults import most_strained, place_of_heads, smaller_steps
from catenary_fe.engines.history import History, RunStopped, of_contacts, section_forces, where_pressed
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.engines.tension import INTERVAL, TensionGauge, TensionRecord
from catenary_fe.layout import InputError, SolverError
from catenary_fe.statics import Shape
from catenary_fe.statics.newton import static_contact

Floats = NDArray[np.float64]
STRETCH = 25  # steps that are divided from where one failed
MOST_PARTS = 8
_ALONG = exu.OutputVariableType.ForceLocal  # of a dropper
_BOTH = exu.ConfigurationType.Initial, exu.ConfigurationType.Current

_log = logging.getLogger(__name__)


class ExudynEngine:
    """A line for any number of runs by Exudyn's solver with one time step.

    store_wire : [s] between stored shapes of the wires; unset: none
    energy : whether energy, work and losses are recorded
    model : to run, be it changed or not, with its own pantographs; unset: a new one for each run
    """

    def __init__(
        self,
        shape: Shape,
        time: TimeSettings | None = None,
        store_wire: float | None = None,
        *,
        energy: bool = False,
        model: ExudynModel | None = None,
    ) -> None:
        self._shape, self._time, self._model = shape, time or TimeSettings(), model
        self._every = round(store_wire / self._time.step) if store_wire else 0
        self._energy_every = max(1, round(INTERVAL / self._time.step)) if energy else 0

    def run(
        self,
        case: RunCase,
        uplifts: Floats,
        progress: Progress | None = None,
        checkpoint: Checkpoint | None = None,
    ) -> History:
        """Run pantographs, each with its uplift [N], from static contact at constant speed.

        checkpoint : must be unset

        Raises SolverError without static contact, RunStopped with the history until then where a step fails
        or the user interrupts.
        """
        assert checkpoint is None
        model = self._model or exudyn_model(self._shape, case.pantographs)
        try:
            step, line = self._time.step, model.system.base_line
            bases = line.courses(case.start, case.speed, step, case.steps(step))
            _start(model, case, uplifts, bases, settle=self._model is not None)
            every = self._every, self._energy_every
            recorder = _Recorder(model, case, uplifts, bases, self._time, every)
            try:
                _integrate(model, case, uplifts, bases, recorder, self._time, progress)
            except (SolverError, KeyboardInterrupt) as error:
                raise RunStopped(recorder.history().until(recorder.done), error) from None
            return recorder.history()
        finally:
            if self._model is None:
                model.release()


def _start(model: ExudynModel, case: RunCase, uplifts: Floats, bases: Bases, *, settle: bool) -> None:
    """Bring the model to rest in static contact.

    bases : whose motion begins from rest
    settle : also by Exudyn's static solver, for what was changed or attached
    """
    mbs, system = model.mbs, model.system
    mbs.Assemble()
    own = [parts for parts in model.pantographs if parts.substructure]
    known = len(own)  # attached ones come last
    if any(bases) and (barred := [parts.record.name for parts in own if parts.frame]):
        raise InputError(
            f"conditions: base moves, and in the multibody model the bars of {barred[0]} stand on"
            " fixed joints; take the method nonlinear, or leave base out"
        )
    q = mbs.systemData.GetODE2Coordinates(configuration=exu.ConfigurationType.Initial)
    if own:
        described = replace(case, pantographs=case.pantographs[:known], start=case.start[:known])
        placed = described.placed(uplifts[:known], system)
        placed = [replace(p, base=base) for p, base in zip(placed, bases, strict=False)]
        moved, placed = static_contact(system, placed)
        q[: system.dof.size] = moved
        for n, (parts, where) in enumerate(zip(own, placed, strict=True)):
            model.pantographs[n] = replace(parts, substructure=where.body)  # as at this speed
            q[parts.index(mbs)] = where.heights
            if parts.frame:
                parts.frame.follow(mbs, q)
    else:
        q[: system.dof.size] = 0.0
    model.load_at(0.0)
    model.lift(uplifts, case.start, [(base.at(0.0)[0] if base else 0.0, 0.0) for base in bases])
    model.place(case.start)  # first: static contact has strips that roll where the wires were installed
    _set_state(model, q, np.zeros_like(q))
    if settle:
        solve_static(mbs, what="static contact at the start", name=model.name)


def _set_state(model: ExudynModel, q: Floats, v: Floats) -> None:
    """Make these coordinates and velocities the initial and the current ones."""
    data = model.mbs.systemData
    for configuration in _BOTH:
        data.SetODE2Coordinates(q, configuration=configuration)
        data.SetODE2Coordinates_t(v, configuration=configuration)


def _integrate(
    model: ExudynModel,
    case: RunCase,
    uplifts: Floats,
    bases: Bases,
    recorder: _Recorder,
    time: TimeSettings,
    progress: Progress | None,
) -> None:
    """Step to the end; where a step fails, on from the state before it in smaller ones for a while.

    Raises SolverError where the smallest ones fail, too.
    """
    contacts, parts, steps = model.contacts, 1, case.steps(time.step)
    while recorder.done < steps:
        first = max(recorder.done, 0)
        last = steps if parts == 1 else min(first + STRETCH, steps)
        finer = replace(time, step=time.step / parts)

        def before_step(end: float, step: float = finer.step, parts: int = parts) -> None:
            count = round(end / step)
            if (count - 1) % parts == 0:
                recorder.record((count - 1) // parts)
            model.load_at(end)
            if model.system.base_line.varies or model.system.base_line.motions:
                model.lift(uplifts, case.start + case.speed * end, base_motion(bases, end))
            contacts.move_to(case.start + case.speed * end, case.speed)
            if progress and count % (50 * parts) == 0:
                progress(count / parts / steps)

        if solve_dynamic(model.mbs, (last - first) * parts, finer, before_step, first * time.step):
            recorder.record(last)
            parts = 1
        elif parts < MOST_PARTS:
            parts *= 2
            recorder.note_smaller_steps(parts)
        else:
            raise SolverError(recorder.failure())
        if recorder.done < steps:
            _set_state(model, *recorder.state)
            contacts.move_to(case.start + case.speed * time.step * recorder.done, case.speed)


class _Recorder:
    """Reads the state at each step; what it keeps is small beside the state itself.

    done : last step on record
    state : coordinates and velocities then
    """

    def __init__(
        self,
        model: ExudynModel,
        case: RunCase,
        uplifts: Floats,
        bases: Bases,
        time: TimeSettings,
        every: tuple[int, int],
    ) -> None:
        self._model, self._case, self._step, self._contacts = model, case, time.step, model.contacts
        system, self._every = model.system, every[0]
        steps = case.steps(time.step)
        n = steps + 1
        self._times: Floats = np.arange(n, dtype=np.float64) * time.step
        self._forces = [np.zeros((len(parts.contacts), n)) for parts in model.pantographs]
        self._heights = [np.full((len(parts.contacts), n), np.nan) for parts in model.pantographs]
        self._lateral = [np.full_like(own, np.nan) for own in self._forces] if system.spatial else []
        self._masses = [np.zeros((len(parts.masses), n)) for parts in model.pantographs]
        self._dropper = np.zeros((system.droppers.length.size, n))
        paths = system.contact_paths
        self._support_index = np.concatenate([path.index[path.supports, 0] for path in paths])
        self._support = np.zeros((self._support_index.size, n))
        self._wire: list[Floats] = []
        self._balance = EnergyBalance(model, uplifts, bases, steps, every[1]) if every[1] else None
        self._tension = TensionRecord(TensionGauge(system))
        self._tension_every = max(1, round(INTERVAL / time.step))
        self._notes: dict[float, int] = {}
        self.done = -1
        self.state = np.zeros(0), np.zeros(0)

    def _positions(self, step: int) -> Floats:
        positions: Floats = self._case.start + self._case.speed * self._step * step
        return positions

    def record(self, n: int) -> None:
        """Take down the current state as step ``n``'s end."""
        if n <= self.done:  # taken up again after smaller steps
            return
        model, contacts, system = self._model, self._contacts, self._model.system
        data = model.mbs.systemData
        q, v = self.state = data.GetODE2Coordinates(), data.GetODE2Coordinates_t()
        nominal = system.contact_wire_height
        forces = [[contacts.force(c) for c in parts.contacts] for parts in model.pantographs]
        for i, parts in enumerate(model.pantographs):
            self._forces[i][:, n] = forces[i]
            for j, contact in enumerate(parts.contacts):
                if contacts.meets(contact):
                    self._heights[i][j, n] = contacts.height(contact.wire_marker) - nominal
                    if self._lateral:
                        self._lateral[i][j, n] = contacts.to_the_left(contact.wire_marker)
            self._masses[i][:, n] = [contacts.height(marker) - nominal for marker in parts.masses]
        self._support[:, n] = q[self._support_index]
        self._dropper[:, n] = [model.mbs.GetObjectOutput(d, _ALONG) for d in model.droppers]
        if self._every and n % self._every == 0:
            self._wire.append(q[system.heights])
        if n % self._tension_every == 0:
            self._tension.read(self._step * n, q)
        if self._balance:
            driving = self._balance.driving(self._step * n, q, self._positions(n), forces)
            drag = self._balance.drag(self._step * n, v)
            self._balance.record(n, (q, v), driving, drag, self._dropper[:, n])
        self.done = n

    def note_smaller_steps(self, parts: int) -> None:
        """Remember for the result that steps were divided, and from when on."""
        at = self._step * self.done
        _log.warning("no convergence after t = %.4f s: on in steps of 1/%d", at, parts)
        self._notes[at] = parts

    def failure(self) -> str:
        """A failed run in words: when, where, what is strained, what to do."""
        n, catenary = self.done, self._model.shape.catenary
        positions = self._positions(n)
        forces = ", ".join(f"{f:.0f} N" for f in (own[:, n].sum() for own in self._forces))
        strained = most_strained(catenary, positions, self._dropper[:, n], self._dropper[:, 0])
        where = place_of_heads(catenary.support_positions, positions)
        return (
            f"run at {3.6 * self._case.speed:g} km/h: no convergence after t = {self._step * n:.4f} s with"
            f" steps of {self._step:g} s and of 1/{MOST_PARTS} of it; {where}, contact force {forces};"
            f" {strained + '; ' if strained else ''}look at the stiffness and uplift_force there, and try a"
            " smaller time step"
        )

    def history(self) -> History:
        """What was recorded so far."""
        system, case, time, balance = self._model.system, self._case, self._times, self._balance
        rest, stored = system.reference[system.heights], np.array(self._wire)
        parts = [slice(wire.first, wire.first + wire.x.size) for wire in system.wires]
        paths, pantographs = system.contact_paths, self._model.pantographs
        profiles = np.concatenate([path.profile[path.supports, 0] for path in paths])
        sections = [np.array([paths[c.wire].section for c in parts.contacts]) for parts in pantographs]
        found = [of_contacts(*each) for each in zip(self._forces, self._heights, sections, strict=True)]
        nothing = np.array([])
        return History(
            time=time,
            position=case.start[:, None] + case.speed * time,
            contact_force=np.array([force for force, _, _ in found]),
            wire_height=np.array([height for _, height, _ in found]),
            mass_heights=self._masses,
            dropper_force=self._dropper,
            support_height=profiles[:, None] + self._support,
            wire_x=[wire.x for wire in system.wires],
            wire_z=[rest[part] + stored[:, part] for part in parts] if self._wire else [],
            wire_times=time[:: self._every] if self._wire else None,
            energy=balance.energy if balance else nothing,
            energy_times=time[:: balance.every] if balance else nothing,
            driven_work=balance.work if balance else nothing,
            lost_work=balance.loss if balance else None,
            tension_change=self._tension.changes,
            tension_span=self._tension.spans,
            tension_times=self._tension.times,
            section_force=section_forces(found),
            contact_lateral=[where_pressed(*both) for both in zip(self._lateral, self._forces, strict=False)],
            notes=tuple(self._note(at, parts) for at, parts in self._notes.items()),
        )

    def _note(self, at: float, parts: int) -> str:
        supports, positions = self._model.system.support_positions, self._case.start + self._case.speed * at
        return smaller_steps(supports, positions, at, parts, 1e3 * STRETCH * self._step)
