"""The same line under other circumstances: where its wires hang under conditions, from which runs start."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.spring import FIXED
from catenary_fe.fe.surroundings import surrounded
from catenary_fe.fe.system import System, WireNodes
from catenary_fe.layout import Catenary, InputError, Line, SolverError
from catenary_fe.layout.arguments import checked
from catenary_fe.layout.conditions import Conditions, Effect
from catenary_fe.layout.parameters import shorten
from catenary_fe.statics.newton import solve_loaded
from catenary_fe.statics.shape import HangingWire, Settlement, Shape

Floats = NDArray[np.float64]
_PASSES = 30
_STEPS = 10  # of the load, where it is too much at once
_STILL = 1e-6  # [m] by which cantilevers may still swing


@checked
def settle(shape: Shape, conditions: Conditions | Sequence[Effect]) -> Shape:
    """The line at rest under conditions: same droppers, same devices, other places and tensions.

    What :func:`find_form` found is hung at the temperature of installation, in still air. Weights keep their
    pull and travel; wires between fixed ends change their tension. Cantilevers swing with the messenger wire;
    the pivot of a steady arm goes along with its contact wire. Modes and runs of every engine start from what
    this returns.

    conditions : or effects, a script's own among them (:class:`catenary_fe.layout.conditions.Effect`)

    Raises InputError for wind on a line that is modelled in the plane, and for a shape that conditions have
    moved already, SolverError where no equilibrium is found.
    """
    if shape.settlement:
        raise InputError("settle: the shape is already under conditions; begin with what find_form returned")
    given, effects = _taken(conditions, shape.catenary.installation_temperature)
    outside = surrounded(shape.system, effects)
    system, moved = _at_rest(shape.system, outside, shape.catenary)
    springs = system.force - outside.force - system.ground_stiffness * moved
    return _shape(shape, system, Settlement(shape, given, moved, springs))


def _taken(
    conditions: Conditions | Sequence[Effect], installed: float
) -> tuple[Conditions | None, list[Effect]]:
    if isinstance(conditions, Conditions):
        return conditions, conditions.effects(installed)
    if not isinstance(conditions, (list, tuple)):
        raise InputError(
            f"settle: conditions = {shorten(conditions)}: give cf.Conditions(...), or a list of effects"
        )
    for effect in conditions:
        if not isinstance(effect, Effect):
            raise InputError(
                f"settle: {type(effect).__name__} is no effect; give Conditions, or objects of a class that"
                " inherits from Effect"
            )
    return None, list(conditions)


def _gradually(before: System, system: System) -> tuple[Floats, Floats | None]:
    """As `solve_loaded`, with loads and lengths that come step by step: arms swing far, or turn over."""
    moved, left = np.zeros(system.dof.size), None
    strain = before.cables.rest_strain
    for share in np.linspace(0, 1, _STEPS + 1)[1:].tolist():
        part = replace(
            system,
            force=before.force + share * (system.force - before.force),
            cables=replace(system.cables, rest_strain=strain + share * (system.cables.rest_strain - strain)),
        )
        moved, left = solve_loaded(part, np.zeros(moved.size), moved)
    return moved, left


def _at_rest(hung: System, system: System, catenary: Catenary) -> tuple[System, Floats]:
    """The line with its cantilevers where the wires take them, and displacements, shape (all,)."""
    cantilevers = _cantilevers(system, catenary)
    swung, moved = system, np.zeros(system.dof.size)
    before = np.full(moved.size, np.inf)
    for _ in range(_PASSES):
        moved, left = solve_loaded(swung, np.zeros(moved.size), moved)
        if left is not None:
            moved, left = _gradually(hung, swung)
        if left is not None:
            worst = int(np.abs(left).argmax())
            raise SolverError(
                f"settle: no equilibrium under these conditions, {np.abs(left).max():.3g} N are left at the"
                f" {system.name(worst)}; look there for loads and temperatures far from usual values"
            )
        carried = np.array([at for c in cantilevers for at in (c.along, *c.below)], dtype=np.int64)
        if np.abs(moved - before)[carried].max(initial=0.0) < _STILL:
            return swung, moved
        swung, before = _swung(system, cantilevers, moved), moved
    raise SolverError("settle: the cantilevers come to no rest; look for arms that nothing pulls")


@dataclass(frozen=True)
class _Cantilever:
    """A cantilever and what it carries.

    along, across : numbers of the coordinates on it of the messenger wire, where there is none of the contact
        wire; across is FIXED in the plane and without a messenger wire
    arms : numbers of the links whose pivots it carries
    below : numbers of the contact wires' coordinates along the track, on these links
    mast : [m] to the left of the track's centre, or None
    """

    along: int
    across: int
    arms: tuple[int, ...]
    below: tuple[int, ...]
    mast: float | None


def _cantilevers(system: System, catenary: Catenary) -> list[_Cantilever]:
    """Those between the ends of each section: a section's ends are anchored."""
    sections = catenary.sections if isinstance(catenary, Line) else (catenary,)
    width, found = 2 * system.axes, []
    for section, line in enumerate(sections):
        mine = [wire for wire in system.wires if wire.section == section and wire.supports.size]
        contact = [wire for wire in mine if wire.contact]
        above = [wire for wire in mine if not wire.contact]
        for number, support in list(enumerate(line.supports))[1:-1]:
            along = [width * (w.first + int(w.supports[number])) for w in (*above, *contact)]
            arms = np.flatnonzero(np.isin(system.arms.first, along[len(above) :]))
            below = tuple(system.arms.first[arms].tolist())
            across = along[0] + 1 if above and system.spatial else FIXED
            found.append(_Cantilever(along[0], across, tuple(arms.tolist()), below, support.mast_position))
    return found


def _swung(system: System, cantilevers: Sequence[_Cantilever], moved: Floats) -> System:
    """The line with its cantilevers moved along the track as far as their wires, and drawn to the masts.

    A pivot goes as far as its own contact wire: the degree or two by which an arm leans along the track where
    contact and messenger wire move differently are left out.
    """
    pivot, force, reference = system.arms.pivot.copy(), system.force.copy(), system.reference.copy()
    for cantilever in cantilevers:
        shift = float(moved[cantilever.along])
        for arm, along in zip(cantilever.arms, cantilever.below, strict=True):
            pivot[arm, 0] += moved[along]
            if system.spatial:
                pivot[arm, 1] += drawn(cantilever.mast, float(pivot[arm, 1]), shift)
        if cantilever.across == FIXED:
            continue
        aside = drawn(cantilever.mast, float(reference[cantilever.across]), shift)
        if system.dof[cantilever.across] == FIXED:
            reference[cantilever.across] += aside
        else:
            force[cantilever.across] += system.ground_stiffness[cantilever.across] * aside
    return replace(system, arms=replace(system.arms, pivot=pivot), force=force, reference=reference)


def drawn(mast: float | None, place: float, shift: float) -> float:
    """[m] to the left by which a point on a cantilever is drawn as it swings along the track.

    mast : [m] to the left of the track's centre, of the hinge; None: it is not drawn
    place : [m] of the point
    shift : [m] along the track

    Raises InputError for a shift longer than the cantilever.
    """
    if mast is None:
        return 0.0
    reach = mast - place
    if abs(shift) >= abs(reach):
        raise InputError(
            f"settle: a wire moves {abs(shift):.2f} m along the track, and the cantilever, hinged at"
            f" mast_position = {mast:g} m, reaches {abs(reach):.2f} m: it cannot swing so far"
        )
    return float(reach - np.sign(reach) * np.sqrt(reach**2 - shift**2))


def _shape(shape: Shape, system: System, settlement: Settlement) -> Shape:
    """The line where it came to rest: from here displacements count, and here engines linearise."""
    moved = settlement.moved
    reference = system.reference + moved
    rows = system.tensions(moved)
    wires = tuple(
        replace(wire, x=_along(system, wire, reference), tension=pull)
        for wire, pull in zip(system.wires, rows, strict=True)
    )
    here = replace(
        system,
        reference=reference,
        force=system.force - system.ground_stiffness * moved - system.linear_stiffness @ moved,
        wires=wires,
    )
    span = system.droppers.span(reference)
    settled = replace(
        shape,
        wires=tuple(HangingWire.from_coordinates(_nodes(system, wire, reference)) for wire in wires),
        dropper_forces=system.droppers.tension(span),
        installed_lengths=np.linalg.norm(span, axis=1),
        has_effect=True,
        settlement=settlement,
    )
    settled.__dict__["system"] = here
    return settled


def _nodes(system: System, wire: WireNodes, values: Floats) -> Floats:
    """Shape (nodes, 2 * axes): a wire's part of values of all coordinates."""
    width = 2 * system.axes
    return values[width * wire.first : width * (wire.first + wire.x.size)].reshape(-1, width)


def _along(system: System, wire: WireNodes, reference: Floats) -> Floats:
    return _nodes(system, wire, reference)[:, 0].copy()
