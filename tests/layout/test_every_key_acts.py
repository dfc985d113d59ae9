"""Every key of every file acts, is refused, or is warned of: each one's value is changed once.

The schemas say which keys there are. A key that is new there has no value here, and fails.
"""

import copy
import tomllib
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import catenary_fe as cf
from catenary_fe.fe.reduction import linear_model
from catenary_fe.layout import layout_schema, layout_warnings
from catenary_fe.layout.files import LayoutFile
from catenary_fe.views.report.tables import _line_table, _wire_table

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


def test_a_value_is_known_for_every_key():
    several = ("further_sections.", "overlap.")  # in a file of their own
    found = {key for key in keys(layout_schema(), layout_schema()) if not key.startswith(several)}
    assert sorted(found) == sorted(LAYOUT)


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
