"""The tables of a report: words and numbers in display units."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from catenary_fe.layout import AnyPantograph, Catenary, Equipment, Wire, counted, ends_in_words
from catenary_fe.layout.arguments import listed
from catenary_fe.layout.installed import changes_in_words
from catenary_fe.results import Run
from catenary_fe.results.export import cell, common_name
from catenary_fe.results.quantities import FORCE, decimals_of, figure_rows
from catenary_fe.results.signal import CUT_OFF, FilterKind
from catenary_fe.statics import LineShape, Shape


@dataclass(frozen=True)
class Table:
    """Rows of ready texts under named columns.

    spans : first and last span that each row is about: it is shown where one of these is; empty: always
    """

    caption: str
    columns: Sequence[str]
    rows: Sequence[Sequence[str]]
    spans: Sequence[tuple[int, int]] = ()
    numeric: Sequence[bool] = field(init=False)

    def __post_init__(self) -> None:
        columns = zip(*self.rows, strict=True) if self.rows else [()] * len(self.columns)
        object.__setattr__(self, "numeric", [all(map(_is_number, column)) for column in columns])


def _is_number(text: str) -> bool:
    return not text or (text[-1].isdigit() and text.lstrip("+-−").replace(".", "").isdigit())


def statistics_table(run: Run, filter: FilterKind) -> Table:
    """Statistics of all pantographs over the evaluated spans."""
    spans = listed(run.evaluated_spans)
    caption = f"Contact force in spans {spans}, {filter} low-pass at {CUT_OFF:g} Hz"
    names = [str(name) for name in run.data["pantograph"].values]
    columns = [s.as_dict() if s else {} for s in run.figures(filter)]
    return Table(caption, ("", *names), figure_rows(FORCE.values(), columns))


def span_table(run: Run, filter: FilterKind) -> Table:
    """Contact force span by span: how far single spans are from the evaluated ones together."""
    by_span = run.statistics_by_span(filter)
    names = [str(name) for name in run.data["pantograph"].values]
    shown = {own: FORCE[own] for own in ("mean", "std", "max", "min")}
    several = len(names) > 1
    columns = [
        f"{name}: {q.short_label}" if several else q.short_label for name in names for q in shown.values()
    ]
    cells = [
        (str(span), *(q.number(getattr(s, own)) for s in figures for own, q in shown.items()))
        for span, figures in by_span.items()
    ]
    return Table("Contact force span by span", ("span", *columns), cells, [(n, n) for n in by_span])


def uplift_table(run: Run) -> Table:
    """Largest uplift at each support that the train passed."""
    places = run.data["support_position"].values
    evaluated = run.uplift_by_support()
    lifts = {n: z for n, z in run.uplift_by_support(range(1, places.size)).items() if 1 < n < places.size}
    rows = [
        (str(n), f"{places[n - 1]:g}", f"{1e3 * lift:.1f}", "yes" if n in evaluated else "")
        for n, lift in lifts.items()
    ]
    columns = ("support", "at (m)", "largest uplift (mm)", "of an evaluated span")
    return Table("Largest uplift", columns, rows, [(n - 1, n) for n in lifts])


def slack_table(run: Run) -> Table:
    """Droppers that went slack, and for how long."""
    forces = run.data["dropper_force"].values
    slack = forces <= 0
    spans, places = run.data["dropper_span"].values, run.data["dropper_position"].values
    rows = [
        (str(spans[i]), f"{places[i]:g}", f"{1e3 * slack[i].sum() * run.step:.0f}", f"{forces[i].max():.0f}")
        for i in run.slackened_droppers
    ]
    caption = f"{len(rows)} of {places.size} droppers went slack"
    columns = ("span", "at (m)", "slack for (ms)", "largest force (N)")
    return Table(caption, columns, rows, [(int(spans[i]), int(spans[i])) for i in run.slackened_droppers])


def line_spans_table(catenary: Catenary) -> Table:
    """What each span is: length, contact wire heights and gradient, stagger, curve, droppers."""
    x, z, staggers = catenary.support_positions, catenary.drawn_heights, catenary.staggers
    rows = [
        (
            str(n),
            f"{x[n - 1]:g} to {x[n]:g}",
            f"{span.length:g}",
            f"{z[n - 1]:.3f} to {z[n]:.3f}",
            f"{1e3 * catenary.gradients[n - 1] + 0.0:.2f}",
            f"{staggers[n - 1]:g} to {staggers[n]:g}",
            _curve(span.curvatures),
            str(len(span.droppers)),
        )
        for n, span in enumerate(catenary.spans, start=1)
    ]
    columns = ("span", "at (m)", "length (m)", "contact wire at (m)", "gradient (‰)", "stagger (m)",
               "curve radius (m)", "droppers")  # fmt: skip
    return Table("Spans", columns, rows, [(n, n) for n in range(1, len(rows) + 1)])


def _curve(curvatures: tuple[float, float]) -> str:
    """Radius and side of a span's curve, of a transition its two ends'."""
    if not any(curvatures):
        return "straight"
    ends = dict.fromkeys(
        f"{1 / abs(c):g} {'left' if c > 0 else 'right'}" if c else "straight" for c in curvatures
    )
    return " to ".join(ends)


def schedule_table(shape: Shape) -> Table:
    """Dropper lengths; which wires they join, where there is a choice."""
    rows = [row.as_dict() for row in shape.dropper_schedule()]
    spans = shape.catenary.dropper_spans.tolist()
    columns = {
        **({"section": "section"} if isinstance(shape, LineShape) else {}),
        "span": "span", "dropper": "dropper", "chainage_m": "chainage (m)",
        "position_m": "in the span at (m)", "length_m": "length (m)", "installed_length_m": "installed (m)",
        "force_N": "force (N)", "contact_wire_height_error_mm": "height error (mm)",
    }  # fmt: skip
    wires = {"hangs_on": "hangs on", "contact_wire": "holds contact wire"}
    columns |= {key: name for key, name in wires.items() if len({row.get(key) for row in rows}) > 1}
    own = [(span, span) for span in spans]
    return Table("Dropper schedule", tuple(columns.values()), _cells(rows, columns), own)


def support_table(shape: Shape) -> Table:
    """Where the wires are at each support, and what it and its steady arm hold."""
    columns = {
        **({"section": "section"} if isinstance(shape, LineShape) else {}),
        "support": "support", "chainage_m": "chainage (m)", "stagger_m": "stagger (m)",
        "contact_wire_height_m": "contact wire at (m)", "system_height_m": "system height (m)",
        "arm_vertical_N": "arm, up (N)", "arm_lateral_N": "arm, left (N)",
        "messenger_vertical_N": "messenger wire, up (N)", "messenger_lateral_N": "messenger wire, left (N)",
        "messenger_wire_tension_kN": "its tension (kN)",
    }  # fmt: skip
    schedule = shape.support_schedule()
    cells = _cells([row.as_dict() for row in schedule], columns)
    at, count = shape.catenary.support_positions, len(shape.catenary.spans)
    before = [int(np.abs(at - row.chainage_m).argmin()) for row in schedule]  # supports, from 0
    spans = [(max(1, i), min(i + 1, count)) for i in before]
    return Table("Supports; of two contact wires the right one first", tuple(columns.values()), cells, spans)


def _cells(rows: Sequence[Mapping[str, Any]], keys: Iterable[str]) -> list[list[str]]:
    """Texts of some columns of a schedule, those of several contact wires together."""
    return [
        [
            ", ".join(
                str(cell(value, decimals_of(key)))
                for name, value in row.items()
                if common_name(name) == key and value is not None
            )
            or "–"
            for key in keys
        ]
        for row in rows
    ]


def input_tables(run: Run) -> list[Table]:
    """Everything that the run was computed from, with its sources."""
    catenary = run.catenary
    tables = [_line_table(catenary), _wire_table(catenary)]
    tables += [
        _pantograph_table(str(name), p)
        for name, p in zip(run.data["pantograph"].values, run.pantographs, strict=True)
    ]
    return [*tables, _settings_table(run)]


def _line_table(catenary: Catenary) -> Table:
    lengths = [span.length for span in catenary.spans]
    counts, damping = [len(span.droppers) for span in catenary.spans], catenary.damping
    stiffnesses = _range([dropper.stiffness / 1e3 for dropper in catenary.droppers])
    rows = [
        ("source", catenary.source or "not given"),
        ("spans", f"{len(lengths)} of {_range(lengths)} m, {catenary.length:g} m in all"),
        ("droppers", f"{_range(counts)} in a span, {stiffnesses} kN/m"),
        ("dropper lengths", "given by the layout" if catenary.gives_dropper_lengths else "of the design"),
        *([("changed since they were cut", changes)] if (changes := changes_in_words(catenary)) else []),
        ("contact wire height", f"{_range(catenary.contact_wire_heights)} m above the rail"),
        ("pre-sag", f"{_range([1e3 * span.pre_sag for span in catenary.spans])} mm"),
        ("system height", _system_height(catenary)),
        ("steady arms", _arms(catenary)),
        ("wires along the track", ends_in_words(catenary)),
        *((f"equipment {n}", _equipment(item)) for n, item in enumerate(catenary.equipment, start=1)),
        ("damping of wires and taut droppers", f"α = {damping.alpha:g} 1/s, β = {damping.beta:g} s"),
        ("modelled", "in space" if catenary.is_spatial else "in the vertical plane"),
        *_lateral_rows(catenary),
    ]
    return Table("Line", ("", "value"), rows)


def _system_height(catenary: Catenary) -> str:
    if catenary.messenger_wire is None:
        return "no messenger wire"
    return f"{_range(catenary.messenger_support_heights - catenary.contact_wire_heights)} m"


def _arms(catenary: Catenary) -> str:
    """Each kind of steady arm once."""
    kinds = dict.fromkeys(
        f"links of {arm.length:g} m, {arm.mass_per_length:g} kg/m, clamp {arm.clamp_mass:g} kg"
        if arm.length is not None
        else f"springs of {arm.stiffness:g} N/m, {arm.mass:g} kg"
        for support in catenary.supports[1:-1]
        if (arm := support.steady_arm)
    )
    return "; ".join(kinds) or "none"


def _equipment(item: Equipment) -> str:
    """A piece with its place, what it has, and its source."""
    parts = [item.place, f"{item.mass:g} kg"]
    parts += [f"{item.length:g} m long"] if item.length else []
    parts += [f"EI = {item.bending_stiffness:g} N m²"] if item.bending_stiffness else []
    return ", ".join([*parts, item.source or "source not given"])


def _lateral_rows(catenary: Catenary) -> list[tuple[str, str]]:
    """What leaves the vertical plane, where anything does."""
    rows = []
    if np.any(catenary.staggers):
        rows.append(("stagger", f"{_range(catenary.staggers)} m"))
    curved = [span for span in catenary.spans if any(span.curvatures)]
    if curved:
        radii = [1 / curvature for span in curved for curvature in span.curvatures if curvature]
        rows.append(("curve radius", f"{_range(radii)} m in {counted(len(curved), 'span')}"))
        transitions = sum(span.curvatures[0] != span.curvatures[1] for span in curved)
        if transitions:
            rows.append(("transition curves", counted(transitions, "span")))
    cants = [1e3 * support.cant for support in catenary.supports]
    if any(cants):
        rows.append(("cant", f"{_range(cants)} mm over {catenary.cant_base:g} m"))
    if catenary.contact_wire_spacing:
        rows.append(("contact wires", f"two, {catenary.contact_wire_spacing:g} m apart"))
    if catenary.stitch_wire:
        lengths = catenary.stitch_wire_lengths[list(catenary.stitched_supports)]
        rows.append(("stitch wires", f"{_range(lengths)} m long"))
    return rows


def _range(values: Any) -> str:
    """``60`` where all are equal, else ``48 to 60``."""
    values = np.round(np.asarray(values, dtype=float), 9)
    if not values.size:
        return "none"
    return f"{values[0]:g}" if np.ptp(values) == 0 else f"{values.min():g} to {values.max():g}"


def _wire_table(catenary: Catenary) -> Table:
    wires = {
        name.replace("_", " "): value
        for name in type(catenary).model_fields
        if isinstance(value := getattr(catenary, name), Wire)
    }
    quantities = (
        ("name", lambda w: w.name or "not given"),
        ("tension (kN)", lambda w: f"{w.tension / 1e3:g}"),
        ("mass (kg/m)", lambda w: f"{w.mass_per_length:g}"),
        ("EA (MN)", lambda w: f"{w.axial_stiffness / 1e6:g}"),
        ("EI (N m²)", lambda w: f"{w.bending_stiffness:g}"),
        ("wave speed (km/h)", lambda w: f"{3.6 * w.wave_speed:.0f}"),
        ("source", lambda w: w.source or "not given"),
    )
    rows = [(name, *map(text, wires.values())) for name, text in quantities]
    return Table("Wires", ("", *wires), rows)


def _pantograph_table(name: str, pantograph: AnyPantograph) -> Table:
    return Table(f"Pantograph {name}", ("", "value"), pantograph.in_words())


def _settings_table(run: Run) -> Table:
    settings, attrs = json.loads(run.data.attrs["settings"]), run.data.attrs
    starts = ", ".join(f"{x:g}" for x in run.data["position"].values[:, 0])
    uplifts = ", ".join(f"{f:.2f}" for f in run.data["uplift_force"].values)
    rows = [
        ("method", run.method),
        ("start at", f"{starts} m"),
        ("force on the lowest mass", f"{uplifts} N"),
        *(
            (f"{kind}: {key.replace('_', ' ')}", f"{value:g}" if isinstance(value, float) else str(value))
            for kind, values in settings.items()
            for key, value in values.items()
        ),
        ("versions", ", ".join(f"{k} {v}" for k, v in json.loads(attrs["versions"]).items())),
        ("SHA-256 of the inputs", str(attrs["input_sha256"])),
    ]
    return Table("Computation", ("", "value"), rows)
