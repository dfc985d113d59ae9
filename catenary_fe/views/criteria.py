"""Picture of a run's criteria: how much of each limit is used."""

from __future__ import annotations

from collections.abc import Sequence

from matplotlib.axes import Axes

from catenary_fe.results import Criterion, labels
from catenary_fe.views.style import finish, new_axes, styled

_COLOURS = {"passed": "#3a7d44", "missed": "#b3261e", "not judged": "#9a9a9a"}
_LONGEST = 2.0  # times the limit: a longer bar would leave no room to compare the others


@styled
def plot_criteria(rows: Sequence[Criterion], *, title: str = "", ax: Axes | None = None) -> Axes:
    """One bar for each criterion: 100 % is the limit, a longer bar misses it.

    A lower limit of a figure that is a mean less its scatter is used by the scatter. Where the share has no
    end, or goes beyond twice the limit, the bar is hatched and ends there. A criterion without a known
    limit has an empty bar.
    """
    ax = new_axes(ax, (11.0, 1.2 + 0.32 * len(rows)))
    shares = [row.used for row in rows]
    end = 100 * max([1.0, *(min(share, _LONGEST) for share in shares if share is not None)])
    for i, (row, share) in enumerate(zip(rows, shares, strict=True)):
        colour = _COLOURS[row.verdict]
        if share is None:
            ax.barh(i, 100, height=0.62, facecolor="none", edgecolor=colour, linestyle=":", linewidth=1.0)
        else:
            hatch = "//" if share > _LONGEST else None
            width = 100 * min(share, _LONGEST)
            ax.barh(i, width, height=0.62, color=colour, hatch=hatch, edgecolor="white" if hatch else colour)
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
