"""What all pictures have in common."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import Any, ParamSpec, TypeVar

from matplotlib import style
from matplotlib.axes import Axes
from matplotlib.figure import Figure

_Arguments = ParamSpec("_Arguments")
_Drawn = TypeVar("_Drawn")

CONTACT = "#c44e1c"  # contact wire
MESSENGER = "#1f5a85"  # messenger wire
STITCH = "#3a7d44"  # stitch wire
DROPPER = "#7a7a7a"
SUPPORT = "#444444"
SLACK = "#d62728"  # a dropper that has gone slack
PANTOGRAPHS = ("#1f5a85", "#c44e1c", "#3a7d44", "#7b4fa3")


_inside: ContextVar[bool] = ContextVar("inside our own style", default=False)


@contextmanager
def own_style(settings: Mapping[str, Any] | None = None) -> Iterator[None]:
    """Let matplotlib draw by its defaults, whatever the user's matplotlibrc asks for; after it, as before.

    settings : of matplotlib's that differ; inside another own style, they alone are changed
    """
    base: list[Any] = [] if _inside.get() else ["default", {"svg.hashsalt": "catenary_fe"}]
    token = _inside.set(True)
    try:
        with style.context([*base, dict(settings or {})]):
            yield
    finally:
        _inside.reset(token)


def styled(draw: Callable[_Arguments, _Drawn]) -> Callable[_Arguments, _Drawn]:
    """Draw in our own style; in texts a dollar sign is one."""

    @wraps(draw)
    def drawn(*args: _Arguments.args, **kwargs: _Arguments.kwargs) -> _Drawn:
        with own_style({"text.parse_math": False}):
            return draw(*args, **kwargs)

    return drawn


class Picture(Figure):
    """A figure that is drawn in our own style, also when the user saves it: matplotlib makes ticks late."""

    def draw(self, renderer: Any) -> None:
        with own_style():
            super().draw(renderer)

    def savefig(self, *args: Any, **kwargs: Any) -> None:
        with own_style():
            super().savefig(*args, **kwargs)


def new_axes(ax: Axes | None, size: tuple[float, float] = (10.0, 4.0)) -> Axes:
    """The given axes, or those of a new figure of this size in inches; the screen is never used."""
    if ax is not None:
        return ax
    figure = Picture(figsize=size, layout="constrained")
    axes: Axes = figure.subplots()
    return axes


def finish(ax: Axes, x: str, y: str, title: str) -> Axes:
    """Labels, title and a light grid."""
    ax.set_xlabel(x)
    ax.set_ylabel(y)
    ax.set_title(title, fontsize=10, loc="left")
    ax.grid(color="#dddddd", linewidth=0.6)
    ax.set_axisbelow(True)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    return ax


def note_failed(ax: Axes, failed: Iterable[str], whose: str = "") -> Axes:
    """Say under the title which checks the shown result fails, if any."""
    if names := ", ".join(dict.fromkeys(failed)):
        title = f"{ax.get_title(loc='left')}\nchecks failed{whose}: {names}"
        ax.set_title(title, fontsize=10, loc="left")
    return ax


def mark_supports(ax: Axes, positions: Iterable[float], label: bool = True) -> None:
    """Thin vertical lines at the supports."""
    for i, x in enumerate(positions):
        ax.axvline(
            x, color=SUPPORT, linewidth=0.7, linestyle=":", label="support" if label and i == 0 else None
        )


def headroom(ax: Axes, share: float) -> None:
    """Leave room for the legend above the curves, as a share of their height."""
    low, high = ax.get_ylim()
    ax.set_ylim(low, high + share * (high - low))
