"""Every engine on every kind of line under every kind of pantograph: the same histories within stated bounds.

The nonlinear engine is what the others are compared with. Lines are three spans of 24 m on the wires, arms
and droppers of a layout; a run starts at the second support and ends in the last span.
"""

from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.theory import MassChain

LAYOUTS = Path(__file__).parents[2] / "models" / "layouts"
SPAN, SPEED = 24.0, 75.0
STARTS = SPAN, 4.0  # [m], 20 m apart


class Bound(NamedTuple):
    """How far a history may be from the nonlinear one.

    exudyn : largest difference, in the history's unit
    linearised : root mean square of the difference, as a share of that of the change since the start
    """

    exudyn: float
    linearised: float


# Exudyn integrates the same equations by the same rule in the same steps. What differs is where the two
# Newton iterations stop: at 1e-6 of a step's first residual, which leaves 1 µm, and so 0.05 N in contact
# springs of 50 kN/m and 0.1 N in droppers of 100 to 200 kN/m. The largest differences of the table are 0.3
# to 0.5 of these bounds.
#
# Linearised runs solve contact and slack droppers exactly; tension, directions of droppers and arms, and
# where a rolling head meets the wire stay as at rest. Motions of some 50 mm turn droppers and arms of 1 m by
# a few per cent, and a dropper that goes slack a step later has another force in that step. The largest
# shares of the table are 0.4 to 0.5 of these bounds.
BOUNDS = {
    "contact_force": Bound(0.12, 0.03),  # N
    "wire_height": Bound(3e-6, 0.009),  # m
    "mass_height": Bound(3e-6, 0.012),  # m
    "dropper_force": Bound(0.35, 0.025),  # N
    "support_uplift": Bound(3e-6, 0.004),  # m
    "contact_wire_height": Bound(4e-6, 0.004),  # m; stored in single precision, ± 0.25 µm
}


def layout(name: str, droppers: int = 4, **changes: object) -> cf.Catenary:
    """Three equal spans of what a layout is made of, droppers spread evenly."""
    whole = cf.load_catenary(LAYOUTS / f"{name}.toml")
    gap = SPAN / droppers
    hangers = [whole.droppers[0].replace(position=(i + 0.5) * gap) for i in range(droppers)]
    span = cf.Span(length=SPAN, droppers=[d.replace(height_offset=None) for d in hangers])
    supports = whole.supports[:4]
    return whole.replace(spans=(span,) * 3, supports=supports, evaluated_spans=(2,), **changes)


def stitched() -> cf.Catenary:
    wire = cf.load_catenary(LAYOUTS / "en50318_2018_ac_stitched.toml").stitch_wire
    return layout("en50318_2018_ac_stitched", stitch_wire=wire.replace(length=10.0))


def curved() -> cf.Catenary:
    """In a curve to the left all arms are on its inside."""
    line = layout("en50318_2018_ac_simple")
    supports = tuple(s.replace(stagger=-0.2) for s in line.supports)
    return line.replace(supports=supports, spans=tuple(s.replace(curve_radius=1000.0) for s in line.spans))


LINES = {
    "plane": lambda: layout("en50318_2002"),
    "arms": lambda: layout("en50318_2018_ac_simple"),
    "twin wires": lambda: layout("dc_3kv_twin", droppers=8),
    "stitch wires": stitched,
    "curve": curved,
}

TWO_STAGES = cf.library.pantograph("EN 50318:2002")
THREE_STAGES = cf.library.pantograph("EN 50318:2018 AC").replace(mean_force=None, uplift_force=140.0)
HEAD = cf.Panhead(width=1.6, strips=2, strip_distance=0.4, spring_distance=0.9)
ONE_STAGE = cf.Pantograph(stages=[cf.Stage(mass=12.0, stiffness=200.0, damping=80.0)], uplift_force=100.0)
# a damper from the head to the base, and one over the middle mass, which no chain of stages has
DAMPERS = np.array([[55.0, -40.0, -5.0], [-40.0, 45.0, -5.0], [-5.0, -5.0, 100.0]])
FREQUENCIES = np.geomspace(0.1, 50.0, 60)
YIELDS = MassChain(np.array([7.5, 9.0, 6.0]), np.array([7000.0, 15500.0, 160.0]), DAMPERS).receptance(
    FREQUENCIES
)
RECEPTANCE = cf.ReceptancePantograph(
    receptance=list(
        zip(FREQUENCIES.tolist(), abs(YIELDS).tolist(), np.angle(YIELDS, deg=True).tolist(), strict=True)
    ),
    uplift_force=140.0,
)
LAW = ((0.0, 200.0), (0.02, 140.0), (0.06, 0.0))

PANTOGRAPHS = {
    "one stage": [ONE_STAGE],
    "two stages": [TWO_STAGES],
    "three stages": [THREE_STAGES],
    "rolling head, two strips": [THREE_STAGES.replace(head=HEAD)],
    "contact lost": [TWO_STAGES.replace(uplift_force=25.0)],
    "contact damping": [THREE_STAGES.replace(head=HEAD, contact_damping=20.0)],
    "receptance": [RECEPTANCE],
    "elastic, straight law": [cf.ElasticPantograph(force=150.0, stiffness=500.0)],
    "elastic, law of points": [cf.ElasticPantograph(law=LAW)],
    "two pantographs": [TWO_STAGES, THREE_STAGES],
}
# Multiples of the bounds for each engine that a pantograph is run with. Exudyn takes the wire's inclination,
# on which contact damping acts, where the step begins: by how much that is off has a test of its own.
COMPARED = {name: {"exudyn": 1.0, "linearised": 1.0} for name in PANTOGRAPHS}
del COMPARED["contact damping"]["exudyn"]

TABLE = [
    (line, pantograph)
    for line in LINES
    for pantograph in PANTOGRAPHS
    if not (line == "twin wires" and pantograph.startswith("elastic"))  # refused: one force, one wire
]


@cache
def run(line: str, pantograph: str, method: str, tension: float = 1.0, step: float = 2.5e-3) -> cf.Run:
    """tension : of the contact wire, as a multiple of the layout's"""
    catenary, pantographs = LINES[line](), PANTOGRAPHS[pantograph]
    wire = catenary.contact_wire
    shape = cf.find_form(catenary.replace(contact_wire=wire.replace(tension=tension * wire.tension)))
    time = cf.TimeSettings(step=step)
    if method != "linearised":  # which does not iterate
        time = cf.TimeSettings(step=step, tolerance=1e-6)
    return cf.simulate(
        shape, pantographs, speed=SPEED, positions=STARTS[: len(pantographs)], time=time,
        store_wire=0.02, method=method,
    )  # fmt: skip


def histories(run: cf.Run) -> dict[str, np.ndarray]:
    """Those of the table; without the masses that a pantograph does not have. Time is the last axis."""
    found = {name: run.data[name].values for name in BOUNDS}
    found["contact_wire_height"] = found["contact_wire_height"].T
    found["mass_height"] = found["mass_height"][~np.isnan(found["mass_height"]).any(axis=-1)]
    return found


def differences(ours: cf.Run, reference: cf.Run) -> dict[str, float]:
    """How far each history is from the reference's, in the measure of the engine's bounds."""
    found, by_name = {}, histories(ours)
    for name, expected in histories(reference).items():
        assert by_name[name].shape == expected.shape, name
        off = by_name[name].astype(float) - expected
        if off.size == 0:
            continue
        if ours.method == "linearised":
            found[name] = np.sqrt((off**2).mean() / ((expected - expected[..., :1]) ** 2).mean())
        else:
            found[name] = np.abs(off).max()
    return found


def misses(found: dict[str, float], method: str, times: float = 1.0) -> dict[str, tuple[float, float]]:
    """Differences that are not within so many times their bounds, with these."""
    bounds = {name: times * getattr(BOUNDS[name], method) for name in found}
    return {name: (off, bounds[name]) for name, off in found.items() if not off <= bounds[name]}


@pytest.mark.parametrize(("line", "pantograph"), TABLE)
def test_engines_agree(line, pantograph):
    reference = run(line, pantograph, "nonlinear")
    assert reference.method == "nonlinear"
    for method, times in COMPARED[pantograph].items():
        other = run(line, pantograph, method)
        assert other.method == method
        assert not misses(differences(other, reference), method, times), method
        # it was computed anew, not by the same engine under another name
        assert not np.array_equal(other.data["contact_force"], reference.data["contact_force"])


def test_with_contact_damping_exudyn_is_off_by_the_order_of_a_step():
    off = []
    for step in (1.25e-3, 6.25e-4):
        ours, theirs = (
            run("plane", "contact damping", method, step=step).data["contact_force"].values
            for method in ("nonlinear", "exudyn")
        )
        off.append(np.std(theirs - ours) / np.std(ours))
    assert off[0] < 0.03
    assert off[1] < 0.6 * off[0]


@pytest.mark.parametrize("line", LINES)
def test_a_tension_that_is_higher_by_one_percent_breaks_every_bound(line):
    """Negative control: bounds of both engines see it in each of the histories."""
    off = run(line, "two stages", "nonlinear", tension=1.01)
    for method in ("exudyn", "linearised"):
        found = differences(run(line, "two stages", method), off)
        assert misses(found, method).keys() == BOUNDS.keys(), method


def test_the_table_has_slack_droppers_and_lost_contact():
    """So the one-sided laws are among what is compared."""
    for line in LINES:
        assert (run(line, "two stages", "nonlinear").data["dropper_force"] <= 0).any(), line
    lost = (run("plane", "contact lost", "nonlinear").data["contact_force"] <= 0).values
    assert 0.02 < lost.mean() < 0.5
