"""Form finding: dropper lengths that give the contact wire its design height, and the reverse."""

from __future__ import annotations

from collections.abc import Sequence
from math import tan

import numpy as np
from numpy.typing import NDArray

from catenary_fe.equilibrium.cut_wires import CutWires, DropperForces, straightened
from catenary_fe.equilibrium.form_checks import (
    check_catenary,
    check_links,
    check_pulls,
    check_room,
    check_stretch,
    dropper_names,
    given_lengths,
)
from catenary_fe.equilibrium.guess import guess_lines
from catenary_fe.equilibrium.shape import HangingWire, Shape
from catenary_fe.fe.mesh import Mesh, MeshSettings, make_mesh
from catenary_fe.fe.model import Installation, Model, build_model, wire_kinds
from catenary_fe.fe.single_wire import At, WireStatics
from catenary_fe.fe.solver import release, solve_static
from catenary_fe.fe.wire import WireLine
from catenary_fe.system import GRAVITY, Catenary, SolverError

Floats = NDArray[np.float64]

HEIGHT_TOLERANCE = 1e-4  # [m] of the contact wire at the droppers
_SETTLED = 1e-6  # [m] change from pass to pass, where form finding ends
_PASSES = 80  # in the plane three are enough, in space about eight, more where stitch wires are loose


def find_form(catenary: Catenary, mesh: MeshSettings | None = None) -> Shape:
    """Dropper lengths and forces with which the contact wire has its design height at every dropper.

    The droppers are cut: the contact wires alone, held at their design heights, give the droppers' pull;
    stitch and messenger wires alone, loaded with it, give the room between the wires and, in space, how the
    droppers lean; that is repeated until nothing changes. The whole model, put together with these lengths,
    is then solved, and must have its design heights.

    mesh : element lengths; a shape belongs to its mesh

    Raises InputError for a design in which a dropper or a steady arm would have to push or has no room,
    SolverError where no equilibrium is found or the heights are off by more than 0.1 mm.
    """
    check_catenary(catenary)
    settings = mesh or MeshSettings()
    wires = CutWires(catenary, make_mesh(catenary, settings))
    lines = guess_lines(wires)
    lengths, none = np.zeros(len(catenary.droppers)), np.zeros(len(catenary.droppers))
    forces = DropperForces(none, none, none, none)
    for _ in range(_PASSES):
        before = lengths
        lines, forces = _pass(wires, lines, forces)
        spread = _spread(wires.mesh, lines)
        check_room(catenary, spread[:, -1])
        distance = np.linalg.norm(spread, axis=1)
        tension = forces.pull * distance / spread[:, -1]
        lengths = distance - tension / np.array([d.stiffness for d in catenary.droppers])
        check_stretch(catenary, distance, tension)
        weight = GRAVITY * np.array([d.mass_per_length for d in catenary.droppers]) * lengths / 2
        lean = spread[:, 1] / spread[:, -1] if wires.axes == 3 else none
        forces = DropperForces(forces.pull, lean, forces.pull / spread[:, -1], weight)
        if np.abs(lengths - before).max(initial=0.0) < _SETTLED:
            break
    else:
        raise SolverError(
            f"form finding: dropper lengths still change by {1e3 * np.abs(lengths - before).max():.3g} mm"
            f" after {_PASSES} passes; look for long spans with little tension"
        )
    if wires.axes == 3:
        check_links(catenary, wires.arm_forces)
    installation = Installation(tuple(lines), lengths, wires.arm_forces, wires.support_forces)
    return _verified(catenary, settings, wires.mesh, installation)


def find_heights(
    catenary: Catenary, lengths: Sequence[float] | Floats | None = None, mesh: MeshSettings | None = None
) -> Shape:
    """The reverse of form finding: the static shape that given dropper lengths result in.

    lengths : [m], shape (droppers,), stress-free; unset: those that the layout gives
    mesh : element lengths; a shape belongs to its mesh

    Raises InputError for missing or impossible lengths, SolverError where no equilibrium is found.
    """
    check_catenary(catenary)
    settings = mesh or MeshSettings()
    lengths = given_lengths(catenary, lengths)
    wires = CutWires(catenary, make_mesh(catenary, settings))
    lines = guess_lines(wires)
    none = np.zeros(lengths.size)
    forces = DropperForces(none, none, none, none)
    for number in range(wires.mesh.contact_wires):
        lines[number], forces = wires.hang_contact_wire(number, lines[number], forces)
    installation = Installation(tuple(lines), lengths, wires.arm_forces, wires.support_forces)
    for _ in range(_PASSES):
        before = installation
        model = build_model(catenary, wires.mesh, installation, held=True)
        installation = _settle(model, installation, wires.pulls)
        moved = max(
            float(np.abs(a.points - b.points).max())
            for a, b in zip(before.lines, installation.lines, strict=True)
        )
        if moved < _SETTLED:
            break
    else:
        raise SolverError(
            f"static shape: the wires still move by {1e3 * moved:.3g} mm after {_PASSES} passes; look for"
            " dropper lengths that do not fit the line"
        )
    if wires.axes == 3:
        check_links(catenary, installation.arm_forces)
    return _shape(catenary, settings, wires.mesh, installation)


def _pass(
    wires: CutWires, lines: list[WireLine], forces: DropperForces
) -> tuple[list[WireLine], DropperForces]:
    """Hang each wire once more, with what is known of the others."""
    mesh, lines = wires.mesh, list(lines)
    for number in range(mesh.contact_wires):
        lines[number], forces = wires.hang_contact_wire(number, lines[number], forces)
    check_pulls(wires.catenary, forces.pull)
    stitch_pulls: dict[tuple[int, int], float] = {}
    for i, ends in enumerate(mesh.stitch_ends):
        number = mesh.first_stitch + i
        clamps = lines[mesh.contact_wires].points[ends]
        lines[number], pulls = wires.hang_stitch_wire(number, lines[number], clamps, forces)
        stitch_pulls |= pulls
    lines[mesh.contact_wires] = wires.hang_messenger_wire(lines[mesh.contact_wires], forces, stitch_pulls)
    return lines, forces


def _spread(mesh: Mesh, lines: Sequence[WireLine]) -> Floats:
    """[m], shape (droppers, axes), from the droppers' lower to their upper clamps."""
    points = np.concatenate([line.points for line in lines])
    spread: Floats = points[mesh.nodes(mesh.upper)] - points[mesh.nodes(mesh.lower)]
    return spread


def _settle(model: Model, installation: Installation, pulls: Sequence[Floats]) -> Installation:
    """One static solve of a held model, and the installation that it amounts to."""
    catenary, mesh = model.catenary, model.mesh
    model.mbs.Assemble()
    solve_static(model.mbs, what="static shape for given dropper lengths")
    statics = [
        WireStatics.from_coordinates(q) for q in model.wire_shapes(model.mbs.systemData.GetODE2Coordinates())
    ]
    held: list[dict[At, float]] = [{} for _ in mesh.wires]
    arm_forces = np.zeros_like(installation.arm_forces)
    support_forces = np.zeros_like(installation.support_forces)
    for (wire, i, axis), constraint in model.held.arms.items():
        node = int(mesh.wires[wire].supports[i])
        held[wire][node, axis] = installation.lines[wire].points[node, axis]
        arm_forces[wire, i, axis - 1] = model.held_force(constraint)
    for (i, axis), constraint in model.held.supports.items():
        wire, node = mesh.contact_wires, int(mesh.messenger.supports[i])
        held[wire][node, axis] = installation.lines[wire].points[node, axis]
        support_forces[i, axis - 1] = model.held_force(constraint)
    lines = tuple(
        straightened(*one)
        for one in zip(
            wire_kinds(catenary, mesh), (w.x for w in mesh.wires), statics, pulls, held, strict=True
        )
    )
    release(model.mbs)
    arm_forces[:, [0, -1]] = 0.0  # the wires' anchors
    for i, support in list(enumerate(catenary.supports))[1:-1]:
        arm = support.steady_arm
        if arm is None or arm.holds_height:
            continue
        for wire in range(mesh.contact_wires):
            raised = statics[wire].points[mesh.wires[wire].supports[i], -1] - catenary.contact_wire_height
            arm_forces[wire, i, -1] = (
                arm.preload - arm.stiffness * raised
                if arm.stiffness is not None
                else abs(arm_forces[wire, i, 0]) * tan(arm.inclination or 0.0)
            )
    return Installation(lines, installation.dropper_lengths, arm_forces, support_forces)


def _verified(catenary: Catenary, settings: MeshSettings, nodes: Mesh, installation: Installation) -> Shape:
    shape = _shape(catenary, settings, nodes, installation)
    errors = np.abs(shape.height_errors)
    if errors.size and errors.max() > HEIGHT_TOLERANCE:
        name = dropper_names(catenary)[int(errors.argmax())]
        raise SolverError(
            f"{name}: the contact wire misses its design height by {1e3 * errors.max():.2f} mm, more than"
            f" {1e3 * HEIGHT_TOLERANCE:g} mm; refine the mesh, and look for slack droppers nearby"
        )
    return shape


def _shape(catenary: Catenary, settings: MeshSettings, nodes: Mesh, installation: Installation) -> Shape:
    """The whole model in equilibrium."""
    model = build_model(catenary, nodes, installation)
    model.mbs.Assemble()
    solve_static(model.mbs, what="static shape of the catenary")
    shapes = model.wire_shapes(model.mbs.systemData.GetODE2Coordinates())
    wires = tuple(HangingWire.from_coordinates(q) for q in shapes)
    points = np.concatenate([q[:, : model.axes] for q in shapes])
    spread = points[nodes.nodes(nodes.upper)] - points[nodes.nodes(nodes.lower)]
    dropper_forces = model.dropper_forces()
    release(model.mbs)
    return Shape(
        catenary=catenary,
        mesh_settings=settings,
        mesh=nodes,
        installation=installation,
        wires=wires,
        dropper_forces=dropper_forces,
        installed_lengths=np.linalg.norm(spread, axis=1),
    )
