"""Builds the documentation: ``sphinx-build -W docs out/docs``. Needs no network, nor do its pages."""

from __future__ import annotations

import sys
from importlib.metadata import version as installed
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).parent))

import drawings
import interface
import key_tables
from docutils import nodes
from latex2mathml.converter import convert

project = "catenary_fe"
copyright = "the authors of catenary_fe"
version = release = installed("catenary_fe")

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_click"]
myst_enable_extensions = ["dollarmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_title = f"catenary_fe {version}"
html_math_renderer = "mathml"
html_show_sphinx = False
html_copy_source = False

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_typehints_format = "short"
python_maximum_signature_line_length = 100
autodoc_default_options = {"members": True, "exclude-members": "model_config"}
python_use_unqualified_type_names = True
# names of other packages are not linked to pages on the network
nitpicky = False
suppress_warnings = ["ref.python"]  # several classes have a "name"


def visit_math(self: Any, node: nodes.math) -> None:
    """A formula inside a line, as MathML, which browsers draw without a script."""
    self.body.append(convert(node.astext()))
    raise nodes.SkipNode


def visit_math_block(self: Any, node: nodes.math_block) -> None:
    """A formula on a line of its own."""
    self.body.append(f'<div class="math">{convert(node.astext(), display="block")}</div>')
    raise nodes.SkipNode


def setup(app: Any) -> None:
    """Sphinx calls this."""
    drawings.draw_all(Path(__file__).parent / "pictures" / "drawn")
    app.add_html_math_renderer("mathml", (visit_math, None), (visit_math_block, None))
    app.add_directive("file-keys", key_tables.FileKeys)
    app.add_directive("key-figures", key_tables.KeyFigures)
    app.add_directive("library-names", key_tables.LibraryNames)
    app.connect("autodoc-process-docstring", interface.list_parameters)
    app.connect("autodoc-process-signature", interface.readable_signature)
    app.connect("autodoc-skip-member", interface.leave_out_fields)
    app.connect("object-description-transform", interface.plain_types)
