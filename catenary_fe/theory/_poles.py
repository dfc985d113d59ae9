"""Poles of a measured frequency response, by vector fitting (Gustavsen and Semlyen 1999; recalled)."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Complex = NDArray[np.complex128]

_ROUNDS = 20  # of moving the poles


def fitted_poles(omega: Floats, H: Complex, modes: int) -> Complex:
    """2 · modes poles in the left half plane, moved until a rational function of them meets the table."""
    own = np.geomspace(omega[0], omega[-1], modes + 2)[1:-1]
    poles = np.array([w * complex(-0.05, side) for w in own for side in (1, -1)], dtype=np.complex128)
    s = (1j * omega).astype(np.complex128)
    for _ in range(_ROUNDS):
        poles = _paired(poles)
        basis, A = _basis(s, poles)
        n = len(poles)
        # numerator - H · (denominator - 1) = H, all by the size of H
        columns = np.hstack([basis / H[:, None], -basis])
        system = np.vstack([columns.real, columns.imag])
        scale = np.linalg.norm(system, axis=0)
        right = np.repeat([1.0, 0.0], omega.size)
        solved = np.linalg.lstsq(system / scale, right, rcond=None)[0] / scale
        moved: Complex = np.linalg.eigvals(A - np.outer(_ones(poles), solved[n:])).astype(np.complex128)
        moved = np.where(moved.real > 0, -moved.conjugate(), moved)
        moved = np.where(np.abs(moved.imag) < 1e-9 * np.abs(moved), moved.real + 0j, moved)
        moved.real = np.minimum(moved.real, -1e-6 * np.abs(moved) - 1e-12)
        done = np.allclose(np.sort_complex(moved), np.sort_complex(poles), rtol=1e-8)
        poles = moved
        if done:
            break
    return poles


def _paired(poles: Complex) -> Complex:
    """Real ones, then those with positive imaginary parts each followed by its conjugate."""
    found = list(np.sort(poles[poles.imag == 0].real).astype(complex))
    for p in np.sort_complex(poles[poles.imag > 0]):
        found += [p, p.conjugate()]
    return np.array(found)


def _basis(s: Complex, poles: Complex) -> tuple[Complex, Floats]:
    """Partial fractions with real coefficients, shape (frequencies, poles), and their real state matrix."""
    basis, A, i = np.zeros((s.size, poles.size), dtype=complex), np.zeros((poles.size,) * 2), 0
    while i < poles.size:
        p = poles[i]
        if p.imag == 0:
            basis[:, i], A[i, i], i = 1 / (s - p), p.real, i + 1
            continue
        a, b = 1 / (s - p), 1 / (s - p.conjugate())
        basis[:, i], basis[:, i + 1] = a + b, 1j * (a - b)
        A[i : i + 2, i : i + 2] = [[p.real, p.imag], [-p.imag, p.real]]
        i += 2
    return basis, A


def _ones(poles: Complex) -> Floats:
    """How the input enters the state of each partial fraction."""
    found = np.ones(poles.size)
    pairs = np.flatnonzero(poles.imag > 0)
    found[pairs], found[pairs + 1] = 2.0, 0.0
    return found
