"""The tables that a crew takes along: one row a dropper, one row a support."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.installation import element_pulls

if TYPE_CHECKING:
    from catenary_fe.statics.shape import Shape

Floats = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class DropperRow:
    """One line of the dropper schedule.

    section : number of the tension section, from 1, of a line that has several; spans, supports count in it
    span : number of the span, from 1
    from_support, to_support : numbers of the supports at its ends, from 1
    dropper : number of the dropper in its span, from 1
    chainage_m : from the line's first support
    position_m : from the span's first support
    cut_length_mm : ``length_m``, rounded to what can be cut
    length_m : stress-free, from clamp to clamp: what to cut
    installed_length_m : under its load
    force_N : tension
    contact_wire_height_m : of the contact wire at this dropper, above the rail
    contact_wire_height_error_mm : of the same above its design height
    hangs_on : "messenger wire" or "stitch wire", on a line that has both
    contact_wire : number of the contact wire that it holds, of two: 1 is the right one
    """

    span: int
    from_support: int
    to_support: int
    dropper: int
    chainage_m: float
    position_m: float
    cut_length_mm: int
    length_m: float
    installed_length_m: float
    force_N: float  # noqa: N815 the unit's own letter
    contact_wire_height_m: float
    contact_wire_height_error_mm: float
    hangs_on: str | None = None
    contact_wire: int | None = None
    section: int | None = None

    def as_dict(self) -> dict[str, Any]:
        """The row by column name; what the line leaves no choice in is left out."""
        return {name: getattr(self, name) for name in self.columns() if getattr(self, name) is not None}

    def as_record(self) -> dict[str, Any]:
        """All columns, the same ones on every line."""
        return {name: getattr(self, name) for name in self.columns()} | {
            "section": self.section or 1,
            "hangs_on": self.hangs_on or "messenger wire",
            "contact_wire": self.contact_wire or 1,
        }

    @classmethod
    def columns(cls) -> list[str]:
        """Names of all columns."""
        return ["section", *(field.name for field in fields(cls) if field.name != "section")]


@dataclass(frozen=True, kw_only=True)
class ArmRow:
    """One contact wire's registration at a support; what does not apply is None.

    stagger_m : of this contact wire, to the left of the track's centre
    contact_wire_height_m : above the rail
    kind : "link", "spring", or "none" where the wire is free or anchored
    side : side of the wire that a link's pivot is on, "left" or "right" looking along the line
    length_m : of a link
    inclination_deg : by which a link rises from the wire to its pivot
    stiffness_N_per_m : vertical, of a spring
    vertical_N, lateral_N : of the arm on the wire, up and to the left, before the weight of clamp and arm
    radial_N : along a link: pull
    """

    stagger_m: float
    contact_wire_height_m: float
    kind: str
    side: str | None = None
    length_m: float | None = None
    inclination_deg: float | None = None
    stiffness_N_per_m: float | None = None  # noqa: N815
    vertical_N: float | None = None  # noqa: N815
    lateral_N: float | None = None  # noqa: N815
    radial_N: float | None = None  # noqa: N815


@dataclass(frozen=True, kw_only=True)
class SupportRow:
    """One line of the support schedule; what does not apply is None.

    section : number of the tension section, from 1, of a line that has several; supports count in it
    support : number, from 1
    chainage_m : from the line's first support
    span_before_m, span_after_m : lengths of the spans on either side
    curve_radius_before_m, curve_radius_after_m : of the track there, positive to the left
    arms : of each contact wire, the right one first
    messenger_wire_height_m : above the rail
    system_height_m : of the messenger wire above the (right) contact wire
    messenger_stagger_m : of the messenger wire, to the left of the track's centre
    messenger_vertical_N, messenger_lateral_N : of the support on the messenger wire, up and to the left
    contact_wire_tension_kN : of each contact wire
    messenger_wire_tension_kN : here; between a stitch wire's clamps the two share the messenger wire's
    stitch_wire_tension_kN, stitch_wire_length_m : of the stitch wire that hangs here
    """

    support: int
    chainage_m: float
    span_before_m: float | None
    span_after_m: float | None
    curve_radius_before_m: float | None
    curve_radius_after_m: float | None
    arms: tuple[ArmRow, ...]
    messenger_wire_height_m: float | None
    system_height_m: float | None
    messenger_stagger_m: float | None
    messenger_vertical_N: float | None  # noqa: N815
    messenger_lateral_N: float | None  # noqa: N815
    contact_wire_tension_kN: float  # noqa: N815
    messenger_wire_tension_kN: float | None  # noqa: N815
    stitch_wire_tension_kN: float | None = None  # noqa: N815
    stitch_wire_length_m: float | None = None
    section: int | None = None

    def as_record(self) -> dict[str, Any]:
        """As :meth:`as_dict`, with the number of the section on every line."""
        return {"section": self.section or 1} | self.as_dict()

    def as_dict(self) -> dict[str, Any]:
        """The row by column name, arms flattened: ``arm_radial_N``, or of two wires ``arm_1_radial_N``."""
        found: dict[str, Any] = {"section": self.section} if self.section else {}
        for name, value in asdict(replace(self, section=None)).items():
            if name == "section":
                continue
            if name != "arms":
                found[name] = value
                continue
            for number, arm in enumerate(value, start=1):
                suffix = f"_{number}" if len(value) > 1 else ""
                for key, each in arm.items():
                    of_wire = key in ("stagger_m", "contact_wire_height_m")
                    column = f"{key.removesuffix('_m')}{suffix}_m" if of_wire else f"arm{suffix}_{key}"
                    found[column] = each
        return found


def dropper_rows(shape: Shape) -> list[DropperRow]:
    """One row a dropper, in order."""
    catenary, mesh = shape.catenary, shape.mesh
    return [
        DropperRow(
            span=(span := int(catenary.dropper_spans[i])),
            from_support=span,
            to_support=span + 1,
            dropper=int(catenary.dropper_numbers[i]),
            chainage_m=float(catenary.dropper_positions[i]),
            position_m=dropper.position,
            cut_length_mm=round(1e3 * float(shape.dropper_lengths[i])),
            length_m=float(shape.dropper_lengths[i]),
            installed_length_m=float(shape.installed_lengths[i]),
            force_N=float(shape.dropper_forces[i]),
            contact_wire_height_m=float(shape.height_errors[i] + catenary.design_heights[i]),
            contact_wire_height_error_mm=1e3 * float(shape.height_errors[i]),
            hangs_on=mesh.wire_name(int(mesh.upper.wire[i])) if shape.stitch_wires else None,
            contact_wire=int(mesh.lower.wire[i]) + 1 if mesh.contact_wires > 1 else None,
        )
        for i, dropper in enumerate(catenary.droppers)
    ]


def support_rows(shape: Shape) -> list[SupportRow]:
    """One row a support, in order."""
    pulls = element_pulls(shape.catenary, shape.mesh)
    own = pulls[shape.mesh.contact_wires] if shape.mesh.messenger else None
    return [_support_row(shape, i, own) for i in range(len(shape.catenary.supports))]


def _support_row(shape: Shape, i: int, pulls: Floats | None) -> SupportRow:
    """pulls : [N], shape (elements,), of the messenger wire along the track, if there is one"""
    catenary = shape.catenary
    before, after = ([None, *catenary.spans, None][i + side] for side in (0, 1))
    arms = tuple(_arm_row(shape, wire, i) for wire in range(shape.mesh.contact_wires))
    stitch = catenary.stitch_wire if catenary.has_stitch_wire(i) else None
    return SupportRow(
        support=i + 1,
        chainage_m=float(catenary.support_positions[i]),
        span_before_m=before.length if before else None,
        span_after_m=after.length if after else None,
        curve_radius_before_m=before.radius_at(end=True) if before else None,
        curve_radius_after_m=after.radius_at(end=False) if after else None,
        arms=arms,
        contact_wire_tension_kN=catenary.contact_wire.tension / 1e3,
        **_of_messenger(shape, i, arms[0].contact_wire_height_m, pulls),
        stitch_wire_tension_kN=stitch.tension / 1e3 if stitch else None,
        stitch_wire_length_m=float(catenary.stitch_wire_lengths[i]) if stitch else None,
    )


def _of_messenger(shape: Shape, support: int, contact_height: float, pulls: Floats | None) -> dict[str, Any]:
    """What a row says of the messenger wire, by column; None each without one."""
    if pulls is None or shape.mesh.messenger is None:
        columns = ("wire_height_m", "stagger_m", "vertical_N", "lateral_N", "wire_tension_kN")
        return {"system_height_m": None} | {f"messenger_{name}": None for name in columns}
    node = int(shape.mesh.messenger.supports[support])
    height, force = float(shape.messenger_wire.z[node]), shape.installation.support_forces[support]
    return {
        "messenger_wire_height_m": height,
        "system_height_m": height - contact_height,
        "messenger_stagger_m": float(shape.messenger_wire.y[node]),
        "messenger_vertical_N": float(force[-1]),
        "messenger_lateral_N": float(force[0]) if force.size > 1 else 0.0,
        "messenger_wire_tension_kN": float(pulls[min(node, pulls.size - 1)]) / 1e3,
    }


def _arm_row(shape: Shape, wire: int, support: int) -> ArmRow:
    """The registration of one contact wire, with its forces where the wire hangs at rest."""
    catenary, hanging = shape.catenary, shape.wires[wire]
    node = shape.mesh.wires[wire].supports[support]
    stagger, height = float(hanging.y[node]), float(hanging.z[node])
    arm = catenary.supports[support].steady_arm
    row = ArmRow(stagger_m=stagger, contact_wire_height_m=height, kind="none")
    if arm is None or support in (0, len(catenary.spans)):
        return row
    force = shape.installation.arm_forces[wire, support]
    lateral, up = float(force[0]) if force.size > 1 else 0.0, float(force[-1])
    row = replace(row, vertical_N=up, lateral_N=lateral)
    if arm.length is None:
        return replace(row, kind="spring", stiffness_N_per_m=arm.stiffness)
    return replace(
        row,
        kind="link",
        side="left" if lateral > 0 else "right",
        length_m=arm.length,
        inclination_deg=float(np.degrees(np.arctan2(up, abs(lateral)))),
        radial_N=float(np.hypot(lateral, up)),
    )
