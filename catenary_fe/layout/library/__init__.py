"""Published wires, lines and pantographs, each with its source and how sure it is."""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Mapping
from functools import cache
from importlib import resources
from typing import Any, Literal

from catenary_fe.layout.arguments import checked, number, one_of, whole
from catenary_fe.layout.catenary import Catenary
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.pantograph import Pantograph
from catenary_fe.layout.parameters import Lateral, Number, Parameters, Positive, Text, shorten
from catenary_fe.layout.parts import Dropper, Span, SteadyArm, StitchWire, Support, Wire

DropperRule = Literal["Re", "France", "CA-220", "CA-160"]


class Line(Parameters):
    """A published line: wires, tensions and geometry, as far as they are known."""

    name: Text
    """of the line"""
    source: Text
    """where the numbers come from, and how sure they are"""
    contact_wire: Wire
    """with its tension"""
    contact_wire_spacing: Positive | None = None
    """[m] sideways between two equal contact wires; unset: one contact wire"""
    messenger_wire: Wire
    """with its tension"""
    span_length: Positive
    """[m] of the usual span"""
    system_height: Positive
    """[m] between messenger wire and contact wire at the supports"""
    contact_wire_height: Positive | None = None
    """[m] above the rail, where known"""
    pre_sag: Number = 0.0
    """[m] at mid-span"""
    stagger: Lateral | None = None
    """[m] to either side, where known"""
    stitch_wire: Wire | None = None
    """with its tension; unset: the line has none"""
    stitch_wire_length: Positive | None = None
    """[m] along the track, half of it to each side of the support"""
    dropper: Dropper | None = None
    """what the droppers have in common, where known (position 0)"""
    dropper_rule: DropperRule | None = None
    """by which the droppers are placed, where known: :func:`build_line` builds the line by it"""

    @checked
    def catenary(self, *, spans: int = 10, dropper_spacing: float = 6.0, steady_arm: SteadyArm) -> Catenary:
        """A layout of equal spans on this line's wires.

        spans : number of spans
        dropper_spacing : [m] wanted distance of the droppers; they are spread evenly, the first half a
            distance from the support. An assumption: the published data do not place them.
        steady_arm : registration, which the published data do not give

        Raises InputError where a value breaks a rule. The layouts that come with the sources place droppers
        and arms with more care.
        """
        whole("spans", spans, least=1, most=10_000)
        number("dropper_spacing", dropper_spacing, "m", least=0.5)
        count = max(2, round(self.span_length / dropper_spacing))
        gap = self.span_length / count
        common = self.dropper or Dropper(position=0.0)
        droppers = tuple(common.replace(position=(i + 0.5) * gap) for i in range(count))
        sides = [(self.stagger or 0.0) * (-1) ** i for i in range(spans + 1)]
        stitch_wire = None
        if self.stitch_wire and self.stitch_wire_length:
            stitch_wire = StitchWire(**self.stitch_wire.model_dump(), length=self.stitch_wire_length)
        return Catenary(
            name=self.name,
            source=self.source,
            contact_wire=self.contact_wire,
            contact_wire_spacing=self.contact_wire_spacing,
            messenger_wire=self.messenger_wire,
            stitch_wire=stitch_wire,
            spans=(Span(length=self.span_length, droppers=droppers, pre_sag=self.pre_sag),) * spans,
            supports=tuple(Support(steady_arm=steady_arm, stagger=y) for y in sides),
            system_height=self.system_height,
            contact_wire_height=self.contact_wire_height or 5.3,
        )


@checked
def wire(name: str, *, tension: float) -> Wire:
    """A wire of the library under a tension [N]. Raises InputError with the near names."""
    return Wire(**(wire_record(name) | {"tension": tension}))


@checked
def wire_record(name: str) -> dict[str, Any]:
    """What the library knows of a wire: all fields but the tension. Raises InputError with the near names."""
    return _find("wire", name)


@checked
def pantograph(name: str) -> Pantograph:
    """A pantograph of the library. Raises InputError with the near names."""
    return Pantograph(**_find("pantograph", name))


@checked
def line(name: str) -> Line:
    """A line of the library. Raises InputError with the near names."""
    record = _find("line", name)
    for key in ("contact_wire", "messenger_wire", "stitch_wire"):
        if key in record:
            record[key] = wire(record[key]["library"], tension=record[key]["tension"])
    return Line(**record)


def names(kind: str) -> list[str]:
    """Names in the library; kind is 'wires', 'pantographs' or 'lines'. Raises InputError for another one."""
    one_of("library: kind", kind, ("wires", "pantographs", "lines"))
    return list(_records(kind))


_SHOWN = 10  # names of a kind in an error


@cache
def _records(kind: str) -> Mapping[str, Mapping[str, Any]]:
    text = resources.files(__name__).joinpath(f"{kind}.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def _find(kind: str, name: str) -> dict[str, Any]:
    """The record of this name, in whatever case, with the name as the library writes it."""
    records = _records(f"{kind}s")
    folded = {known.casefold(): known for known in records}
    known = folded.get(name.casefold())
    if known:
        return {**records[known], "name": known}
    near = [folded[n] for n in difflib.get_close_matches(name.casefold(), folded, n=3, cutoff=0.4)]
    shown = near or list(records)[:_SHOWN]
    listed = ", ".join(f"'{n}'" for n in shown)
    if not near and len(records) > _SHOWN:
        listed += f" and {len(records) - _SHOWN} more"
    raise InputError(
        f"no {kind} {shorten(name)} in the library; {'near' if near else 'known'} names: {listed}"
    )
