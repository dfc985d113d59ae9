"""Exudyn's model of a line in a script's hands: another law of the droppers, a pantograph of own bodies.

Run it with ``python models/studies/own_exudyn_model.py``; it takes a minute and prints what each change
makes of the contact force.
"""

from __future__ import annotations

from pathlib import Path

import exudyn as exu
import exudyn.itemInterface as eii
from exudyn.advancedUtilities import CreateSymbolicUserFunction

import catenary_fe as cf

LAYOUT = Path(__file__).parents[1] / "layouts" / "en50318_2002.toml"
SPEED, START = 280 / 3.6, 10.0  # m/s, m
UPLIFT = 120.0  # N
TIME = cf.TimeSettings(step=2e-3)
SLACK = 0.5e-3  # m of stretch over which the strands of a dropper's rope straighten
STOP = 5e-3  # m by which the head's suspension moves from rest until it meets a stop
UPWARD = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]  # turns a Mass1D, which moves along x, up in the vertical plane


def rope(mbs, t, item, stretch, rate, stiffness, damping, force):  # type: ignore[no-untyped-def]
    """[N] of a rope that tightens by and by instead of at once."""
    return 0.5 * stiffness * (stretch + exu.symbolic.sqrt(stretch * stretch + SLACK**2))


def with_ropes(shape: cf.Shape, pantograph: cf.Pantograph) -> cf.Run:
    """A run over droppers with the law of :func:`rope`."""
    model = cf.exudyn_model(shape, [pantograph])
    kind = "ObjectConnectorSpringDamper"
    law = CreateSymbolicUserFunction(model.mbs, rope, "springForceUserFunction", itemTypeName=kind)
    model.mbs.variables["rope"] = law  # the function must live as long as the model
    for dropper in model.droppers:
        model.mbs.SetObjectParameter(dropper, "springForceUserFunction", law)
    return run(shape, [pantograph], model)


def add_masses(model: cf.ExudynModel, pantograph: cf.Pantograph, stop: float | None) -> list[int]:
    """Two masses on springs, the upper one's with stops; returns position markers on them."""
    mbs, shape = model.mbs, model.shape
    nominal = shape.catenary.contact_wire_height
    lift = float(shape.contact_wire_height(START)) - nominal + 2e-3  # a little into the wire
    points, heights = [], []
    for stage in pantograph.stages:
        node = mbs.AddNode(eii.Node1D(referenceCoordinates=[0.0], initialCoordinates=[lift]))
        body = mbs.AddObject(
            eii.ObjectMass1D(
                mass=stage.mass,
                nodeNumber=node,
                referencePosition=[0.0, nominal, 0.0],
                referenceRotation=UPWARD,
            )
        )
        points.append(int(mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body))))
        heights.append(mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=0)))
    head, frame = pantograph.stages
    at_rest = UPLIFT / head.stiffness  # by which the suspension is pressed together at rest
    suspension = {"markerNumbers": [heights[1], heights[0]], "stiffness": head.stiffness}
    if stop is not None:
        suspension |= {
            "nodeNumber": mbs.AddNode(
                eii.NodeGenericData(numberOfDataCoordinates=3, initialCoordinates=[0.0] * 3)
            ),
            "useLimitStops": True,
            "limitStopsUpper": stop - at_rest,
            "limitStopsLower": -stop - at_rest,
            "limitStopsStiffness": 1e5,
        }
    mbs.AddObject(eii.ObjectConnectorCoordinateSpringDamperExt(damping=head.damping, **suspension))
    mbs.AddObject(
        eii.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[model.ground, heights[1]], stiffness=frame.stiffness, damping=frame.damping
        )
    )
    mbs.AddLoad(eii.LoadCoordinate(markerNumber=heights[1], load=UPLIFT))
    return points


def with_own_bodies(shape: cf.Shape, pantograph: cf.Pantograph, stop: float | None = STOP) -> cf.Run:
    """A run with two masses of this script's own in the place of the pantograph's."""
    model = cf.exudyn_model(shape)
    points = add_masses(model, pantograph, stop)
    stiffness = pantograph.contact_stiffness
    model.attach("head on stops", points[:1], contact_stiffness=stiffness, masses=points)
    return run(shape, [], model)


def run(shape: cf.Shape, pantographs: list[cf.Pantograph], model: cf.ExudynModel | None) -> cf.Run:
    """A run of a model, or of the line as it is."""
    return cf.simulate(
        shape, pantographs, speed=SPEED, positions=[START], time=TIME, method="exudyn", model=model
    )


def main() -> None:
    """Compare."""
    line = cf.load_catenary(LAYOUT)
    line = line.replace(spans=line.spans[:5], supports=line.supports[:6], evaluated_spans=(3, 4))
    shape = cf.find_form(line)
    pantograph = cf.library.pantograph("EN 50318:2002").with_uplift(UPLIFT)
    for name, compute in (
        ("as it is", lambda: run(shape, [pantograph], None)),
        ("droppers that tighten by and by", lambda: with_ropes(shape, pantograph)),
        ("own bodies, without stops", lambda: with_own_bodies(shape, pantograph, None)),
        (f"own bodies, stops at {1e3 * STOP:g} mm", lambda: with_own_bodies(shape, pantograph)),
    ):
        force = compute().contact_force_statistics()[0]
        print(f"{name:34s} mean {force.mean:6.1f} N, standard deviation {force.std:5.1f} N", flush=True)


if __name__ == "__main__":
    main()
