"""What conditions do to a line, in figures: tensions, sags, offsets, cantilevers, devices, forces."""

from __future__ import annotations

from dataclasses import asdict, dataclass, fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.spring import FIXED
from catenary_fe.fe.system import System, WireNodes
from catenary_fe.layout import Catenary, InputError, Line
from catenary_fe.layout.arguments import checked
from catenary_fe.layout.terminations import WireField
from catenary_fe.statics.line import LineShape
from catenary_fe.statics.shape import HangingWire, Shape

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class WireRow:
    """A wire under conditions.

    tension_N, least_tension_N, largest_tension_N : mean along the wire, and extremes of elements
    largest_sag_m : below the straight line between two supports, of a stitch wire between its clamps
    """

    name: str
    tension_N: float  # noqa: N815 the unit's own letter
    least_tension_N: float  # noqa: N815
    largest_tension_N: float  # noqa: N815
    largest_sag_m: float


@dataclass(frozen=True)
class CaseSupportRow:
    """A support under conditions; what does not apply is None.

    section : number of the tension section, from 1; supports count along the line
    cantilever_shift_mm : of the messenger wire along the track, of the contact wire where there is none
    cantilever_rotation_deg : of the cantilever about its hinge, where `mast_position` says where that is
    contact_wire_height_m, stagger_m : of the (right) contact wire
    device_travel_mm : of weights, downwards positive: the wire's end, times the device's ratio if known;
        of a spring, the wire's end
    forces_N : on the wires, up and to the left: of the support on the messenger wire, of the steady arms
    """

    section: int
    support: int
    cantilever_shift_mm: float | None
    cantilever_rotation_deg: float | None
    contact_wire_height_m: float
    stagger_m: float
    device_travel_mm: dict[str, float] | None
    forces_N: dict[str, float]  # noqa: N815


@dataclass(frozen=True)
class CaseRows:
    """A line under one case's conditions, beside how it was hung.

    largest_lateral_offset_m : of the contact wires from the track's centre
    offset_at_m : where along the line that is
    allowed_offset_m : or None where the conditions allow any
    lowest_contact_wire_m, highest_contact_wire_m : between the sections' ends
    largest_dropper_force_N, slack_droppers : among all droppers
    pushed_arms : numbers of the supports where a steady arm would have to push
    """

    name: str
    wires: list[WireRow]
    largest_lateral_offset_m: float
    offset_at_m: float
    allowed_offset_m: float | None
    lowest_contact_wire_m: float
    highest_contact_wire_m: float
    largest_dropper_force_N: float  # noqa: N815
    slack_droppers: int
    pushed_arms: list[int]
    supports: list[CaseSupportRow]

    @property
    def holds(self) -> bool:
        """Whether the contact wire stays within the allowed offset, and no steady arm would have to push."""
        allowed = self.allowed_offset_m
        return not self.pushed_arms and (allowed is None or self.largest_lateral_offset_m <= allowed)

    def as_dict(self) -> dict[str, Any]:
        """For JSON; what does not apply is left out."""
        found = {f.name: getattr(self, f.name) for f in fields(self) if getattr(self, f.name) is not None}
        supports = [{k: v for k, v in asdict(row).items() if v is not None} for row in self.supports]
        return found | {
            "wires": [asdict(row) for row in self.wires],
            "supports": supports,
            "holds": self.holds,
        }


@checked
def case_rows(settled: Shape) -> CaseRows:
    """The figures of a line under conditions. Raises InputError for a shape that was not settled."""
    settlement = settled.settlement
    if settlement is None:
        raise InputError("case_rows: the shape is as it was hung; give what cf.settle returned")
    conditions = settlement.conditions
    contact = settled.contact_wires
    offsets = [np.abs(wire.y) for wire in contact]
    most = int(np.argmax([values.max() for values in offsets]))
    heights = np.concatenate([wire.z for wire in contact])
    return CaseRows(
        name=conditions.name if conditions else "effects",
        wires=_wires(settled),
        largest_lateral_offset_m=float(offsets[most].max()),
        offset_at_m=float(contact[most].x[offsets[most].argmax()]),
        allowed_offset_m=conditions.allowed_offset if conditions else None,
        lowest_contact_wire_m=float(heights.min()),
        highest_contact_wire_m=float(heights.max()),
        largest_dropper_force_N=float(settled.dropper_forces.max(initial=0.0)),
        slack_droppers=int((settled.dropper_forces <= 0).sum()),
        pushed_arms=pushed_arms(settled),
        supports=_supports(settled),
    )


def pushed_arms(shape: Shape) -> list[int]:
    """Numbers, from 1, of the supports where a steady arm that is a link would have to push."""
    arms, reference = shape.system.arms, shape.system.reference
    pushed = arms.first[arms.tension(arms.span(reference)) < 0]
    before = shape.settlement.before.system.reference if shape.settlement else reference
    at = shape.catenary.supports_at(before[pushed])
    return sorted(set((at + 1).tolist()))


def _wires(settled: Shape) -> list[WireRow]:
    """Contact and messenger wires, then all stitch wires together."""
    system = settled.system
    pulls = system.tensions(np.zeros(system.dof.size))
    found, stitches = [], []
    for nodes, wire, pull in zip(system.wires, settled.wires, pulls, strict=True):
        row = nodes.name, pull, np.diff(nodes.x), _sag(wire, nodes)
        if nodes.kind == "stitch_wire":
            stitches.append(row)
        else:
            found.append(row)
    if stitches:
        _, forces, lengths, sags = zip(*stitches, strict=True)
        found.append(("stitch wires", np.concatenate(forces), np.concatenate(lengths), max(sags)))
    return [
        WireRow(name, float(pull @ lengths / lengths.sum()), float(pull.min()), float(pull.max()), sag)
        for name, pull, lengths, sag in found
    ]


def _sag(wire: HangingWire, nodes: WireNodes) -> float:
    """[m] below the straight lines between the points where the wire is held."""
    held = nodes.supports if nodes.supports.size else np.array([0, wire.x.size - 1])
    return float((np.interp(wire.x, wire.x[held], wire.z[held]) - wire.z).max())


def _supports(settled: Shape) -> list[CaseSupportRow]:
    """Section by section, each support once a section."""
    assert settled.settlement
    catenary, system, moved = settled.catenary, settled.system, settled.settlement.moved
    sections = catenary.sections if isinstance(catenary, Line) else (catenary,)
    forces = _holding_forces(settled)
    begins = catenary.begins if isinstance(catenary, Line) else (0.0,)
    width, up, found = 2 * system.axes, system.axes - 1, []
    for number, (section, begin) in enumerate(zip(sections, begins, strict=True)):
        of_line = catenary.supports_at(section.support_positions + begin)
        mine = [wire for wire in system.wires if wire.section == number and wire.supports.size]
        messenger = [wire for wire in mine if not wire.contact]
        lowest = min(wire.first for wire in mine if wire.contact)
        contact = next(wire for wire in mine if wire.first == lowest)
        for i, support in enumerate(section.supports):
            at = [width * (wire.first + int(wire.supports[i])) for wire in (*messenger[:1], contact)]
            shift = float(moved[at[0]])
            inner = 0 < i < len(section.supports) - 1
            reach = None if support.mast_position is None else support.mast_position - _y(system, at[0])
            found.append(
                CaseSupportRow(
                    section=number + 1,
                    support=int(of_line[i]) + 1,
                    cantilever_shift_mm=1e3 * shift if inner else None,
                    cantilever_rotation_deg=float(np.degrees(np.arcsin(shift / abs(reach))))
                    if inner and reach
                    else None,
                    contact_wire_height_m=float(system.reference[at[-1] + up]),
                    stagger_m=_y(system, at[-1]),
                    device_travel_mm=None if inner else _travel(section, mine, width, moved, i),
                    forces_N=_forces(forces, mine, width, i, up),
                )
            )
    return found


def _y(system: System, at: int) -> float:
    return float(system.reference[at + 1]) if system.spatial else 0.0


def _travel(
    section: Catenary, wires: list[WireNodes], width: int, moved: Floats, support: int
) -> dict[str, float] | None:
    """[mm] of each wire's device at an end of its section, downwards positive."""
    found: dict[str, float] = {}
    for wire in wires:
        kind = _field(wire)
        end = (section.end if support else section.begin).of(kind)
        if end.kind == "fixed":
            continue
        outwards = float(moved[width * (wire.first + int(wire.supports[support]))]) * (1 if support else -1)
        found[kind] = 1e3 * outwards * (end.ratio or 1.0)
    return found or None


def _field(wire: WireNodes) -> WireField:
    """What a contact or messenger wire is called in a layout."""
    return "contact_wire" if wire.contact else "messenger_wire"


def _forces(forces: Floats, wires: list[WireNodes], width: int, support: int, up: int) -> dict[str, float]:
    found = {"messenger_up": 0.0, "messenger_left": 0.0, "arms_up": 0.0, "arms_left": 0.0}
    for wire in wires:
        at, name = width * (wire.first + int(wire.supports[support])), "arms" if wire.contact else "messenger"
        found[f"{name}_up"] += float(forces[at + up])
        found[f"{name}_left"] += float(forces[at + 1]) if up > 1 else 0.0
    return found


def _holding_forces(settled: Shape) -> Floats:
    """[N], shape (all coordinates,): what supports and arms do to the wires, now."""
    assert settled.settlement
    system, none = settled.system, np.zeros(settled.system.dof.size)
    found = settled.settlement.springs + _installed(settled)
    held = system.dof == FIXED
    found[held] = -system.out_of_balance(none)[held]
    arms = system.arms
    np.add.at(found, arms.index().ravel(), arms.forces(system.reference).ravel())
    return found


def _installed(settled: Shape) -> Floats:
    """[N], shape (all coordinates,): preloads of springs at supports and arms."""
    system, found = settled.system, np.zeros(settled.system.dof.size)
    width, axes = 2 * system.axes, np.arange(1, system.axes)
    for number, section in enumerate(_section_shapes(settled)):
        mine = [wire for wire in system.wires if wire.section == number and wire.supports.size]
        contact = [wire for wire in mine if wire.contact]
        installation = section.installation
        of_wires = list(zip(contact, installation.arm_forces, strict=True))
        of_wires += [(wire, installation.support_forces) for wire in mine if not wire.contact]
        for wire, forces in of_wires:
            at = (width * (wire.first + wire.supports))[:, None] + axes
            found[at] = np.where(system.ground_stiffness[at] > 0, forces, 0.0)
    return found


def _section_shapes(settled: Shape) -> tuple[Shape, ...]:
    return settled.sections if isinstance(settled, LineShape) else (settled,)
