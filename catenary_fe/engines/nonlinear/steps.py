"""Steps of a compiled nonlinear run.

Generalised-α as in a linearised run. Newton's method with the matrix at rest, which is corrected exactly for
what changes quickly: contacts, whose law is solved along with each iteration, and droppers that are slack.
"""

from __future__ import annotations

from typing import Any

from catenary_fe.engines import arrays as shared_arrays
from catenary_fe.engines import contact_solver, generalized_alpha, kernels, lanes, pantograph_laws
from catenary_fe.engines.arrays import Floats, PantographParameters, PantographState, Records, Wires, Work
from catenary_fe.engines.compiled import compiled, kept, stamp
from catenary_fe.engines.contact_solver import (
    SWEEPS,
    TOLERANCE,
    advance_heads,
    free_heads,
    lateral_place,
    move_wires,
    place_base,
    place_head,
    update_contact,
    weigh_contact,
)
from catenary_fe.engines.generalized_alpha import Scheme, predict
from catenary_fe.engines.kernels import add_loads, copy, take
from catenary_fe.engines.nonlinear import arrays, cables, energies, forces
from catenary_fe.engines.nonlinear.arrays import EnergyBalance, Equations, Factor, Motion, Slack, Stations
from catenary_fe.engines.nonlinear.energies import add_energy
from catenary_fe.engines.nonlinear.forces import (
    local_compliance,
    place_at,
    solve,
    take_cables,
    take_droppers,
    take_links,
    woodbury_update,
)
from catenary_fe.engines.pantograph_laws import begin_laws, update_laws

ITERATIONS = 20
FLOOR = 1e-8  # [m] motion in a step below which a run is at rest
FAR = 1.0  # [m] displacement in a step that is none any more


@compiled
def _place(
    scheme: Scheme,
    stations: Stations,
    factor: Factor,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    system: Equations,
    motion: Motion,
    time: float,
) -> None:
    """Contacts where they are at the step's end; the forces of the step before are the first guess."""
    advance_heads(scheme, pantographs, 0)
    free_heads(heads, pantographs, 0, time)
    begin_laws(heads, pantographs, work, 0)
    for j in range(heads.owner.shape[1]):
        p = heads.owner[0, j]
        if p < 0:
            continue
        position = heads.start[0, j] + heads.speed[0, j] * time
        e, _ = weigh_contact(stations, heads, work, 0, j, position)
        place_base(heads, work, 0, j, time)
        place_head(heads, work, 0, j, _sideways(system, stations, work.shape[0, j], motion.q, e))
        first, width = local_compliance(factor, work.at[0, j], work.shape[0, j], work.column[0, j])
        work.first[0, j], work.width[0, j] = first, width
        for s in range(pantographs.x.shape[2]):
            pantographs.x[0, p, s] -= work.force[0, j] * work.head_compliance[0, j, s]


@compiled
def _sideways(system: Equations, stations: Stations, weights: Floats, q: Floats, node: int) -> float:
    """[m] to the left of the track at a contact, as the wire was a step ago."""
    place = 0.0
    if system.dof.shape[0] == 6:
        for m in range(4):
            i = stations.node[node + m // 2]
            if i >= 0:
                place += weights[m] * place_at(system, q, 1 + 3 * (m % 2), i)
    return place


@compiled
def _move(system: Equations, scheme: Scheme, flat: Wires, motion: Motion) -> None:
    """Positions and velocities that belong to the accelerations; of forces the constant ones."""
    for i in range(flat.x.size):
        motion.q[i] = flat.q[i] + scheme.b * flat.x[i]
        motion.v[i] = flat.v[i] + scheme.g * flat.x[i]
        motion.residual[i] = system.force[i]


@compiled
def _residual(system: Equations, motion: Motion, flat: Wires, signals: Floats) -> None:
    """What is out of balance at the step's end, but for contacts; droppers have added theirs."""
    residual = motion.residual
    take_cables(system, motion, flat.x, residual)
    take_links(system, motion.q, residual)
    add_loads(system.patterns, signals, residual)
    take(system.stiffness, motion.q, residual)
    take(system.mass, flat.x, residual)
    take(system.damping, motion.v, residual)


@compiled
def _contacts(heads: PantographParameters, work: Work, residual: Floats) -> None:
    for j in range(heads.owner.shape[1]):
        if heads.owner[0, j] >= 0:
            for m in range(4):
                if work.at[0, j, m] >= 0:
                    residual[work.at[0, j, m]] += work.force[0, j] * work.shape[0, j, m]


@compiled
def _relax(
    scheme: Scheme,
    wires: Wires,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    time: float,
) -> None:
    """Bring the contact forces to their laws, and the accelerations with them."""
    contacts, laws = heads.owner.shape[1], heads.laws.kind.shape[1]
    for _ in range(SWEEPS):
        change = 0.0
        if laws > 0:
            change = update_laws(scheme, heads, pantographs, work, 0, time)
        for j in range(contacts):
            if heads.owner[0, j] >= 0:
                more = update_contact(scheme, wires, heads, pantographs, work, 0, j)
                move_wires(wires, 0, work.first[0, j], work.column[0, j, : work.width[0, j]], more)
                change = max(change, abs(more))
        if change <= TOLERANCE or contacts + laws == 1:
            break


@compiled
def _correct(scheme: Scheme, flat: Wires, motion: Motion) -> tuple[float, float]:
    """Largest displacement of this iteration, and of the step so far [m]."""
    x, before, v = flat.x, motion.before, motion.v
    a, b, c, d = 0.0, 0.0, 0.0, 0.0  # each waits for its last one alone
    e, f, g, h = 0.0, 0.0, 0.0, 0.0
    for i in range(0, x.size, 4):
        a, b = max(a, abs(x[i] - before[i])), max(b, abs(x[i + 1] - before[i + 1]))
        c, d = max(c, abs(x[i + 2] - before[i + 2])), max(d, abs(x[i + 3] - before[i + 3]))
        e, f = max(e, abs(v[i])), max(f, abs(v[i + 1]))
        g, h = max(g, abs(v[i + 2])), max(h, abs(v[i + 3]))
    return scheme.b * max(a, b, c, d), scheme.h * max(e, f, g, h)


@compiled
def _record(
    scheme: Scheme,
    stations: Stations,
    system: Equations,
    wires: Wires,
    motion: Motion,
    heads: PantographParameters,
    pantographs: PantographState,
    work: Work,
    to: Records,
) -> None:
    """Write down the state at the step's end."""
    n = pantographs.step[0] + 1
    for j in range(heads.owner.shape[1]):
        if heads.owner[0, j] >= 0:
            to.force[0, j, n] = work.force[0, j]
            z = work.shape[0, j, 4] - heads.nominal
            for m in range(4):
                i = work.at[0, j, m]
                if i >= 0:
                    z += work.shape[0, j, m] * (wires.q[i, 0] + scheme.b * wires.x[i, 0])
            to.height[0, j, n] = z
            if to.lateral.shape[2] > 0:
                to.lateral[0, j, n] = lateral_place(scheme, stations, wires, work, 0, j)
    for p in range(pantographs.x.shape[1]):
        for s in range(pantographs.x.shape[2]):
            to.masses[0, p, s, n] = pantographs.q[0, p, s] + scheme.b * pantographs.x[0, p, s]
    up = system.dof.shape[0] // 2 - 1
    for s in range(stations.supports.size):
        i = stations.supports[s]
        if i >= 0:
            to.supports[0, s, n] = place_at(system, motion.q, up, i) - stations.rest_supports[s]
    if to.every > 0 and n % to.every == 0:
        for node in range(stations.heights.size):
            i = stations.heights[node]
            if i >= 0:
                to.wire[0, n // to.every, node] = place_at(system, motion.q, up, i) - stations.rest[node]


def _loop(sources: str) -> Any:
    """Steps; ``sources`` is the stamp of all that they call."""
    # longer than others: the arrays of a run are arguments, as compiled code knows no objects

    @kept
    def advance(
        scheme: Scheme,
        system: Equations,
        stations: Stations,
        factor: Factor,
        wires: Wires,
        flat: Wires,
        motion: Motion,
        slack: Slack,
        heads: PantographParameters,
        pantographs: PantographState,
        work: Work,
        records: Records,
        energy: EnergyBalance,
        signals: Floats,
        steps: int,
        parts: int,
        tolerance: float,
    ) -> tuple[bool, int]:
        """Take steps, each in so many parts; returns whether all converged, and the number of iterations.

        signals : shape (loads, steps * parts + 1), of loads that vary in time, from the first step's begin on
        """
        iterations = len(sources) * 0
        begin = pantographs.step[0] * parts
        for n in range(begin, begin + steps * parts):
            predict(scheme, 0.0, flat)
            _place(scheme, stations, factor, heads, pantographs, work, system, motion, scheme.h * (n + 1))
            residual, converged, change = motion.residual, False, FAR
            step = pantographs.step[0] + 1
            for iteration in range(ITERATIONS):
                iterations += 1
                _move(system, scheme, flat, motion)
                take_droppers(
                    system, scheme, motion, slack, energy, records.droppers[0], pantographs.step[0] + 1
                )
                _residual(system, motion, flat, signals[:, n + 1 - begin])
                _contacts(heads, work, residual)
                solve(factor, residual)
                woodbury_update(factor, slack, residual)
                for i in range(residual.size):
                    motion.before[i] = flat.x[i]
                    flat.x[i] += residual[i]
                _relax(scheme, wires, heads, pantographs, work, scheme.h * (n + 1))
                earlier = change
                change, moved = _correct(scheme, flat, motion)
                if not change < FAR:
                    break
                rate = change / earlier
                converged = (
                    iteration > 0 and rate < 1 and change * rate / (1 - rate) <= tolerance * max(moved, FLOOR)
                )
                if converged:
                    break
            if not converged:
                return False, iterations
            add_energy(system, scheme, wires, motion, heads, pantographs, work, energy, scheme.h * (n + 1))
            if signals.shape[0] > 0:
                residual[:] = 0.0
                for end in (n - begin, n + 1 - begin):
                    add_loads(system.patterns, signals[:, end], residual)
                for i in range(residual.size):
                    energy.work[0] += residual[i] * motion.before[i] / 2
            if (n + 1) % parts == 0:
                _record(scheme, stations, system, wires, motion, heads, pantographs, work, records)
                pantographs.step[0] = step
                copy(energy.work, energy.history[:, step])
        return True, iterations

    return advance


advance = _loop(
    stamp(
        shared_arrays,
        generalized_alpha,
        contact_solver,
        pantograph_laws,
        kernels,
        lanes,
        arrays,
        cables,
        energies,
        forces,
    )
)
