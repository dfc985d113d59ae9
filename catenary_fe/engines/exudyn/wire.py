"""Single wires under moving loads, integrated by Exudyn."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from types import SimpleNamespace

import exudyn as exu
import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.exudyn.build import add_line
from catenary_fe.engines.exudyn.contact import Contacts, PantographParts, add_pantograph
from catenary_fe.engines.exudyn.solver import new_system, release, solve_dynamic
from catenary_fe.engines.recorder import Sizes, make_pantographs, make_records
from catenary_fe.engines.settings import TimeSettings
from catenary_fe.fe.contact import PlacedPantograph
from catenary_fe.fe.system import System
from catenary_fe.layout import SolverError

Floats = NDArray[np.float64]
_BOTH = (exu.ConfigurationType.Initial, exu.ConfigurationType.Current)
_TENSION = exu.OutputVariableType.Force


class WireRun:
    """Wires, and loads on the first one: pantographs with bodies, or forces that are set before each step.

    heads : speeds and laws of the loads, as compiled runs have them; of a force, the middle of its law is it
    records : forces, heights, masses and droppers
    """

    def __init__(
        self, system: System, placed: Sequence[PlacedPantograph], steps: int, time: TimeSettings
    ) -> None:
        self._system, self._placed, self._time = system, placed, time
        self._mbs = mbs = new_system()
        self._line = line = add_line(mbs, system)
        contact = line["wires"][:1]
        self._parts: list[PantographParts | None] = [
            add_pantograph(mbs, system, contact, line["ground"], SimpleNamespace(assemble=self._body(p)))
            if p.body.size
            else None
            for p in placed
        ]
        mbs.Assemble()
        sliding = [parts for parts in self._parts if parts]
        self._contacts = Contacts(mbs, system, contact, sliding)
        for parts, p in zip(self._parts, placed, strict=True):
            for load, at in parts.loads if parts else ():
                mbs.SetLoadParameter(load, "load", float(p.body.load[at]) * p.uplift)
        sizes = Sizes.of([placed], 1, steps, 0)
        self.heads, _ = make_pantographs(1, sizes, 0.0, system.base_line)
        self.records = make_records(1, sizes, (system.droppers.length.size, 0, 0, 0), 0)
        for j, p in enumerate(placed):
            if p.body.contact.points:
                self.heads.law[0, j] = p.body.contact.points

    @staticmethod
    def _body(placed: PlacedPantograph) -> Callable[..., object]:
        return lambda *, spatial, height: placed.body

    def set_in_motion(self, v: Floats, x: Floats, heads: Floats) -> None:
        """Begin with velocities [m/s], shape (all,); Exudyn finds the accelerations by itself."""
        rates = self._mbs.systemData.GetODE2Coordinates_t()
        rates[: v.size] = v
        for configuration in _BOTH:
            self._mbs.systemData.SetODE2Coordinates_t(rates, configuration=configuration)

    def integrate(self, steps: int, before: Callable[[int], None], after: Callable[[int], None]) -> None:
        """Take steps, each between two calls with its number. Raises SolverError without convergence."""
        self._apply(0)
        self._record(0)

        def before_step(end: float) -> None:
            count = round(end / self._time.step)
            if count > 1:
                self._record(count - 1)
                after(count - 1)
            before(count)
            self._apply(count)

        try:
            if not solve_dynamic(self._mbs, steps, self._time, before_step, 0.0):
                raise SolverError("wire: no convergence; try a smaller time step")
            self._record(steps)
            after(steps)
        finally:
            release(self._mbs)

    def _place(self, j: int, count: int) -> tuple[float, bool]:
        """[m] along the track of a load at a step's end, and whether that is on the wire."""
        position = self._placed[j].position + self.heads.speed[0, j] * self._time.step * count
        x = self._system.wires[0].x
        return float(position), bool(x[0] <= position <= x[-1])

    def _apply(self, count: int) -> None:
        force, moved = self._system.force.copy(), []
        for j, parts in enumerate(self._parts):
            position, on = self._place(j, count)
            if parts is None and on:
                force += self.heads.law[0, j, 1, 1] * self._system.row(0, position)
            elif parts:
                self._mbs.SetObjectParameter(parts.contacts[0].connector, "activeConnector", on)
                x = self._system.wires[0].x
                moved.append((float(np.clip(position, x[0], x[-1])), self.heads.speed[0, j]))
        self._mbs.SetObjectParameter(self._line["loads"], "forceVector", force)
        if moved:
            self._contacts.move_to([position for position, _ in moved], float(moved[0][1]))

    def _record(self, n: int) -> None:
        q, system = self._mbs.systemData.GetODE2Coordinates(), self._system
        total = system.reference + q[: system.dof.size]
        for j, parts in enumerate(self._parts):
            position, on = self._place(j, n)
            self.records.height[0, j, n] = system.row(0, position) @ total if on else np.nan
            known = self.heads.law[0, j, 1, 1] if parts is None else self._contacts.force(parts.contacts[0])
            self.records.force[0, j, n] = known if on else 0.0
            if parts:
                own = q[parts.index(self._mbs)]
                self.records.masses[0, j, : own.size, n] = own
        for i, dropper in enumerate(self._line["droppers"]):
            self.records.droppers[0, i, n] = np.linalg.norm(self._mbs.GetObjectOutput(dropper, _TENSION))

    def motion(self) -> tuple[Floats, Floats]:
        """Displacements and velocities now, shape (all,) each."""
        data, size = self._mbs.systemData, self._system.dof.size
        return data.GetODE2Coordinates()[:size], data.GetODE2Coordinates_t()[:size]
