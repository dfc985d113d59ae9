"""Where a linearised run's motions were too large for it: which wire, which dropper, where and when.

The bounds come from 96 pairs of a linearised and a nonlinear run: EN 50318:2002 (also with 11 kN in both
wires), EN 50318:2018 AC simple and AC stitched, Re 330, Re 250 and the DC line with two contact wires, on six
spans, pushed up by 90 to 500 N at two or three speeds each. In the 64 pairs inside both bounds the standard
deviations agree within 0.5 % and the filtered forces within 3 % of them (rms); outside, up to 1.1 % and 9 %
are found.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.reduction import Gaps
from catenary_fe.fe.system import System
from catenary_fe.layout import Catenary

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]

TENSION_CHANGE = 0.015  # of the tension that carries there
SLACKENING = 0.1  # [m] shortening of a slack dropper
_REMEDY = "beyond that the force can be off by more than 3 % of σ: run again with the method nonlinear"


def tension_doubts(
    system: System, supports: Floats, gaps: Gaps, change: Floats, changed: Integers, step: float
) -> list[str]:
    """A warning where the tension of a wire changed by too much of the tension that carries there.

    supports : [m], shape (spans + 1,), along the line
    change, changed : [N], shape (gaps,), largest change, and the time step at whose end it was
    step : [s]

    A pantograph meets the contact wire's wave speed, which follows the contact wire's own tension, and the
    line's stiffness, which follows the tension of all wires over one another. So the contact wire's change
    is a share of its own tension, a messenger or stitch wire's one of contact and messenger wires' together.
    A stitch wire of 3.5 kN that changes by 9 % takes 300 N out of 48 kN: no force shows that.
    """
    wires = system.wires
    own = np.array([wire.tension.max() for wire in wires])
    section = np.array([wire.section for wire in wires])
    whole = np.array([wire.supports.size > 0 for wire in wires])  # stitch wires are not
    together = np.bincount(section[whole], own[whole])
    touched = np.array([wire.contact for wire in wires])[gaps.wire]
    carrying = np.where(touched, own[gaps.wire], together[section[gaps.wire]])
    share = change / carrying
    worst = int(share.argmax())
    if share[worst] <= TENSION_CHANGE:
        return []
    where, when = _wire_at(system, supports, gaps, worst), step * changed[worst]
    whose = "its own" if touched[worst] else "that of contact and messenger wires together"
    return [
        f"linearised run: the tension of {where} changes by {change[worst]:.0f} N at {when:.2f} s,"
        f" {100 * share[worst]:.1f} % of {whose}, {carrying[worst] / 1e3:.4g} kN; linearised runs are good"
        f" up to {100 * TENSION_CHANGE:g} %; {_REMEDY}"
    ]


def _wire_at(system: System, supports: Floats, gaps: Gaps, gap: int) -> str:
    """A wire and a place on it in words."""
    wire = system.wires[int(gaps.wire[gap])]
    if not wire.supports.size:
        return f"the {wire.name} at support {int(np.abs(supports - wire.x.mean()).argmin()) + 1}"
    begin, end = gaps.ends[gap]
    twins = [w for w in system.wires if w.contact and w.section == wire.section] if wire.contact else []
    side = ["right ", "left "][twins.index(wire)] if len(twins) > 1 else ""
    span = int(np.searchsorted(supports, (begin + end) / 2))
    return f"the {side}{wire.name} in span {span}, between {begin:.4g} and {end:.4g} m,"


def slack_doubts(catenary: Catenary, shortening: Floats, shortened: Integers, step: float) -> list[str]:
    """A warning where a slack dropper's ends came too close to each other.

    shortening, shortened : [m], shape (droppers,), largest one of each, and the time step at whose end it was
    step : [s]

    The wires there have moved so far that inclinations of third order begin to count.
    """
    worst = int(shortening.argmax()) if shortening.size else 0
    if not shortening.size or shortening[worst] <= SLACKENING:
        return []
    span = int(catenary.dropper_spans[worst])
    number = int(catenary.dropper_numbers[worst])
    place, when = catenary.dropper_positions[worst], step * shortened[worst]
    return [
        f"linearised run: dropper {number} of span {span}, at {place:.4g} m, is slack at {when:.2f} s and"
        f" shortens by {1e3 * shortening[worst]:.0f} mm; linearised runs are good up to"
        f" {1e3 * SLACKENING:g} mm; {_REMEDY}"
    ]
