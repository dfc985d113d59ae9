"""A single-arm pantograph built by hand from Exudyn's bodies and joints, beside its description's.

Run it with ``python models/studies/own_linkage.py``; it takes half a minute and prints the contact force of
both, and by how much they differ. Three rigid bodies turn on four joints in the vertical plane; a torque and
a damper act on the lower arm, the head stands on the apex by its spring.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import exudyn.itemInterface as eii
import numpy as np

import catenary_fe as cf

LAYOUT = Path(__file__).parents[1] / "layouts" / "en50318_2002.toml"
SPEED, START = 250 / 3.6, 10.0  # m/s, m
TIME = cf.TimeSettings(step=1e-3)
GRAVITY = 9.81  # m/s²
UPWARD = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]  # turns a Mass1D, which moves along x, up in the vertical plane
FRAME = cf.LinkagePantograph(
    name="single-arm frame",
    source="dimensions made up to be plausible: no published ones were found",
    pivot_height=3.9,
    head_height=0.12,
    apex_mass=6.0,
    lower_arm={"length": 1.6, "mass": 30.0, "centre": 0.75, "inertia": 7.0},
    upper_arm={
        "length": 2.19, "mass": 14.0, "centre": 0.9, "inertia": 6.0, "lever": 0.2, "lever_angle": 3.376,
    },
    coupling_rod={"length": 1.67, "mass": 5.0, "centre": 0.83, "inertia": 1.2, "pivot": (-0.2, -0.32)},
    head_stages=[{"mass": 7.2, "stiffness": 4200.0, "damping": 10.0}],
    damper={"up": 700.0, "down": 700.0},
    drive={"torque": 1500.0},
)  # fmt: skip


def bar(mbs: Any, part: Any, begin: Sequence[float], angle: float) -> tuple[int, int]:
    """A rigid body with its weight, whose first axis leads from its begin to its end; body and node."""
    centre = np.asarray(begin) + part.centre * np.array([np.cos(angle), np.sin(angle)])
    node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=[*centre.tolist(), angle]))
    body = mbs.AddObject(eii.ObjectRigidBody2D(mass=part.mass, inertia=part.inertia, nodeNumber=node))
    weigh(mbs, body)
    return int(body), int(node)


def weigh(mbs: Any, body: int) -> None:
    """Let a body weigh what it weighs."""
    marker = mbs.AddMarker(eii.MarkerBodyMass(bodyNumber=body))
    mbs.AddLoad(eii.LoadMassProportional(markerNumber=marker, loadVector=[0.0, -GRAVITY, 0.0]))


def joint(mbs: Any, *places: tuple[int, Sequence[float]]) -> None:
    """Two bodies turn about a point, of each at this place."""
    markers = [
        mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[*map(float, place), 0.0]))
        for body, place in places
    ]
    mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=markers))


def add_frame(model: cf.ExudynModel, frame: cf.LinkagePantograph, apex: float) -> tuple[int, float]:
    """Arms, rod, apex mass, torque and damper; the upper arm's body, and its length beyond its centre [m].

    apex : [m] above the base pivot where it begins
    """
    mbs, angle = model.mbs, frame.linkage.angle_at(apex)
    pose, pivot = frame.linkage.pose(angle), np.array([0.0, frame.pivot_height])
    lower, upper, rod = frame.lower_arm, frame.upper_arm, frame.coupling_rod
    low, turning = bar(mbs, lower, pivot, float(pose.lower))
    up, _ = bar(mbs, upper, pivot + pose.knee, float(pose.upper))
    held, _ = bar(mbs, rod, pivot + rod.pivot, float(pose.rod))
    ground = mbs.AddObject(eii.ObjectGround(referencePosition=[*pivot.tolist(), 0.0]))
    lever = upper.lever * np.array([np.cos(upper.lever_angle), np.sin(upper.lever_angle)])
    joint(mbs, (ground, (0.0, 0.0)), (low, (-lower.centre, 0.0)))
    joint(mbs, (low, (lower.length - lower.centre, 0.0)), (up, (-upper.centre, 0.0)))
    joint(mbs, (up, lever - [upper.centre, 0.0]), (held, (rod.length - rod.centre, 0.0)))
    joint(mbs, (ground, rod.pivot), (held, (-rod.centre, 0.0)))
    top = mbs.AddNode(eii.NodePoint2D(referenceCoordinates=(pivot + pose.apex).tolist()))
    guide = mbs.AddObject(eii.ObjectMassPoint2D(mass=frame.apex_mass, nodeNumber=top))
    weigh(mbs, guide)
    joint(mbs, (up, (upper.length - upper.centre, 0.0)), (guide, (0.0, 0.0)))
    raising = float(np.sign(frame.linkage.rise(angle)))  # whether the arm turns to the left or to the right
    marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=low))
    torque = [0.0, 0.0, raising * float(frame.drive.torque)]
    mbs.AddLoad(eii.LoadTorqueVector(markerNumber=marker, loadVector=torque))
    turn = mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=turning, coordinate=2))
    mbs.AddObject(
        eii.ObjectConnectorCoordinateSpringDamper(markerNumbers=[model.ground, turn], damping=frame.damper.up)
    )
    return up, upper.length - upper.centre


def add_head(
    model: cf.ExudynModel, frame: cf.LinkagePantograph, arm: tuple[int, float], height: float
) -> int:
    """A mass on its spring upon the apex; a marker on it. ``height`` [m]: above the rail, where it begins."""
    mbs, stage = model.mbs, frame.head_stages[0]
    node = mbs.AddNode(eii.Node1D(referenceCoordinates=[0.0]))
    head = mbs.AddObject(
        eii.ObjectMass1D(
            mass=stage.mass, nodeNumber=node, referencePosition=[0.0, height, 0.0], referenceRotation=UPWARD
        )
    )
    weigh(mbs, head)
    strip = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=head))
    apex = mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=arm[0], localPosition=[arm[1], 0.0, 0.0]))
    mbs.AddObject(
        eii.ObjectConnectorCartesianSpringDamper(
            markerNumbers=[apex, strip],
            stiffness=[0.0, stage.stiffness, 0.0],
            damping=[0.0, stage.damping, 0.0],
            offset=[0.0, frame.head_height + stage.mass * GRAVITY / stage.stiffness, 0.0],
        )
    )
    return int(strip)


def by_hand(shape: cf.Shape, frame: cf.LinkagePantograph) -> cf.Run:
    """A run with bodies and joints of this script's own."""
    model = cf.exudyn_model(shape)
    height = float(shape.contact_wire_height(START)) + 2e-3  # a little into the wire
    stage = frame.head_stages[0]
    apex = height - frame.pivot_height - frame.head_height + frame.static_uplift(SPEED) / stage.stiffness
    strip = add_head(model, frame, add_frame(model, frame, apex), height)
    model.attach(frame.name, [strip], contact_stiffness=frame.contact_stiffness)
    return run(shape, [], model)


def run(shape: cf.Shape, pantographs: list[cf.LinkagePantograph], model: cf.ExudynModel | None) -> cf.Run:
    """A run of a model, or of what a pantograph's description makes."""
    return cf.simulate(
        shape, pantographs, speed=SPEED, positions=[START], time=TIME, method="exudyn", model=model
    )


def main() -> None:
    """Compare. What is left comes from the damper, whose lever the description takes as it is at rest."""
    line = cf.load_catenary(LAYOUT)
    line = line.replace(spans=line.spans[:4], supports=line.supports[:5], evaluated_spans=(2, 3))
    shape = cf.find_form(line)
    forces = []
    for name, compute in (
        ("from its description", lambda: run(shape, [FRAME], None)),
        ("built by hand", lambda: by_hand(shape, FRAME)),
    ):
        found = compute()
        forces.append(found.data["contact_force"].values[0])
        force = found.contact_force_statistics()[0]
        print(f"{name:22s} mean {force.mean:6.2f} N, standard deviation {force.std:6.2f} N", flush=True)
    off = np.std(forces[1] - forces[0]) / np.std(forces[0])
    print(f"they differ by {100 * off:.2f} % of the standard deviation")


if __name__ == "__main__":
    main()
