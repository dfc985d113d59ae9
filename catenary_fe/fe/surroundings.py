"""A line in its surroundings: what effects do to the wires, added to the assembled system in one place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from catenary_fe.fe.cable import scattered
from catenary_fe.fe.contact import EvenCurve, surface_places
from catenary_fe.fe.spring import Springs
from catenary_fe.fe.system import System, TimeLoad, WireNodes
from catenary_fe.layout import GRAVITY, InputError
from catenary_fe.layout.conditions import Effect, WirePart

Floats = NDArray[np.float64]
_ACROSS = 1  # of the three rows of an effect: along the track, to the left, up


def surrounded(system: System, effects: Sequence[Effect]) -> System:
    """The line with loads, masses, damping and lengths of effects; it has not moved yet.

    Raises InputError for what acts across the track on a line that is modelled in the plane.
    """
    for effect in effects:
        system = _with(system, effect)
    return system


def _with(system: System, effect: Effect) -> System:
    parts, counts = _parts(system), [wire.x.size - 1 for wire in system.wires]
    load = np.concatenate([effect.load(part) for part in parts], axis=1)
    mass = np.concatenate([effect.mass(part) for part in parts])
    damping = np.concatenate([effect.damping(part) for part in parts], axis=1)
    strain = np.concatenate([effect.strain(part) for part in parts])
    load[-1] -= GRAVITY * mass
    base, motion = system.base_line, effect.base_motion()
    return replace(
        system,
        cables=replace(system.cables, rest_strain=system.cables.rest_strain + strain),
        force=system.force + _forces(system, load),
        mass=_more(system, system.mass, np.tile(mass, (3, 1))),
        linear_damping=_more(system, system.linear_damping, damping),
        droppers=_lengthened(system, effect),
        wires=tuple(_with_surface(wire, effect) for wire in system.wires),
        time_loads=(*system.time_loads, *_time_loads(system, effect, parts, counts)),
        base_line=replace(base, motions=(*base.motions, motion)) if motion else base,
    )


def _parts(system: System) -> list[WirePart]:
    """The middles of each wire's elements."""
    found = []
    for wire in system.wires:
        assert wire.wire is not None
        found.append(WirePart(wire.kind, wire.wire, (wire.x[:-1] + wire.x[1:]) / 2))
    return found


def _forces(system: System, load: Floats) -> Floats:
    """[N], shape (all,), of a load [N/m] of shape (3, elements)."""
    if not system.spatial and load[_ACROSS].any():
        raise InputError(
            "conditions: wind across the track moves the wires to the side, and the line is modelled in the"
            " vertical plane; set spatial = true in the layout"
        )
    rows = (0, _ACROSS, 2) if system.spatial else (0, 2)
    forces = np.zeros(system.dof.size)
    for axis, row in enumerate(rows):
        if load[row].any():
            forces += system.distributed(load[row], axis)
    return forces


def _more(system: System, matrix: Any, per_length: Floats) -> Any:
    """A matrix with that of masses or dampers per length, of shape (3, elements)."""
    if not per_length.any():
        return matrix
    rows = per_length if system.spatial else per_length[[0, 2]]
    axis = np.arange(4 * system.axes) % system.axes
    share = (rows / system.mass_per_length)[axis].T  # elements, coordinates
    return (
        matrix + scattered([(system.elements(), system.element_mass * share[:, :, None])], system.dof.size)
    ).tocsr()


def _with_surface(wire: WireNodes, effect: Effect) -> WireNodes:
    """A contact wire with the effect's irregularity on top of what it has."""
    if not wire.contact:
        return wire
    assert wire.wire is not None
    x = surface_places(wire.x)
    surface = EvenCurve.through(x, effect.irregularity(WirePart(wire.kind, wire.wire, x)))
    return replace(wire, irregularity=surface.over(wire.irregularity)) if surface else wire


def _lengthened(system: System, effect: Effect) -> Springs:
    """Droppers lengthen as the wire that they hang from."""
    springs, strain = system.droppers, np.zeros(system.droppers.length.size)
    node = springs.last // (2 * system.axes)
    for wire in system.wires:
        assert wire.wire is not None
        mine = (node >= wire.first) & (node < wire.first + wire.x.size)
        strain[mine] = effect.strain(WirePart(wire.kind, wire.wire, wire.x[node[mine] - wire.first]))
    return replace(springs, length=springs.length * (1 + strain))


def _time_loads(
    system: System, effect: Effect, parts: Sequence[WirePart], counts: Sequence[int]
) -> list[TimeLoad]:
    """Loads that vary in time, one for each signal of the effect; each wire may have its own."""
    found, ends = [], np.cumsum(counts)
    for part, end, count in zip(parts, ends, counts, strict=True):
        for load, signal in effect.in_time(part):
            whole = np.zeros((3, ends[-1]))
            whole[:, end - count : end] = load
            found.append((signal, _forces(system, whole)))
    by_signal: dict[int, TimeLoad] = {}
    for signal, pattern in found:  # what wires share is one load
        before = by_signal.get(id(signal))
        by_signal[id(signal)] = TimeLoad(pattern + before.pattern if before else pattern, signal)
    return list(by_signal.values())
