"""Rules that hold between the parts of a catenary: what breaks them, one line a fault."""

from __future__ import annotations

from typing import TYPE_CHECKING

from catenary_fe.layout.errors import InputError

if TYPE_CHECKING:
    from catenary_fe.layout.catenary import Catenary


def catenary_faults(catenary: Catenary) -> list[str]:
    """One line for each fault of a catenary whose parts are sound by themselves."""
    rules = (
        _absent_spans,
        _long_droppers,
        _left_plane,
        _loose_staggers,
        _meeting_stitch_wires,
        _missing_twins,
    )
    return [fault for rule in rules for fault in rule(catenary)]


def _absent_spans(catenary: Catenary) -> list[str]:
    if catenary.evaluated_spans == ():
        return ["evaluated_spans is empty; name spans, or leave it out for the middle third"]
    count = len(catenary.spans)
    return [
        f"evaluated_spans names span {number}: the line has spans 1 to {count}"
        for number in catenary.evaluated_spans or ()
        if not 1 <= number <= count
    ]


def _long_droppers(catenary: Catenary) -> list[str]:
    """A messenger wire sags: no dropper can be longer than the room at the higher of its two supports."""
    faults = []
    top = catenary.messenger_support_heights
    design = iter(catenary.design_heights)
    for i, span in enumerate(catenary.spans):
        for number, dropper in enumerate(span.droppers, start=1):
            room = max(top[i], top[i + 1]) - next(design)
            if dropper.length is not None and dropper.length >= room:
                faults.append(
                    f"span {i + 1}: dropper {number} with a length of {dropper.length:g} m is longer than"
                    f" the system height allows, {room:g} m here; shorten it or raise system_height"
                )
    return faults


def _left_plane(catenary: Catenary) -> list[str]:
    if catenary.spatial is False and catenary.leaves_the_plane:
        return [
            "spatial = false, but stagger, curves or steady arms with a length leave the vertical plane;"
            " leave it out, or take the planar equivalent (--planar, Catenary.planar())"
        ]
    return []


def _loose_staggers(catenary: Catenary) -> list[str]:
    return [
        f"support {i}: stagger = {support.stagger:g} m without a steady_arm: nothing holds the wire"
        for i, support in list(enumerate(catenary.supports, start=1))[1:-1]
        if support.stagger and support.steady_arm is None
    ]


def _meeting_stitch_wires(catenary: Catenary) -> list[str]:
    if catenary.stitch_wire is None:
        return []
    faults, length = [], catenary.stitch_wire.length
    for i, span in enumerate(catenary.spans):
        halves = sum(catenary.has_stitch_wire(n) for n in (i, i + 1))
        if halves * length / 2 >= span.length:
            faults.append(
                f"span {i + 1}: stitch wires of {length:g} m meet in a span of {span.length:g} m;"
                " shorten stitch_wire.length"
            )
    if catenary.stitch_wire.tension >= catenary.messenger_wire.tension:
        faults.append(
            f"stitch_wire.tension = {catenary.stitch_wire.tension:g} N leaves the messenger wire none"
            f" of its {catenary.messenger_wire.tension:g} N; lower it"
        )
    return faults


def _missing_twins(catenary: Catenary) -> list[str]:
    if catenary.contact_wire_spacing is not None:
        return []
    return [
        f"span {i}: dropper {number}: contact_wire = {dropper.contact_wire}, but there is one contact wire;"
        " give contact_wire_spacing for two, or leave it out"
        for i, span in enumerate(catenary.spans, start=1)
        for number, dropper in enumerate(span.droppers, start=1)
        if dropper.contact_wire is not None
    ]


def check_lengths(catenary: Catenary) -> None:
    """Raises InputError where some droppers have a length and others none: no rule says how to hang those."""
    missing = [
        f"span {i}: dropper {number} at {dropper.position:g} m"
        for i, span in enumerate(catenary.spans, start=1)
        for number, dropper in enumerate(span.droppers, start=1)
        if dropper.length is None
    ]
    count = sum(len(span.droppers) for span in catenary.spans)
    if len(missing) not in (0, count):
        raise InputError(
            f"{missing[0]} has no length: {len(missing)} of {count} droppers have none, the others have one;"
            " give all lengths, or none to have them found"
        )
