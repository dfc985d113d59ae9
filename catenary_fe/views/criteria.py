"""Picture of a run's criteria: how much of each limit is used."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes

from catenary_fe.results import Criterion, labels
from catenary_fe.views.style import finish, new_axes, styled

_COLOURS = {"passed": "#3a7d44", "missed": "#b3261e", "not judged": "#9a9a9a"}


@styled
def plot_criteria(rows: Sequence[Criterion], *, title: str = "", ax: Axes | None = None) -> Axes:
    """One bar for each criterion: 100 % is the limit, a longer bar misses it.

    A limit of 0 and an unknown one have no bar: value, limit and verdict stand alone there.
    """
    ax = new_axes(ax, (11.0, 1.2 + 0.32 * len(rows)))
    shares = [limit_used(row) or 0.0 for row in rows]
    end = 100 * max([1.0, *shares])
    for i, (row, share) in enumerate(zip(rows, shares, strict=True)):
        ax.barh(i, 100 * share, height=0.62, color=_COLOURS[row.verdict])
        text = f"{row.value_text}, {row.limit_text}" if row.limit is not None else row.value_text
        marks = [row.verdict] + ["limit recalled"] * row.recalled
        colour = _COLOURS["missed"] if row.passed is False else "#222222"
        ax.text(end + 3, i, f"{text}: {', '.join(marks)}", va="center", fontsize=8, color=colour)
    ax.axvline(100, color="#333333", linewidth=1.0, linestyle="--")
    ax.set_yticks(range(len(rows)), labels(rows), fontsize=8)
    ax.invert_yaxis()
    ax.set_xlim(0, 1.6 * end)
    ax.set_xticks([x for x in ax.get_xticks() if x <= end])
    heading = f"{title}: criteria" if title else "criteria"
    finish(ax, "share of the limit that is used (%)", "", heading)
    ax.grid(visible=False, axis="y")
    return ax


def limit_used(row: Criterion) -> float | None:
    """Value over limit, or limit over value where the limit is a lower one; None where that says nothing."""
    if row.limit is None or row.limit <= 0 or row.value <= 0:
        return None
    return row.value / row.limit if row.relation == "at most" else row.limit / row.value
