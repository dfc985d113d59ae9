"""What a report says first: the figures of every pantograph, which one governs, the verdict with its bars."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from catenary_fe.results import Criterion, ForceStatistics, Run, excess, governing, labels
from catenary_fe.results.criteria import criteria_table
from catenary_fe.results.quantities import FORCE, UPLIFT
from catenary_fe.results.signal import FilterKind
from catenary_fe.views.style import pantograph_colour

_LONGEST = 2.0  # times the limit: a longer bar would leave no room to compare the others


@dataclass(frozen=True)
class Value:
    """A figure of one pantograph, or of the line: ``who`` is empty where there is nothing to tell apart."""

    text: str
    who: str = ""
    colour: str = ""
    governs: bool = False


@dataclass(frozen=True)
class KeyFigure:
    """A figure to see at one glance, of each pantograph or of the line."""

    name: str
    values: Sequence[Value]


@dataclass(frozen=True)
class Bar:
    """A criterion with the share of its limit that is used.

    cells : label, value, limit, verdict, source
    share : in words; empty where there is no limit
    width, limit : [%] of the room for bars: of the bar, and where the limit stands
    """

    cells: Sequence[str]
    share: str
    width: float
    limit: float

    @property
    def verdict(self) -> str:
        """'passed', 'missed' or 'not judged'."""
        return self.cells[3]


def governing_figures(run: Run, filter: FilterKind, rows: Sequence[Criterion]) -> ForceStatistics | None:
    """Those of the pantograph that decides on the line; None where the evaluated spans were not passed."""
    figures = run.figures(filter)
    name = governing(figures, excess(rows)) if run.reached else None
    return next((s for s in figures if s and s.pantograph == name), None)


def why_it_governs(run: Run, s: ForceStatistics | None, rows: Sequence[Criterion]) -> str:
    """Which pantograph governs, and why, where there are several."""
    if s is None or run.data.sizes["pantograph"] == 1:
        return ""
    over = excess(rows)
    if s.pantograph in over:
        why = "which misses a criterion" if len(over) == 1 else "which misses a criterion by most"
    else:
        why = f"whose σ is the largest share of its mean force, {s.std / s.mean:.2f}"
    return f"The pantograph that governs is {s.pantograph}, {why}."


def key_figures(run: Run, filter: FilterKind, governs: ForceStatistics | None) -> list[KeyFigure]:
    """Figures of all pantographs, and the largest uplift."""
    figures = run.figures(filter)
    if not any(figures):
        return [KeyFigure("evaluated spans", [Value("not passed")])]
    names = [str(name) for name in run.data["pantograph"].values]
    several = len(names) > 1

    def of_each(text: Callable[[ForceStatistics], str]) -> list[Value]:
        return [
            Value(
                text(s) if s else "not passed",
                name if several else "",
                pantograph_colour(i),
                several and governs is not None and name == governs.pantograph,
            )
            for i, (name, s) in enumerate(zip(names, figures, strict=True))
        ]

    loss = FORCE["long_contact_loss"]
    found = [
        *(KeyFigure(FORCE[own].name, of_each(FORCE[own].text)) for own in ("mean", "std")),
        KeyFigure(
            "actual minimum, maximum", of_each(lambda s: f"{FORCE['min'].text(s)}, {FORCE['max'].text(s)}")
        ),
        KeyFigure(loss.name, of_each(loss.text)),
    ]
    if run.reached:
        uplift = UPLIFT.number(UPLIFT.shown(run.largest_support_uplift()))
        found.append(KeyFigure(UPLIFT.name, [Value(f"{uplift} {UPLIFT.unit}")]))
    return found


def criteria_bars(rows: Sequence[Criterion]) -> list[Bar]:
    """Each criterion with its bar, all to one scale; bars end at twice the limit."""
    shares = [row.used for row in rows]
    scale = max([1.0, *(min(share, _LONGEST) for share in shares if share is not None)])
    _, texts = criteria_table(rows)
    return [
        Bar(cells, _in_words(share), 100 * min(share or 0.0, _LONGEST) / scale, 100 / scale)
        for cells, share in zip(texts, shares, strict=True)
    ]


def closest(rows: Sequence[Criterion]) -> tuple[str, Bar | None]:
    """The missed criterion that is farthest beyond its limit, else the met one that is closest to it.

    A mean force that the run itself set to its limit is left out where it is met. In words, with its bar;
    nothing where none is judged.
    """
    judged = [
        (row.passed is False, row.used or 0.0, i)
        for i, row in enumerate(rows)
        if row.passed is False or (row.passed and not row.tolerance)
    ]
    if not judged:
        return "", None
    missed, _, i = max(judged, key=lambda found: found[:2])
    what = "Farthest beyond its limit" if missed else "Closest to its limit"
    return f"{what}: {labels(rows)[i]},", criteria_bars(rows)[i]


def _in_words(share: float | None) -> str:
    if share is None:
        return ""
    return f"over {100 * _LONGEST:.0f} %" if share > _LONGEST else f"{100 * share:.0f} %"
