"""What standards ask of current collection: the limits by system and speed, and how sure each one is.

No text of a standard was open to us: limits come from secondary sources, or were recalled, and say which.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, cast, get_args

from catenary_fe.layout.arguments import number, one_of

PowerSystem = Literal["AC", "DC 3 kV", "DC 1.5 kV"]
MeanForceRule = Literal["EN 50367 AC", "EN 50367 DC 3 kV", "EN 50367 DC 1.5 kV"]
Bound = Literal["minimum", "maximum"]

DEVIATION_SHARE = 0.3  # standard deviation over mean force, at most (secondary source)
WAVE_SPEED_SHARE = 0.7  # of the contact wire's wave speed, EN 50119 practice (secondary source)
# speed up to [km/h], and the largest gradient there (EN 50119, recalled)
_GRADIENTS = ((50, 25e-3), (60, 20e-3), (100, 6e-3), (120, 4e-3), (160, 3.3e-3), (200, 2e-3), (250, 1e-3))
UPLIFT_FACTOR = 2.0  # times the computed uplift must have room at a steady arm (recalled)
MEAN_FORCE_TOLERANCE = 0.1  # [N] within which a run's uplift is set for a mean force


@dataclass(frozen=True)
class Limit:
    """A limit and what it rests on.

    value : in the quantity's SI unit; None where it is not known here
    source : where it comes from
    recalled : whether it was recalled by an expert, not read anywhere
    """

    value: float | None
    source: str
    recalled: bool = True


@dataclass(frozen=True)
class _Parabola:
    """Mean force a v² + b [N], v in km/h, and the speed [km/h] above which it holds."""

    quadratic: float
    constant: float
    above: float = 0.0
    recalled: bool = True

    def at(self, v: float) -> float:
        return self.quadratic * v**2 + self.constant


# fastest first; of DC 1.5 kV only what holds above 200 km/h is known here
_MEAN_FORCE: dict[tuple[PowerSystem, Bound], tuple[_Parabola, ...]] = {
    ("AC", "maximum"): (_Parabola(0.00097, 70, above=200, recalled=False), _Parabola(0.00047, 90)),
    ("AC", "minimum"): (_Parabola(0.00047, 60),),
    ("DC 3 kV", "maximum"): (_Parabola(0.00097, 110),),
    ("DC 3 kV", "minimum"): (_Parabola(0.00096, 60),),
    ("DC 1.5 kV", "maximum"): (_Parabola(0.00228, 90, above=200),),
    ("DC 1.5 kV", "minimum"): (_Parabola(0.00112, 70, above=200),),
}


def _kmh(speed: float) -> float:
    return round(3.6 * speed, 9)  # 200 km/h given in m/s is not above 200 km/h


def gradient_limit(speed: float) -> Limit:
    """Largest gradient of the contact wire at a speed in m/s; it may change by half of that at a support."""
    largest = next((gradient for fastest, gradient in _GRADIENTS if _kmh(speed) <= fastest), 0.0)
    return Limit(largest, "EN 50119 (recalled)")


def mean_force_limit(system: PowerSystem, bound: Bound, speed: float) -> Limit:
    """[N] smallest or largest mean contact force that EN 50367 allows.

    speed : [m/s] of the train
    """
    v = _kmh(speed)
    for curve in _MEAN_FORCE[system, bound]:
        if v > curve.above:
            how = "recalled" if curve.recalled else "secondary source"
            formula = f"{curve.quadratic:g} v² + {curve.constant:g}"
            return Limit(curve.at(v), f"EN 50367 {system}, {formula} ({how})", curve.recalled)
    return Limit(None, f"EN 50367 {system} up to {curve.above:g} km/h: not known here", recalled=False)


def target_mean_force(rule: MeanForceRule, speed: float) -> float:
    """[N] largest mean contact force that EN 50367 allows.

    rule : which system's formula
    speed : [m/s] of the train

    Source: the AC formula above 200 km/h from a secondary source; the others were recalled, not read. Of the
    DC 1.5 kV formula only the branch above 200 km/h is known here: below it, the same formula is used.

    Raises InputError for another rule, or a speed that is not one.
    """
    one_of("rule", rule, get_args(MeanForceRule))
    v = _kmh(number("speed", speed, "m/s", least=0.0))
    system = cast(PowerSystem, rule.removeprefix("EN 50367 "))
    curves = _MEAN_FORCE[system, "maximum"]
    return next((c for c in curves if v > c.above), curves[-1]).at(v)


def contact_loss_limit(speed: float) -> Limit:
    """Largest share of the time in losses of contact longer than 5 ms, as standards limit the time with arcs.

    speed : [m/s] of the train

    A loss in a run stands for an arc on the line; 0.1 % below 250 km/h and 0.2 % from there on were recalled
    as practice of EN 50367 and EN 50119.
    """
    if _kmh(speed) < 250:
        return Limit(0.001, "losses longer than 5 ms, below 250 km/h (recalled)")
    return Limit(0.002, "losses longer than 5 ms, from 250 km/h on (recalled)")


def force_limit(system: PowerSystem, speed: float) -> Limit:
    """[N] largest contact force, actual or statistical; known for AC alone.

    speed : [m/s] of the train
    """
    if system != "AC":
        return Limit(None, f"largest force, {system}: not known here", recalled=False)
    if _kmh(speed) <= 200:
        return Limit(300.0, "AC up to 200 km/h (recalled)")
    return Limit(350.0, "AC above 200 km/h (recalled)")
