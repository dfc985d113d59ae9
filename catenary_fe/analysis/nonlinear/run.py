"""A catenary ready for compiled nonlinear runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.analysis.linear_arrays import Wires, Work
from catenary_fe.analysis.linear_records import Sizes, load_heads, make_heads, make_records, read_journey
from catenary_fe.analysis.linear_setup import factorise, make_scheme, quads
from catenary_fe.analysis.linear_start import Chain, Start, chain_of
from catenary_fe.analysis.nonlinear.arrays import Ends, Factor, Motion, Slack, Stations, System
from catenary_fe.analysis.nonlinear.cables import Elements
from catenary_fe.analysis.nonlinear.forces import ROOM
from catenary_fe.analysis.nonlinear.steps import advance
from catenary_fe.equilibrium import Shape
from catenary_fe.fe.solver_settings import TimeSettings
from catenary_fe.system import AnyPantograph, SolverError

if TYPE_CHECKING:
    from catenary_fe.fe.drive import Journey
    from catenary_fe.fe.nonlinear_model import ContactStart, NonlinearModel, Springs

Floats = NDArray[np.float64]
Progress = Callable[[float], None]
BLOCK = 250  # steps between looks at progress


class NonlinearCatenary:
    """A catenary for any number of compiled nonlinear runs with one time step.

    Raises SolverError if there is no static equilibrium.
    """

    def __init__(
        self, shape: Shape, time: TimeSettings | None = None, store_wire: float | None = None
    ) -> None:
        from catenary_fe.fe.nonlinear_model import nonlinear_model

        self._shape, self._time = shape, time or TimeSettings()
        self._every = round(store_wire / self._time.step) if store_wire else 0
        self._scheme = make_scheme(self._time)
        self._model = nonlinear_model(shape.catenary, shape.mesh, shape.installation)
        self._system = _system(self._model)
        self._stations = _stations(self._model, shape)
        self._factor = _factor(self._model, self._scheme.b, self._scheme.g)

    def drive(
        self,
        pantographs: Sequence[tuple[AnyPantograph, float]],
        speed: float,
        positions: Floats,
        steps: int,
        progress: Progress | None = None,
    ) -> Journey:
        """Run pantographs, each with its uplift [N], from static contact at constant speed [m/s].

        Raises SolverError where a step does not converge.
        """
        from catenary_fe.fe.nonlinear_model import contact_start

        shape, scheme, h = self._shape, self._scheme, self._time.step
        begin = contact_start(shape.catenary, shape.mesh, shape.installation, pantographs, positions)
        start = self._start(pantographs, positions, speed, begin)
        sizes = _sizes(start.chains, steps, self._every)
        heads = make_heads(1, sizes, shape.catenary.contact_wire_height)
        counts = self._system.droppers.k.size, self._stations.supports.size, self._stations.heights.size
        records = make_records(1, sizes, counts, self._every)
        load_heads(heads, records, 0, scheme, start, steps)
        total, stations = self._model.reference + begin.wires, self._stations
        records.supports[0, :, 0] = total[stations.supports] - stations.rest_supports
        if self._every:
            records.wire[0, 0] = total[stations.heights] - stations.rest
        wires, motion, slack, work = self._room(sizes, start)
        flat = Wires(*(array.reshape(-1) for array in wires))
        state = scheme, self._system, self._stations, self._factor, wires, flat, motion, slack, heads
        self.iterations = 0
        for first in range(0, steps, BLOCK):
            count = min(BLOCK, steps - first)
            failed, iterations = advance(*state, work, records, count, self._time.tolerance)
            self.iterations += iterations
            if failed:
                reached = h * heads.step[0]
                raise SolverError(
                    f"run at {3.6 * speed:g} km/h: no convergence at t = {reached:.4f} s with steps of {h:g}"
                    " s; try a smaller time step, and look at the contact and dropper stiffnesses"
                )
            if progress:
                progress((first + count) / steps)
        return read_journey(records, heads, 0, start, steps, h, shape)

    def _start(
        self,
        pantographs: Sequence[tuple[AnyPantograph, float]],
        positions: Floats,
        speed: float,
        begin: ContactStart,
    ) -> Start:
        model, chains = self._model, []
        for (pantograph, uplift), position, q, forces in zip(
            pantographs, positions, begin.heads, begin.forces, strict=True
        ):
            chain = chain_of(model, pantograph)
            touches = tuple(
                replace(
                    touch,
                    force=float(force),
                    wire_height=self._height(begin, touch.wire, position + touch.ahead),
                )
                for touch, force in zip(chain.touches, forces, strict=True)
            )
            chains.append(replace(chain, uplift=uplift, position=float(position), q=q, touches=touches))
        free = np.zeros(self._system.force.size)
        moves = model.place >= 0
        free[model.place[moves]] = begin.wires[moves]
        return Start(free, chains, _tensions(model, begin.wires), speed)

    def _height(self, begin: ContactStart, wire: int, position: float) -> float:
        from catenary_fe.fe.wire import hermite

        line = self._model.contacts[wire]
        axes, up = self._model.axes, self._model.axes - 1
        first = int(self._shape.mesh.first_nodes[wire])
        e = int(np.clip(np.searchsorted(line.x, position, side="right") - 1, 0, line.x.size - 2))
        xi = (position - line.x[e]) / (line.x[e + 1] - line.x[e])
        nodes = 2 * axes * (first + np.array([e, e + 1]))
        moved = begin.wires[nodes[:, None] + [up, up + axes]]
        values = (line.static[e : e + 2] + moved).ravel()
        return float(hermite(xi, line.lengths[e]) @ values - self._shape.catenary.contact_wire_height)

    def _room(self, sizes: Sizes, start: Start) -> tuple[Wires, Motion, Slack, Work]:
        n, whole = self._system.force.size, self._system.place.size
        wires = Wires(start.q[:, None].copy(), *(np.zeros((n, 1)) for _ in range(4)))
        motion = Motion(np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(whole), np.zeros(whole))
        work = _work(sizes)
        j = 0
        for chain in start.chains:
            for touch in chain.touches:
                work.force[0, j] = touch.force
                j += 1
        return wires, motion, _slack(self._system), work


def _system(model: NonlinearModel) -> System:
    more = -model.size % 4
    cables = model.cables
    idle = np.zeros(more)
    return System(
        reference=model.reference,
        place=model.place,
        elements=Elements(
            cables.first,
            cables.length,
            cables.axial_stiffness,
            cables.bending_stiffness,
            1 + cables.rest_strain,
        ),
        droppers=_ends(model.droppers),
        links=_ends(model.links),
        ground=np.concatenate([model.ground_stiffness, idle]),
        force=np.concatenate([model.force, idle]),
        mass=quads(_padded(model.mass, more, 1.0)),
        damping=quads(_padded(model.damping, more, 0.0)),
    )


def _ends(springs: Springs) -> Ends:
    return Ends(
        springs.first, springs.last, springs.pivot, springs.length, springs.stiffness, springs.damping
    )


def _padded(matrix: object, more: int, diagonal: float) -> object:
    from scipy.sparse import block_diag, identity

    return block_diag([matrix, diagonal * identity(more)]).tocsr() if more else matrix


def _stations(model: NonlinearModel, shape: Shape) -> Stations:
    contacts, mesh = model.contacts, shape.mesh
    up, width = model.axes - 1, 2 * model.axes
    supports = [
        width * (first + wire.supports) + up
        for first, wire in zip(mesh.first_nodes, mesh.wires[: mesh.contact_wires], strict=False)
    ]
    return Stations(
        first=np.cumsum([0, *(wire.x.size for wire in contacts)]),
        x=np.concatenate([wire.x for wire in contacts]),
        lengths=np.concatenate([[*wire.lengths, 1.0] for wire in contacts]),
        static=np.concatenate([wire.static for wire in contacts]),
        lateral=np.concatenate([wire.lateral for wire in contacts]),
        at=np.concatenate([wire.index for wire in contacts]),
        supports=np.concatenate(supports),
        heights=width * np.arange(mesh.first_nodes[-1]) + up,
        rest=np.concatenate([wire.z for wire in shape.wires]),
        rest_supports=np.concatenate(
            [wire.z[m.supports] for wire, m in zip(shape.contact_wires, mesh.wires, strict=False)]
        ),
    )


def _factor(model: NonlinearModel, b: float, g: float) -> Factor:
    matrix = model.mass + g * model.tangent_damping + b * model.tangent
    factor = factorise(_padded(matrix, -model.size % 4, 1.0))
    return Factor(
        quads(factor.L, "lower"),
        quads(factor.L.T, "upper"),
        1 / factor.U.diagonal(),
        np.zeros(factor.shape[0]),
    )


def _sizes(chains: Sequence[Chain], steps: int, every: int) -> Sizes:
    return Sizes(
        pantographs=len(chains),
        contacts=sum(len(chain.touches) for chain in chains),
        coordinates=max([1, *(len(chain.K) for chain in chains)]),
        steps=steps,
        shapes=steps // every + 1 if every else 0,
    )


def _work(sizes: Sizes) -> Work:
    j, m = sizes.contacts, sizes.coordinates
    return Work(
        force=np.zeros((1, j)),
        slack=np.zeros((1, 0)),
        active=np.zeros((1, 0), dtype=np.int64),
        active_count=np.zeros(1, dtype=np.int64),
        column=np.zeros((1, j, ROOM)),
        first=np.zeros((1, j), dtype=np.int64),
        width=np.zeros((1, j), dtype=np.int64),
        shape=np.zeros((1, j, 5)),
        rise=np.zeros((1, j, 5)),
        at=np.zeros((1, j, 4), dtype=np.int64),
        head=np.zeros((1, j, m)),
        soft=np.zeros((1, j, m)),
    )


def _slack(system: System) -> Slack:
    droppers, axes = system.droppers, np.arange(system.droppers.pivot.shape[1])
    ends = np.concatenate([droppers.first[:, None] + axes, droppers.last[:, None] + axes], axis=1)
    count = droppers.first.size
    return Slack(
        lack=np.zeros(count),
        row=np.zeros(ends.shape),
        at=system.place[ends],
        column=np.zeros((count, ROOM)),
        first=np.zeros(count, dtype=np.int64),
        width=np.zeros(count, dtype=np.int64),
    )


def _tensions(model: NonlinearModel, moved: Floats) -> Floats:
    """[N], shape (droppers,), at rest."""
    total, axes = model.reference + moved, np.arange(model.axes)
    droppers = model.droppers
    span = total[droppers.last[:, None] + axes] - total[droppers.first[:, None] + axes]
    force: Floats = droppers.stiffness * (np.linalg.norm(span, axis=1) - droppers.length)
    return np.maximum(force, 0.0)
