"""The semi-discretised wire of the method of lines, and its integration in time."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol

import numpy as np

from catenary_fe.theory._checks import FloatArray, refuse

# |R(iy)| ≤ 1 of DOP853 on the imaginary axis up to here (computed from scipy's coefficients: 5.96)
_EXPLICIT_LIMIT = 5.9
# Explicit steps that stability may cost for each step that following the wave needs. Measured on a wire with
# EI = 200 kN m², meshed ever finer: an undamped wire makes the stiff scheme follow fast waves too, so that
# it pays only from about here (twice as slow at 34, twice as fast at 69).
_AFFORDABLE = 50.0
# Deflection [m] that does not matter.
_SMALL = 1e-9
_STEP_OF_LAW = 1e-6


class _Contact(Protocol):
    @property
    def start(self) -> float: ...

    @property
    def speed(self) -> float: ...

    def contact_force(self, t: float, deflection: float) -> float: ...


@dataclass(frozen=True)
class Lines:
    """ρ ü + EI u'''' − T u'' = f at equidistant nodes, some of them fixed; state (u, v)."""

    x: FloatArray
    fixed: Any
    tension: float
    mass_per_length: float
    bending_stiffness: float
    loads: Sequence[_Contact]

    @property
    def step(self) -> float:
        """Distance of the nodes [m]."""
        return float((self.x[-1] - self.x[0]) / (self.x.size - 1))

    @property
    def wave_speed(self) -> float:
        """c of the string [m/s]."""
        return float(np.sqrt(self.tension / self.mass_per_length))

    @property
    def fastest(self) -> float:
        """Bound of the largest angular frequency of the lines [rad/s], that of the shortest wave, 2h long."""
        second = 4.0 / self.step**2
        return float(
            np.sqrt((self.tension * second + self.bending_stiffness * second**2) / self.mass_per_length)
        )

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
        elastic = self.tension * eye(count) - self.bending_stiffness * second
        return (diags(free) @ elastic @ second / self.mass_per_length).tocsr()

    @cached_property
    def _first_order(self) -> Any:
        from scipy.sparse import bmat, identity

        return bmat([[None, identity(self.x.size)], [self.operator, None]], format="csc")

    def _weights(self, load: _Contact, t: float) -> tuple[int, float, float] | None:
        """Left node and shares of the two nodes around the load; none while it is off the wire."""
        place = (load.start + load.speed * t - self.x[0]) / self.step
        if not 0.0 <= place <= self.x.size - 1:
            return None
        left = min(int(place), self.x.size - 2)
        return left, 1.0 - (place - left), place - left

    def forces(self, t: float, u: FloatArray) -> list[float]:
        """Force of each load on the wire [N]."""
        return [self._force(load, t, u) for load in self.loads]

    def _force(self, load: _Contact, t: float, u: FloatArray) -> float:
        where = self._weights(load, t)
        if where is None:
            return 0.0
        left, near, far = where
        return load.contact_force(t, float(near * u[left] + far * u[left + 1]))

    def rates(self, t: float, state: FloatArray) -> FloatArray:
        """Return (u̇, v̇)."""
        count = self.x.size
        u = state[:count]
        acceleration = self.operator @ u
        for load in self.loads:
            where = self._weights(load, t)
            if where is None:
                continue
            left, near, far = where
            push = self._force(load, t, u) / (self.mass_per_length * self.step)
            acceleration[left] += near * push
            acceleration[left + 1] += far * push
        acceleration[self.fixed] = 0.0
        return np.concatenate([state[count:], acceleration])

    def jacobian(self, t: float, state: FloatArray) -> Any:
        """Return ∂(u̇, v̇)/∂(u, v), sparse; a law's slope is taken by a central difference."""
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
            slope = change / (2.0 * _STEP_OF_LAW * self.mass_per_length * self.step)
            entries = slope * np.outer(shares_of_free, shares)
            rows, columns = np.repeat(nodes + count, 2), np.tile(nodes, 2)
            total = total + coo_matrix((entries.ravel(), (rows, columns)), shape=total.shape).tocsc()
        return total


def choose_integrator(lines: Lines, duration: float, wanted: str) -> tuple[str, str]:
    """Return the scheme, DOP853 or Radau, and the reason in one sentence."""
    if wanted not in ("auto", "explicit", "stiff"):
        rule = "must be 'auto', 'explicit' or 'stiff'"
        raise refuse("integrator", repr(wanted), rule, "choose one of them")
    stable = lines.fastest * duration / _EXPLICIT_LIMIT
    resolving = duration / resolving_step(lines)
    ratio = stable / resolving if resolving > 0.0 else 0.0
    numbers = (
        f"largest angular frequency {lines.fastest:.4g} rad/s: {stable:.0f} explicit steps for stability, "
        f"{resolving:.0f} steps to follow waves and loads from node to node, ratio {ratio:.2g}"
    )
    if wanted != "auto":
        return ("DOP853" if wanted == "explicit" else "Radau"), f"asked for; {numbers}"
    if ratio <= _AFFORDABLE:
        return "DOP853", f"not stiff; {numbers}, not above {_AFFORDABLE:.0f}"
    return "Radau", f"stiff; {numbers}, above {_AFFORDABLE:.0f}"


def resolving_step(lines: Lines) -> float:
    """Return the time [s] in which the string's wave, or a faster load, passes from node to node."""
    return lines.step / max([lines.wave_speed, *(load.speed for load in lines.loads)])


def integrate(
    lines: Lines,
    start: FloatArray,
    instants: FloatArray,
    scheme: str,
    tolerance: float,
    progress: Callable[[float], None] | None,
) -> tuple[FloatArray, int]:
    """Return the states at the instants, shape (times, 2 nodes), and the number of evaluations."""
    states = np.empty((instants.size, start.size))
    done = int(np.searchsorted(instants, 0.0, side="right"))
    states[:done] = start
    if done == instants.size:
        return states, 0
    solver = _solver(lines, start, float(instants[-1]), scheme, tolerance)
    report = _Progress(progress)
    while solver.status == "running":
        message = solver.step()
        if solver.status == "failed":
            raise RuntimeError(f"{scheme} gave up at t = {solver.t:g} s of {instants[-1]:g} s: {message}")
        reached = int(np.searchsorted(instants, solver.t, side="right"))
        if reached > done:
            states[done:reached] = solver.dense_output()(instants[done:reached]).T
            done = reached
        report(solver.t / float(instants[-1]))
    return states, int(solver.nfev)


def _solver(lines: Lines, start: FloatArray, end: float, scheme: str, tolerance: float) -> Any:
    from scipy.integrate import DOP853, Radau

    count = lines.x.size
    scale = np.repeat([_SMALL, _SMALL * lines.wave_speed / lines.step], count)
    common: dict[str, Any] = {"rtol": tolerance, "atol": scale}
    if scheme == "DOP853":
        return DOP853(lines.rates, 0.0, start, end, **common)
    # A large stiff step could leap over a load that comes and goes between its stages.
    return Radau(lines.rates, 0.0, start, end, jac=lines.jacobian, max_step=resolving_step(lines), **common)


class _Progress:
    """Pass on the fraction done whenever it has grown by a hundredth."""

    def __init__(self, listener: Callable[[float], None] | None) -> None:
        self._listener = listener
        self._said = -1.0

    def __call__(self, fraction: float) -> None:
        if self._listener is not None and (fraction >= self._said + 0.01 or fraction >= 1.0 > self._said):
            self._said = fraction
            self._listener(fraction)
