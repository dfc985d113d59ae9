"""Checks of momentum and energy: what forces did in a run against what masses and springs have of it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import AnyPantograph
from catenary_fe.layout.bodies import DAMPER, STOP
from catenary_fe.layout.substructure import Substructure
from catenary_fe.results.check import Check

if TYPE_CHECKING:
    from catenary_fe.results.run import Run

Floats = NDArray[np.float64]

OF_A_SCRIPT, BY_A_SCRIPT = "of a script", "steered by a script"  # what a record says of its model
IMBALANCE = 0.005  # of the uplift
UNBALANCED = 0.02  # of the work done; of sound runs 0.5 % at most is missing, the integrator's own damping
STAGES_UNBALANCED = 0.003  # of the contact force's work; 0.01 % in sound runs


def lumped(run: Run) -> list[tuple[int, AnyPantograph]]:
    return [(i, p) for i, p in enumerate(run.pantographs) if p.masses]


def _steered(run: Run) -> bool:
    """Whether a script set uplifts or speeds on the way, of which there is no record."""
    return bool(run.data.attrs.get("model") == BY_A_SCRIPT)


def _risen(run: Run, number: int, body: Substructure) -> Floats:
    """[m], shape (times,): height above the nominal one at which a pantograph's base spring is force-free."""
    if not body.follows:
        return _roof(run, number)
    line = run.catenary.design_line(run.data["position"].values[number])
    return np.asarray(line - run.catenary.contact_wire_height) + _roof(run, number)


def _roof(run: Run, number: int) -> Floats:
    """[m], shape (times,): by how much a pantograph's base has moved up, with spring and damper."""
    return run.data["base_height"].values[number] if "base_height" in run.data else 0 * run.time


def name_of(run: Run, pantograph: int) -> str:
    return str(run.data["pantograph"].values[pantograph])


def worst(found: Sequence[tuple[float, str]]) -> tuple[float, str]:
    """The largest value and its text; not-a-number counts as the largest."""
    return max(found, key=lambda item: np.inf if np.isnan(item[0]) else item[0])


def force_balance(run: Run) -> Iterator[Check]:
    """Newton's law over the whole run: uplift, springs and dampers of the base, less the contact force.

    Together they are the momentum gained. The histories are those of the steps' ends; what is left of a sound
    run is the rounding of the last velocity, far below half a per cent of the uplift (0.02 % at most in the
    EN 50318:2002 runs).
    """
    if run.time.size < 3 or _steered(run):
        return
    found = []
    for i, pantograph in lumped(run):
        force, uplift = run.data["contact_force"].values[i], float(run.data["uplift_force"].values[i])
        body, heights, risen = _motion(run, i, pantograph)
        if not _follows_from_motion(body):
            continue
        duration = float(run.time[-1])
        n = len(body.bodies)  # pitch does not move the middle
        pressed = body.stiffness[:n, :n].sum(axis=0) @ heights - body.base_stiffness.sum() * risen
        pressed = pressed + _law_forces(body, heights, (risen, _roof(run, i)), run.step).sum(axis=0)
        pushed = np.trapezoid(uplift - force - pressed, dx=run.step)
        over = heights - _roof(run, i)
        pushed -= body.damping[:n, :n].sum(axis=0) @ (over[:, -1] - over[:, 0])
        velocity = (1.5 * heights[:, -1] - 2 * heights[:, -2] + 0.5 * heights[:, -3]) / run.step
        gained = np.diag(body.mass)[:n] @ velocity
        found.append((100 * abs(float(pushed - gained)) / duration / uplift, name_of(run, i)))
    if found:
        value, name = worst(found)
        text = (
            f"share of the uplift force of {name} by which the forces on it and its momentum do not agree;"
            " take a smaller time step or tolerance"
        )
        yield Check("force balance", value, "%", "at most", 100 * IMBALANCE, text)


def _motion(run: Run, number: int, pantograph: AnyPantograph) -> tuple[Substructure, Floats, Floats]:
    """A pantograph's matrices in the plane, and its masses' heights, shape (masses, times), and its base's.

    Both [m] above the nominal contact wire height.
    """
    body = pantograph.assemble(spatial=False, height=run.catenary.contact_wire_height, speed=run.speed)
    heights = run.data["mass_height"].values[number, : len(body.bodies)] - run.catenary.contact_wire_height
    return body, heights, _risen(run, number, body)


def _follows_from_motion(body: Substructure) -> bool:
    """Whether all forces in a pantograph follow from heights and their rates.

    Dry friction's at rest does not, nor do those of strips that bend.
    """
    return not body.bending and all(law.kind in (STOP, DAMPER) for law in body.laws)


def _law_forces(body: Substructure, heights: Floats, base: tuple[Floats, Floats], step: float) -> Floats:
    """[N], shape of heights: forces against the coordinates that are not linear.

    base : [m], shape (times,), of the springs' lower ends, and of the dampers'
    """
    forces, rates = np.zeros_like(heights), np.gradient(heights, step, axis=1) if body.laws else heights
    for law in body.laws:
        row = np.array(law.row)[: len(heights)]
        rate = row @ rates + law.to_base * np.gradient(base[1], step)
        forces += np.outer(row, law.push(row @ heights + law.to_base * base[0], rate))
    return forces


def met_stops(run: Run, number: int, pantograph: AnyPantograph) -> float:
    """[Hz], the highest, of a pantograph's masses on stops that they met in a run; 0 where they met none."""
    body, heights, risen = _motion(run, number, pantograph)
    highest = 0.0
    for law in body.laws:
        whole = np.array(law.row)
        row = whole[: len(heights)]
        if law.kind == STOP and (row @ heights + law.to_base * risen).max() > law.values[0]:
            own = law.values[1] * float(whole @ np.linalg.solve(body.mass, whole))
            highest = max(highest, float(np.sqrt(own)) / (2 * np.pi))
    return highest


def pantograph_energy(run: Run) -> Iterator[Check]:
    """Uplift, contact force and base work on the masses; springs store it, dampers take it, masses keep it.

    From the histories alone, so that it is there whatever integrated the run. Work of a step is the mean of a
    force at its ends along the displacement. Of heads with several strips, or that roll, the single forces
    are not known.
    """
    found = []
    for i, pantograph in [] if _steered(run) else lumped(run):
        rolls = run.catenary.is_spatial and pantograph.panhead.spring_distance
        if run.time.size < 5 or rolls or pantograph.panhead.strips > 1:
            continue
        body, heights, risen = _motion(run, i, pantograph)
        if not _follows_from_motion(body):
            continue
        force, uplift = run.data["contact_force"].values[i], float(run.data["uplift_force"].values[i])
        roof = _roof(run, i)
        moved, velocity = np.diff(heights), np.gradient(heights, run.step, axis=1)
        pushed = -(force[1:] + force[:-1]) / 2 * moved[0]
        base = body.base_stiffness[:, None] * (risen[1:] + risen[:-1]) / 2
        base = base + body.base_damping[:, None] * np.diff(roof) / run.step
        lifted = ((uplift * body.load)[:, None] + base) * moved
        lost = (moved * (body.damping @ moved)).sum(axis=0) / run.step
        laws = _law_forces(body, heights, (risen, roof), run.step)
        lost = lost + (moved * (laws[:, 1:] + laws[:, :-1])).sum(axis=0) / 2
        stored = (velocity * (body.mass @ velocity) + heights * (body.stiffness @ heights)).sum(axis=0) / 2
        balance = np.cumsum(pushed + lifted.sum(axis=0) - lost) - (stored[1:] - stored[0])
        share = np.abs(balance[1:-1] - balance[0]).max() / max(np.abs(pushed).sum(), 1e-9)
        found.append((100 * float(share), name_of(run, i)))
    if found:
        value, name = worst(found)
        text = (
            f"share of the contact force's work on {name} that its springs, dampers and masses do not account"
            " for; take a smaller time step"
        )
        yield Check("pantograph energy", value, "%", "at most", 100 * STAGES_UNBALANCED, text)


def energy_balance(run: Run) -> Iterator[Check]:
    """Work of uplift forces and moving bases, less what dampers take, is stored and kinetic energy.

    Of the whole system, where the run recorded it: all nonlinear runs do. What is missing of a sound run went
    into the integrator's own damping: up to 0.2 % at 1 ms, 0.5 % at 2 ms.
    """
    if not run.has_energy:
        return
    missing, work = np.abs(run.missing_energy).max(), np.abs(run.data["driven_work"].values).max()
    for i, pantograph in lumped(run):  # the energy's potential has the uplift's work in it
        lowest = _motion(run, i, pantograph)[1][-1]
        work += float(run.data["uplift_force"].values[i]) * np.abs(lowest - lowest[0]).max()
    text = "share of the work on wires and pantographs that is missing; take a smaller time step or tolerance"
    share = 100 * float(missing / max(work, 1e-9))
    yield Check("energy balance", share, "%", "at most", 100 * UNBALANCED, text)
