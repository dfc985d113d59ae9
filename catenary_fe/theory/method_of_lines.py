"""Method of lines: a supported string or tensioned beam under forces and elastic pantographs (eq. 8)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._numerics import FloatArray, Function, counted, numbers, positive, refuse, within
from catenary_fe.theory.forces import MovingLoad
from catenary_fe.theory.wires import String, known

# |R(iy)| ≤ 1 of DOP853 on the imaginary axis up to here (computed from scipy's coefficients: 5.96)
_EXPLICIT_LIMIT = 5.9
# Explicit steps that stability may cost for each step that following the wave needs. Measured on a wire with
# EI = 200 kN m², meshed ever finer: an undamped wire makes the stiff scheme follow fast waves too, so that
# it pays only from about here (twice as slow at 34, twice as fast at 69).
_AFFORDABLE = 50.0
_SMALL = 1e-9  # [m] deflection that does not matter
_STEP_OF_LAW = 1e-6  # [m]


@dataclass(frozen=True, kw_only=True)
class LinesResult:
    """Motion of the wire, complete.

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
        """[N] sum of all loads, shape (times,)."""
        return np.asarray(self.forces.sum(axis=1))


def solve_by_lines(
    wire: String,
    t: ArrayLike,
    *,
    ends: tuple[float, float],
    intervals: int,
    supports: ArrayLike = (),
    loads: Sequence[MovingLoad] = (),
    initial_deflection: Function | None = None,
    initial_velocity: Function | None = None,
    integrator: Literal["auto", "explicit", "stiff"] = "auto",
    tolerance: float = 1e-5,
) -> LinesResult:
    """Motion of a wire, by second differences in space and a high-order scheme in time.

    ρ ü + EI u'''' − T u'' + k u = Σ F δ(x − a − Vt), u = u'' = 0 at both ends, u = 0 at the supports (over
    which a beam runs through), u = u₀ and u̇ = v₀ at t = 0. u'' ≈ (u₋ − 2u + u₊)/h², u'''' is that applied
    twice. A force acts on its two neighbouring nodes in proportion to nearness, which keeps its sum and its
    moment; the deflection that an elastic pantograph feels is interpolated with the same weights, so that
    the exchange conserves energy. Second order in h where the motion is smooth; kinks under a force on a
    string lower it to about first order.
    Source: paper, eq. 8 and 1 (P = −T); the print divides the second difference by h in place of h².

    t : [s] instants of the answer, rising, none negative, shape (times,); the motion starts at 0
    ends : [m] first and last point of the wire, both pinned
    intervals : [-] number of equal intervals between the ends, at least 4
    supports : [m] rigid supports, each at a node, at any distances
    loads : moving forces and elastic pantographs
    initial_deflection : [m] u₀, function of positions, 0 at ends and supports; none: straight
    initial_velocity : [m/s] v₀ likewise; none: at rest
    integrator : "explicit" (DOP853), "stiff" (Radau IIA, sparse Jacobian) or "auto" (by stiffness, see `why`)
    tolerance : [-] relative tolerance of the time integration

    Raises ValueError also for a support off the nodes and an initial state that moves a support;
    RuntimeError where the integration fails.
    """
    instants, x = _instants(t), _nodes(ends, intervals)
    lines = Lines(x, _fixed_nodes(x, supports), known(wire), tuple(loads))
    given = {"initial_deflection": initial_deflection, "initial_velocity": initial_velocity}
    start = np.concatenate([_initial(name, function, lines) for name, function in given.items()])
    scheme, why = _choose_scheme(lines, float(instants[-1]), integrator)
    states, evaluations = _integrate(lines, start, instants, scheme, positive("tolerance", tolerance, ""))
    deflection = states[:, : x.size]
    forces = [
        [lines.force(load, time, u) for load in loads] for time, u in zip(instants, deflection, strict=True)
    ]
    return LinesResult(
        x=x,
        t=instants,
        deflection=deflection,
        velocity=states[:, x.size :],
        forces=np.array(forces).reshape(instants.size, len(loads)),
        integrator=scheme,
        why=why,
        evaluations=evaluations,
    )


def _instants(t: ArrayLike) -> FloatArray:
    instants = np.atleast_1d(numbers("t", t))
    if instants.ndim != 1 or instants.size == 0 or instants[0] < 0.0 or np.any(np.diff(instants) <= 0.0):
        rule = "must be rising instants from 0 on"
        raise refuse("t", instants.tolist()[:4], rule, "sort them and drop doubles")
    return instants


def _nodes(ends: tuple[float, float], intervals: int) -> FloatArray:
    first, last = numbers("ends", ends)
    if not last > first:
        raise refuse("ends", (float(first), float(last)), "the second must lie beyond the first", "swap them")
    return np.linspace(first, last, counted("intervals", intervals, at_least=4) + 1)


def _fixed_nodes(x: FloatArray, supports: ArrayLike) -> Any:
    """Indices of the end nodes and of the supports' nodes."""
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
        value = f"{moved.max():g} at {lines.x[lines.fixed[np.argmax(moved)]]:g} m"
        raise refuse(name, value, "must be 0 at ends and supports", "change the shape")
    values[lines.fixed] = 0.0
    return values


@dataclass(frozen=True)
class Lines:
    """ρ ü + EI u'''' − T u'' + k u = f at equidistant nodes, some of them fixed; state (u, v)."""

    x: FloatArray
    fixed: Any
    wire: String
    loads: Sequence[MovingLoad]

    @property
    def step(self) -> float:
        """[m] between nodes."""
        return float((self.x[-1] - self.x[0]) / (self.x.size - 1))

    @property
    def highest_frequency(self) -> float:
        """[rad/s] bound of the largest angular frequency of the lines, that of the shortest wave, 2h long."""
        w, second = self.wire, 4.0 / self.step**2
        elastic = w.tension * second + w.bending_stiffness * second**2 + w.foundation_stiffness
        return float(np.sqrt(elastic / w.mass_per_length))

    @property
    def resolving_step(self) -> float:
        """[s] in which the string's wave, or a faster load, passes from node to node."""
        return self.step / max([self.wire.wave_speed, *(load.speed for load in self.loads)])

    @cached_property
    def operator(self) -> Any:
        """Sparse matrix from deflections to free accelerations."""
        from scipy.sparse import diags, eye

        count = self.x.size
        inner = np.ones(count)
        inner[[0, -1]] = 0.0  # pinned ends: u'' = 0, so that the fourth difference next to them is right too
        second = diags([1.0, -2.0, 1.0], [-1, 0, 1], shape=(count, count)) / self.step**2
        second = diags(inner) @ second
        free = np.ones(count)
        free[self.fixed] = 0.0
        elastic = self.wire.tension * eye(count) - self.wire.bending_stiffness * second
        force = elastic @ second - self.wire.foundation_stiffness * eye(count)
        return (diags(free) @ force / self.wire.mass_per_length).tocsr()

    def _weights(self, load: MovingLoad, t: float) -> tuple[int, float, float] | None:
        """Left node and shares of the two nodes around the load; none while it is off the wire."""
        place = (load.start + load.speed * t - self.x[0]) / self.step
        if not 0.0 <= place <= self.x.size - 1:
            return None
        left = min(int(place), self.x.size - 2)
        return left, 1.0 - (place - left), place - left

    def force(self, load: MovingLoad, t: float, u: FloatArray) -> float:
        """[N] of a load on the wire."""
        where = self._weights(load, t)
        if where is None:
            return 0.0
        left, near, far = where
        return load.contact_force(t, float(near * u[left] + far * u[left + 1]))

    def rates(self, t: float, state: FloatArray) -> FloatArray:
        """(u̇, v̇)."""
        count = self.x.size
        u = state[:count]
        acceleration = self.operator @ u
        for load in self.loads:
            where = self._weights(load, t)
            if where is None:
                continue
            left, near, far = where
            push = self.force(load, t, u) / (self.wire.mass_per_length * self.step)
            acceleration[left] += near * push
            acceleration[left + 1] += far * push
        acceleration[self.fixed] = 0.0
        return np.concatenate([state[count:], acceleration])

    @cached_property
    def _first_order(self) -> Any:
        from scipy.sparse import bmat, identity

        return bmat([[None, identity(self.x.size)], [self.operator, None]], format="csc")

    def jacobian(self, t: float, state: FloatArray) -> Any:
        """∂(u̇, v̇)/∂(u, v), sparse; a law's slope is taken by a central difference."""
        from scipy.sparse import coo_matrix

        count = self.x.size
        total = self._first_order
        for load in self.loads:
            where = self._weights(load, t)
            if where is None:
                continue
            left, near, far = where
            u = float(near * state[left] + far * state[left + 1])
            change = load.contact_force(t, u + _STEP_OF_LAW) - load.contact_force(t, u - _STEP_OF_LAW)
            if change == 0.0:
                continue
            nodes, shares = np.array([left, left + 1]), np.array([near, far])
            shares_of_free = shares * ~np.isin(nodes, self.fixed)
            slope = change / (2.0 * _STEP_OF_LAW * self.wire.mass_per_length * self.step)
            entries = slope * np.outer(shares_of_free, shares)
            rows, columns = np.repeat(nodes + count, 2), np.tile(nodes, 2)
            total = total + coo_matrix((entries.ravel(), (rows, columns)), shape=total.shape).tocsc()
        return total


def _choose_scheme(lines: Lines, duration: float, wanted: str) -> tuple[str, str]:
    """The scheme, DOP853 or Radau, and the reason in one sentence."""
    if wanted not in ("auto", "explicit", "stiff"):
        rule = "must be 'auto', 'explicit' or 'stiff'"
        raise refuse("integrator", repr(wanted), rule, "choose one of them")
    stable = lines.highest_frequency * duration / _EXPLICIT_LIMIT
    resolving = duration / lines.resolving_step
    ratio = stable / resolving if resolving > 0.0 else 0.0
    found = (
        f"largest angular frequency {lines.highest_frequency:.4g} rad/s: {stable:.0f} explicit steps for"
        f" stability, {resolving:.0f} steps to follow waves and loads from node to node, ratio {ratio:.2g}"
    )
    if wanted != "auto":
        return ("DOP853" if wanted == "explicit" else "Radau"), f"asked for; {found}"
    if ratio <= _AFFORDABLE:
        return "DOP853", f"not stiff; {found}, not above {_AFFORDABLE:.0f}"
    return "Radau", f"stiff; {found}, above {_AFFORDABLE:.0f}"


def _integrate(
    lines: Lines, start: FloatArray, instants: FloatArray, scheme: str, tolerance: float
) -> tuple[FloatArray, int]:
    """States at the instants, shape (times, 2 nodes), and the number of evaluations."""
    from scipy.integrate import DOP853, Radau

    states = np.empty((instants.size, start.size))
    done = int(np.searchsorted(instants, 0.0, side="right"))
    states[:done] = start
    if done == instants.size:
        return states, 0
    end = float(instants[-1])
    scale = np.repeat([_SMALL, _SMALL * lines.wire.wave_speed / lines.step], lines.x.size)
    settings: dict[str, Any] = {"rtol": tolerance, "atol": scale}
    if scheme == "DOP853":
        solver: Any = DOP853(lines.rates, 0.0, start, end, **settings)
    else:  # a large stiff step could leap over a load that comes and goes between its stages
        settings |= {"jac": lines.jacobian, "max_step": lines.resolving_step}
        solver = Radau(lines.rates, 0.0, start, end, **settings)
    while solver.status == "running":
        message = solver.step()
        if solver.status == "failed":
            raise RuntimeError(f"{scheme} stopped at t = {solver.t:g} s of {end:g} s: {message}")
        reached = int(np.searchsorted(instants, solver.t, side="right"))
        if reached > done:
            states[done:reached] = solver.dense_output()(instants[done:reached]).T
            done = reached
    return states, int(solver.nfev)
