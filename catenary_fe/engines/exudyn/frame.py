"""A pantograph's frame in the multibody model: arms and rod as rigid bodies on revolute joints.

The bodies move in the plane of the first two axes, whatever is up in the line's model: a guide on the node of
the frame's coordinate leads the apex there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import exudyn as exu
import exudyn.itemInterface as eii
import numpy as np
from numpy.typing import NDArray

from catenary_fe.layout import GRAVITY, InputError
from catenary_fe.layout.bodies import Mechanism
from catenary_fe.theory.linkage import Bar, Linkage

Floats = NDArray[np.float64]
_GUIDE = 1e8  # [N/m] that holds apex and guide together: a micrometre under 100 N
_LIGHT = 1e-3  # [kg] of bars without a mass, and of the guide


@dataclass(frozen=True)
class FrameParts:
    """A frame.

    mechanism : what it is
    nodes : of lower arm, upper arm and rod
    guide : node whose coordinate is the height of the apex above where it is at rest
    """

    mechanism: Mechanism
    nodes: tuple[int, int, int]
    guide: int

    def follow(self, mbs: exu.MainSystem, q: Floats) -> None:
        """Put the bodies where the guide's coordinate asks for, in coordinates of the system."""
        risen = float(q[mbs.systemData.GetNodeLTGODE2(self.guide)[0]])
        risen += self.mechanism.push(risen) / _GUIDE
        there, rest = (_places(self.mechanism, z) for z in (risen, 0.0))
        for node, now, before in zip(self.nodes, there, rest, strict=True):
            q[mbs.systemData.GetNodeLTGODE2(node)] = now - before


def add_frame(mbs: exu.MainSystem, mechanism: Mechanism, guide: int) -> FrameParts:
    """Add the bars, their joints, weight and drive.

    guide : node of the frame's coordinate

    Raises InputError for a drive with a table: its torque is constant here.
    """
    if isinstance(mechanism.torque, tuple):
        raise InputError(
            "drive.torque: a table over the angle is not in the multibody model; give one torque, or take the"
            " method nonlinear"
        )
    linkage, places = mechanism.linkage, _places(mechanism, 0.0)
    bodies, nodes = [], []
    for bar, place in zip(_bars(linkage), places, strict=True):
        node = mbs.AddNode(eii.NodeRigidBody2D(referenceCoordinates=place.tolist()))
        body = eii.ObjectRigidBody2D(
            mass=max(bar.mass, _LIGHT), inertia=max(bar.inertia, _LIGHT * bar.length**2 / 12), nodeNumber=node
        )
        nodes.append(int(node))
        bodies.append(int(mbs.AddObject(body)))
    lower, upper, rod = bodies
    ground = mbs.AddObject(eii.ObjectGround())
    lower_bar, upper_bar, rod_bar = _bars(linkage)
    turned = linkage.lever * np.array([np.cos(linkage.lever_angle), np.sin(linkage.lever_angle)])
    _revolute(mbs, (ground, (0.0, 0.0)), (lower, (-lower_bar.centre, 0.0)))
    _revolute(mbs, (lower, (lower_bar.length - lower_bar.centre, 0.0)), (upper, (-upper_bar.centre, 0.0)))
    _revolute(
        mbs, (upper, (turned[0] - upper_bar.centre, turned[1])), (rod, (rod_bar.length - rod_bar.centre, 0.0))
    )
    _revolute(mbs, (ground, linkage.rod_pivot), (rod, (-rod_bar.centre, 0.0)))
    _lead(mbs, mechanism, guide, upper, linkage.upper.length - upper_bar.centre)
    if mechanism.torque is not None:
        for body in bodies:
            marker = mbs.AddMarker(eii.MarkerBodyMass(bodyNumber=body))
            mbs.AddLoad(eii.LoadMassProportional(markerNumber=marker, loadVector=[0.0, -GRAVITY, 0.0]))
        marker = mbs.AddMarker(eii.MarkerBodyRigid(bodyNumber=lower))
        sense = float(np.sign(linkage.rise(mechanism.angle(0.0))))
        pull = [0.0, 0.0, sense * float(mechanism.torque)]
        mbs.AddLoad(eii.LoadTorqueVector(markerNumber=marker, loadVector=pull))
    return FrameParts(mechanism, (nodes[0], nodes[1], nodes[2]), guide)


def _bars(linkage: Linkage) -> tuple[Bar, Bar, Bar]:
    """Lower arm, upper arm with the apex mass, and rod."""
    upper, apex = linkage.upper, linkage.apex_mass
    mass = upper.mass + apex
    centre = (upper.mass * upper.centre + apex * upper.length) / mass if mass else 0.0
    inertia = upper.inertia + upper.mass * (upper.centre - centre) ** 2 + apex * (upper.length - centre) ** 2
    return linkage.lower, Bar(upper.length, mass, centre, inertia), linkage.rod


def _places(mechanism: Mechanism, risen: float) -> list[Floats]:
    """Of each bar its centre [m] and angle [rad], the apex so many metres above its place at rest."""
    linkage = mechanism.linkage
    pose = linkage.pose(mechanism.angle(risen))
    found = []
    for bar, begin, angle in zip(
        _bars(linkage),
        (np.zeros(2), pose.knee, np.array(linkage.rod_pivot)),
        (pose.lower, pose.upper, pose.rod),
        strict=True,
    ):
        turn = float(angle)
        found.append(np.array([*(begin + bar.centre * np.array([np.cos(turn), np.sin(turn)])), turn]))
    return found


def _revolute(mbs: exu.MainSystem, first: tuple[Any, Any], second: tuple[Any, Any]) -> None:
    markers = [
        mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body, localPosition=[*map(float, place), 0.0]))
        for body, place in (first, second)
    ]
    mbs.AddObject(eii.ObjectJointRevolute2D(markerNumbers=markers))


def _lead(mbs: exu.MainSystem, mechanism: Mechanism, guide: int, upper: int, ahead: float) -> None:
    """Let the guide's coordinate and the apex rise together; along the track the apex is free."""
    apex = [*mechanism.linkage.pose(mechanism.angle(0.0)).apex.tolist(), 0.0]
    point = eii.ObjectMass1D(
        mass=_LIGHT,
        nodeNumber=guide,
        referencePosition=apex,
        referenceRotation=[[0, -1, 0], [1, 0, 0], [0, 0, 1]],
    )
    body = mbs.AddObject(point)
    markers = [
        mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body)),
        mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=upper, localPosition=[ahead, 0.0, 0.0])),
    ]
    mbs.AddObject(
        eii.ObjectConnectorCartesianSpringDamper(markerNumbers=markers, stiffness=[0.0, _GUIDE, 0.0])
    )
