"""Wires between rigid ends, strings and beams: sine series, images, bays between supports (eq. 7)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._numerics import (
    FloatArray,
    Function,
    antiderivative,
    counted,
    non_negative,
    numbers,
    positive,
    refuse,
    times,
    within,
)
from catenary_fe.theory.forces import Force, HarmonicForce, as_harmonic, impulse_function
from catenary_fe.theory.infinite_string import influence_interval, running_waves
from catenary_fe.theory.wires import String, angular_frequency, known, string_speed

# Nearer to the wave speed than this (1 − V²/c²), the series is summed as it stands: its tail has no closed
# form at V = c.
_NEAR_CRITICAL = 1e-3
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)  # in half a wave of the highest mode, or less


def _turned_over(x: FloatArray, length: float, function: Callable[[FloatArray], ArrayLike]) -> FloatArray:
    """A function on 0 ≤ x ≤ length, continued odd and 2·length-periodic."""
    lap = np.mod(x, 2.0 * length)
    beyond = lap > length
    values = np.asarray(function(np.where(beyond, 2.0 * length - lap, lap)), dtype=np.float64)
    return np.where(beyond, -values, values)


def reflected_waves(
    string: String,
    x: ArrayLike,
    t: ArrayLike,
    *,
    length: float,
    initial_deflection: Function | None = None,
    initial_velocity: Function | None = None,
    breakpoints: Sequence[float] = (),
) -> FloatArray:
    """[m] free waves on a string between rigid ends, by images: exact.

    d'Alembert's solution on the odd, 2L-periodic continuation of the initial state. ü = c² u'', u(0, t) =
    u(L, t) = 0, u = u₀ and u̇ = v₀ at t = 0. An echo returns inverted.
    Source: method of images (any textbook on waves) on eq. 4 of the paper.

    x : [m] positions, 0 ≤ x ≤ L, any shape
    t : [s] times, not negative, broadcasting with x
    length : [m] L between the ends
    initial_deflection : [m] u₀ on 0 ≤ x ≤ L, function of positions; none: straight
    initial_velocity : [m/s] v₀ likewise; none: at rest
    breakpoints : [m] places where v₀ jumps or bends, so that its quadrature stays exact there
    """
    x = within("x", x, 0.0, positive("length", length, "m"))
    deflection = even_integral = None
    if (shape := initial_deflection) is not None:

        def deflection(s: FloatArray) -> FloatArray:
            return _turned_over(s, length, shape)

    if initial_velocity is not None:
        integral = antiderivative(initial_velocity, 0.0, length, breakpoints=breakpoints)

        def even_integral(s: FloatArray) -> FloatArray:
            return integral(np.abs(np.mod(s + length, 2.0 * length) - length))

    return running_waves(string, x, t, initial_deflection=deflection, velocity_antiderivative=even_integral)


def initial_value_series(
    wire: String,
    x: ArrayLike,
    t: ArrayLike,
    *,
    length: float,
    initial_deflection: Function | None = None,
    initial_velocity: Function | None = None,
    modes: int = 200,
) -> FloatArray:
    """[m] free waves on a wire between pinned ends, by sine series.

    ρ ü + EI u'''' − T u'' + k_f u = 0, u = u'' = 0 at x = 0 and L, u = u₀ and u̇ = v₀ at t = 0: u = Σ [a_n cos
    ω_n t + (b_n/ω_n) sin ω_n t] sin(nπx/L), a_n = (2/L) ∫ u₀ sin(nπx/L) dx, b_n likewise of v₀, ω_n of
    `natural_frequencies`. One mode alone is a standing wave, two running waves of half its amplitude.
    Source: paper, eq. 7 with eq. 1; the shapes on 0 ≤ x ≤ L are sin(nπx/L), the print has cos(lπ/L).

    x : [m] positions, 0 ≤ x ≤ L, any shape
    t : [s] times, not negative, broadcasting with x
    length : [m] L between the ends
    initial_deflection : [m] u₀ on 0 ≤ x ≤ L, function of positions; none: straight
    initial_velocity : [m/s] v₀ likewise; none: at rest
    modes : [-] number of terms
    """
    x, t = within("x", x, 0.0, positive("length", length, "m")), times(t)
    a, b = (
        _sine_coefficients(function, length, counted("modes", modes))
        for function in (initial_deflection, initial_velocity)
    )

    def amplitude(time: FloatArray, omega: float, k: float) -> FloatArray:
        n = round(k * length / np.pi) - 1
        return np.asarray(a[n] * np.cos(omega * time) + b[n] * np.sin(omega * time) / omega)

    return _sine_sum(wire, x, t, length, modes, amplitude)


def _sine_coefficients(function: Function | None, length: float, modes: int) -> FloatArray:
    """(2/L) ∫ f sin(nπx/L) dx over 0 ≤ x ≤ L for n = 1 … modes."""
    if function is None:
        return np.zeros(modes)
    panels = max(modes, 64)
    panel = length / panels
    points = (panel * (np.arange(panels)[:, None] + 0.5 * (1.0 + _NODES))).ravel()
    values = np.broadcast_to(np.asarray(function(points), dtype=np.float64), points.shape)
    weighted = values * np.tile(_WEIGHTS, panels) * panel / length
    return np.asarray([weighted @ np.sin(n * np.pi * points / length) for n in range(1, modes + 1)])


def _sine_sum(
    wire: String,
    x: FloatArray,
    t: FloatArray,
    length: float,
    modes: int,
    amplitude: Callable[[FloatArray, float, float], FloatArray],
) -> FloatArray:
    """Σ amplitude(t, ω, k) sin(k x), k = nπ/length, n = 1 … modes, in the shape of x and t broadcast.

    One mode at a time: sines and amplitudes are only computed on x and t as given, which are often a row
    and a column.
    """
    total = np.zeros(np.broadcast_shapes(x.shape, t.shape))
    for mode in range(1, counted("modes", modes) + 1):
        k = mode * np.pi / length
        total += amplitude(t, float(angular_frequency(wire, k)), k) * np.sin(k * x)
    return total


def moving_force_by_images(
    string: String,
    x: ArrayLike,
    t: ArrayLike,
    *,
    length: float,
    speed: float,
    force: Force,
    start: float = 0.0,
    impulse: Function | None = None,
) -> FloatArray:
    """[m] deflection of a string between rigid ends under a moving force, by images: exact, for every speed.

    ρ ü − T u'' = F(t) δ(x − a − Vt) while a + Vt < L, then free; u(0, t) = u(L, t) = 0, u = u̇ = 0 at t =
    0. The sum of the infinite string's solution for the force and its images at ±(a + Vt) + 2nL.
    Source: method of images on eq. 4 and 5 of the paper.

    x : [m] positions, 0 ≤ x ≤ L, any shape
    t : [s] times, not negative, broadcasting with x
    length : [m] L between the ends
    speed : [m/s] V, not negative; below, at or above the wave speed
    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times
    start : [m] a, where the force is at t = 0, 0 ≤ a ≤ L
    impulse : [N s] any antiderivative of F as a function of time; used in place of the quadrature
    """
    x, t = within("x", x, 0.0, positive("length", length, "m")), times(t)
    v, a = non_negative("speed", speed, "m/s"), float(within("start", start, 0.0, length))
    until = min(float(np.max(t, initial=0.0)), _leaving_time(length - a, v))
    gathered = impulse_function(force, until, impulse=impulse)
    return _image_sum(string, x, t, length, v, a, gathered)


def _leaving_time(distance: float, speed: float) -> float:
    """[s] that the force needs for the distance to the end; infinite for a force at rest."""
    return distance / speed if speed > 0.0 else np.inf


def _image_sum(
    string: String,
    x: FloatArray,
    t: FloatArray,
    length: float,
    speed: float,
    start: float,
    impulse: Callable[[FloatArray], FloatArray],
) -> FloatArray:
    """[m] what all images have sent to (x, t); no checks. Nothing is felt before t = 0."""
    leave, c = _leaving_time(length - start, speed), string_speed(string)
    if np.isfinite(leave):
        # A free string repeats itself, so that no more images are needed than until one period after the
        # force left.
        t = np.where(t > leave, leave + np.mod(t - leave, 2.0 * length / c), t)
    laps = int(np.ceil((c * float(np.max(t, initial=0.0)) + 2.0 * length) / (2.0 * length)))
    total = np.zeros(np.broadcast_shapes(x.shape, t.shape))
    for lap in range(-laps, laps + 1):
        for sign in (1.0, -1.0):
            relative = sign * (x - 2.0 * lap * length) - start
            first, last = influence_interval(string, relative, t, speed=speed)
            last = np.minimum(last, leave)
            total += sign * (impulse(last) - impulse(np.minimum(first, last)))
    return total / (2.0 * string.impedance)


def moving_force_series(
    wire: String,
    x: ArrayLike,
    t: ArrayLike,
    *,
    length: float,
    speed: float,
    force: float | HarmonicForce,
    start: float = 0.0,
    modes: int = 200,
    accelerate: bool = True,
) -> FloatArray:
    """[m] deflection of a wire between pinned ends under a moving force, by sine series.

    ρ ü + EI u'''' − T u'' + k_f u = F(t) δ(x − a − Vt) while a + Vt < L, then free; u = u'' = 0 at x = 0 and
    L, u = u̇ = 0 at t = 0. For a constant force from a = 0, while it acts: u = Σ (2F/ρL) [sin Ω_n t −
    (Ω_n/ω_n) sin ω_n t]/(ω_n² − Ω_n²) sin(nπx/L), Ω_n = nπV/L, ω_n of `natural_frequencies`; each mode's
    amplitude is exact, resonances included (all modes of a string at V = c). Kinks make a string's terms fall
    as 1/n² only; with `accelerate` that part is summed in closed form (away from V = c), which leaves a rest
    that falls as 1/n³, and nothing at all for a constant force. The terms of a beam have no such part, and
    fall as 1/n⁴ once n > (L/π) √(T/EI).
    Source: paper, eq. 7 with eq. 5 and 1; the shapes are sin(nπx/L), the print has cos(lπ/L). Acceleration:
    derived here.

    x : [m] positions, 0 ≤ x ≤ L, any shape
    t : [s] times, not negative, broadcasting with x
    length : [m] L between the ends
    speed : [m/s] V, not negative; below, at or above the wave speed
    force : [N] positive upwards: a number or a `HarmonicForce`
    start : [m] a, where the force is at t = 0, 0 ≤ a ≤ L
    modes : [-] number of terms
    accelerate : sum the slowly converging part in closed form, where there is one
    """
    x, t = within("x", x, 0.0, positive("length", length, "m")), times(t)
    v, a = non_negative("speed", speed, "m/s"), float(within("start", start, 0.0, length))
    load = TravellingForce(as_harmonic(force), v, a, _leaving_time(length - a, v))
    c, inertia = known(wire).wave_speed, wire.mass_per_length * length
    gap = 1.0 - (v / c) ** 2
    is_string = wire.bending_stiffness == wire.foundation_stiffness == 0.0
    accelerate = accelerate and is_string and abs(gap) > _NEAR_CRITICAL

    def amplitude(time: FloatArray, omega: float, k: float) -> FloatArray:
        q = load.amplitude(time, omega, k)
        if accelerate:
            q = q - _kinks(load, time, c, length, lambda s: np.sin(k * s)) / (gap * omega**2)
        return q * 2.0 / inertia

    total = _sine_sum(wire, x, t, length, modes, amplitude)
    if accelerate:
        closed = _kinks(load, t, c, length, lambda s: _influence_line(x, s, length))
        total = total + closed / (gap * wire.tension)
    return total


def _influence_line(x: FloatArray, place: FloatArray, length: float) -> FloatArray:
    """[m] static deflection × T under a unit force at ``place``, continued odd and 2L-periodic in it."""
    return _turned_over(place, length, lambda a: np.minimum(x, a) * (length - np.maximum(x, a)) / length)


def _kinks(
    load: TravellingForce, t: FloatArray, c: float, length: float, shape: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Kinks under the force and those shed when it came and left: a sum of ``shape`` at their places."""
    ratio, acts = load.speed / c, t <= load.leave
    force = np.where(acts, load.force(t), 0.0)
    total = force * shape(load.start + load.speed * np.where(acts, t, 0.0))
    came = (1.0 + ratio) * shape(load.start + c * t) + (1.0 - ratio) * shape(load.start - c * t)
    total = total - 0.5 * load.force(0.0) * came
    if np.isfinite(load.leave):
        since = c * np.maximum(0.0, t - load.leave)
        left = shape(length + since) - shape(length - since)
        total = total + 0.5 * ratio * load.force(load.leave) * left
    return np.asarray(total)


@dataclass(frozen=True)
class TravellingForce:
    """A constant or harmonic force that moves from ``start`` at t = 0 and acts until it leaves the wire."""

    force: HarmonicForce
    speed: float
    start: float
    leave: float

    def amplitude(self, t: FloatArray, omega: float, wavenumber: float) -> FloatArray:
        """q of q̈ + ω² q = F(t) sin(k (start + V t)), from rest, right side 0 after the force left."""
        acting = np.minimum(t, self.leave)
        displacement, rate = np.zeros(t.shape), np.zeros(t.shape)
        for weight, drive, phase in self._terms(wavenumber):
            if weight == 0.0:
                continue
            by_cosine, by_sine = _driven(acting, omega, abs(drive))
            along, across = weight * np.cos(phase), -weight * np.sin(phase) * np.sign(drive)
            displacement += along * by_cosine[0] + across * by_sine[0]
            rate += along * by_cosine[1] + across * by_sine[1]
        since = t - acting
        return displacement * np.cos(omega * since) + rate * since * _sinc(omega * since)

    def _terms(self, wavenumber: float) -> list[tuple[float, float, float]]:
        """F(t) sin(k (start + V t)) as a sum of weight · cos(drive · t + phase)."""
        sweep, phase = wavenumber * self.speed, wavenumber * self.start
        half, pulse, lead = 0.5 * self.force.amplitude, self.force.angular_frequency, self.force.phase
        return [
            (self.force.mean, sweep, phase - 0.5 * np.pi),
            (half, sweep - pulse, phase - lead),
            (-half, sweep + pulse, phase + lead),
        ]


def _sinc(angle: FloatArray) -> FloatArray:
    return np.asarray(np.sinc(angle / np.pi))


def _driven(
    t: FloatArray, omega: float, drive: float
) -> tuple[tuple[FloatArray, FloatArray], tuple[FloatArray, FloatArray]]:
    """Displacement and rate of q̈ + ω² q = cos(a t), and of q̈ + ω² q = sin(a t), a ≥ 0, from rest.

    The limit at a = ω is included.
    """
    far, near = 0.5 * (omega + drive) * t, 0.5 * (omega - drive) * t
    beat, both = t * np.cos(far) * _sinc(near), 0.5 * t**2 * _sinc(far) * _sinc(near)
    by_cosine = both, (omega * beat + np.sin(drive * t)) / (omega + drive)
    by_sine = (np.sin(omega * t) / omega - beat) / (omega + drive), drive * both
    return by_cosine, by_sine


def moving_force_on_supports(
    string: String,
    x: ArrayLike,
    t: ArrayLike,
    *,
    supports: ArrayLike,
    speed: float,
    force: Force,
    start: float | None = None,
    method: Literal["images", "series"] = "images",
    modes: int = 200,
) -> FloatArray:
    """[m] deflection of a string on rigid supports at any positions under a force that runs over it.

    ρ ü − T u'' = F(t) δ(x − a − Vt) between the supports s_0 < s_1 < …, u(s_j, t) = 0, u = u̇ = 0 at t = 0.
    A rigid support lets nothing pass, so each bay is a string of its own; the force enters it at (s_j −
    a)/V, leaves it at (s_{j+1} − a)/V, and it rings on. The wire ends at the first and the last support.
    Source: paper, eq. 7 and fig. 5.

    x : [m] positions from the first to the last support, any shape
    t : [s] times, not negative, broadcasting with x
    supports : [m] two positions or more, rising, at any distances
    speed : [m/s] V, positive; below, at or above the wave speed
    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times
    start : [m] a, where the force is at t = 0, between the first and the last support; none: the first
    method : "images" (exact) or "series" (constant or harmonic force only)
    modes : [-] number of terms of the series in each bay
    """
    places = numbers("supports", supports)
    if places.ndim != 1 or places.size < 2 or np.any(np.diff(places) <= 0.0):
        rule = "must be two or more positions in rising order"
        raise refuse("supports", places.tolist(), rule, "sort them and drop doubles")
    first, last = float(places[0]), float(places[-1])
    a = first if start is None else float(within("start", start, first, last))
    v = positive("speed", speed, "m/s", remedy="for a force at rest use one bay and moving_force_by_images")
    if method not in ("images", "series"):
        raise refuse("method", repr(method), "must be 'images' or 'series'", "choose one of them")
    x, t = np.broadcast_arrays(within("x", x, first, last), times(t))
    gathered = impulse_function(force, float(np.max(t, initial=0.0)))
    total = np.zeros(x.shape)
    for left, right in pairwise(places.tolist()):
        enter, begin, length = max(0.0, (left - a) / v), max(0.0, a - left), right - left
        felt = (x > left) & (x < right) & (t > enter)
        if begin >= length or not felt.any():
            continue
        where, since = x[felt] - left, t[felt] - enter
        if method == "images":  # the impulse before `enter` drops out of every difference
            later = partial(_later, gathered, enter)
            total[felt] = _image_sum(string, where, since, length, v, begin, later)
        else:
            shifted = as_harmonic(force).later(enter)
            bay = {"length": length, "speed": v, "start": begin}
            total[felt] = moving_force_series(string, where, since, **bay, force=shifted, modes=modes)
    return total


def _later(impulse: Callable[[FloatArray], FloatArray], delay: float, t: FloatArray) -> FloatArray:
    """The impulse on a clock that starts ``delay`` later."""
    return impulse(t + delay)
