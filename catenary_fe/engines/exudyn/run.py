"""Drive pantographs along the wire, and write down what happens at every step."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.contact import MovingContact
from catenary_fe.engines.exudyn.energy import EnergyBalance
from catenary_fe.engines.exudyn.model import Model, build_model
from catenary_fe.engines.exudyn.pantograph import PantographItems, add_pantographs
from catenary_fe.engines.exudyn.solver import release, solve_dynamic, solve_static
from catenary_fe.engines.faults import most_strained, place_of_heads, smaller_steps
from catenary_fe.engines.history import History, RunStopped
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.engines.tension import INTERVAL, TensionGauge, TensionRecord
from catenary_fe.fe.installation import Installation, dropper_damping
from catenary_fe.fe.mesh import Mesh
from catenary_fe.layout import AnyPantograph, Catenary, SolverError

Floats = NDArray[np.float64]
Progress = Callable[[float], None]
STRETCH = 25  # steps that are divided from where one failed
MOST_PARTS = 8

_log = logging.getLogger(__name__)


@dataclass(frozen=True)
class Trip:
    """How to drive.

    speed : [m/s]
    start : [m], shape (pantographs,), positions at the start
    steps : number of time steps
    time : settings of the integration
    wire_interval : [s] between stored shapes of the wires, or None
    energy_interval : [s] between readings of the energy, or None
    """

    speed: float
    start: Floats
    steps: int
    time: TimeSettings
    wire_interval: float | None = None
    energy_interval: float | None = None


def drive(
    catenary: Catenary,
    mesh: Mesh,
    installation: Installation,
    pantographs: Sequence[tuple[AnyPantograph, float]],
    trip: Trip,
    progress: Progress | None = None,
) -> History:
    """Run pantographs, each with its uplift [N], from static contact at their starts at constant speed.

    Raises SolverError where there is no static contact, RunStopped with the history until then where a step
    fails or the user interrupts.
    """
    model = build_model(catenary, mesh, installation)
    items = add_pantographs(model, pantographs)
    contact = MovingContact(model, items)
    mbs = model.mbs
    mbs.Assemble()
    contact.move_to(trip.start, 0.0)
    raise_heads(model, items)
    solve_static(mbs, what="static contact at the start")
    contact.settle_laws(lambda: solve_static(mbs, what="static contact at the start"))
    recorder = _Recorder(model, items, trip)
    try:
        _travel(model, contact, recorder, trip, progress)
    except (SolverError, KeyboardInterrupt) as error:
        raise RunStopped(recorder.history().until(recorder.done), error) from None
    finally:
        release(mbs)
    return recorder.history()


def _travel(
    model: Model, contact: MovingContact, recorder: _Recorder, trip: Trip, progress: Progress | None
) -> None:
    """Step to the end; where a step fails, on from the state before it in smaller ones for a while.

    Raises SolverError where the smallest ones fail, too.
    """
    what, parts = f"run at {3.6 * trip.speed:g} km/h", 1
    while recorder.done < trip.steps:
        first = max(recorder.done, 0)
        last = trip.steps if parts == 1 else min(first + STRETCH, trip.steps)
        time = replace(trip.time, step=trip.time.step / parts)

        def before_step(end: float, step: float = time.step, parts: int = parts) -> None:
            count = round(end / step)
            if (count - 1) % parts == 0:
                recorder.record((count - 1) // parts)
            contact.move_to(trip.start + trip.speed * end, trip.speed)
            if progress and count % (50 * parts) == 0:
                progress(count / parts / trip.steps)

        try:
            solve_dynamic(
                model.mbs,
                steps=(last - first) * parts,
                time=time,
                what=what,
                before_step=before_step,
                begin=first * trip.time.step,
            )
            recorder.record(last)
            parts = 1
        except SolverError:
            if parts == MOST_PARTS:
                raise SolverError(recorder.failure(what)) from None
            parts *= 2
            recorder.note_smaller_steps(parts)
        if recorder.done < trip.steps:
            recorder.take_up()
            contact.move_to(trip.start + trip.speed * trip.time.step * recorder.done, trip.speed)


def raise_heads(model: Model, items: Sequence[PantographItems]) -> None:
    """Start the masses from contact: a pantograph with no base spring has no other equilibrium."""
    mbs = model.mbs
    coordinates = mbs.systemData.GetODE2Coordinates(configuration=exu.ConfigurationType.Initial)
    for item in items:
        gaps = [mbs.GetObjectOutput(c.connector, exu.OutputVariableType.Displacement) for c in item.contacts]
        gap = float(np.mean([values[c.wire.up] for values, c in zip(gaps, item.contacts, strict=True)]))
        for node, coordinate in item.heights:
            coordinates[mbs.systemData.GetNodeLTGODE2(node)[coordinate]] = 1e-3 - gap
    for configuration in (exu.ConfigurationType.Initial, exu.ConfigurationType.Current):
        mbs.systemData.SetODE2Coordinates(coordinates, configuration=configuration)


class _Recorder:
    """Reads the state at each step; what it keeps is small beside the state itself."""

    def __init__(self, model: Model, items: Sequence[PantographItems], trip: Trip) -> None:
        self._model, self._items, self._trip = model, items, trip
        n, catenary = trip.steps + 1, model.catenary
        self._force = np.zeros((len(items), n))
        self._wire_height = np.zeros((len(items), n))
        self._masses = [np.zeros((len(item.heights), n)) for item in items]
        self._mass_index = [
            [model.mbs.systemData.GetNodeLTGODE2(node)[coordinate] for node, coordinate in item.heights]
            for item in items
        ]
        self._dropper = np.zeros((len(catenary.droppers), n))
        self._stiffness = np.array([d.stiffness for d in catenary.droppers])
        self._damping = dropper_damping(catenary)
        mesh, width = model.mesh, model.node_width
        axes, up = np.arange(model.axes), model.axes - 1
        self._lower = width * mesh.nodes(mesh.lower)[:, None] + axes
        self._upper = width * mesh.nodes(mesh.upper)[:, None] + axes
        reference = np.concatenate([wire.line.coordinates().ravel() for wire in model.wires])
        self._span = reference[self._upper] - reference[self._lower]
        supports = [
            first + wire.supports
            for first, wire in zip(mesh.first_nodes, mesh.wires[: mesh.contact_wires], strict=False)
        ]
        self._support_index = width * np.array(supports) + up
        self._support = np.zeros((mesh.contact_wires, len(catenary.supports), n))
        self._wire_index = width * np.arange(mesh.first_nodes[-1]) + up
        self._every = round(trip.wire_interval / trip.time.step) if trip.wire_interval else 0
        self._wire: list[Floats] = []
        self._energy_every = round(trip.energy_interval / trip.time.step) if trip.energy_interval else 0
        self._energy_balance = (
            EnergyBalance(model, items, trip.start, trip.steps, self._energy_every)
            if trip.energy_interval
            else None
        )
        self._tension = TensionRecord(TensionGauge(model.system))
        self._tension_every = max(1, round(INTERVAL / trip.time.step))
        self.done = -1  # last step on record
        self._state = np.zeros(0), np.zeros(0)
        self._notes: dict[float, int] = {}

    def take_up(self) -> None:
        """Make the last state on record the initial one."""
        for set_values, values in zip(
            (self._model.mbs.systemData.SetODE2Coordinates, self._model.mbs.systemData.SetODE2Coordinates_t),
            self._state,
            strict=True,
        ):
            for configuration in (exu.ConfigurationType.Initial, exu.ConfigurationType.Current):
                set_values(values, configuration=configuration)

    def note_smaller_steps(self, parts: int) -> None:
        """Remember for the result that steps were divided, and from when on."""
        at = self._trip.time.step * self.done
        _log.warning("no convergence after t = %.4f s: on in steps of 1/%d", at, parts)
        self._notes[at] = parts

    def failure(self, what: str) -> str:
        """A failed run in words: when, where, what is strained, what to do."""
        trip, catenary, n = self._trip, self._model.catenary, self.done
        positions = trip.start + trip.speed * trip.time.step * n
        forces = ", ".join(f"{f:.0f} N" for f in self._force[:, n])
        strained = most_strained(catenary, positions, self._dropper[:, n], self._dropper[:, 0])
        return (
            f"{what}: no convergence after t = {trip.time.step * n:.4f} s with steps of {trip.time.step:g} s"
            f" and of 1/{MOST_PARTS} of it; {place_of_heads(catenary.support_positions, positions)}, contact"
            f" force {forces};"
            f" {strained + '; ' if strained else ''}look at the stiffness and uplift_force there, and try a"
            " smaller time step"
        )

    def record(self, n: int) -> None:
        if n <= self.done:  # taken up again after smaller steps
            return
        data = self._model.mbs.systemData
        q, v = self._state = data.GetODE2Coordinates(), data.GetODE2Coordinates_t()
        output, force = self._model.mbs.GetObjectOutput, exu.OutputVariableType.Force
        for i, item in enumerate(self._items):
            self._force[i, n] = sum(output(c.connector, force)[c.wire.up] for c in item.contacts)
            self._wire_height[i, n] = self._height_over(item)
            self._masses[i][:, n] = q[self._mass_index[i]]
        self._support[:, :, n] = q[self._support_index]
        self._dropper[:, n], drag, length = self._dropper_forces(q, v)
        if self._every and n % self._every == 0:
            self._wire.append(q[self._wire_index])
        if n % self._tension_every == 0:
            self._tension.read(self._trip.time.step * n, q)
        if self._energy_balance:
            self._energy_balance.record(n, self._trip.speed * self._trip.time.step * n, (drag, length))
        self.done = n

    def _height_over(self, item: PantographItems) -> float:
        """[m] of the wire over a head, above its nominal height; the mean of its points of contact."""
        position, output = exu.OutputVariableType.Position, self._model.mbs.GetMarkerOutput
        heights = [output(c.wire_marker, position)[c.wire.up] for c in item.contacts]
        return float(sum(heights) / len(heights) - self._model.contact_wire_height)

    def _dropper_forces(self, q: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """Tensions [N], the dampers' part of them, and lengths [m], each of shape (droppers,)."""
        span = self._span + q[self._upper] - q[self._lower]
        length = np.linalg.norm(span, axis=1)
        stretch = length - self._model.dropper_lengths
        rate = ((v[self._upper] - v[self._lower]) * span).sum(axis=1) / length
        spring = np.maximum(self._stiffness * stretch, 0.0)
        drag = np.clip(self._damping * rate, -spring, spring)
        return spring + drag, drag, length

    def history(self) -> History:
        trip, model = self._trip, self._model
        time: Floats = np.arange(trip.steps + 1, dtype=np.float64) * trip.time.step
        wires, ends = model.wires, model.mesh.first_nodes
        stored = np.array(self._wire)
        support_z = np.array(
            [w.line.z[m.supports] for w, m in zip(model.contacts, model.mesh.wires, strict=False)]
        )
        return History(
            time=time,
            position=trip.start[:, None] + trip.speed * time,
            contact_force=self._force,
            wire_height=self._wire_height,
            mass_heights=self._masses,
            dropper_force=self._dropper,
            support_height=support_z[:, :, None] + self._support,
            wire_x=[wire.line.x for wire in wires],
            wire_z=[w.line.z + stored[:, a:b] for w, a, b in zip(wires, ends[:-1], ends[1:], strict=True)]
            if self._wire
            else [],
            wire_times=time[:: self._every] if self._wire else None,
            energy=self._energy_balance.energy if self._energy_balance else np.array([]),
            energy_times=time[:: self._energy_every] if self._energy_balance else np.array([]),
            driven_work=self._energy_balance.work if self._energy_balance else np.array([]),
            lost_work=self._energy_balance.loss if self._energy_balance else None,
            tension_change=self._tension.changes,
            tension_span=self._tension.spans,
            tension_times=self._tension.times,
            notes=tuple(
                smaller_steps(
                    model.catenary.support_positions,
                    trip.start + trip.speed * at,
                    at,
                    parts,
                    1e3 * STRETCH * trip.time.step,
                )
                for at, parts in self._notes.items()
            ),
        )
