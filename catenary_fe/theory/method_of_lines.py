"""Method of lines: a supported string or tensioned beam under forces and elastic pantographs (eq. 8)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray, counted, non_negative, numbers, positive, refuse, within
from catenary_fe.theory._lines import Lines, choose_integrator, integrate
from catenary_fe.theory._quadrature import Function
from catenary_fe.theory.forces import Force, force_values

Integrator = Literal["auto", "explicit", "stiff"]


class MovingContact(Protocol):
    """What pushes the wire at start + speed · t."""

    @property
    def start(self) -> float: ...

    @property
    def speed(self) -> float: ...

    def contact_force(self, t: float, deflection: float) -> float:
        """Return the upward force [N] on the wire at time t [s], given the deflection there [m]."""
        ...


@dataclass(frozen=True, kw_only=True)
class MovingForce:
    """A force known in advance, moving along the wire (eq. 5).

    Parameters
    ----------
    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times
    speed : [m/s] not negative
    start : [m] where it is at t = 0; it acts only while it is on the wire

    Raises
    ------
    ValueError
        The speed is negative.
    """

    force: Force
    speed: float
    start: float = 0.0

    def __post_init__(self) -> None:
        non_negative("speed", self.speed, "m/s")

    def contact_force(self, t: float, deflection: float) -> float:
        """Return F(t) [N]; the wire has no say."""
        return float(force_values(self.force, t))


@dataclass(frozen=True, kw_only=True)
class ElasticPantograph:
    """A pantograph whose contact force depends on the wire's deflection above it and never pulls.

    F = max(0, law(u)). Source: paper, section 3.1 (fig. 12), which leaves the law open.

    Parameters
    ----------
    law : [N] force as a function of the deflection [m]; `linear_law` gives the usual one
    speed : [m/s] not negative
    start : [m] where it is at t = 0; it acts only while it is on the wire

    Raises
    ------
    ValueError
        The speed is negative.
    """

    law: Callable[[float], float]
    speed: float
    start: float = 0.0

    def __post_init__(self) -> None:
        non_negative("speed", self.speed, "m/s")

    def contact_force(self, t: float, deflection: float) -> float:
        """Return max(0, law(deflection)) [N]."""
        return max(0.0, float(self.law(deflection)))


def linear_law(*, force: float, stiffness: float) -> Callable[[float], float]:
    """Force F₀ − k u of a pantograph that slackens as the wire rises.

    Parameters
    ----------
    force : [N] F₀ on the undeflected wire
    stiffness : [N/m] k, not negative

    Returns
    -------
    Callable[[float], float]
        [N] as a function of the deflection [m]

    Raises
    ------
    ValueError
        The stiffness is negative.
    """
    slackening = non_negative("stiffness", stiffness, "N/m")
    return lambda deflection: force - slackening * deflection


@dataclass(frozen=True, kw_only=True)
class LinesResult:
    """Motion of the wire, complete.

    Parameters
    ----------
    x : [m] nodes, shape (nodes,)
    t : [s] instants, shape (times,)
    deflection : [m] shape (times, nodes)
    velocity : [m/s] shape (times, nodes)
    forces : [N] of each load on the wire, shape (times, loads); 0 before it enters and after it leaves
    integrator : name of the scheme that was used
    why : reason of that choice, with the numbers
    evaluations : [-] how often the right side was evaluated
    """

    x: FloatArray
    t: FloatArray
    deflection: FloatArray
    velocity: FloatArray
    forces: FloatArray
    integrator: str
    why: str
    evaluations: int

    @property
    def force(self) -> FloatArray:
        """Sum of all loads [N], shape (times,)."""
        return np.asarray(self.forces.sum(axis=1))


def solve_by_lines(
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    bending_stiffness: float = 0.0,
    ends: tuple[float, float],
    intervals: int,
    supports: ArrayLike = (),
    loads: Sequence[MovingContact] = (),
    initial_deflection: Function | None = None,
    initial_velocity: Function | None = None,
    integrator: Integrator = "auto",
    tolerance: float = 1e-5,
    progress: Callable[[float], None] | None = None,
) -> LinesResult:
    """Motion of a string or tensioned beam, second differences in space and a high-order scheme in time.

    ρ ü + EI u'''' − T u'' = Σ F δ(x − a − Vt), u = u'' = 0 at both ends, u = 0 at the supports (over which
    a beam runs through), u = u₀ and u̇ = v₀ at t = 0. u'' ≈ (u₋ − 2u + u₊)/h², u'''' is that applied twice.
    A force acts on its two neighbouring nodes in proportion to nearness, which keeps its sum and its
    moment; the deflection that an elastic pantograph feels is interpolated with the same weights, so that
    the exchange conserves energy. Second order in h where the motion is smooth; kinks under a force on a
    string lower it to about first order.
    Source: paper, eq. 8 and 1 (P = −T); the print divides the second difference by h in place of h².

    Parameters
    ----------
    t : [s] instants of the answer, rising, none negative, shape (times,); the motion starts at 0
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    bending_stiffness : [N m²] EI, 0 for a string
    ends : [m] first and last point of the wire, both pinned
    intervals : [-] number of equal intervals between the ends
    supports : [m] rigid supports, each at a node, at any distances
    loads : moving forces and elastic pantographs
    initial_deflection : [m] u₀, function of positions, 0 at ends and supports; none means straight
    initial_velocity : [m/s] v₀ likewise; none means at rest
    integrator : "explicit" (DOP853), "stiff" (Radau IIA, sparse Jacobian) or "auto" (by stiffness, see `why`)
    tolerance : [-] relative tolerance of the time integration
    progress : called with the fraction done, 0 to 1, about a hundred times

    Returns
    -------
    LinesResult
        motion at nodes and instants, contact forces, the scheme used and why

    Raises
    ------
    ValueError
        Tension, mass or tolerance is not positive, EI negative, fewer than 4 intervals, instants that do
        not rise, a support off the nodes, an initial state that moves a support, or an unknown integrator.
    RuntimeError
        The integrator gave up; the message says where and why.
    """
    instants = _instants(t)
    x = _nodes(ends, intervals)
    lines = Lines(
        x=x,
        fixed=_fixed_nodes(x, supports),
        tension=positive("tension", tension, "N"),
        mass_per_length=positive("mass_per_length", mass_per_length, "kg/m"),
        bending_stiffness=non_negative("bending_stiffness", bending_stiffness, "N m²"),
        loads=tuple(loads),
    )
    start = np.concatenate(
        [
            _initial("initial_deflection", initial_deflection, lines),
            _initial("initial_velocity", initial_velocity, lines),
        ]
    )
    chosen, why = choose_integrator(lines, float(instants[-1]), integrator)
    states, evaluations = integrate(
        lines, start, instants, chosen, positive("tolerance", tolerance, ""), progress
    )
    deflection, velocity = states[:, : x.size], states[:, x.size :]
    forces = np.array([lines.forces(time, u) for time, u in zip(instants, deflection, strict=True)])
    return LinesResult(
        x=x,
        t=instants,
        deflection=deflection,
        velocity=velocity,
        forces=forces.reshape(instants.size, len(loads)),
        integrator=chosen,
        why=why,
        evaluations=evaluations,
    )


def _instants(t: ArrayLike) -> FloatArray:
    instants = np.atleast_1d(numbers("t", t))
    if instants.ndim != 1 or instants.size == 0 or instants[0] < 0.0 or np.any(np.diff(instants) <= 0.0):
        raise refuse(
            "t", instants.tolist()[:4], "must be rising instants from 0 on", "sort them and drop doubles"
        )
    return instants


def _nodes(ends: tuple[float, float], intervals: int) -> FloatArray:
    first, last = numbers("ends", ends)
    if not last > first:
        raise refuse("ends", (float(first), float(last)), "the second must lie beyond the first", "swap them")
    return np.linspace(first, last, counted("intervals", intervals, at_least=4) + 1)


def _fixed_nodes(x: FloatArray, supports: ArrayLike) -> FloatArray:
    """Return the indices of the end nodes and of the supports' nodes."""
    places = np.atleast_1d(within("supports", supports, x[0], x[-1])) if np.size(supports) else np.empty(0)
    step = x[1] - x[0]
    nearest = np.rint((places - x[0]) / step).astype(int)
    off = np.abs(x[nearest] - places) > 1e-6 * step
    if off.any():
        rule = f"must be at a node, every {step:g} m from {x[0]:g} m"
        remedy = f"choose other intervals or move it to {x[nearest[off][0]]:g} m"
        raise refuse("supports", f"{places[off][0]:g} m", rule, remedy)
    return np.unique(np.concatenate([[0, x.size - 1], nearest]))


def _initial(name: str, function: Function | None, lines: Lines) -> FloatArray:
    if function is None:
        return np.zeros(lines.x.size)
    values = np.array(np.broadcast_to(numbers(name, function(lines.x)), lines.x.shape))
    moved = np.abs(values[lines.fixed])
    if np.any(moved > 1e-6 * max(float(np.abs(values).max()), 1e-300)):
        place = lines.x[lines.fixed[np.argmax(moved)]]
        raise refuse(
            name, f"{moved.max():g} at {place:g} m", "must be 0 at ends and supports", "change the shape"
        )
    values[lines.fixed] = 0.0
    return values
