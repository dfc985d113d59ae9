"""A pantograph whose frame is a mechanism: against virtual work, its lumped equivalent, and rigid bodies."""

from importlib import util

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.layout.pantograph import recorded_pantograph
from tests.conftest import LAYOUTS

GRAVITY = 9.81
FRAME = {
    "name": "frame",
    "pivot_height": 3.9,
    "head_height": 0.12,
    "apex_mass": 6.0,
    "lower_arm": {"length": 1.6, "mass": 30.0, "centre": 0.75, "inertia": 7.0},
    "upper_arm": {
        "length": 2.19, "mass": 14.0, "centre": 0.9, "inertia": 6.0, "lever": 0.2, "lever_angle": 3.376,
    },
    "coupling_rod": {"length": 1.67, "mass": 5.0, "centre": 0.83, "inertia": 1.2, "pivot": (-0.2, -0.32)},
    "head_stages": [{"mass": 7.2, "stiffness": 4200.0, "damping": 10.0}],
    "damper": {"up": 700.0, "down": 700.0},
}  # fmt: skip
TORQUE = {"drive": {"torque": 1500.0}}


def linkage(**changes) -> cf.LinkagePantograph:
    force = {} if changes.get("drive", {}).get("torque") else {"uplift_force": 120.0}
    return cf.LinkagePantograph.model_validate(FRAME | force | changes)


@pytest.fixture(scope="module")
def shape() -> cf.Shape:
    line = cf.load_catenary(LAYOUTS / "en50318_2002.toml")
    part = {"spans": line.spans[:4], "supports": line.supports[:5], "evaluated_spans": (2, 3)}
    return cf.find_form(line.replace(**part))


def on_a_ramp() -> cf.Shape:
    """Six short spans, of whose contact wire the last five come down by six tenths of a metre."""
    line = cf.load_catenary(LAYOUTS / "en50318_2002.toml")
    heights = [5.3, 5.3, 5.18, 5.06, 4.94, 4.82, 4.7]
    droppers = [d.replace(position=d.position * 30 / 60) for d in line.spans[0].droppers]
    spans = [line.spans[0].replace(length=30.0, droppers=tuple(droppers))] * 6
    supports = [line.supports[2].replace(contact_wire_height=z) for z in heights]
    return cf.find_form(line.replace(spans=spans, supports=supports, evaluated_spans=(3, 4)))


@pytest.mark.parametrize("height", [4.6, 5.3, 6.1])
def test_mass_and_force_at_a_height_by_virtual_work(height):
    """½ M ż² and the potential of weights and torque, by differences of the bars' places."""
    given = linkage(**TORQUE, working_height=height)
    body, frame = given.assemble(spatial=False), given.linkage
    angle, h = frame.angle_at(height - 3.9 - 0.12), 1e-5

    def places(at):
        pose = frame.pose(at)
        along = [np.array([np.cos(t), np.sin(t)]) for t in (pose.lower, pose.upper, pose.rod)]
        return np.array(
            [
                0.75 * along[0],
                pose.knee + 0.9 * along[1],
                np.array([-0.2, -0.32]) + 0.83 * along[2],
                pose.apex,
            ]
        ), np.array([pose.lower, pose.upper, pose.rod])

    (up, turned), (down, before) = places(angle + h), places(angle - h)
    speed, turn = (up - down) / (2 * h), (turned - before) / (2 * h)
    masses = np.array([30.0, 14.0, 5.0, 6.0])
    energy = masses @ (speed**2).sum(axis=1) + np.array([7.0, 6.0, 1.2]) @ turn**2
    assert body.mass[-1, -1] == pytest.approx(energy / speed[3, 1] ** 2, rel=1e-6)
    assert body.mass[-1, -1] != pytest.approx(1.0001 * energy / speed[3, 1] ** 2, rel=1e-6)
    lift = 1500.0 / abs(speed[3, 1]) - GRAVITY * masses @ speed[:, 1] / speed[3, 1] - 7.2 * GRAVITY
    assert given.static_uplift(50.0) == pytest.approx(lift, rel=1e-6)
    assert given.static_uplift(50.0) != pytest.approx(1.0001 * lift, rel=1e-6)


def test_the_force_over_the_height_is_that_of_the_mechanism():
    """What the static law of its substructure leaves of the uplift, at any height."""
    given = linkage(**TORQUE)
    body, frame = given.assemble(spatial=False), given.linkage
    response = cf.pantograph_response(given)
    at = frame.angles_at(5.3 - 3.9 - 0.12 + response.height + response.force / 4200.0)  # its spring
    assert response.force == pytest.approx(given.lift(at), rel=1e-5)
    assert response.force_varies and body.stiffness[-1, -1] < 4200.0
    held = cf.pantograph_response(linkage())
    assert held.force == pytest.approx(np.full(held.force.size, 120.0), abs=1e-6)


def lumped_of(given: cf.LinkagePantograph) -> cf.Pantograph:
    body = given.assemble(spatial=False)
    frame = {"mass": body.mass[-1, -1], "stiffness": 0.0, "damping": body.damping[-1, -1] - 10.0}
    stages = [given.head_stages[0], cf.Stage(**frame)]
    return cf.Pantograph(name="lumped", base="rail", stages=stages, uplift_force=120.0)


@pytest.mark.parametrize("method", ["linearised", "nonlinear"])
def test_small_motions_are_those_of_the_lumped_equivalent(shape, method):
    given = linkage()
    heavier = lumped_of(given)
    heavier = heavier.replace(stages=[heavier.stages[0], heavier.stages[1].replace(mass=22.0)])
    sigma = [
        cf.simulate(shape, [each], speed=70.0, method=method).contact_force_statistics()[0].std
        for each in (given, lumped_of(given), heavier)
    ]
    assert sigma[0] == pytest.approx(sigma[1], rel=0.01)
    assert sigma[0] != pytest.approx(sigma[2], rel=0.01)


def balance(run: cf.Run) -> float:
    return float(np.abs(run.missing_energy).max() / run.data["lost_work"].values.max())


def test_energy_holds_with_friction_stops_and_a_bellows(shape):
    """Stops that are met, friction that slides, mass and force that change with the height."""
    given = linkage(
        **{"drive": {"torque": 1500.0, "bellows_stiffness": 300.0, "lag": 0.2}},
        joint_friction=10.0,
        reach=(1.28 - 0.02, 1.28 + 0.022),
        stop_stiffness=2e4,
    )
    run = cf.simulate(shape, [given], speed=70.0)
    frame = run.data["mass_height"].values[0, 1] - 5.3
    assert frame.max() > 0.022
    assert balance(run) < 0.01
    quiet = cf.simulate(shape, [given.replace(joint_friction=0.0)], speed=70.0)
    assert quiet.data["lost_work"].values[-1] != pytest.approx(run.data["lost_work"].values[-1], rel=0.02)


def test_large_motions_are_those_of_rigid_bodies_on_joints():
    """The frame goes down by half a metre, driven by a torque; σ and heights as of Exudyn's bodies."""
    shape, given = on_a_ramp(), linkage(**TORQUE)
    runs = [cf.simulate(shape, [given], speed=60.0, method=m) for m in ("nonlinear", "exudyn")]
    forces = [run.data["contact_force"].values[0] for run in runs]
    sigma = forces[0].std()
    assert forces[1].std() == pytest.approx(sigma, rel=0.005)
    assert np.sqrt(np.mean((forces[0] - forces[1]) ** 2)) < 0.02 * sigma
    heights = [run.data["mass_height"].values[0, 1] for run in runs]
    assert heights[0] == pytest.approx(heights[1], abs=2e-4)
    assert heights[0].max() - heights[0].min() > 0.45
    linear = lumped_of(given).replace(uplift_force=given.static_uplift(60.0))
    of_lumped = cf.simulate(shape, [linear], speed=60.0).data["contact_force"].values[0]
    assert of_lumped.std() != pytest.approx(sigma, rel=0.02)


def test_it_is_read_written_and_shown(tmp_path):
    path = LAYOUTS.parents[1] / "docs/reference/examples/pantograph_linkage.toml"
    given = cf.load_pantograph(path)
    assert isinstance(given, cf.LinkagePantograph)
    assert recorded_pantograph(given.model_dump(mode="json")) == given
    assert given.kind == "linkage" and given.masses[0] == 7.2 and 10 < given.masses[1] < 20
    assert dict(given.in_words())["damper of the frame"] == "600 N m s/rad up and 900 down"
    body = given.assemble(spatial=False)
    assert len(body.bodies) == 3 and len(body.laws) == 5  # frame, damper, friction, two stops


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"pivot_height": 5.3}, "the frame does not stand at working_height = 5.3 m: the apex reaches 0.3"),
        ({"coupling_rod": {"length": 0.1, "pivot": (-0.2, -0.32)}}, "do not close"),
        ({"reach": (0.1, 2.0)}, "must rise, and lie within what the mechanism reaches, 0.371 to 3.689 m"),
        ({"stop_stiffness": 1e5}, "stop_stiffness has no effect without reach"),
        ({"drive": {"torque": 1500.0}, "uplift_force": 100.0}, "give exactly one"),
        ({"drive": {"bellows_stiffness": 100.0}}, "bellows_stiffness and lag belong together"),
        ({"drive": {"torque": [[1.0, 900.0]]}, "uplift_force": None}, "two rows at least"),
        ({"base": "contact wire"}, "base = 'contact wire': must be 'rail'"),
    ],
)
def test_what_is_refused(changes, said):
    with pytest.raises(cf.InputError, match=said):
        cf.LinkagePantograph(**(FRAME | {"uplift_force": 120.0} | changes))


def test_a_wire_out_of_reach_and_a_drive_that_does_not_lift_are_refused(shape):
    low = shape.catenary.replace(contact_wire_height=4.2)
    with pytest.raises(cf.InputError, match=r"the apex would be 0\.180 m above the base pivot"):
        cf.simulate(cf.find_form(low), [linkage()], speed=70.0)
    with pytest.raises(cf.InputError, match="drive, weight and air leave -"):
        cf.simulate(shape, [linkage(drive={"torque": 800.0})], speed=70.0)


def test_bodies_and_joints_of_a_script(shape):
    """The same frame by hand: the same force; what its damper adds is linear in its description alone."""
    spec = util.spec_from_file_location("own_linkage", LAYOUTS.parent / "studies/own_linkage.py")
    script = util.module_from_spec(spec)
    spec.loader.exec_module(script)
    script.TIME = cf.TimeSettings(step=2e-3)
    short = shape.catenary.replace(spans=shape.catenary.spans[:3], supports=shape.catenary.supports[:4],
                                   evaluated_spans=(2,))  # fmt: skip
    line = cf.find_form(short)
    for damper, apart in ((0.0, 1e-3), (700.0, 0.02)):
        frame = script.FRAME.replace(damper={"up": damper, "down": damper})
        described, own = (
            run.data["contact_force"].values[0]
            for run in (script.run(line, [frame], None), script.by_hand(line, frame))
        )
        assert np.std(own - described) < apart * np.std(described)
    heavier = script.by_hand(line, frame.replace(apex_mass=7.0)).data["contact_force"].values[0]
    assert np.std(heavier - own) > 0.02 * np.std(own)


@pytest.mark.parametrize("method", ["nonlinear", "linearised"])
def test_a_roof_that_moves_is_that_under_the_lumped_equivalent(shape, method):
    """Two centimetres once every ten metres; on a roof at rest the force is another one."""
    x = np.arange(0.0, 241.0, 0.25)
    roof = np.column_stack([x, 0.02 * np.sin(2 * np.pi * x / 10)]).tolist()
    day = cf.Conditions(base=cf.BaseMotion(height=roof))
    given = linkage()
    moved, lumped, still = (
        cf.simulate(shape, [head], speed=70.0, method=method, conditions=on).data["contact_force"].values[0]
        for head, on in ((given, day), (lumped_of(given), day), (given, None))
    )
    assert np.std(moved - lumped) < 0.02 * np.std(lumped)
    assert np.std(moved - still) > 0.1 * np.std(still)
