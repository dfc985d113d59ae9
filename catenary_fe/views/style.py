"""What all pictures have in common."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from functools import wraps
from typing import Any, Literal, ParamSpec, TypeVar

import numpy as np
from matplotlib import colormaps, style
from matplotlib.axes import Axes
from matplotlib.colors import to_hex
from matplotlib.figure import Figure
from numpy.typing import ArrayLike

from catenary_fe.layout.arguments import runs
from catenary_fe.results import Run

_Arguments = ParamSpec("_Arguments")
_Drawn = TypeVar("_Drawn")

CONTACT = "#c44e1c"  # contact wire
MESSENGER = "#1f5a85"  # messenger wire
STITCH = "#3a7d44"  # stitch wire
WIRES = {"contact wire": CONTACT, "messenger wire": MESSENGER, "stitch wire": STITCH}
DROPPER = "#8d959c"
SUPPORT = "#111111"
SLACK = "#d62728"  # a dropper that has gone slack
EVALUATED = "#f3efe2"  # behind the evaluated spans
OTHERS = "#c9c9c9"  # what is not evaluated
ALONG = "position along the line (m)"
PANTOGRAPHS = ("#7a2fb0", "#00a6a6", "#b07900", "#b0306a")  # unlike wires: both are in one picture
_MANY = (*PANTOGRAPHS, "#1f5a85", "#c44e1c", "#3a7d44", "#5a5a5a")


def wire_colour(name: str) -> str:
    """Colour of a wire by its name, such as "left contact wire"."""
    return next((colour for kind, colour in WIRES.items() if kind in name), MESSENGER)


def pantograph_colour(number: int) -> str:
    """Colour of a pantograph, numbered from 0."""
    return PANTOGRAPHS[number % len(PANTOGRAPHS)]


def sequence(count: int) -> list[str]:
    """Distinct colours in order, dark to bright."""
    return [to_hex(colormaps["viridis"](0.9 * i / max(1, count - 1))) for i in range(count)]


def distinct(count: int) -> list[str]:
    """Distinct colours to tell curves apart."""
    return list(_MANY[:count]) if count <= len(_MANY) else sequence(count)


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
    """Draw in our own style, with dollar signs in texts taken literally."""

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


def new_panels(size: tuple[float, float], heights: Sequence[float]) -> list[Axes]:
    """Axes below one another in a new figure.

    size : [in] of the figure
    heights : of the axes, relative to each other
    """
    figure = Picture(figsize=size, layout="constrained")
    return list(figure.subplots(len(heights), 1, height_ratios=list(heights), squeeze=False)[:, 0])


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


def legend(ax: Axes, columns: int = 4, where: Literal["upper left", "upper right"] = "upper left") -> None:
    """Names of the curves on a light ground."""
    ax.legend(loc=where, fontsize=8, ncols=columns, framealpha=0.9)


def finish_run(ax: Axes, run: Run, x: str, y: str, what: str) -> Axes:
    """As :func:`finish`, of a run: the title says which one and what is shown, and which checks it fails."""
    return note_failed(finish(ax, x, y, run_title(run, what)), run.failed_checks)


def run_title(run: Run, what: str) -> str:
    """The run's title and speed, and what is shown of it."""
    return f"{run.data.attrs['title']}, {3.6 * run.speed:.0f} km/h{what}"


def note_failed(ax: Axes, failed: Iterable[str], whose: str = "") -> Axes:
    """Name under the title the checks that the result fails, if any."""
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


def mark_spans(
    ax: Axes, supports: ArrayLike, spans: Iterable[int], label: str | None = "evaluated spans"
) -> None:
    """A band behind some spans (numbers from 1); neighbours share one."""
    places = np.asarray(supports, dtype=float)
    for first, last in runs(spans):
        ax.axvspan(places[first - 1], places[last], color=EVALUATED, linewidth=0, zorder=0, label=label)
        label = None


def rotation_that_fits(ax: Axes, x: ArrayLike, texts: Sequence[str], size: float) -> int | None:
    """Degrees by which texts, centred at ``x``, stay clear of each other: 0, or 90, or None where none does.

    The axes need their limits.
    """
    gaps = np.diff(np.asarray(x, dtype=float))
    if not gaps.size:
        return 0
    figure = ax.get_figure(root=True)
    assert figure is not None
    low, high = ax.get_xlim()
    grows = 1.1 if figure.get_layout_engine() else 1.0  # when the figure is laid out, at the least
    room = grows * gaps / (high - low) * ax.get_window_extent().width / figure.dpi * 72  # [pt]
    widths = np.array([0.65 * size * len(text) + 0.5 * size for text in texts])
    if (room > (widths[:-1] + widths[1:]) / 2).all():
        return 0
    return 90 if (room > 1.3 * size).all() else None


def annotate(
    ax: Axes, text: str, place: tuple[float, float], offset: tuple[float, float], **options: Any
) -> None:
    """Write a text beside a point, so many points [pt] to the right and up."""
    ax.annotate(text, place, offset, textcoords="offset points", **{"fontsize": 8, **options})


def label_row(
    ax: Axes, x: ArrayLike, y: ArrayLike, texts: Sequence[str], *, size: float = 7, above: float = 0
) -> bool:
    """Write texts at points, upright where they would touch; returns whether there was room for them.

    above : [pt] over the points; 0: centred on them
    """
    rotation = rotation_that_fits(ax, x, texts, size)
    if rotation is None:
        return False
    places = np.broadcast_to(np.asarray(y, dtype=float), np.shape(x))
    options = {"ha": "center", "va": "bottom" if above else "center", "rotation": rotation, "fontsize": size}
    for place, height, text in zip(np.asarray(x, dtype=float), places, texts, strict=True):
        annotate(ax, text, (place, height), (0, above), **options)
    return True


def number_row(ax: Axes, x: ArrayLike, y: float, numbers: Sequence[int], *, size: float = 8) -> None:
    """Write numbers in a row just above ``y``: all, or of many the first and every second, fifth, tenth ...

    The axes need their limits.
    """
    places, every = np.asarray(x, dtype=float), (1, 2, 5, 10, 20, 50, 100, 200, 500)
    for step in every:
        shown = [i for i, n in enumerate(numbers) if n % step == 0]
        if numbers[0] % step and (not shown or shown[0] > 0.6 * step):
            shown = [0, *shown]
        texts = [str(numbers[i]) for i in shown]
        if rotation_that_fits(ax, places[shown], texts, size) == 0:
            label_row(ax, places[shown], y, texts, size=size, above=1)
            return


def label_beside(
    ax: Axes, places: ArrayLike, texts: Sequence[str], *, size: float = 8, upright: bool = False
) -> list[int]:
    """Write each text to the right of its point or, where another one or the edge is in the way, to the left.

    places : shape (texts, 2), in the axes' coordinates, which need their limits

    Returns the numbers of the texts that found room; the others are left out.
    """
    figure = ax.get_figure(root=True)
    assert figure is not None
    points = ax.transData.transform(np.asarray(places, dtype=float).reshape(-1, 2)) / figure.dpi * 72
    edge = ax.get_window_extent().x1 / figure.dpi * 72
    taken: list[tuple[float, float, float, float]] = []  # middle, width, height [pt]
    written = []
    for i, (x, y) in enumerate(points):
        length, width = 0.65 * size * len(texts[i]) + 0.4 * size, 1.4 * size
        w, h = (width, length) if upright else (length, width)
        for side in (1, -1):
            middle = x + side * (5 + w / 2)
            if middle + w / 2 > edge or any(
                abs(middle - a) < (w + b) / 2 and abs(y - c) < (h + d) / 2 for a, c, b, d in taken
            ):
                continue
            taken.append((middle, y, w, h))
            written.append(i)
            options = {"ha": "left" if side > 0 else "right", "va": "center", "fontsize": size}
            place = np.asarray(places, dtype=float).reshape(-1, 2)[i]
            annotate(ax, texts[i], tuple(place), (5 * side, 0), rotation=90 if upright else 0, **options)
            break
    return written
