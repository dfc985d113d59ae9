"""A wire on pinned ends in gusts: spectrum and variance of its deflection, in closed form over its modes."""

from __future__ import annotations

from math import ceil, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._numerics import FloatArray, finite, positive, within
from catenary_fe.theory.gusts import KARMAN, Gusts, frequencies_of, known_gusts
from catenary_fe.theory.wires import String, known, natural_frequencies

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


def spectrum_of_string_response(
    wire: String,
    x: ArrayLike,
    f: ArrayLike,
    gusts: Gusts,
    *,
    length: float,
    damping: float,
    load_per_speed: float,
    modes: int = 50,
) -> FloatArray:
    """[m²/Hz] one-sided spectrum of a wire's deflection in gusts, shape (shape of f, shape of x).

    ρ v̈ + c v̇ + EI v'''' − T v'' + k_f v = k u(x, t) on pinned ends, v = v'' = 0 at x = 0 and ℓ:

    S_v(x, f) = k² S(f) Σ_n Σ_m H_n conj(H_m) J_nm sin(k_n x) sin(k_m x), k_n = nπ/ℓ,
    H_n = (2/ρℓ)/(ω_n² − ω² + iωc/ρ), ω = 2πf, ω_n of `natural_frequencies`,
    J_nm = ∫∫ sin(k_n x) sin(k_m x') exp(−a|x − x'|) dx dx', a = C f/U, both from 0 to ℓ
    = aℓ δ_nm/(a² + k_n²) + 2 k_n k_m [1 − (−1)ⁿ exp(−aℓ)]/((a² + k_n²)(a² + k_m²)) for n + m even, else 0.

    Source: random vibrations by modes (any textbook); J_nm derived here. The coherence is that of amplitudes.

    x : [m] positions, 0 ≤ x ≤ ℓ, any shape
    f : [Hz] not negative, any shape
    gusts : their statistics
    length : [m] ℓ between the ends
    damping : [N s/m²] c, viscous, per length, positive: without it resonances have no bound
    load_per_speed : [N s/m²] k, load per length over gust; of a drag q ∝ U², small gusts have 2q/U
    modes : [-] number of terms
    """
    places = within("x", x, 0.0, positive("length", length, "m"))
    frequencies = frequencies_of(f)
    case = _Response(wire, gusts, length, damping, load_per_speed, modes)
    spectrum = case.spectrum(places.ravel(), frequencies.ravel())
    return spectrum.reshape(frequencies.shape + places.shape)


def variance_of_string_response(
    wire: String,
    x: ArrayLike,
    gusts: Gusts,
    *,
    length: float,
    damping: float,
    load_per_speed: float,
    modes: int = 50,
) -> FloatArray:
    """[m²] stationary variance of a wire's deflection in gusts, in the shape of x.

    ∫ S_v df of `spectrum_of_string_response`, from 0 to beyond the highest mode, by 8 Gauss points in panels
    that double away from f = 0 and from each resonance. Slow gusts that are the same everywhere leave a
    string (k σ x (ℓ − x)/2T)². At mid-span the modes left out have less than 10⁻⁴ of it.
    Source: as `spectrum_of_string_response`.

    x, gusts, length, damping, load_per_speed, modes : as there
    """
    places = within("x", x, 0.0, positive("length", length, "m"))
    case = _Response(wire, gusts, length, damping, load_per_speed, modes)
    edges = case.edges()
    half = 0.5 * np.diff(edges)
    f = (edges[:-1, None] + half[:, None] * (1.0 + _NODES)).ravel()
    weights = (half[:, None] * _WEIGHTS).ravel()
    return np.asarray(weights @ case.spectrum(places.ravel(), f)).reshape(places.shape)


class _Response:
    """A wire in gusts, as a sum of modes."""

    def __init__(
        self, wire: String, gusts: Gusts, length: float, damping: float, load_per_speed: float, modes: int
    ) -> None:
        self.natural = natural_frequencies(known(wire), modes, length=length)
        self.wavenumbers = np.arange(1, self.natural.size + 1) * pi / length
        self.gusts, self.length = known_gusts(gusts), length
        remedy = "give some, without damping a resonance has no bound"
        self.damping = positive("damping", damping, "N s/m²", remedy=remedy) / wire.mass_per_length
        self.load = finite("load_per_speed", load_per_speed, "N s/m²") * 2.0 / (wire.mass_per_length * length)

    def spectrum(self, x: FloatArray, f: FloatArray) -> FloatArray:
        """[m²/Hz] shape (frequencies, places)."""
        omega, k = 2.0 * pi * f[:, None], self.wavenumbers
        decay = self.gusts.decay * f[:, None] / self.gusts.mean_speed
        answers = self.load / (self.natural**2 - omega**2 + 1j * omega * self.damping)
        near = 1.0 / (decay**2 + k**2)  # of a gust and a mode
        shapes = np.sin(np.outer(k, x))
        total = decay * self.length * ((np.abs(answers) ** 2 * near) @ shapes**2)
        for first, sign in ((0, 1.0), (1, -1.0)):  # modes even about mid-span, and odd ones
            some = slice(first, None, 2)
            both_ends = 1.0 + sign * np.exp(-decay * self.length)
            summed = (answers * near * k)[:, some] @ shapes[some]
            total = total + 2.0 * both_ends * np.abs(summed) ** 2
        return np.asarray(self.gusts.spectrum(f)[:, None] * total)

    def edges(self) -> FloatArray:
        """[Hz] of panels in which the spectrum is smooth."""
        gusts, resonances = self.gusts, self.natural / (2.0 * pi)
        slow = [
            gusts.mean_speed / (sqrt(KARMAN) * gusts.length_scale),
            gusts.mean_speed / (gusts.decay * self.length) if gusts.decay else np.inf,
            self.natural[0] ** 2 / (2.0 * pi * self.damping),  # creep, where damping is strong
        ]
        centres = np.concatenate([[0.0], resonances])
        widths = np.full(centres.size, self.damping / (4.0 * pi))
        widths[0] = min(slow)
        rooms = 0.5 * np.diff(centres)
        edges = [centres]
        for centre, width, room in zip(centres, widths, np.append(rooms, rooms[-1]), strict=True):
            edges.append(centre + _ladder(width, room))
        for centre, width, room in zip(centres[1:], widths[1:], rooms, strict=True):
            edges.append(centre - _ladder(width, room))
        return np.unique(np.concatenate(edges))


def _ladder(width: float, room: float) -> FloatArray:
    """Distances from half a width, doubling, to the room that there is."""
    steps = max(0, ceil(np.log2(2.0 * room / width)))
    return np.append(0.5 * width * 2.0 ** np.arange(steps), room)
