"""Exudyn's model in a script's hands: its parts, what is changed in it, bodies that are attached."""

import json
from importlib import util
from pathlib import Path

import exudyn.itemInterface as eii
import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.layout import AttachedPantograph
from catenary_fe.studies.rerun import rerun

SCRIPT = Path(__file__).parents[2] / "models" / "studies" / "own_exudyn_model.py"
SPEED, TIME = 75.0, cf.TimeSettings(step=2.5e-3, tolerance=1e-6)


def on_short_spans(path, length=24.0, count=4):
    """Three short spans of a layout's wires, which are run over in a second."""
    whole = cf.load_catenary(path)
    droppers = [
        whole.droppers[0].replace(position=(i + 0.5) * length / count, height_offset=None)
        for i in range(count)
    ]
    span = cf.Span(length=length, droppers=droppers)
    return whole.replace(spans=(span,) * 3, supports=whole.supports[:4], evaluated_spans=(2,))


@pytest.fixture(scope="module")
def shape(reference_layout):
    return cf.find_form(on_short_spans(reference_layout))


@pytest.fixture(scope="module")
def pushed(pantograph):
    return pantograph.with_uplift(120.0)


def simulate(shape, pantographs, model=None, **options):
    settings = {"speed": SPEED, "positions": [6.0], "time": TIME, "method": "exudyn"} | options
    return cf.simulate(shape, pantographs, model=model, **settings)


@pytest.fixture(scope="module")
def plain(shape, pushed):
    return simulate(shape, [pushed])


def forces(run):
    return run.data["contact_force"].values


def test_parts_go_by_station_and_name(shape, pushed):
    model = cf.exudyn_model(shape, [pushed])
    mbs, system = model.mbs, shape.system
    (wire,) = model.contact_wires
    assert (wire.name, model.messenger_wire.name) == ("contact wire", "messenger wire")
    assert model.stitch_wires == ()
    places = [mbs.GetNodeParameter(node, "referenceCoordinates")[0] for node in wire.nodes]
    assert places == pytest.approx(wire.x) and len(wire.elements) == wire.x.size - 1
    lengths = [mbs.GetObjectParameter(dropper, "referenceLength") for dropper in model.droppers]
    assert lengths == pytest.approx(shape.dropper_lengths)
    stiffness = mbs.GetObjectParameter(model.supports["messenger wire at 24.0 m, position up"], "stiffness")
    assert stiffness == shape.catenary.supports[1].messenger_stiffness
    assert "contact wire at 0.0 m, position along the track" in model.holds
    (parts,) = model.pantographs
    assert [mbs.GetObjectParameter(body, "mass") for body in parts.bodies] == [s.mass for s in pushed.stages]
    assert [mbs.GetObjectParameter(j, "stiffness") for j in parts.joints] == [
        s.stiffness for s in pushed.stages
    ]
    model.lift([90.0])
    (load, last), (contact,) = *parts.loads, parts.contacts
    assert (mbs.GetLoadParameter(load, "load"), last) == (90.0, len(pushed.stages) - 1)
    model.lift([90.0], bases=[(0.01, 0.2)])
    below = pushed.stages[-1]
    by_hand = 90.0 + 0.01 * below.stiffness + 0.2 * below.damping
    assert mbs.GetLoadParameter(load, "load") == pytest.approx(by_hand)
    model.place([25.0])
    element = int(mbs.GetMarkerParameter(contact.wire_marker, "bodyNumber"))
    begin, end = (wire.x[wire.nodes.index(int(n))] for n in mbs.GetObjectParameter(element, "nodeNumbers"))
    assert begin <= 25.0 <= end
    assert len(mbs.GetObjectParameter(model.loads, "forceVector")) == system.dof.size
    model.release()


def test_strips_on_one_spring_share_the_uplift(shape, pushed):
    head = cf.Panhead(strips=2, strip_distance=0.4)
    model = cf.exudyn_model(shape, [pushed.replace(stages=pushed.stages[:1], head=head)])
    model.lift([90.0])
    (parts,) = model.pantographs
    assert [model.mbs.GetLoadParameter(load, "load") for load, *_ in parts.loads] == [45.0, 45.0]
    assert [contact.ahead for contact in parts.contacts] == [0.2, -0.2]
    model.release()


def test_parts_in_space(reference_layout):
    """Bars at the masts, clamps of stitch wires, a head on two springs that meets each wire at its place."""
    folder = reference_layout.parent
    stitched = cf.load_catenary(folder / "en50318_2018_ac_stitched.toml")
    shape = cf.find_form(
        stitched.replace(spans=stitched.spans[:3], supports=stitched.supports[:4], evaluated_spans=(2,))
    )
    model = cf.exudyn_model(shape)
    assert (len(model.arms), len(model.stitch_wires)) == (2, 2)
    ends = {name.split(",")[0] for name in model.clamps}
    assert len(model.clamps) == 3 * 2 * 2 and len(ends) == 4
    model.release()
    twin = cf.find_form(on_short_spans(folder / "dc_3kv_twin.toml", count=8))
    head = cf.Panhead(width=1.6, strips=2, strip_distance=0.4, spring_distance=0.9)
    model = cf.exudyn_model(twin, [cf.library.pantograph("EN 50318:2018 AC").replace(head=head)])
    (parts,) = model.pantographs
    assert (len(model.contact_wires), len(parts.strips), len(parts.contacts)) == (2, 2, 4)
    model.place([30.0])
    lateral = [model.contacts.lateral(contact) for contact in parts.contacts]
    expected = [float(w.lateral(30.0 + ahead)) for ahead in (0.2, -0.2) for w in twin.contact_wires]
    assert lateral == pytest.approx(expected, abs=1e-4)
    model.release()


def test_a_model_that_was_not_changed_runs_as_the_line_does(shape, pushed):
    """And again; for longer than a second, which is the time that Exudyn's static solver ends at."""
    model, plain = cf.exudyn_model(shape, [pushed]), simulate(shape, [pushed], speed=50.0)
    first, second = (simulate(shape, [pushed], model, speed=50.0) for _ in range(2))
    model.release()
    assert plain.time[-1] > 1
    assert forces(first) == pytest.approx(forces(plain), abs=1e-3)  # static contact by Exudyn, to 1e-9
    dropper = first.data["dropper_force"].values
    assert dropper == pytest.approx(plain.data["dropper_force"].values, abs=3e-3)
    assert first.data.identical(second.data)


def test_another_law_of_droppers(shape, pushed, plain, tmp_path):
    def rod(mbs, t, item, stretch, rate, stiffness, damping, force):
        return stiffness * stretch

    model = cf.exudyn_model(shape, [pushed])
    for dropper in model.droppers:
        model.mbs.SetObjectParameter(dropper, "springForceUserFunction", rod)
    run = simulate(shape, [pushed], model)
    model.release()
    assert plain.data["dropper_force"].values.min() == 0
    assert run.data["dropper_force"].values.min() < -5
    assert np.std(forces(run) - forces(plain)) > 1
    assert run.method == "exudyn"
    assert run.data.attrs["input_sha256"] != plain.data.attrs["input_sha256"]
    (said,) = [w for w in run.warnings if "what the script changed or attached" in w]
    loaded = cf.load_run(run.save(tmp_path / "run.nc"))
    with pytest.raises(cf.InputError, match="to repeat the run, repeat the script"):
        rerun(loaded)
    assert not [w for w in plain.warnings if w == said]


def add_masses(model, pantograph, uplift, start=6.0):
    """The same pantograph of bodies of one's own; position markers on them."""
    mbs, nominal = model.mbs, model.shape.catenary.contact_wire_height
    lift = float(model.shape.contact_wire_height(start)) - nominal + 2e-3
    points, heights = [], []
    for stage in pantograph.stages:
        node = mbs.AddNode(eii.Node1D(referenceCoordinates=[0.0], initialCoordinates=[lift]))
        body = mbs.AddObject(
            eii.ObjectMass1D(
                mass=stage.mass, nodeNumber=node, referencePosition=[0, nominal, 0],
                referenceRotation=[[0, -1, 0], [1, 0, 0], [0, 0, 1]],
            )
        )  # fmt: skip
        points.append(int(mbs.AddMarker(eii.MarkerBodyPosition(bodyNumber=body))))
        heights.append(mbs.AddMarker(eii.MarkerNodeCoordinate(nodeNumber=node, coordinate=0)))
    for stage, upper, lower in zip(pantograph.stages, heights, [*heights[1:], model.ground], strict=True):
        spring = eii.ObjectConnectorCoordinateSpringDamper(
            markerNumbers=[lower, upper], stiffness=stage.stiffness, damping=stage.damping
        )
        mbs.AddObject(spring)
    mbs.AddLoad(eii.LoadCoordinate(markerNumber=heights[-1], load=uplift))
    return points


def test_bodies_of_ones_own_run_as_a_pantograph_does(shape, pushed, plain, tmp_path):
    model = cf.exudyn_model(shape)
    points = add_masses(model, pushed, 120.0)
    model.attach("mine", points[:1], contact_stiffness=pushed.contact_stiffness, masses=points)
    run = simulate(shape, [], model, store_wire=0.02)
    model.release()
    assert forces(run) == pytest.approx(forces(plain), abs=1e-3)
    assert run.data["mass_height"].values == pytest.approx(plain.data["mass_height"].values, abs=1e-7)
    loaded = cf.load_run(run.save(tmp_path / "run.nc"))
    record = AttachedPantograph(name="mine", contact_stiffness=50e3)
    assert loaded.pantographs == run.pantographs == (record,)
    assert json.loads(loaded.data.attrs["settings"])["time"]["step"] == TIME.step
    assert loaded.contact_force_statistics()[0].mean == pytest.approx(
        plain.contact_force_statistics()[0].mean, abs=1e-3
    )
    with pytest.raises(cf.InputError, match=r"mine: bodies of a script's own .* run the script again"):
        cf.simulate(shape, loaded.pantographs, speed=SPEED)


def test_beside_a_pantograph_of_the_layout(shape, pushed):
    """Strips one behind the other; the leading one is attached, and so comes last in the result."""
    model = cf.exudyn_model(shape, [pushed])
    points = add_masses(model, pushed, 120.0, start=24.0)
    model.attach("mine", points[:1], contact_stiffness=50e3, contact_damping=30.0, ahead=[0.3], masses=points)
    run = simulate(shape, [pushed], model, positions=[4.0, 23.7], speed=50.0)
    other = simulate(shape, [pushed, pushed.replace(contact_damping=30.0)], positions=[4.0, 24.0], speed=50.0)
    model.release()
    assert run.data["pantograph"].values.tolist() == [pushed.name, "mine"]
    assert run.data["uplift_force"].values.tolist() == [120.0, 0.0]
    n = run.time.size  # it ends 0.3 m later
    assert forces(run)[:, : n - 10] == pytest.approx(forces(other)[:, : n - 10], abs=2e-3)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"method": "nonlinear"}, "model with the method nonlinear: only the method 'exudyn'"),
        ({"energy": True}, "energy: not of a model that a script may have changed"),
    ],
)
def test_models_that_cannot_run(shape, pushed, options, said):
    model = cf.exudyn_model(shape, [pushed])
    with pytest.raises(cf.InputError, match=said):
        simulate(shape, [pushed], model, **options)
    model.release()


def test_a_model_of_another_line_or_pantograph(shape, pushed):
    model = cf.exudyn_model(shape, [pushed])
    with pytest.raises(cf.InputError, match="pantographs are not those of the model"):
        simulate(shape, [pushed.with_uplift(90.0)], model)
    with pytest.raises(cf.InputError, match="model is of another shape"):
        simulate(cf.find_form(shape.catenary), [pushed], model)
    with pytest.raises(cf.InputError, match="model = 3: must be a multibody model"):
        simulate(shape, [pushed], 3)
    (strip,) = model.pantographs[0].strips
    with pytest.raises(cf.InputError, match="mine: 1 strips and 2 distances ahead"):
        model.attach("mine", [strip], contact_stiffness=50e3, ahead=[0.0, 0.1])
    for bad in (10**6, -1, 0.5, "x", model.ground):
        with pytest.raises(cf.InputError, match=r"mine: strips: .* must be the number of a position marker"):
            model.attach("mine", [bad], contact_stiffness=50e3)
    with pytest.raises(cf.InputError, match="contact_stiffness"):
        model.attach("mine", [strip], contact_stiffness=0.0)
    model.release()
    with pytest.raises(cf.InputError, match="pantographs is empty"):
        empty = cf.exudyn_model(shape)
        simulate(shape, [], empty)


def test_bodies_that_find_no_contact_are_an_error(shape, pushed):
    """Masses without springs have no equilibrium."""
    model = cf.exudyn_model(shape)
    stages = tuple(stage.replace(stiffness=0.0) for stage in pushed.stages)
    points = add_masses(model, pushed.replace(stages=stages), 120.0)
    model.attach("mine", points[:1], contact_stiffness=50e3)
    with pytest.raises(cf.SolverError, match=r"static contact at the start: no static .* at the pantographs"):
        simulate(shape, [], model)
    model.release()


def test_a_law_of_points_holds_at_every_step(shape):
    """Also where the wire passes its corners."""
    law = cf.ElasticPantograph(law=((0.0, 160.0), (0.02, 140.0), (0.03, 90.0), (0.06, 60.0)))
    run = simulate(shape, [law])
    elevation = run.data["wire_height"].values[0] - shape.catenary.contact_wire_height
    for corner in (0.02, 0.03):
        assert elevation.min() < corner < elevation.max()
    assert forces(run)[0] == pytest.approx([law.contact_force(u) for u in elevation], abs=1e-6)


def test_the_script(shape, pantograph):
    spec = util.spec_from_file_location(SCRIPT.stem, SCRIPT)
    script = util.module_from_spec(spec)
    spec.loader.exec_module(script)
    script.START = 6.0
    pushed = pantograph.with_uplift(script.UPLIFT)
    plain = forces(script.run(shape, [pushed], None))
    ropes = forces(script.with_ropes(shape, pushed))
    assert 0.1 < np.std(ropes - plain) < 0.3 * np.std(plain)
    bodies = forces(script.with_own_bodies(shape, pushed, None))
    assert bodies == pytest.approx(plain, abs=0.02)  # at the tolerance of short steps
    stops = forces(script.with_own_bodies(shape, pushed))
    assert np.std(stops - plain) > 0.1
