"""Drive pantographs along the wire, and write down what happens at every step."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.contact import MovingContact, PantographItems, add_pantographs, locate
from catenary_fe.fe.energy import EnergyMeter
from catenary_fe.fe.mesh import Mesh
from catenary_fe.fe.model import Installation, Model, build_model, dropper_damping
from catenary_fe.fe.solver import solve_dynamic, solve_static
from catenary_fe.fe.solver_settings import TimeSettings
from catenary_fe.fe.wire import COORDINATES, UP, hermite
from catenary_fe.system import AnyPantograph, Catenary

Floats = NDArray[np.float64]
Progress = Callable[[float], None]


@dataclass(frozen=True)
class Journey:
    """What a run recorded, at every time step, the initial state included.

    time : [s], shape (times,)
    position : [m], shape (pantographs, times), along the track
    contact_force : [N], shape (pantographs, times)
    wire_height : [m], shape (pantographs, times), of the contact wire over the head, above its nominal height
    mass_heights : [m], for each pantograph shape (masses, times), above the nominal contact wire height
    dropper_force : [N], shape (droppers, times)
    support_height : [m], shape (spans + 1, times), of the contact wire at the supports
    wire_x, wire_z : [m], stations (nodes,) of the contact wire and its heights (shape times, nodes), or None
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
    wire_x: Floats
    wire_z: Floats | None
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
    wire_interval : [s] between stored shapes of the contact wire, or None
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
    return recorder.journey()


def raise_heads(model: Model, items: Sequence[PantographItems]) -> None:
    """Start the masses from contact: a pantograph with no base spring has no other equilibrium."""
    mbs = model.mbs
    coordinates = mbs.systemData.GetODE2Coordinates(configuration=exu.ConfigurationType.Initial)
    for item in items:
        gap = float(mbs.GetObjectOutput(item.connector, exu.OutputVariableType.Displacement)[UP])
        for node in item.nodes:
            coordinates[mbs.systemData.GetNodeLTGODE2(node)[0]] = 1e-3 - gap
    for configuration in (exu.ConfigurationType.Initial, exu.ConfigurationType.Current):
        mbs.systemData.SetODE2Coordinates(coordinates, configuration=configuration)


class _Recorder:
    """Reads the state at each step; what it keeps is small beside the state itself."""

    def __init__(self, model: Model, items: Sequence[PantographItems], trip: Trip) -> None:
        self._model, self._items, self._trip = model, items, trip
        n, catenary = trip.steps + 1, model.catenary
        self._force = np.zeros((len(items), n))
        self._gap = np.zeros((len(items), n))
        self._masses = [np.zeros((len(item.nodes), n)) for item in items]
        self._mass_index = [
            [model.mbs.systemData.GetNodeLTGODE2(node)[0] for node in item.nodes] for item in items
        ]
        self._dropper = np.zeros((len(catenary.droppers), n))
        self._stiffness = np.array([d.stiffness for d in catenary.droppers])
        self._damping = dropper_damping(catenary)
        offset = COORDINATES * len(model.contact.nodes)
        lower = COORDINATES * model.mesh.contact.droppers
        upper = offset + COORDINATES * model.mesh.messenger.droppers
        self._lower, self._upper = lower[:, None] + [0, UP], upper[:, None] + [0, UP]
        contact, messenger = model.contact.line, model.messenger.line
        self._reference = np.concatenate([contact.coordinates().ravel(), messenger.coordinates().ravel()])
        self._span = self._reference[self._upper] - self._reference[self._lower]
        self._support_index = COORDINATES * model.mesh.contact.supports + UP
        self._support = np.zeros((len(catenary.supports), n))
        self._wire_index = COORDINATES * np.arange(len(model.contact.nodes)) + UP
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
        for i, item in enumerate(self._items):
            output = self._model.mbs.GetObjectOutput
            self._force[i, n] = output(item.connector, exu.OutputVariableType.Force)[UP]
            self._gap[i, n] = output(item.connector, exu.OutputVariableType.Displacement)[UP]
            self._masses[i][:, n] = q[self._mass_index[i]]
        self._support[:, n] = q[self._support_index]
        if self._stiffness.size:
            self._dropper[:, n] = self._dropper_tension(q, data.GetODE2Coordinates_t())
        if self._every and n % self._every == 0:
            self._wire.append(q[self._wire_index])
        if self._meter:
            self._add_work(n, q)
            if n % self._energy_every == 0:
                self._energy.append(self._meter.energy())

    def _add_work(self, n: int, q: Floats) -> None:
        """Work of a step as the trapezoidal rule has it: half of each end's force over the other's wire.

        That is what force and wire exchange when the mean of two forces works along a step's displacement.
        """
        after, _ = self._model.wire_shapes(q)
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
        return float(hermite(local / length, length) @ shape[element : element + 2, [UP, 3]].ravel())

    def _dropper_tension(self, q: Floats, v: Floats) -> Floats:
        span = self._span + q[self._upper] - q[self._lower]
        length = np.hypot(span[:, 0], span[:, 1])
        stretch = length - self._model.dropper_lengths
        rate = ((v[self._upper] - v[self._lower]) * span).sum(axis=1) / length
        spring = np.maximum(self._stiffness * stretch, 0.0)
        force: Floats = spring + np.clip(self._damping * rate, -spring, spring)
        return force

    def journey(self) -> Journey:
        trip, model = self._trip, self._model
        time: Floats = np.arange(trip.steps + 1, dtype=np.float64) * trip.time.step
        wire = np.array(self._wire) if self._wire else None
        nominal = np.zeros((1, time.size))  # an elastic pantograph's law counts from there
        heads = np.array([masses[0] if masses.size else nominal[0] for masses in self._masses])
        line = model.contact.line
        return Journey(
            time=time,
            position=trip.start[:, None] + trip.speed * time,
            contact_force=self._force,
            wire_height=heads - self._gap,
            mass_heights=self._masses,
            dropper_force=self._dropper,
            support_height=line.z[model.mesh.contact.supports, None] + self._support,
            wire_x=line.x,
            wire_z=None if wire is None else line.z + wire,
            wire_times=None if wire is None else time[:: self._every],
            energy=np.array(self._energy),
            energy_times=time[:: self._energy_every] if self._meter else np.array([]),
            driven_work=self._work,
        )
