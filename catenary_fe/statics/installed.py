"""A line as it is against its design, and the dropper lengths that explain measured heights."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

from catenary_fe.fe.mesh import MeshSettings
from catenary_fe.layout import Catenary
from catenary_fe.layout.arguments import checked
from catenary_fe.layout.measured import MeasuredWire, set_to_measured, with_design_heights_of
from catenary_fe.statics.forms import find_form
from catenary_fe.statics.line import LineShape
from catenary_fe.statics.shape import Shape


@dataclass(frozen=True, kw_only=True)
class InstalledRow:
    """One dropper of the design, and what has become of it.

    section : number of the tension section, from 1, on a line of several
    span, dropper : number of the span, and of the dropper in it, from 1
    chainage_m : from the first support of the line or section, as designed
    state : "missing", "broken", "clamp slid", or empty
    design_height_m, contact_wire_height_m : of the contact wire there, above the rail
    height_difference_mm : of the line as it is above its design
    design_force_N, force_N : tension of the dropper; 0 of one that is gone
    force_difference_N : of the line as it is above its design
    design_length_m, length_m : stress-free; None of a dropper that is gone
    """

    section: int | None = None
    span: int
    dropper: int
    chainage_m: float
    state: str
    design_height_m: float
    contact_wire_height_m: float
    height_difference_mm: float
    design_force_N: float  # noqa: N815 the unit's own letter
    force_N: float  # noqa: N815
    force_difference_N: float  # noqa: N815
    design_length_m: float
    length_m: float | None

    def as_dict(self) -> dict[str, Any]:
        """The row by column name; the section where there are several."""
        return {name: v for name, v in asdict(self).items() if not (name == "section" and v is None)}


def design_of(shape: Shape, catenary: Catenary | None = None) -> Shape:
    """The design of a line, with the dropper lengths that it takes, on the shape's mesh settings.

    catenary : whose design it is; unset: the shape's own line

    Raises InputError where the design is one that cannot be hung.
    """
    designed = (catenary or shape.catenary).as_designed().without_dropper_lengths()
    return find_form(designed, shape.mesh_settings)


@checked
def against_design(shape: Shape, design: Shape | None = None) -> list[InstalledRow]:
    """Heights and dropper forces of a line as it is beside those of its design, one row a dropper of the design.

    design : unset: found here

    Raises InputError where the design is one that cannot be hung.
    """
    design = design or design_of(shape)
    if isinstance(shape, LineShape) and isinstance(design, LineShape):
        pairs = enumerate(zip(shape.sections, design.sections, strict=True), start=1)
        return [row for n, (now, then) in pairs for row in _rows(now, then, n)]
    return _rows(shape, design, None)


def _rows(shape: Shape, design: Shape, section: int | None) -> list[InstalledRow]:
    line, then = shape.catenary, design.catenary
    hanging = iter(range(len(line.droppers)))
    droppers = [dropper for span in line.spans for dropper in span.droppers]
    rows = []
    for i, dropper in enumerate(droppers):
        now = next(hanging) if dropper.state is None else None
        x, wire = float(then.dropper_positions[i]), int(design.mesh.lower.wire[i])
        height, before = float(shape.wires[wire].height(x)), float(design.wires[wire].height(x))
        force = float(shape.dropper_forces[now]) if now is not None else 0.0
        rows.append(
            InstalledRow(
                section=section,
                span=int(then.dropper_spans[i]),
                dropper=int(then.dropper_numbers[i]),
                chainage_m=x,
                state=dropper.state or ("clamp slid" if dropper.clamp_shift else ""),
                design_height_m=before,
                contact_wire_height_m=height,
                height_difference_mm=1e3 * (height - before),
                design_force_N=float(design.dropper_forces[i]),
                force_N=force,
                force_difference_N=force - float(design.dropper_forces[i]),
                design_length_m=float(design.dropper_lengths[i]),
                length_m=float(shape.dropper_lengths[now]) if now is not None else None,
            )
        )
    return rows


@checked
def fit_measured(catenary: Catenary, measured: MeasuredWire, mesh: MeshSettings | None = None) -> Shape:
    """The line that has measured heights: dropper lengths with which the wire, as it is, lies where it was measured.

    Supports get the measured height (and stagger, where there is one), droppers the lengths that bring the wire
    to the measured height at them; the messenger wire's supports and the design heights at droppers stay. Its
    catenary has these lengths: a layout of the line as it is.

    Raises InputError where the measurement does not reach a support or a dropper, where no lengths give these
    heights, and for a layout that says itself what has changed.
    """
    goal = set_to_measured(catenary, measured)
    lengths = find_form(goal, mesh).dropper_lengths
    return find_form(with_design_heights_of(goal, catenary).with_dropper_lengths(lengths), mesh)
