"""What the ends of a tension section and its midpoint anchor make of its wires along the track."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pydantic import Field

from catenary_fe.layout.as_built import tension_ratio
from catenary_fe.layout.parts import CLOSEST, Wire
from catenary_fe.layout.track import support_bends

if TYPE_CHECKING:
    from catenary_fe.layout.catenary import Catenary

Floats = NDArray[np.float64]
Loss = Annotated[float, Field(strict=True, allow_inf_nan=False, ge=0, lt=0.1)]
WireField = Literal["contact_wire", "messenger_wire"]
_BESIDE = 1e-6  # [m] beside a support, where the tension steps
_LEAST = 0.5  # of the nominal tension: below it the numbers of friction are a slip of the pen


def wires_with_ends(catenary: Catenary) -> tuple[WireField, ...]:
    """Kinds of wires that end on terminations."""
    return ("contact_wire", "messenger_wire") if catenary.messenger_wire else ("contact_wire",)


def midpoint_place(catenary: Catenary, wire: WireField | None = None) -> float | None:
    """[m] from the section's first support to its midpoint anchor; None where there is none.

    wire : the one that it holds; none where that has a fixed end, which holds it already
    """
    if wire and "fixed" in (catenary.begin.of(wire).kind, catenary.end.of(wire).kind):
        return None
    if catenary.midpoint is not None:
        return float(catenary.support_positions[catenary.midpoint - 1])
    return catenary.midpoint_position


def tension_shares(catenary: Catenary, wire: WireField, x: ArrayLike) -> Floats:
    """Share of its nominal tension that a wire has as installed at places x [m] along the section, any shape.

    Friction takes some in a device at an end, and at each support from there to where the wire is held, by
    the midpoint anchor, else at the end without weights: T_i = T η (1 − loss)^i behind i supports. It is a
    constant force on the wire, and does not turn round where the wire moves the other way. Beside that, its
    tension as built may be another than the nominal one.
    """
    at, ends = np.asarray(x, dtype=float), (catenary.begin.of(wire), catenary.end.of(wire))
    built = tension_ratio(catenary, wire)
    if all(end.kind == "fixed" for end in ends):
        return np.full_like(at, built)
    held = midpoint_place(catenary, wire)
    if held is None:
        pulled = ends[1].kind == "weights" or (ends[1].kind == "spring" and ends[0].kind == "fixed")
        held = 0.0 if pulled else catenary.length
    inner, keeps = catenary.support_positions[1:-1], 1 - catenary.tension_loss
    before = np.searchsorted(inner, at)
    shares: Floats = np.where(
        at < held,
        built * ends[0].efficiency * keeps**before,
        built * ends[1].efficiency * keeps ** (inner.size - before),
    )
    return shares


def shares_at_supports(catenary: Catenary, wire: WireField) -> Floats:
    """Shape (spans + 1,): where friction takes tension at a support, the mean of the shares on both sides."""
    x = catenary.support_positions
    before, behind = (tension_shares(catenary, wire, x + side) for side in (-_BESIDE, _BESIDE))
    shares: Floats = (before + behind) / 2
    return shares


def lateral_pulls(catenary: Catenary) -> Floats:
    """[N], shape (spans + 1,): force to the left on the supports, see :attr:`Catenary.lateral_pulls`.

    Where friction takes tension at a support, its mean on both sides: what that leaves out is the friction's
    own inclination.
    """
    tension = catenary.contact_wire.tension * shares_at_supports(catenary, "contact_wire")
    pulls: Floats = tension * len(catenary.contact_wire_offsets) * support_bends(catenary)
    return pulls


def slowest_contact_wire(catenary: Catenary) -> Wire:
    """The contact wire where it has the least tension, and so the least wave speed; of a line of several
    sections that of the slowest one."""
    found = []
    for section in getattr(catenary, "sections", (catenary,)):
        x = section.support_positions
        share = float(tension_shares(section, "contact_wire", (x[1:] + x[:-1]) / 2).min())
        wire = section.contact_wire
        found.append(wire.replace(tension=wire.tension * share) if share != 1 else wire)
    return min(found, key=lambda wire: wire.wave_speed)


def ends_in_words(catenary: Catenary) -> str:
    """What holds the wires along the track, section by section."""
    said = []
    for section in getattr(catenary, "sections", (catenary,)):
        middle = f", held at support {section.midpoint}" if section.midpoint else ""
        if section.midpoint_position is not None:
            middle = f", held at {section.midpoint_position:g} m"
        loss = f", {100 * section.tension_loss:g} % lost at a support" if section.tension_loss else ""
        said.append(f"begin {section.begin.of_both}{middle}, end {section.end.of_both}{loss}")
    return "; ".join(dict.fromkeys(said))


def termination_faults(catenary: Catenary) -> Iterator[str]:
    """One line for each way in which ends and midpoint do not go together."""
    if faults := list(_faults_of_midpoint(catenary)):
        yield from faults
        return
    for name in ("begin", "end") if catenary.messenger_wire is None else ():
        if getattr(catenary, name).messenger_wire:
            yield f"{name}.messenger_wire has no effect on a line without a messenger wire; leave it out"
    given = catenary.midpoint is not None or catenary.midpoint_position is not None
    both: list[bool] = []
    for wire in wires_with_ends(catenary):
        kinds = [end.of(wire).kind for end in (catenary.begin, catenary.end)]
        both.append("fixed" not in kinds)
        if kinds == ["weights", "weights"] and not given:
            yield (
                f"{wire}: weights at both ends and no midpoint: nothing holds it along the track; name the"
                " support that does in midpoint, or fix an end"
            )
        if kinds == ["spring", "spring"] and not given and catenary.tension_loss:
            yield (
                f"{wire}: tension_loss between springs at both ends has no direction; name the support in"
                " between that holds the wire in midpoint, or fix an end"
            )
    if given and not any(both):
        yield "midpoint has no effect where an end of each wire is fixed; leave it out, or tension both ends"
    if catenary.tension_loss and all(
        end.of(wire).kind == "fixed"
        for end in (catenary.begin, catenary.end)
        for wire in wires_with_ends(catenary)
    ):
        yield "tension_loss has no effect between fixed ends; leave it out"
    yield from _faults_of_friction(catenary)


def _faults_of_midpoint(catenary: Catenary) -> Iterator[str]:
    count, midpoint, place = len(catenary.supports), catenary.midpoint, catenary.midpoint_position
    if midpoint is not None and not 1 < midpoint < count:
        yield f"midpoint = {midpoint}: must be a support inside the section, 2 to {count - 1}"
    if place is None:
        return
    if midpoint is not None:
        yield f"midpoint = {midpoint} and midpoint_position = {place:g} m: give one of them"
    if not 0 < place < catenary.length:
        yield (
            f"midpoint_position = {place:g} m lies outside the section; it counts from the section's first"
            f" support, between 0 and {catenary.length:g} m"
        )
    stations = np.concatenate([catenary.support_positions, catenary.dropper_positions])
    apart = float(np.abs(stations - place).min())
    if _BESIDE < apart < CLOSEST:
        yield (
            f"midpoint_position = {place:.6g} m is {1e3 * apart:.2g} mm from a dropper or support; place it"
            f" there, or at least {CLOSEST:g} m away"
        )


def _faults_of_friction(catenary: Catenary) -> Iterator[str]:
    """Efficiency and losses that leave a wire too little tension."""
    x = catenary.support_positions
    for wire in wires_with_ends(catenary):
        least = float(tension_shares(catenary, wire, (x[1:] + x[:-1]) / 2).min())
        if least < _LEAST:
            yield (
                f"{wire}: efficiency and tension_loss leave it {100 * least:.3g} % of its tension; must be at"
                f" least {100 * _LEAST:g} %: both are shares; lower the loss, or tension the other end too"
            )
        stitch, nominal = catenary.stitch_wire, getattr(catenary, wire).tension
        if wire == "messenger_wire" and stitch and least * nominal <= stitch.tension < nominal:
            yield (
                f"stitch_wire.tension = {stitch.tension:g} N leaves the messenger wire none of the"
                f" {least * nominal:.5g} N that friction leaves it; lower it"
            )
