"""Keys beside other keys: what changes nothing is warned of, what is at odds is refused."""

import tomllib

import pytest

import catenary_fe as cf
from catenary_fe.layout import layout_warnings
from tests.layout.test_every_key_acts import BASES, PLANE, line_of, put
from tests.layout.test_every_key_of_pantographs import SET

INERT = {  # values that change nothing on a line, and what is said
    "messenger_lateral_stiffness in the plane": (
        "plane", {"support.messenger_lateral_stiffness": 1e5}, "has no effect in the vertical plane"
    ),
    "no stitch wires": ("plane", {"support.stitch_wire": False}, "the line has no stitch wires"),
    "a length where no stitch wire hangs": (
        "plane", {"support.stitch_wire_length": 14.0}, "stitch_wire_length = 14 m has no effect"
    ),
    "no support for a stitch wire": (
        "many wires", {"support.stitch_wire": False}, "stitch_wire has no effect"
    ),
    "a sag between two droppers": (
        "plane", {"span.pre_sag": 0.05, "span.droppers": [6.0, 24.0]}, "pre_sag = 0.05 m has no effect"
    ),
    "a sag where heights are given": (
        "plane", {"span.pre_sag": 0.05, "dropper.height_offset": 0.0}, "pre_sag = 0.05 m has no effect"
    ),
    "an arm of a line's end": (
        "plane", {"supports.at": 1, "supports.steady_arm.stiffness": 900.0}, "support 1: steady_arm has no"
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", INERT)
def test_what_changes_nothing_is_warned_of(case):
    base, changes, said = INERT[case]
    record = BASES[base]
    for place, value in changes.items():
        record = put(record, place, value)
    assert layout_warnings(line_of(BASES[base])) == []
    (line,) = layout_warnings(line_of(record))
    assert said in line


COMBINED = {  # keys that are at odds, and what is said
    "stagger twice": ("space", {"support.stagger": 0.1}, "stagger = 0.25 m, .* give one of them"),
    "both kinds of arm": ("plane", {"supports.steady_arm.stiffness": 9.0, "supports.steady_arm.length": 1.0},
                          "supports: at = 2: stiffness and length: give exactly one"),
    "a key of the other kind": ("space", {"supports.steady_arm.mass": 1.0}, "mass has no effect on an arm"),
    "damping without a spring": (
        "space", {"supports.messenger_damping": 1.0}, "give messenger_stiffness too"
    ),
    "an arm that holds the height": ("plane", {"support.steady_arm.holds_design_height": True},
                                     "preload = 150 N has no effect"),
    "a length for some droppers": (
        "plane", {"span.droppers.length": 0.9}, "span 1: dropper 2 at 15 m has no"
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", COMBINED)
def test_keys_at_odds_are_refused(case):
    base, changes, said = COMBINED[case]
    record = BASES[base] | ({"stagger": 0.25} if base == "space" else {})
    for place, value in changes.items():
        record = put(record, place, value)
    with pytest.raises(cf.InputError, match=said):
        cf.find_form(line_of(record))


def test_air_beside_a_mean_force_is_refused():
    with pytest.raises(cf.InputError, match="aerodynamic_force has no effect beside mean_force"):
        cf.Pantograph(**SET, aerodynamic_force={"linear": 0.1})


def arms(text: str) -> list[cf.SteadyArm]:
    record = tomllib.loads(PLANE + text)
    return [support.steady_arm for support in line_of(record).supports]


def test_an_arm_of_one_support_keeps_what_it_does_not_change():
    common, arm, _ = arms("[[supports]]\nat = 2\nsteady_arm = { stiffness = 400, uplift_room = 0.2 }")
    assert arm == common.replace(stiffness=400.0, uplift_room=0.2)


def test_an_arm_of_the_other_kind_keeps_the_room_alone():
    text = "[[supports]]\nat = 2\nstagger = 0.2\nsteady_arm = { length = 1.1 }"
    record = put(tomllib.loads(PLANE + text), "support.steady_arm.uplift_room", 0.15)
    assert line_of(record).supports[1].steady_arm == cf.SteadyArm(length=1.1, uplift_room=0.15)


def test_an_arm_that_holds_the_height_drops_the_preload_of_the_others():
    _, arm, _ = arms("[[supports]]\nat = 2\nsteady_arm = { holds_design_height = true }")
    assert (arm.holds_height, arm.preload, arm.mass) == (True, 0.0, 0.5)
