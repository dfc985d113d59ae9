"""Runs on a line that answers with its lowest eigenforms only (paper, section 2.2)."""

from __future__ import annotations

import logging
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from catenary_fe.engines.settings import SHORTEST_STEP
from catenary_fe.layout import DescribedPantograph, ElasticPantograph, InputError, Pantograph
from catenary_fe.layout.arguments import checked, number
from catenary_fe.results.modal_run import ModalRun
from catenary_fe.results.modes import Modes
from catenary_fe.statics import Shape

Floats = NDArray[np.float64]
_log = logging.getLogger(__name__)
_PIECES = 8  # straight pieces of an elastic pantograph's law to try in a step


@checked
def modal_run(
    shape: Shape,
    modes: Modes,
    pantograph: DescribedPantograph,
    *,
    speed: float,
    start: float | None = None,
    distance: float | None = None,
    step: float = 1e-3,
    at_rest: bool = False,
) -> ModalRun:
    """Run one pantograph along the line, whose motion is a sum of eigenforms about its static state.

    Droppers stay taut, damping couples no modes, and what the modes above the last one would give is missing.
    Each mode is integrated exactly for a force that changes evenly over a step.

    shape, modes : the line and its modes, of the same mesh; ``modes.below(20.0)`` cuts them off at 20 Hz
    speed : [m/s]
    start : [m] where the pantograph starts; unset: a sixth of the first span
    distance : [m] that it runs; unset: to a sixth of a span before the end
    step : [s]
    at_rest : start from the unloaded line instead of from static contact

    A pantograph's ``mean_force`` is taken as its uplift, which is said in the log.

    Raises InputError where the run does not fit on the line, no mode is left, the modes are of another line
    or mesh, the contact has a damper, or line or head have more than one point of contact.
    """
    number("speed", speed, "m/s", above=0.0)  # no upper bound: studies go beyond the wave speed
    number("step", step, "s", least=SHORTEST_STEP)
    _check_fit(shape, modes)
    margin = float(np.diff(shape.catenary.support_positions).min()) / 6
    first = margin if start is None else start
    way = shape.catenary.length - margin - first if distance is None else distance
    if not (first >= 0 and way > 0 and first + way <= shape.catenary.length):
        raise InputError(
            f"modal run from {first:g} m over {way:g} m: must lie on the line's {shape.catenary.length:g} m"
        )
    if not len(modes):
        raise InputError("modal run: no mode is left below the cut-off; raise it")
    count = int(np.floor(way / (speed * step) + 1e-9)) + 1
    if count < 2:
        raise InputError(
            f"modal run: {way:g} m are passed in less than a step of {step:g} s; shorten the step"
        )
    time: Floats = step * np.arange(count, dtype=np.float64)
    position: Floats = first + speed * time
    line, head = _ModalLine(modes, position, step), _head(pantograph, speed, step)
    sag = shape.contact_wire_height(position) - shape.catenary.contact_wire_height
    force, lift = np.zeros(count), np.zeros(count)
    coordinates, masses = np.zeros((count, len(modes))), np.zeros((count, head.state.size // 2))
    if not at_rest:
        force[0] = head.start(sag[0], line.start_compliance)
        line.start(force[0])
    for n in range(count):
        if n:
            free, give = line.predict(n, force[n - 1])
            force[n] = head.update_contact(sag[n] + free, give, force[n - 1])
            line.finish(n, force[n])
        coordinates[n], lift[n] = line.q, line.shapes[n] @ line.q
        masses[n] = head.heights
    nominal = shape.catenary.contact_wire_height
    return ModalRun(modes, time, position, force, nominal + sag + lift, nominal + masses.T, coordinates)


def _check_fit(shape: Shape, modes: Modes) -> None:
    """Raises InputError for modes of another line or mesh, and for lines with two contact wires."""
    if modes.catenary != shape.catenary or not np.array_equal(modes.contact.x, shape.wires[0].x):
        raise InputError("modal run: the modes are of another line or mesh; give solve_modes(shape)")
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


@dataclass
class _Elastic:
    """A force that depends on the wire's height alone."""

    pantograph: ElasticPantograph
    state: Floats
    heights: Floats

    def start(self, sag: float, give: float) -> float:
        return self.update_contact(sag, give, 0.0)

    def update_contact(self, height: float, give: float, before: float) -> float:
        """[N] at the step's end, on a wire that is ``height`` [m] high unpushed and gives way."""
        force = before
        for _ in range(_PIECES):
            at_zero, stiffness = self.pantograph.tangent(height + give * force)
            met = max(0.0, (at_zero - stiffness * height) / (1 + stiffness * give))
            if abs(met - force) <= 1e-9 * max(1.0, met):
                return met
            force = met
        # the straight pieces alternate; but the wire rises with the force, and the law falls
        from scipy.optimize import brentq

        law = self.pantograph.contact_force
        return float(brentq(lambda f: law(height + give * f) - f, 0.0, law(height)))


class _Chain:
    """Lumped masses in contact over a spring that does not pull."""

    def __init__(self, pantograph: Pantograph, uplift: float, step: float) -> None:
        stages = pantograph.stages
        n = len(stages)
        joints = np.eye(n) - np.eye(n, k=1)  # each spring between its mass and the next, the last to the base
        self._K = joints.T @ np.diag([s.stiffness for s in stages]) @ joints
        D = joints.T @ np.diag([s.damping for s in stages]) @ joints
        inverse = np.diag([1 / s.mass for s in stages])
        system = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ self._K, -inverse @ D]])
        head = np.concatenate([np.zeros(n), -inverse[:, 0]])
        lowest = np.concatenate([np.zeros(n), inverse[:, -1]])
        self._advance, self._before, self._after = _exact_step(system, head, step)
        _, early, late = _exact_step(system, lowest, step)
        self._lifting, self._uplift = uplift * (early + late), uplift
        self._contact = pantograph.contact_stiffness
        self.state = np.zeros(2 * n)

    @property
    def heights(self) -> Floats:
        return self.state[: self.state.size // 2]

    def start(self, sag: float, give: float) -> float:
        """Static contact: masses, contact force and wire together."""
        n = self.heights.size
        system, right = np.zeros((n + 1, n + 1)), np.zeros(n + 1)
        system[:n, :n], system[0, n], right[n - 1] = self._K, 1.0, self._uplift
        system[n, 0], system[n, n], right[n] = 1.0, -1 / self._contact - give, sag
        solved = np.linalg.solve(system, right)
        self.state[:n] = solved[:n]
        return float(solved[n])

    def update_contact(self, height: float, give: float, before: float) -> float:
        free = self._advance @ self.state + self._before * before + self._lifting
        depth = free[0] - height
        yielding = 1 + self._contact * (give - self._after[0])
        force = max(0.0, float(self._contact * depth / yielding))
        self.state = free + self._after * force
        return force


def _head(pantograph: DescribedPantograph, speed: float, step: float) -> _Elastic | _Chain:
    if isinstance(pantograph, ElasticPantograph):
        return _Elastic(pantograph, np.zeros(0), np.zeros(0))
    if pantograph.head and pantograph.head.strips > 1:
        raise InputError(
            f"{pantograph.name}: head.strips = 2: a modal run has one point of contact; leave the head out,"
            " or use simulate"
        )
    if pantograph.mean_force is not None:
        _log.warning(
            f"{pantograph.name}: a modal run takes mean_force as the uplift; with the base's spring the mean"
            " comes out a little different"
        )
    if pantograph.contact_damping:
        raise InputError(
            f"{pantograph.name}: contact_damping = {pantograph.contact_damping:g} N s/m: a modal run has no"
            " damper in the contact; leave it out, or use simulate"
        )
    return _Chain(pantograph, pantograph.static_uplift(speed), step)
