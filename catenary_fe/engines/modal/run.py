"""Runs on a line that answers with its lowest eigenforms only (paper, section 2.2)."""

from __future__ import annotations

import logging

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.compiled import plain
from catenary_fe.engines.contact_solver import solve_points
from catenary_fe.engines.settings import SHORTEST_STEP
from catenary_fe.layout import AnyPantograph, InputError
from catenary_fe.layout.arguments import checked, number
from catenary_fe.layout.substructure import Substructure
from catenary_fe.results.modes import ModalRun, Modes
from catenary_fe.statics import Shape

Floats = NDArray[np.float64]
_log = logging.getLogger(__name__)


@checked
def modal_run(
    shape: Shape,
    modes: Modes,
    pantograph: AnyPantograph,
    *,
    speed: float,
    start: float | None = None,
    distance: float | None = None,
    step: float = 1e-3,
    at_rest: bool = False,
) -> ModalRun:
    """Run one pantograph along the line, whose motion is a sum of eigenforms about its static state.

    Droppers stay taut, damping couples no modes, and what the modes above the last one would add is missing.
    Each mode is integrated exactly for a force that changes evenly over a step.

    shape, modes : the line and its modes, of the same mesh; ``modes.below(20.0)`` cuts them off at 20 Hz
    speed : [m/s]
    start : [m] where the pantograph starts; unset: a sixth of the first span
    distance : [m] that it runs; unset: to a sixth of a span before the end
    step : [s]
    at_rest : start from the unloaded line instead of from static contact

    A pantograph's ``mean_force`` is taken as its uplift, which is said in the log.

    Raises InputError where the run does not fit on the line, no mode is left, the modes are of another line
    or mesh, the contact has a damper, the pantograph is not linear, or line or head have more than one point
    of contact.
    """
    number("speed", speed, "m/s", above=0.0)  # no upper bound: studies go beyond the wave speed
    _check_fit(shape, modes, step)
    margin = float(np.diff(shape.catenary.support_positions).min()) / 6
    first = margin if start is None else start
    way = shape.catenary.length - margin - first if distance is None else distance
    if not (first >= 0 and way > 0 and first + way <= shape.catenary.length):
        raise InputError(
            f"modal run from {first:g} m over {way:g} m: must lie on the line's {shape.catenary.length:g} m"
        )
    count = int(np.floor(way / (speed * step) + 1e-9)) + 1
    if count < 2:
        raise InputError(
            f"modal run: {way:g} m are passed in less than a step of {step:g} s; shorten the step"
        )
    time: Floats = step * np.arange(count, dtype=np.float64)
    position: Floats = first + speed * time
    line, head = _ModalLine(modes, position, step), _head(pantograph, speed, step)
    nominal = shape.catenary.contact_wire_height
    sag = shape.contact_wire_height(position) - nominal
    force, lift = np.zeros(count), np.zeros(count)
    coordinates, masses = np.zeros((count, len(modes))), np.zeros((count, head.state.size // 2))
    if not at_rest:
        force[0] = head.start(sag[0], line.start_compliance)
        line.start(force[0])
    for n in range(count):
        if n:
            free, compliance = line.predict(n, force[n - 1])
            force[n] = head.push(sag[n] + free, compliance, force[n - 1])
            line.finish(n, force[n])
        coordinates[n], lift[n] = line.q, line.shapes[n] @ line.q
        masses[n] = head.heights
    return ModalRun(modes, time, position, force, nominal + sag + lift, nominal + masses.T, coordinates)


def _check_fit(shape: Shape, modes: Modes, step: float) -> None:
    """Raises InputError for no modes, those of another line or mesh, and for lines with two contact wires."""
    number("step", step, "s", least=SHORTEST_STEP)
    if not len(modes):
        raise InputError("modal run: no mode is left below the cut-off; raise it")
    if modes.catenary != shape.catenary or not np.array_equal(modes.contact.x, shape.wires[0].x):
        raise InputError("modal run: the modes are of another line or mesh; give solve_modes(shape)")
    if shape.catenary.changes_height:
        raise InputError("modal run: the contact wire changes its height along the line; use simulate")
    line = shape.system
    if line.base_line.motions or line.time_loads or any(path.irregularity for path in line.contact_paths):
        raise InputError(
            "modal run: gusts, a base that moves and an uneven contact wire are not in it; leave them out of"
            " the conditions, or use simulate"
        )
    if len(shape.contact_wires) > 1:
        raise InputError("modal run: the line has two contact wires, the modal run knows one; use simulate")


class _ModalLine:
    """Modal coordinates and their step from time to time."""

    def __init__(self, modes: Modes, position: Floats, step: float) -> None:
        omega = 2 * np.pi * modes.frequencies
        system = np.zeros((omega.size, 2, 2))
        system[:, 0, 1] = 1.0
        system[:, 1, 0] = -(omega**2)
        system[:, 1, 1] = -2 * modes.damping_ratios * omega
        self._advance, self._before, self._after = _exact_step(system, np.array([0.0, 1.0]), step)
        self.shapes: Floats = np.ascontiguousarray(modes.contact.at(position).T)
        self._state = np.zeros((omega.size, 2))
        self._static = self.shapes[0] / omega**2

    @property
    def q(self) -> Floats:
        coordinates: Floats = self._state[:, 0]
        return coordinates

    @property
    def start_compliance(self) -> float:
        """[m/N] where the run starts."""
        return float(self.shapes[0] @ self._static)

    def start(self, force: float) -> None:
        self._state[:, 0] = force * self._static

    def predict(self, n: int, force: float) -> tuple[float, float]:
        """Lift [m] over the head at the step's end without the force there, and what a unit force adds."""
        self._state = np.einsum("mij,mj->mi", self._advance, self._state)
        self._state += self._before * (force * self.shapes[n - 1])[:, None]
        shape = self.shapes[n]
        return float(shape @ self._state[:, 0]), float(shape**2 @ self._after[:, 0])

    def finish(self, n: int, force: float) -> None:
        self._state += self._after * (force * self.shapes[n])[:, None]


def _exact_step(system: Floats, gain: Floats, step: float) -> tuple[Floats, Floats, Floats]:
    """Transition of ẋ = A x + b f for f that changes evenly, and the parts of f before and after the step."""
    from scipy.linalg import expm

    n = system.shape[-1]
    augmented = np.zeros((*system.shape[:-2], n + 2, n + 2))
    augmented[..., :n, :n] = system
    augmented[..., :n, n] = gain
    augmented[..., n, n + 1] = 1.0
    whole = expm(step * augmented)
    after = whole[..., :n, n + 1] / step
    return whole[..., :n, :n], whole[..., :n, n] - after, after


class _Head:
    """A pantograph on one point of contact."""

    def __init__(self, body: Substructure, uplift: float, step: float) -> None:
        n, M = body.size, body.mass
        self._body, self._uplift = body, uplift
        self._row = body.row(body.strips[0])
        inverse = np.diag(1 / np.diag(M))
        still = np.zeros(n)
        system = np.block(
            [[np.zeros((n, n)), np.eye(n)], [-inverse @ body.stiffness, -inverse @ body.damping]]
        )
        pushed = np.concatenate([still, -inverse @ self._row])
        self._advance, self._before, self._after = _exact_step(system, pushed, step)
        _, early, late = _exact_step(system, np.concatenate([still, inverse @ body.load]), step)
        self._lifting = uplift * (early + late)
        self.state = np.zeros(2 * n)

    @property
    def heights(self) -> Floats:
        return self.state[: self._body.size]

    def start(self, sag: float, compliance: float) -> float:
        """Static contact: masses, contact force and wire together."""
        body = self._body
        if not body.size:
            return self._solved(-sag, compliance)
        own = np.linalg.solve(body.stiffness, np.column_stack([self._uplift * body.load, self._row]))
        force = self._solved(float(self._row @ own[:, 0]) - sag, compliance + float(self._row @ own[:, 1]))
        self.state[: body.size] = own[:, 0] - force * own[:, 1]
        return force

    def push(self, height: float, compliance: float, before: float) -> float:
        """[N] at the step's end, on a wire ``height`` [m] high unpushed that yields by ``compliance``."""
        n = self._body.size
        free = self._advance @ self.state + self._before * before + self._lifting
        depth = float(self._row @ free[:n]) - height
        force = self._solved(depth, compliance - float(self._row @ self._after[:n]))
        self.state = free + self._after * force
        return force

    def _solved(self, depth: float, compliance: float) -> float:
        """[N] of the law where each newton takes ``compliance`` [m] off the depth."""
        law = self._body.contact
        if law.points:
            return plain(solve_points)(np.array(law.points), len(law.points), -depth, compliance)
        return max(0.0, (law.preload + law.stiffness * depth) / (1 + law.stiffness * compliance))


def _head(pantograph: AnyPantograph, speed: float, step: float) -> _Head:
    body = pantograph.assemble(spatial=False, speed=speed)
    if len(body.strips) > 1:
        raise InputError(
            f"{pantograph.name}: head.strips = 2: a modal run has one point of contact; leave the head out,"
            " or use simulate"
        )
    if body.laws:
        raise InputError(
            f"{pantograph.name}: stops, dry friction, dampers that differ up and down and frames that are not"
            " linear are not in a modal run; leave them out, or use simulate"
        )
    if pantograph.target_mean_force(speed) is not None:
        _log.warning(
            f"{pantograph.name}: a modal run takes mean_force as the uplift; with the base's spring the mean"
            " comes out a little different"
        )
    if body.contact.damping:
        raise InputError(
            f"{pantograph.name}: contact_damping = {body.contact.damping:g} N s/m: a modal run has no"
            " damper in the contact; leave it out, or use simulate"
        )
    return _Head(body, pantograph.static_uplift(speed), step)
