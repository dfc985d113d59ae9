"""Templates, and pictures inside a page."""

from __future__ import annotations

import base64
import io
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING

from matplotlib.axes import Axes

from catenary_fe.views.style import own_style

if TYPE_CHECKING:
    from jinja2 import Environment, Template

ASSETS = ("uPlot.min.css", "report.css", "uPlot.iife.min.js", "report.js", "uPlot.LICENSE")


def svg_address(ax: Axes, dpi: int = 100) -> str:
    """A data address of the picture as SVG: sharp on paper, and the same bytes each time.

    dpi : of what is a bitmap inside it
    """
    figure, file = ax.get_figure(root=True), io.BytesIO()
    assert figure is not None
    with own_style({"path.simplify_threshold": 0.3}):
        figure.savefig(file, format="svg", dpi=dpi, metadata={"Date": None})
    return "data:image/svg+xml;base64," + base64.b64encode(file.getvalue()).decode("ascii")


def template(name: str) -> Template:
    """A template by its file's name; ``assets`` in it are style and scripts as they are."""
    return _environment().get_template(name)


@cache
def _environment() -> Environment:
    from jinja2 import Environment, PackageLoader, StrictUndefined
    from markupsafe import Markup

    folder = resources.files(__package__).joinpath("assets")
    environment = Environment(
        loader=PackageLoader(__package__, "assets"), autoescape=True, undefined=StrictUndefined
    )
    environment.globals["assets"] = {
        name: Markup(folder.joinpath(name).read_text(encoding="utf-8")) for name in ASSETS
    }
    return environment
