"""Tables of a comparison with a line test: names of columns, and rows of ready texts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from catenary_fe.results.line_test.band import WITHIN
from catenary_fe.results.line_test.comparison import SHOWN, LineTestComparison
from catenary_fe.results.quantities import FORCE, UPLIFT, Quantity
from catenary_fe.results.statistics import ForceStatistics

TextTable = tuple[tuple[str, ...], list[tuple[str, ...]]]
_BY_KEY = {q.key: q for q in FORCE.values()}
_BY_SPAN = ("mean", "std", "max", "min")


def figures_table(c: LineTestComparison) -> TextTable:
    """Contact force of the run, of each pass and of all passes, with the differences to these."""
    measured = [p.statistics for p in c.passes if p.statistics]
    if c.statistics is None or c.measured is None:
        return (), []
    columns = [c.statistics, *measured, *([c.measured] if len(measured) > 1 else [])]
    names = ("", "run", *(s.pantograph for s in columns[1:]), "difference", "difference (%)")
    rows = [
        (
            FORCE[name].label,
            *(_number(FORCE[name], s) for s in columns),
            *_differences(FORCE[name], getattr(c.statistics, name), getattr(c.measured, name)),
        )
        for name in SHOWN
    ]
    return names, rows


def span_table(c: LineTestComparison) -> TextTable:
    """Contact force span by span: run, measurement."""
    names = ["span"]
    for name in _BY_SPAN:
        names += [f"{FORCE[name].short}, run (N)", "measured"]
    measured = c.measured_by_span
    rows = []
    for n, own in c.by_span.items():
        pairs = ((_number(FORCE[name], own), _number(FORCE[name], measured[n])) for name in _BY_SPAN)
        rows.append((str(n), *(text for pair in pairs for text in pair)))
    return tuple(names), rows


def support_table(c: LineTestComparison) -> TextTable:
    """Largest uplift at each support that was measured."""
    rows: list[tuple[str, ...]] = [
        (str(n), UPLIFT.number(UPLIFT.shown(run)), UPLIFT.number(UPLIFT.shown(measured)),
         *_differences(UPLIFT, run, measured))
        for n, (run, measured) in c.uplift.items()
    ]  # fmt: skip
    return ("support", "uplift, run (mm)", "measured (mm)", "difference (mm)", "difference (%)"), rows


def height_table(c: LineTestComparison) -> TextTable:
    """Range of the point of contact of the run and of each pass."""
    q = FORCE["contact_point_range"]
    if c.height_range is None:
        return (), []
    each = [p.height_range for p in c.passes if p.height_range is not None]
    names = ("", "run", *(p.name for p in c.passes if p.height_range is not None), "difference")
    assert c.measured_height_range is not None
    shown = (q.number(q.shown(value)) for value in (c.height_range, *each))
    return names, [(q.label, *shown, _differences(q, c.height_range, c.measured_height_range)[0])]


def pass_table(c: LineTestComparison) -> TextTable:
    """Where each pass was put, and how it was measured."""
    rows: list[tuple[str, ...]] = [
        (
            p.name,
            f"{p.place.shift:.2f}",
            "–" if p.place.correlation is None else f"{p.place.correlation:.3f}",
            f"{p.rate:.0f}",
            f"{3.6 * p.speed:.1f}",
        )
        for p in c.passes
    ]
    return ("pass", "shift (m)", "correlation", "samples a second", "speed (km/h)"), rows


def band_table(c: LineTestComparison) -> TextTable:
    """Figures of what was measured in the bands of a scatter study, and the share of places inside."""
    if c.band is None:
        return (), []
    passes = list(dict.fromkeys(name for row in c.band.figures for name in row["measured"]))
    rows = []
    for row in c.band.figures:
        q = UPLIFT if row["figure"] == UPLIFT.key else _BY_KEY[row["figure"]]
        ends = (q.number(row[side]) for side in ("low_5", "median", "high_95"))
        rows.append((q.label, *ends, *(_in_band(q, row, name) for name in passes)))
    if c.band.inside:
        shares = (f"{c.band.inside[n]:.0f} %" if n in c.band.inside else "" for n in passes)
        rows.append((f"places inside ({WITHIN} % on average)", "", "", "", *shares))
    return ("", "5 %", "median", "95 %", *passes), rows


def _in_band(quantity: Quantity, row: Mapping[str, Any], name: str) -> str:
    if name not in row["measured"]:
        return ""
    return f"{quantity.number(row['measured'][name])}, {'inside' if row['inside'][name] else 'outside'}"


def all_tables(c: LineTestComparison) -> Sequence[tuple[str, TextTable]]:
    """The tables that have rows, with what they show."""
    found = (
        (f"contact force, {c.filter} low-pass, {c.begin:.1f} to {c.end:.1f} m", figures_table(c)),
        ("height of the point of contact", height_table(c)),
        ("span by span", span_table(c)),
        ("largest uplift at supports", support_table(c)),
        ("in the bands of the scatter study", band_table(c)),
        ("passes", pass_table(c)),
    )
    return [(title, table) for title, table in found if table[1]]


def _number(quantity: Quantity, s: ForceStatistics) -> str:
    return quantity.number(quantity.shown(getattr(s, quantity.attribute)))


def _differences(quantity: Quantity, run: float, measured: float) -> tuple[str, str]:
    """Of the run to the measurement, in the quantity's unit and in % of what was measured."""
    difference = run - measured
    shown = f"{round(quantity.shown(difference), quantity.digits) + 0.0:+.{quantity.digits}f}"
    return shown, "–" if measured <= 0 else f"{round(100 * difference / measured, 1) + 0.0:+.1f}"
