"""What form finding refuses: designs that no crew could install."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import degrees

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import Catenary, InputError, counted
from catenary_fe.layout.arguments import numbers
from catenary_fe.layout.rules import dropper_names

Floats = NDArray[np.float64]

STEEPEST = np.pi / 3  # [rad] a steady arm that stands up more has no hold on the wire
MOST_OFF = 0.3  # [m] from its design height, of a contact wire on given lengths: as much as an overlap lifts
_HOLDS_DOWN = 5.0  # [N] by which an arm's own weight can
_LEAST_PULL = 1.0  # [N] lateral


def check_pulls(catenary: Catenary, pulls: Floats) -> None:
    """Raises InputError for droppers that would have to push."""
    _report(
        f"{dropper_names(catenary)[i]} would have to push with {-pulls[i]:.1f} N; droppers only pull: change"
        " the pre-sag, the height there or the position"
        for i in np.flatnonzero(pulls < 0)
    )


def check_room(catenary: Catenary, heights: Floats) -> None:
    """Raises InputError for droppers whose upper clamp lies below the lower one."""
    tension = catenary.messenger_wire.tension if catenary.messenger_wire else 0.0
    _report(
        f"{dropper_names(catenary)[i]} has no room: the wire it hangs on lies {abs(heights[i]):.3f} m below"
        f" its lower clamp; raise system_height or the messenger wire's tension of {tension:g} N"
        for i in np.flatnonzero(heights <= 0)
    )


def check_stretch(catenary: Catenary, distances: Floats, tensions: Floats) -> None:
    """Raises InputError for droppers so soft that their tension stretches them from no length at all.

    distances : [m], shape (droppers,), between their clamps
    tensions : [N], shape (droppers,)
    """
    stiffness = np.array([dropper.stiffness for dropper in catenary.droppers])
    _report(
        f"{dropper_names(catenary)[i]}: stiffness = {stiffness[i]:g} N/m is too small: its tension of"
        f" {tensions[i]:.0f} N would stretch it by {tensions[i] / stiffness[i]:.3g} m, and it spans"
        f" {distances[i]:.3g} m; raise it, look at its unit"
        for i in np.flatnonzero(tensions / stiffness >= distances)
    )


def check_arms(catenary: Catenary, arm_forces: Floats) -> None:
    """Raises InputError for steady arms that would have to push, and for links that nothing pulls.

    arm_forces : [N], shape (contact wires, spans + 1, axes - 1), on the wires: in space to the left; up
    """
    faults = []
    for i, support in list(enumerate(catenary.supports, start=1))[1:-1]:
        arm = support.steady_arm
        if arm is None:
            continue
        for force in arm_forces[:, i - 1]:
            left, up = force[0], force[-1]
            if up < -_HOLDS_DOWN and not catenary.gives_dropper_lengths:
                faults.append(
                    f"support {i}: the steady arm would have to hold the contact wire down with {-up:.0f} N:"
                    " steady arms hang from their pivots and only carry: raise the wire here, or lower it at"
                    " the supports beside"
                )
            if arm.length is None or force.size < 2:
                continue
            side = "left" if left > 0 else "right"
            steep = np.arctan2(abs(up), abs(left))
            if abs(left) < _LEAST_PULL:
                faults.append(
                    f"support {i}: no lateral force on the steady arm ({abs(left):.2f} N): a link needs a"
                    " stagger or a curve; give one, or a stiffness instead of a length"
                )
            elif arm.side and arm.side != side:
                faults.append(
                    f"support {i}: the arm on the {arm.side} would have to push with {abs(left):.0f} N:"
                    f" steady arms only pull: put it on the {side}, or change the stagger"
                )
            elif steep > STEEPEST:
                faults.append(
                    f"support {i}: the steady arm would stand up by {degrees(steep):.0f}° to hold {up:.0f} N"
                    f" of weight with {abs(left):.0f} N of lateral force, more than {degrees(STEEPEST):.0f}°;"
                    " give more stagger, or a stiffness instead of a length"
                )
    _report(dict.fromkeys(faults))


def check_reach(catenary: Catenary, lengths: Floats) -> None:
    """Raises InputError for clamps that slid further than droppers of lengths [m] reach."""
    _report(
        f"{name}: clamp_shift = {dropper.clamp_shift:g} m is more than its length of {length:.3f} m reaches;"
        " it slides until the dropper is taut"
        for name, dropper, length in zip(dropper_names(catenary), catenary.droppers, lengths, strict=True)
        if abs(dropper.clamp_shift) >= length
    )


def check_bridged(catenary: Catenary, lengths: Floats, errors: Floats) -> None:
    """Raises InputError for given lengths that take the contact wire where no line has it.

    lengths, errors : [m], shape (droppers,), stress-free, and heights above the design's
    """
    worst = int(np.abs(errors).argmax())
    if abs(errors[worst]) > MOST_OFF:
        count, side = int((np.abs(errors) > MOST_OFF).sum()), "above" if errors[worst] > 0 else "below"
        raise InputError(
            f"{dropper_names(catenary)[worst]}: with a length of {lengths[worst]:g} m the contact wire hangs"
            f" {1e3 * abs(errors[worst]):.0f} mm {side} its design height ({counted(count, 'dropper')} more"
            f" than {1e3 * MOST_OFF:g} mm off): no such line is built; look at its unit, the lengths beside,"
            " and system_height"
        )


def given_lengths(catenary: Catenary, lengths: Sequence[float] | Floats | None) -> Floats:
    """[m], shape (droppers,): lengths that were given here, or in the layout.

    Raises InputError for missing or impossible ones.
    """
    names = dropper_names(catenary)
    if lengths is None:
        missing = [n for n, d in zip(names, catenary.droppers, strict=True) if d.length is None]
        if missing:
            raise InputError(
                f"{missing[0]} has no length ({counted(len(missing), 'dropper')} in all); give all lengths"
            )
        lengths = np.array([d.length for d in catenary.droppers], dtype=float)
    values = numbers("lengths", lengths)
    if values.shape != (len(names),):
        raise InputError(
            f"{counted(values.size, 'dropper length')} for {counted(len(names), 'dropper')}: give one each"
        )
    heights = catenary.messenger_support_heights
    room = np.interp(catenary.dropper_positions, catenary.support_positions, heights)
    room -= catenary.design_heights
    _report(
        f"{name}: a length of {value:g} m must lie between 0 and the system height, {space:g} m there"
        for name, value, space in zip(names, values, room, strict=True)
        if not 0 < value < space
    )
    return values


def _report(faults: Iterable[str]) -> None:
    lines = list(faults)
    if lines:
        raise InputError(*lines)
