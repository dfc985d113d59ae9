"""A moving force on a string between two rigid ends: images and sine series (eq. 7 with eq. 5)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import (
    FloatArray,
    counted,
    finite,
    non_negative,
    positive,
    refuse,
    times,
    within,
)
from catenary_fe.theory._modal import MovingLoad, sine_sum
from catenary_fe.theory._quadrature import Function
from catenary_fe.theory.bounded_string import influence_line
from catenary_fe.theory.forces import Force, HarmonicForce, Impulse, as_harmonic, impulse_function
from catenary_fe.theory.infinite_string import wave_speed
from catenary_fe.theory.point_force import influence_interval

# Nearer to the wave speed than this (1 − V²/c²), the series is summed as it stands: its tail has no closed
# form at V = c.
_NEAR_CRITICAL = 1e-3


def moving_force_by_images(
    x: ArrayLike,
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    length: float,
    speed: float,
    force: Force,
    start: float = 0.0,
    impulse: Function | None = None,
) -> FloatArray:
    """Deflection of a string between rigid ends under a moving force, by images: exact, for every speed.

    ρ ü − T u'' = F(t) δ(x − a − Vt) while a + Vt < L, then free; u(0, t) = u(L, t) = 0, u = u̇ = 0 at t =
    0. The sum of the infinite string's solution for the force and its images at ±(a + Vt) + 2nL.
    Source: method of images on eq. 4 and 5 of the paper.

    Parameters
    ----------
    x : [m] positions, 0 ≤ x ≤ L, any shape
    t : [s] times, not negative, broadcasting with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    length : [m] L between the rigid ends
    speed : [m/s] V, not negative; below, at or above the wave speed
    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times
    start : [m] a, where the force is at t = 0, 0 ≤ a ≤ L
    impulse : [N s] any antiderivative of F as a function of time; used in place of the quadrature

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension, mass or length is not positive, speed or a time is negative, x or start off the string.
    """
    x, t = within("x", x, 0.0, positive("length", length, "m")), times(t)
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    v, a = non_negative("speed", speed, "m/s"), float(within("start", start, 0.0, length))
    until = min(float(np.max(t, initial=0.0)), leaving_time(length - a, v))
    gathered = impulse_function(force, until, impulse=impulse)
    return image_sum(x, t, wave_speed=c, length=length, speed=v, start=a, impulse=gathered) / (
        2.0 * mass_per_length * c
    )


def leaving_time(distance: float, speed: float) -> float:
    """Return the time [s] the force needs for the distance to the end; infinite for a force at rest."""
    return distance / speed if speed > 0.0 else np.inf


def image_sum(
    x: FloatArray,
    t: FloatArray,
    *,
    wave_speed: float,
    length: float,
    speed: float,
    start: float,
    impulse: Impulse,
) -> FloatArray:
    """Sum the impulse [N s] that each image has sent to (x, t); no checks. Nothing is felt before t = 0."""
    leave = leaving_time(length - start, speed)
    if np.isfinite(leave):
        # A free string repeats itself, so that no more images are needed than until one period after the
        # force left.
        t = np.where(t > leave, leave + np.mod(t - leave, 2.0 * length / wave_speed), t)
    laps = int(np.ceil((wave_speed * float(np.max(t, initial=0.0)) + 2.0 * length) / (2.0 * length)))
    total = np.zeros(np.broadcast_shapes(x.shape, t.shape))
    for lap in range(-laps, laps + 1):
        for sign in (1.0, -1.0):
            relative = sign * (x - 2.0 * lap * length) - start
            first, last = influence_interval(relative, t, wave_speed=wave_speed, speed=speed)
            last = np.minimum(last, leave)
            total += sign * (impulse(last) - impulse(np.minimum(first, last)))
    return total


def moving_force_series(
    x: ArrayLike,
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    length: float,
    speed: float,
    force: float | HarmonicForce,
    start: float = 0.0,
    modes: int = 200,
    accelerate: bool = True,
) -> FloatArray:
    """Deflection of a string between rigid ends under a moving force, by sine series.

    ρ ü − T u'' = F(t) δ(x − a − Vt) while a + Vt < L, then free; u(0, t) = u(L, t) = 0, u = u̇ = 0 at t =
    0. For a constant force from a = 0, while it acts: u = Σ (2F/ρL) [sin Ω_n t − (Ω_n/ω_n) sin ω_n t]/(ω_n²
    − Ω_n²) sin(nπx/L), Ω_n = nπV/L, ω_n = nπc/L; at V = c every mode is in resonance and the limit is
    taken. Kinks make the terms fall as 1/n² only; with `accelerate` that part is summed in closed form
    (away from V = c), which leaves a rest that falls as 1/n³, and nothing at all for a constant force.
    Source: paper, eq. 7 with eq. 5; the shapes are sin(nπx/L), the print has cos(lπ/L). Acceleration:
    derived here.

    Parameters
    ----------
    x : [m] positions, 0 ≤ x ≤ L, any shape
    t : [s] times, not negative, broadcasting with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    length : [m] L between the rigid ends
    speed : [m/s] V, not negative; below, at or above the wave speed
    force : [N] positive upwards: a number or a `HarmonicForce`
    start : [m] a, where the force is at t = 0, 0 ≤ a ≤ L
    modes : [-] number of terms
    accelerate : sum the slowly converging part in closed form

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension, mass or length is not positive, speed or a time is negative, x or start off the string, or
        the force is neither constant nor harmonic.
    """
    x, t = within("x", x, 0.0, positive("length", length, "m")), times(t)
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    load = moving_load(force, speed=speed, start=start, length=length)
    gap = 1.0 - (load.speed / c) ** 2
    accelerate = accelerate and abs(gap) > _NEAR_CRITICAL

    def amplitude(time: FloatArray, k: float) -> FloatArray:
        q = load.amplitude(time, k * c, k)
        if accelerate:
            q = q - _quasi_static(load, time, c, length, lambda s: np.sin(k * s)) / (gap * (k * c) ** 2)
        return q * 2.0 / (mass_per_length * length)

    total = sine_sum(x, t, length=length, modes=counted("modes", modes), amplitude=amplitude)
    if accelerate:
        kinks = _quasi_static(load, t, c, length, lambda s: influence_line(x, s, length))
        total = total + kinks / (gap * tension)
    return total


def moving_load(force: Force, *, speed: float, start: float, length: float) -> MovingLoad:
    """Check and bundle what a series needs to know of the force."""
    harmonic = harmonic_or_refuse(force)
    v = non_negative("speed", speed, "m/s")
    a = float(within("start", finite("start", start, "m"), 0.0, length))
    return MovingLoad(harmonic, v, a, leaving_time(length - a, v))


def harmonic_or_refuse(force: Force) -> HarmonicForce:
    """Return a constant or harmonic force as a harmonic one, refuse any other."""
    harmonic = as_harmonic(force)
    if harmonic is None:
        rule = "a series is written for a constant or harmonic force"
        raise refuse("force", force, rule, "pass a number or a HarmonicForce, or use images")
    return harmonic


def _quasi_static(
    load: MovingLoad, t: FloatArray, c: float, length: float, shape: Callable[[FloatArray], FloatArray]
) -> FloatArray:
    """Kinks under the force and those shed when it came and left: a sum of `shape` at their places."""
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
