"""Energy in compiled nonlinear runs: what contacts and bases did in a step, and what was lost in it."""

from __future__ import annotations

from catenary_fe.engines.arrays import Floats, PantographParameters, PantographState, Wires, Work
from catenary_fe.engines.compiled import apart, compiled
from catenary_fe.engines.contact_solver import base_height, risen_base, surface_at
from catenary_fe.engines.generalized_alpha import Scheme
from catenary_fe.engines.kernels import take
from catenary_fe.engines.nonlinear.arrays import EnergyBalance, Equations, Motion
from catenary_fe.engines.nonlinear.forces import damp_cables
from catenary_fe.engines.pantograph_laws import frame_at
from catenary_fe.layout.bodies import DAMPER, FRAME, FRICTION


@apart
def add_energy(
    system: Equations,
    scheme: Scheme,
    wires: Wires,
    motion: Motion,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    energy: EnergyBalance,
    time: float,
) -> None:
    """Add what contacts did and dampers took in this step, or part of one."""
    moved, drag, lost = motion.before, motion.residual, 0.0
    for i in range(moved.size):
        q = wires.q[i, 0] + scheme.b * wires.x[i, 0]
        moved[i], energy.q[i] = q - energy.q[i], q
        motion.v[i] = wires.v[i, 0] + scheme.g * wires.x[i, 0]
    drag[:] = 0.0
    damp_cables(system, motion, drag)  # its negative
    take(system.damping, motion.v, drag)
    for i in range(moved.size):
        lost += (energy.drag[i] - drag[i]) * moved[i] / 2
        energy.drag[i] = -drag[i]
    for i in range(energy.span.size):
        stretch = energy.new_span[i] - energy.span[i]
        lost += (energy.damper[i] + energy.new_damper[i]) * stretch / 2
        energy.damper[i], energy.span[i] = energy.new_damper[i], energy.new_span[i]
    energy.work[0] += _contact_work(scheme, heads, pantographs, work, energy, moved)
    energy.work[0] += _base_work(scheme, heads, pantographs, energy, time)
    base, taken = _law_work(scheme, heads, pantographs, work, energy, time)
    energy.work[0] += base
    energy.work[1] += lost + taken
    energy.work[1] += _head_losses(scheme, heads, pantographs, energy)


@compiled
def _contact_work(
    scheme: Scheme,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    energy: EnergyBalance,
    moved: Floats,
) -> float:
    """Work of the contacts on wires and masses [J]."""
    driven = 0.0
    for j in range(heads.owner.shape[1]):
        p = heads.owner[0, j]
        if p < 0:
            continue
        before, now = 0.0, 0.0
        for m in range(4):
            if energy.at[j, m] >= 0:
                before += energy.shape[j, m] * moved[energy.at[j, m]]
            if work.at[0, j, m] >= 0:
                now += work.shape[0, j, m] * moved[work.at[0, j, m]]
            energy.at[j, m], energy.shape[j, m] = work.at[0, j, m], work.shape[0, j, m]
        for s in range(pantographs.x.shape[2]):
            rise = pantographs.q[0, p, s] + scheme.b * pantographs.x[0, p, s] - energy.heads[p, s]
            before -= energy.head[j, s] * rise
            now -= work.head[0, j, s] * rise
            energy.head[j, s] = work.head[0, j, s]
        driven += (energy.force[j] * before + work.force[0, j] * now) / 2
        energy.force[j] = work.force[0, j]
    return driven


@compiled
def _base_work(
    scheme: Scheme,
    heads: PantographParameters,
    pantographs: PantographState,
    energy: EnergyBalance,
    time: float,
) -> float:
    """Work of the bases on the masses in the step that ends at a time, as forces on fixed springs [J]."""
    driven = 0.0
    for p in range(pantographs.x.shape[1]):
        risen = (base_height(heads, 0, p, time - scheme.h) + base_height(heads, 0, p, time)) / 2
        if risen != 0.0:
            for s in range(pantographs.x.shape[2]):
                place = pantographs.q[0, p, s] + scheme.b * pantographs.x[0, p, s]
                driven += risen * heads.base_load[0, p, s] * (place - energy.heads[p, s])
        if heads.base.last[p] >= 0:
            before, early = surface_at(heads.base, p, time - scheme.h)
            now, late = surface_at(heads.base, p, time)
            for s in range(pantographs.x.shape[2]):
                place = pantographs.q[0, p, s] + scheme.b * pantographs.x[0, p, s]
                force = heads.base_stiffness[0, p, s] * (before + now) / 2
                force += heads.base_damping[0, p, s] * (early + late) / 2
                driven += force * (place - energy.heads[p, s])
    return driven


@compiled
def _law_work(
    scheme: Scheme,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    energy: EnergyBalance,
    time: float,
) -> tuple[float, float]:
    """What bases did on stops and frames that stand on them, and what friction and dampers took [J]."""
    driven, lost = 0.0, 0.0
    for n in range(heads.laws.kind.shape[1]):
        kind, grounded, force = heads.laws.kind[0, n], heads.laws.to_base[0, n], work.law_force[0, n]
        if kind < 0:
            continue
        p, u, moved = heads.laws.owner[0, n], 0.0, 0.0
        for s in range(pantographs.x.shape[2]):
            place = pantographs.q[0, p, s] + scheme.b * pantographs.x[0, p, s]
            u += heads.laws.row[0, n, s] * place
            moved += heads.laws.row[0, n, s] * (place - energy.heads[p, s])
        if kind in (DAMPER, FRICTION):
            lost += (energy.law_force[n] + force) * moved / 2
        elif grounded != 0.0:
            risen = risen_base(heads, 0, p, time)
            if kind == FRAME:  # its inertia is no matter of the base
                first, step = heads.laws.values[0, n, 0], heads.laws.values[0, n, 1]
                _, _, force, _ = frame_at(heads.laws.frame[0, n], first, step, u + grounded * risen)
            rise = risen - risen_base(heads, 0, p, time - scheme.h)
            driven += (energy.law_force[n] + force) / 2 * grounded * rise
        energy.law_force[n] = force
    return driven, lost


@compiled
def _head_losses(
    scheme: Scheme, heads: PantographParameters, pantographs: PantographState, energy: EnergyBalance
) -> float:
    """What the pantographs' dampers took [J]."""
    lost = 0.0
    for p in range(pantographs.x.shape[1]):
        for s in range(pantographs.x.shape[2]):
            drag = 0.0
            for r in range(pantographs.x.shape[2]):
                drag += heads.D[0, p, s, r] * (pantographs.v[0, p, r] + scheme.g * pantographs.x[0, p, r])
            place = pantographs.q[0, p, s] + scheme.b * pantographs.x[0, p, s]
            lost += (energy.head_drag[p, s] + drag) * (place - energy.heads[p, s]) / 2
            energy.heads[p, s], energy.head_drag[p, s] = place, drag
    return lost
