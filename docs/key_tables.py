"""Keys of files and of parameter objects, read from the JSON Schemas with which they are checked."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from docutils import nodes
from docutils.parsers.rst import Directive

from catenary_fe.layout.conditions import conditions_schema
from catenary_fe.layout.files import layout_schema, pantograph_schema
from catenary_fe.layout.parameters import LARGEST
from catenary_fe.layout.study import study_schema
from catenary_fe.results.quantities import FORCE, OF_RUN

SCHEMAS = {
    "layout": layout_schema,
    "pantograph": pantograph_schema,
    "conditions": conditions_schema,
    "study": study_schema,
}
EXAMPLES = Path(__file__).parent / "reference" / "examples"
_UNIT = re.compile(r"\[([^\]]+)\],?\s*")
_HEADS = "Key", "Unit", "Default", "Allowed", "Meaning", "Example"
_WIDTHS = 19, 6, 9, 11, 33, 22
_MANY = {"array": "lists", "integer": "whole numbers", "number": "numbers", "string": "texts"}
_LONGEST = 50  # characters of an example


@dataclass(frozen=True)
class Key:
    """A key as it is shown; ``tables`` are the definitions of the tables that it holds."""

    name: str
    unit: str
    default: str
    allowed: str
    meaning: str
    tables: tuple[str, ...] = ()


@dataclass
class Table:
    """A table of a file: the places where it may stand, and its keys.

    like : another table all of whose keys it has, too; they are not listed again
    """

    name: str
    meaning: str
    places: list[str] = field(default_factory=list)
    keys: list[Key] = field(default_factory=list)
    like: str | None = None


def keys_of(schema: dict[str, Any]) -> list[Key]:
    """Keys of an object's schema, without those that are only there to be refused."""
    needed = schema.get("required", [])
    kept = {n: part for n, part in schema.get("properties", {}).items() if not part.get("deprecated")}
    return [_key(name, part, name in needed) for name, part in kept.items()]


def _key(name: str, part: dict[str, Any], needed: bool) -> Key:
    text = " ".join(part.get("description", "").split())
    unit = _UNIT.match(text)
    return Key(
        name=name,
        unit=unit[1] if unit else "–",
        default="required" if needed else _default(part),
        allowed=" or ".join(dict.fromkeys(_allowed(part))),
        meaning=text[unit.end() :] if unit else text,
        tables=tuple(_references(part)),
    )


def _default(part: dict[str, Any]) -> str:
    if "default" not in part:
        return "of the library"
    value = part["default"]
    if isinstance(value, dict):
        return "as below"
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float):
        return f"{value:g}"
    return str(value) if value not in (None, "", []) else "unset"


def _allowed(part: dict[str, Any]) -> Iterator[str]:
    for each in part.get("anyOf", []):
        yield from _allowed(each)
    if "enum" in part or "const" in part:
        yield " or ".join(str(v) for v in part.get("enum", [part.get("const")]))
    elif part.get("type") in ("number", "integer"):
        yield _bounds(part, "whole number" if part["type"] == "integer" else "number")
    elif part.get("type") == "array":
        of = part.get("items") or next(iter(part.get("prefixItems", [])), {})
        yield f"list of {'tables' if _references(of) else _MANY.get(of.get('type'), 'values')}"
    elif "$ref" in part or part.get("type") == "object":
        yield "table"
    elif part.get("type") in ("string", "boolean"):
        yield {"string": "text", "boolean": "true or false"}[part["type"]]


def _bounds(part: dict[str, Any], kind: str) -> str:
    low, above = part.get("minimum", -LARGEST), part.get("exclusiveMinimum", -LARGEST)
    high, below = part.get("maximum", LARGEST), part.get("exclusiveMaximum", LARGEST)
    if low > -LARGEST and high < LARGEST:
        return f"{low:.5g} to {high:.5g}".replace("-", "−")
    bounds = [f"≥ {low:.4g}"] * (low > -LARGEST) + [f"> {above:.4g}"] * (above > -LARGEST)
    bounds += [f"≤ {high:.5g}"] * (high < LARGEST) + [f"< {below:.4g}"] * (below < LARGEST)
    whole = [kind] if kind == "whole number" or not bounds else []
    return ", ".join(whole + bounds).replace("-", "−")


def _references(part: dict[str, Any]) -> list[str]:
    items = [part[name] for name in ("items", "additionalProperties") if isinstance(part.get(name), dict)]
    inner = [*items, *part.get("anyOf", []), *part.get("oneOf", [])]
    own = [part["$ref"].rpartition("/")[2]] if "$ref" in part else []
    return [*own, *(name for each in inner for name in _references(each))]


def tables_of(schema: dict[str, Any]) -> list[Table]:
    """The tables of a file in the order in which they are met, each once, with all its places."""
    definitions = schema.get("$defs", {})
    branches = _references({k: v for k, v in schema.items() if k in ("anyOf", "oneOf")})
    tables: dict[str, Table] = {}
    for name in branches or [""]:
        _collect(definitions | {"": schema}, name, "", tables)
    found = list(tables.values())
    for i, table in enumerate(found):
        alike = [t for t in found[:i] if t.name and t.keys and _extends(table, t)]
        if alike:
            table.like = max(alike, key=lambda t: len(t.keys)).name
    return found


def _extends(table: Table, other: Table) -> bool:
    """Whether a table has all keys of another, most of them the same in all."""
    names = {key.name for key in table.keys}
    same = set(table.keys) & set(other.keys)
    return {key.name for key in other.keys} <= names and len(same) > len(other.keys) / 2


def _collect(definitions: dict[str, Any], name: str, place: str, tables: dict[str, Table]) -> None:
    known = name in tables
    schema = definitions[name]
    table = tables.setdefault(name, Table(name, schema.get("description", ""), keys=keys_of(schema)))
    table.places += [place] if place and place not in table.places else []
    for key in table.keys:
        part = schema["properties"][key.name]
        many = "array" in str(part.get("type"))
        for inner in key.tables:
            inside = f"[{key.name}] …" if _is_by_name(part) else _place(place, key.name, many)
            if not known or inside not in tables[inner].places:
                _collect(definitions, inner, inside, tables)


def _is_by_name(part: dict[str, Any]) -> bool:
    """Whether a key holds tables by names of the user's own."""
    return isinstance(part.get("additionalProperties"), dict)


def _place(place: str, key: str, many: bool) -> str:
    if not place:
        return f"[[{key}]]" if many else f"[{key}]"
    return f"{place} {key} = " + ("[{ … }]" if many else "{ … }")


def examples_of(kind: str) -> dict[tuple[str, str], str]:
    """An example for each key, by table and key, as the example files of this kind have it."""
    schema = SCHEMAS[kind]()
    definitions = schema.get("$defs", {}) | {"": schema}
    found: dict[tuple[str, str], str] = {}
    for path in sorted(EXAMPLES.glob(f"{kind}*.toml")):
        _note(definitions, "", tomllib.loads(path.read_text(encoding="utf-8")), found)
    return found


def _note(definitions: dict[str, Any], name: str, value: Any, found: dict[tuple[str, str], str]) -> None:
    for each in value if isinstance(value, list) else [value]:
        if not isinstance(each, dict):
            continue
        schema = definitions[name]
        for branch in _references({k: v for k, v in schema.items() if k in ("anyOf", "oneOf")}):
            if set(each) <= set(definitions[branch].get("properties", {})):
                _note(definitions, branch, each, found)
        for key, inner in each.items():
            part = schema.get("properties", {}).get(key)
            if part is None:
                continue
            text = _toml(inner)
            if len(text) <= _LONGEST:
                found.setdefault((name, key), f"{key} = {text}")
            for below in _references(part):
                _note(definitions, below, list(inner.values()) if _is_by_name(part) else inner, found)


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {_toml(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(_toml(v) for v in value) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else f"{value:g}" if abs(value) < 1e3 else f"{value:.6g}"


def example_of(table: Table, key: Key, tables: list[Table], examples: dict[tuple[str, str], str]) -> str:
    """An example of a key: where its table is, its own, or that of the same key in another table."""
    inner = next((t for t in tables if t.name in key.tables), None)
    if inner and not table.places:
        return inner.places[0] if len(inner.places) == 1 else f"[{key.name}]"
    if own := examples.get((table.name, key.name)):
        return own
    for other in tables:
        if key in other.keys and (found := examples.get((other.name, key.name))):
            return found
    return f"[{key.name}]" if inner else ""


class FileKeys(Directive):
    """All keys of a kind of file: one section with a table of keys for each table of the file."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Nodes in place of the directive."""
        kind = self.arguments[0]
        tables = tables_of(SCHEMAS[kind]())
        tops = [t for t in tables if not t.places]
        titles = {t.name: ", ".join(t.places) or _top(t, len(tops)) for t in tables}
        examples = examples_of(kind)
        return [self._section(kind, table, tables, titles, examples) for table in tables]

    def _section(
        self,
        kind: str,
        table: Table,
        tables: list[Table],
        titles: dict[str, str],
        examples: dict[tuple[str, str], str],
    ) -> nodes.section:
        section = nodes.section(ids=[_identifier(kind, table.name)], names=[])
        section += nodes.title(
            "", "", *_written(f"``{titles[table.name]}``" if table.places else titles[table.name])
        )
        section += [nodes.paragraph("", "", *_written(p)) for p in table.meaning.split("\n\n") if p]
        keys = table.keys
        if table.like:
            like = next(t for t in tables if t.name == table.like)
            keys = [key for key in keys if key not in like.keys]
            link = nodes.reference("", titles[like.name], refid=_identifier(kind, like.name), internal=True)
            rest = ". New or different:" if keys else "."
            section += nodes.paragraph("", "", nodes.Text("The keys of "), link, nodes.Text(rest))
        rows = [self._row(kind, table, key, tables, examples) for key in keys]
        section += [_table(rows)] if rows else []
        return section

    def _row(
        self, kind: str, table: Table, key: Key, tables: list[Table], examples: dict[tuple[str, str], str]
    ) -> list[list[nodes.Node]]:
        links: list[nodes.Node] = []
        for name in key.tables:
            links += [nodes.Text(", " if links else ""), nodes.reference(
                "", key.allowed, refid=_identifier(kind, name), internal=True
            )]  # fmt: skip
        example = example_of(table, key, tables, examples)
        return [
            [nodes.literal("", key.name)],
            [nodes.Text(key.unit)],
            [nodes.Text(key.default)],
            links or [nodes.Text(key.allowed)],
            _written(key.meaning),
            [nodes.literal("", example)],
        ]


def _top(table: Table, tops: int) -> str:
    """The heading of what stands outside any table; with its name where a kind of file has several forms."""
    words = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", table.name).capitalize()
    return f"{words}: at the top" if tops > 1 else "At the top"


def _identifier(kind: str, name: str) -> str:
    return nodes.make_id(f"{kind} {name or 'top'}")


def _written(text: str) -> list[nodes.Node]:
    """Text whose names in backticks are literals."""
    parts = re.split(r"`{1,2}([^`]+)`{1,2}", " ".join(text.split()))
    return [nodes.literal("", p) if i % 2 else nodes.Text(p) for i, p in enumerate(parts) if p]


def _table(
    rows: list[list[list[nodes.Node]]], heads: Sequence[str] = _HEADS, widths: Sequence[int] = _WIDTHS
) -> nodes.table:
    group = nodes.tgroup("", *(nodes.colspec(colwidth=w) for w in widths), cols=len(widths))
    head = nodes.row("", *(nodes.entry("", nodes.paragraph("", each)) for each in heads))
    body = [nodes.row("", *(nodes.entry("", nodes.paragraph("", "", *cell)) for cell in row)) for row in rows]
    group += [nodes.thead("", head), nodes.tbody("", *body)]
    return nodes.table("", group, classes=["keys", "colwidths-given"])


def figures_table() -> nodes.table:
    """The figures that a run is described with: their keys in files, what they are called, their units."""
    rows = [
        [[nodes.literal("", q.key)], *([nodes.Text(text or "–")] for text in texts)]
        for q in (*FORCE.values(), *OF_RUN)
        for texts in [(q.name, q.symbol, f"{q.unit} {q.share_of}".rstrip(), str(q.digits))]
    ]
    return _table(rows, ("Key", "Figure", "Symbol", "Unit", "Decimals in tables"), (34, 30, 10, 14, 12))


class KeyFigures(Directive):
    """The table of figures."""

    def run(self) -> list[nodes.Node]:
        """Nodes in place of the directive."""
        return [figures_table()]


class LibraryNames(Directive):
    """What the library holds, with sources."""

    def run(self) -> list[nodes.Node]:
        """Nodes in place of the directive."""
        from catenary_fe.layout import library

        finders = {"wires": library.wire_record, "pantographs": library.pantograph, "lines": library.line}
        found: list[nodes.Node] = []
        for kind, find in finders.items():
            shown = nodes.definition_list()
            for name in library.names(kind):
                record: Any = find(name)
                source = record["source"] if isinstance(record, dict) else record.source
                term = nodes.term("", "", nodes.literal("", name))
                shown += nodes.definition_list_item(
                    "", term, nodes.definition("", nodes.paragraph("", source))
                )
            found += [nodes.rubric("", kind.capitalize()), shown]
        return found
