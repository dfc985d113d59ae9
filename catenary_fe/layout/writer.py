"""A catenary as the text of a layout file: what all parts share is written once, what differs beside it."""

from __future__ import annotations

import tomllib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

from pydantic import ValidationError

from catenary_fe.layout import library
from catenary_fe.layout.arguments import checked
from catenary_fe.layout.catenary import Catenary
from catenary_fe.layout.entries import SteadyArmEntry
from catenary_fe.layout.errors import InputError
from catenary_fe.layout.files import LayoutFile, SectionEntry
from catenary_fe.layout.line import Line
from catenary_fe.layout.overlap import Overlap
from catenary_fe.layout.parameters import Parameters
from catenary_fe.layout.parts import Dropper, Span, SteadyArm, Support, Wire
from catenary_fe.layout.toml import toml_value
from catenary_fe.layout.variation import unit_of

_WIDTH = 110  # of a line, where a list can be broken
_Record = dict[str, Any]


@checked
def layout_text(catenary: Catenary, *, comment: str = "") -> str:
    """The text of a layout file that describes a catenary; read again, it is equal to it.

    Equal spans are counted, values that most droppers or supports share are written once, wires of the
    library by their name. Overlaps of several sections are written span by span.

    comment : lines to stand above it

    Raises InputError where the file format cannot say what a catenary made in Python says.
    """
    record = layout_record(catenary)
    text = "".join(f"# {line}\n" for line in comment.splitlines()) + "\n" * bool(comment) + _toml(record)
    try:
        again = LayoutFile.model_validate(tomllib.loads(text)).catenary()
    except (ValidationError, ValueError) as error:
        raise InputError(f"{catenary.name}: no layout file can say this: {error}") from None
    wanted = _as_written(catenary)
    if again != wanted:
        fields = type(wanted).model_fields
        names = [n for n in fields if getattr(again, n, None) != getattr(wanted, n)]
        raise InputError(
            f"{catenary.name}: no layout file can say its {', '.join(names)}; give values that can be written"
        )
    return text


def _as_written(catenary: Catenary) -> Catenary:
    """Itself; a line of several sections as a file has it: of one name, its overlaps span by span."""
    if not isinstance(catenary, Line):
        return catenary
    same = {"name": catenary.name, "source": catenary.source, "evaluated_spans": None}
    overlaps = [Overlap(spans=o.spans, kind=o.kind, as_written=True) for o in catenary.overlaps]
    return catenary.replace(sections=[s.replace(**same) for s in catenary.sections], overlaps=overlaps)


def layout_record(catenary: Catenary) -> _Record:
    """Keys and values of the layout file."""
    sections = catenary.sections if isinstance(catenary, Line) else (catenary,)
    shared = _Shared.of(sections)
    first, *further = (_section(section, shared) for section in sections)
    found: _Record = {"name": catenary.name}
    for name in LayoutFile.model_fields:
        if name in Catenary.model_fields and name not in _MADE:
            owner = catenary if name in ("source", "evaluated_spans") else sections[0]
            value, default = getattr(owner, name), Catenary.model_fields[name].get_default()
            if value is not None and (value != default or name in ("contact_wire_height", "system_height")):
                found[name] = _wire(value) if isinstance(value, Wire) else _plain(value)
    found |= {"dropper": shared.dropper} if shared.dropper else {}
    found |= {"support": shared.support} if shared.support else {}
    found |= {name: value for name, value in first.items() if value or name == "span"}
    if isinstance(catenary, Line):
        entries = zip(sections[1:], further, catenary.overlaps, strict=True)
        found["further_sections"] = [_further(sections[0], *entry) for entry in entries]
    return found


def _further(first: Catenary, section: Catenary, own: _Record, overlap: Overlap) -> _Record:
    """An entry of a further section: its wires and ends where they are others, its supports and spans."""
    others = {}
    for name in SectionEntry.model_fields.keys() & Catenary.model_fields.keys() - _MADE:
        value = getattr(section, name)
        if name not in ("spans", *_OF_ONE) and value not in (None, getattr(first, name)):
            others[name] = _wire(value) if isinstance(value, Wire) else _plain(value)
    head = {"overlap": {"spans": overlap.spans, "kind": overlap.kind, "as_written": True}}
    lists = {name: _plain(items) for name in _OF_ONE if (items := getattr(section, name))}
    return dict(sorted(others.items())) | {"stagger": own.get("stagger", 0.0)} | head | lists | own


_OF_ONE = ("equipment", "wear", "as_built")  # of a section, which the next does not repeat
_MADE = {"supports", "stagger", "curve_radius"}
_BLOCKS = {
    "supports",
    "span",
    "further_sections",
    "equipment",
    "wear",
}  # lists that are written as [[tables]]


@dataclass(frozen=True)
class _Shared:
    """Tables ``dropper`` and ``support`` of what most have in common, and the steady arm of all supports."""

    dropper: _Record
    support: _Record
    arm: SteadyArm | None

    @classmethod
    def of(cls, sections: Sequence[Catenary]) -> _Shared:
        droppers = [d for section in sections for span in section.spans for d in span.droppers]
        supports = [s for section in sections for s in section.supports]
        arms = [support.steady_arm for support in supports]
        arm = Counter(arms).most_common(1)[0][0] if None not in arms else None
        if arm and any(_own_arm(each, arm) is None for each in arms):
            arm = None  # a value of some cannot be taken back in others
        support = _shared([_fields(s, without=("steady_arm", "stagger")) for s in supports], Support)
        return cls(
            _shared([_fields(d, without=("position",)) for d in droppers], Dropper),
            support | ({"steady_arm": _plain(arm)} if arm else {}),
            arm,
        )


def _section(section: Catenary, shared: _Shared) -> _Record:
    """``stagger``, ``supports`` and ``span`` of one section."""
    spans = [
        ({"count": n} if (n := len(list(same))) > 1 else {}) | _span(span, shared.dropper)
        for span, same in groupby(section.spans)
    ]
    return _supports(section, shared) | {"span": spans}


def _default(model: type[Parameters], name: str) -> Any:
    field = model.model_fields[name]
    return None if field.is_required() else field.get_default()


def _fields(part: Parameters, without: Sequence[str] = ()) -> _Record:
    return {name: getattr(part, name) for name in type(part).model_fields if name not in without}


def _plain(value: Any) -> Any:
    """Tables and lists of what is not as it is anyway."""
    if isinstance(value, Parameters):
        kept = {n: v for n, v in _fields(value).items() if v is not None and v != _default(type(value), n)}
        return {name: _plain(v) for name, v in kept.items()}
    return [_plain(v) for v in value] if isinstance(value, tuple | list) else value


def _wire(wire: Wire) -> _Record:
    """By its name in the library with what differs, or all of its own."""
    if wire.name not in library.names("wires"):
        return dict(_plain(wire))
    known = library.wire_record(wire.name)
    own = {n: v for n, v in _fields(wire).items() if v != known.get(n, _default(type(wire), n))}
    if None in own.values():  # cannot be taken back from the library's
        return {name: value for name, value in _plain(wire).items() if value is not None}
    return {"library": wire.name} | own


def _shared(records: Sequence[_Record], model: type[Parameters]) -> _Record:
    """Values that more than half of the records have, where all of them have one."""
    shared = {}
    for name in records[0] if records else ():
        values = [record[name] for record in records]
        value, count = Counter(values).most_common(1)[0] if not _tables(values) else (None, 0)
        if 2 * count > len(values) and None not in values and value != _default(model, name):
            shared[name] = value
    return shared


def _tables(values: Sequence[Any]) -> bool:
    return any(isinstance(value, Parameters | tuple) for value in values)


def _own(part: Parameters, common: _Record, without: Sequence[str] = ()) -> _Record:
    """What a part does not share."""
    found = {
        name: _plain(value)
        for name, value in _fields(part, without).items()
        if value != common.get(name, _default(type(part), name))
    }
    return {name: value for name, value in found.items() if value is not None}


def _span(span: Span, common: _Record) -> _Record:
    droppers = [{"position": d.position} | _own(d, common, without=("position",)) for d in span.droppers]
    own = _own(span, {}, without=("droppers",))
    return own | {"droppers": [d if len(d) > 1 else d["position"] for d in droppers]}


def _supports(section: Catenary, shared: _Shared) -> _Record:
    """``stagger`` and ``supports``."""
    sides = [s.stagger * (-1) ** i + 0.0 for i, s in enumerate(section.supports)]
    stagger, count = Counter(sides).most_common(1)[0]
    stagger = stagger if count > sum(s.stagger == 0 for s in section.supports) else 0.0
    entries = []
    for i, support in enumerate(section.supports):
        beside = shared.support | {"stagger": stagger * (-1) ** i}
        arm = _own_arm(support.steady_arm, shared.arm)
        own = _own(support, beside, without=("steady_arm",)) | ({"steady_arm": arm} if arm else {})
        entries += [{"at": i + 1} | own] if own else []
    return {"stagger": stagger, "supports": entries}


def _own_arm(arm: SteadyArm | None, usual: SteadyArm | None) -> _Record | None:
    """What makes this arm of the usual one, as little as can be; None where nothing does."""
    if arm is None or usual is None or arm == usual:
        return {} if arm is None or arm == usual else dict(_plain(arm))
    fields = {name: value for name, value in _fields(arm).items() if value is not None}
    fewer = {name: value for name, value in fields.items() if value != getattr(usual, name)}
    for own in sorted((fewer, dict(_plain(arm)), fields), key=len):
        try:
            if own and SteadyArmEntry(**own).beside(usual) == arm:
                return own
        except InputError:
            pass
    return None


def _toml(record: _Record, place: str = "", inline: bool = False) -> str:
    """Single values first, then tables, then lists of tables.

    inline : whether tables are written in one line, in an entry of a list
    """
    lines, below = [], ""
    for name, value in record.items():
        path = f"{place}.{name}" if place else name
        if isinstance(value, dict) and not inline:
            below += f"\n[{path}]\n" + _toml(value, path)
        elif name in _BLOCKS and value and isinstance(value, list):
            below += "".join(f"\n[[{path}]]\n" + _toml(each, path, inline=True) for each in value)
        else:
            lines.append(_line(name, value, path))
    return "".join(lines) + below


def _line(name: str, value: Any, path: str) -> str:
    """``key = value # unit``."""
    several = isinstance(value, list) and any(isinstance(v, dict) for v in value)
    unit = unit_of(path) or (unit_of(f"{path}.position") if isinstance(value, list) else "")
    said = f" # {unit}" if unit else ""
    line = f"{name} = {toml_value(value)}{said}\n"
    if isinstance(value, list) and (several or len(line) > _WIDTH):
        return f"{name} = [{said}\n" + "".join(f"    {toml_value(v)},\n" for v in value) + "]\n"
    return line
