"""The string on rigid supports: bays independent of each other, entered and left by the force (fig. 5)."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from catenary_fe.theory._checks import FloatArray, numbers, positive, refuse, times, within
from catenary_fe.theory.bounded_moving_force import harmonic_or_refuse, image_sum, moving_force_series
from catenary_fe.theory.forces import Force, Impulse, impulse_function
from catenary_fe.theory.infinite_string import wave_speed


def moving_force_on_supports(
    x: ArrayLike,
    t: ArrayLike,
    *,
    tension: float,
    mass_per_length: float,
    supports: ArrayLike,
    speed: float,
    force: Force,
    start: float | None = None,
    method: Literal["images", "series"] = "images",
    modes: int = 200,
) -> FloatArray:
    """Deflection of a string on rigid supports at any positions under a force that runs over it.

    ρ ü − T u'' = F(t) δ(x − a − Vt) between the supports s_0 < s_1 < …, u(s_j, t) = 0, u = u̇ = 0 at t = 0.
    A rigid support lets nothing pass, so each bay is a string of its own; the force enters it at (s_j −
    a)/V, leaves it at (s_{j+1} − a)/V, and it rings on. The wire ends at the first and the last support.
    Source: paper, eq. 7 and fig. 5.

    Parameters
    ----------
    x : [m] positions from the first to the last support, any shape
    t : [s] times, not negative, broadcasting with x
    tension : [N] along the wire, constant
    mass_per_length : [kg/m] of the wire, constant
    supports : [m] two positions or more, rising, at any distances
    speed : [m/s] V, positive; below, at or above the wave speed
    force : [N] positive upwards: a number, a `HarmonicForce`, or a function of an array of times
    start : [m] a, where the force is at t = 0, between the first and the last support; none means the first
    method : "images" (exact) or "series" (constant or harmonic force only)
    modes : [-] number of terms of the series in each bay

    Returns
    -------
    FloatArray
        [m] deflection, shape of x and t broadcast

    Raises
    ------
    ValueError
        Tension, mass or speed is not positive, a time is negative, supports do not rise, x or start off the
        wire, unknown method, or a force that the method cannot take.
    """
    places = _rising(supports)
    c = wave_speed(tension=tension, mass_per_length=mass_per_length)
    a = places[0] if start is None else float(within("start", start, places[0], places[-1]))
    v = positive("speed", speed, "m/s", remedy="for a force at rest use one bay and moving_force_by_images")
    if method not in ("images", "series"):
        raise refuse("method", repr(method), "must be 'images' or 'series'", "choose one of them")
    x, t = np.broadcast_arrays(within("x", x, places[0], places[-1]), times(t))
    gathered = impulse_function(force, float(np.max(t, initial=0.0)))
    total = np.zeros(x.shape)
    for left, right in pairwise(places):
        enter, begin, length = max(0.0, (left - a) / v), max(0.0, a - left), right - left
        felt = (x > left) & (x < right) & (t > enter)
        if begin >= length or not felt.any():
            continue
        where, since = x[felt] - left, t[felt] - enter
        if method == "images":
            sent = image_sum(
                where,
                since,
                wave_speed=c,
                length=length,
                speed=v,
                start=begin,
                impulse=_later(gathered, enter),
            )
            total[felt] = sent / (2.0 * mass_per_length * c)
        else:
            shifted = harmonic_or_refuse(force).later(enter)
            total[felt] = moving_force_series(
                where,
                since,
                tension=tension,
                mass_per_length=mass_per_length,
                length=length,
                speed=v,
                force=shifted,
                start=begin,
                modes=modes,
            )
    return total


def _later(impulse: Impulse, delay: float) -> Impulse:
    """Return the impulse on a clock that starts `delay` later; its constant drops out of every difference."""
    return lambda t: impulse(t + delay)


def _rising(supports: ArrayLike) -> list[float]:
    """Return the supports as a list of at least two rising positions."""
    places = numbers("supports", supports)
    if places.ndim != 1 or places.size < 2 or np.any(np.diff(places) <= 0.0):
        rule = "must be two or more positions in rising order"
        raise refuse("supports", places.tolist(), rule, "sort them and drop doubles")
    return [float(place) for place in places]
