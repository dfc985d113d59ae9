"""Layouts and pantographs as TOML files, and the JSON Schemas with which an editor completes them."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Annotated, Any, Self

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError, model_validator

from catenary_fe.layout import library
from catenary_fe.layout.arguments import checked
from catenary_fe.layout.as_built import AsBuilt
from catenary_fe.layout.catenary import Catenary, RayleighDamping
from catenary_fe.layout.conditions.from_files import with_tables_as_built
from catenary_fe.layout.entries import (
    DropperDefaults,
    SpanEntry,
    StitchWireEntry,
    SupportEntry,
    WireEntry,
)
from catenary_fe.layout.equipment import Equipment
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.installed import Wear
from catenary_fe.layout.line import join_sections
from catenary_fe.layout.overlap import Overlap
from catenary_fe.layout.pantograph import DescribedPantograph, kind_of
from catenary_fe.layout.parameters import (
    Lateral,
    NonEmpty,
    Number,
    Parameters,
    Positive,
    Temperature,
    Text,
    problem_lines,
)
from catenary_fe.layout.parts import Dropper, SectionEnd, Span, Support
from catenary_fe.layout.receptance import read_receptance, receptance_table_of
from catenary_fe.layout.terminations import Loss
from catenary_fe.layout.toml import read_toml, toml_value

MOST_SPANS = 10_000  # of a line: 500 km, whose model no machine would take
MOST_DROPPERS = 200_000  # of a line, likewise


class SectionEntry(Parameters):
    """A further tension section, or several equal ones; keys that are not given are as of the first."""

    contact_wire: WireEntry | None = None
    """the wire that the pantograph touches"""
    messenger_wire: WireEntry | None = None
    """the wire that carries the droppers"""
    stitch_wire: StitchWireEntry | None = None
    """at each support between the section's ends"""
    stagger: Lateral | None = None
    """[m] of the contact wire at the supports, to the left at the first and then to alternating sides"""
    curve_radius: Number | None = None
    """[m] of the track in spans that do not say otherwise, positive to the left"""
    supports: tuple[SupportEntry, ...] | None = None
    """supports that differ, numbered from the section's first one"""
    span: Annotated[tuple[SpanEntry, ...], NonEmpty] | None = None
    """the section's spans in order, those of its overlaps included"""
    begin: SectionEnd | None = None
    """what holds the wires along the track at the section's first support"""
    end: SectionEnd | None = None
    """what holds the wires along the track at the section's last support"""
    midpoint: Annotated[int, Field(strict=True)] | None = None
    """number of the support, from the section's first one, that holds the wires along the track"""
    midpoint_position: Number | None = None
    """[m] from the section's first support to a midpoint anchor within a span, instead"""
    equipment: tuple[Equipment, ...] = ()
    """within the section's spans; that of other sections is not repeated"""
    wear: tuple[Wear, ...] = ()
    """of the section's contact wire; that of other sections is not repeated"""
    as_built: AsBuilt | None = None
    """by how much the section differs from its drawing; that of other sections is not repeated"""
    overlap: Overlap | None = None
    """with the section before; unset: as the layout's `overlap`"""
    count: Annotated[int, Field(strict=True, ge=1, le=1000)] = 1
    """how many sections like this follow one another"""

    def beside(self, first: LayoutFile) -> LayoutFile:
        """The layout of this section by itself."""
        own = (self.model_fields_set | {"equipment", "wear", "as_built"}) - {"overlap", "count"}
        midpoints = {"midpoint", "midpoint_position"}
        others = dict.fromkeys(midpoints - own) if midpoints & own else {}
        return first.replace(
            **{name: getattr(self, name) for name in own},
            **others,
            further_sections=(),
            overlap=None,
            evaluated_spans=None,
        )


class LayoutFile(Parameters):
    """A catenary layout, as it is written in a TOML file."""

    model_config = ConfigDict(title="catenary_fe layout")

    name: Text
    """what is drawn and printed as title"""
    source: Text = ""
    """where the numbers come from, and how sure they are"""
    contact_wire: WireEntry
    """the wire that the pantograph touches"""
    messenger_wire: WireEntry | None = None
    """the wire that carries the droppers; unset, on a line without droppers: none, the contact wire hangs at
    the supports alone"""
    contact_wire_spacing: Positive | None = None
    """[m] sideways between two equal contact wires; unset: one contact wire"""
    stitch_wire: StitchWireEntry | None = None
    """at each support between the line's ends; unset: none"""
    stagger: Lateral = 0.0
    """[m] of the contact wire at the supports, to the left at the first and then to alternating sides; a
    support that differs may say so"""
    curve_radius: Number | None = None
    """[m] of the track in spans that do not say otherwise, positive to the left; unset: straight"""
    dropper: DropperDefaults = DropperDefaults()
    """values that all droppers have in common"""
    support: Support = Support()
    """values that all supports have in common"""
    supports: tuple[SupportEntry, ...] = ()
    """supports that differ"""
    span: Annotated[tuple[SpanEntry, ...], NonEmpty]
    """the spans in order"""
    contact_wire_height: Positive = 5.3
    """[m] nominal, above the rail"""
    system_height: Positive = 1.2
    """[m] between messenger wire and contact wire at the supports"""
    begin: SectionEnd = SectionEnd(kind="fixed")
    """what holds the wires along the track at the first support"""
    end: SectionEnd = SectionEnd(kind="weights")
    """what holds the wires along the track at the last support"""
    midpoint: Annotated[int, Field(strict=True)] | None = None
    """number of the support, from 1, that holds the wires along the track between two tensioned ends"""
    midpoint_position: Number | None = None
    """[m] from the first support to a midpoint anchor within a span, instead"""
    tension_loss: Loss = 0.0
    """[1] share of a wire's tension that friction takes at each support on the way from weights or spring"""
    equipment: tuple[Equipment, ...] = ()
    """within the spans: section insulators, neutral sections, clamps"""
    wear: tuple[Wear, ...] = ()
    """of the contact wire, since its droppers were cut"""
    as_built: AsBuilt | None = None
    """by how much the line differs from its drawing; unset: not at all"""
    installation_temperature: Temperature = 15.0
    """[°C] at which the line hangs as designed; what is warmer or colder, conditions say"""
    cant_base: Positive = 1.5
    """[m] between the rails' middles, over which `cant` is measured"""
    damping: RayleighDamping = RayleighDamping()
    """of wires and taut droppers"""
    evaluated_spans: tuple[Annotated[int, Field(strict=True)], ...] | None = None
    """numbers of the spans (from 1) for the statistics; unset: the middle third"""
    spatial: Annotated[bool, Field(strict=True)] | None = None
    """true: modelled in space; unset: where stagger, curves or links leave the vertical plane"""
    further_sections: tuple[SectionEntry, ...] = ()
    """tension sections behind the one that the other keys describe"""
    overlap: Overlap | None = None
    """of each section with the next that does not say otherwise; unset: the default of each key"""

    @model_validator(mode="after")
    def _overlaps_of_sections(self) -> Self:
        if self.overlap and not self.further_sections:
            raise ValueError("overlap has no effect on a line of one section; add [[further_sections]]")
        return self

    def catenary(self) -> Catenary:
        """The catenary, or the line of several sections, that the file describes. Raises InputError."""
        if not self.further_sections:
            return self._section()
        first = self.replace(further_sections=(), overlap=None, evaluated_spans=None)
        sections, overlaps, faults = [first._section()], [], []
        for number, entry in enumerate(self.further_sections, start=1):
            try:
                sections += [entry.beside(self)._section()] * entry.count
            except InputError as error:
                faults += [f"further_sections {number}: {line}" for line in error.problems]
            overlaps += [entry.overlap or self.overlap or Overlap()] * entry.count
        if faults:
            raise InputError(*faults)
        return join_sections(
            sections, overlaps, name=self.name, source=self.source, evaluated_spans=self.evaluated_spans
        )

    def _section(self) -> Catenary:
        self._check_size()
        spans = tuple(span for entry in self.span for span in (self._span(entry),) * entry.count)
        supports, faults = self._all_supports(len(spans) + 1)
        made = {"contact_wire", "messenger_wire", "stitch_wire", "supports"}
        same = Catenary.model_fields.keys() & type(self).model_fields.keys() - made
        try:
            catenary = Catenary(
                contact_wire=self.contact_wire.wire(),
                messenger_wire=self.messenger_wire and self.messenger_wire.wire(),
                stitch_wire=self.stitch_wire and self.stitch_wire.wire(),
                spans=spans,
                supports=supports,
                **{name: getattr(self, name) for name in same},
            )
        except InputError as error:
            faults += error.problems
        if faults:
            raise InputError(*faults)
        return catenary

    def _check_size(self) -> None:
        """Raises InputError before a slip in a count fills the memory."""
        spans = sum(entry.count for entry in self.span)
        droppers = sum(entry.count * len(entry.droppers) for entry in self.span)
        for count, what, most in ((spans, "spans", MOST_SPANS), (droppers, "droppers", MOST_DROPPERS)):
            if count > most:
                raise InputError(
                    f"span: {count:,} {what} in all: must be at most {most:,}; look at the counts"
                )

    def _all_supports(self, count: int) -> tuple[tuple[Support, ...], list[str]]:
        """The common support with the differing ones in their places, and what is wrong with those."""
        sides = [self.stagger * (-1) ** i for i in range(count)]
        supports = [self.support.replace(stagger=y) if self.stagger else self.support for y in sides]
        faults: list[str] = []
        if self.stagger and "stagger" in self.support.model_fields_set:
            faults.append(
                f"stagger = {self.stagger:g} m, to alternating sides, and support.stagger ="
                f" {self.support.stagger:g} m: give one of them"
            )
        named: set[int] = set()
        for entry in self.supports:
            if entry.at > count:
                faults.append(f"supports: at = {entry.at}: the line has supports 1 to {count}")
                continue
            if entry.at in named:
                faults.append(f"supports: at = {entry.at} is there twice; make one entry of them")
            named.add(entry.at)
            try:
                supports[entry.at - 1] = entry.beside(supports[entry.at - 1])
            except InputError as error:
                faults += [f"supports: at = {entry.at}: {line}" for line in error.problems]
        return tuple(supports), faults

    def _span(self, entry: SpanEntry) -> Span:
        common = {name: getattr(self.dropper, name) for name in self.dropper.model_fields_set}
        droppers = tuple(
            Dropper(**(common | {name: getattr(d, name) for name in d.model_fields_set}))
            for d in entry.droppers
        )
        own_radius = "curve_radius" in entry.model_fields_set
        return Span(
            length=entry.length,
            droppers=droppers,
            pre_sag=entry.pre_sag,
            curve_radius=entry.curve_radius if own_radius else self.curve_radius,
            curve_radius_end=entry.curve_radius_end,
        )


def layout_record(path: str | Path) -> dict[str, Any]:
    """What a layout file says, with the CSV tables that it names. Raises InputError for faulty ones."""
    return with_tables_as_built(read_toml(Path(path), "layout"), Path(path).parent)


def layout_bytes(path: str | Path) -> bytes:
    """A layout file's content; where it names other files, with what they say in their place."""
    record = read_toml(Path(path), "layout")
    if with_tables_as_built(record, None) == record:
        return Path(path).read_bytes()
    return "".join(f"{key} = {toml_value(value)}\n" for key, value in layout_record(path).items()).encode()


@checked
def load_catenary(path: str | Path) -> Catenary:
    """Read a layout file (TOML).

    Raises InputError, one line for each fault that the file has.
    """
    path = Path(path)
    record = layout_record(path)
    try:
        return LayoutFile.model_validate(record).catenary()
    except ValidationError as error:
        lines = [*fault_lines(error, record), *_further_faults(record, error)]
    except InputError as error:
        lines = list(error.problems)
    raise InputError(*(f"{path}: {line}" for line in lines)) from None


def fault_lines(error: ValidationError, record: dict[str, Any]) -> list[str]:
    """One line for each fault of a layout as it is written, by the numbers of spans and supports on site."""
    names = _numbers_on_site(record)
    found = [(line, re.match(r"(?:supports|span) \d+", line)) for line in problem_lines(error, LayoutFile)]
    return [names.get(m[0], m[0]) + line[m.end() :] if m else line for line, m in found]


def _numbers_on_site(record: dict[str, Any]) -> dict[str, str]:
    """Names of entries in lists: by the support, or by the first of the spans that they stand for."""
    names, first = {}, 1
    for n, entry in enumerate(_entries(record, "supports"), start=1):
        at = entry.get("at")
        names[f"supports {n}"] = f"supports: at = {at}" if type(at) is int else f"entry {n} of [[supports]]"
    for n, entry in enumerate(_entries(record, "span"), start=1):
        if first != n:
            names[f"span {n}"] = f"span {first} (entry {n} of [[span]])"
        count = entry.get("count", 1)
        first += count if type(count) is int else 1
    return names


def _entries(record: dict[str, Any], key: str) -> list[dict[str, Any]]:
    entries = record.get(key)
    return [e if isinstance(e, dict) else {} for e in entries] if isinstance(entries, list) else []


def _further_faults(record: dict[str, Any], error: ValidationError) -> tuple[str, ...]:
    """What would be wrong with the layout if its faulty tables were sound, to be reported together."""
    faulty = {detail["loc"][0] for detail in error.errors(include_url=False) if detail["loc"]}
    wire = {"mass_per_length": 1.0, "tension": 1e4, "axial_stiffness": 1e7}
    stand_ins = {"name": "", "contact_wire": wire, "messenger_wire": wire}
    try:
        LayoutFile.model_validate(stand_ins | {k: v for k, v in record.items() if k not in faulty}).catenary()
    except ValidationError:
        pass  # the spans themselves are at fault
    except InputError as further:
        return further.problems
    return ()


@checked
def load_pantograph(name_or_path: str | Path) -> DescribedPantograph:
    """A pantograph from a TOML file, or from the library by its name.

    A file with ``force`` and ``stiffness``, or with a ``law``, is that of an elastic pantograph; one with a
    ``receptance`` names a table beside it, which is read along.

    Raises InputError, one line for each fault that the file has, or the near names of the library.
    """
    path = Path(name_or_path)
    if path.suffix == ".toml" or (os.path.exists(path) and not os.path.isdir(path)):
        record = read_toml(path, "pantograph")
        model = kind_of(record)
        if table := receptance_table_of(path, record):
            record["receptance"] = read_receptance(table)
        try:
            return model.model_validate(record)
        except ValidationError as error:
            raise InputError(*problem_lines(error, model, where=str(path))) from None
    return library.pantograph(str(name_or_path))


def layout_schema() -> dict[str, Any]:
    """JSON Schema of a layout file."""
    return LayoutFile.model_json_schema()


def pantograph_schema() -> dict[str, Any]:
    """JSON Schema of a pantograph file: of masses, of a receptance, or elastic."""
    return TypeAdapter(DescribedPantograph).json_schema() | {"title": "catenary_fe pantograph"}
