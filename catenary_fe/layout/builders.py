"""Lines built by the rules of their types: stitch wires and droppers for each span, by its length.

The rules are from excerpts and course notes (secondary sources), not from the owners' standards. What they do
not say is assumed, and the line's `source` says so.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, get_args

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import library
from catenary_fe.layout.arguments import checked, number, numbers, one_of
from catenary_fe.layout.catenary import Catenary, RayleighDamping
from catenary_fe.layout.errors import InputError, counted
from catenary_fe.layout.library import DropperRule, Line
from catenary_fe.layout.line import Line as SectionedLine
from catenary_fe.layout.parameters import shorten
from catenary_fe.layout.parts import Dropper, Span, SteadyArm, StitchWire, Support

Floats = NDArray[np.float64]
RULES: tuple[DropperRule, ...] = get_args(DropperRule)

# what the sources on lines do not give: values of EN 50318:2018 AC stitched (secondary source, recalled)
USUAL_DROPPER = Dropper(
    position=0.0,
    stiffness=1e5,
    mass_per_length=0.089,
    messenger_clamp_mass=0.155,
    contact_wire_clamp_mass=0.14,
)
USUAL_ARM = SteadyArm(length=1.15, mass_per_length=0.78, clamp_mass=0.46)
USUAL_SUPPORT = Support(messenger_stiffness=5e5, messenger_damping=1000.0)
USUAL_DAMPING = RayleighDamping(alpha=0.0125, beta=1e-4)
USUAL_STAGGER = 0.2  # [m]
STITCH_CLAMP = 0.38  # [kg]
ASSUMED = (
    "Assumed, as of EN 50318:2018 AC stitched, where not said otherwise: masses and stiffness of droppers and"
    " clamps, steady arms, supports, damping"
)

_PAIR = 0.5  # [m] between the droppers of a pair
_PAIRS = {  # by rule and span [m]: first dropper, clear gap between pairs [m], number of droppers
    "CA-220": {60.0: (5.25, 6.50, 16), 55.0: (5.20, 5.80, 16), 50.0: (5.25, 6.00, 14)},
    "CA-160": {60.0: (4.75, 5.75, 18), 50.0: (4.80, 5.20, 16)},
}  # fmt: skip


@checked
def dropper_positions(rule: str, span_length: float) -> Floats:
    """[m], shape (droppers,): where the droppers of a span stand by a rule, from its first support.

    rule : "Re": the German types Re 330 and Re 250, the first dropper on the stitch wire at 5 m (of a stitch
        wire of 14 m, and assumed where there is none, at 4 m), between the outer ones 3, 4 or 5 more above
        36, 44 and 58 m; "France": lines for 300 and 350 km/h, the first at 4.5 m, then every 6.75 m from
        both ends, 4.5 to 9 m in the middle; "CA-220", "CA-160": the Spanish tables for two contact wires,
        pairs 0.5 m apart, one dropper for each wire
    span_length : [m]

    Raises InputError for a span that the rule does not know.
    """
    one_of("rule", rule, RULES)
    length = number("span_length", span_length, "m", above=0)
    if rule == "Re":
        return _german(length)
    if rule == "France":
        return _french(length)
    return _pairs(rule, length)


def _german(length: float) -> Floats:
    if not 36 < length <= 65:
        raise InputError(
            f"span of {length:g} m: the rule of Re 330 and Re 250 is for spans above 36 up to 65 m"
        )
    first = 5.0 if _usual_stitch(length) == 18 else 4.0
    between = 3 + (length > 44) + (length > 58)
    return np.linspace(first, length - first, between + 2)


def _usual_stitch(length: float) -> float:
    """[m] of the stitch wires beside a span, 0 where it has none."""
    return 18.0 if length >= 55 else 14.0 if length >= 44 else 0.0


def _french(length: float) -> Floats:
    first, step, least, most = 4.5, 6.75, 4.5, 9.0
    gaps = int((length - 2 * first - least + 1e-9) // step)
    middle = length - 2 * first - gaps * step
    if gaps < 0 or middle > most + 1e-9:
        raise InputError(
            f"span of {length:g} m: the French rule leaves {middle - step:.4g} or {middle:.4g} m in the"
            f" middle: must be {least:g} to {most:g} m; spans of these lines are multiples of 4.5 m, from"
            " 13.5 m"
        )
    left = first + step * np.arange(gaps - gaps // 2 + 1)
    return np.concatenate([left, length - first - step * np.arange(gaps // 2, -1, -1)])


def _pairs(rule: str, length: float) -> Floats:
    table = _PAIRS[rule]
    if length not in table:
        known = ", ".join(f"{each:g}" for each in sorted(table))
        raise InputError(f"span of {length:g} m: the table of {rule} has spans of {known} m")
    first, gap, count = table[length]
    pairs = first + (gap + _PAIR) * np.arange(count // 2)
    positions: Floats = np.add.outer(pairs, [0.0, _PAIR]).ravel()
    return positions


def stitch_wire_length(span_length: float, next_length: float, longest: float) -> float:
    """[m] of the stitch wire at a support between two spans [m] by the rule of Re 330 and Re 250; 0: none.

    18 m for spans of 55 to 65 m, 14 m from 44 m, none below. Of spans that differ the shorter one decides, an
    assumption.

    longest : [m] of the line type
    """
    return min(longest, _usual_stitch(min(span_length, next_length)))


@checked
def build_line(
    line: str | Line,
    span_lengths: Sequence[float],
    *,
    staggers: Any = None,
    curve_radii: Any = None,
    contact_wire_heights: Any = None,
    steady_arm: SteadyArm | None = None,
    **others: Any,
) -> Catenary:
    """A line of a type of the library, droppers and stitch wires by its rule for each span.

    line : of the library, or its name
    span_lengths : [m]
    staggers : [m] to the left: one number, to alternating sides, or one for each support; unset: the type's
    curve_radii : [m] of the track, positive to the left, 0 where it is straight: one number, or one a span
    contact_wire_heights : [m] above the rail at the supports; unset: one height
    steady_arm : unset: that of EN 50318:2018 AC stitched, a link of 1.15 m
    others : further fields of :class:`Catenary`

    Raises InputError for a type without a dropper rule, and for a span that the rule does not know.
    """
    kind = library.line(line) if isinstance(line, str) else line
    if not isinstance(kind, Line):
        raise InputError(f"line = {shorten(line)}: must be a line of the library, or its name")
    lengths = numbers("span_lengths", span_lengths)
    if lengths.ndim != 1 or not lengths.size:
        raise InputError(
            f"span_lengths = {shorten(span_lengths)}: must be a list of at least one length in m"
        )
    if kind.dropper_rule is None:
        ruled = [name for name in library.names("lines") if library.line(name).dropper_rule]
        raise InputError(
            f"line '{kind.name}': no dropper rule is known; take one of {', '.join(map(repr, ruled))}, or"
            " give the droppers in a table or a layout"
        )
    count = lengths.size
    radii = _each("curve_radii", 0.0 if curve_radii is None else curve_radii, count, "span")
    if staggers is None or np.ndim(staggers) == 0:
        sides = USUAL_STAGGER if kind.stagger is None else kind.stagger
        amplitude = number("staggers", sides if staggers is None else staggers, "m")
        staggers = amplitude * (-1.0) ** np.arange(count + 1)
    at = _each("staggers", staggers, count + 1, "support")
    heights = (
        [None] * (count + 1)
        if contact_wire_heights is None
        else _each("contact_wire_heights", contact_wire_heights, count + 1, "support")
    )
    common = USUAL_SUPPORT.replace(steady_arm=steady_arm or USUAL_ARM)
    supports = [
        common.replace(stagger=float(y), contact_wire_height=z) for y, z in zip(at, heights, strict=True)
    ]
    stitched = _stitched(kind, supports, lengths.tolist())
    given = {
        "name": kind.name,
        "source": f"{kind.source}; built by its rule. {ASSUMED}",
        "system_height": kind.system_height,
        "contact_wire_height": kind.contact_wire_height or 5.3,
        "damping": USUAL_DAMPING,
    }
    return Catenary(
        contact_wire=kind.contact_wire,
        messenger_wire=kind.messenger_wire,
        contact_wire_spacing=kind.contact_wire_spacing,
        stitch_wire=_stitch_wire(kind) if any(s.stitch_wire for s in stitched[1:-1]) else None,
        spans=tuple(rule_span(kind, length, r) for length, r in zip(lengths.tolist(), radii, strict=True)),
        supports=stitched if any(s.stitch_wire for s in stitched[1:-1]) else tuple(supports),
        **(given | others),
    )


def _each(name: str, values: Any, count: int, what: str) -> list[float]:
    array = numbers(name, values)
    if array.ndim == 0:
        array = np.full(count, float(array))
    if array.shape != (count,):
        raise InputError(f"{name}: {counted(array.size, 'value')} for {counted(count, what)}: give one each")
    return list(array.tolist())


def _stitch_wire(kind: Line) -> StitchWire | None:
    if kind.stitch_wire is None or kind.stitch_wire_length is None:
        return None
    return StitchWire(
        **kind.stitch_wire.model_dump(), length=kind.stitch_wire_length, clamp_mass=STITCH_CLAMP
    )


def rule_span(kind: Line, length: float, radius: float | None = None) -> Span:
    """One span of a line by its dropper rule. Raises InputError for a length that the rule does not know."""
    assert kind.dropper_rule is not None
    common = kind.dropper or USUAL_DROPPER
    wires = (1, 2) if kind.contact_wire_spacing else (None, None)
    droppers = tuple(
        common.replace(position=round(float(x), 3), contact_wire=wires[i % 2])
        for i, x in enumerate(dropper_positions(kind.dropper_rule, length))
    )
    pre_sag = kind.pre_sag * length / kind.span_length  # a share of the span
    return Span(length=length, droppers=droppers, pre_sag=pre_sag, curve_radius=radius or None)


def _stitched(kind: Line, supports: Sequence[Support], lengths: Sequence[float]) -> tuple[Support, ...]:
    """Supports with the stitch wires that the rule gives them, where the line has any."""
    usual = kind.stitch_wire_length
    if usual is None or kind.dropper_rule != "Re":
        return tuple(supports)
    inner = [stitch_wire_length(a, b, usual) for a, b in pairwise(lengths)]
    each = [*inner[:1], *inner, *inner[-1:]] or [usual] * 2  # the ends, which have none, as the next ones
    return tuple(
        support.replace(stitch_wire=length > 0, stitch_wire_length=length if 0 < length < usual else None)
        for support, length in zip(supports, each, strict=True)
    )


@dataclass(frozen=True)
class LinePattern:
    """What tables of masts and droppers do not hold.

    line : its wires, damping, heights
    support, dropper : what all have in common
    sag : pre-sag as a share of the span
    kind : type of the library, whose rules place droppers and stitch wires; None: of a base layout
    """

    line: Catenary
    support: Support
    dropper: Dropper
    sag: float
    kind: Line | None = None

    @classmethod
    def of(cls, base: Any) -> LinePattern:
        """Raises InputError for a base whose droppers or supports differ in what the tables do not hold."""
        kind = None
        if isinstance(base, str):
            kind = library.line(base)
            base = build_line(kind.replace(dropper_rule="Re"), [60.0] * 3)  # of which the wires are taken
        if not isinstance(base, Catenary):
            raise InputError(f"base = {base!r:.60}: must be a Catenary or the name of a line in the library")
        sections = base.sections if isinstance(base, SectionedLine) else (base,)
        wires = [(s.contact_wire, s.messenger_wire, s.stitch_wire, s.system_height) for s in sections]
        _one(base, "sections", wires)
        bare = {"stagger": 0.0, "cant": 0.0, "contact_wire_height": None, "system_height": None}
        bare |= {"stitch_wire": True, "stitch_wire_length": None}
        inner = [s for section in sections for s in section.supports[1:-1] or section.supports]
        plumb = {s: {"messenger_stagger": 0.0} for s in inner if not isinstance(s.messenger_stagger, str)}
        support = _one(base, "supports", [s.replace(**bare, **plumb.get(s, {})) for s in inner])
        plain = {"position": 0.0, "length": None, "height_offset": None, "contact_wire": None}
        dropper = _one(base, "droppers", [d.replace(**plain) for d in base.droppers] or [Dropper(position=0)])
        sag = _one(base, "pre-sags", [round(span.pre_sag / span.length, 9) for span in base.spans])
        return cls(sections[0], support, dropper, sag, kind)

    def span(self, length: float) -> Span:
        """A span without a table of droppers. Raises InputError where no rule says where they are."""
        if self.kind and self.kind.dropper_rule:
            return rule_span(self.kind, length)
        alike = [s for s in self.line.spans if abs(s.length - length) < 1e-3] if self.kind is None else []
        if not alike:
            raise InputError(
                f"span of {length:g} m: '{self.line.name}' has no rule for its droppers"
                + ("" if self.kind else ", nor a span of this length")
                + "; give a table of droppers"
            )
        droppers = tuple(d.replace(length=None) for d in alike[0].droppers)
        return alike[0].replace(length=length, droppers=droppers, curve_radius=None, curve_radius_end=None)


def _one(base: Catenary, what: str, parts: Sequence[Any]) -> Any:
    if any(part != parts[0] for part in parts):
        raise InputError(
            f"'{base.name}' as a base of tables: its {what} are of several kinds, and the tables do not say"
            " which is where; take a base with one kind"
        )
    return parts[0]
