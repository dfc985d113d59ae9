"""Docstrings and signatures of the Python interface as its reference page shows them."""

from __future__ import annotations

import inspect
import re
import sys
import types
from dataclasses import MISSING, fields, is_dataclass
from functools import cached_property
from typing import Annotated, Any, ForwardRef, Literal, TypeVar, Union, get_args, get_origin

from docutils import nodes
from key_tables import keys_of
from pydantic import BaseModel
from sphinx import addnodes
from sphinx.util.inspect import stringify_signature

_ENTRY = re.compile(r"^(?P<names>[A-Za-z_]\w*(?:, [A-Za-z_]\w*)*) : (?P<text>.*)$")
_ARRAY = re.compile(
    r"NDArray\[[^\[\]]*\]|ndarray\[tuple\[Any, \.\.\.\], dtype\[\w+\]\]|\b(?:Floats|FloatArray|Integers)\b"
)
_LITERAL = re.compile(r"Literal\[([^\]]*)\]")
_SHORT = 60  # characters of a type
_MODULE = re.compile(r"\b(?:np|xr|cf)\.(?=[A-Z])")


def list_parameters(app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Our docstrings write ``speed : [m/s] of the train``, one line or more each: make them a list."""
    written = [_escaped(line) for line in lines]
    if _is_model(obj):
        written += ["", *_fields(obj)]
    lines.clear()
    for line in written:
        entry = _ENTRY.match(line)
        if entry:
            if lines and lines[-1] and not lines[-1].startswith(("* ", "  ")):
                lines.append("")
            lines.append(f"* **{entry['names']}** – {entry['text']}")
        elif line.startswith("    ") and lines and lines[-1].startswith(("* ", "  ")):
            lines.append("  " + line.strip())
        else:
            lines.append(line)


def _escaped(line: str) -> str:
    """Bars are absolute values to us, and an underscore at a word's end is an index."""
    return re.sub(r"\||(?<=\w)_(?!\w)", r"\\\g<0>", line)


def _is_model(obj: Any) -> bool:
    return isinstance(obj, type) and issubclass(obj, BaseModel)


def _fields(model: type[BaseModel]) -> list[str]:
    """Each field on one line, whole: name, unit, meaning, allowed values."""
    plain = ("text", "number", "table", "true or false")
    lines = []
    for key in keys_of(model.model_json_schema()):
        unit = "" if key.unit == "–" else f"[{key.unit}] "
        allowed = "" if key.allowed in plain or key.allowed.startswith("list") else f" ({key.allowed})"
        text = re.sub(r"(?<!`)`([^`]+)`(?!`)", r"``\1``", key.meaning)
        lines.append(_escaped(f"{key.name} : {unit}{text}{allowed}"))
    return lines


def leave_out_fields(app: Any, what: str, name: str, obj: Any, skip: bool, options: Any) -> bool | None:
    """Fields stand in the list of their class; what is computed from them, and methods, below it."""
    computed = isinstance(obj, property | cached_property) or callable(obj)
    return True if what in ("class", "exception") and not computed else None


def readable_signature(
    app: Any, what: str, name: str, obj: Any, options: Any, arguments: str, result: str
) -> tuple[str, str] | None:
    """A signature in the words of the source: types without the rules that check them."""
    if _is_model(obj):
        return _model_signature(obj), ""
    if what not in ("class", "exception", "function", "method"):
        return None
    try:
        signature = inspect.signature(obj)
    except (TypeError, ValueError):
        return None
    made = {
        f.name: f.default_factory()
        for f in (fields(obj) if is_dataclass(obj) else ())
        if f.default_factory is not MISSING
    }
    names = vars(sys.modules[obj.__module__])
    parameters = [
        p.replace(annotation=_plain(p.annotation, names), default=made.get(p.name, p.default))
        for i, p in enumerate(signature.parameters.values())
        if not (i == 0 and p.name in ("self", "cls"))
    ]
    returned = "" if what in ("class", "exception") else _plain(signature.return_annotation, names)
    bare = signature.replace(parameters=parameters, return_annotation=inspect.Signature.empty)
    return stringify_signature(bare), returned if isinstance(returned, str) else ""


def _plain(annotation: Any, names: dict[str, Any]) -> Any:
    """An annotation as it is written, but for arrays, modules and the names of choices."""
    annotation = getattr(annotation, "__forward_arg__", annotation)
    if not isinstance(annotation, str):
        return annotation
    text = _MODULE.sub("", _ARRAY.sub("array", annotation))
    text = _LITERAL.sub(lambda found: found[1].replace("'", '"').replace(", ", " | "), text)
    return re.sub(r"(?<!\")\b[A-Z]\w+", lambda found: _choice(found[0], names.get(found[0])), text)


def _choice(name: str, value: Any) -> str:
    """What a name of several types or values stands for, where that is short."""
    text = _type(value) if get_origin(value) in (Literal, Union, types.UnionType) else name
    return text if len(text) <= _SHORT else name


def _model_signature(model: type[BaseModel]) -> str:
    fields = sorted(model.model_fields.items(), key=lambda item: not item[1].is_required())
    words = [
        f"{name}: {_type(f.annotation)}" + ("" if f.is_required() else f" = {_default(f)}")
        for name, f in fields
        if not f.exclude
    ]
    return f"(*, {', '.join(words)})"


def _default(field: Any) -> str:
    value = field.get_default(call_default_factory=True)
    return f"{type(value).__name__}()" if isinstance(value, BaseModel) else repr(value)


def _type(annotation: Any) -> str:
    """An annotation without the rules inside it: ``Annotated[float, Gt(0)] | None`` is ``float | None``."""
    kind, inner = get_origin(annotation), get_args(annotation)
    if kind is Annotated:
        return _type(inner[0])
    if kind in (Union, types.UnionType):
        return " | ".join(_type(each) for each in inner)
    if kind is Literal:
        return " | ".join(f'"{v}"' if isinstance(v, str) else str(v) for v in inner)
    if isinstance(annotation, str | list | ForwardRef | TypeVar):
        return str(annotation)
    if kind is not None:
        return f"{kind.__name__}[{', '.join('...' if each is ... else _type(each) for each in inner)}]"
    return "None" if annotation is type(None) else annotation.__name__


def plain_types(app: Any, domain: str, kind: str, content: addnodes.desc_content) -> None:
    """Types of properties, which autodoc writes itself, in plain words too."""
    for part in list(content.parent.findall(addnodes.desc_annotation)):
        for condition in list(part.findall(addnodes.pending_xref_condition)):
            if condition["condition"] == "resolved":
                condition.parent.remove(condition)
        text = part.astext()
        if "ndarray" in text:
            part.children = []
            part += nodes.Text(_plain(text, {}))
