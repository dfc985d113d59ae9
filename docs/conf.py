"""Builds the documentation: ``sphinx-build -W docs out/docs``. Needs no network, nor do its pages."""

from __future__ import annotations

import re
from importlib import import_module
from importlib.metadata import version as installed
from typing import Any, get_args

from docutils import nodes
from docutils.parsers.rst import Directive
from latex2mathml.converter import convert
from pydantic import BaseModel

project = "catenary_fe"
copyright = "the authors of catenary_fe"
version = release = installed("catenary_fe")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_click"]
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
html_theme = "furo"
html_title = f"catenary_fe {version}"
html_math_renderer = "mathml"
html_show_sphinx = False
html_copy_source = False

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
autodoc_default_options = {"members": True, "exclude-members": "model_config"}
python_use_unqualified_type_names = True
# names of other packages are not linked to pages on the network
nitpicky = False
suppress_warnings = ["ref.python"]  # several classes have a "name"

_ENTRY = re.compile(r"^(?P<names>[A-Za-z_]\w*(?:, [A-Za-z_]\w*)*) : (?P<text>.*)$")


def list_parameters(app: Any, what: str, name: str, obj: Any, options: Any, lines: list[str]) -> None:
    """Our docstrings write ``speed : [m/s] of the train``, one line or more each: make them a list."""
    # bars are absolute values to us, and an underscore at a word's end is an index
    written = [re.sub(r"\||(?<=\w)_(?!\w)", r"\\\g<0>", line) for line in lines]
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


def visit_math(self: Any, node: nodes.math) -> None:
    """A formula inside a line, as MathML, which browsers draw without a script."""
    self.body.append(convert(node.astext()))
    raise nodes.SkipNode


def visit_math_block(self: Any, node: nodes.math_block) -> None:
    """A formula on a line of its own."""
    self.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode


class FileKeys(Directive):
    """All keys of a file, from the models that check it: one table of keys for each table in the file."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Nodes in place of the directive."""
        module, _, name = self.arguments[0].rpartition(".")
        return list(self._tables(getattr(import_module(module), name), "", set()))

    def _tables(self, model: type[BaseModel], place: str, seen: set[type]) -> list[nodes.Node]:
        seen.add(model)
        shown, inner = nodes.definition_list(), []
        for key, field in model.model_fields.items():
            if field.exclude:
                continue
            models = _models_in(field.annotation)
            rule = "required" if field.is_required() else f"default {_default(field)}"
            term = nodes.term("", "", nodes.literal("", key), nodes.Text(f" ({rule})"))
            text = " ".join((field.description or "").split())
            shown += nodes.definition_list_item("", term, nodes.definition("", nodes.paragraph("", text)))
            for each in models:
                if each not in seen:
                    inner += self._tables(each, f"{place}.{key}".strip("."), seen)
        head = [nodes.rubric("", f"Keys of {place}")] if place else []
        return [*head, shown, *inner]


def _models_in(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [m for a in get_args(annotation) for m in _models_in(a)]


def _default(field: Any) -> str:
    value = field.get_default(call_default_factory=True)
    if isinstance(value, BaseModel):
        return "its own defaults"
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value) if value else "unset"


class LibraryNames(Directive):
    """What the library holds, with sources."""

    def run(self) -> list[nodes.Node]:
        """Nodes in place of the directive."""
        from catenary_fe.system import library

        found: list[nodes.Node] = []
        for kind, find in (
            ("wires", library.wire_record),
            ("pantographs", library.pantograph),
            ("lines", library.line),
        ):
            shown = nodes.definition_list()
            for name in library.names(kind):
                record = find(name)
                source = record["source"] if isinstance(record, dict) else record.source
                term = nodes.term("", "", nodes.literal("", name))
                shown += nodes.definition_list_item(
                    "", term, nodes.definition("", nodes.paragraph("", source))
                )
            found += [nodes.rubric("", kind.capitalize()), shown]
        return found


def setup(app: Any) -> None:
    """Sphinx calls this."""
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_math_block, None))
    app.add_directive("file-keys", FileKeys)
    app.add_directive("library-names", LibraryNames)
    app.connect("autodoc-process-docstring", list_parameters)
