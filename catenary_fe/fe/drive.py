"""Drive pantographs along the wire, and write down what happens at every step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.contact import MovingContact, locate
from catenary_fe.fe.energy import EnergyMeter
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.model import Installation, Model, build_model, dropper_damping
from catenary_fe.fe.pantograph import PantographItems, add_pantographs
from catenary_fe.fe.solver import release, solve_dynamic, solve_static
from catenary_fe.fe.solver_settings import TimeSettings
from catenary_fe.fe.wire import hermite
from catenary_fe.system import AnyPantograph, Catenary

Floats = NDArray[np.float64]
Progress = Callable[[float], None]


@dataclass(frozen=True)
class Journey:
    """What a run recorded, at every time step, the initial state included.

    time : [s], shape (times,)
    position : [m], shape (pantographs, times), along the track
    contact_force : [N], shape (pantographs, times), of all strips on all contact wires
    wire_height : [m], shape (pantographs, times), of the contact wire over the head, above its nominal
        height; of several points of contact, their mean
    mass_heights : [m], for each pantograph shape (masses, times), above the nominal contact wire height
    dropper_force : [N], shape (droppers, times)
    support_height : [m], shape (contact wires, spans + 1, times), of the contact wires at the supports
    wire_x, wire_z : [m], for each wire its stations (nodes,) and its heights (shape times, nodes), or none
    wire_times : [s], times of ``wire_z``
    energy : [J], shape (energy_times,), kinetic and stored, or empty
    energy_times : [s]
    driven_work : [J], shape (times,), done by the moving bases, which drive the contact forces over the
        wire's inclination, or empty
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
) -> Journey:
    """Run pantographs, each with its uplift [N], from static contact at their starts at constant speed.

    Raises SolverError where a solve fails.
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
    step = trip.time.step

    def before_step(mbs: exu.MainSystem, end: float) -> bool:
        count = round(end / step)
        recorder.record(count - 1)
        contact.move_to(trip.start + trip.speed * end, trip.speed)
        if progress and count % 50 == 0:
            progress(count / trip.steps)
        return True

    mbs.SetPreStepUserFunction(before_step)
    solve_dynamic(mbs, steps=trip.steps, time=trip.time, what=f"run at {3.6 * trip.speed:g} km/h")
    recorder.record(trip.steps)
    release(mbs)
    return recorder.journey()


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
        self._work = np.zeros(n if trip.energy_interval else 0)
        self._shape_before: Floats | None = None
        self._energy_every = round(trip.energy_interval / trip.time.step) if trip.energy_interval else 0
        self._meter = EnergyMeter(model.mbs) if trip.energy_interval else None
        self._energy: list[float] = []

    def record(self, n: int) -> None:
        data = self._model.mbs.systemData
        q = data.GetODE2Coordinates()
        output, force = self._model.mbs.GetObjectOutput, exu.OutputVariableType.Force
        for i, item in enumerate(self._items):
            self._force[i, n] = sum(output(c.connector, force)[c.wire.up] for c in item.contacts)
            self._wire_height[i, n] = self._height_over(item)
            self._masses[i][:, n] = q[self._mass_index[i]]
        self._support[:, :, n] = q[self._support_index]
        if self._stiffness.size:
            self._dropper[:, n] = self._dropper_tension(q, data.GetODE2Coordinates_t())
        if self._every and n % self._every == 0:
            self._wire.append(q[self._wire_index])
        if self._meter:
            self._add_work(n, q)
            if n % self._energy_every == 0:
                self._energy.append(self._meter.energy())

    def _height_over(self, item: PantographItems) -> float:
        """[m] of the wire over a head, above its nominal height; the mean of its points of contact."""
        position, output = exu.OutputVariableType.Position, self._model.mbs.GetMarkerOutput
        heights = [output(c.wire_marker, position)[c.wire.up] for c in item.contacts]
        return float(sum(heights) / len(heights) - self._model.contact_wire_height)

    def _add_work(self, n: int, q: Floats) -> None:
        """Work of a step as the trapezoidal rule has it: half of each end's force over the other's wire.

        That is what force and wire exchange when the mean of two forces works along a step's displacement.
        """
        after, *_ = self._model.wire_shapes(q)
        before, self._shape_before = self._shape_before, after
        if before is None:
            return
        way = self._trip.speed * self._trip.time.step
        x = self._trip.start + way * n
        first = np.array([self._height(after, xi) - self._height(after, xi - way) for xi in x])
        last = np.array([self._height(before, xi) - self._height(before, xi - way) for xi in x])
        pushed = self._force[:, n - 1] @ first + self._force[:, n] @ last
        self._work[n] = self._work[n - 1] - pushed / 2

    def _height(self, shape: Floats, position: float) -> float:
        element, local = locate(self._model.contact, position)
        length = self._model.contact.line.lengths[element]
        vertical = [self._model.axes - 1, -1]
        return float(hermite(local / length, length) @ shape[element : element + 2, vertical].ravel())

    def _dropper_tension(self, q: Floats, v: Floats) -> Floats:
        span = self._span + q[self._upper] - q[self._lower]
        length = np.linalg.norm(span, axis=1)
        stretch = length - self._model.dropper_lengths
        rate = ((v[self._upper] - v[self._lower]) * span).sum(axis=1) / length
        spring = np.maximum(self._stiffness * stretch, 0.0)
        force: Floats = spring + np.clip(self._damping * rate, -spring, spring)
        return force

    def journey(self) -> Journey:
        trip, model = self._trip, self._model
        time: Floats = np.arange(trip.steps + 1, dtype=np.float64) * trip.time.step
        wires, ends = model.wires, model.mesh.first_nodes
        stored = np.array(self._wire)
        support_z = np.array(
            [w.line.z[m.supports] for w, m in zip(model.contacts, model.mesh.wires, strict=False)]
        )
        return Journey(
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
            energy=np.array(self._energy),
            energy_times=time[:: self._energy_every] if self._meter else np.array([]),
            driven_work=self._work,
        )
