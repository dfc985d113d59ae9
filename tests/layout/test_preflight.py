"""Values that no rule forbids and no overhead line has: mostly slips of the unit."""

import pytest

import catenary_fe as cf
from catenary_fe.layout.rules import layout_warnings, pantograph_warnings

SLIPS = {
    "contact_wire_height": 5300.0, "system_height": 1400.0, "contact_wire.mass_per_length": 951.0,
    "messenger_wire.tension": 16.0, "contact_wire.bending_stiffness": 109e6, "damping.beta": 0.1,
}  # fmt: skip
IN_ALL = {
    "length": 54e3, "pre_sag": 54.0, "dropper.mass_per_length": 90.0, "dropper.messenger_clamp_mass": 300.0,
    "dropper.stiffness": 100.0, "support.messenger_stiffness": 500.0, "support.stagger": 2.0,
    "steady_arm.uplift_room": 120.0,
}  # fmt: skip


def changed(line, key, value):
    name = key.split(".")[-1]
    match key.split("."):
        case [_]:
            return line.replace(**{name: value})
        case [owner, _]:
            return line.replace(**{owner: getattr(line, owner).replace(**{name: value})})


def changed_in_all(line, key, value):
    owner, name = key.split(".") if "." in key else ("span", key)
    spans, supports = line.spans, line.supports
    if owner == "span":
        spans = [s.replace(**{name: value}) for s in spans]
    if owner == "dropper":
        spans = [s.replace(droppers=[d.replace(**{name: value}) for d in s.droppers]) for s in spans]
    if owner == "support":
        supports = [s.replace(**{name: value}) for s in supports]
    if owner == "steady_arm":
        supports = [s.replace(steady_arm=s.steady_arm.replace(**{name: value})) for s in supports]
    return line.replace(spans=spans, supports=supports)


@pytest.mark.parametrize("key", SLIPS)
def test_a_slip_is_told_with_its_place(reference, key):
    (line, *more) = layout_warnings(changed(reference, key, SLIPS[key]))
    assert line.startswith(f"{key} = {SLIPS[key]:g} ")
    assert "looks like kN" in line if "tension" in key else line.endswith("look at the unit")
    assert not more


@pytest.mark.parametrize("key", IN_ALL)
def test_what_is_the_same_in_all_spans_is_told_once(reference, key):
    (line,) = layout_warnings(changed_in_all(reference, key, IN_ALL[key]))
    assert f"{key.split('.')[-1]} = {IN_ALL[key]:g} " in line
    assert line.startswith(("span 1", "support 1"))


def test_lines_and_pantographs_of_the_library_are_plausible(reference_layout):
    for path in reference_layout.parent.glob("*.toml"):
        line = cf.load_catenary(path)
        assert [w for w in layout_warnings(line) if "no steady arm" not in w] == [], path
    for name in cf.library.names("pantographs"):
        for kmh in (80, 160, 250, 350):
            assert pantograph_warnings(cf.library.pantograph(name), kmh / 3.6) == [], name


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"uplift_force": 0.12}, "pushes with 0.12 N at 180 km/h"),
        ({"aerodynamic_force": {"quadratic": 0.97}}, "pushes with 2545 N at 180 km/h"),
        ({"stages": ((7000.0, 1e4), (15.0, 50.0))}, "heads have 1 to 60 kg"),
        ({"stages": ((60.0, 1e4), (7.0, 50.0))}, "look at the order of the stages"),
    ],
)
def test_slips_in_a_pantograph(pantograph, changes, said):
    if "stages" in changes:
        changes = {"stages": [cf.Stage(mass=m, stiffness=k) for m, k in changes["stages"]]}
    if "aerodynamic_force" in changes:
        changes = {"aerodynamic_force": cf.AerodynamicForce(quadratic=0.97)}
    (line,) = pantograph_warnings(pantograph.replace(**changes), 50.0)
    assert said in line
