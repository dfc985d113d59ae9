"""Rules between the parts of a catenary, and what looks wrong though no rule forbids it."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from typing import TYPE_CHECKING

from catenary_fe.layout.arguments import checked
from catenary_fe.layout.equipment import equipment_faults
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.installed import change_faults
from catenary_fe.layout.pantograph import AnyPantograph, Pantograph
from catenary_fe.layout.parameters import Parameters
from catenary_fe.layout.terminations import termination_faults

if TYPE_CHECKING:
    from catenary_fe.layout.catenary import Catenary


def catenary_faults(catenary: Catenary) -> list[str]:
    """One line for each fault of a catenary whose parts are sound by themselves."""
    return [
        *line_faults(catenary),
        *_faults_of_droppers(catenary),
        *_faults_of_stitch_wires(catenary),
        *termination_faults(catenary),
        *equipment_faults(catenary),
        *change_faults(catenary),
        *_faults_without_messenger(catenary),
    ]


def line_faults(catenary: Catenary) -> list[str]:
    """One line for each fault of evaluated spans, plane and supports."""
    return list(_faults_of_line(catenary))


def _faults_of_line(catenary: Catenary) -> Iterator[str]:
    if catenary.evaluated_spans == ():
        yield "evaluated_spans is empty; name spans, or leave it out for the middle third"
    count = len(catenary.spans)
    for number in catenary.evaluated_spans or ():
        if not 1 <= number <= count:
            yield f"evaluated_spans names span {number}: the line has spans 1 to {count}"
    if catenary.spatial is False and catenary.leaves_the_plane:
        yield (
            "spatial = false, but stagger, curves or steady arms with a length leave the vertical plane;"
            " leave it out, or take the planar equivalent (--planar, Catenary.planar())"
        )
    for i, support in list(enumerate(catenary.supports, start=1))[1:-1]:
        if support.stagger and support.steady_arm is None:
            yield f"support {i}: stagger = {support.stagger:g} m without a steady_arm: nothing holds the wire"


def _faults_of_droppers(catenary: Catenary) -> Iterator[str]:
    top, design = catenary.messenger_support_heights, iter(catenary.design_heights)
    for i, span in enumerate(catenary.spans):
        for number, dropper in enumerate(span.droppers, start=1):
            # a messenger wire sags: the most room is at the higher of its two supports
            room = None if dropper.state else max(top[i], top[i + 1]) - next(design)
            if room is not None and dropper.length is not None and dropper.length >= room:
                yield (
                    f"span {i + 1}: dropper {number} with a length of {dropper.length:g} m is longer than"
                    f" the system height allows, {room:g} m here; shorten it or raise system_height"
                )
            if dropper.contact_wire is not None and catenary.contact_wire_spacing is None:
                yield (
                    f"span {i + 1}: dropper {number}: contact_wire = {dropper.contact_wire}, but there is one"
                    " contact wire; give contact_wire_spacing for two, or leave it out"
                )


def _faults_without_messenger(catenary: Catenary) -> Iterator[str]:
    """What needs a messenger wire, on a line without."""
    if catenary.messenger_wire is not None:
        return
    hung = [i for i, span in enumerate(catenary.spans, start=1) if span.droppers]
    if hung:
        yield (
            f"messenger_wire is missing, and span {hung[0]} has droppers; add it: the wire that carries them,"
            " or leave out all droppers of a contact wire that hangs at the supports alone"
        )
        return
    if catenary.stitch_wire is not None:
        yield "stitch_wire without a messenger_wire has nothing to be clamped on; give both, or neither"
    for n, item in enumerate(catenary.equipment, start=1):
        if item.wire == "messenger wire":
            yield f"equipment {n}: wire = 'messenger wire', but the line has none; put it on the contact wire"
    for i, support in list(enumerate(catenary.supports, start=1))[1:-1]:
        if support.steady_arm is None:
            yield (
                f"support {i}: neither a steady_arm nor droppers hold the contact wire; give a steady_arm, or"
                " make one span of the two"
            )


def _faults_of_stitch_wires(catenary: Catenary) -> Iterator[str]:
    wire = catenary.stitch_wire
    if wire is None:
        return
    for i, span in enumerate(catenary.spans):
        lengths = catenary.stitch_wire_lengths[i : i + 2]
        if lengths.sum() / 2 >= span.length:
            yield (
                f"span {i + 1}: stitch wires of {lengths.max():g} m meet in a span of {span.length:g} m;"
                " shorten stitch_wire.length"
            )
    if catenary.messenger_wire and wire.tension >= catenary.messenger_wire.tension:
        yield (
            f"stitch_wire.tension = {wire.tension:g} N leaves the messenger wire none of its"
            f" {catenary.messenger_wire.tension:g} N; lower it"
        )


def dropper_names(catenary: Catenary) -> list[str]:
    """Shape (droppers,): each dropper's name in errors."""
    if sections := getattr(catenary, "sections", ()):
        return [f"section {n}: {name}" for n, s in enumerate(sections, start=1) for name in dropper_names(s)]
    places = zip(catenary.dropper_spans, catenary.dropper_numbers, catenary.droppers, strict=True)
    return [f"span {i}: dropper {number} at {dropper.position:g} m" for i, number, dropper in places]


def check_lengths(catenary: Catenary) -> None:
    """Raises InputError where some droppers have a length and others none: no rule says how to hang those."""
    designed = catenary.as_designed()
    missing = [i for i, dropper in enumerate(designed.droppers) if dropper.length is None]
    if len(missing) not in (0, count := len(designed.droppers)):
        raise InputError(
            f"{dropper_names(designed)[missing[0]]} has no length: {len(missing)} of {count} droppers have"
            " none, the others have one; give all lengths, or none to have them found"
        )


Range = tuple[float, float, str]

# least, most and unit of what overhead lines have, drawn wide around the lines of the library: an assumption.
# Values of 0 mean that something is not there.
_LINE: dict[str, Range] = {
    "contact_wire_height": (3.5, 8.0, "m"),
    "system_height": (0.1, 4.0, "m"),
    "contact_wire_spacing": (0.01, 0.2, "m"),
    "cant_base": (0.6, 1.8, "m"),
}
_DAMPING: dict[str, Range] = {"alpha": (0.0, 5.0, "1/s"), "beta": (0.0, 0.03, "s")}
_WIRE: dict[str, Range] = {
    "mass_per_length": (0.1, 4.0, "kg/m"),
    "tension": (0.0, 1e5, "N"),
    "bending_stiffness": (0.0, 5e3, "N m²"),
    "length": (4.0, 40.0, "m"),
    "clamp_mass": (0.0, 5.0, "kg"),
}
_SPAN: dict[str, Range] = {"length": (5.0, 120.0, "m"), "pre_sag": (0.0, 0.5, "m")}
_DROPPER: dict[str, Range] = {
    "stiffness": (1e3, 1e8, "N/m"),
    "damping": (0.0, 1e4, "N s/m"),
    "mass_per_length": (0.0, 2.0, "kg/m"),
    "messenger_clamp_mass": (0.0, 3.0, "kg"),
    "contact_wire_clamp_mass": (0.0, 3.0, "kg"),
    "height_offset": (0.0, 0.5, "m"),
}
_SUPPORT: dict[str, Range] = {
    "stagger": (0.0, 0.6, "m"),
    "messenger_stagger": (0.0, 1.5, "m"),
    "cant": (0.0, 0.2, "m"),
    "messenger_stiffness": (1e4, 1e10, "N/m"),
    "messenger_lateral_stiffness": (1e3, 1e10, "N/m"),
    "system_height": (0.1, 4.0, "m"),
    "stitch_wire_length": (4.0, 40.0, "m"),
}
_ARM: dict[str, Range] = {
    "length": (0.3, 3.0, "m"),
    "mass": (0.0, 20.0, "kg"),
    "mass_per_length": (0.1, 10.0, "kg/m"),
    "clamp_mass": (0.0, 5.0, "kg"),
    "uplift_room": (0.02, 0.6, "m"),
}
_EQUIPMENT: dict[str, Range] = {
    "mass": (0.05, 80.0, "kg"),
    "length": (0.02, 20.0, "m"),
    "bending_stiffness": (1.0, 1e6, "N m²"),
}


@checked
def layout_warnings(catenary: Catenary) -> list[str]:
    """What looks wrong in a layout, though no rule forbids it; each value is told once."""
    found: dict[tuple[type, str], str] = {}
    for where, owner, usual in _parts(catenary):
        for text in _unusual(owner, usual):
            found.setdefault((type(owner), text), f"{where}{text}")
    warnings = list(found.values())
    for name in ("contact_wire", "messenger_wire"):
        wire = getattr(catenary, name)
        if wire is None:
            continue
        if wire.tension < 1000:
            warnings.append(
                f"{name}.tension = {wire.tension:g} N is below 1000 N: looks like kN, the field takes N"
            )
        strain = wire.tension / wire.axial_stiffness
        if strain > 0.01:
            warnings.append(
                f"{name}: the tension stretches the wire by {100 * strain:.2g} %, more than 1 %: EA ="
                f" {wire.axial_stiffness:g} N looks too small"
            )
    bare = [n for n, s in enumerate(catenary.supports[1:-1], start=2) if s.steady_arm is None]
    if bare:
        warnings.append(
            f"{_supports(bare)} no steady arm: nothing holds the contact wire's height there, it hangs on the"
            " droppers beside; give a steady_arm in [support], unless that is meant"
        )
    return warnings + _without_effect(catenary)


def _without_effect(catenary: Catenary) -> list[str]:
    """Values that change nothing on this line, each kind told once."""
    found: dict[str, str] = {}
    for i, support in enumerate(catenary.supports, start=1):
        if not catenary.is_spatial and support.messenger_lateral_stiffness is not None:
            found.setdefault(
                "lateral",
                f"support {i}: messenger_lateral_stiffness has no effect in the vertical plane; spatial ="
                " true models the line in space",
            )
        if not support.stitch_wire and catenary.stitch_wire is None:
            found.setdefault(
                "stitch", f"support {i}: stitch_wire = false has no effect: the line has no stitch wires"
            )
        inside = 1 < i < len(catenary.supports)
        if inside and support.stitch_wire_length is not None and not catenary.has_stitch_wire(i - 1):
            found.setdefault(
                "stitch length",
                f"support {i}: stitch_wire_length = {support.stitch_wire_length:g} m has no effect: no stitch"
                " wire hangs there",
            )
    if catenary.cant_base != 1.5 and not any(support.cant for support in catenary.supports):
        found["cant"] = f"cant_base = {catenary.cant_base:g} m has no effect: no support has a cant"
    if catenary.messenger_wire is None:
        found |= dict(_of_messenger(catenary))
    if catenary.stitch_wire and not catenary.stitched_supports:
        found["stitch"] = "stitch_wire has no effect: no support between the line's ends has one"
    for i, span in enumerate(catenary.spans, start=1):
        sagging = span.droppers if len(span.droppers) == 1 else span.droppers[1:-1]
        if span.pre_sag and all(d.height_offset is not None for d in sagging):
            found.setdefault(
                "pre_sag",
                f"span {i}: pre_sag = {span.pre_sag:g} m has no effect: it is the sag between the outermost"
                " droppers, where a dropper without a height_offset has to be",
            )
    return list(found.values()) + _anchored(catenary)


def _of_messenger(catenary: Catenary) -> Iterator[tuple[str, str]]:
    """Values that a line without a messenger wire does not need."""
    if catenary.system_height != type(catenary).model_fields["system_height"].default:
        yield "height", f"system_height = {catenary.system_height:g} m has no effect without a messenger_wire"
    names = ("messenger_stiffness", "messenger_lateral_stiffness", "messenger_stagger", "system_height")
    for i, support in enumerate(catenary.supports, start=1):
        for name in names:
            if value := getattr(support, name):
                shown = value if isinstance(value, str) else f"{value:g}"
                yield name, f"support {i}: {name} = {shown} has no effect without a messenger_wire"


def _anchored(catenary: Catenary) -> list[str]:
    """Values of a line's ends alone, which anchor the wires whatever is written there."""
    inert = ("steady_arm", "messenger_stiffness", "messenger_damping", "messenger_lateral_stiffness",
             "messenger_lateral_damping", "stitch_wire",
             "stitch_wire_length")  # fmt: skip
    inner = catenary.supports[1:-1]
    return [
        f"support {i}: {name} has no effect at the line's end, which anchors both wires"
        for i in (1, len(catenary.supports))
        for name in inert
        if inner and all(getattr(s, name) != getattr(catenary.supports[i - 1], name) for s in inner)
    ]


def _supports(numbers: list[int]) -> str:
    """Supports that have something, in words: runs of numbers by their ends."""
    parts, first = [], numbers[0]
    for n, following in zip(numbers, [*numbers[1:], -1], strict=True):
        if following != n + 1:
            parts.append(f"{first} to {n}" if n > first else f"{n}")
            first = following
    several = len(numbers) > 1
    return f"support{'s' if several else ''} {', '.join(parts)} {'have' if several else 'has'}"


def _parts(catenary: Catenary) -> Iterator[tuple[str, Parameters, dict[str, Range]]]:
    yield "", catenary, _LINE
    yield "damping.", catenary.damping, _DAMPING
    yield "contact_wire.", catenary.contact_wire, _WIRE
    if catenary.messenger_wire:
        yield "messenger_wire.", catenary.messenger_wire, _WIRE
    if catenary.stitch_wire:
        yield "stitch_wire.", catenary.stitch_wire, _WIRE
    for i, span in enumerate(catenary.spans, start=1):
        yield f"span {i}: ", span, _SPAN
        for n, dropper in enumerate(span.droppers, start=1):
            yield f"span {i}: dropper {n}: ", dropper, _DROPPER
    for n, item in enumerate(catenary.equipment, start=1):
        yield f"equipment {n}: ", item, _EQUIPMENT
    for i, support in enumerate(catenary.supports, start=1):
        yield f"support {i}: ", support, _SUPPORT
        if support.steady_arm:
            yield f"support {i}: steady_arm.", support.steady_arm, _ARM


def _unusual(owner: Parameters, usual: dict[str, Range]) -> Iterator[str]:
    for name, (least, most, unit) in usual.items():
        value = getattr(owner, name, None)
        if value and not isinstance(value, str) and not least <= abs(value) <= most:
            bounds = f"{least:g} to {most:g}" if least else f"at most {most:g}"
            yield f"{name} = {value:g} {unit}: overhead lines have {bounds} {unit}; look at the unit"


def pantograph_warnings(pantograph: AnyPantograph, speed: float) -> list[str]:
    """What looks wrong in a pantograph at a speed [m/s], though no rule forbids it."""
    name, found = pantograph.name, []
    force = pantograph.target_mean_force(speed) or pantograph.static_uplift(speed)
    if not 20 <= force <= 400:
        found.append(
            f"{name}: pushes with {force:.4g} N at {3.6 * speed:g} km/h; pantographs push with 20 to 400 N:"
            " look at the units of uplift_force and aerodynamic_force"
        )
    found += pantograph.fit_warnings()
    if not isinstance(pantograph, Pantograph):
        return found
    masses = pantograph.masses
    if not 1 <= masses[0] <= 60 or sum(masses) > 300:
        found.append(
            f"{name}: masses of {', '.join(f'{m:g}' for m in masses)} kg, head first: heads have 1 to 60 kg,"
            " pantographs at most 300 kg; look at the unit"
        )
    elif any(above > 3 * below for above, below in pairwise(masses)):
        found.append(
            f"{name}: masses of {', '.join(f'{m:g}' for m in masses)} kg: the head comes first, and is the"
            " lightest; look at the order of the stages"
        )
    return found
