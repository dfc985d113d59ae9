"""Form finding: dropper lengths that give the contact wire its design height, and the reverse."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from catenary_fe.equilibrium.shape import Shape
from catenary_fe.fe.mesh import Mesh, MeshSettings, WireMesh, make_mesh
from catenary_fe.fe.model import Installation, Model, build_model
from catenary_fe.fe.single_wire import WireStatics, solve_wire
from catenary_fe.fe.solver import solve_static
from catenary_fe.fe.wire import GRAVITY, WireLine
from catenary_fe.system import Catenary, InputError, SolverError, Wire

Floats = NDArray[np.float64]

HEIGHT_TOLERANCE = 1e-4  # [m] of the contact wire at the droppers
_PASSES = 3  # each squares the error of the wires' lengths and of the droppers' weight; two are enough


def find_form(catenary: Catenary, mesh: MeshSettings | None = None) -> Shape:
    """Dropper lengths and forces with which the contact wire has its design height at every dropper.

    The droppers are cut: the contact wire alone, held at its design heights, gives their forces; the
    messenger wire alone, loaded with them, gives the room between the wires. The whole model, put together
    with these lengths, is then solved, and must have its design heights.

    mesh : element lengths; a shape belongs to its mesh

    Raises InputError for a design in which a dropper would have to push or has no room, SolverError where
    no equilibrium is found or the heights are off by more than 0.1 mm.
    """
    settings = mesh or MeshSettings()
    nodes = make_mesh(catenary, settings)
    contact, forces, arm_forces = _hang_contact_wire(catenary, nodes.contact)
    contact_weight = _clamp_weights(catenary, "contact_wire_clamp_mass")
    lengths = np.zeros(len(catenary.droppers))
    messenger = _messenger_guess(catenary, nodes.messenger, forces)
    support_forces = np.zeros(len(catenary.supports))
    for _ in range(_PASSES):
        half_weights = _half_weights(catenary, lengths)
        tensions = forces + contact_weight + half_weights
        _check_tensions(catenary, tensions)
        messenger, support_forces = _hang_messenger_wire(
            catenary, nodes.messenger, messenger, tensions + half_weights
        )
        lengths = _installed_lengths(nodes, contact, messenger) - tensions / _stiffnesses(catenary)
    _check_room(catenary, lengths)
    installation = Installation(contact, messenger, lengths, arm_forces, support_forces)
    return _verified(catenary, settings, nodes, installation)


def find_heights(
    catenary: Catenary, lengths: Sequence[float] | Floats | None = None, mesh: MeshSettings | None = None
) -> Shape:
    """The reverse of form finding: the static shape that given dropper lengths result in.

    lengths : [m], shape (droppers,), stress-free; unset: those that the layout gives
    mesh : element lengths; a shape belongs to its mesh

    Raises InputError for missing or impossible lengths, SolverError where no equilibrium is found.
    """
    settings = mesh or MeshSettings()
    nodes = make_mesh(catenary, settings)
    lengths = _given_lengths(catenary, lengths)
    installation = _installation_guess(catenary, nodes, lengths)
    for _ in range(_PASSES):
        model = build_model(catenary, nodes, installation, held=True)
        installation = _settle(model, installation)
    return _shape(catenary, settings, nodes, installation)


def _hang_contact_wire(catenary: Catenary, mesh: WireMesh) -> tuple[WireLine, Floats, Floats]:
    """Line of the contact wire, forces that hold it at the droppers, and forces of the steady arms."""
    design = catenary.design_heights
    nominal = catenary.contact_wire_height
    last = len(catenary.supports) - 1
    held = dict(zip(mesh.droppers.tolist(), design.tolist(), strict=True))
    loads, springs = {}, {}
    for i, support in enumerate(catenary.supports):
        node, arm = int(mesh.supports[i]), support.steady_arm
        if i in (0, last) or (arm and arm.holds_design_height):
            held[node] = nominal
        elif arm:
            springs[node] = (arm.stiffness, nominal)
            loads[node] = arm.preload - GRAVITY * arm.mass
    fixed = sorted(held)
    z = np.interp(mesh.x, mesh.x[fixed], [held[n] for n in fixed])
    line = WireLine.through(catenary.contact_wire, mesh.x, z, np.gradient(z, mesh.x))
    for _ in range(_PASSES):
        statics = solve_wire(
            catenary.contact_wire, line, held, loads, springs, what="form finding of the contact wire"
        )
        line = _straightened(catenary.contact_wire, mesh, statics)
    forces = np.array([statics.reactions[int(n)] for n in mesh.droppers])
    arm_forces = np.zeros(last + 1)
    for i, support in list(enumerate(catenary.supports))[1:-1]:
        node, arm = int(mesh.supports[i]), support.steady_arm
        if arm and arm.holds_design_height:
            arm_forces[i] = statics.reactions[node] + GRAVITY * arm.mass
        elif arm:
            arm_forces[i] = arm.preload - arm.stiffness * (statics.z[node] - nominal)
    return line, forces, arm_forces


def _hang_messenger_wire(
    catenary: Catenary, mesh: WireMesh, line: WireLine, pulls: Floats
) -> tuple[WireLine, Floats]:
    """Line of the messenger wire under the pull of the droppers, and the forces of its supports."""
    pulls = pulls + _clamp_weights(catenary, "messenger_clamp_mass")
    held = dict(zip(mesh.supports.tolist(), catenary.messenger_support_heights.tolist(), strict=True))
    loads = dict(zip(mesh.droppers.tolist(), (-pulls).tolist(), strict=True))
    statics = solve_wire(
        catenary.messenger_wire, line, held, loads, {}, what="form finding of the messenger wire"
    )
    return _straightened(catenary.messenger_wire, mesh, statics), np.array(
        [statics.reactions[int(n)] for n in mesh.supports]
    )


def _straightened(wire: Wire, mesh: WireMesh, statics: WireStatics) -> WireLine:
    """The line that was found, with the nodes back at their stations: clamps sit where they are wanted."""
    from scipy.interpolate import CubicHermiteSpline

    curve = CubicHermiteSpline(statics.x, statics.z, statics.dz_dx, extrapolate=True)
    return WireLine.through(wire, mesh.x, curve(mesh.x), curve(mesh.x, 1))


def _messenger_guess(catenary: Catenary, mesh: WireMesh, forces: Floats) -> WireLine:
    """Parabolas between the supports, for the weight of both wires."""
    weight = GRAVITY * (catenary.messenger_wire.mass_per_length + catenary.contact_wire.mass_per_length)
    heights, positions = catenary.messenger_support_heights, catenary.support_positions
    z, slope = np.empty_like(mesh.x), np.empty_like(mesh.x)
    for i in range(len(catenary.spans)):
        a, b = positions[i], positions[i + 1]
        part = slice(mesh.supports[i], mesh.supports[i + 1] + 1)
        x = mesh.x[part]
        rise = (heights[i + 1] - heights[i]) / (b - a)
        load = weight / (2 * catenary.messenger_wire.tension)
        z[part] = heights[i] + rise * (x - a) - load * (x - a) * (b - x)
        slope[part] = rise - load * (a + b - 2 * x)
    return WireLine.through(catenary.messenger_wire, mesh.x, z, slope)


def _clamp_weights(catenary: Catenary, which: str) -> Floats:
    return GRAVITY * np.array([getattr(d, which) for d in catenary.droppers])


def _half_weights(catenary: Catenary, lengths: Floats) -> Floats:
    return GRAVITY * np.array([d.mass_per_length for d in catenary.droppers]) * lengths / 2


def _stiffnesses(catenary: Catenary) -> Floats:
    return np.array([d.stiffness for d in catenary.droppers])


def _installed_lengths(mesh: Mesh, contact: WireLine, messenger: WireLine) -> Floats:
    lower, upper = mesh.contact.droppers, mesh.messenger.droppers
    rise: Floats = messenger.z[upper] - contact.z[lower]
    return rise


def _names(catenary: Catenary) -> list[str]:
    return [
        f"span {i}: dropper {number} at {dropper.position:g} m"
        for i, span in enumerate(catenary.spans, start=1)
        for number, dropper in enumerate(span.droppers, start=1)
    ]


def _check_tensions(catenary: Catenary, tensions: Floats) -> None:
    faults = [
        f"{name} would have to push with {-force:.1f} N; droppers only pull: change the pre-sag, the height"
        " there or the position"
        for name, force in zip(_names(catenary), tensions, strict=True)
        if force < 0
    ]
    if faults:
        raise InputError(*faults)


def _check_room(catenary: Catenary, lengths: Floats) -> None:
    faults = [
        f"{name} has no room: the messenger wire hangs {-length:.3f} m below its lower clamp; raise"
        " system_height or the messenger wire's tension"
        for name, length in zip(_names(catenary), lengths, strict=True)
        if length <= 0
    ]
    if faults:
        raise InputError(*faults)


def _given_lengths(catenary: Catenary, lengths: Sequence[float] | Floats | None) -> Floats:
    if lengths is None:
        given = [d.length for d in catenary.droppers]
        missing = [n for n, v in zip(_names(catenary), given, strict=True) if v is None]
        if missing:
            raise InputError(f"{missing[0]} has no length ({len(missing)} droppers in all); give all lengths")
        lengths = np.array(given, dtype=float)
    values = np.asarray(lengths, dtype=float)
    if values.shape != (len(catenary.droppers),):
        raise InputError(
            f"{values.size} dropper lengths for {len(catenary.droppers)} droppers: give one each"
        )
    room = np.interp(
        catenary.dropper_positions, catenary.support_positions, catenary.messenger_support_heights
    ) - (catenary.design_heights)
    faults = [
        f"{name}: a length of {value:g} m must lie between 0 and the system height, {space:g} m there"
        for name, value, space in zip(_names(catenary), values, room, strict=True)
        if not 0 < value < space
    ]
    if faults:
        raise InputError(*faults)
    return values


def _installation_guess(catenary: Catenary, mesh: Mesh, lengths: Floats) -> Installation:
    """Contact wire at its design height, messenger wire a dropper's length above it."""
    contact, _, arm_forces = _hang_contact_wire(catenary, mesh.contact)
    at = np.concatenate([mesh.messenger.supports, mesh.messenger.droppers])
    heights = np.concatenate([catenary.messenger_support_heights, catenary.design_heights + lengths])
    order = np.argsort(at)
    z = np.interp(mesh.messenger.x, mesh.messenger.x[at[order]], heights[order])
    messenger = WireLine.through(
        catenary.messenger_wire, mesh.messenger.x, z, np.gradient(z, mesh.messenger.x)
    )
    return Installation(contact, messenger, lengths, arm_forces, np.zeros(len(catenary.supports)))


def _settle(model: Model, installation: Installation) -> Installation:
    """One static solve of a held model, and the installation that it amounts to."""
    catenary, mesh = model.catenary, model.mesh
    model.mbs.Assemble()
    solve_static(model.mbs, what="static shape for given dropper lengths")
    contact, messenger = (
        WireStatics(q[:, 0], q[:, 1], q[:, 3] / q[:, 2], {})
        for q in model.wire_shapes(model.mbs.systemData.GetODE2Coordinates())
    )
    arm_forces, support_forces = np.zeros(len(catenary.supports)), np.zeros(len(catenary.supports))
    for i, constraint in model.held_arms.items():
        arm_forces[i] = model.held_force(constraint)
    for i, constraint in model.held_supports.items():
        support_forces[i] = model.held_force(constraint)
    for i, support in list(enumerate(catenary.supports))[1:-1]:
        arm = support.steady_arm
        if arm and not arm.holds_design_height:
            raised = contact.z[mesh.contact.supports[i]] - catenary.contact_wire_height
            arm_forces[i] = arm.preload - arm.stiffness * raised
    return Installation(
        _straightened(catenary.contact_wire, mesh.contact, contact),
        _straightened(catenary.messenger_wire, mesh.messenger, messenger),
        installation.dropper_lengths,
        arm_forces,
        support_forces,
    )


def _verified(catenary: Catenary, settings: MeshSettings, nodes: Mesh, installation: Installation) -> Shape:
    shape = _shape(catenary, settings, nodes, installation)
    errors = np.abs(shape.height_errors)
    if errors.size and errors.max() > HEIGHT_TOLERANCE:
        name = _names(catenary)[int(errors.argmax())]
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
    contact, messenger = model.wire_shapes(model.mbs.systemData.GetODE2Coordinates())
    lower, upper = contact[nodes.contact.droppers], messenger[nodes.messenger.droppers]
    return Shape(
        catenary=catenary,
        mesh_settings=settings,
        mesh=nodes,
        installation=installation,
        contact_wire_x=contact[:, 0],
        contact_wire_z=contact[:, 1],
        contact_wire_dz_dx=contact[:, 3] / contact[:, 2],
        messenger_wire_x=messenger[:, 0],
        messenger_wire_z=messenger[:, 1],
        dropper_forces=model.dropper_forces(),
        installed_lengths=np.hypot(upper[:, 0] - lower[:, 0], upper[:, 1] - lower[:, 1]),
    )
