"""Single wires in motion, on any engine: the runs behind the paper's figures.

Without weight and from a straight line unless asked otherwise: to be compared with closed forms.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.arrays import PantographParameters, Records
from catenary_fe.engines.base import Progress
from catenary_fe.engines.generalized_alpha import at_start
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.contact import PlacedPantograph
from catenary_fe.fe.single_wire import initial_velocity, pair_system, wire_system
from catenary_fe.fe.system import System
from catenary_fe.fe.wire_problem import (
    Load,
    PairMotion,
    SlidingPantograph,
    WireMotion,
    WirePair,
    WireProblem,
)
from catenary_fe.layout import InputError, SolverError
from catenary_fe.layout.arguments import checked, number, one_of
from catenary_fe.layout.bodies import ContactLaw, Strip
from catenary_fe.layout.substructure import Substructure
from catenary_fe.statics.newton import free_part, solve_loaded
from catenary_fe.theory import ElasticPantograph, MovingForce

Floats = NDArray[np.float64]
WireMethod = Literal["nonlinear", "linearised", "exudyn"]
MOST_STEPS = 10_000_000  # what they record would fill the memory
_NEAR = 1e-3  # [m] about the expected deflection, where a law is sampled


@checked
def run_wire(
    problem: WireProblem,
    *,
    duration: float,
    time: TimeSettings | None = None,
    interval: float | None = None,
    energy: bool = False,
    progress: Progress | None = None,
    method: WireMethod = "nonlinear",
) -> WireMotion:
    """Integrate from the initial deflection and velocity.

    duration : [s], a whole number of steps
    time : settings of the integration; unset: steps of 0.5 ms
    interval : [s] between stored times, a whole number of steps; unset: every step
    energy : store the energy of the wire and its springs too; not with a sliding pantograph, nor linearised
    progress : called with the share done, 0 to 1
    method : engine, "nonlinear", "linearised" about the line where the wire is let go, or "exudyn"

    Raises InputError for a duration or interval that is no whole number of steps, SolverError if a step does
    not converge.
    """
    one_of("method", method, get_args(WireMethod))
    time = time or TimeSettings(step=5e-4, tolerance=1e-6)
    steps = _steps("duration", duration, time.step)
    every = 1 if interval is None else _steps("interval", interval, time.step)
    if energy and any(isinstance(load, SlidingPantograph) for load in problem.loads):
        raise InputError("energy: not known for a wire with a sliding pantograph; leave it out")
    if energy and method == "linearised":
        raise InputError("energy: linearised runs do not record it; take the method 'nonlinear'")
    system = wire_system(problem)
    run = _WireRun(system, [problem], problem.loads, steps, time, method)
    return run.motions(steps, every, progress, energy=energy)[0]


def run_pair(
    pair: WirePair, *, duration: float, time: TimeSettings, method: WireMethod = "nonlinear"
) -> PairMotion:
    """Integrate from the wires' initial states; all steps are stored.

    Raises SolverError if a step does not converge.
    """
    system, steps = pair_system(pair), _steps("duration", duration, time.step)
    run = _WireRun(system, [pair.lower, pair.upper], (), steps, time, method)
    lower, upper = run.motions(steps, 1)
    return PairMotion(lower, upper, run.records.droppers[0, 0, : steps + 1].copy())


def wire_at_rest(problem: WireProblem) -> Floats:
    """[m] shape (nodes,), static deflection under the moving forces where they start, and the weight.

    Raises InputError for other loads, SolverError if there is no equilibrium.
    """
    system = wire_system(problem)
    load = np.zeros(system.dof.size)
    for moving in problem.loads:
        if not isinstance(moving, MovingForce):
            raise InputError(f"{type(moving).__name__}: a wire at rest takes forces known in advance only")
        load += moving.contact_force(0.0, 0.0) * system.row(0, moving.start)
    moved, residual = solve_loaded(system, load, 0 * load)
    if residual is not None:
        raise SolverError("wire at rest: no static equilibrium found; look at forces and stiffnesses")
    deflection: Floats = (system.reference + moved)[system.heights]
    return deflection


def vertical_matrices(problem: WireProblem) -> tuple[Any, Any]:
    """Sparse stiffness and mass matrix of small vertical motions, held nodes taken out."""
    system = wire_system(problem)
    (path,) = system.contact_paths
    free = np.sort(path.dof[path.dof >= 0])
    K, M = system.tangent(np.zeros(system.dof.size)), system.free(system.mass)
    return K[free][:, free], M[free][:, free]


def _steps(name: str, value: float, step: float) -> int:
    count = round(number(name, value, "s", above=0.0, most=MOST_STEPS * step) / step)
    if count < 1 or abs(count * step - value) > 1e-6 * step:
        raise InputError(f"{name} = {value!r} s: must be a whole number of steps of {step:g} s")
    return count


def _placed(load: Load, deflection: float) -> PlacedPantograph:
    """A load where it starts, on a wire with this deflection [m] there."""
    if isinstance(load, SlidingPantograph):
        body = load.pantograph.assemble(spatial=False)
        force, uplift, start = body.contact.force(-deflection), load.uplift, load.start
        return PlacedPantograph(body, uplift, start, np.zeros(body.size), *_at_start(force, deflection))
    force = load.contact_force(0.0, deflection)
    law = ContactLaw(0.0, points=((-1.0, force), (0.0, force), (1.0, force)))
    body = Substructure((), (), (), (Strip(),), law)
    return PlacedPantograph(body, 0.0, load.start, np.zeros(0), *_at_start(force, deflection))


def _at_start(force: float, deflection: float) -> tuple[Floats, Floats]:
    return np.array([force if np.isfinite(deflection) else 0.0]), np.array([deflection])


class _WireRun:
    """Wires under moving loads on one of the engines, step by step."""

    def __init__(
        self,
        system: System,
        problems: Sequence[WireProblem],
        loads: Sequence[Load],
        steps: int,
        time: TimeSettings,
        method: WireMethod,
    ) -> None:
        self.system, self._loads, self._time = system, loads, time
        self._deflections = [self._deflection_at(load.start) for load in loads]
        placed = [_placed(load, u) for load, u in zip(loads, self._deflections, strict=True)]
        self._before: list[float | None] = [None] * len(loads)
        self._engine: Any = _engine(method)(system, placed, steps, time)
        self._heads: PantographParameters = self._engine.heads
        self.records: Records = self._engine.records
        for j, load in enumerate(loads):
            self._heads.speed[0, j] = load.speed
        v = np.zeros(system.dof.size)
        for problem, wire in zip(problems, system.wires, strict=True):
            v += initial_velocity(problem, wire.first, v.size)
        self._engine.set_in_motion(v, *self._accelerations(v, placed))

    def _deflection_at(self, position: float) -> float:
        """[m] of the wire at the start; NaN off the wire."""
        x = self.system.wires[0].x
        if not x[0] <= position <= x[-1]:
            return float("nan")
        return float(self.system.row(0, position) @ self.system.reference)

    def _accelerations(self, v: Floats, placed: Sequence[PlacedPantograph]) -> tuple[Floats, Floats]:
        """[m/s²] of all coordinates, and of the pantographs, as they are let go."""
        from scipy.sparse.linalg import spsolve

        system = self.system
        force = system.out_of_balance(np.zeros(v.size)) - system.damping() @ v
        heads = np.zeros((max(len(placed), 1), max([1, *(p.body.size for p in placed)])))
        for i, p in enumerate(placed):
            (push,), body = p.forces, p.body
            if np.isfinite(p.wire_heights[0]):
                force += push * system.row(0, p.position)
            if body.size:
                row = body.row(body.strips[0])
                heads[i, : body.size] = np.linalg.solve(body.mass, p.uplift * body.load - push * row)
        free = spsolve(system.free(system.mass).tocsc(), system.gather(force))
        return system.spread(np.atleast_1d(free)), heads

    def _prepare(self, count: int) -> None:
        """Set the forces of the end of the count-th step."""
        t = count * self._time.step
        for j, load in enumerate(self._loads):
            if isinstance(load, MovingForce):
                self._heads.law[0, j, :, 1] = load.contact_force(t, 0.0)
            elif isinstance(load, ElasticPantograph):
                self._sample(j, load, t, count)

    def _sample(self, j: int, load: ElasticPantograph, t: float, count: int) -> None:
        """Take a law about the deflection that is expected at the step's end, from the last two."""
        now, before = float(self.records.height[0, j, count - 1]), self._before[j]
        self._before[j] = now if np.isfinite(now) else None
        if not np.isfinite(now):
            now = 0.0
        expected = now if before is None else 2 * now - before
        heights = expected + _NEAR * np.array([-1.0, 0.0, 1.0])
        self._heads.law[0, j, :, 0] = heights
        self._heads.law[0, j, :, 1] = [load.contact_force(t, float(u)) for u in heights]

    def motions(
        self, steps: int, every: int, progress: Progress | None = None, *, energy: bool = False
    ) -> list[WireMotion]:
        """Motion of each wire, stored at every so many steps; loads are on the first one."""
        system, taken = self.system, [self._engine.motion()]

        def after(count: int) -> None:
            if count % every == 0:
                taken.append(self._engine.motion())
            if progress and count % 50 == 0:
                progress(count / steps)

        self._engine.integrate(steps, self._prepare, after)
        counts = np.arange(0, steps + 1, every)
        forces, under, heads = self._at_loads(counts)
        found = []
        for i, wire in enumerate(system.wires):
            up = system.heights[wire.first : wire.first + wire.x.size]
            rest = system.reference[up] - (system.reference[up[0]] if i else 0.0)
            found.append(
                WireMotion(
                    t=np.asarray(counts * self._time.step, dtype=np.float64),
                    x=wire.x,
                    deflection=np.array([rest + q[up] for q, _ in taken]),
                    velocity=np.array([v[up] for _, v in taken]),
                    forces=forces,
                    under_loads=under,
                    heads=heads,
                    energy=np.array([_energy(system, q, v) for q, v in taken] if energy else []),
                )
            )
        return found

    def _at_loads(self, counts: NDArray[np.int64]) -> tuple[Floats, Floats, Floats]:
        """Forces [N], deflections and heads' heights [m] at these steps, shape (times, loads) each."""
        records, loads = self.records, self._loads
        shape = counts.size, len(loads)
        force, under, heads = np.zeros(shape), np.full(shape, np.nan), np.full(shape, np.nan)
        for j, load in enumerate(loads):
            force[:, j], under[:, j] = records.force[0, j, counts], records.height[0, j, counts]
            if isinstance(load, SlidingPantograph):
                heads[:, j] = records.masses[0, j, 0, counts]
        return force, under, heads


def _engine(method: WireMethod) -> Callable[..., Any]:
    if method == "exudyn":
        from catenary_fe.engines.exudyn.wire import WireRun

        return WireRun
    return _Nonlinear if method == "nonlinear" else _Linearised


class _Compiled:
    """Steps one by one."""

    def integrate(self, steps: int, before: Callable[[int], None], after: Callable[[int], None]) -> None:
        for count in range(1, steps + 1):
            before(count)
            self.advance()
            after(count)

    def advance(self) -> None:
        raise NotImplementedError


class _Nonlinear(_Compiled):
    def __init__(
        self, system: System, placed: Sequence[PlacedPantograph], steps: int, time: TimeSettings
    ) -> None:
        from catenary_fe.engines.nonlinear.run import NonlinearEngine, NonlinearRun

        self._system = system
        engine = NonlinearEngine(system, time)
        self._run = NonlinearRun(engine, np.zeros(system.dof.size), placed, 0.0, steps)
        self.heads, self.records = self._run.state.heads, self._run.records

    def set_in_motion(self, v: Floats, x: Floats, heads: Floats) -> None:
        self._run.set_in_motion(free_part(self._system, v), free_part(self._system, x), heads)

    def advance(self) -> None:
        self._run.advance(1, read=False)

    def motion(self) -> tuple[Floats, Floats]:
        q, v = self._run.motion()
        return self._system.spread(q), self._system.spread(v)


class _Linearised(_Compiled):
    def __init__(
        self, system: System, placed: Sequence[PlacedPantograph], steps: int, time: TimeSettings
    ) -> None:
        from catenary_fe.engines.linearised.batch import Batch
        from catenary_fe.engines.linearised.run import LinearisedEngine
        from catenary_fe.engines.recorder import InitialState, Sizes
        from catenary_fe.fe.reduction import linear_model

        self._system = system
        self._setup = setup = LinearisedEngine(system, linear_model(system), time).setup
        sizes = Sizes.of([placed], len(setup.model.contacts), steps, 0)
        self._batch = Batch(setup, sizes, 1)
        droppers = system.droppers
        tensions = droppers.tension(droppers.span(system.reference))
        wires = len(setup.model.contacts)
        start = InitialState(np.zeros(setup.size), list(placed), tensions, 0.0, wires)
        self._batch.load(0, start, steps)
        self.heads, self.records = self._batch.heads, self._batch.records
        # heights and vertical slopes: numbers among all coordinates, and among the engine's own
        all_of, own = setup.model.vertical
        self._index, self._dof = all_of[own >= 0], own[own >= 0]

    def set_in_motion(self, v: Floats, x: Floats, heads: Floats) -> None:
        wires, own, scheme = self._batch.wires, self._batch.pantographs, self._setup.scheme
        parts = at_start(scheme, np.zeros(self._dof.size), v[self._index], x[self._index])
        for array, values in zip(wires[:4], parts, strict=True):
            array[self._dof, 0] = values
        parts = at_start(scheme, own.q[0].copy(), np.zeros_like(own.q[0]), heads)
        for array, values in zip(own[:4], parts, strict=True):
            array[0] = values

    def advance(self) -> None:
        self._batch.advance(1)

    def motion(self) -> tuple[Floats, Floats]:
        wires, scheme = self._batch.wires, self._setup.scheme
        found = []
        for values, share in ((wires.q, scheme.b), (wires.v, scheme.g)):
            spread = np.zeros(self._system.dof.size)
            spread[self._index] = (values + share * wires.x)[self._dof, 0]
            found.append(spread)
        return found[0], found[1]


def _energy(system: System, q: Floats, v: Floats) -> float:
    return system.energy(q) + float(v @ (system.mass @ v) / 2)
