"""A chain of masses whose head moves under a force as a table of receptances says: fit and closed form."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from catenary_fe.theory._numerics import counted, numbers, refuse
from catenary_fe.theory._poles import fitted_poles

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

MOST_MODES = 6
LEAST_POINTS = 12
_CLOSE = 0.01  # error that is small enough
_NOISE = 0.05  # error that may be the measurement's: more masses need not be tried twice
_WORTH = 0.9  # of its error, that a further mass or damper must leave at most
_SOFTEST = 1e-9  # share of the largest stiffness: a base spring so soft is none
_SMALLEST = 1e-300  # keeps logarithms finite
_RANGE = 16.0  # of the logarithms of masses and springs


@dataclass(frozen=True)
class MassChain:
    """Masses on springs one above the other, the head first, the last one on the base; dampers between all.

    masses : [kg], shape (n,)
    springs : [N/m], shape (n,), below each mass
    damping : [N s/m], shape (n, n), symmetric and positive semidefinite
    """

    masses: Floats
    springs: Floats
    damping: Floats

    @property
    def stiffness(self) -> Floats:
        """[N/m], shape (n, n)."""
        K = np.diag(self.springs) + np.diag([0.0, *self.springs[:-1]])
        off = np.diag(self.springs[:-1], 1)
        return np.asarray(K - off - off.T)

    @property
    def static_stiffness(self) -> float:
        """[N/m] of the head at rest."""
        return 0.0 if not self.springs.all() else float(1 / (1 / self.springs).sum())

    def receptance(self, frequency: ArrayLike) -> Complex:
        """[m/N], shape of the frequencies [Hz]: the head's displacement for each newton on it."""
        omega = 2 * np.pi * np.asarray(frequency, dtype=float)
        found = _response(self.masses, self.stiffness, self.damping, omega.ravel())[:, 0]
        return np.asarray(found.reshape(omega.shape), dtype=np.complex128)


def fit_receptance(
    frequency: ArrayLike,
    receptance: ArrayLike,
    modes: int | None = None,
    static_stiffness: float | None = None,
) -> MassChain:
    """The chain of masses that comes nearest to a measured receptance.

    Masses, springs and dampers can do nothing but keep or take energy, so that the chain is stable on any
    line. Errors count as logarithms of the ratio, in magnitude and phase alike: an antiresonance has the
    weight of a resonance. Each number of masses is begun from the poles of vector fitting (Gustavsen and
    Semlyen, IEEE Trans. Power Delivery 14(3), 1999; recalled), and from the best chain of one mass less with
    each mass split in turn; then least squares over all masses, springs and dampers. Dampers are between
    neighbours and to the base, as far as that is enough; else between any two masses.

    frequency : [Hz], above 0, rising
    receptance : [m/N], complex, displacement by force; its phase lies between -180° and 0 but for noise
    modes : number of masses; unset: the fewest whose error is below 1 % in the mean square, or that more
        would hardly lessen
    static_stiffness : [N/m] of the head at 0 Hz; unset: what the table leads to

    Raises ValueError.
    """
    f = numbers("frequency", frequency)
    H = np.asarray(receptance, dtype=np.complex128)
    most = MOST_MODES if modes is None else counted("modes", modes)
    if most > MOST_MODES:
        raise refuse("modes", most, f"must be at most {MOST_MODES}", "take fewer")
    if f.ndim != 1 or f.shape != H.shape or f.size < LEAST_POINTS or (np.diff(f, prepend=0.0) <= 0).any():
        raise refuse("frequency", f"{f.size} values", f"must be {LEAST_POINTS} or more, above 0 and rising",
                     "give one receptance for each")  # fmt: skip
    if not np.isfinite(H).all() or not (H != 0).all():
        raise refuse("receptance", "some", "must be finite and not 0", "leave those frequencies out")
    # in units in which the frequencies' middle and the mass there are 1
    rate = float(2 * np.pi * np.sqrt(f[0] * f[-1]))
    omega = 2 * np.pi * f / rate
    mass = float(np.exp(-np.log(omega**2 * np.abs(H)).mean())) / rate**2
    unit = mass * rate**2
    static = None if static_stiffness is None else static_stiffness / unit
    table = _Table(omega, np.asarray(H * unit, dtype=np.complex128), static)
    with np.errstate(all="ignore"):  # of starts that lead nowhere
        chain = _of_so_many(table, most, chosen=modes is None)
    return MassChain(chain.masses * mass, chain.springs * unit, chain.damping * mass * rate)


def _response(masses: Floats, K: Floats, D: Floats, omega: Floats) -> Complex:
    """Shape (frequencies, n): displacements by a force of 1 at the head."""
    Z = K + 1j * omega[:, None, None] * D - omega[:, None, None] ** 2 * np.diag(masses)
    head = np.zeros((omega.size, masses.size, 1))
    head[:, 0] = 1.0
    found: Complex = np.linalg.solve(Z, head)[..., 0].astype(np.complex128)
    return found


def _modes(omega: Floats, H: Complex, modes: int) -> tuple[Floats, Floats, Floats]:
    """Angular frequencies, damping ratios and squares of the head's part of the modes to start from."""
    from scipy.optimize import nnls

    poles = fitted_poles(omega, H, modes)
    real = np.sort(poles[poles.imag == 0].real)
    pairs = [(p, p.conjugate()) for p in poles if p.imag > 0]
    pairs += [(complex(a), complex(b)) for a, b in zip(real[::2], real[1::2], strict=True)]
    own = np.array([np.sqrt((a * b).real) for a, b in pairs])
    ratio = np.array([-(a + b).real / 2 for a, b in pairs]) / own
    shapes = 1 / (own**2 - omega[:, None] ** 2 + 2j * ratio * own * omega[:, None]) / H[:, None]
    squares, _ = nnls(np.vstack([shapes.real, shapes.imag]), np.repeat([1.0, 0.0], omega.size))
    least = 1e-6 * squares.max(initial=1e-300)
    return own, ratio, np.maximum(squares, least)


def _chain_of_modes(own: Floats, ratio: Floats, squares: Floats) -> MassChain:
    """The chain with these modes, whose head's row has these squares."""
    n = own.size
    # Lanczos: an orthogonal basis that begins with the head makes the stiffness tridiagonal
    Q = np.zeros((n, n))
    Q[0] = np.sqrt(squares / squares.sum())
    for i in range(1, n):
        following = own**2 * Q[i - 1]
        for _ in range(2):
            following -= Q[:i].T @ (Q[:i] @ following)
        Q[i] = following / np.linalg.norm(following)
    K = (Q * own**2) @ Q.T
    # scale the coordinates so that, from the head down, every spring but the last is between two masses
    masses, springs, size = np.zeros(n), np.zeros(n), np.zeros(n)
    size[0] = 1 / np.sqrt(squares.sum())  # square root of the mass
    above = 0.0
    for i in range(n):
        masses[i] = size[i] ** 2
        springs[i] = K[i, i] * masses[i] - above
        if i + 1 < n:
            size[i + 1] = springs[i] / (abs(K[i, i + 1]) * size[i])
        above = springs[i]
    sign = np.cumprod([1.0, *(-np.sign(np.diag(K, 1)))])
    rows = sign[:, None] * Q
    D = (rows * (2 * ratio * own)) @ rows.T * np.outer(size, size)
    return MassChain(masses, np.maximum(springs, _SOFTEST * springs.max()), D)


@dataclass(frozen=True)
class _Table:
    """Angular frequencies, receptances, and what is known of the static stiffness."""

    omega: Floats
    H: Complex
    static: float | None

    def error(self, chain: MassChain) -> float:
        """Root mean square of the relative error."""
        H = _response(chain.masses, chain.stiffness, chain.damping, self.omega)[:, 0]
        return float(np.sqrt((np.abs(H / self.H - 1) ** 2).mean()))


def _of_so_many(table: _Table, most: int, *, chosen: bool) -> MassChain:
    """Chains of one mass more each, until there are enough."""
    found: list[tuple[float, MassChain]] = []
    for n in range(1, most + 1):
        starts = [_chain_of_modes(*_modes(table.omega, table.H, n))]
        starts += _split(found[-1][1], table.omega[-1]) if found else []
        starts = [s for s in starts if np.isfinite([*s.masses, *s.springs, *s.damping.ravel()]).all()]
        best: tuple[float, MassChain] = (np.inf, starts[0])
        for start in starts:
            chain = _refined(table, start, 1)
            best = min(best, (table.error(chain), chain), key=lambda each: each[0])
            if best[0] < _CLOSE:
                break
        if best[0] >= _CLOSE and n > 2:
            general = [_refined(table, start, n) for start in (best[1], starts[0])]
            error, chain = min(((table.error(c), c) for c in general), key=lambda each: each[0])
            if error < _WORTH * best[0]:
                best = error, chain
        found.append(best)
        if chosen and best[0] < _CLOSE:
            break
        gains = [after <= _WORTH * before for (before, _), (after, _) in pairwise(found)]
        tried = 1 if best[0] < _NOISE else 2
        if chosen and len(gains) >= tried and not any(gains[-tried:]):
            break
    if not chosen:
        return found[-1][1]
    least = min(error for error, _ in found)
    return next(chain for error, chain in found if error <= max(_CLOSE, least / _WORTH))


def _split(chain: MassChain, highest: float) -> list[MassChain]:
    """Chains of one mass more: each mass in turn as two halves on a stiff spring."""
    found = []
    for i in range(chain.masses.size):
        half = chain.masses[i] / 2
        masses = np.insert(chain.masses, i, half)
        masses[i + 1] = half
        stiff = half * highest**2 / 2
        D = np.insert(np.insert(chain.damping, i, 0.0, axis=0), i, 0.0, axis=1)
        D[i : i + 2, i : i + 2] += 0.05 * half * highest * np.array([[1.0, -1.0], [-1.0, 1.0]])
        if i:
            D[[i, i - 1], [i - 1, i]] = D[i + 1, i - 1]
            D[[i + 1, i - 1], [i - 1, i + 1]] = 0.0
            D[i, i] += chain.damping[i - 1, i - 1]
        found.append(MassChain(masses, np.insert(chain.springs, i, stiff), D))
    return found


class _Unknowns:
    """Masses and springs as logarithms in a range, the base spring as a square, dampers as a factor."""

    def __init__(self, count: int, static: float | None, reach: int) -> None:
        self.n, self.static = count, static
        i, j = np.tril_indices(self.n)
        near = i - j <= reach
        self.lower = i[near], j[near]

    def of(self, chain: MassChain) -> Floats:
        logs = np.log(np.concatenate([chain.masses, chain.springs[:-1]]))
        free = _RANGE * np.arctanh(np.clip(logs / _RANGE, -0.9, 0.9))
        values, vectors = np.linalg.eigh(chain.damping)
        root = vectors * np.sqrt(np.maximum(values, 1e-6 * values.max(initial=1e-6)))
        factor = np.asarray(np.linalg.qr(root.T, mode="r")).T
        factor = factor * np.where(np.diag(factor) < 0, -1.0, 1.0)
        base = [] if self.static is not None else [np.sqrt(chain.springs[-1])]
        return np.concatenate([free, base, factor[self.lower]])

    def chain(self, x: Floats) -> MassChain:
        n = self.n
        sizes, rest = np.exp(_RANGE * np.tanh(x[: 2 * n - 1] / _RANGE)), x[2 * n - 1 :]
        springs = sizes[n:]
        if self.static is None:
            base, rest = rest[0] ** 2, rest[1:]
        else:
            base = self.static / max(1 - self.static * (1 / springs).sum(), 1e-3)
        return MassChain(sizes[:n], np.append(springs, base), self._square(rest))

    def _square(self, rest: Floats) -> Floats:
        factor = self._factor(rest)
        return np.asarray(factor @ factor.T)

    def _factor(self, rest: Floats) -> Floats:
        factor = np.zeros((self.n, self.n))
        factor[self.lower] = rest
        return factor

    def slopes(self, x: Floats, moved: Complex, omega: Floats) -> Complex:
        """Shape (frequencies, unknowns): derivatives of the receptance; moved : by 1 N at the head."""
        n, chain = self.n, self.chain(x)
        below = np.hstack([moved[:, 1:], np.zeros((omega.size, 1))])
        by_mass = omega[:, None] ** 2 * moved**2 * chain.masses
        by_spring = -((moved - below) ** 2)
        inner, base = by_spring[:, :-1] * chain.springs[:-1], by_spring[:, -1:]
        if self.static is None:
            base, rest = base * 2 * x[2 * n - 1], x[2 * n :]
        else:
            # a softer chain needs a stiffer base for the same static stiffness
            inner = inner - base * chain.springs[-1] ** 2 / chain.springs[:-1]
            base, rest = base[:, :0], x[2 * n - 1 :]
        felt = moved @ self._factor(rest)
        i, j = self.lower
        by_damper = -2j * omega[:, None] * moved[:, i] * felt[:, j]
        sizes = np.hstack([by_mass, inner]) * (1 - np.tanh(x[: 2 * n - 1] / _RANGE) ** 2)
        return np.hstack([sizes, base, by_damper])


def _refined(table: _Table, start: MassChain, reach: int) -> MassChain:
    """The nearest chain to be reached from a start, with dampers between masses so many places apart."""
    from scipy.optimize import least_squares

    unknowns = _Unknowns(start.masses.size, table.static, reach)

    def moved(x: Floats) -> Complex:
        chain = unknowns.chain(x)
        return _response(chain.masses, chain.stiffness, chain.damping, table.omega)

    def errors(x: Floats) -> Any:
        ratio = np.log(moved(x)[:, 0] / table.H + _SMALLEST)
        return np.concatenate([ratio.real, ratio.imag])

    def slopes(x: Floats) -> Any:
        u = moved(x)
        each = unknowns.slopes(x, u, table.omega) / u[:, :1]
        return np.vstack([each.real, each.imag])

    x = unknowns.of(start)
    found = least_squares(errors, x, slopes, method="lm", x_scale="jac", max_nfev=150, xtol=1e-9, ftol=1e-9)
    return unknowns.chain(found.x)
