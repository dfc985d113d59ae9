"""Every key of every file acts, is refused, or is warned of: each one's value is changed once.

The schemas say which keys there are. A key that is new there has no value here, and fails.
"""

import copy
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.fe.reduction import linear_model
from catenary_fe.layout import layout_schema, layout_warnings, pantograph_schema
from catenary_fe.layout.files import LayoutFile
from catenary_fe.views.report.tables import _line_table, _pantograph_table, _wire_table

EXAMPLES = Path(__file__).parents[2] / "docs/reference/examples"
PLANE = """
name = "two spans in the plane"
evaluated_spans = [2]
equipment = [{ x = 20.0, mass = 8.0, length = 2.0, bending_stiffness = 2e3 }]
contact_wire = { library = "AC-120 CuMg", tension = 15e3 }
messenger_wire = { library = "BzII 70", tension = 12e3, bending_stiffness = 50.0 }
damping = { alpha = 0.01, beta = 1e-4 }
wear = [{ begin = 5.0, end = 20.0, area_left = 0.9 }]
dropper = { stiffness = 1e5, damping = 5.0, mass_per_length = 0.1, messenger_clamp_mass = 0.1 }
[support]
messenger_stiffness = 5e5
messenger_damping = 10.0
steady_arm = { stiffness = 200.0, mass = 0.5, damping = 5.0, preload = 150.0, holds_design_height = false }
[begin]
kind = "fixed"
[end]
kind = "weights"
[[span]]
length = 30.0
droppers = [6.0, 15.0, { position = 24.0, contact_wire_clamp_mass = 0.1 }]
count = 2
"""
SPACE = """
name = "two spans in a curve"
stagger = 0.2
curve_radius = 900.0
contact_wire = { mass_per_length = 1.1, axial_stiffness = 1e7, bending_stiffness = 100.0, tension = 15e3 }
messenger_wire = { mass_per_length = 0.6, axial_stiffness = 8e6, tension = 12e3 }
[support]
messenger_lateral_stiffness = 1e5
messenger_lateral_damping = 10.0
cant = 0.05
[support.steady_arm]
length = 1.0
mass_per_length = 0.7
clamp_mass = 0.2
inclination = 0.1
[[span]]
length = 30.0
droppers = [6.0, 15.0, 24.0]
count = 2
"""
MANY_WIRES = """
name = "two contact wires, stitch wires"
spatial = true
system_height = 1.6
contact_wire_spacing = 0.04
contact_wire = { mass_per_length = 1.1, axial_stiffness = 1e7, tension = 15e3 }
messenger_wire = { mass_per_length = 0.6, axial_stiffness = 8e6, tension = 14e3 }
support = { steady_arm = { stiffness = 200.0 } }
[stitch_wire]
library = "BzII 35"
tension = 2.5e3
length = 14.0
[[span]]
length = 40.0
droppers = [4.0, 12.0, 20.0, 28.0, 36.0]
count = 2
"""
BASES = {name: tomllib.loads(text) for name, text in
         (("plane", PLANE), ("space", SPACE), ("many wires", MANY_WIRES))}  # fmt: skip

WIRE = {
    "mass_per_length": 1.3, "tension": 13e3, "axial_stiffness": 9e6, "bending_stiffness": 150.0,
    "name": "another", "source": "elsewhere", "library": "BzII 120",
    "diameter": 0.02, "thermal_expansion": 2e-5,
}  # fmt: skip
ARM = {
    "stiffness": 300.0, "mass": 0.8, "damping": 9.0, "length": 1.2, "mass_per_length": 1.0, "clamp_mass": 0.4,
    "inclination": 0.15, "side": "left", "holds_design_height": False, "preload": 170.0, "uplift_room": 0.1,
}  # fmt: skip
SUPPORT = {
    "messenger_stiffness": 4e5, "messenger_damping": 20.0, "messenger_lateral_stiffness": 2e5,
    "messenger_lateral_damping": 20.0, "system_height": 1.3, "contact_wire_height": 5.495,
    "stagger": 0.1, "messenger_stagger": 0.05,
    "stitch_wire": False, "stitch_wire_length": 12.0, "cant": 0.1, "mast_position": 3.5,
}  # fmt: skip
DROPPER = {
    "position": 7.0, "length": 0.9, "stiffness": 2e5, "damping": 9.0, "mass_per_length": 0.2,
    "messenger_clamp_mass": 0.3, "contact_wire_clamp_mass": 0.3, "height_offset": -0.005, "contact_wire": 2,
    "state": "missing", "clamp_shift": 0.2,
}  # fmt: skip
LAYOUT: dict[str, Any] = {
    "name": "another", "source": "elsewhere", "contact_wire_spacing": 0.06, "stagger": 0.25,
    "curve_radius": 700.0, "contact_wire_height": 5.5, "system_height": 1.3, "evaluated_spans": [1],
    "spatial": True, "damping.alpha": 0.02, "damping.beta": 2e-4,
    "equipment.x": 22.0, "equipment.span": 1, "equipment.position": 3.0, "equipment.mass": 9.0,
    "equipment.wire": "messenger wire", "equipment.length": 1.5, "equipment.bending_stiffness": 3e3,
    "equipment.name": "an insulator", "equipment.source": "elsewhere",
    "wear.begin": 8.0, "wear.end": 25.0, "wear.span": 1, "wear.area_left": 0.8, "wear.contact_wire": 2,
    "wear.transition": 2.0, "as_built.contact_wire_tension": 0.03, "as_built.messenger_wire_tension": -0.03,
    "as_built.stagger": 0.02, "as_built.messenger_wire_height": 0.02,
    "as_built.dropper_length": {"deviation": 0.002, "seed": 3},
    "as_built.contact_wire_height": [[0.0, 0.0], [40.0, 0.01]], "as_built.pre_sag": 0.01,
    "cant_base": 1.1, "installation_temperature": 5.0, "span.curve_radius_end": 500.0,
    "span.length": 32.0, "span.pre_sag": 0.01, "span.curve_radius": 700.0, "span.count": 3, "supports.at": 3,
    "midpoint": 2, "midpoint_position": 35.0, "tension_loss": 0.01,
} | {
    f"{end}{wire}.{key}": value
    for end, kind in (("begin", "weights"), ("end", "fixed"))
    for wire in ("", ".contact_wire", ".messenger_wire")
    for key, value in {"kind": kind, "stiffness": 5e3, "ratio": 3.0, "efficiency": 0.95}.items()
} | {
    f"{place}.{key}": value
    for places, values in (
        (("contact_wire", "messenger_wire"), WIRE),
        (("stitch_wire",), WIRE | {"tension": 2e3, "length": 12.0, "clamp_mass": 0.2}),
        (("dropper", "span.droppers"), DROPPER),
        (("support", "supports"), SUPPORT),
        (("support.steady_arm", "supports.steady_arm"), ARM),
    )
    for place in places
    for key, value in values.items()
}  # fmt: skip
PANTOGRAPH: dict[str, Any] = {
    "name": "another", "source": "elsewhere", "stages.mass": 8.0, "stages.stiffness": 5e3,
    "stages.damping": 20.0, "stages.damping_up": 5.0, "stages.damping_down": 140.0, "stages.friction": 3.0,
    "stages.travel": [0.03, 0.04], "stages.stop_stiffness": 2e5,
    "uplift_force": 130.0, "mean_force": "EN 50367 DC 3 kV",
    "aerodynamic_force.quadratic": 0.02, "aerodynamic_force.linear": 0.2, "contact_stiffness": 6e4,
    "contact_damping": 5.0, "base": "rail", "head.width": 1.0, "head.spring_distance": 0.6,
    "head.roll_inertia": 2.0,
    "head.strips": 1, "head.strip_distance": 0.4,
}  # fmt: skip
ELASTIC: dict[str, Any] = {
    "base": "rail",
    "force": 250.0,
    "stiffness": 900.0,
    "law": [[0.0, 150.0], [0.1, 90.0]],
}
RECEPTANCE: dict[str, Any] = {"receptance": "", "order": 1, "static_stiffness": 0.0, "head_width": 1.9}
LINKAGE: dict[str, Any] = {
    "lower_arm.length": 1.55, "lower_arm.mass": 25.0, "lower_arm.centre": 0.7, "lower_arm.inertia": 6.0,
    "upper_arm.length": 2.1, "upper_arm.mass": 15.0, "upper_arm.centre": 0.8, "upper_arm.inertia": 5.0,
    "upper_arm.lever": 0.21, "upper_arm.lever_angle": 3.4,
    "coupling_rod.length": 1.66, "coupling_rod.mass": 6.0, "coupling_rod.centre": 0.8,
    "coupling_rod.inertia": 1.0, "coupling_rod.pivot": [-0.2, -0.3], "apex_mass": 7.0,
    "head_stages.mass": 8.0, "head_stages.stiffness": 5e3, "head_stages.damping": 20.0,
    "pivot_height": 3.8, "head_height": 0.1, "working_height": 5.2, "reach": [0.5, 2.5],
    "stop_stiffness": 2e5, "drive.torque": 1400.0, "drive.bellows_stiffness": 200.0, "drive.lag": 0.3,
    "damper.up": 500.0, "damper.down": 500.0, "joint_friction": 1.0,
    "head_stages.damping_up": 5.0, "head_stages.damping_down": 5.0, "head_stages.friction": 2.0,
    "head_stages.travel": [0.03, 0.04], "head_stages.stop_stiffness": 1e5,
}  # fmt: skip


def keys(schema: dict[str, Any], node: dict[str, Any], place: str = "") -> Iterator[str]:
    """Places of all values that a schema knows, without the numbers of lists."""
    node = schema["$defs"][node["$ref"].rsplit("/", 1)[1]] if "$ref" in node else node
    if "properties" in node:
        for name, inner in node["properties"].items():
            yield from keys(schema, inner, f"{place}.{name}" if place else name)
        return
    branches = node.get("anyOf", []) + node.get("allOf", [])  # the latter by old versions of pydantic
    branches += [node["items"]] if "items" in node else []
    tables = [b for b in branches if "$ref" in b or "items" in b]
    inside = [k for b in tables for k in keys(schema, b, place)]
    yield from inside or [place]


@pytest.mark.parametrize(
    ("schema", "known"),
    [(layout_schema(), LAYOUT), (pantograph_schema(), PANTOGRAPH | ELASTIC | RECEPTANCE | LINKAGE)],
)
def test_a_value_is_known_for_every_key(schema, known):
    several = ("further_sections.", "overlap.")  # below
    found = {key for key in keys(schema, schema) if not key.startswith(several)}
    assert sorted(found) == sorted(known)


def put(record: dict[str, Any], place: str, value: Any) -> dict[str, Any]:
    """A copy of a record with one value changed; of lists, in the first member."""
    record = copy.deepcopy(record)
    *parents, last = place.split(".")
    owner = record
    for name in parents:
        inner = owner.setdefault(name, [{"at": 2}] if name == "supports" else {})
        if isinstance(inner, list):
            if not isinstance(inner[0], dict):
                inner[0] = {"position": inner[0]}
            inner = inner[0]
        owner = inner
    owner[last] = value
    return record


def line_of(record: dict[str, Any]) -> cf.Catenary:
    try:
        return LayoutFile.model_validate(record).catenary()
    except ValueError as error:
        assert isinstance(error, cf.InputError) or "validation error" in str(error)
        raise cf.InputError(str(error)) from None


def shown(line: cf.Catenary) -> str:
    """What a report says of a line."""
    return str((line.name, _line_table(line), _wire_table(line)))


def computed(line: cf.Catenary) -> Iterator[Any]:
    """What a line results in, cheap things first: if one of these differs, more need not be looked at."""
    yield line.spans_to_evaluate
    yield [support.steady_arm and support.steady_arm.uplift_room for support in line.supports[1:-1]]
    shape = cf.find_form(line)
    yield shape.dropper_schedule()
    yield [wire.z.round(9).tolist() for wire in shape.wires]
    yield [wire.irregularity and float(wire.irregularity.values.sum()) for wire in shape.system.wires]
    model = linear_model(shape.system)
    weights = np.cos(np.arange(model.size))
    for matrix in (model.mass, model.damping, model.stiffness):
        yield float(weights @ (matrix @ weights))
    wind = cf.Wind(speed=15.0) if line.is_spatial else None
    settled = cf.settle(shape, cf.Conditions(temperature=40.0, wind=wind))
    yield [(wire.x.round(6).tolist(), wire.y.round(6).tolist()) for wire in settled.wires]


@pytest.fixture(scope="module")
def results() -> dict[str, list[Any]]:
    """Of the base layouts, as far as they were asked for."""
    return {name: list(computed(line_of(record))) for name, record in BASES.items()}


def outcome(base: str, place: str, results: dict[str, list[Any]]) -> str:
    """What a change of one key's value does on a base layout."""
    before = line_of(BASES[base])
    try:
        line = line_of(put(BASES[base], place, LAYOUT[place]))
        if line == before:
            return "read and not used"
        if place.split(".")[-1] in ("name", "source"):
            return "shown" if shown(line) != shown(before) else "silent"
        differ = any(a != b for a, b in zip(computed(line), results[base], strict=True))
    except cf.InputError:
        return "refused"
    if differ:
        return "acts"
    return "warned of" if layout_warnings(line) != layout_warnings(before) else "silent"


# where a key is not active in the plane
ELSEWHERE = {
    "contact_wire_spacing": "many wires", "stitch_wire": "many wires", "contact_wire": "many wires",
    "stagger": "space", "curve_radius": "space", "messenger_lateral_stiffness": "space",
    "messenger_lateral_damping": "space", "messenger_stagger": "space", "length": "space",
    "mass_per_length": "space", "clamp_mass": "space", "inclination": "space", "side": "space",
    "holds_design_height": "many wires", "stitch_wire_length": "many wires", "cant": "space",
    "cant_base": "space", "curve_radius_end": "space", "mast_position": "space",
    "diameter": "space",
}  # fmt: skip
REFUSED = {
    "wear.span": "beside begin and end", "wear.contact_wire": "there is one",
    "equipment.span": "beside x", "equipment.position": "beside x",
    "dropper.position": "each span has its own", "support.stagger": "the layout's alternates",
    "support.steady_arm.side": "half of the links would push", "span.droppers.length": "others have none",
}  # fmt: skip


REFUSED |= {
    f"{end}{wire}.{key}": "not of this kind"
    for end in ("begin", "end")
    for wire in ("", ".contact_wire", ".messenger_wire")
    for key in ("kind", "stiffness", "ratio", "efficiency")
    if ((end, wire) != ("end", "") and key != "kind") or end == "begin" or (wire, key) == ("", "stiffness")
} | {"midpoint": "one end is fixed", "midpoint_position": "likewise"}


def base_of(place: str) -> str:
    owner, _, last = place.rpartition(".")
    if owner.endswith("wire") or owner in ("span", "dropper", "span.droppers", "equipment", "wear"):
        of_owner = {"stitch_wire": "many wires"}.get(owner, "plane")
        return (
            ELSEWHERE.get(last, "plane")
            if owner not in ("wear", "stitch_wire")
            and last in ("contact_wire", "curve_radius", "curve_radius_end", "diameter")
            else of_owner
        )
    return ELSEWHERE.get(last, "plane")


@pytest.mark.parametrize("place", [p for p in LAYOUT if not p.startswith(("supports.", "span.droppers."))])
def test_a_key_of_a_layout_acts(place, results):
    expected = "shown" if place.split(".")[-1] in ("name", "source") else "acts"
    assert outcome(base_of(place), place, results) == ("refused" if place in REFUSED else expected)


def droppers(line: cf.Catenary) -> list[cf.Dropper]:
    """Those of the design."""
    return [dropper for span in line.spans for dropper in span.droppers]


@pytest.mark.parametrize("place", [p for p in LAYOUT if p.startswith(("supports.", "span.droppers."))])
def test_a_key_of_one_support_or_dropper_reaches_it(place):
    """What it does there is what it does in all."""
    base = BASES[base_of(place)]
    before, line = line_of(base), line_of(put(base, place, LAYOUT[place]))
    if place == "supports.at":
        assert line == before  # an entry with nothing in it
        return
    parts = (
        (line.supports, before.supports)
        if place.startswith("supports")
        else (droppers(line), droppers(before))
    )
    changed = [a for a, b in zip(*parts, strict=True) if a != b]
    found = changed[0].steady_arm if "steady_arm" in place else changed[0]
    assert getattr(found, place.split(".")[-1]) == LAYOUT[place]
    assert len(changed) == (1 if place.startswith("supports") else 2)  # in both spans of this kind


STRIPS = {"spring_distance": 0.7, "strips": 2, "strip_distance": 0.5}
STAGES = [{"mass": 7.0, "stiffness": 4e3, "damping": 10.0}, {"mass": 14.0, "stiffness": 50.0}]
PUSHED = {"name": "pushed", "uplift_force": 120.0, "stages": STAGES, "head": STRIPS}
BESIDE: dict[str, dict[str, Any]] = {
    "damping_up": {"damping": 0.0, "damping_up": 20.0, "damping_down": 30.0},
    "damping_down": {"damping": 0.0, "damping_up": 20.0, "damping_down": 30.0},
    "stop_stiffness": {"travel": [0.02, 0.02]},
}
SET = {"name": "set", "mean_force": "EN 50367 AC", "stages": STAGES}


def known_of(pantograph: cf.Pantograph) -> list[Any]:
    """What is computed from a pantograph before it runs."""
    found = [pantograph.assemble(spatial=True)]
    return [*found, pantograph.static_uplift(70.0), pantograph.target_mean_force(70.0)]


@pytest.mark.parametrize("place", PANTOGRAPH)
def test_a_key_of_a_pantograph_acts(place):
    base: dict[str, Any] = SET if place == "mean_force" else PUSHED
    key = place.removeprefix("stages.")
    if key in BESIDE:  # they act with another one
        base = base | {"stages": [STAGES[0] | BESIDE[key], STAGES[1]]}
    before, changed = cf.Pantograph(**base), put(base, place, PANTOGRAPH[place])
    if place == "head.strips":
        with pytest.raises(cf.InputError, match="strips = 2 and strip_distance belong together"):
            cf.Pantograph(**changed)
        return
    after = cf.Pantograph(**changed)
    if place in ("name", "source"):
        assert str(_pantograph_table(after.name, after)) != str(_pantograph_table(before.name, before))
    else:
        assert known_of(after) != known_of(before)


@pytest.mark.parametrize("key", ELASTIC)
def test_a_key_of_an_elastic_pantograph_acts(key):
    base: dict[str, Any] = {"force": 200.0, "stiffness": 500.0}
    changed = {key: ELASTIC[key]} if key == "law" else base | {key: ELASTIC[key]}
    before, after = (cf.ElasticPantograph.model_validate(record) for record in (base, changed))
    assert before.assemble(spatial=False) != after.assemble(spatial=False)
    if key == "law":  # beside a force, it is refused
        with pytest.raises(cf.InputError, match="give exactly one"):
            cf.ElasticPantograph(**base, law=ELASTIC["law"])


@pytest.mark.parametrize(
    "key", ["receptance", "order", "static_stiffness", "head_width", "base", "uplift_force"]
)
def test_a_key_of_a_pantograph_by_its_receptance_acts(key):
    frequencies = [0.2 * 1.2**n for n in range(30)]
    response = cf.pantograph_response(cf.Pantograph(**(PUSHED | {"head": None})), frequencies).as_dict()
    rows = [list(row) for row in zip(*response["receptance"].values(), strict=True)]
    base: dict[str, Any] = {"receptance": rows, "uplift_force": 100.0}
    values = RECEPTANCE | {"receptance": [[f, 0.9 * z, phase] for f, z, phase in rows]} | PANTOGRAPH
    before, after = (cf.ReceptancePantograph(**record) for record in (base, base | {key: values[key]}))
    assert (*known_of(before), before.panhead) != (*known_of(after), after.panhead)


@pytest.mark.parametrize("place", LINKAGE)
def test_a_key_of_a_mechanism_acts(place):
    base = tomllib.loads((EXAMPLES / "pantograph_linkage.toml").read_text(encoding="utf-8"))
    before = cf.LinkagePantograph.model_validate(base)
    changed = put(base, place, LINKAGE[place])
    beside = {"drive.torque": "give exactly one", "head_stages.damping_up": "give both or neither",
              "head_stages.damping_down": "give both or neither",
              "head_stages.stop_stiffness": "give both or neither"}  # fmt: skip
    if place in beside:
        with pytest.raises(cf.InputError, match=beside[place]):
            cf.LinkagePantograph(**changed)
        if place != "drive.torque":
            return
        changed.pop("mean_force")
    after = cf.LinkagePantograph.model_validate(changed)
    assert known_of(after) != known_of(before)
