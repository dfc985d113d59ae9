"""Gusts along a line: von Kármán's spectrum with Davenport's coherence, and histories drawn from them.

The wind blows across the line, so that points of the line are apart at right angles to it, and gusts reach
all of them without delay: cross spectra are real. What is known of the sources:

- spectrum: T. von Kármán, Progress in the statistical theory of turbulence, 1948; recalled, not read.
- coherence: A. G. Davenport, The spectrum of horizontal gustiness near the ground in high winds, 1961, and
  later papers of his; recalled, not read. T. Burton and others, Wind Energy Handbook, appendix A5.4 (an
  excerpt was read) has the form below as his normalised co-spectrum, with decays from 7 in unstable to 50 in
  stable air, and 10 as a value recommended for design; Eurocode 1 has 11.5 (recalled). The form is empirical.
  It makes the slowest gusts reach all over the line, however long that is.
- IEC 61400-1 has spectra and coherences of this kind (an earlier edition von Kármán's spectrum); its
  coherence has a term in Δx/L besides, which limits the slowest gusts (recalled, not read).
- fields: P. S. Veers, Three-dimensional wind simulation, 1988; recalled, not read.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from math import ceil, gamma, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._numerics import (
    ComplexArray,
    FloatArray,
    counted,
    non_negative,
    numbers,
    positive,
    refuse,
)

# 70.78, printed as 70.8: with it the spectrum's integral is the variance
KARMAN = (2.0 * sqrt(pi) * gamma(1 / 3) / gamma(5 / 6)) ** 2
_INSTANTS = 8  # of the grid in a period of the cut-off; images of it then have 2e-7 of its variance at most
_FORGOTTEN = 16.0  # times L/U, after which a gust's correlation with itself has fallen to 3e-6
_LONGEST, _LARGEST = 2**24, 2**27  # instants of a period, values of a field: 128 MiB and 1 GiB


@dataclass(frozen=True, kw_only=True)
class Gusts:
    """Statistics of the along-wind gust u(x, t), stationary and Gaussian, about a wind that blows across.

    mean_speed : [m/s] U, positive
    intensity : [-] I = σ/U, positive, at most 1
    length_scale : [m] L of the gusts along the wind, positive
    decay : [-] C of the coherence along the line, not negative; 0: the same gust everywhere. Known roughly:
        10 is a value recommended for design, measured ones are from 7 in unstable to 50 in stable air

    Raises ValueError for a value out of its range.
    """

    mean_speed: float
    intensity: float
    length_scale: float
    decay: float = 10.0

    def __post_init__(self) -> None:
        positive("mean_speed", self.mean_speed, "m/s")
        if positive("intensity", self.intensity, "") > 1.0:
            raise refuse("intensity", f"{self.intensity:g}", "must be at most 1", "use 0.15 for 15 %")
        positive("length_scale", self.length_scale, "m")
        non_negative("decay", self.decay, "")

    @property
    def standard_deviation(self) -> float:
        """[m/s] σ = I U of the gust at any place."""
        return self.intensity * self.mean_speed

    def spectrum(self, f: ArrayLike) -> FloatArray:
        """[m²/s] one-sided power spectral density S(f), in the shape of f; ∫ S df from 0 to ∞ is σ².

        S = 4 σ² (L/U) / (1 + 70.8 (f L/U)²)^(5/6), with 70.8 = (2 √π Γ(1/3)/Γ(5/6))².
        Source: T. von Kármán 1948; recalled, not read.

        f : [Hz] not negative, any shape
        """
        time = self.length_scale / self.mean_speed
        scaled = 1.0 + KARMAN * (frequencies_of(f) * time) ** 2
        return np.asarray(4.0 * self.standard_deviation**2 * time * scaled ** (-5 / 6))

    def coherence(self, f: ArrayLike, separation: ArrayLike) -> FloatArray:
        """[-] of amplitudes: cross spectrum over S at two places, exp(−C f |Δx|/U), broadcasting.

        It is the root of the magnitude-squared coherence, which is exp(−2 C f |Δx|/U).
        Source: A. G. Davenport 1961; recalled, and in an excerpt of the Wind Energy Handbook, A5.4.

        f : [Hz] not negative, any shape
        separation : [m] Δx of the places along the line
        """
        distance = np.abs(numbers("separation", separation))
        return np.asarray(np.exp(-self.decay * frequencies_of(f) * distance / self.mean_speed))

    def share_below(self, f: ArrayLike) -> FloatArray:
        """[-] share of the variance σ² at frequencies up to f, in the shape of f.

        The regularised incomplete beta function B(z; 1/2, 1/3), z = 70.8 n²/(1 + 70.8 n²), n = f L/U.
        Source: derived here from the spectrum.

        f : [Hz] not negative, any shape
        """
        from scipy.special import betainc

        square = KARMAN * (frequencies_of(f) * self.length_scale / self.mean_speed) ** 2
        return np.asarray(betainc(0.5, 1 / 3, square / (1.0 + square)))


def frequencies_of(f: ArrayLike) -> FloatArray:
    """[Hz] as an array of finite floats, none negative."""
    frequencies = numbers("f", f)
    if np.any(frequencies < 0.0):
        remedy = "use its magnitude, the spectrum is one-sided"
        raise refuse("f", f"{frequencies.min():g} Hz", "must not be negative", remedy)
    return frequencies


@dataclass(frozen=True, kw_only=True, eq=False)
class GustField:
    """One history of gusts at the stations of a line, as `generate_gusts` makes it.

    gusts : the statistics it was drawn from
    stations : [m] along the line, shape (stations,)
    duration : [s] from t = 0
    cut_off : [Hz] highest frequency in it
    seed : [-] of the random numbers
    period : [s] after which it would repeat; longer than the duration, so that its end knows nothing of its
        start
    step : [s] between the knots of the spline in time
    coefficients : [m/s] of the spline, shape (stations, knots), the first knot at −step
    variance_share : [-] share of σ² that it has on average over seeds: what lies above the cut-off is missing
    """

    gusts: Gusts
    stations: FloatArray
    duration: float
    cut_off: float
    seed: int
    period: float
    step: float
    coefficients: FloatArray = field(repr=False)
    variance_share: float

    def at(self, t: ArrayLike) -> FloatArray:
        """[m/s] gusts u at instants, shape (stations, shape of t); smooth: u, u̇ and ü are continuous.

        Cubic B-splines on a grid of 8 instants in a period of the cut-off. Their coefficients leave every
        frequency up to the cut-off as it is; images of it, at seven times the cut-off and more, have less
        than 10⁻⁶ of the variance.

        t : [s] 0 ≤ t ≤ duration, any shape and order

        Raises ValueError for instants outside.
        """
        instants = numbers("t", t)
        outside = (instants < 0.0) | (instants > self.duration)
        if np.any(outside):
            rule = f"must be between 0 s and the field's duration, {self.duration:g} s"
            raise refuse("t", f"{instants[outside].flat[0]:g} s", rule, "generate a longer field")
        knot = np.minimum((instants / self.step).astype(np.intp), self.coefficients.shape[1] - 4)
        s = instants / self.step - knot
        r = 1.0 - s
        u = self.coefficients[:, knot] * (r**3 / 6.0)
        u += self.coefficients[:, knot + 1] * ((3.0 * s**3 - 6.0 * s**2 + 4.0) / 6.0)
        u += self.coefficients[:, knot + 2] * ((3.0 * r**3 - 6.0 * r**2 + 4.0) / 6.0)
        u += self.coefficients[:, knot + 3] * (s**3 / 6.0)
        return np.asarray(u)


def generate_gusts(
    gusts: Gusts, stations: ArrayLike, *, duration: float, seed: int, cut_off: float = 20.0
) -> GustField:
    """A history of gusts at the stations of a line, stationary and Gaussian, drawn by chance.

    u(x_j, t) = Re Σ_k A_jk exp(2πi f_k t), f_k = k Δf up to the cut-off. At each frequency the amplitudes are
    complex Gaussian, A = √(S Δf) L z, with a Cholesky factor L of the matrix of coherences (Veers 1988), so
    that the field is Gaussian at any number of frequencies. Along a line the coherence is that of a chain,
    r_j = exp(−C f (x_j − x_j−1)/U), whose factor is known: A_j = r_j A_j−1 + √(1 − r_j²) √(S Δf) z_j. The
    zeroth frequency, a constant gust of the variance S(0) Δf/2, stands for those slower than the period: over
    the duration, the mean of a field is not zero, but over seeds it is.

    The period 1/Δf is at least the duration + 16 L/U + C/U times the line's length. Covariances over places
    and times are then within 0.5 % of σ² of those that the spectrum has up to the cut-off.

    The same arguments give the same bytes, with any number of threads, and stations in another order the same
    field; more of them, or another duration, another one.
    Source: P. S. Veers 1988; recalled, not read. The chain and the bound are derived here.

    gusts : their statistics
    stations : [m] places along the line, any order, shape (stations,)
    duration : [s] of the history, from t = 0
    seed : [-] of the random numbers, a whole number of at least 0
    cut_off : [Hz] highest frequency; how much of the variance is below it, `Gusts.share_below` says

    Raises ValueError for a value out of its range and for a field that has no room.
    """
    places = _stations(stations)
    positive("duration", duration, "s")
    counted("seed", seed, at_least=0)
    step = 1.0 / (_INSTANTS * positive("cut_off", cut_off, "Hz"))
    instants, knots = _sizes(known_gusts(gusts), places, duration, step)
    f = np.arange(int(cut_off * instants * step) + 1) / (instants * step)
    variances = gusts.spectrum(f) * f[1]
    variances[0] *= 0.5
    coefficients = np.empty((places.size, knots))
    # irfft takes half of an amplitude, but the whole mean; a B-spline has sinc⁴ of its coefficients'
    scale = 0.5 * instants / np.sinc(f * step) ** 4
    scale[0] *= 2.0
    scale *= np.sqrt(variances)
    for j, amplitudes in _amplitudes(gusts, places, f, seed):
        history = np.fft.irfft(scale * amplitudes, n=instants)
        coefficients[j, 0], coefficients[j, 1:] = history[-1], history[: knots - 1]
    places.setflags(write=False)
    coefficients.setflags(write=False)
    images = (f / (1.0 / step - f)) ** 8 + (f / (1.0 / step + f)) ** 8
    kept = float(np.sum(variances * (1.0 + images))) / gusts.standard_deviation**2
    return GustField(
        gusts=gusts,
        stations=places,
        duration=float(duration),
        cut_off=float(cut_off),
        seed=int(seed),
        period=instants * step,
        step=step,
        coefficients=coefficients,
        variance_share=kept,
    )


def _stations(stations: ArrayLike) -> FloatArray:
    places = numbers("stations", stations).copy()
    if places.ndim != 1 or places.size == 0:
        rule = "must be a list of at least one place"
        raise refuse("stations", f"an array of shape {places.shape}", rule, "pass a one-dimensional array")
    return places


def _sizes(gusts: Gusts, stations: FloatArray, duration: float, step: float) -> tuple[int, int]:
    """Instants in a period, and knots that are kept."""
    from scipy.fft import next_fast_len

    slowest = _FORGOTTEN * gusts.length_scale + gusts.decay * float(np.ptp(stations))
    period = duration + slowest / gusts.mean_speed
    if not period / step <= _LONGEST:
        rule = f"a period of {period:g} s has {period / step:.3g} instants, more than {_LONGEST}"
        raise refuse("cut_off", f"{0.125 / step:g} Hz", rule, "lower it, or shorten duration or line")
    knots = int(duration / step) + 4
    if knots * stations.size > _LARGEST:
        rule = f"the field has {knots * stations.size:.3g} values, more than {_LARGEST}"
        raise refuse("duration", f"{duration:g} s", rule, "shorten it, lower cut_off, or use fewer stations")
    # four more: the knots around both ends of the duration
    return int(next_fast_len(ceil(period / step) + 4, real=True)), knots


def _amplitudes(
    gusts: Gusts, stations: FloatArray, f: FloatArray, seed: int
) -> Iterator[tuple[int, ComplexArray]]:
    """Each station, from one end of the line to the other, with its amplitudes for a spectrum of 1."""
    rng = np.random.default_rng(seed)
    amplitudes = np.zeros(f.size, dtype=np.complex128)
    place = -np.inf
    for j in np.argsort(stations, kind="stable"):
        real, imaginary = rng.standard_normal((2, f.size))
        if place == -np.inf:
            amplitudes = real + 1j * imaginary
        else:
            path = gusts.decay * f * (stations[j] - place) / gusts.mean_speed
            # 1 − r² by expm1: it is small between near stations, and at low frequencies
            amplitudes = np.exp(-path) * amplitudes + np.sqrt(-np.expm1(-2.0 * path)) * (
                real + 1j * imaginary
            )
        place = stations[j]
        yield int(j), amplitudes


def known_gusts(gusts: Gusts) -> Gusts:
    """The gusts, if they are that."""
    if not isinstance(gusts, Gusts):
        raise refuse("gusts", repr(gusts), "must be a theory.Gusts", "make one of speed, intensity, length")
    return gusts
